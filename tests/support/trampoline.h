/* Runs a piece of code with every register chosen and every register seen afterwards, as dav1d's checkasm
 * does for whole functions: the tests of fragments plant canaries with it.
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
};

/* Loads `in`, jumps to `code`, stores what was there on the way out to `out`. Needs AVX. */
void trampoline_run(const void *code, const struct machine_state *in, struct machine_state *out);

extern const char trampoline_exit[], trampoline_exit_taken[];

#endif
