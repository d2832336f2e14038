/* Register allocation, in the ways of def/engine/allocator.def. The default is linear scan over live
 * intervals (Poletto and Sarkar 1999). The program is one sequence of instructions, in which loops and
 * regions are marks.
 *
 * The interval of a value runs from its definition to its last use. If the value is defined before a loop and
 * used in it, the interval runs at least to the loop's end. Values that phis and joins unite form a web: one
 * value with several definitions (coalesce.c). A value is in a register up to position `split`, and in memory
 * after it. A value that is evicted later is stored at each of its definitions, so it does not matter whether
 * the region of its eviction ran. A value from outside of a loop that is evicted in the loop is in memory
 * from the loop's head on, because the next iteration executes all of the loop.
 *
 * The victim in straight-line code is the value with the longest rest of its life for its accesses to
 * memory: a store and the uses that are left. An evicted value does not come back to a register, so the rest
 * of its life counts and not only its next use (Belady 1966). In programs with loops it is the value with the
 * longest relief for its estimated number of uses. Values whose intervals do not overlap share spill slots.
 * Values that memory already holds need no slot: literals and slots of the constant table are in registers
 * only as copies, a uniform is read again, and a load from memory that no routine writes is addressed where
 * it is. Variables, if the profile keeps them, are in the stack frame.
 *
 * A value of the preamble (ir.h) that the body uses is alive to the end of the body, which is repeated. It is
 * the first to be evicted, because in the body it needs no store and is a memory operand. Evicted in the
 * body, it is in memory in the whole body. So the values of the preamble occupy the registers that the body
 * leaves, those with most uses first.
 *
 * A register that the body does not need has a constant with many uses in the whole body (keep.c).
 *
 * Vectors have 13 registers, or 29 of the 32 with AVX-512. With 16 lanes, masks have six registers of their
 * own. */
#ifndef ENGINES_SPECIALIZE_ALLOCATE_ALLOCATE_H
#define ENGINES_SPECIALIZE_ALLOCATE_ALLOCATE_H

#include "ir/ir.h"

enum {
    ALLOCATABLE = 13,    /* vector registers 0 to 12, and 16 to 31 if there are 32 */
    SCRATCH_RESULT = 13, /* for results without a register */
    SCRATCH_FIRST = 14,  /* two registers for operands that are loaded */
    SCRATCH_SECOND = 15,
    MASKS = 32,          /* the number of mask register 0; 33 to 38 are allocated */
    MASK_RESULT = MASKS, /* mask register 0, which cannot mask an instruction */
    MASK_SCRATCH = MASKS + 7,
    REGISTERS = MASKS + 8,
    NO_REGISTER = 255,
    NO_SLOT = 0xffff,
    NEVER = 0xffff,
    SLOT_WORDS = IR_CAPACITY / 64 + 1,
    LOOP_CAPACITY = IR_CAPACITY / 2 + 1 /* more loops than any program has */
};

/* The positions of a loop's ends, and the loop around it, 0: none. A loop's number is higher than those of
 * the loops around it. */
struct loop_extent {
    uint16_t head, again, outer;
};

enum residence {
    RESIDENCE_NONE,     /* no value, or an unused one */
    RESIDENCE_REGISTER, /* in a register up to `split` */
    RESIDENCE_MEMORY,   /* in memory at every use */
    RESIDENCE_KEPT      /* a constant that the body has in a register, and the preamble in memory (keep.c) */
};

enum allocator {
#define ALLOCATOR(name, ...) ALLOCATOR_##name,
#include "def/engine/allocator.def"
#undef ALLOCATOR
    ALLOCATORS
};

/* Which registers are available, and how to choose among them. All zero: all registers, by the rules above.
 * Tests remove registers and draw lots, because an allocation must be correct whatever is chosen. */
struct register_file {
    uint64_t without; /* bit r: register r is not available; this may be all of them */
    uint64_t seed;    /* not 0: free registers, victims, slots and what is coalesced are drawn by lot */
    bool wide;        /* there are 32 vector registers, and mask registers */
    bool scalar;      /* there is one lane: a word of memory can be an operand */
    bool hinted;      /* for the allocator `hints`: allocate_write_hints has run */
    enum allocator allocator;
};

/* The registers that are allocated, a bit each. */
#define NARROW_REGISTERS ((1ull << ALLOCATABLE) - 1)
#define WIDE_REGISTERS   (NARROW_REGISTERS | 0xffff0000ull)
#define MASK_REGISTERS   (0x7eull << MASKS)

