/* The order in which the calls of a stream are executed. */
#ifndef COMMAND_STREAM_EXPAND_H
#define COMMAND_STREAM_EXPAND_H

#include "command/stream/stream.h"

/* Fills `executed`, with room for `most` numbers, and `frames` of a whole stream. It may have no frame. */
int stream_expand(struct stream *stream, uint32_t most, struct error *error);

/* Appends the numbers of calls `first` to `last` - 1, with plays expanded, to `executed`, which has room for
 * them. Calls the function, which may be null, at the end of each frame. */
typedef int stream_frame_function(void *user, const struct call *call);
#endif
