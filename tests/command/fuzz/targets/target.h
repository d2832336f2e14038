/* Fuzz targets. A target is a function that gives any bytes to a reader of untrusted input. The reader must
 * refuse them with one line, or return an object with which the usual operations succeed. The targets are
 * plain C. The Unity program tests/command/fuzz/inputs.c runs every target on its corpus, and libFuzzer
 * (fuzzer.c) runs it on generated inputs.
 *
 * A failed check prints a line and aborts, so that a fuzzer stores the input. Sanitizers find other
 * faults. */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_TARGET_H
#define TESTS_COMMAND_FUZZ_TARGETS_TARGET_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

struct fuzz_target {
    const char *name; /* the corpus is tests/data/corpus/NAME */
    void (*run)(const uint8_t *data, size_t bytes);
};

/* Returns target number i, in the order of names, or null after the last one. */
const struct fuzz_target *fuzz_target_at(unsigned i);
const struct fuzz_target *fuzz_target_named(const char *name);

#define expect(condition, ...)                                                                               \
    do                                                                                                       \
        if (!(condition)) {                                                                                  \
            fprintf(stderr, "%s:%d: broken promise: %s: ", __FILE__, __LINE__, #condition);                  \
            fprintf(stderr, __VA_ARGS__);                                                                    \
            fputc('\n', stderr);                                                                             \
            abort();                                                                                         \
        }                                                                                                    \
    while (0)

/* Fails unless the error is a refusal: one line that begins with `path`. */
void expect_refusal(const struct error *error, const char *path);

/* Fails unless the error is a refusal at a position: a line that begins with PATH:LINE:COLUMN: */
void expect_refusal_at(const struct error *error, const char *path);

/* Returns the path of a file in memory that contains the bytes until the next call. */
const char *fuzz_file(const uint8_t *data, size_t bytes);

/* Returns a path with that ending for a file, in memory if the system has such files. The caller removes the
 * file. */
const char *fuzz_path(const char *ending);

/* Reports an event to the fuzzer that makes more inputs of its kind worthwhile. Uninstrumented libraries are
 * observed only by their refusal reasons. */
void fuzz_note(uint32_t what);

/* Streams of a target read no file while this is 0, and may read those in memory while it is 1 (limit.c). */
extern int fuzz_files;

/* The first bytes of an input as small numbers that choose options; zeros when it has ended. */
struct choices {
    const uint8_t *at, *end;
};

static inline unsigned choose(struct choices *choices, unsigned below)
{
    return choices->at < choices->end ? *choices->at++ % below : 0;
}

#endif
