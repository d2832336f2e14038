/* Fuzz targets: functions that take any bytes for a reader of untrusted input, and what the reader must do
 * with them: refuse them with one line, or take them for something that survives what is done with such
 * things. Plain C: the Unity program tests/command/fuzz/inputs.c runs every target over its corpus,
 * libFuzzer (fuzzer.c) over what it makes up.
 *
 * A broken promise aborts with a line, so that a fuzzer keeps the input; the rest is for the sanitizers to
 * see. */
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

/* All targets, by name; null past the last. */
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

/* A refusal: one line that begins with `path`. */
void expect_refusal(const struct error *error, const char *path);

/* A refusal at a place: PATH:LINE:COLUMN: */
void expect_refusal_at(const struct error *error, const char *path);

/* The path of a file that holds the bytes until the next call; no disk is involved. */
const char *fuzz_file(const uint8_t *data, size_t bytes);

/* A path for a file with that ending, of memory where the system has such; the caller removes the file. */
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
