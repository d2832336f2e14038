/* The checks of the targets of streams on a stream that a reader accepted (survive.c). */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_SURVIVE_H
#define TESTS_COMMAND_FUZZ_TARGETS_SURVIVE_H

#include "command/stream/stream.h"

/* As text and as a container it is the same stream with every byte of its resources, and the engine that
 * needs no generated code plays it, if it is small. */
void expect_survives(const struct stream *stream);

/* Returns true if playing it takes at most about a millisecond. */
int is_small_resource(const struct resource *resource);
int is_small_call(const struct stream *stream, const struct call *call);

#endif
