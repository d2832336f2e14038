/* Recordings that are read while they are played. A resource is created on the device when the reader reaches
 * its definition, and destroyed at its release. Buffers are created when they are bound: most buffers of
 * recordings are the data of one update, for which the device needs no buffer. Going back starts again at the
 * beginning. */
#include "command/play/play_part.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static int fail(const struct player *player, const char *what, struct error *error)
{
    return error_set(error, "%s: %s: %s", player->stream->path, what, triptych_error(player->device));
}

static int reserve(struct player *player, struct error *error)
{
    uint32_t count = player->stream->resource_count;
    if (count <= player->handle_count)
        return 0;
    struct handles *larger = realloc(player->handles, (count + 1) * sizeof *larger);
    if (!larger)
        return error_set(error, "%s: not enough memory", player->stream->path);
    memset(larger + player->handle_count, 0, (count - player->handle_count) * sizeof *larger);
    player->handles = larger;
    player->handle_count = count;
    return 0;
}

static int define(struct player *player, uint32_t number, struct error *error)
{
    const struct resource *resource = &player->stream->resources[number];
    if (reserve(player, error))
        return -1;
    player->handles[number] = (struct handles){.frame = NOWHERE};
    if (resource->type == RESOURCE_BUFFER)
        return 0;
    if (player_create(player->device, resource, &player->handles[number]))
        return fail(player, resource->name, error);
    reader_drop_texels(player->reader, number);
    return 0;
}

static void release(struct player *player, uint32_t number)
{
    player_destroy(player->device, &player->handles[number]);
    player->handles[number] = (struct handles){.frame = NOWHERE};
    reader_release(player->reader, number);
}

/* Creates the buffer that the call binds or changes, if it does not exist yet. */
static int make_buffer(struct player *player, const struct call *call, struct error *error)
{
    bool uses = call->type == CALL_BIND_INDICES || call->type == CALL_BIND_ELEMENT ||
                call->type == CALL_BIND_STREAM || call->type == CALL_WRITE || call->type == CALL_DISCARD;
    if (!uses || call->resource == NO_RESOURCE)
        return 0;
    struct handles *handles = &player->handles[call->resource];
    const struct resource *resource = &player->stream->resources[call->resource];
    if (resource->type != RESOURCE_BUFFER || handles->vertices || handles->indices)
        return 0;
    return player_create(player->device, resource, handles) ? fail(player, resource->name, error) : 0;
}

static int execute(struct player *player, const struct call *call, bool draws, struct error *error)
{
    if (make_buffer(player, call, error))
        return -1;
    if (player_execute_state(player, call) || (draws && player_execute_pixels(player, call)))
        return stream_fail(player->stream, call, triptych_error(player->device), error);
    if (call->type == CALL_RELEASE)
        release(player, call->resource);
    return 0;
}

/* Plays up to the end of the current frame. */
static int play_frame(struct player *player, bool draws, struct error *error)
{
    struct step step;
    for (;;) {
        if (reader_next(player->reader, &step, error))
            return -1;
        if (step.type == RECORD_NONE)
            return error_set(error, "%s: found the end of the recording, expected another frame",
                             player->stream->path);
        if (step.type == RECORD_IS_CALL && step.call.type == CALL_FRAME)
            return 0;
        if (step.type == RECORD_IS_RESOURCE ? define(player, step.number, error)
                                            : execute(player, &step.call, draws, error))
            return -1;
    }
}

/* Starts again. No object of earlier frames remains. */
static int begin(struct player *player, struct error *error)
{
    if (player_reset(player))
        return fail(player, "beginning", error);
    for (uint32_t i = 0; i < player->handle_count; i++)
        player_destroy(player->device, &player->handles[i]);
    memset(player->handles, 0, player->handle_count * sizeof *player->handles);
    return reader_rewind(player->reader, error);
}

int player_recorded_frame(struct player *player, uint32_t frame, struct error *error)
{
    uint32_t next = player->next;
    player->next = NOWHERE;
    if (next == NOWHERE || next > frame) {
        next = 0;
        if (begin(player, error))
            return -1;
    }
    for (; next < frame; next++)
        if (play_frame(player, false, error))
            return -1;
    player->frame = frame;
    for (uint32_t i = 0; i < player->handle_count; i++)
        player->handles[i].frame = NOWHERE;
    if (play_frame(player, true, error))
        return -1;
    if (triptych_end_frame(player->device))
        return fail(player, "finishing", error);
    player->next = frame + 1;
    return 0;
}
