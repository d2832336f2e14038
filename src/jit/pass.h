/* The passes over the IR and the list of them. Each file that implements one says what it requires and
 * leaves.
 *
 * All keep the IR valid (ir_verify) and its meaning to the bit; each returns how many instructions it
 * changed. */
#ifndef JIT_PASS_H
#define JIT_PASS_H

#include "ir/ir.h"

enum pass {
#define PASS(name, profile, meaning) PASS_##name,
#include "def/pass.def"
#undef PASS
    PASS_COUNT
};

enum profile { PROFILE_THESIS, PROFILE_FULL };

/* What is known of a value without running it: bounds (of flt and itg; all values when unknown), whether a
 * flt may be NaN, -0 or a denormal. Bounds of a flt are those of its non-NaN values. */
struct range {
    float low, high; /* for itg too: rounded outward */
    uint8_t nan;
    uint8_t minus_zero;
    uint8_t denormal; /* a flt whose bits may be a denormal's */
};

enum { PASS_TABLE = 2 * (IR_CAPACITY + 1) }; /* a power of two */

enum { PHI_CHANGES = 2 * IR_CAPACITY, PASS_LOOPS = IR_CAPACITY / 2 + 1 };

/* A variable that an open region has changed, and the value it held before; the phi, if that was the
 * change. */
struct phi_change {
    uint16_t variable, value, phi;
};

struct phi_region {
    uint32_t changes; /* there were when it began */
};

/* Of the construction of phis (phi.c): what the walk over the program remembers. */
struct phi_memory {
    uint64_t sets[PASS_LOOPS][VARIABLES / 64]; /* a bit for each variable that a loop sets */
    uint16_t outer[PASS_LOOPS];                /* the loop around a loop, 0: none */
    uint16_t held[VARIABLES];                  /* by each variable now, 0: nothing */
    uint8_t type[VARIABLES];
    uint8_t seen[VARIABLES];
    struct phi_region region[IR_CAPACITY];
    struct phi_change change[PHI_CHANGES];
};

/* Of loop-invariant motion (invariant.c), by instruction and by loop. */
struct invariant_memory {
    uint16_t home[IR_CAPACITY];      /* the innermost loop that a value changes with */
    uint16_t following[IR_CAPACITY]; /* what is moved to the same place after it, 0: nothing */
    uint16_t around[IR_CAPACITY];    /* the `when` around a `when` */
    uint8_t moves[IR_CAPACITY];
    uint16_t outer[PASS_LOOPS]; /* the loop around a loop */
    uint16_t first[PASS_LOOPS]; /* and last of what is moved before it, 0: none */
    uint16_t last[PASS_LOOPS];
    uint8_t open[PASS_LOOPS];
};

/* Of preloading (preload.c), by copy from 1 and by loop. */
struct preload_memory {
    uint16_t source[IR_CAPACITY];
    uint16_t following[IR_CAPACITY]; /* another copy before the same loop, 0: none */
    uint16_t number[IR_CAPACITY];    /* of the copy in the new program */
    uint16_t outer[PASS_LOOPS];
    uint16_t first[PASS_LOOPS];
    uint16_t start[PASS_LOOPS]; /* where a loop with its phis begins */
};

/* Scratch memory of the passes, one per build. */
struct pass_memory {
    unsigned lanes; /* that the routine will have, if that is known */
    struct range range[IR_CAPACITY];
    uint16_t map[IR_CAPACITY];
    uint16_t region[IR_CAPACITY];
    uint16_t same[IR_CAPACITY];
    uint8_t flag[IR_CAPACITY];
    uint8_t read[VARIABLES];
    struct phi_memory phi;
    struct invariant_memory invariant;
    struct preload_memory preload;
    struct ir_instruction rebuilt[IR_CAPACITY]; /* of the passes that add or move */
    uint16_t table[PASS_TABLE];
};

typedef unsigned pass_function(struct ir *ir, struct pass_memory *memory);

pass_function pass_phi, pass_copy, pass_fold, pass_reduce, pass_common, pass_dead, pass_invariant, pass_hoist,
    pass_preload, pass_wide, pass_window;

/* Fills memory->range for every value (range.c). Rounds as the contract does: run under its MXCSR. */
void range_analyse(const struct ir *ir, struct pass_memory *memory);

/* The same for single values, of a program that may be reduced meanwhile: after `begin`, memory->range of a value holds
 * once it was demanded; memory->flag tells of which that was, and memory->table is in use. */
void range_begin(const struct ir *ir, struct pass_memory *memory);
void range_demand(const struct ir *ir, struct pass_memory *memory, unsigned value);

/* The range of an instruction's operand, as the type that the operation takes it for: after copy propagation
 * through a cast the value may be of another, of which its range says nothing. */
struct range range_of_operand(const struct ir *ir, const struct pass_memory *memory,
                              const struct ir_instruction *instruction, int operand);

/* Called after each pass that changed something. */
typedef void pass_observer(void *context, enum pass pass, const struct ir *ir);

/* Runs the profile's passes except those whose bit is set in `disabled`; ends compacted. Returns the rounds.
 */
unsigned optimize(struct ir *ir, struct pass_memory *memory, enum profile profile, uint32_t disabled,
                  pass_observer *observer, void *context);

#endif
