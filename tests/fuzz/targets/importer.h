/* A process that imports one model after the other, for fuzzers (importer.c). */
#ifndef FUZZ_IMPORTER_H
#define FUZZ_IMPORTER_H

#include "stream/isolate.h"

enum import_end {
    IMPORT_ANSWERED, /* the answer's data is the caller's, and no larger than it is */
    IMPORT_REFUSED,  /* with a reason */
    IMPORT_DIED      /* or took too long; the next one gets a new process */
};

/* Before each input; nobody has been in Assimp then. */
void importer_prepare(void);

/* What a process of its own does with a file (stream/import.c), in one that has done it with others before. */
enum import_end importer_run(const char *path, int bones, struct answer *answer, struct error *error);

/* Whether the last process that died, of this kind or of isolate.h's, was in Assimp then. If not, this repository's own
 * code crashed. */
int importer_died_in_assimp(void);

#endif
