/* The methods of textures: IDirect3DBaseTexture9, IDirect3DTexture9, IDirect3DCubeTexture9,
 * IDirect3DVolumeTexture9 and IDirect3DVolume9. */
#include "front/d3d9/call.h"
#include "texture.h"

/* --- All textures --- */

uint32_t d3d9_base_texture_set_lod(struct d3d9_base_texture *texture, uint32_t lod)
{
    uint32_t old = texture->lod;
    if (texture->resource.pool != D3D9_POOL_MANAGED)
        return 0;
    texture->lod = lod < texture->levels ? lod : texture->levels - 1;
    return old;
}

uint32_t d3d9_base_texture_get_lod(struct d3d9_base_texture *texture)
{
    return texture->lod;
}

uint32_t d3d9_base_texture_get_level_count(struct d3d9_base_texture *texture)
{
    return texture->visible_levels;
}

int32_t d3d9_base_texture_set_auto_gen_filter_type(struct d3d9_base_texture *texture, uint32_t filter)
{
    enum { FILTER_NONE = 0 };
    if (filter == FILTER_NONE)
        return D3D9_INVALID_CALL;
    texture->mip_filter = filter;
    return D3D9_OK;
}

uint32_t d3d9_base_texture_get_auto_gen_filter_type(struct d3d9_base_texture *texture)
{
    return texture->mip_filter;
}

void d3d9_base_texture_generate_mip_sub_levels(struct d3d9_base_texture *texture)
{
    d3d9_base_texture_drawn(texture);
}

/* Uploads a resource of the managed pool. */
void d3d9_object_pre_load(struct d3d9_object *object)
{
    if (d3d9_object_interface_is(object->interface, D3D9_INTERFACE_BASE_TEXTURE))
        d3d9_base_texture_use((struct d3d9_base_texture *)object);
    else if (object->interface == D3D9_INTERFACE_SURFACE && ((struct d3d9_surface *)object)->texture)
        d3d9_base_texture_use(((struct d3d9_surface *)object)->texture);
}

static int32_t get_part(struct d3d9_base_texture *texture, uint32_t face, uint32_t level, void **out)
{
    if (!out)
        return D3D9_INVALID_CALL;
    struct d3d9_surface *part = d3d9_base_texture_part(texture, face, level);
    *out = part;
    if (!part)
        return D3D9_INVALID_CALL;
    d3d9_object_add_ref(&part->resource.object);
    return D3D9_OK;
}

static int32_t get_surface_desc(struct d3d9_base_texture *texture, uint32_t level,
                                struct d3d9_surface_desc *desc)
{
    struct d3d9_surface *part = d3d9_base_texture_part(texture, 0, level);
    return part ? d3d9_surface_get_desc(part, desc) : D3D9_INVALID_CALL;
}

static int32_t lock_rect(struct d3d9_base_texture *texture, uint32_t face, uint32_t level,
                         struct d3d9_locked_rect *locked, const struct d3d9_rect *rectangle, uint32_t flags)
{
    struct d3d9_surface *part = d3d9_base_texture_part(texture, face, level);
    return part ? d3d9_surface_lock_rect(part, locked, rectangle, flags) : D3D9_INVALID_CALL;
}

/* Adds a part of level 0 of a face, and what it covers of the other levels. Only textures that the program
 * can write outside of the default pool have dirty boxes. */
static int32_t add_dirty(struct d3d9_base_texture *texture, uint32_t face, const struct d3d9_box *box)
{
    struct d3d9_surface *first = d3d9_base_texture_part(texture, face, 0);
    if (!first)
        return D3D9_INVALID_CALL;
    if (box && (box->left >= box->right || box->top >= box->bottom || box->front >= box->back ||
                box->right > texture->width || box->bottom > texture->height || box->back > texture->depth))
        return D3D9_INVALID_CALL;
    if (texture->resource.pool == D3D9_POOL_DEFAULT)
        return D3D9_OK;
    for (uint32_t level = 0; level < texture->visible_levels; level++) {
        struct d3d9_image *image = &texture->part[face * texture->levels + level]->image;
        if (!box) {
            d3d9_image_add_dirty(image, NULL);
            continue;
        }
        const struct triptych_box scaled = {
            .x = box->left >> level,
            .y = box->top >> level,
            .z = box->front >> level,
            .width = ((box->right - 1) >> level) - (box->left >> level) + 1,
            .height = ((box->bottom - 1) >> level) - (box->top >> level) + 1,
            .depth = ((box->back - 1) >> level) - (box->front >> level) + 1,
        };
        d3d9_image_add_dirty(image, &scaled);
    }
    d3d9_base_texture_changed(texture);
    return D3D9_OK;
}

static int32_t add_dirty_rectangle(struct d3d9_base_texture *texture, uint32_t face,
                                   const struct d3d9_rect *r)
{
    if (!r)
        return add_dirty(texture, face, NULL);
    if (r->left < 0 || r->top < 0 || r->right < 0 || r->bottom < 0)
        return D3D9_INVALID_CALL;
    const struct d3d9_box box = {r->left, r->top, r->right, r->bottom, 0, 1};
    return add_dirty(texture, face, &box);
}

/* --- 2D --- */

int32_t d3d9_texture_get_level_desc(struct d3d9_texture *texture, uint32_t level,
                                    struct d3d9_surface_desc *desc)
{
    return get_surface_desc(&texture->base, level, desc);
}

int32_t d3d9_texture_get_surface_level(struct d3d9_texture *texture, uint32_t level,
                                       struct d3d9_surface **surface)
{
    return get_part(&texture->base, 0, level, (void **)surface);
}

