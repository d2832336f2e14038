/* Operations: what the stitcher's reading of the specification appends (bind.h), before it is known where
 * values are.
 *
 * An operation's number is that of the value it gives; 0 is none. Two walks make parts of them: one from
 * back to front finds who reads each value (readers.c), one from front to back decides which register or
 * slot of the frame it is in and appends the fragments (place.c).
 *
 * Control nests, and a value is read only where control cannot have avoided it: in the region that it is
 * given in, inner regions included. What leaves a region is a variable, which has a slot of its own. */
#ifndef STITCH_OPERATION_H
#define STITCH_OPERATION_H

#include "def/binding.h"
#include "stitch/fragment.h"

enum operation_kind {
    OPERATION_NONE,    /* nobody reads what it gives */
    OPERATION_COMPUTE, /* `fragment`: k are the arguments behind the operands */
    OPERATION_LITERAL, /* k[0] in all lanes; k[1] is its place among the literals once it has one */
    OPERATION_READ,    /* `fragment`, load or uniform, from base k[1] + k[0] */
    OPERATION_GET,     /* variable k[0]; k[1]: nothing is set before the value's last reader */
    OPERATION_SET,
    OPERATION_STORE, /* to base k[1] + k[0] */
    OPERATION_SCATTER,
    OPERATION_WHEN, /* k[0]: the end */
    OPERATION_END,
    OPERATION_LOOP, /* k[0]: the end */
    OPERATION_AGAIN /* k[0]: the begin */
};

/* What is computed: rows of def/op.def and of def/fusion.def, and what the latter tells of literals. */
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
#include "def/fusion.def"
#undef FORM
#undef FUSION
    FORM_literal,
    FORM_zero,
    FORM_ones,
    FORM_COUNT
};

static_assert(FORM_COUNT <= 64, "sets of forms are words");

/* Those that may become another, as a set. */
#define FORM(name, fragment, operands, properties)
#define FUSION(operation, operand, given, becomes, a, b, c) | 1ull << FORM_##operation
static const uint64_t forms_that_fuse = 0
#include "def/fusion.def"
    ;
#undef FORM
#undef FUSION

struct operation {
    const struct fragment *fragment;
    uint32_t operand[3];
    uint32_t next[3]; /* of each operand, its next reader; 0: this is the last */
    int32_t k[4];     /* bases are counted from r8 */
    uint8_t kind;     /* enum operation_kind */
    uint8_t operands;
    uint8_t commutes;
    uint8_t form;  /* enum form */
    uint8_t fused; /* of two or more */
    uint16_t line; /* of the specification */
    const char *file;
};

/* A value, and where it is while it is alive. */
struct value {
    uint32_t last;   /* its last reader; of what is read in a loop but given before, the loop's end */
    uint32_t next;   /* its next reader */
    uint32_t dying;  /* at the end of a loop, the next value that dies there as well */
    int32_t slot;    /* of the frame, or SLOT_NONE */
    uint8_t vector;  /* register, or VECTOR_NONE */
    uint8_t foreign; /* its slot is a variable's */
};

enum { SLOT_NONE = -1, VECTOR_NONE = 255 };

/* A variable: a slot of the frame, or a register as long as it is in use. */
struct variable_state {
    int32_t slot;      /* or SLOT_NONE */
    uint8_t vector;    /* or VECTOR_NONE */
    uint32_t first;    /* the operations that it is in use from, */
    uint32_t last;     /* and to: of what is in use when a loop begins, the loop's end */
    uint32_t next_set; /* walking from back to front, the last that was met; 0: none */
    uint32_t value;    /* that it is known to have, 0: none; where that was learned: */
    uint32_t known_at, region, depth;
};

#endif
