/* Random programs of nested loops, jumps and conditions, each lane with its own path: as the staged language
 * executes or records them, and in C, lane by lane. */
#ifndef TESTS_SUPPORT_CONTROL_NEST_H
#define TESTS_SUPPORT_CONTROL_NEST_H

#include "contract/arguments.h"
#include "ir/ir.h"

enum { NEST_DATA = 4, NEST_NODES = 64, NEST_LANES = 16, NEST_BLOCKS = 3 };

enum nest_kind {
    NEST_STEP,
    NEST_IF,
    NEST_WHILE,
    NEST_FLOW,
    NEST_BREAK,
    NEST_CONTINUE,
    NEST_GOTO,
    NEST_KINDS
};

/* A statement, and the one after it. Numbers are those of nodes; 0: none. */
struct nest_node {
    uint8_t kind;
    uint8_t data;  /* the variable that a step changes, and that conditions test */
    uint8_t block; /* of a goto */
    uint8_t next;
    uint8_t body[NEST_BLOCKS]; /* of a flow, its blocks; else the first */
    int32_t number;            /* of a step: it is added. of conditions: a mask of bits */
};

struct nest {
    unsigned nodes;
    unsigned kinds[NEST_KINDS]; /* the number of each */
    struct nest_node node[NEST_NODES];
};

/* Makes a random program. */
void nest_make(struct nest *nest, uint64_t *seed);

/* Computes the program in C, for one lane's data. */
void nest_compute(const struct nest *nest, int32_t data[NEST_DATA]);

/* Records it as a vertex routine: lane l's data are the rows of `index`, NEST_LANES apart; results are the
 * first slots. */
void nest_record(const struct nest *nest, struct ir *ir);

/* Executes it under the emulator's binding. */
void nest_emulate(const struct nest *nest, const struct vertex_arguments *arguments);

#endif
