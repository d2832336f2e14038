#include "texture.h"
#include "front/d3d9/device.h"
#include "renderer.h"

static uint32_t level_size(uint32_t size, uint32_t level)
{
    size >>= level;
    return size ? size : 1;
}

static void destroy(struct d3d9_object *object)
{
    struct d3d9_base_texture *texture = (struct d3d9_base_texture *)object;
    for (uint32_t i = 0; texture->part && i < texture->faces * texture->levels; i++)
        if (texture->part[i])
            d3d9_object_free_part(&texture->part[i]->resource.object);
    d3d9_resource_end(&texture->resource);
    if (texture->renderer)
        triptych_texture_destroy(texture->resource.device->renderer, texture->renderer);
    d3d9_memory_free(texture->part);
    d3d9_memory_free(texture->memory);
}

static int32_t make_renderer(struct d3d9_base_texture *texture)
{
    static const enum triptych_texture_type types[] = {
        [D3D9_TYPE_TEXTURE] = TRIPTYCH_TEXTURE_2D,
        [D3D9_TYPE_CUBE] = TRIPTYCH_TEXTURE_CUBE,
        [D3D9_TYPE_VOLUME_TEXTURE] = TRIPTYCH_TEXTURE_VOLUME,
    };
    /* A target that keeps nothing is never sampled. */
    bool nothing = texture->format->number == TRIPTYCH_SURFACE_NULL;
    const struct triptych_texture_description description = {
        .type = types[texture->resource.type],
        .format = nothing ? TRIPTYCH_SURFACE_A8R8G8B8 : (enum triptych_surface_format)texture->format->number,
        .width = texture->width,
        .height = texture->height,
        .depth = texture->depth,
        .levels = texture->levels,
    };
    enum triptych_result result =
        triptych_texture_define(texture->resource.device->renderer, &description, &texture->renderer);
    for (uint32_t i = 0; !result && i < texture->faces * texture->levels; i++) {
        struct d3d9_image *image = &texture->part[i]->image;
        image->surface = (struct triptych_surface){
            .texture = texture->renderer, .level = i % texture->levels, .slice = i / texture->levels};
        image->face = i / texture->levels;
        image->has_surface = image->is_texture = true;
    }
    return d3d9_renderer_result(result);
}

/* Images are in the memory of the texture, by faces, then by levels. A face begins at a multiple of 16. */
static int32_t make_memory(struct d3d9_base_texture *texture)
{
    enum { ALIGNMENT = 16 };
    size_t bytes = 0;
    for (int pass = 0; pass < 2; pass++) {
        bytes = 0;
        for (uint32_t i = 0; i < texture->faces * texture->levels; i++) {
            struct d3d9_image *image = &texture->part[i]->image;
            if (i % texture->levels == 0)
                bytes = (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
            if (pass)
                image->memory = texture->memory + bytes;
            image->borrowed = true;
            bytes += d3d9_image_bytes(image);
        }
        if (!pass)
            texture->memory = d3d9_memory_allocate(bytes);
        if (!texture->memory)
            return D3D9_OUT_OF_MEMORY;
    }
    return D3D9_OK;
}

/* ATI1 and ATI2 are lockable in every pool. */
static bool is_lockable(const struct d3d9_base_texture *texture)
{
    uint32_t format = texture->format->number;
    return texture->resource.pool != D3D9_POOL_DEFAULT || texture->resource.usage & D3D9_USAGE_DYNAMIC ||
           format == TRIPTYCH_SURFACE_ATI1 || format == TRIPTYCH_SURFACE_ATI2;
}

static struct d3d9_surface *make_part(struct d3d9_base_texture *texture, uint32_t level)
{
    bool volume = texture->resource.type == D3D9_TYPE_VOLUME_TEXTURE;
    struct d3d9_surface *part = d3d9_object_make_part(
        sizeof *part, volume ? D3D9_INTERFACE_VOLUME : D3D9_INTERFACE_SURFACE, &texture->resource.object);
    if (!part)
        return NULL;
    part->resource.type = volume ? D3D9_TYPE_VOLUME : D3D9_TYPE_SURFACE;
    part->resource.device = texture->resource.device;
    part->resource.pool = texture->resource.pool;
    part->resource.usage = texture->resource.usage;
    part->texture = texture;
    d3d9_image_begin(&part->image, texture->resource.device, texture->format,
                     level_size(texture->width, level), level_size(texture->height, level),
                     level_size(texture->depth, level));
    part->image.use = &texture->use;
    part->image.lockable = is_lockable(texture);
    part->image.home = part->image.lockable ? D3D9_HOME_MEMORY : D3D9_HOME_RENDERER;
    return part;
}

static int32_t make_parts(struct d3d9_base_texture *texture)
{
    uint32_t count = texture->faces * texture->levels;
    texture->part = d3d9_memory_allocate(count * sizeof *texture->part);
    if (!texture->part)
        return D3D9_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        texture->part[i] = make_part(texture, i % texture->levels);
        if (!texture->part[i])
            return D3D9_OUT_OF_MEMORY;
    }
    return D3D9_OK;
}

