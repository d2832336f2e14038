/* A small unwinder of its own: reads call frame information (.eh_frame) of one routine and says what the caller's registers
 * were. Knows what DWARF 4 says of the instructions that the routines' information uses, and fails on any other. */
#ifndef TESTS_UNWINDER_H
#define TESTS_UNWINDER_H

#include <stddef.h>
#include <stdint.h>

enum {
    UNWINDER_REGISTERS = 17
}; /* by DWARF's number: rax rdx rcx rbx rsi rdi rbp rsp r8 ... r15, return address */

struct unwinder_frame {
    uint64_t value[UNWINDER_REGISTERS]; /* at some instruction, or in the caller behind the call */
    uint64_t cfa;                       /* of the callee; rsp in the caller */
};

/* From the registers at address `at` to those of the caller. Null, or what is wrong with the information. */
const char *unwinder_step(const uint8_t *information, size_t bytes, uint64_t at,
                          const uint64_t value[UNWINDER_REGISTERS], struct unwinder_frame *caller);

#endif
