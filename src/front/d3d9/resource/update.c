/* Copies from the system pool to the default pool and back: UpdateSurface, UpdateTexture,
 * GetRenderTargetData. */
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "renderer.h"
#include "texture.h"

/* Copies a box of the memory of `from` to `to`, wherever its home is. */
static int32_t copy_box(struct d3d9_image *to, uint32_t x, uint32_t y, uint32_t z,
                        const struct d3d9_image *from, const struct triptych_box *box)
{
    if (to->home == D3D9_HOME_RENDERER)
        return d3d9_image_upload_box(to, x, y, z, from, box);
    const struct triptych_box target = {x, y, z, box->width, box->height, box->depth};
    if (!d3d9_image_allocate(to))
        return D3D9_OUT_OF_MEMORY;
    d3d9_image_copy(to, x, y, z, from, box);
    d3d9_image_add_dirty(to, &target);
    return D3D9_OK;
}

static bool is_free(const struct d3d9_surface *surface)
{
    return !surface->image.locked && !surface->image.use->context;
}

static struct d3d9_box box_of(const struct d3d9_image *image, const struct d3d9_rect *r)
{
    if (r)
        return (struct d3d9_box){r->left, r->top, r->right, r->bottom, 0, 1};
    return (struct d3d9_box){0, 0, image->width, image->height, 0, 1};
}

int32_t d3d9_device_update_surface(struct d3d9_device *device, struct d3d9_surface *source,
                                   const struct d3d9_rect *rectangle, struct d3d9_surface *destination,
                                   const struct d3d9_point *point)
{
    if (!source || !destination)
        return D3D9_INVALID_CALL;
    struct d3d9_image *from = &source->image, *to = &destination->image;
    if (source->resource.device != device || destination->resource.device != device)
        return D3D9_INVALID_CALL;
    if (source->resource.pool != D3D9_POOL_SYSTEM || destination->resource.pool != D3D9_POOL_DEFAULT)
        return D3D9_INVALID_CALL;
    if (from->format != to->format || to->samples > 1 || d3d9_format_is_depth(to->format))
        return D3D9_INVALID_CALL;
    if (!is_free(source) || !is_free(destination))
        return D3D9_INVALID_CALL;
    const struct d3d9_box box = box_of(from, rectangle);
    uint32_t x = point ? (uint32_t)point->x : 0, y = point ? (uint32_t)point->y : 0;
    const struct d3d9_box target = {x, y, x + box.right - box.left, y + box.bottom - box.top, 0, 1};
    if (!d3d9_image_box_fits(from, &box) || !d3d9_image_box_fits(to, &target))
        return D3D9_INVALID_CALL;
    const struct triptych_box part = {box.left, box.top, 0, box.right - box.left, box.bottom - box.top, 1};
    int32_t result = copy_box(to, x, y, 0, from, &part);
    if (destination->texture)
        d3d9_base_texture_changed(destination->texture);
    return result;
}

/* The first level of the source that has the size of the destination's first level; or all levels. */
static uint32_t first_level(const struct d3d9_base_texture *source, const struct d3d9_base_texture *target)
{
    const struct d3d9_image *first = &target->part[0]->image;
    uint32_t level = 0;
    for (; level < source->visible_levels; level++) {
        const struct d3d9_image *image = &source->part[level]->image;
        if (image->width == first->width && image->height == first->height && image->depth == first->depth)
            break;
    }
    return level;
}

/* Converts a box to another format. Direct3D documents equal formats only, and drivers accept others with
 * as many bits. */
static int32_t convert_box(struct d3d9_image *to, const struct d3d9_image *from,
                           const struct triptych_box *box)
{
    const struct triptych_rectangle part = {box->x, box->y, box->width, box->height};
    int32_t result = D3D9_OK;
    if (to->format->side > 1 || from->format->side > 1 || !to->has_surface || to->home == D3D9_HOME_MEMORY)
        return D3D9_OK;
    for (uint32_t z = box->z; result >= 0 && z < box->z + box->depth; z++) {
        struct triptych_surface surface = to->surface;
        surface.slice += z;
        result = d3d9_renderer_write(to->device->renderer, &surface, from->format, &part,
                                     d3d9_image_at(from, box->x, box->y, z), from->row_bytes);
    }
    return result;
}

