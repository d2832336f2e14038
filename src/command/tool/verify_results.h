/* The results of `triptych verify` as JSON: its units of work, which are streams with engines
 * (command/results/results.h), in shards, and continued after an interruption. */
#ifndef COMMAND_TOOL_VERIFY_RESULTS_H
#define COMMAND_TOOL_VERIFY_RESULTS_H

#include "command/bench/execution.h"
#include "command/results/results.h"
#include "command/support/choose.h"
#include "command/support/command.h"
#include "command/support/difference.h"
#include "command/support/shard.h"
#include "command/tool/golden.h"

struct verify_results {
    const struct command *self;
    const struct operands *operands; /* all streams of the campaign */
    const struct choice *engines, *threads;
    const struct settings_choice *renderer;
    const struct golden *golden;
    unsigned frames; /* 0: all */
    unsigned shuffle;
    struct shard shard;
    const char *path, *resume; /* of the files; may be null */

    /* From verify_results_begin on. */
    cJSON *streams;               /* the entries; null if no file is written */
    struct execution *executions; /* CHOICE_CAPACITY of them, indexed like `engines` */
    struct results earlier;       /* of the file that is continued */
    unsigned different;           /* streams of the earlier results that differ */
};

/* The result of the comparisons: unknown if no stream is complete and none has a difference. */
enum verify_verdict { VERIFY_UNKNOWN, VERIFY_IDENTICAL, VERIFY_DIFFERENT };

/* Reads the results to continue, if there are any. Returns 0, or STATUS_BAD after printing the reason. */
int verify_results_begin(struct verify_results *results);
void verify_results_free(struct verify_results *results);

/* Sets selected[i] if the shard has that stream with engine i of `engines`, and no earlier result. Returns
 * the number of these engines. */
unsigned verify_results_select(const struct verify_results *results, unsigned stream,
                               bool selected[CHOICE_CAPACITY]);

/* Adds an entry for the stream with the selected engines; it has no fields of results yet. */
cJSON *verify_results_add(struct verify_results *results, unsigned stream, const char *name,
                          const bool selected[CHOICE_CAPACITY]);

/* Adds the first difference of an engine with a number of threads and settings of the renderer. */
void verify_results_difference(cJSON *differences, const char *engine, unsigned threads, const char *settings,
                               unsigned frame, const struct difference *difference, const char *text);

/* Writes the file of --resume, after each stream; and, at the end, both files. `interrupted` is the name of
 * the signal, or null. Both return 0, or STATUS_BAD after printing the reason. */
int verify_results_keep(const struct verify_results *results, enum verify_verdict verdict);
int verify_results_write(const struct verify_results *results, enum verify_verdict verdict,
                         const char *interrupted);

/* Adds the field "identical": null for an unknown verdict. */
void verify_results_verdict(cJSON *json, enum verify_verdict verdict);

#endif
