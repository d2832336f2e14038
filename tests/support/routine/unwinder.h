/* A small independent unwinder: reads the call frame information (.eh_frame) of one routine and computes
 * the caller's registers. It implements the DWARF 4 instructions that the routines' information uses, and
 * fails on any other. */
#ifndef TESTS_SUPPORT_ROUTINE_UNWINDER_H
#define TESTS_SUPPORT_ROUTINE_UNWINDER_H

#include <stddef.h>
#include <stdint.h>

enum {
    UNWINDER_REGISTERS = 17
}; /* by DWARF's number: rax rdx rcx rbx rsi rdi rbp rsp r8 ... r15, return address */

struct unwinder_frame {
    uint64_t value[UNWINDER_REGISTERS]; /* at an instruction, or in the caller after the call */
    uint64_t cfa;                       /* of the callee; rsp in the caller */
};

/* Computes the caller's registers from those at address `at`. Returns null, or the error in the
 * information. */
const char *unwinder_step(const uint8_t *information, size_t bytes, uint64_t at,
                          const uint64_t value[UNWINDER_REGISTERS], struct unwinder_frame *caller);

#endif
