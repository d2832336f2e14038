/* The keys of a draw come from the renderer: a device executes the states that precede the draw, and the draw
 * itself, but no other draws. The only routines that it builds are then those of the draw. */
#include "command/support/session.h"

#include <stdlib.h>
#include <string.h>

static bool is_clear(const struct stream *stream, uint32_t position)
{
    return call_clear_values(&stream->calls[stream->executed[position]]) != NULL;
}

int session_find_draw(const struct command *self, const struct stream *stream, unsigned frame, unsigned draw,
                      uint32_t *position)
{
    if (frame >= stream->frame_count)
        return tool_fail(self, "%s has no frame %u, its last is %u", stream->path, frame,
                         stream->frame_count - 1);
    unsigned draws = 0;
    for (uint32_t i = stream->frames[frame]; i < stream->frames[frame + 1]; i++)
        if (stream_draws_at(stream, i) && draws++ == draw)
            return *position = i, STATUS_OK;
    return tool_fail(self, "%s: frame %u has no draw %u, it has %u, from 0", stream->path, frame, draw,
                     draws);
}

/* A copy of the stream with one frame: all calls up to the draw, without other draws and clears. The arrays
 * `executed` and `frames` belong to the copy; the rest is shared. */
static struct stream single_draw(const struct stream *stream, uint32_t draw, uint32_t *executed,
                                 uint32_t frames[static 2])
{
    struct stream view = *stream;
    view.executed = executed;
    view.executed_count = 0;
    for (uint32_t i = 0; i <= draw; i++)
        if (i == draw || (!stream_draws_at(stream, i) && !is_clear(stream, i)))
            executed[view.executed_count++] = stream->executed[i];
    view.frames = frames;
    view.frame_count = 1;
    frames[0] = 0;
    frames[1] = view.executed_count;
    return view;
}

/* The key of the unit's routine, among those that the session's device has built. */
static int find_key(const struct command *self, const struct session *session, enum unit unit, union key *key)
{
    struct triptych_routine_info info;
    for (unsigned i = 0; triptych_get_routine(session->device, i, &info); i++) {
        const char *where;
        if (strcmp(info.unit, unit_name[unit]))
            continue;
        if (key_parse(unit, info.key, key, &where))
            return tool_fail(self, "the key of routine %u cannot be read at \"%s\"", info.number, where);
        return STATUS_OK;
    }
    return tool_fail(self, "the draw has no %s routine: it covers no pixels", unit_name[unit]);
}

int session_read_key(const struct command *self, const struct stream *stream, uint32_t draw, unsigned engine,
                     const struct setting_values *settings, enum unit unit, union key *key)
{
    uint32_t frames[2], *executed = malloc((draw + 1) * sizeof *executed);
    if (!executed)
        return tool_fail(self, "no memory for %u calls", draw + 1);
    struct stream view = single_draw(stream, draw, executed, frames);
    struct session session = {0};
    int status = session_open(self, &view, engine, 1, settings, &session);
    if (!status)
        status = session_play(self, &session, 0);
    if (!status)
        status = find_key(self, &session, unit, key);
    session_close(&session);
    free(executed);
    return status;
}
