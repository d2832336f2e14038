/* Operations: the stitcher's recording of the specification (bind.h), before values have locations.
 *
 * An operation's number is the number of the value that it computes; 0 means none. Two walks convert
 * operations to parts. The first, from back to front, finds the readers of each value (readers.c). The
 * second, from front to back, chooses a register or a slot of the stack frame for each value and appends
 * the fragments (locate.c).
 *
 * Operations that are the same for a whole call come before all others, in front of the routine's loop. A
 * value that is computed there, or read there and in the loop, is alive to the end of the routine.
 *
 * Control flow nests. A value is read only in the region in which it is computed, or in regions inside it.
 * A value that leaves a region is a variable, which has a location of its own. */
#ifndef ENGINES_STITCH_OPERATION_H
#define ENGINES_STITCH_OPERATION_H

#include "contract/binding.h"
#include "engines/stitch/fragment.h"

enum operation_kind {
    OPERATION_NONE,    /* its value is not read */
    OPERATION_COMPUTE, /* `fragment`; k are the arguments after the operands */
    OPERATION_LITERAL, /* k[0] in all lanes; k[1] is its number among the literals, or 0 */
    OPERATION_READ,    /* `fragment`, load or uniform, from base k[1] + k[0] */
    OPERATION_GET,     /* variable k[0]; k[1]: the variable is not set before the last reader of the value */
    OPERATION_SET,
    OPERATION_STORE, /* to base k[1] + k[0] */
    OPERATION_SCATTER,
    OPERATION_WHEN, /* k[0]: the end */
    OPERATION_END,
    OPERATION_LOOP, /* k[0]: the end */
    OPERATION_AGAIN /* k[0]: the begin */
};

/* The forms of operations: rows of def/op.def and def/engine/fusion.def, and the kinds of literals in the
 * latter. */
enum form {
    FORM_none,
#define OP(name, result, a, b, c, properties, expression)  FORM_##name,
#define OPK(name, result, a, b, c, properties, expression) FORM_##name,
#define CAST(name, result, from)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
#define FORM(name, fragment, operands, properties) FORM_##name,
#define FUSION(operation, operand, given, becomes, a, b, c)
#include "def/engine/fusion.def"
#undef FORM
#undef FUSION
    FORM_literal,
    FORM_zero,
    FORM_ones,
    FORM_COUNT
};

static_assert(FORM_COUNT <= 64, "sets of forms are words");

/* The set of forms that a rule can change. */
#define FORM(name, fragment, operands, properties)
#define FUSION(operation, operand, given, becomes, a, b, c) | 1ull << FORM_##operation
static const uint64_t forms_that_fuse = 0
#include "def/engine/fusion.def"
    ;
#undef FORM
#undef FUSION

/* How often an operation is executed: for each group of lanes, or once a call, since it is the same for all
 * (operations.c). A literal or a word of the call needs no part by itself. */
enum once { ONCE_NOT, ONCE_READ, ONCE_COMPUTED };

struct operation {
    const struct fragment *fragment;
    uint32_t operand[3];
    uint32_t next[3]; /* the next reader of each operand; 0: this is the last */
    int32_t k[4];     /* bases are counted from r8 */
    uint8_t kind;     /* enum operation_kind */
    uint8_t operands;
    uint8_t commutes;
    uint8_t form;  /* enum form */
    uint8_t once;  /* enum once */
    uint8_t fused; /* does two or more operations of the specification */
    uint16_t line; /* of the specification */
    const char *file;
};

/* A value and its location. */
struct value {
    uint32_t last;   /* its last reader; the end of a loop if it is read in the loop but computed before it */
    uint32_t next;   /* its next reader */
    uint32_t dying;  /* the next value in the list of those that end at the same loop */
    int32_t slot;    /* of the frame, or SLOT_NONE */
    uint8_t vector;  /* register, or VECTOR_NONE */
    uint8_t foreign; /* the slot belongs to a variable */
    uint8_t read;    /* bit 0: in the routine's loop; bit 1: before it */
};

enum { SLOT_NONE = -1, VECTOR_NONE = 255 };

/* A variable: a slot of the stack frame, or a register while it is in use. */
struct variable_state {
    int32_t slot;      /* or SLOT_NONE */
    uint8_t vector;    /* or VECTOR_NONE */
    uint32_t first;    /* the first operation that uses it */
    uint32_t last;     /* the last one; the end of a loop if it is in use when the loop begins */
    uint32_t next_set; /* during the walk from back to front: the set that was visited last, 0: none */
    uint32_t value;    /* its known value, 0: none; then where that value was set or read */
    uint32_t known_at, region, depth;
};

#endif
