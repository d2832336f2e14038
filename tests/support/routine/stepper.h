/* Runs code one instruction at a time with the processor's trap flag. The tests of unwind information
 * check every instruction with it. */
#ifndef TESTS_SUPPORT_ROUTINE_STEPPER_H
#define TESTS_SUPPORT_ROUTINE_STEPPER_H

#include "tests/support/routine/unwinder.h"

/* Called before each instruction between `code` and code + bytes, with the registers by DWARF number; the
 * return address is the address of the instruction. Runs on a stack of its own as a signal handler, so it
 * may only inspect and count. */
typedef void stepper_callback(void *user, const uint64_t value[UNWINDER_REGISTERS]);

/* Calls function(first, second), which is in `code` or jumps to it. Not thread-safe. */
void stepper_call(void (*function)(const void *first, const void *second), const void *first,
                  const void *second, const void *code, size_t bytes, stepper_callback *callback, void *user);

#endif
