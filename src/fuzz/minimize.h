/* Makes a failing draw stream small: what is left of its text is what it takes to fail.
 *
 * Delta debugging (Zeller and Hildebrandt: Simplifying and Isolating Failure-Inducing Input, 2002) over the text's
 * structure instead of its bytes: calls, whole resources and their uses, lines and items of blocks, attributes of
 * vertices, pairs of flow control in shaders, clauses of calls; draws get fewer primitives, textures and targets
 * fewer texels, formats and operands become plain, numbers 0 or 1. The passes go round until none of them finds
 * anything, or until so many texts have been tried. Candidates that are no valid stream cost a try and nothing
 * else: the test is what knows what a stream is.
 *
 * Deterministic: the same text and a test that answers alike give the same result. */
#ifndef FUZZ_MINIMIZE_H
#define FUZZ_MINIMIZE_H

#include "base/error.h"
#include "fuzz/text.h"

#include <stdbool.h>

enum { MINIMIZE_TRIES = 20000 };

/* Whether the text still fails in the same way. The bytes are followed by a zero. Who runs out of patience answers
 * false from then on. */
typedef bool minimize_test(void *user, const char *text, size_t bytes);

/* What became of it. */
struct minimized {
    unsigned tries;  /* calls of the test */
    unsigned rounds; /* of all passes */
    bool complete;   /* nothing more was found; else the tries were used up */
};

/* Writes the smallest text found to `smallest`, which is empty before. It has failed the test itself. At most
 * `tries` calls of the test (0: MINIMIZE_TRIES). `minimized` can be null. Returns 0, or -1 with the reason: the
 * text does not fail, no memory. */
int minimize(const char *text, size_t bytes, minimize_test *still_fails, void *user, unsigned tries,
             struct text *smallest, struct minimized *minimized, struct error *error);

#endif
