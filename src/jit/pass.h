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

/* Scratch memory of the passes, one per build. */
struct pass_memory {
    struct range range[IR_CAPACITY];
    uint16_t map[IR_CAPACITY];
    uint16_t region[IR_CAPACITY];
    uint8_t flag[IR_CAPACITY];
    uint8_t read[VARIABLES];
    uint16_t table[PASS_TABLE];
};

typedef unsigned pass_function(struct ir *ir, struct pass_memory *memory);

pass_function pass_copy, pass_fold, pass_reduce, pass_common, pass_dead, pass_hoist;

/* Fills memory->range for every value (range.c). Rounds as the contract does: run under its MXCSR. */
void range_analyse(const struct ir *ir, struct pass_memory *memory);

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
