#include "surface.h"
#include "front/d3d9/adapter/check.h"
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "renderer.h"
#include "texture.h"

static void destroy(struct d3d9_object *object)
{
    struct d3d9_surface *surface = (struct d3d9_surface *)object;
    struct d3d9_device *device = surface->resource.device;
    d3d9_resource_end(&surface->resource);
    if (surface->image.has_surface)
        d3d9_renderer_destroy_image(device->renderer, &surface->image.surface);
    d3d9_image_end(&surface->image);
}

static int32_t begin_image(struct d3d9_surface *surface, const struct d3d9_surface_creation *c)
{
    struct d3d9_device *device = surface->resource.device;
    struct d3d9_image *image = &surface->image;
    const struct d3d9_format *format = d3d9_format_find(c->format);
    d3d9_image_begin(image, device, format, c->width, c->height, 1);
    image->use = &surface->use;
    image->lockable = c->lockable;
    image->samples = d3d9_check_samples(c->multi_sample_type, c->multi_sample_quality);
    if (c->user_memory)
        d3d9_image_borrow(image, c->user_memory);
    if (c->pool != D3D9_POOL_DEFAULT)
        return d3d9_image_allocate(image) ? D3D9_OK : D3D9_OUT_OF_MEMORY;
    image->home = D3D9_HOME_RENDERER;
    int32_t result = d3d9_renderer_create_image(device->renderer, format, c->width, c->height, image->samples,
                                                &image->surface);
    image->has_surface = result >= 0;
    return result;
}

int32_t d3d9_surface_make(struct d3d9_device *device, const struct d3d9_surface_creation *c,
                          struct d3d9_surface **out)
{
    struct d3d9_object *parent = &device->object;
    *out = NULL;
    struct d3d9_surface *surface = (c->implicit ? d3d9_object_make_implicit : d3d9_object_make)(
        sizeof *surface, D3D9_INTERFACE_SURFACE, parent, destroy);
    if (!surface)
        return D3D9_OUT_OF_MEMORY;
    surface->resource.object.container = c->container ? c->container : parent;
    surface->multi_sample_type = c->multi_sample_type;
    surface->multi_sample_quality = c->multi_sample_quality;
    d3d9_resource_begin(&surface->resource, device, D3D9_TYPE_SURFACE, c->usage, c->pool);
    int32_t result = begin_image(surface, c);
    if (result < 0) {
        if (c->implicit)
            d3d9_object_drop(&surface->resource.object);
        else
            d3d9_object_release(&surface->resource.object);
        return result;
    }
    d3d9_resource_count_bytes(&surface->resource, d3d9_image_bytes(&surface->image) * surface->image.samples);
    *out = surface;
    return D3D9_OK;
}

bool d3d9_surface_as_target(struct d3d9_surface *surface, struct triptych_surface *out)
{
    if (!surface->image.has_surface)
        return false;
    if (surface->texture)
        d3d9_base_texture_drawn(surface->texture);
    *out = surface->image.surface;
    return true;
}

/* --- IDirect3DSurface9 --- */

int32_t d3d9_surface_get_container(struct d3d9_surface *surface, const struct d3d9_guid *iid,
                                   void **container)
{
    return d3d9_object_query_container(&surface->resource.object, iid, container);
}

int32_t d3d9_surface_get_desc(struct d3d9_surface *surface, struct d3d9_surface_desc *desc)
{
    if (!desc)
        return D3D9_INVALID_CALL;
    *desc = (struct d3d9_surface_desc){
        .format = surface->image.format->number,
        .type = D3D9_TYPE_SURFACE,
        .usage = surface->resource.usage,
        .pool = surface->resource.pool,
        .multi_sample_type = surface->multi_sample_type,
        .multi_sample_quality = surface->multi_sample_quality,
        .width = surface->image.width,
        .height = surface->image.height,
    };
    return D3D9_OK;
}

int32_t d3d9_surface_lock_rect(struct d3d9_surface *surface, struct d3d9_locked_rect *locked,
                               const struct d3d9_rect *r, uint32_t flags)
{
    struct d3d9_image *image = &surface->image;
    if (!locked || !image->lockable)
        return D3D9_INVALID_CALL;
    struct d3d9_box box = {0, 0, 0, 0, 0, 1};
    if (r)
        box = (struct d3d9_box){r->left, r->top, r->right, r->bottom, 0, 1};
    bool strict = surface->resource.pool == D3D9_POOL_DEFAULT;
    if (surface->resource.usage & D3D9_USAGE_DYNAMIC)
        flags &= ~(uint32_t)D3D9_LOCK_NO_DIRTY_UPDATE;
    void *bits;
    int32_t result =
        d3d9_image_lock(image, r ? &box : NULL, strict ? D3D9_BOX_STRICT : D3D9_BOX_ANY, flags, &bits);
    if (result < 0)
        return result;
    locked->pitch = (int32_t)image->pitch;
    locked->bits = bits;
    return D3D9_OK;
}

/* A level of a 2D texture can be unlocked without a lock. */
int32_t d3d9_surface_unlock_rect(struct d3d9_surface *surface)
{
    struct d3d9_image *image = &surface->image;
    if (!image->lockable)
        return D3D9_INVALID_CALL;
    bool is_level = surface->texture && surface->texture->resource.type == D3D9_TYPE_TEXTURE;
    if (!image->locked && !image->use->context && is_level)
        return D3D9_OK;
    int32_t result = d3d9_image_unlock(image);
    if (surface->texture)
        d3d9_base_texture_changed(surface->texture);
    return result;
}

/* Formats of bitmaps of Windows. */
static bool has_context(uint32_t format)
{
    switch (format) {
    case TRIPTYCH_SURFACE_A8R8G8B8:
    case TRIPTYCH_SURFACE_X8R8G8B8:
    case TRIPTYCH_SURFACE_R8G8B8:
    case TRIPTYCH_SURFACE_R5G6B5:
    case TRIPTYCH_SURFACE_X1R5G5B5:
    case TRIPTYCH_SURFACE_A1R5G5B5: return true;
    default: return false;
    }
}

int32_t d3d9_surface_get_dc(struct d3d9_surface *surface, struct d3d9_host_bits *out)
{
    struct d3d9_image *image = &surface->image;
    if (!image->lockable || !has_context(image->format->number))
        return D3D9_INVALID_CALL;
    void *bits;
    int32_t result = d3d9_image_begin_context(image, &bits);
    if (result < 0)
        return result;
    *out = (struct d3d9_host_bits){(uintptr_t)bits, image->pitch, image->width, image->height,
                                   image->format->number};
    return D3D9_OK;
}

int32_t d3d9_surface_release_dc(struct d3d9_surface *surface)
{
    int32_t result = d3d9_image_end_context(&surface->image);
    if (surface->texture)
        d3d9_base_texture_changed(surface->texture);
    return result;
}
