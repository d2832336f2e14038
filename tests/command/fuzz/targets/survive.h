/* Checks of a stream that a reader accepted, for the fuzz targets of streams (survive.c). */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_SURVIVE_H
#define TESTS_COMMAND_FUZZ_TARGETS_SURVIVE_H

#include "command/stream/stream.h"

/* Writes the stream as text and as a container and reads it again, which must not change it or any byte of
 * its resources. If the stream is small, an engine without generated code plays it. */
void expect_survives(const struct stream *stream);

/* Returns true if playing it takes at most about a millisecond. */
int is_small_resource(const struct resource *resource);
int is_small_call(const struct stream *stream, const struct call *call);

#endif
