/* The batch interpreter: executes the recorded pipeline one operation after the other, each over many
 * elements.
 *
 * The thesis calls this horizontal specialization (section 2.4.2): a decision is made once for an operation
 * and a batch instead of once for an element, and no code is generated. It needs only baseline x86-64. */
#ifndef EMU_BATCH_BATCH_H
#define EMU_BATCH_BATCH_H

#include "contract/engine.h"
#include "emu/batch/schedule.h"

extern const struct engine engine_batch; /* BATCH_LANES */

#define BATCH(lanes) extern const struct engine engine_batch_##lanes;
#include "def/engine/batch.def"
#undef BATCH

/* A routine for a given recording, with batches of at most `lanes` lanes. Free it with the engine's free().
 * Returns null with the reason. */
struct routine *batch_routine(const struct ir *ir, unsigned lanes, enum unit unit, const union key *key,
                              struct error *error);

/* The schedule that such a routine executes. For tests: the schedule of a routine. */
const struct schedule *batch_schedule(const struct routine *routine);

#endif
