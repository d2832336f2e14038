/* Resources of a follower: buffers for the state, textures that are drawn to, queries, releases. */
#include "command/stream/follow_part.h"
#include "render/target/surface.h"

#include <stdlib.h>
#include <string.h>

/* Returns the entry of a resource; null if memory is short. */
static struct followed *follower_resource(struct follower *follower, uint32_t number)
{
    if (number >= follower->resource_count) {
        uint32_t most = follower->stream->resource_count, twice = 2 * follower->resource_count;
        uint32_t count = most > twice ? most : twice;
        struct followed *larger = realloc(follower->resources, count * sizeof *larger);
        if (!larger)
            return NULL;
        memset(larger + follower->resource_count, 0, (count - follower->resource_count) * sizeof *larger);
        follower->resources = larger;
        follower->resource_count = count;
    }
    return &follower->resources[number];
}

struct triptych_buffer *follower_buffer(struct follower *follower, uint32_t resource, struct error *error)
{
    struct followed *entry = follower_resource(follower, resource);
    const struct resource *data = &follower->stream->resources[resource];
    if (entry && !entry->stand_in) {
        entry->stand_in = calloc(1, sizeof *entry->stand_in);
        if (entry->stand_in) {
            entry->stand_in->resource = resource;
            entry->stand_in->buffer.data =
                (uint8_t *)(uintptr_t)resource_data(data, &entry->stand_in->buffer.bytes);
        }
    }
    if (entry && entry->stand_in)
        return &entry->stand_in->buffer;
    error_set(error, "not enough memory");
    return NULL;
}

void follower_free_buffer(struct followed *entry)
{
    if (entry->stand_in)
        free(entry->stand_in->changed);
    free(entry->stand_in);
    entry->stand_in = NULL;
}

/* Returns the bytes of a buffer, which are about to change; null with the reason. */
static uint8_t *changing_bytes(struct follower *follower, uint32_t resource, struct error *error)
{
    struct triptych_buffer *buffer = follower_buffer(follower, resource, error);
    if (!buffer)
        return NULL;
    struct stand_in *stand_in = follower->resources[resource].stand_in;
    if (!stand_in->changed) {
        stand_in->changed = malloc(buffer->bytes);
        if (!stand_in->changed) {
            error_set(error, "not enough memory");
            return NULL;
        }
        memcpy(stand_in->changed, buffer->data, buffer->bytes);
    }
    buffer->data = stand_in->changed;
    buffer->version++;
    return buffer->data;
}

int follow_write(struct follower *follower, const struct call *call, struct error *error)
{
    const struct resource *resources = follower->stream->resources;
    size_t bytes, room;
    const void *data = resource_data(&resources[call->write.source], &bytes);
    resource_data(&resources[call->resource], &room);
    if (call->write.offset > room || bytes > room - call->write.offset)
        return error_set(error, "found %zu bytes at offset %u, expected them within the %zu bytes of %s",
                         bytes, call->write.offset, room, resources[call->resource].name);
    uint8_t *to = changing_bytes(follower, call->resource, error);
    if (to)
        memcpy(to + call->write.offset, data, bytes);
    return to ? 0 : -1;
}

int follow_discard(struct follower *follower, const struct call *call, struct error *error)
{
    uint8_t *to = changing_bytes(follower, call->resource, error);
    if (to)
        memset(to, 0, follower->resources[call->resource].stand_in->buffer.bytes);
    return to ? 0 : -1;
}

/* --- Surfaces ------------------------------------------------------------------------------------------- */

/* A texture without texels or an image without pixels. */
struct shape {
    struct triptych_texture texture;
    struct triptych_image image;
};

/* Returns a surface of the shape, for checks. It is null for the target. */
static struct triptych_surface shape_of(const struct stream *stream, const struct call_surface *surface,
                                        struct shape *shape)
{
    struct triptych_surface r = {NULL, surface->level, surface->slice, NULL};
    if (surface->resource == NO_RESOURCE)
        return r;
    const struct resource *resource = &stream->resources[surface->resource];
    if (resource->type == RESOURCE_IMAGE) {
        shape->image.description = resource->image;
        r.image = &shape->image;
        return r;
    }
    texture_describe(&resource->texture, &shape->texture, NULL);
    r.texture = &shape->texture;
    return r;
}

static int check_attach(const struct stream *stream, const struct call *call,
                        struct triptych_target_description *description, struct error *error)
{
    struct shape shape[TRIPTYCH_TARGETS + 1];
    struct triptych_target_surfaces surfaces = {.depth_format = call->attach.depth_format};
    for (int t = 0; t < TRIPTYCH_TARGETS; t++) {
        const struct call_surface *color = call->attach.color;
        int first = 0; /* of the same texture or image */
        while (color[first].resource != color[t].resource)
            first++;
        surfaces.color[t] = shape_of(stream, &color[t], &shape[first]);
    }
    surfaces.depth = shape_of(stream, &call->attach.depth, &shape[TRIPTYCH_TARGETS]);
    return surfaces_describe(&surfaces, description, error) ? -1 : 0;
}