int32_t d3d9_texture_lock_rect(struct d3d9_texture *texture, uint32_t level, struct d3d9_locked_rect *locked,
                               const struct d3d9_rect *rectangle, uint32_t flags)
{
    return lock_rect(&texture->base, 0, level, locked, rectangle, flags);
}

int32_t d3d9_texture_unlock_rect(struct d3d9_texture *texture, uint32_t level)
{
    struct d3d9_surface *part = d3d9_base_texture_part(&texture->base, 0, level);
    return part ? d3d9_surface_unlock_rect(part) : D3D9_INVALID_CALL;
}

int32_t d3d9_texture_add_dirty_rect(struct d3d9_texture *texture, const struct d3d9_rect *rectangle)
{
    return add_dirty_rectangle(&texture->base, 0, rectangle);
}

/* --- Cube --- */

int32_t d3d9_cube_get_level_desc(struct d3d9_cube *texture, uint32_t level, struct d3d9_surface_desc *desc)
{
    return get_surface_desc(&texture->base, level, desc);
}

int32_t d3d9_cube_get_cube_map_surface(struct d3d9_cube *texture, uint32_t face, uint32_t level,
                                       struct d3d9_surface **surface)
{
    return get_part(&texture->base, face, level, (void **)surface);
}

int32_t d3d9_cube_lock_rect(struct d3d9_cube *texture, uint32_t face, uint32_t level,
                            struct d3d9_locked_rect *locked, const struct d3d9_rect *rectangle,
                            uint32_t flags)
{
    return lock_rect(&texture->base, face, level, locked, rectangle, flags);
}

/* A face that is not locked can be unlocked, unlike its surface. */
int32_t d3d9_cube_unlock_rect(struct d3d9_cube *texture, uint32_t face, uint32_t level)
{
    struct d3d9_surface *part = d3d9_base_texture_part(&texture->base, face, level);
    if (!part)
        return D3D9_INVALID_CALL;
    return part->image.lockable && !part->image.locked ? D3D9_OK : d3d9_surface_unlock_rect(part);
}

int32_t d3d9_cube_add_dirty_rect(struct d3d9_cube *texture, uint32_t face, const struct d3d9_rect *rectangle)
{
    return add_dirty_rectangle(&texture->base, face, rectangle);
}

/* --- Volume --- */

int32_t d3d9_volume_texture_get_level_desc(struct d3d9_volume_texture *texture, uint32_t level,
                                           struct d3d9_volume_desc *desc)
{
    struct d3d9_surface *part = d3d9_base_texture_part(&texture->base, 0, level);
    return part ? d3d9_volume_get_desc((struct d3d9_volume *)part, desc) : D3D9_INVALID_CALL;
}

int32_t d3d9_volume_texture_get_volume_level(struct d3d9_volume_texture *texture, uint32_t level,
                                             struct d3d9_volume **volume)
{
    return get_part(&texture->base, 0, level, (void **)volume);
}

int32_t d3d9_volume_texture_lock_box(struct d3d9_volume_texture *texture, uint32_t level,
                                     struct d3d9_locked_box *locked, const struct d3d9_box *box,
                                     uint32_t flags)
{
    struct d3d9_surface *part = d3d9_base_texture_part(&texture->base, 0, level);
    return part ? d3d9_volume_lock_box((struct d3d9_volume *)part, locked, box, flags) : D3D9_INVALID_CALL;
}

int32_t d3d9_volume_texture_unlock_box(struct d3d9_volume_texture *texture, uint32_t level)
{
    struct d3d9_surface *part = d3d9_base_texture_part(&texture->base, 0, level);
    return part ? d3d9_volume_unlock_box((struct d3d9_volume *)part) : D3D9_INVALID_CALL;
}

int32_t d3d9_volume_texture_add_dirty_box(struct d3d9_volume_texture *texture, const struct d3d9_box *box)
{
    return add_dirty(&texture->base, 0, box);
}

int32_t d3d9_volume_get_container(struct d3d9_volume *volume, const struct d3d9_guid *iid, void **container)
{
    return d3d9_object_query_container(&volume->base.resource.object, iid, container);
}

int32_t d3d9_volume_get_desc(struct d3d9_volume *volume, struct d3d9_volume_desc *desc)
{
    const struct d3d9_surface *part = &volume->base;
    if (!desc)
        return D3D9_INVALID_CALL;
    *desc = (struct d3d9_volume_desc){
        .format = part->image.format->number,
        .type = D3D9_TYPE_VOLUME,
        .usage = part->resource.usage,
        .pool = part->resource.pool,
        .width = part->image.width,
        .height = part->image.height,
        .depth = part->image.depth,
    };
    return D3D9_OK;
}

int32_t d3d9_volume_lock_box(struct d3d9_volume *volume, struct d3d9_locked_box *locked,
                             const struct d3d9_box *box, uint32_t flags)
{
    struct d3d9_image *image = &volume->base.image;
    if (!locked)
        return D3D9_INVALID_CALL;
    if (!image->lockable) {
        *locked = (struct d3d9_locked_box){0};
        return D3D9_INVALID_CALL;
    }
    if (volume->base.resource.usage & D3D9_USAGE_DYNAMIC)
        flags &= ~(uint32_t)D3D9_LOCK_NO_DIRTY_UPDATE;
    void *bits;
    int32_t result = d3d9_image_lock(image, box, D3D9_BOX_STRICT, flags, &bits);
    if (result < 0)
        return result;
    *locked = (struct d3d9_locked_box){(int32_t)image->pitch, (int32_t)image->slice_bytes, bits};
    return D3D9_OK;
}

int32_t d3d9_volume_unlock_box(struct d3d9_volume *volume)
{
    int32_t result = d3d9_image_unlock(&volume->base.image);
    d3d9_base_texture_changed(volume->base.texture);
    return result;
}
