/* Register allocation: linear scan over live intervals (Poletto and Sarkar 1999) in one line of code, in
 * which loops and regions are marks.
 *
 * A value's interval runs from its definition to its last use; where it comes into a loop and is used
 * there, to the loop's end. Values that phis and joins unite are one value with several definitions, a web
 * (coalesce.c). A value lives in a register until position `split` and in memory after it; it is stored
 * where it is defined, each time, so that it does not matter whether the region in which it was evicted
 * ran. One that is evicted in a loop that it came into is in memory from the loop's head on, since the next
 * pass comes to all of it.
 *
 * Victims are the values whose next use is furthest away (Belady 1966); where there are loops, those that
 * give most for what they cost there. Spill slots are shared by values whose intervals do not meet. Values
 * that memory already holds need no slot: literals and frame constants are never in registers unless
 * copied, a uniform is read again, a load from memory that no routine writes is addressed where it is.
 * Variables, where a profile leaves them, are words of the frame.
 *
 * There are two sets of registers, each for values of its own. Vectors have 13 registers, or 29 where there are 32. With
 * 16 lanes masks have six of their own. */
#ifndef JIT_ALLOCATE_H
#define JIT_ALLOCATE_H

#include "ir/ir.h"

enum {
    ALLOCATABLE = 13, /* vector registers 0 to 12; those from 16 on as well where there are 32 */
    SCRATCH_RESULT = 13,
    SCRATCH_FIRST = 14, /* two registers for operands that must leave memory */
    SCRATCH_SECOND = 15,
    MASKS = 32,          /* the number of mask register 0; 33 to 38 are allocated */
    MASK_RESULT = MASKS, /* the one that no instruction can be masked by */
    MASK_SCRATCH = MASKS + 7,
    REGISTERS = MASKS + 8,
    NO_REGISTER = 255,
    NO_SLOT = 0xffff,
    NEVER = 0xffff,
    SLOT_WORDS = IR_CAPACITY / 64 + 1,
    LOOP_CAPACITY = IR_CAPACITY / 2 + 1 /* any routine's */
};

/* A loop of the routine: where it begins and ends, and the loop around it, 0: none. Outer ones come first. */
struct loop_extent {
    uint16_t head, again, outer;
};

enum residence {
    RESIDENCE_NONE,     /* no value, or never used */
    RESIDENCE_REGISTER, /* up to `split` */
    RESIDENCE_MEMORY    /* an operand in memory wherever it is used */
};

/* Which registers there are, and how to choose among them. All zero: all, by the rules above. Tests take some away and
 * draw lots, since what is allocated must be right whatever is chosen. */
struct register_file {
    uint64_t without; /* bit r: register r is not to be used; all may be missing */
    uint64_t seed;    /* not 0: free registers, victims, slots and what shares a place are drawn by lot */
    int wide;         /* 32 vector registers, and mask registers */
};

/* Those that are allocated, a bit each. */
#define NARROW_REGISTERS ((1ull << ALLOCATABLE) - 1)
#define WIDE_REGISTERS   (NARROW_REGISTERS | 0xffff0000ull)
#define MASK_REGISTERS   (0x7eull << MASKS)

