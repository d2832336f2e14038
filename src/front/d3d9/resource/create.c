/* The creation of surfaces and textures: what Direct3D refuses. */
#include "front/d3d9/adapter/check.h"
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "texture.h"

enum { USAGE_OF_FORMAT = D3D9_USAGE_RENDER_TARGET | D3D9_USAGE_DEPTH_STENCIL | D3D9_USAGE_AUTOMATIC_MIPS };

/* Whole blocks, for the formats whose blocks are those of Direct3D itself. */
static bool blocks_fit(const struct d3d9_format *format, uint32_t width, uint32_t height)
{
    bool ati = format->number == TRIPTYCH_SURFACE_ATI1 || format->number == TRIPTYCH_SURFACE_ATI2;
    return ati || format->across < 4 || (width % format->across == 0 && height % format->side == 0);
}

static int32_t check_shared(const struct d3d9_device *device, enum d3d9_pool pool, bool user_memory_allowed)
{
    if (!device->extended)
        return D3D9_NOT_IMPLEMENTED;
    if (pool == D3D9_POOL_DEFAULT)
        return D3D9_NOT_AVAILABLE; /* resources of several devices */
    if (d3d9_memory_is_shared())
        return D3D9_NOT_AVAILABLE;
    return pool == D3D9_POOL_SYSTEM && user_memory_allowed ? D3D9_OK : D3D9_INVALID_CALL;
}

static bool usage_fits_pool(uint32_t usage, enum d3d9_pool pool)
{
    uint32_t drawn = usage & (D3D9_USAGE_RENDER_TARGET | D3D9_USAGE_DEPTH_STENCIL);
    if (drawn == (D3D9_USAGE_RENDER_TARGET | D3D9_USAGE_DEPTH_STENCIL))
        return false;
    if (drawn && (pool != D3D9_POOL_DEFAULT || usage & D3D9_USAGE_DYNAMIC))
        return false;
    if (usage & D3D9_USAGE_DYNAMIC && (pool == D3D9_POOL_MANAGED || pool == D3D9_POOL_SCRATCH))
        return false;
    if (usage & D3D9_USAGE_AUTOMATIC_MIPS && (pool == D3D9_POOL_SYSTEM || pool == D3D9_POOL_SCRATCH))
        return false;
    return !(usage & D3D9_USAGE_WRITE_ONLY);
}

static bool size_fits(const struct d3d9_texture_creation *c)
{
    bool volume = c->type == D3D9_TYPE_VOLUME_TEXTURE;
    uint32_t most = volume ? TRIPTYCH_VOLUME_MAXIMUM : TRIPTYCH_TEXTURE_MAXIMUM;
    uint32_t size = c->width > c->height ? c->width : c->height, count = 1;
    if (c->depth > size)
        size = c->depth;
    if (!c->width || !c->height || !c->depth || size > most)
        return false;
    while (size >>= 1)
        count++;
    return c->levels <= (c->usage & D3D9_USAGE_AUTOMATIC_MIPS ? 1 : count);
}

static int32_t check_texture(const struct d3d9_device *device, const struct d3d9_texture_creation *c)
{
    const struct d3d9_format *format = d3d9_format_find(c->format);
    if (!format || c->pool >= D3D9_POOL_COUNT || !size_fits(c))
        return D3D9_INVALID_CALL;
    if (device->extended && c->pool == D3D9_POOL_MANAGED)
        return D3D9_INVALID_CALL;
    if (!usage_fits_pool(c->usage, c->pool))
        return D3D9_INVALID_CALL;
    if (c->type == D3D9_TYPE_VOLUME_TEXTURE && c->usage & USAGE_OF_FORMAT)
        return D3D9_INVALID_CALL;
    if (!blocks_fit(format, c->width, c->height))
        return D3D9_INVALID_CALL;
    if (c->pool != D3D9_POOL_DEFAULT && d3d9_format_is_depth(format))
        return D3D9_INVALID_CALL;
    if (c->pool == D3D9_POOL_SCRATCH)
        return D3D9_OK;
    return d3d9_check_format(c->usage & USAGE_OF_FORMAT, c->type, c->format) < 0 ? D3D9_INVALID_CALL
                                                                                 : D3D9_OK;
}

