/* Surfaces: by themselves, or levels of a texture. Also volumes, which are levels of a volume texture. */
#ifndef D3D9_SURFACE_H
#define D3D9_SURFACE_H

#include "image.h"

struct d3d9_base_texture;

/* Surfaces and volumes have one structure. A volume is not a resource in Direct3D. */
struct d3d9_surface {
    struct d3d9_resource resource;
    struct d3d9_image image;
    struct d3d9_image_use use; /* unless it belongs to a texture */
    uint32_t multi_sample_type, multi_sample_quality;
    struct d3d9_base_texture *texture; /* null: by itself */
};

struct d3d9_volume {
    struct d3d9_surface base;
};

/* The description of a surface by itself. */
struct d3d9_surface_creation {
    uint32_t width, height, format, usage;
    enum d3d9_pool pool;
    uint32_t multi_sample_type, multi_sample_quality;
    bool lockable;
    bool implicit;                 /* belongs to the device or a swap chain: no reference of the program */
    struct d3d9_object *container; /* null: the device */
    void *user_memory;             /* of the program, in the system pool; null: none */
};

/* Makes a surface without checks. *out is null after a failure. */
int32_t d3d9_surface_make(struct d3d9_device *, const struct d3d9_surface_creation *,
                          struct d3d9_surface **out);

static inline bool d3d9_surface_is_target(const struct d3d9_surface *surface)
{
    return surface->resource.usage & D3D9_USAGE_RENDER_TARGET;
}
static inline bool d3d9_surface_is_depth(const struct d3d9_surface *surface)
{
    return surface->resource.usage & D3D9_USAGE_DEPTH_STENCIL;
}

/* The renderer's surface of a target or depth surface that is attached. The levels below it that Direct3D
 * generates are old from now on. Returns false if it has none. */
bool d3d9_surface_as_target(struct d3d9_surface *, struct triptych_surface *);

#endif
