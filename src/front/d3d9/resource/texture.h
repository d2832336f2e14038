/* Textures: 2D, cube and volume.
 *
 * A texture has `faces` x `levels` parts: surfaces, or volumes. The program reaches the first
 * `visible_levels`; a texture whose levels Direct3D generates shows only one. */
#ifndef D3D9_TEXTURE_H
#define D3D9_TEXTURE_H

#include "surface.h"

struct d3d9_base_texture {
    struct d3d9_resource resource;
    const struct d3d9_format *format;
    uint32_t width, height, depth, faces, levels, visible_levels;
    triptych_texture *renderer; /* null: not made yet, or of the scratch pool */
    uint8_t *memory;            /* of all images; null: their home is the renderer */
    struct d3d9_image_use use;
    struct d3d9_surface **part; /* [face * levels + level] */
    bool pending;               /* an image was changed in memory, or the generated levels are old */
    bool old_levels;
    uint32_t lod;        /* the first level that is sampled; of the managed pool */
    uint32_t mip_filter; /* D3DTEXTUREFILTERTYPE of generated levels */
};

struct d3d9_texture {
    struct d3d9_base_texture base;
};
struct d3d9_cube {
    struct d3d9_base_texture base;
};
struct d3d9_volume_texture {
    struct d3d9_base_texture base;
};

struct d3d9_texture_creation {
    enum d3d9_resource_type type;
    uint32_t width, height, depth, levels, usage, format;
    enum d3d9_pool pool;
    void *user_memory; /* of the program, in the system pool; null: none */
};

/* Makes a texture without checks. *out is null after a failure. */
int32_t d3d9_base_texture_make(struct d3d9_device *, const struct d3d9_texture_creation *,
                               struct d3d9_base_texture **out);

/* The renderer's texture with the current contents, before a draw samples it: uploads what is newer in
 * memory and generates levels. Null if it cannot be sampled. It is cheap while `pending` is false. */
triptych_texture *d3d9_base_texture_use(struct d3d9_base_texture *);
/* A surface of it is drawn to, or written by the renderer. */
void d3d9_base_texture_drawn(struct d3d9_base_texture *);
/* An image has changed in memory, or was uploaded by itself. */
void d3d9_base_texture_changed(struct d3d9_base_texture *);
/* Everything in memory is newer than in the renderer (EvictManagedResources). */
void d3d9_base_texture_evict(struct d3d9_base_texture *);

/* The part of a face and level; null if there is none that the program can reach. */
struct d3d9_surface *d3d9_base_texture_part(struct d3d9_base_texture *, uint32_t face, uint32_t level);

#endif
