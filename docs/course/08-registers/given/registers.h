/* Lab 8: live intervals, and registers for them. */
#ifndef REGISTERS_H
#define REGISTERS_H

#include <stdbool.h>

enum { PROGRAM_MAXIMUM = 4096, OPERANDS = 3, NOWHERE = -1 };

/* The number of an instruction is its index, and the name of its value. Operands are numbers of earlier
 * values, or 0: none. Instruction 0 is empty. Every value has a use. */
struct instruction {
    bool has_value; /* a store has none */
    int operand[OPERANDS];
};

struct program {
    int count; /* of instructions, with number 0 */
    struct instruction instruction[PROGRAM_MAXIMUM];
};

/* A value is alive from its definition to its last use. An instruction reads its operands before it writes
 * its value, so the value may have the register of an operand whose last use this is. */
struct interval {
    int first, last; /* numbers of instructions */
};

/* Where a value is during its whole life: in a register or in a slot of memory. The other one is NOWHERE. */
struct place {
    int reg, slot;
};

/* --- allocate.c --- */

/* Sets interval[n] of each value n. */
void find_intervals(const struct program *program, struct interval *interval);

/* Sets place[n] of each value n: a register from 0 to registers - 1, or a slot. Values that are alive at the
 * same time have different places. As few values as possible are in slots, and as few slots as possible are
 * used. Returns the number of slots. */
int allocate(const struct program *program, const struct interval *interval, int registers,
             struct place *place);

#endif
