/* Playing: stream_prepare creates resources once, then frames are executed any number of times.
 *
 * The player keeps the number of the frame for which the device's state is correct. To play another frame it
 * starts at the beginning: every state is set to its default, then the calls of earlier frames are executed
 * without draws and clears. The reset sets all states that a frame can change, so playing does not
 * depend on the defaults of the device. */
#include "render/texture/texture.h"
#include "command/play/play_part.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* --- Resources ------------------------------------------------------------------------------------------ */

static enum triptych_result fill(triptych_device *device, const struct resource *resource,
                                 triptych_texture *texture)
{
    struct triptych_texture shape;
    const uint8_t *data = resource->texels;
    enum triptych_result result = texture_describe(&resource->texture, &shape, NULL);
    for (unsigned face = 0; face < shape.faces && !result; face++)
        for (unsigned level = 0; level < (resource->mips ? 1 : shape.levels) && !result; level++) {
            size_t row = texture_row_bytes(shape.format, (uint32_t)shape.level[level].width);
            size_t bytes = texture_level_bytes(&shape, level);
            size_t slice = bytes / (size_t)shape.level[level].depth;
            result = triptych_texture_update(device, texture, face, level, NULL, data, row, slice);
            data += bytes;
        }
    return !result && resource->mips ? triptych_texture_generate_mips(device, texture) : result;
}

static enum triptych_result create_texture(triptych_device *device, const struct resource *resource,
                                           triptych_texture **texture)
{
    enum triptych_result result = triptych_texture_define(device, &resource->texture, texture);
    return result ? result : fill(device, resource, *texture);
}

enum triptych_result player_create(triptych_device *device, const struct resource *resource,
                                   struct handles *handles)
{
    enum triptych_result result = TRIPTYCH_OK;
    if (resource->type == RESOURCE_TEXTURE && resource->texels)
        result = create_texture(device, resource, &handles->texture);
    bool geometry = resource_has_geometry(resource);
    if (!result && geometry && resource->vertices)
        result =
            triptych_buffer_create(device, resource->vertices, resource->vertex_bytes, &handles->vertices);
    if (!result && geometry && resource->indices)
        result = triptych_buffer_create(device, resource->indices,
                                        (size_t)resource->index_count * resource->index_bits / 8,
                                        &handles->indices);
    if (!result && resource->type == RESOURCE_SHADER)
        result = triptych_shader_assemble(device, resource->name, resource->code, resource->code_bytes,
                                          &handles->shader);
    if (!result && resource->type == RESOURCE_IMAGE)
        result = triptych_image_create(device, &resource->image, &handles->image);
    handles->frame = NOWHERE;
    if (!result && resource->type == RESOURCE_QUERY)
        result = triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &handles->query);
    return result;
}

/* Destroying null or an object of the device cannot fail. */
void player_destroy(triptych_device *device, const struct handles *handles)
{
    triptych_buffer_destroy(device, handles->vertices);
    triptych_buffer_destroy(device, handles->indices);
    triptych_texture_destroy(device, handles->texture);
    triptych_image_destroy(device, handles->image);
    triptych_shader_destroy(device, handles->shader);
    triptych_query_destroy(device, handles->query);
}

static int create_all(struct player *player, struct error *error)
{
    const struct stream *stream = player->stream;
    for (uint32_t i = 0; i < stream->resource_count; i++)
        if (player_create(player->device, &stream->resources[i], &player->handles[i]))
            return error_set(error, "%s: %s: %s", stream->path, stream->resources[i].name,
                             triptych_error(player->device));
    return 0;
}

static int open_recording(struct player *player, struct error *error)
{
    player->reader = reader_create(player->stream, error);
    if (!player->reader)
        return -1;
    player->stream = reader_window(player->reader);
    return 0;
}

int stream_prepare(const struct stream *stream, triptych_device *device, struct player **player,
                   struct error *error)
{
    struct player *made = calloc(1, sizeof *made);
    *player = NULL;
    if (made)
        made->handles = calloc(stream->resource_count + 1, sizeof *made->handles);
    if (!made || !made->handles) {
        player_free(made);
        return error_set(error, "%s: not enough memory", stream->path);
    }
    made->stream = stream;
    made->device = device;
    made->next = NOWHERE;
    made->handle_count = stream->resource_count;
    if (stream->streamed ? open_recording(made, error) : create_all(made, error)) {
        player_free(made);
        return -1;
    }
    *player = made;
    return 0;
}

void player_free(struct player *player)
{
    if (!player)
        return;
    for (uint32_t i = 0; player->handles && i < player->handle_count; i++)
        player_destroy(player->device, &player->handles[i]);
    free(player->handles);
    reader_free(player->reader);
    free(player);
}

/* --- Calls ---------------------------------------------------------------------------------------------- */

/* Returns true if the frame clears all pixels of the target that executed[at] sets before it uses them. */
static bool is_overwritten(const struct stream *stream, uint32_t at, uint32_t end)
{
    enum triptych_depth_format format = stream->calls[stream->executed[at]].target.depth_format;
    unsigned all = TRIPTYCH_CLEAR_COLOR | (triptych_depth_bits(format) ? TRIPTYCH_CLEAR_DEPTH : 0) |
                   (triptych_stencil_bits(format) ? TRIPTYCH_CLEAR_STENCIL : 0);
    while (++at < end) {
        const struct call *call = &stream->calls[stream->executed[at]];
        if (call->type == CALL_CLEAR)
            return call->clear.flags == all;
        if (call_row(call->type)->traits & CALL_USES_TARGET)
            return false;
    }
    return false;
}

