/* The batch interpreter: the recorded pipeline, one operation after the other over many elements at a time.
 *
 * This is what the thesis calls horizontal specialization (section 2.4.2): decisions are taken once per
 * operation and batch instead of once per element, without generating code. It needs nothing but baseline
 * x86-64. */
#ifndef EMU_BATCH_H
#define EMU_BATCH_H

#include "draw/engine.h"
#include "emu/plan.h"

extern const struct engine engine_batch; /* BATCH_LANES */

#define BATCH(lanes) extern const struct engine engine_batch_##lanes;
#include "def/batch.def"
#undef BATCH

/* A routine for a recording instead of a key's, of at most `lanes` lanes a batch; free it like the engine's.
 * Null with the reason. */
struct routine *batch_routine(const struct ir *ir, unsigned lanes, enum unit unit, const union key *key,
                              struct error *error);

/* What such a routine executes. */
const struct plan *batch_plan(const struct routine *routine);

#endif