struct allocation {
    uint64_t lots; /* the state of the lots; 0: none are drawn */
    int wide;
    uint8_t residence[IR_CAPACITY];
    uint8_t reg[IR_CAPACITY];
    uint16_t split[IR_CAPACITY]; /* at positions after this the value is in memory; NEVER */
    uint16_t
        slot[IR_CAPACITY]; /* its spill slot, NO_SLOT when memory holds it already or it is not spilled */
    uint16_t last[IR_CAPACITY]; /* last position at which it is alive; 0 when it is not used */
    uint32_t uses[IR_CAPACITY];
    uint16_t next[IR_CAPACITY][3]; /* the use after this one of the same value, 0: this is the last */
    uint16_t next_use[IR_CAPACITY];
    uint16_t expiring[IR_CAPACITY]; /* the value whose slot is free behind a position, 0: none; then the next
                                       such */
    uint16_t expiring_next[IR_CAPACITY];
    uint32_t weight[IR_CAPACITY]; /* if there are loops: how often it is used or defined, by estimate; and the
                                     use passed last */
    uint16_t recent[IR_CAPACITY]; /* if there are loops: the use passed last */
    uint16_t loop_at[IR_CAPACITY];   /* the loop that begins or ends at a position, or that a phi is of */
    uint16_t region_at[IR_CAPACITY]; /* if there are joins: of a `when` its end, and of an `end` its `when` */
    int webs;                        /* whether there are any: else each value is one */
    uint16_t web[IR_CAPACITY];       /* the first value of each value's web */
    uint16_t member[IR_CAPACITY];    /* the next of the web, 0: the last */
    uint16_t tail[IR_CAPACITY];      /* of a web: its last value */
    uint16_t death[IR_CAPACITY];     /* where a value is alive last */
    struct loop_extent loop[LOOP_CAPACITY];
    uint64_t free_slot[SLOT_WORDS]; /* a bit for each slot that is free */
    uint32_t slots;
    uint32_t spills; /* values that left their register */
};

/* Whether selection can take operand `position` of this operation from memory. */
int allocate_folds(const struct ir_instruction *instruction, int position);

/* Whether operands keep their registers until the result is there. */
int allocate_keeps_operands(const struct ir_instruction *instruction);

/* Whether a value is in memory from the start: a literal, a frame constant. */
static inline int allocate_is_constant(const struct ir_instruction *instruction)
{
    return instruction->op == IR_literal || instruction->op == IR_constant;
}

/* Fills `allocation` for a verified, compacted IR. */
void allocate(const struct ir *ir, struct allocation *allocation, const struct register_file *file);

/* Whether a value is in a mask register when it is in one: what the table says is a mask, and what such values go
 * through. (Integers have their and-not from masks.) */
static inline int allocate_is_mask(const struct allocation *allocation,
                                   const struct ir_instruction *instruction)
{
    if (!allocation->wide || instruction->type != TYPE_msk)
        return 0;
    switch (instruction->op) {
    case IR_copy:
    case IR_get:
    case IR_phi:
    case IR_join: return 1;
    default: return ir_op_information[instruction->op].result == TYPE_msk;
    }
}

/* Registers 0 to count - 1, and half as many masks, chosen by the rules; the whole file if that is ALLOCATABLE. */
static inline struct register_file register_file_of(unsigned count, unsigned width)
{
    uint64_t with = ((1ull << count) - 1) | ((2ull << count / 2) - 1) << MASKS;
    return (struct register_file){.without = count < ALLOCATABLE ? ~with : 0, .wide = width == 16};
}

/* A number below `limit` where lots are drawn, else 0. */
static inline unsigned allocate_lot(struct allocation *allocation, unsigned limit)
{
    uint64_t lots = allocation->lots;
    if (!lots)
        return 0;
    lots ^= lots >> 12;
    lots ^= lots << 25;
    lots ^= lots >> 27;
    allocation->lots = lots;
    return (unsigned)((lots * 0x2545f4914f6cdd1dull >> 33) % limit);
}

/* The web of a value. What is said of a value's register, uses and slot stands at its web; of each
 * definition, `reg` is where its instruction puts it. */
static inline unsigned allocate_web(const struct allocation *allocation, unsigned value)
{
    return allocation->webs ? allocation->web[value] : value;
}

/* The outermost of the loops around loop `inner`, itself included, that what is defined at `birth` is older
 * than; 0: none. */
unsigned allocate_entered_loop(const struct allocation *allocation, unsigned birth, unsigned inner);

/* The end of the region behind which a join stands. */
uint32_t allocate_joined_end(const struct ir *ir, uint32_t join);

/* Fills web, member and tail, with loops and regions found (coalesce.c). */
void allocate_coalesce(const struct ir *ir, struct allocation *allocation);

/* Prints the live intervals as a chart. */
void allocate_print(const struct ir *ir, const struct allocation *allocation, FILE *out);

#endif