static int32_t create_texture(struct d3d9_device *device, struct d3d9_texture_creation *c, uint64_t *shared,
                              struct d3d9_base_texture **out)
{
    bool user_memory = c->type == D3D9_TYPE_TEXTURE && c->levels == 1;
    if (!out)
        return D3D9_INVALID_CALL;
    *out = NULL;
    int32_t result = shared ? check_shared(device, c->pool, user_memory) : D3D9_OK;
    if (result < 0)
        return result;
    if (shared)
        c->user_memory = (void *)(uintptr_t)*shared;
    result = check_texture(device, c);
    return result < 0 ? result : d3d9_base_texture_make(device, c, out);
}

int32_t d3d9_device_create_texture(struct d3d9_device *device, uint32_t width, uint32_t height,
                                   uint32_t levels, uint32_t usage, uint32_t format, uint32_t pool,
                                   struct d3d9_texture **texture, uint64_t *shared)
{
    struct d3d9_texture_creation c = {D3D9_TYPE_TEXTURE, width, height, 1, levels, usage, format, pool, NULL};
    return create_texture(device, &c, shared, (struct d3d9_base_texture **)texture);
}

int32_t d3d9_device_create_cube_texture(struct d3d9_device *device, uint32_t edge, uint32_t levels,
                                        uint32_t usage, uint32_t format, uint32_t pool,
                                        struct d3d9_cube **texture, uint64_t *shared)
{
    struct d3d9_texture_creation c = {D3D9_TYPE_CUBE, edge, edge, 1, levels, usage, format, pool, NULL};
    return create_texture(device, &c, shared, (struct d3d9_base_texture **)texture);
}

int32_t d3d9_device_create_volume_texture(struct d3d9_device *device, uint32_t width, uint32_t height,
                                          uint32_t depth, uint32_t levels, uint32_t usage, uint32_t format,
                                          uint32_t pool, struct d3d9_volume_texture **texture,
                                          uint64_t *shared)
{
    struct d3d9_texture_creation c = {
        D3D9_TYPE_VOLUME_TEXTURE, width, height, depth, levels, usage, format, pool, NULL,
    };
    return create_texture(device, &c, shared, (struct d3d9_base_texture **)texture);
}

/* --- Surfaces --- */

static int32_t check_surface(const struct d3d9_surface_creation *c)
{
    const struct d3d9_format *format = d3d9_format_find(c->format);
    uint32_t drawn = c->usage & (D3D9_USAGE_RENDER_TARGET | D3D9_USAGE_DEPTH_STENCIL);
    uint32_t samples = d3d9_check_samples(c->multi_sample_type, c->multi_sample_quality);
    uint32_t most = TRIPTYCH_TARGET_MAXIMUM;
    if (!format || !c->width || !c->height || c->width > most || c->height > most)
        return D3D9_INVALID_CALL;
    if (c->pool >= D3D9_POOL_COUNT || c->pool == D3D9_POOL_MANAGED)
        return D3D9_INVALID_CALL;
    if (!samples || (samples > 1 && c->lockable && !(drawn & D3D9_USAGE_DEPTH_STENCIL)))
        return D3D9_INVALID_CALL;
    if (!blocks_fit(format, c->width, c->height))
        return D3D9_INVALID_CALL;
    if (c->pool == D3D9_POOL_SCRATCH)
        return d3d9_format_is_depth(format) ? D3D9_INVALID_CALL : D3D9_OK;
    return d3d9_check_format(drawn, D3D9_TYPE_SURFACE, c->format) < 0 ? D3D9_INVALID_CALL : D3D9_OK;
}

static int32_t create_surface(struct d3d9_device *device, struct d3d9_surface_creation *c, uint64_t *shared,
                              struct d3d9_surface **out)
{
    if (!out)
        return D3D9_INVALID_CALL;
    *out = NULL;
    int32_t result = shared ? check_shared(device, c->pool, true) : D3D9_OK;
    if (result < 0)
        return result;
    if (shared)
        c->user_memory = (void *)(uintptr_t)*shared;
    result = check_surface(c);
    return result < 0 ? result : d3d9_surface_make(device, c, out);
}

