/* Runs code one instruction at a time, by the processor's trap flag: the tests of unwind information look at every
 * instruction with it. */
#ifndef TESTS_STEPPER_H
#define TESTS_STEPPER_H

#include "tests/support/unwinder.h"

/* Called before each instruction between `code` and code + bytes, with the registers by DWARF's numbers; that of the
 * return address is the instruction's. Runs on a stack of its own, as a signal handler: it may look and count. */
typedef void stepper_callback(void *user, const uint64_t value[UNWINDER_REGISTERS]);

/* Calls function(first, second), which is somewhere in `code` or comes there. One thread at a time. */
void stepper_call(void (*function)(const void *first, const void *second), const void *first,
                  const void *second, const void *code, size_t bytes, stepper_callback *callback, void *user);

#endif