/* The working data of graph colouring (coloring.c), by web. As with all arrays of a build, pages that a
 * program does not reach are never touched. */
enum { ALIVE_LIMIT = 96, EDGE_CAPACITY = 2 * IR_CAPACITY * ALIVE_LIMIT };

struct allocate_candidate {
    float cost;
    uint16_t web;
};

struct allocate_graph {
    uint32_t ordered;
    uint8_t spilled[IR_CAPACITY]; /* before the graph was made */
    uint8_t removed[IR_CAPACITY];
    uint16_t degree[IR_CAPACITY];
    uint16_t order[IR_CAPACITY]; /* in which webs were removed */
    uint16_t easy[IR_CAPACITY];
    struct allocate_candidate candidate[IR_CAPACITY];
    uint32_t begin[IR_CAPACITY], end[IR_CAPACITY]; /* of its neighbours in `edge` */
    uint16_t edge[EDGE_CAPACITY];
};

struct allocation {
    uint64_t lots; /* the state of the generator of lots; 0: no lots are drawn */
    bool wide;
    bool scalar;
    uint8_t residence[IR_CAPACITY];
    uint8_t reg[IR_CAPACITY];
    /* By value: */
    uint16_t split[IR_CAPACITY];    /* the last position at which it is in its register; NEVER: everywhere */
    uint16_t slot[IR_CAPACITY];     /* its spill slot; NO_SLOT: not spilled, or read again from memory */
    uint16_t last[IR_CAPACITY];     /* the last position at which it is alive; 0: unused */
    uint32_t uses[IR_CAPACITY];     /* the number of uses */
    uint16_t next[IR_CAPACITY][3];  /* by instruction and operand: the next use of the same value, 0: none */
    uint16_t next_use[IR_CAPACITY]; /* the next use from the current position on, 0: none */
    uint16_t left[IR_CAPACITY];     /* in the scan: the uses from the current position on */
    uint16_t expiring[IR_CAPACITY]; /* by position: a value whose last use it is, 0: none */
    uint16_t expiring_next[IR_CAPACITY]; /* another value with the same last use, 0: none */
    uint32_t weight[IR_CAPACITY]; /* in programs with loops: the estimated number of uses and definitions */
    uint16_t recent[IR_CAPACITY]; /* in programs with loops: the latest use before the current position */
    uint16_t
        loop_at[IR_CAPACITY]; /* by position: the loop that begins or ends there, or that a phi belongs to */
    uint16_t region_at[IR_CAPACITY]; /* by position: of a `when` its end, and of an `end` its `when` */
    uint16_t section, repeat;        /* the positions of the section's ends; 0: there is no preamble */
    bool webs;                       /* false: each value is a web */
    uint16_t web[IR_CAPACITY];       /* the first value of its web */
    uint16_t member[IR_CAPACITY];    /* the next value of its web, 0: none */
    uint16_t tail[IR_CAPACITY];      /* of a web: its last value */
    uint16_t death[IR_CAPACITY];     /* while coalescing: the last position at which it is alive */
    struct loop_extent loop[LOOP_CAPACITY];
    uint64_t free_slot[SLOT_WORDS]; /* a bit for each slot that is free */
    uint32_t slots;
    uint32_t spills; /* the number of evicted values */
    uint32_t constant_count, kept_count;
    uint16_t constant[IR_CAPACITY]; /* values that are constants and have a use */
    uint16_t kept[ALLOCATABLE];     /* those that the body has in registers */
    uint8_t unread[IR_CONSTANTS];   /* by slot of the constant table: no instruction reads it */
    struct allocate_graph graph;
};

/* Returns true if the code of this operation can read the operand from memory. */
bool allocate_folds(const struct ir_instruction *instruction, int operand);

/* Returns true if the operands keep their registers until the result is complete. */
bool allocate_keeps_operands(const struct ir_instruction *instruction);

/* Returns true if a value is in memory from the start: a literal, a slot of the constant table. */
static inline bool allocate_is_constant(const struct ir_instruction *instruction)
{
    return instruction->op == IR_literal || instruction->op == IR_constant;
}

static inline bool allocate_defines_value(const struct ir_instruction *instruction)
{
    return instruction->op != IR_nop && !(ir_properties(instruction) & IR_EFFECT);
}

/* Writes what explicit frees of temporaries would give: the last use of each value. The allocator
 * `hints` then needs no analysis. Without allocate_registers, it is a part that is measured by itself. */
