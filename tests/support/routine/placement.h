/* A proof about the machine code of a specializer's routine: every instruction reads the operands of its
 * operation, through registers, copies, spills, reloads, phis and joins.
 *
 * The code is executed symbolically from front to back. A register or a slot of the stack frame contains a
 * set of values of the intermediate representation that are equal there, or the value of a literal, a
 * constant or a word of memory. An instruction may read locations that contain an operand of the operation
 * that it was selected for, or an intermediate result of that operation. Copies copy sets. Where paths
 * join, only values that both paths have remain. A loop is walked until nothing changes. A phi is another
 * name for its first value, and, on the path around the loop, for its next value. A join is another name
 * for its operands on its two paths.
 *
 * The proof is independent of register allocation and of the emission of moves. From the allocation it
 * uses, and checks, only the register of each operation's result. It does not check the order of an
 * instruction's operands, or its computation; the tests that run the code check both. */
#ifndef TESTS_SUPPORT_ROUTINE_PLACEMENT_H
#define TESTS_SUPPORT_ROUTINE_PLACEMENT_H

#include "engines/specialize/build.h"

/* Checks the routine that was built last. Returns null, or one line with the error, valid until the next
 * call. */
const char *placement_check(const struct builder *builder);

#endif
