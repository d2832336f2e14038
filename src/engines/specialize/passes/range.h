/* Range analysis: bounds of each value, without running the program (range.c). */
#ifndef ENGINES_SPECIALIZE_PASSES_RANGE_H
#define ENGINES_SPECIALIZE_PASSES_RANGE_H

#include "ir/ir.h"

/* The known range of a value. Only flt and itg have ranges; everything else, and all that is unknown, may be
 * anything. */
struct range {
    float low,
        high;    /* bounds, inclusive: of a flt, of its values other than NaN; of an itg, rounded outward */
    uint8_t nan; /* a flt that may be NaN */
    uint8_t minus_zero;
    uint8_t denormal; /* a flt that may have the bits of a denormal */
};

struct range_memory {
    struct range range[IR_CAPACITY];
    uint8_t known[IR_CAPACITY];    /* 1: the value's range is valid */
    uint16_t waiting[IR_CAPACITY]; /* a stack of values whose operands are analysed first */
};

/* Computes the range of every value. Run it under the contract's MXCSR, since it rounds as routines do. For
 * tests: ranges of single values. */
void range_analyse(const struct ir *ir, struct range_memory *memory);

/* Computes the ranges of single values, in a program that may be reduced meanwhile: after range_begin, the
 * range of a value is valid once range_demand was called for it. */
void range_begin(const struct ir *ir, struct range_memory *memory);
void range_demand(const struct ir *ir, struct range_memory *memory, unsigned value);

/* Returns the range of an instruction's operand, as the type that the operation expects. After copy
 * propagation through a cast the operand may have another type; then it may be anything. */
struct range range_of_operand(const struct ir *ir, const struct range_memory *memory,
                              const struct ir_instruction *instruction, int operand);

/* The most that each half of a packed value can be, as an unsigned integer; 0xffff: nothing is known. */
struct halves {
    uint32_t low, high;
};
struct halves range_halves(const struct ir *ir, unsigned value);

#endif
