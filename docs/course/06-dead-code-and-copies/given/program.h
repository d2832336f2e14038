/* Lab 6: programs in single assignment, and two passes over them. */
#ifndef PROGRAM_H
#define PROGRAM_H

enum { PROGRAM_MAXIMUM = 4096 };

enum kind {
    KIND_NOTHING, /* removed: it does nothing */
    KIND_VALUE,   /* computes or reads a value */
    KIND_COPY,    /* its value is that of operand[0] */
    KIND_STORE    /* writes operand[0] to memory; has no value */
};

/* The number of an instruction is its index in the program, and the name of its value. Operands are values of
 * earlier instructions. Number 0 names nothing: instruction 0 does nothing, and unused operands are 0. */
struct instruction {
    enum kind kind;
    char operation[12]; /* "mul_f", for example */
    int operand[3];
    /* Loads and stores: the place in memory, "OUTPUT position[1]" for example. Literals: the number. */
    char place[40];
    char type[4]; /* of the value: "flt", "itg" or "msk" */
};

struct program {
    int count; /* of instructions, with number 0 */
    struct instruction instruction[PROGRAM_MAXIMUM];
};

/* --- passes.c --- */

/* Copy propagation: afterwards no operand is a copy, and copies are KIND_NOTHING. Returns the number of
 * removed copies. */
int pass_copy(struct program *program);

/* Dead code: instructions whose values no store needs become KIND_NOTHING. One walk over the program. Returns
 * the number of instructions that were removed. */
int pass_dead(struct program *program);

/* Takes the colour out of the recording of a lit vertex: its stores become KIND_NOTHING. Returns the number
 * of removed stores. */
int remove_color(struct program *program);

#endif
