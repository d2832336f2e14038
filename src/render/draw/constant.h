/* Constants of shaders as recorded draws have them: blocks in memory that lasts until the draws are rendered.
 *
 * A block is what program_write_constants makes of the state's registers. It never changes; draws share it
 * until their shader, or a constant that it reads, is another. The memory is bounded: when blocks do not
 * fit any more, what is recorded must be rendered first. There are two of it, so that draws can be
 * recorded meanwhile. */
#ifndef RENDER_DRAW_CONSTANT_H
#define RENDER_DRAW_CONSTANT_H

#include "contract/job.h"
#include "render/state/state.h"

#include <stdbool.h>

/* Enough for a full queue of shaders of a hardware's models, which read 4 KiB of constants at most, and
 * for the largest blocks of both stages. */
enum { CONSTANT_BYTES = 8 << 20 };

struct constants {
    uint8_t *memory; /* twice CONSTANT_BYTES; null before the first shader */
    size_t half;     /* where the half begins that is written: 0 or CONSTANT_BYTES */
    size_t used;     /* of it */
    const struct program *program[SHADER_STAGES]; /* whose block is the newest one; null: there is none */
    const float *block[SHADER_STAGES];
    uint64_t number[SHADER_STAGES]; /* of that block: how many the stage has had. Memory is reused, numbers
                                       are not */
};

/* Memory, if there is none yet. Returns 0, or -1 with the reason. */
int constants_create(struct constants *constants, struct error *error);
void constants_destroy(struct constants *constants);

/* Returns true if the blocks of a draw with this state fit. They always do after constants_reset. */
bool constants_fit(const struct constants *constants, const struct state *state);

/* The block of a draw's stage with this state, which fits: the newest one if it is right. Null without
 * shader. */
const float *constants_block(struct constants *constants, const struct state *state, int stage);

/* Room for other data of the draws, aligned as the blocks are; null if it does not fit. After constants_reset
 * CONSTANT_BYTES fit. */
void *constants_take(struct constants *constants, size_t bytes);

/* A constant of that stage has changed: its newest block is not that of later draws. */
void constants_changed(struct constants *constants, unsigned stage);

/* Drops the blocks of the half that is written. */
void constants_reset(struct constants *constants);
/* Drops the blocks of the other half, which is written from now on. */
void constants_exchange(struct constants *constants);

#endif
