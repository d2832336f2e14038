/* Runs a piece of code, or calls a function, with every register chosen and every register seen afterwards, as dav1d's
 * checkasm does: canaries are planted with it.
 *
 * The code is entered by a jump and leaves by a jump to trampoline_exit (or trampoline_exit_taken, to tell
 * two ways out apart). It may do what it likes to any register and to MXCSR; the caller's are put back. Not
 * thread-safe: when no register may be used, state has to be in fixed memory. */
#ifndef TESTS_TRAMPOLINE_H
#define TESTS_TRAMPOLINE_H

#include <stdalign.h>
#include <stdint.h>

struct machine_state {
    alignas(32) uint8_t ymm[16][32];
    uint64_t general[16]; /* by hardware number: rax rcx rdx rbx rsp rbp rsi rdi r8 ... */
    uint64_t flags;       /* seen only */
    uint32_t mxcsr;
    uint32_t taken; /* seen only: left by trampoline_exit_taken */
    alignas(64)
        uint8_t zmm_high[16][32]; /* of the registers' 512 bits, where there are so many; also those from 16
                                             on, coming in */
};

/* Whether there are registers of 512 bits, and `zmm_high` says something. */
int trampoline_is_wide(void);

/* Loads `in`, jumps to `code`, stores what was there on the way out to `out`. Needs AVX. */
void trampoline_run(const void *code, const struct machine_state *in, struct machine_state *out);

/* Calls a function of the System V calling convention with two arguments, as C does, but from a stack of its own that
 * lies between unreadable pages, at any multiple of 16; with random words in all other registers, vector registers to
 * their last bit, and above the return address; and with that MXCSR. Returns null when the callee kept the convention:
 * what is callee-saved, the stack pointer, the caller's frame, MXCSR's control bits and the direction flag are as they
 * were, and the upper halves of vector registers zero. Else what it did (until the next call). */
const char *trampoline_call(const void *function, const void *first, const void *second, uint32_t mxcsr,
                            uint64_t *seed);

extern const char trampoline_exit[], trampoline_exit_taken[];

#endif
