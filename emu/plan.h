/* What the batch interpreter executes: the recording of one routine as an array of steps over rows.
 *
 * A batch is up to `lanes` lanes in groups of four. A step computes one operation for the whole batch before
 * the next step begins. A value is a row of the frame: the lanes' words, group behind group, each group one
 * of the emulator's four-lane values (emu/bind.h). Values that are the same in all lanes of any batch
 * (literals, words of the draw, and what is computed from these alone) have one group only, and operands
 * advance through their rows by 16 bytes or by none.
 *
 * Rows are shared by values that are not needed at the same time, by a linear scan over the recording; a
 * value that a loop needs from outside keeps its row until the loop ends; each variable has a row of its own.
 * So what a batch works on stays small, which is what decides how many lanes are best (thesis, section
 * 2.4.2). Literals are written at the head of the frame once a call.
 *
 * Memory operations take their address for each group: four lanes of a quad are always consecutive, but the
 * groups of a batch may be of different triangles and blocks. */
#ifndef EMU_PLAN_H
#define EMU_PLAN_H

#include "base/error.h"
#include "ir/ir.h"

enum {
    BATCH_MAXIMUM = 256, /* lanes */
    GROUP_LANES = 4,
    GROUP_BYTES = GROUP_LANES * 4,
    GROUPS_MAXIMUM = BATCH_MAXIMUM / GROUP_LANES,
    FRAME_LIMIT = 1 << 20 /* bytes: routines with so many rows take fewer lanes */
};

/* One batch being executed. */
struct batch {
    uint8_t *frame;
    unsigned groups[2]; /* how many there are; of a value that is the same in all: 1 */
    const uint8_t *base[BASE_COUNT][GROUPS_MAXIMUM];
};

struct plan_step;

/* Executes a step and returns the next one, null at the end. */
typedef const struct plan_step *step_function(struct batch *batch, const struct plan_step *step);

struct plan_step {
    step_function *run;
    uint32_t to; /* byte offsets of rows in the frame */
    uint32_t operand[3];
    uint8_t stride[3]; /* of the operands: GROUP_BYTES or 0 */
    uint8_t once;      /* 1: the result has one group */
    uint8_t base;
    uint8_t scale;
    int32_t k; /* when: steps to skip; again: steps to go back; else as in ir.h */
    int32_t field;
};

struct plan {
    unsigned lanes;       /* of a batch */
    uint32_t frame_bytes; /* for so many lanes; a multiple of 64 */
    uint32_t literals;    /* groups at the head of the frame */
    uint32_t count;
    int counts; /* adds up in the lane table: no two groups of a batch may be at the same place of a block */
    int32_t *literal;
    struct plan_step step[];
};

/* Plans a recording for batches of at most `lanes`; null with the reason. */
struct plan *plan_create(const struct ir *ir, unsigned lanes, struct error *error);
void plan_free(struct plan *plan);

/* Writes the literals to the head of a frame. */
void plan_start(const struct plan *plan, uint8_t *frame);

/* Executes one batch under the caller's MXCSR. */
void plan_run(const struct plan *plan, struct batch *batch);

/* What executes the opcode (step.c); null for those that are no step. */
step_function *plan_step_of(enum ir_op op);
const struct plan_step *plan_step_end(struct batch *batch, const struct plan_step *step);

#endif
