/* What the targets of streams promise of a stream that a reader let through (survive.c). */
#ifndef FUZZ_SURVIVE_H
#define FUZZ_SURVIVE_H

#include "stream/stream.h"

/* As text and as a container it is the same stream with every byte of its resources, and the engine that needs no
 * generated code plays it, if it is small. */
void expect_survives(const struct stream *stream);

#endif
