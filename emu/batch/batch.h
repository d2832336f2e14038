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

/* Returns true for batch and its variants, of any number of lanes. */
bool batch_is_engine(const struct engine *engine);

/* Returns true for an engine of batch with the option fuse=products. */
bool batch_fuses(const struct engine *engine);

/* The options of variants (engines/variant.h), as those of specialize.h. */
void *batch_copy_options(const struct engine *engine);
#define VARIANT(name, ...) int batch_set_##name(void *options, const char *value, struct error *error);
#include "def/engine/batch_option.def"
#undef VARIANT

/* A routine for a given recording, with batches of at most `lanes` lanes, and with steps for pairs of
 * operations (def/engine/pair.def) if `fuses`. Free it with the engine's free(). Returns null with the
 * reason. */
struct routine *batch_routine(const struct ir *ir, unsigned lanes, bool fuses, enum unit unit,
                              const union key *key, struct error *error);

/* The schedule that such a routine executes. For tests: the schedule of a routine. */
const struct schedule *batch_schedule(const struct routine *routine);

#endif