static int32_t make_contents(struct d3d9_base_texture *texture, void *user_memory)
{
    uint64_t bytes = 0;
    int32_t result = make_parts(texture);
    if (result < 0)
        return result;
    for (uint32_t i = 0; i < texture->faces * texture->levels; i++) {
        d3d9_image_add_dirty(&texture->part[i]->image, NULL);
        texture->part[i]->image.stale = true;
        bytes += d3d9_image_bytes(&texture->part[i]->image);
    }
    if (user_memory)
        d3d9_image_borrow(&texture->part[0]->image, user_memory);
    else if (is_lockable(texture))
        result = make_memory(texture);
    if (result < 0)
        return result;
    d3d9_resource_count_bytes(&texture->resource, bytes);
    texture->pending = true;
    return texture->resource.pool == D3D9_POOL_DEFAULT ? make_renderer(texture) : D3D9_OK;
}

static uint32_t level_count(const struct d3d9_texture_creation *c)
{
    uint32_t size = c->width > c->height ? c->width : c->height, count = 1;
    if (c->depth > size)
        size = c->depth;
    while (size >>= 1)
        count++;
    bool all = !c->levels || c->usage & D3D9_USAGE_AUTOMATIC_MIPS;
    return all ? count : c->levels;
}

int32_t d3d9_base_texture_make(struct d3d9_device *device, const struct d3d9_texture_creation *c,
                               struct d3d9_base_texture **out)
{
    enum { FILTER_LINEAR = 2 };
    static const enum d3d9_interface interfaces[] = {
        [D3D9_TYPE_TEXTURE] = D3D9_INTERFACE_TEXTURE,
        [D3D9_TYPE_CUBE] = D3D9_INTERFACE_CUBE,
        [D3D9_TYPE_VOLUME_TEXTURE] = D3D9_INTERFACE_VOLUME_TEXTURE,
    };
    *out = NULL;
    struct d3d9_base_texture *texture =
        d3d9_object_make(sizeof *texture, interfaces[c->type], &device->object, destroy);
    if (!texture)
        return D3D9_OUT_OF_MEMORY;
    d3d9_resource_begin(&texture->resource, device, c->type, c->usage, c->pool);
    texture->format = d3d9_format_find(c->format);
    texture->width = c->width;
    texture->height = c->height;
    texture->depth = c->depth;
    texture->faces = c->type == D3D9_TYPE_CUBE ? 6 : 1;
    texture->levels = level_count(c);
    texture->visible_levels = c->usage & D3D9_USAGE_AUTOMATIC_MIPS ? 1 : texture->levels;
    texture->mip_filter = FILTER_LINEAR;
    int32_t result = make_contents(texture, c->user_memory);
    if (result < 0)
        d3d9_object_release(&texture->resource.object);
    else
        *out = texture;
    return result;
}

struct d3d9_surface *d3d9_base_texture_part(struct d3d9_base_texture *texture, uint32_t face, uint32_t level)
{
    if (face >= texture->faces || level >= texture->visible_levels)
        return NULL;
    return texture->part[face * texture->levels + level];
}

void d3d9_base_texture_drawn(struct d3d9_base_texture *texture)
{
    if (!(texture->resource.usage & D3D9_USAGE_AUTOMATIC_MIPS))
        return;
    texture->old_levels = true;
    texture->pending = true;
}

void d3d9_base_texture_changed(struct d3d9_base_texture *texture)
{
    texture->pending = true;
    if (texture->resource.usage & D3D9_USAGE_AUTOMATIC_MIPS)
        texture->old_levels = true;
}

void d3d9_base_texture_evict(struct d3d9_base_texture *texture)
{
    for (uint32_t i = 0; i < texture->faces * texture->levels; i++)
        d3d9_image_add_dirty(&texture->part[i]->image, NULL);
    d3d9_base_texture_changed(texture);
}

/* Textures of the system pool are uploaded whole: their dirty boxes are those of UpdateTexture. */
static int32_t upload(struct d3d9_base_texture *texture)
{
    int32_t result = D3D9_OK;
    for (uint32_t i = 0; result >= 0 && i < texture->faces * texture->levels; i++) {
        struct d3d9_image *image = &texture->part[i]->image;
        const struct triptych_box whole = d3d9_image_box(image);
        if (image->home == D3D9_HOME_RENDERER || i % texture->levels >= texture->visible_levels)
            continue;
        if (texture->resource.pool != D3D9_POOL_SYSTEM)
            result = d3d9_image_upload(image);
        else if (image->stale)
            result = d3d9_image_upload_box(image, 0, 0, 0, image, &whole);
        image->stale = false;
    }
    return result;
}

triptych_texture *d3d9_base_texture_use(struct d3d9_base_texture *texture)
{
    if (!texture->pending)
        return texture->renderer;
    if (texture->resource.pool == D3D9_POOL_SCRATCH)
        return NULL;
    if (!texture->renderer && make_renderer(texture) < 0)
        return NULL;
    if (upload(texture) < 0)
        return NULL;
    if (texture->old_levels && texture->levels > 1 &&
        triptych_texture_generate_mips(texture->resource.device->renderer, texture->renderer) != TRIPTYCH_OK)
        return NULL;
    texture->old_levels = false;
    texture->pending = false;
    return texture->renderer;
}