/* Copies the dirty box of a face and level. */
static int32_t update_level(struct d3d9_image *to, struct d3d9_image *from)
{
    struct triptych_box box = from->dirty;
    if (!box.width)
        return D3D9_OK;
    return to->format == from->format ? copy_box(to, box.x, box.y, box.z, from, &box)
                                      : convert_box(to, from, &box);
}

int32_t d3d9_device_update_texture(struct d3d9_device *device, struct d3d9_base_texture *source,
                                   struct d3d9_base_texture *destination)
{
    if (!source || !destination)
        return D3D9_INVALID_CALL;
    if (source->resource.device != device || destination->resource.device != device)
        return D3D9_INVALID_CALL;
    if (source->resource.pool != D3D9_POOL_SYSTEM || destination->resource.pool != D3D9_POOL_DEFAULT)
        return D3D9_INVALID_CALL;
    if (source->resource.type != destination->resource.type)
        return D3D9_INVALID_CALL;
    if (source->format->floats != destination->format->floats)
        return D3D9_INVALID_CALL;
    uint32_t skipped = first_level(source, destination);
    int32_t result = D3D9_OK;
    for (uint32_t face = 0; face < source->faces; face++)
        for (uint32_t level = 0; result >= 0 && level < destination->visible_levels; level++) {
            if (skipped + level >= source->visible_levels)
                break;
            result = update_level(&destination->part[face * destination->levels + level]->image,
                                  &source->part[face * source->levels + skipped + level]->image);
        }
    for (uint32_t i = 0; i < source->faces * source->levels; i++)
        source->part[i]->image.dirty.width = 0;
    d3d9_base_texture_changed(destination);
    return result;
}

int32_t d3d9_device_get_render_target_data(struct d3d9_device *device, struct d3d9_surface *source,
                                           struct d3d9_surface *destination)
{
    if (!source || !destination)
        return D3D9_INVALID_CALL;
    struct d3d9_image *from = &source->image, *to = &destination->image;
    if (source->resource.device != device || destination->resource.device != device)
        return D3D9_INVALID_CALL;
    if (!d3d9_surface_is_target(source) || destination->resource.pool != D3D9_POOL_SYSTEM)
        return D3D9_INVALID_CALL;
    if (from->format != to->format || from->width != to->width || from->height != to->height)
        return D3D9_INVALID_CALL;
    if (from->samples > 1 || !is_free(source) || !is_free(destination))
        return D3D9_INVALID_CALL;
    if (device->presentation.lost)
        return D3D9_DEVICE_LOST;
    int32_t result = d3d9_image_download(to, from);
    to->stale = true;
    d3d9_image_add_dirty(to, NULL);
    if (destination->texture)
        d3d9_base_texture_changed(destination->texture);
    return result;
}

/* --- The managed pool --- */

int32_t d3d9_device_evict_managed_resources(struct d3d9_device *device)
{
    for (struct d3d9_resource *r = device->presentation.resources; r; r = r->next)
        if (r->pool == D3D9_POOL_MANAGED &&
            d3d9_object_interface_is(r->object.interface, D3D9_INTERFACE_BASE_TEXTURE))
            d3d9_base_texture_evict((struct d3d9_base_texture *)r);
    return D3D9_OK;
}

/* The memory of Direct3D's default pool is the computer's. The number is one that programs expect. */
uint32_t d3d9_device_get_available_texture_mem(struct d3d9_device *device)
{
    const uint64_t all = UINT64_C(2) << 30, used = device->extended ? 0 : device->presentation.resource_bytes;
    return used < all ? (uint32_t)(all - used) : 0;
}

int32_t d3d9_device_check_resource_residency(struct d3d9_device *device, struct d3d9_object **resources,
                                             uint32_t count)
{
    (void)device;
    return count && !resources ? D3D9_INVALID_CALL : D3D9_OK;
}
