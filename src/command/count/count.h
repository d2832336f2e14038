/* `triptych bench --counts`: what the frames of streams need of the cache and of the tiers. */
#ifndef COMMAND_COUNT_COUNT_H
#define COMMAND_COUNT_COUNT_H

#include "command/support/choose.h"
#include "command/support/json.h"
#include "setting/setting.h"

struct count_settings {
    unsigned threads, frames; /* frames: 0 for all of a stream */
    unsigned budget_kib;      /* of the cache; 0: the usual one */
    struct setting_values renderer;
};

/* Plays the first frames of each stream once on a new device of each engine, and prints by unit: keys, hits,
 * misses, evictions, what is left in the cache, the times of lookups and builds; and by tier of a tiered
 * engine: runs, builds, drops. `report` receives all of this, histograms, and the states of each frame, as
 * its member `counts`. Returns 0, or STATUS_BAD after a message. */
int count_all(const struct command *self, char **paths, unsigned count, const struct choice *engines,
              const struct count_settings *settings, cJSON *report);

#endif
