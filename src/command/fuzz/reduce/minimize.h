/* Reduces a failing draw stream to the parts that it needs to fail.
 *
 * Delta debugging (Zeller and Hildebrandt: Simplifying and Isolating Failure-Inducing Input, 2002) over the
 * structure of the text instead of its bytes: calls, whole resources and their uses, lines and items of
 * blocks, attributes of vertices, pairs of flow control in shaders, clauses of calls. Draws get fewer
 * primitives, textures and targets fewer texels, formats and operands become plain, numbers 0 or 1. The
 * passes repeat until none of them finds a reduction or the limit of tries is reached. A candidate that is
 * not a valid stream costs one try: only the test decides if a text is a stream.
 *
 * Deterministic: the same text and a deterministic test give the same result. */
#ifndef COMMAND_FUZZ_REDUCE_MINIMIZE_H
#define COMMAND_FUZZ_REDUCE_MINIMIZE_H

#include "base/error.h"
#include "command/fuzz/case/text.h"

#include <stdbool.h>

enum { MINIMIZE_TRIES = 20000 };

/* Returns true if the text still fails in the same way. A zero follows the bytes. A test that gives up
 * returns false from then on. */
typedef bool minimize_test(void *user, const char *text, size_t bytes);

/* The result. */
struct minimized {
    unsigned tries;  /* calls of the test */
    unsigned rounds; /* of all passes */
    bool complete;   /* nothing more was found; else the tries were used up */
};

/* Writes the smallest text found to `smallest`, which is empty before. It has failed the test itself. At
 * most `tries` calls of the test (0: MINIMIZE_TRIES). `minimized` can be null. Returns 0, or -1 with the
 * reason: the text does not fail, no memory. */
int minimize(const char *text, size_t bytes, minimize_test *still_fails, void *user, unsigned tries,
             struct text *smallest, struct minimized *minimized, struct error *error);

#endif