int follow_copy(struct follower *follower, const struct call *call, struct error *error)
{
    struct shape shape[2];
    struct triptych_surface surface[2];
    struct surface_copy_plan plan;
    struct surface_copy copy = {.filter = call->copy.filter};
    for (int i = 0; i < 2; i++) {
        surface[i] = shape_of(follower->stream, &call->copy.surface[i], &shape[i]);
        copy.surface[i] = &surface[i];
        copy.part[i] = call->copy.part[i];
    }
    return surface_check_copy(&copy, &follower->target, &plan, error) ? -1 : 0;
}

int follow_set_pixels(struct follower *follower, const struct call *call, struct error *error)
{
    struct shape shape;
    struct surface_memory memory;
    struct triptych_surface surface = shape_of(follower->stream, &call->set_pixels.surface, &shape);
    return surface_check_memory(&surface, &call->set_pixels.part, call->set_pixels.format, &follower->target,
                                &memory, error)
               ? -1
               : 0;
}

int follow_fill(struct follower *follower, const struct call *call, struct error *error)
{
    struct shape shape;
    struct surface_memory memory;
    struct triptych_surface surface = shape_of(follower->stream, &call->fill.surface, &shape);
    return surface_check_fill(&surface, &call->fill.part, &follower->target, &memory, error) ? -1 : 0;
}

int follow_attach(struct follower *follower, const struct call *call, struct error *error)
{
    struct triptych_target_description description = follower->target;
    if (call->attach.some && check_attach(follower->stream, call, &description, error))
        return -1;
    follower_draw_to(follower, &description);
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        follower->attached[t] = call->attach.some ? call->attach.color[t].resource : NO_RESOURCE;
    follower->attached[TRIPTYCH_TARGETS] = call->attach.some ? call->attach.depth.resource : NO_RESOURCE;
    return 0;
}

/* --- Queries -------------------------------------------------------------------------------------------- */

/* Queries begin and end in one frame, so that each frame has its own results. */
static int follow_query(struct follower *follower, const struct call *call, struct error *error)
{
    const char *name = follower->stream->resources[call->resource].name;
    struct followed *query = follower_resource(follower, call->resource);
    if (!query)
        return error_set(error, "not enough memory");
    if (call->type == CALL_BEGIN_QUERY && query->begun)
        return error_set(error, "found query %s begun again, expected end-query %s before it", name, name);
    if (call->type == CALL_END_QUERY && !query->begun)
        return error_set(error, "found query %s not begun, expected begin-query %s before it", name, name);
    query->begun = call->type == CALL_BEGIN_QUERY;
    query->beginning = call->position;
    follower->begun += query->begun ? 1 : UINT32_MAX;
    return 0;
}

int follow_begin_query(struct follower *follower, const struct call *call, struct error *error)
{
    return follow_query(follower, call, error);
}

int follow_end_query(struct follower *follower, const struct call *call, struct error *error)
{
    return follow_query(follower, call, error);
}

int follower_frame(struct follower *follower, struct error *error)
{
    for (uint32_t i = 0; i < follower->resource_count && follower->begun; i++)
        if (follower->resources[i].begun) {
            struct error reason = {{0}};
            const char *name = follower->stream->resources[i].name;
            error_set(&reason, "found query %s begun and not ended, expected end-query %s in its frame", name,
                      name);
            const struct call begin = {.type = CALL_BEGIN_QUERY,
                                       .position = follower->resources[i].beginning};
            return stream_fail(follower->stream, &begin, reason.text, error);
        }
    return 0;
}

/* --- Releases ------------------------------------------------------------------------------------------- */

/* Returns the binding that uses the resource, or null. */
static const char *holder(const struct follower *follower, uint32_t number)
{
    const struct state *state = &follower->state;
    const struct followed *entry = &follower->resources[number];
    for (unsigned i = 0; i < STREAM_COUNT && entry->stand_in; i++)
        if (state->stream[i].buffer == &entry->stand_in->buffer)
            return "bound as vertices";
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        if (follower->texture[i] == number)
            return "bound as a texture";
    if (follower->clip_mask == number)
        return "the clip mask";
    for (unsigned i = 0; i < SHADER_STAGES; i++)
        if (follower->shader[i] == number)
            return "set as a shader";
    for (unsigned i = 0; i <= TRIPTYCH_TARGETS; i++)
        if (follower->attached[i] == number)
            return "attached";
    if (follower->indices == number)
        return "bound as indices";
    return entry->begun ? "begun" : NULL;
}

int follow_release(struct follower *follower, const struct call *call, struct error *error)
{
    struct followed *entry = follower_resource(follower, call->resource);
    if (!entry)
        return error_set(error, "not enough memory");
    const char *held = holder(follower, call->resource);
    if (held)
        return error_set(error, "found '%s' %s, expected a resource that nothing uses",
                         follower->stream->resources[call->resource].name, held);
    follower_free_buffer(entry);
    *entry = (struct followed){.released = true};
    return 0;
}

void follower_define(struct follower *follower, uint32_t number)
{
    if (number < follower->resource_count)
        follower->resources[number] = (struct followed){.released = false};
}
