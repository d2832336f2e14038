/* The calls of a whole stream in the order in which they are executed, and its frames. */
#include "command/stream/expand.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* --- Expansion ------------------------------------------------------------------------------------------ */

struct expansion {
    struct stream *stream;
    uint32_t frame_capacity;
    struct error *error;
};

/* During the expansion frames[f] is the end of frame f. */
static int add_frame(void *user, const struct call *call)
{
    struct expansion *expansion = user;
    struct stream *stream = expansion->stream;
    if (stream->frame_count == LIMIT_FRAMES) {
        struct error reason = {{0}};
        error_set(&reason, "found one more frame, expected at most %d", LIMIT_FRAMES);
        return stream_fail(stream, call, reason.text, expansion->error);
    }
    if (stream->frame_count + 2 > expansion->frame_capacity) {
        uint32_t capacity = 2 * expansion->frame_capacity + 16;
        uint32_t *larger = realloc(stream->frames, capacity * sizeof *larger);
        if (!larger)
            return stream_fail(stream, call, "not enough memory", expansion->error);
        stream->frames = larger;
        expansion->frame_capacity = capacity;
    }
    stream->frames[stream->frame_count++] = stream->executed_count;
    return 0;
}

static int stream_expand_calls(struct stream *stream, uint32_t first, uint32_t last,
                               stream_frame_function *frame, void *user)
{
    for (uint32_t i = first; i < last; i++) {
        const struct call *call = &stream->calls[i];
        if (call->type == CALL_SEQUENCE) {
            i += call->sequence.count;
        } else if (call->type == CALL_FRAME) {
            if (frame && frame(user, call))
                return -1;
        } else if (call->type == CALL_PLAY) {
            uint32_t begin = stream->resources[call->resource].call + 1;
            if (stream_expand_calls(stream, begin, begin + stream->calls[begin - 1].sequence.count, frame,
                                    user))
                return -1;
        } else {
            stream->executed[stream->executed_count++] = i;
        }
    }
    return 0;
}

/* `most` counts plays and frames too, so there is enough room. */
int stream_expand(struct stream *stream, uint32_t most, struct error *error)
{
    struct expansion expansion = {.stream = stream, .error = error};
    stream->executed = malloc((most + 1) * sizeof *stream->executed);
    if (!stream->executed)
        return error_set(error, "%s: not enough memory", stream->path);
    if (stream_expand_calls(stream, 0, stream->call_count, add_frame, &expansion))
        return -1;
    uint32_t ended = stream->frame_count ? stream->frames[stream->frame_count - 1] : 0;
    if (stream->executed_count > ended && add_frame(&expansion, &stream->calls[stream->call_count - 1]))
        return -1;
    if (!stream->frame_count)
        return 0;
    memmove(stream->frames + 1, stream->frames, stream->frame_count * sizeof *stream->frames);
    stream->frames[0] = 0;
    return 0;
}
