/* Copies and fills within the default pool: StretchRect, ColorFill. */
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "renderer.h"
#include "texture.h"

enum { FILTER_NONE = 0, FILTER_POINT = 1, FILTER_LINEAR = 2 };

static bool is_plain(const struct d3d9_surface *surface)
{
    return !surface->texture && !d3d9_surface_is_target(surface) && !d3d9_surface_is_depth(surface);
}

static bool is_whole(const struct d3d9_surface *surface, const struct d3d9_rect *r)
{
    return !r || (!r->left && !r->top && (uint32_t)r->right == surface->image.width &&
                  (uint32_t)r->bottom == surface->image.height);
}

/* Returns false for a rectangle that is empty, mirrored, not inside the surface, or not of whole blocks. */
static bool make_rectangle(const struct d3d9_surface *surface, const struct d3d9_rect *r,
                           struct triptych_rectangle *out)
{
    const struct d3d9_image *image = &surface->image;
    const struct d3d9_rect whole = {0, 0, (int32_t)image->width, (int32_t)image->height};
    if (!r)
        r = &whole;
    if (r->left < 0 || r->top < 0 || r->left >= r->right || r->top >= r->bottom)
        return false;
    if ((uint32_t)r->right > image->width || (uint32_t)r->bottom > image->height)
        return false;
    const struct d3d9_box box = {r->left, r->top, r->right, r->bottom, 0, 1};
    *out = (struct triptych_rectangle){r->left, r->top, r->right - r->left, r->bottom - r->top};
    return d3d9_image_box_fits(image, &box);
}

/* Depth surfaces are copied whole, outside of scenes, to a surface of the same format and size. */
static int32_t check_depth(const struct d3d9_device *device, const struct d3d9_surface *source,
                           const struct d3d9_rect *part, const struct d3d9_surface *target,
                           const struct d3d9_rect *target_part)
{
    const struct d3d9_image *from = &source->image, *to = &target->image;
    if (!d3d9_surface_is_depth(source) || !d3d9_surface_is_depth(target))
        return D3D9_INVALID_CALL;
    if (source->texture || target->texture || device->in_scene)
        return D3D9_INVALID_CALL;
    if (from->format != to->format || from->width != to->width || from->height != to->height)
        return D3D9_INVALID_CALL;
    return is_whole(source, part) && is_whole(target, target_part) ? D3D9_OK : D3D9_INVALID_CALL;
}

static int32_t check_color(const struct d3d9_surface *source, const struct triptych_rectangle *part,
                           const struct d3d9_surface *target, const struct triptych_rectangle *target_part)
{
    const struct d3d9_image *from = &source->image, *to = &target->image;
    bool scales = part->width != target_part->width || part->height != target_part->height;
    if (is_plain(target) && (!is_plain(source) || scales))
        return D3D9_INVALID_CALL;
    if (!is_plain(target) && !d3d9_surface_is_target(target))
        return D3D9_INVALID_CALL;
    bool convertible = from->format == to->format || to->format->drawn == D3D9_DRAWN_COLOR;
    return convertible ? D3D9_OK : D3D9_INVALID_CALL;
}

static int32_t copy(struct d3d9_device *device, struct d3d9_surface *source,
                    const struct triptych_rectangle *part, struct d3d9_surface *target,
                    const struct triptych_rectangle *target_part, uint32_t filter)
{
    bool linear = filter == FILTER_LINEAR && !d3d9_surface_is_depth(source);
    if (source->texture)
        d3d9_base_texture_use(source->texture);
    if (!source->image.has_surface)
        return D3D9_INVALID_CALL;
    enum triptych_result result =
        triptych_copy(device->renderer, &source->image.surface, part, &target->image.surface, target_part,
                      linear ? TRIPTYCH_COPY_LINEAR : TRIPTYCH_COPY_POINT);
    if (target->texture)
        d3d9_base_texture_drawn(target->texture);
    return d3d9_renderer_result(result);
}

int32_t d3d9_device_stretch_rect(struct d3d9_device *device, struct d3d9_surface *source,
                                 const struct d3d9_rect *source_rectangle, struct d3d9_surface *target,
                                 const struct d3d9_rect *target_rectangle, uint32_t filter)
{
    struct triptych_rectangle part, target_part;
    if (!source || !target || source == target || filter > FILTER_LINEAR)
        return D3D9_INVALID_CALL;
    if (source->resource.device != device || target->resource.device != device)
        return D3D9_INVALID_CALL;
    if (source->resource.pool != D3D9_POOL_DEFAULT || target->resource.pool != D3D9_POOL_DEFAULT)
        return D3D9_INVALID_CALL;
    if (source->image.locked || target->image.locked)
        return D3D9_INVALID_CALL;
    if (!make_rectangle(source, source_rectangle, &part))
        return D3D9_INVALID_CALL;
    if (!make_rectangle(target, target_rectangle, &target_part))
        return D3D9_INVALID_CALL;
    bool depth = d3d9_surface_is_depth(source) || d3d9_surface_is_depth(target);
    int32_t result = depth ? check_depth(device, source, source_rectangle, target, target_rectangle)
                           : check_color(source, &part, target, &target_part);
    return result < 0 ? result : copy(device, source, &part, target, &target_part, filter);
}

int32_t d3d9_device_color_fill(struct d3d9_device *device, struct d3d9_surface *surface,
                               const struct d3d9_rect *rectangle, uint32_t color)
{
    const float rgba[4] = {(color >> 16 & 255) / 255.0f, (color >> 8 & 255) / 255.0f, (color & 255) / 255.0f,
                           (color >> 24) / 255.0f};
    struct triptych_rectangle part;
    if (!surface || surface->resource.device != device || surface->resource.pool != D3D9_POOL_DEFAULT)
        return D3D9_INVALID_CALL;
    if (!is_plain(surface) && !d3d9_surface_is_target(surface))
        return D3D9_INVALID_CALL;
    if (surface->image.locked || !surface->image.has_surface)
        return D3D9_INVALID_CALL;
    if (!make_rectangle(surface, rectangle, &part))
        return D3D9_INVALID_CALL;
    int32_t result = d3d9_renderer_fill(device->renderer, &surface->image.surface, &part, rgba);
    if (surface->texture)
        d3d9_base_texture_drawn(surface->texture);
    return result;
}
