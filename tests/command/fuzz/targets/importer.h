/* A process that imports one model after the other, for fuzzers (importer.c). */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_IMPORTER_H
#define TESTS_COMMAND_FUZZ_TARGETS_IMPORTER_H

#include "command/import/isolate.h"

#include <stdbool.h>

enum import_end {
    IMPORT_ANSWERED, /* the caller frees the answer's data, whose memory has exactly their size */
    IMPORT_REFUSED,  /* with a reason */
    IMPORT_DIED      /* the process crashed or needed too long; the next import starts a new process */
};

/* Call this before each input. It records that Assimp is not running. */
void importer_prepare(void);

/* Imports a file as its own process does (command/assets/import.c), in a process that has imported other
 * files before. */
enum import_end importer_run(const char *path, unsigned parts, struct answer *answer, struct error *error);

/* Returns 1 if the last process that died, one of this file or of isolate.h, was executing Assimp. Otherwise
 * the code of this repository crashed. */
int importer_died_in_assimp(void);

#endif
