/* Runs a piece of code with every register set, and reads every register afterwards, as dav1d's checkasm
 * does.
 *
 * The code is entered by a jump and leaves by a jump to trampoline_exit or trampoline_exit_taken, which
 * distinguishes two exits. It may change any register and MXCSR; the caller's are restored. Not thread-safe:
 * no register is free to hold an address, so the state is in fixed memory. */
#ifndef TESTS_SUPPORT_ROUTINE_TRAMPOLINE_H
#define TESTS_SUPPORT_ROUTINE_TRAMPOLINE_H

#include <stdalign.h>
#include <stdint.h>

struct machine_state {
    alignas(32) uint8_t ymm[16][32];
    uint64_t general[16]; /* by hardware number: rax rcx rdx rbx rsp rbp rsi rdi r8 ... */
    uint64_t flags;       /* output only */
    uint32_t mxcsr;
    uint32_t taken; /* output only: left by trampoline_exit_taken */

    /* The upper halves of zmm0 to zmm15, on processors with AVX-512. On entry, zmm16 to zmm31 have the same
     * values. */
    alignas(64) uint8_t zmm_high[16][32];
};

/* Returns 1 if the processor has AVX-512 and `zmm_high` is used. */
int trampoline_is_wide(void);

/* Loads `in`, jumps to `code`, and stores the registers at the exit to `out`. Needs AVX. */
void trampoline_run(const void *code, const struct machine_state *in, struct machine_state *out);

enum { TRAMPOLINE_ARGUMENTS = 6 };

/* Calls a function of the System V calling convention as C does, but with a stack of its own, and checks the
 * convention.
 *
 * The stack is between unreadable pages, and its top is any multiple of 16. All other registers, all bits of
 * the vector registers, and the memory above the return address have random values, and MXCSR is `mxcsr`.
 * Returns null when the callee-saved registers, the stack pointer, the caller's stack frame, MXCSR's control
 * bits and the direction flag are unchanged, and the upper halves of the vector registers are zero. Else
 * returns the violation, valid until the next call. `result` receives rax and rdx. */
const char *trampoline_call_with(const void *function, const uint64_t argument[static TRAMPOLINE_ARGUMENTS],
                                 uint32_t mxcsr, uint64_t *seed, uint64_t result[static 2]);

/* The same with two arguments; the others are random. */
const char *trampoline_call(const void *function, const void *first, const void *second, uint32_t mxcsr,
                            uint64_t *seed);

extern const char trampoline_exit[], trampoline_exit_taken[];

#endif
