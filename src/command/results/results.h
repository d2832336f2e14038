/* Results of campaigns, read again from JSON: to continue a campaign, or to merge the results of its shards.
 *
 * A campaign has numbered units of work (command/support/shard.h):
 *
 *   fuzz            a unit is a case; its number is that of the case
 *   verify          a stream with an engine: number of the stream * engines + number of the engine
 *   bench, claims   a stream; a claim
 *
 * A file has "command", "machine" with the commit, the fields that determine the results (results_kind.same),
 * and the results of some units. Those of fuzz are counts, with the numbers of the cases in "done". The
 * others have an array of entries. Such a file has the names of all streams or claims in "inputs". An entry
 * has its position there as "number", or only its name. Entries that are incomplete, because the command was
 * interrupted, do not count.
 *
 * A file can contain anything: results_load checks every value that this module, the merging of results and
 * their continuation use. */
#ifndef COMMAND_RESULTS_RESULTS_H
#define COMMAND_RESULTS_RESULTS_H

#include "command/support/json.h"
#include "command/results/ranges.h"

#include <stdint.h>

struct results_kind {
    const char *command;
    const char *unit;        /* for messages: "case" */
    const char *const *same; /* the fields that determine the results; null after the last */
    const char *entries;     /* the array of entries; null: counts */
    const char *name;        /* the field of an entry that is in "inputs" */
    bool engines;            /* an entry has some of the engines */
};

struct results {
    const char *path;
    const struct results_kind *kind;
    cJSON *json;
    uint64_t first, count; /* the units of the whole campaign */
    struct ranges done;
};

/* Reads and checks a file. Returns 0, or STATUS_BAD after printing the reason. Free it in both cases. */
int results_load(const struct command *self, const char *path, struct results *results);

/* The same for a value, which the results own from now on. The path is for messages. */
int results_take(const struct command *self, const char *path, cJSON *json, struct results *results);
void results_free(struct results *results);

/* Compares the commands, the commits and the fields that determine results. Returns 0, or STATUS_BAD after
 * printing the first difference. */
int results_match(const struct command *self, const struct results *a, const struct results *b);

/* Reads the file that a command continues with --resume. `fresh` has its fields without results. The shard
 * must be the same too. *found is false if there is no file; the results are then empty. */
int results_resume(const struct command *self, const char *path, const struct results *fresh,
                   struct results *results, bool *found);

/* The outcomes of fuzz, in order, null after the last; and the index of the first that is a finding. */
extern const char *const results_outcomes[];
enum { RESULTS_FINDING = 3 };

/* The position of the entry in "inputs"; -1 if it has none. */
int64_t results_number(const struct results *results, const cJSON *entry);

/* Returns true if the entry is complete. */
bool results_complete(const cJSON *entry);

/* The position of the engine in "engines", an array of names or of objects with names; -1 if it has none. */
int results_engine(const cJSON *engines, const char *name);
unsigned results_engine_count(const struct results *results);

/* The value of a text field, or "". */
const char *results_text(const cJSON *object, const char *field);

/* The value of a numeric field; 0 if there is none. */
double results_value(const cJSON *object, const char *field);

#endif
