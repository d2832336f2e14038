/* A process that imports one model after the other, for fuzzers (importer.c). */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_IMPORTER_H
#define TESTS_COMMAND_FUZZ_TARGETS_IMPORTER_H

#include "command/assets/isolate.h"

#include <stdbool.h>

enum import_end {
    IMPORT_ANSWERED, /* the answer's data is the caller's, and no larger than it is */
    IMPORT_REFUSED,  /* with a reason */
    IMPORT_DIED      /* or took too long; the next one gets a new process */
};

/* Before each input; Assimp is not running then. */
void importer_prepare(void);

/* Imports a file as its own process does (command/assets/import.c), in a process that has imported other
 * files before. */
enum import_end importer_run(const char *path, bool bones, struct answer *answer, struct error *error);

/* Returns true if the last process that died, of this kind or of isolate.h's, was in Assimp then. If not, the
 * code of this repository crashed. */
int importer_died_in_assimp(void);

#endif
