/* Where values are in the machine code of a specializer's routine: a proof that every instruction reads what its
 * operation has as operands, through registers, copies, spills, reloads, phis and joins.
 *
 * The code is run symbolically from front to back. A register or a slot of the frame holds a set of values of the
 * intermediate representation that are equal there, or what a literal, a constant or a word of memory is; an
 * instruction may read what holds an operand of the operation that it was selected for, and what was made on the way to
 * that operation's result. Copies copy sets. Where control joins, only what holds on all ways stays; a loop is walked until
 * nothing changes any more. A phi is another name for what it begins as, and on the way around the loop for its next
 * value; so is a join on its two ways.
 *
 * Nothing of this knows how registers were allocated or moves written: of the allocation it believes only, and checks,
 * the register in which each operation leaves its result. It does not see which of its operands an instruction takes
 * first, nor what it computes; running the code does. */
#ifndef TESTS_PLACEMENT_H
#define TESTS_PLACEMENT_H

#include "jit/build.h"

/* Of the routine that was built last: null, or one line that says what is wrong (until the next call). */
const char *placement_check(const struct builder *builder);

#endif
