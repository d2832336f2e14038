/* Functions that the parts of the device share. */
#ifndef RENDER_DEVICE_DEVICE_PART_H
#define RENDER_DEVICE_DEVICE_PART_H

#include "render/device/device.h"

/* --- Targets and textures --- */

/* Fails if there is no target. */
enum triptych_result device_has_target(const struct triptych_device *device, struct error *error);

/* Sets the order of the memory of all targets, images and textures. Renders what is recorded first. */
void device_order_targets(struct triptych_device *device, bool quad_rows);
/* Frees all targets, when the queue is empty. */
void device_free_targets(struct triptych_device *device);

/* Before texels are read or changed by others than draws: stores what was drawn to the texture, and renders
 * what is recorded if it may use the texture. After a change of levels `first` to `last`: what is drawn to
 * them begins with it. */
void device_store_texture(struct triptych_device *device, struct triptych_texture *texture);
/* Stores what was drawn, in the queue. */
void device_store_surfaces(struct triptych_device *device, struct triptych_texture *texture);
/* Before texels are changed by others than draws, instead of device_store_texture: waits for draws only if
 * they write the texture. The texels of `lost` may get any values. */
void device_change_texture(struct triptych_device *device, struct triptych_texture *texture,
                           struct texture_span lost);
void device_load_texture(struct triptych_device *device, struct triptych_texture *texture, unsigned first,
                         unsigned last);

/* Before a draw or a clear is queued: brings the tiles of the target up to date. */
void device_load_target(struct triptych_device *device);
static inline void device_prepare_target(struct triptych_device *device)
{
    if (device->binding.stale)
        device_load_target(device);
}
/* Before a draw is queued: brings the texels up to date that it samples. */
void device_prepare_textures(struct triptych_device *device);
/* The command that is queued next may change these parts of the target (enum target_part). */
void device_note_newer(struct triptych_device *device, unsigned parts);
static inline void device_note_drawn(struct triptych_device *device, unsigned parts)
{
    if (parts & device->binding.textured)
        device_note_newer(device, parts & device->binding.textured);
}

/* Frees what commands that are rendered have referred to. */
void device_free_released(struct released *released);

/* The queue is empty: brings the tiles of a texture's surface up to date, whose attachment has memory. */
void device_load_surface(struct triptych_device *device, const struct triptych_surface *surface);
/* A surface of a texture has been written, in its tiles or as texels. */
void device_note_written(struct triptych_device *device, const struct triptych_surface *surface, bool tiles);

/* --- Draws --- */

/* The part of a draw that depends on the call. */
struct drawn {
    enum triptych_primitive primitive;
    uint32_t count;
    const void *indices; /* null: none */
    uint32_t index_bits;
    uint32_t base;                     /* as in struct draw */
    uint64_t lowest, highest;          /* the vertices that it reads, if count is not 0 */
    struct buffer_span index_span;     /* the bytes of the bound indices that it reads */
    const struct immediate *immediate; /* null: all vertices and indices are in buffers */
};

/* Queues a checked draw of what is derived, all instances one after the other. */
enum triptych_result device_enqueue(struct triptych_device *device, const struct drawn *drawn,
                                    uint32_t instances, struct error *error);

/* The steps of a draw call (render/device/draw.c). Checks that do not depend on its vertices, and the
 * derivation of what it needs. */
enum triptych_result device_prepare_draw(struct triptych_device *device, enum triptych_primitive primitive,
                                         struct error *error);
/* Checks that it is without instances. */
enum triptych_result device_check_no_instances(const struct triptych_device *device, struct error *error);
/* Fails if there is no target, no position, or constants that shaders must not run with. */
enum triptych_result device_check_vertex_input(struct triptych_device *device, struct error *error);
/* The next draw reads stream 0, not immediate vertices. */
void device_use_streams(struct triptych_device *device);
/* Checks that the elements that a vertex routine reads have vertices up to `last`. */
enum triptych_result device_check_elements(const struct state *state, const struct vertex_key *key,
                                           uint64_t last, struct error *error);
/* The same for the routine of the draw. */
enum triptych_result device_check_vertices(const struct triptych_device *device, uint64_t last,
                                           struct error *error);
/* Queues a checked draw, if it has an effect, and counts it. */
enum triptych_result device_count_draw(struct triptych_device *device, const struct drawn *drawn,
                                       struct error *error);

/* The place of the next command; renders what is recorded if there is no other. */
struct command *device_next_command(struct triptych_device *device);

/* Fails if draws must not run with the current integer constants. */
enum triptych_result device_check_integers(struct triptych_device *device, struct error *error);

/* --- What is queued --- */

/* Returns true if draws of an epoch may not be rendered yet. A resource has the epoch of the last draw that
 * uses it. */
static inline bool device_epoch_is_queued(const struct triptych_device *device, uint64_t epoch)
{
    return epoch == device->epoch || (device->rendered.commands && epoch == device->epoch - 1);
}
/* Returns true if draws that are not rendered yet sample the texture. */
bool device_uses(const struct triptych_device *device, const struct triptych_texture *texture);
/* Drops everything that is queued. */
void device_forget(struct triptych_device *device);

/* --- Memory --- */

/* Storage of resources (render/device/storage.c). New storage has any contents; null if memory is short.
 * Storage that is retired is kept until the draws up to an epoch are rendered. */
void *device_new_storage(struct triptych_device *device, size_t bytes);
void device_retire(struct triptych_device *device, void *storage, uint64_t epoch);
/* The draws of a list are rendered. */
void device_reuse_storage(struct triptych_device *device, struct extents *retired);
/* Starts rendering if much storage is retired. To be called after device_retire, when no draw is being
 * built. */
void device_limit_retired(struct triptych_device *device);
void device_free_storage(struct triptych_device *device);

/* Frees all shaders. */
void device_free_shaders(struct triptych_device *device);

#endif
