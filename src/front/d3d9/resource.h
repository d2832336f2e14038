/* The base of surfaces, textures and buffers: their pool, usage and priority. Volumes are not resources in
 * Direct3D, and have these too.
 *
 * Numbers are Direct3D's. */
#ifndef D3D9_RESOURCE_H
#define D3D9_RESOURCE_H

#include "object.h"

struct d3d9_device;

/* D3DRESOURCETYPE */
enum d3d9_resource_type {
    D3D9_TYPE_SURFACE = 1,
    D3D9_TYPE_VOLUME,
    D3D9_TYPE_TEXTURE,
    D3D9_TYPE_VOLUME_TEXTURE,
    D3D9_TYPE_CUBE,
    D3D9_TYPE_VERTEX_BUFFER,
    D3D9_TYPE_INDEX_BUFFER
};

/* D3DPOOL */
enum d3d9_pool { D3D9_POOL_DEFAULT, D3D9_POOL_MANAGED, D3D9_POOL_SYSTEM, D3D9_POOL_SCRATCH, D3D9_POOL_COUNT };

/* D3DUSAGE */
enum d3d9_usage {
    D3D9_USAGE_RENDER_TARGET = 0x1,
    D3D9_USAGE_DEPTH_STENCIL = 0x2,
    D3D9_USAGE_WRITE_ONLY = 0x8,
    D3D9_USAGE_SOFTWARE_PROCESSING = 0x10,
    D3D9_USAGE_DO_NOT_CLIP = 0x20,
    D3D9_USAGE_POINTS = 0x40,
    D3D9_USAGE_RT_PATCHES = 0x80,
    D3D9_USAGE_N_PATCHES = 0x100,
    D3D9_USAGE_DYNAMIC = 0x200,
    D3D9_USAGE_AUTOMATIC_MIPS = 0x400,
    D3D9_USAGE_RESTRICTED_CONTENT = 0x800,
    D3D9_USAGE_RESTRICT_SHARED_RESOURCE = 0x2000,
    D3D9_USAGE_DISPLACEMENT_MAP = 0x4000,
    D3D9_USAGE_QUERY_BUMP_MAP = 0x8000,
    D3D9_USAGE_QUERY_SRGB_READ = 0x10000,
    D3D9_USAGE_QUERY_FILTER = 0x20000,
    D3D9_USAGE_QUERY_SRGB_WRITE = 0x40000,
    D3D9_USAGE_QUERY_BLENDING = 0x80000,
    D3D9_USAGE_QUERY_VERTEX_TEXTURE = 0x100000,
    D3D9_USAGE_QUERY_WRAP_AND_MIP = 0x200000
};

/* D3DLOCK */
enum d3d9_lock {
    D3D9_LOCK_READ_ONLY = 0x10,
    D3D9_LOCK_NO_OVERWRITE = 0x1000,
    D3D9_LOCK_DISCARD = 0x2000,
    D3D9_LOCK_DO_NOT_WAIT = 0x4000,
    D3D9_LOCK_NO_DIRTY_UPDATE = 0x8000
};

struct d3d9_resource {
    struct d3d9_object object;
    struct d3d9_device *device; /* not referenced by this pointer */
    enum d3d9_resource_type type;
    enum d3d9_pool pool;
    uint32_t usage;
    uint32_t priority;
    uint64_t bytes;                    /* in the default pool */
    struct d3d9_resource *next, *last; /* in the device's list */
};

/* Completes a new object of this type: it is now one of the device's resources. */
void d3d9_resource_begin(struct d3d9_resource *, struct d3d9_device *, enum d3d9_resource_type,
                         uint32_t usage, enum d3d9_pool);
/* Removes it from the device, when it is destroyed. */
void d3d9_resource_end(struct d3d9_resource *);
/* Adds to the memory of the default pool that it uses. */
void d3d9_resource_count_bytes(struct d3d9_resource *, uint64_t bytes);
/* Returns true if the program references a resource that a Reset would lose: one of the default pool. */
bool d3d9_resource_prevents_reset(const struct d3d9_device *);

#endif