enum { USAGE_OF_EX = D3D9_USAGE_RESTRICTED_CONTENT | D3D9_USAGE_RESTRICT_SHARED_RESOURCE };

int32_t d3d9_device_create_render_target_ex(struct d3d9_device *device, uint32_t width, uint32_t height,
                                            uint32_t format, uint32_t samples, uint32_t quality,
                                            int32_t lockable, struct d3d9_surface **surface, uint64_t *shared,
                                            uint32_t usage)
{
    struct d3d9_surface_creation c = {
        .width = width,
        .height = height,
        .format = format,
        .usage = usage | D3D9_USAGE_RENDER_TARGET,
        .pool = D3D9_POOL_DEFAULT,
        .multi_sample_type = samples,
        .multi_sample_quality = quality,
        .lockable = lockable,
    };
    if (usage & ~(uint32_t)USAGE_OF_EX)
        return D3D9_INVALID_CALL;
    return create_surface(device, &c, shared, surface);
}

int32_t d3d9_device_create_render_target(struct d3d9_device *device, uint32_t width, uint32_t height,
                                         uint32_t format, uint32_t samples, uint32_t quality,
                                         int32_t lockable, struct d3d9_surface **surface, uint64_t *shared)
{
    return d3d9_device_create_render_target_ex(device, width, height, format, samples, quality, lockable,
                                               surface, shared, 0);
}

int32_t d3d9_device_create_depth_stencil_surface_ex(struct d3d9_device *device, uint32_t width,
                                                    uint32_t height, uint32_t format, uint32_t samples,
                                                    uint32_t quality, int32_t discard,
                                                    struct d3d9_surface **surface, uint64_t *shared,
                                                    uint32_t usage)
{
    (void)discard;
    struct d3d9_surface_creation c = {
        .width = width,
        .height = height,
        .format = format,
        .usage = usage | D3D9_USAGE_DEPTH_STENCIL,
        .pool = D3D9_POOL_DEFAULT,
        .multi_sample_type = samples,
        .multi_sample_quality = quality,
        .lockable = format == TRIPTYCH_SURFACE_D16_LOCKABLE || format == TRIPTYCH_SURFACE_D32F_LOCKABLE,
    };
    if (usage & ~(uint32_t)USAGE_OF_EX)
        return D3D9_INVALID_CALL;
    return create_surface(device, &c, shared, surface);
}

int32_t d3d9_device_create_depth_stencil_surface(struct d3d9_device *device, uint32_t width, uint32_t height,
                                                 uint32_t format, uint32_t samples, uint32_t quality,
                                                 int32_t discard, struct d3d9_surface **surface,
                                                 uint64_t *shared)
{
    return d3d9_device_create_depth_stencil_surface_ex(device, width, height, format, samples, quality,
                                                       discard, surface, shared, 0);
}

int32_t d3d9_device_create_offscreen_plain_surface_ex(struct d3d9_device *device, uint32_t width,
                                                      uint32_t height, uint32_t format, uint32_t pool,
                                                      struct d3d9_surface **surface, uint64_t *shared,
                                                      uint32_t usage)
{
    struct d3d9_surface_creation c = {
        .width = width,
        .height = height,
        .format = format,
        .usage = usage,
        .pool = pool,
        .lockable = true,
    };
    if (surface && usage)
        *surface = NULL;
    if (usage & ~(uint32_t)USAGE_OF_EX)
        return D3D9_INVALID_CALL;
    return create_surface(device, &c, shared, surface);
}

int32_t d3d9_device_create_offscreen_plain_surface(struct d3d9_device *device, uint32_t width,
                                                   uint32_t height, uint32_t format, uint32_t pool,
                                                   struct d3d9_surface **surface, uint64_t *shared)
{
    return d3d9_device_create_offscreen_plain_surface_ex(device, width, height, format, pool, surface, shared,
                                                         0);
}
