/* A schedule: the recording of one routine as an array of steps over rows, as the batch interpreter executes
 * it.
 *
 * A batch is at most `lanes` lanes in groups of four. A step computes one operation for the whole batch
 * before the next step begins. A value is a row of the scratch memory: the words of all lanes, one group
 * after the other. A group is one of the emulator's four-lane values (emu/emulate/bind.h). Values that are
 * the same in all lanes of any batch have only one group. These are literals, words of the draw, and results
 * computed only from them. Operands advance through their rows by 16 bytes or by none.
 *
 * Values whose lifetimes do not overlap share rows, by a linear scan over the recording. A value from outside
 * a loop that is used in the loop keeps its row until the loop ends. Each variable has a row of its own. The
 * scratch memory stays small, and its size decides which number of lanes is the fastest (thesis, section
 * 2.4.2). Each run of the routine writes the literals to the first groups.
 *
 * Memory operations have an address for each group: the four lanes of a group are consecutive, but the groups
 * of a batch may belong to different triangles and blocks. */
#ifndef EMU_BATCH_SCHEDULE_H
#define EMU_BATCH_SCHEDULE_H

#include "base/error.h"
#include "ir/ir.h"

#include <stdbool.h>

enum {
    BATCH_MAXIMUM = 256, /* lanes */
    GROUP_LANES = 4,
    GROUP_BYTES = GROUP_LANES * 4,
    GROUPS_MAXIMUM = BATCH_MAXIMUM / GROUP_LANES,
    SCRATCH_LIMIT = 1 << 20 /* bytes: a routine that needs more uses fewer lanes */
};

/* One batch during its execution. */
struct batch {
    uint8_t *scratch;
    unsigned groups[2]; /* the number of groups; of a value that is the same in all lanes: 1 */
    const uint8_t *base[BASE_COUNT][GROUPS_MAXIMUM];
};

struct schedule_step;

/* Executes a step. Returns the next one, null at the end. */
typedef const struct schedule_step *step_function(struct batch *batch, const struct schedule_step *step);

struct schedule_step {
    step_function *run;
    uint32_t to; /* byte offsets of rows in the scratch memory */
    uint32_t operand[3];
    uint8_t stride[3]; /* of the operands: GROUP_BYTES or 0 */
    uint8_t once;      /* 1: the result has one group */
    uint8_t base;
    uint8_t scale;
    int32_t k; /* when: steps to skip; again: steps to go back; else as in ir.h */
    int32_t field;
};

struct schedule {
    unsigned lanes;         /* of a batch */
    uint32_t scratch_bytes; /* a multiple of 64 */
    uint32_t literals;      /* groups at the beginning of the scratch memory */
    uint32_t count;
    bool
        counts; /* the routine counts pixels: no two groups of a batch may be the same quad of their blocks */
    int32_t *literal;
    struct schedule_step step[];
};

/* Schedules a recording for batches of at most `lanes` lanes, with steps for pairs if `fuses`. `numbers`,
 * unless null, has room for a number for each instruction, and receives the instruction of each step, of a
 * pair the second. Returns null with the reason. */
struct schedule *schedule_create(const struct ir *ir, unsigned lanes, bool fuses, uint16_t *numbers,
                                 struct error *error);
void schedule_free(struct schedule *schedule);

/* Writes the literals to the beginning of the scratch memory. */
void schedule_start(const struct schedule *schedule, uint8_t *scratch);

/* Executes one batch under the caller's MXCSR. */
void schedule_run(const struct schedule *schedule, struct batch *batch);

/* The function that executes the opcode (step.c); null for opcodes without a step. */
step_function *schedule_step_of(enum ir_op op);

/* The function that executes both opcodes as one step, if the second has the first's result as its operand
 * `position`; null if they are not a row of def/engine/pair.def. */
step_function *schedule_pair_of(enum ir_op first, enum ir_op second, int position);
const struct schedule_step *schedule_step_end(struct batch *batch, const struct schedule_step *step);

#endif