void allocate_write_hints(const struct ir *ir, struct allocation *allocation,
                          const struct register_file *file);

/* The name of allocator i and one line about it; null past the last. */
const char *allocate_name(unsigned i);
const char *allocate_meaning(unsigned i);

/* Fills `allocation` for a valid, compacted program. */
void allocate_registers(const struct ir *ir, struct allocation *allocation, const struct register_file *file);

/* Returns true if the value's register is a mask register: the operation's result is a mask, or the operation
 * passes a mask on. (The type of the instruction does not decide, because andn_m is also applied to
 * integers.) */
static inline bool allocate_is_mask(const struct allocation *allocation,
                                    const struct ir_instruction *instruction)
{
    if (!allocation->wide || instruction->type != TYPE_msk)
        return false;
    switch (instruction->op) {
    case IR_copy:
    case IR_get:
    case IR_phi:
    case IR_join: return true;
    default: return ir_op_information[instruction->op].result == TYPE_msk;
    }
}

/* The number of vector registers that values can have. */
static inline unsigned allocate_most_registers(unsigned width)
{
    return (unsigned)__builtin_popcountll(width == 16 ? WIDE_REGISTERS : NARROW_REGISTERS);
}

/* The file of the first `count` vector registers, or of all if there are fewer. With 16 lanes, also of half
 * as many mask registers. */
static inline struct register_file allocate_register_file(unsigned count, unsigned width)
{
    unsigned above = count > ALLOCATABLE ? count - ALLOCATABLE : 0;
    uint64_t with = (1ull << (count - above)) - 1;
    if (above)
        with |= WIDE_REGISTERS & ((1ull << (16 + above)) - 1);
    with |= (count / 2 < 6 ? (2ull << count / 2) - 1 : MASK_REGISTERS >> MASKS) << MASKS;
    return (struct register_file){.without = count < allocate_most_registers(width) ? ~with : 0,
                                  .wide = width == 16,
                                  .scalar = width == 1};
}

/* Returns a number below `limit` if lots are drawn, else 0. */
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

/* The web of a value, named by its first value. A web's split, slot, uses and last use are those of its first
 * value; `reg` of each definition is the register that its instruction writes. */
static inline unsigned allocate_web(const struct allocation *allocation, unsigned value)
{
    return allocation->webs ? allocation->web[value] : value;
}

/* Returns true if a value of the preamble is used at `position` in the body. */
static inline bool allocate_enters_body(const struct allocation *allocation, unsigned value,
                                        uint32_t position)
{
    return value < allocation->section && position > allocation->section;
}

/* Returns true if a value, whose uses have been found, is alive in the whole body. */
static inline bool allocate_is_kept(const struct allocation *allocation, unsigned value)
{
    return value < allocation->section && allocation->last[value] == allocation->repeat;
}

/* The outermost loop that begins after position `birth` and contains loop `inner` or is it, 0: none. */
unsigned allocate_entered_loop(const struct allocation *allocation, unsigned birth, unsigned inner);

/* The position of the `end` that a join follows. */
uint32_t allocate_joined_end(const struct ir *ir, uint32_t join);

/* The allocators: they fill residence, reg, split, slot, last and slots, and count spills.
 * `registers` has a bit for each available register. Ends of regions and loops have been found. */
#define ALLOCATOR(name, ...)                                                                                 \
    void allocate_by_##name(const struct ir *ir, struct allocation *allocation, uint64_t registers);
#include "def/engine/allocator.def"
#undef ALLOCATOR

/* For allocators: finds webs, the uses of each, and which values need a register. No value has one yet. */
void allocate_find_lives(const struct ir *ir, struct allocation *allocation);

/* For the allocator `hints`: the same without webs and uses, which allocate_write_hints has found. */
void allocate_read_hints(const struct ir *ir, struct allocation *allocation);

/* For allocators: gives slots to the values that are not in a register everywhere (slot.c). */
void allocate_slots(const struct ir *ir, struct allocation *allocation);

/* Gives constants to registers that hold nothing in the body: `free` has a bit for each (keep.c). */
void allocate_keep(const struct ir *ir, struct allocation *allocation, uint64_t free);

/* Fills web, member and tail; loops and regions have been found (coalesce.c). */
void allocate_coalesce(const struct ir *ir, struct allocation *allocation);

/* Prints the live intervals as a chart. */
void allocate_print(const struct ir *ir, const struct allocation *allocation, FILE *out);

#endif