/* Compares the colours. The first format of the second description may be 0, which means A8R8G8B8. */
static bool same_colors(const struct triptych_target_description *got,
                        const struct triptych_target_description *wanted)
{
    bool same = got->color_format[0] ==
                (wanted->color_format[0] ? wanted->color_format[0] : TRIPTYCH_SURFACE_A8R8G8B8);
    for (unsigned t = 1; t < TRIPTYCH_TARGETS; t++)
        same &= got->color_format[t] == wanted->color_format[t];
    return same;
}

/* Keeps a target that the frame sets again. Otherwise replaying a frame would measure the creation of
 * targets. A target with the same description can stay if its pixels do not matter. */
static enum triptych_result keep_target(struct player *player, const struct call *call, bool *kept)
{
    struct triptych_target_description target;
    enum triptych_result result = triptych_set_target_surfaces(player->device, NULL);
    triptych_get_target(player->device, &target);
    *kept = target.width == call->target.width && target.height == call->target.height &&
            target.depth_format == call->target.depth_format &&
            target.samples == (call->target.samples ? call->target.samples : 1) &&
            same_colors(&target, &call->target);
    if (!*kept || result)
        return result;
    const struct triptych_viewport whole = {0, 0, (float)target.width, (float)target.height, 0, 1};
    result = triptych_set_scissor(player->device, 0, 0, target.width, target.height);
    return result ? result : triptych_set_viewport(player->device, &whole);
}

static enum triptych_result execute(struct player *player, uint32_t at, uint32_t end, bool draws)
{
    const struct stream *stream = player->stream;
    const struct call *call = &stream->calls[stream->executed[at]];
    enum triptych_result result = TRIPTYCH_OK;
    bool kept = false;
    if (call->type == CALL_TARGET && draws && is_overwritten(stream, at, end))
        result = keep_target(player, call, &kept);
    if (!result && !kept)
        result = player_execute_state(player, call);
    if (!result && draws)
        result = player_execute_pixels(player, call);
    return result;
}

/* --- Frames --------------------------------------------------------------------------------------------- */

/* Executes calls `first` to `last` - 1 of `executed`. The reason begins with the position of the call. */
static int execute_range(struct player *player, uint32_t first, uint32_t last, bool draws,
                         struct error *error)
{
    const struct stream *stream = player->stream;
    for (uint32_t i = first; i < last; i++)
        if (execute(player, i, last, draws)) {
            const struct call *call = &stream->calls[stream->executed[i]];
            return stream_fail(stream, call, triptych_error(player->device), error);
        }
    return 0;
}

static int check_frame(const struct stream *stream, uint32_t frame, struct error *error)
{
    if (frame < stream->frame_count)
        return 0;
    return error_set(error, "%s: frame %" PRIu32 ", expected 0 to %" PRIu32, stream->path, frame,
                     stream->frame_count - 1);
}

int player_seek(struct player *player, uint32_t frame, struct error *error)
{
    if (check_frame(player->stream, frame, error))
        return -1;
    if (player->reader || player->next == frame)
        return 0;
    player->next = NOWHERE;
    if (player_reset(player))
        return error_set(error, "%s: %s", player->stream->path, triptych_error(player->device));
    if (execute_range(player, 0, player->stream->frames[frame], false, error))
        return -1;
    player->next = frame;
    return 0;
}

static int perform(struct player *player, uint32_t frame, struct error *error)
{
    const struct stream *stream = player->stream;
    player->next = NOWHERE;
    player->frame = frame;
    for (uint32_t i = 0; i < stream->resource_count; i++)
        player->handles[i].frame = NOWHERE;
    if (execute_range(player, stream->frames[frame], stream->frames[frame + 1], true, error))
        return -1;
    if (triptych_end_frame(player->device))
        return error_set(error, "%s: frame %" PRIu32 ": %s", stream->path, frame,
                         triptych_error(player->device));
    player->next = frame + 1;
    return 0;
}

int player_frame(struct player *player, uint32_t frame, struct error *error)
{
    if (player_seek(player, frame, error))
        return -1;
    return player->reader ? player_recorded_frame(player, frame, error) : perform(player, frame, error);
}

int player_go_on(struct player *player, uint32_t frame, struct error *error)
{
    const struct stream *stream = player->stream;
    if (player->reader || player->next == NOWHERE || frame >= stream->frame_count)
        return error_set(error, "%s: frame %" PRIu32 " cannot continue the last picture", stream->path,
                         frame);
    return perform(player, frame, error);
}

uint32_t player_resource(const struct player *player, const void *object)
{
    for (uint32_t i = 0; i < player->handle_count && object; i++) {
        const struct handles *h = &player->handles[i];
        if (object == h->vertices || object == h->indices || object == h->texture || object == h->shader ||
            object == h->query || object == h->image)
            return i;
    }
    return NO_RESOURCE;
}

bool player_query(struct player *player, uint32_t i, struct query_count *count)
{
    const struct stream *stream = player->stream;
    for (uint32_t r = 0; r < player->handle_count; r++) {
        const struct handles *handles = &player->handles[r];
        if (!handles->query || handles->frame != player->frame || i--)
            continue;
        count->name = stream->resources[r].name;
        return !triptych_query_result(player->device, handles->query, &count->passed);
    }
    return false;
}

int stream_play(const struct stream *stream, triptych_device *device, uint32_t first, uint32_t last,
                frame_callback *callback, void *user, struct error *error)
{
    struct player *player;
    if (stream_prepare(stream, device, &player, error))
        return -1;
    int result = 0;
    for (uint32_t frame = first; frame <= last && !result; frame++) {
        result = player_frame(player, frame, error);
        if (!result && callback)
            result = callback(user, frame, device, error);
    }
    player_free(player);
    return result;
}
