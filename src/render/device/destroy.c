/* Destruction of buffers, textures, images and queries, which are unbound. Memory that queued draws may
 * read is retired (render/device/storage.c). */
#include "render/device/device_part.h"

#include <stdlib.h>

static enum triptych_result not_ours(struct error *error, const char *what)
{
    error_set(error, "%s to destroy: expected one of this device", what);
    return TRIPTYCH_BAD_ARGUMENT;
}

/* The links to an object in the device's lists, or those at the ends of the lists. */

static struct triptych_buffer **find_buffer(struct triptych_device *device,
                                            const struct triptych_buffer *buffer)
{
    struct triptych_buffer **at = &device->resources.buffers;
    while (*at && *at != buffer)
        at = &(*at)->next;
    return at;
}

static struct triptych_texture **find_texture(struct triptych_device *device,
                                              const struct triptych_texture *texture)
{
    struct triptych_texture **at = &device->resources.textures;
    while (*at && *at != texture)
        at = &(*at)->next;
    return at;
}

static struct triptych_image **find_image(struct triptych_device *device, const struct triptych_image *image)
{
    struct triptych_image **at = &device->resources.images;
    while (*at && *at != image)
        at = &(*at)->next;
    return at;
}

static struct triptych_query **find_query(struct triptych_device *device, const struct triptych_query *query)
{
    struct triptych_query **at = &device->queries.first;
    while (*at && *at != query)
        at = &(*at)->next;
    return at;
}

bool device_has_buffer(struct triptych_device *device, const struct triptych_buffer *buffer)
{
    return *find_buffer(device, buffer);
}

bool device_has_texture(struct triptych_device *device, const struct triptych_texture *texture)
{
    return *find_texture(device, texture);
}

bool device_has_image(struct triptych_device *device, const struct triptych_image *image)
{
    return *find_image(device, image);
}

bool device_has_query(struct triptych_device *device, const struct triptych_query *query)
{
    return *find_query(device, query);
}

static void unbind_buffer(struct triptych_device *device, const struct triptych_buffer *buffer)
{
    struct state *state = &device->state;
    for (unsigned i = 0; i < STREAM_COUNT; i++)
        if (state->stream[i].buffer == buffer) {
            state->stream[i].buffer = NULL;
            device_state_changed(device, CHANGE_OF_STREAM);
        }
    if (state->indices == buffer) {
        state->indices = NULL;
        state->index_bits = 0;
    }
}

enum triptych_result device_buffer_destroy(struct triptych_device *device, struct triptych_buffer *buffer,
                                           struct error *error)
{
    struct triptych_buffer **at = find_buffer(device, buffer);
    if (!*at)
        return not_ours(error, "buffer");
    unbind_buffer(device, buffer);
    *at = buffer->next;
    device->resources.mapped -= buffer->is_mapped;
    device_retire(device, buffer->data, buffer->epoch);
    buffer->data = NULL;
    buffer_destroy(buffer);
    device_limit_retired(device);
    return TRIPTYCH_OK;
}

enum triptych_result device_texture_destroy(struct triptych_device *device, struct triptych_texture *texture,
                                            struct error *error)
{
    struct triptych_texture **at = find_texture(device, texture);
    if (!*at)
        return not_ours(error, "texture");
    if (device_draws_to(device, texture) && device_set_target_surfaces(device, NULL, error) != TRIPTYCH_OK)
        return TRIPTYCH_NO_MEMORY;
    for (struct drawn_surface *drawn = texture->drawn; drawn; drawn = drawn->next)
        device->binding.newer -= drawn->attachment->tiles_newer;
    surface_free_attachments(texture);
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        if (device->state.texture[i] == texture) {
            device->state.texture[i] = NULL;
            device_state_changed(device, change_of_texture(texture, NULL));
        }
    if (device->state.clip_mask.texture == texture) {
        device->state.clip_mask.texture = NULL;
        device_state_changed(device, CHANGE_OF_CLIP_MASK);
    }
    *at = texture->next;
    free(texture->blocks); /* which draws do not read */
    device_retire(device, texture->texels, texture->epoch);
    device_retire(device, texture, texture->epoch);
    device_limit_retired(device);
    return TRIPTYCH_OK;
}

/* Queued commands hold what they need. */
enum triptych_result device_image_destroy(struct triptych_device *device, struct triptych_image *image,
                                          struct error *error)
{
    struct triptych_image **at = find_image(device, image);
    if (!*at)
        return not_ours(error, "image");
    if (device_draws_to_image(device, image) &&
        device_set_target_surfaces(device, NULL, error) != TRIPTYCH_OK)
        return TRIPTYCH_NO_MEMORY;
    *at = image->next;
    attachment_release(image->attachment);
    free(image);
    return TRIPTYCH_OK;
}

enum triptych_result device_query_destroy(struct triptych_device *device, struct triptych_query *query,
                                          struct error *error)
{
    struct triptych_query **at = find_query(device, query);
    if (!*at)
        return not_ours(error, "query");
    device->queries.counting -= query->phase == QUERY_BEGUN;
    *at = query->next;
    free(query);
    return TRIPTYCH_OK;
}
