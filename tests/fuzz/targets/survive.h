/* What the targets of streams promise of a stream that a reader let through (survive.c). */
#ifndef FUZZ_SURVIVE_H
#define FUZZ_SURVIVE_H

#include "stream/stream.h"

/* As text and as a container it is the same stream with every byte of its resources, and the engine that needs no
 * generated code plays it, if it is small. */
void expect_survives(const struct stream *stream);

/* Whether it takes no more than a millisecond or so of a player's time. */
int is_small_resource(const struct resource *resource);
int is_small_call(const struct stream *stream, const struct call *call);

#endif
