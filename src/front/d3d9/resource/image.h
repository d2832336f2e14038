/* One image of a resource: a surface by itself, or a level of a texture (of a cube: of one face; of a
 * volume: all slices).
 *
 * An image has its texels in one of two places, its home:
 * - memory: the front end's memory, which Lock returns. Images that the renderer samples also have a level
 *   of a texture there. `dirty` is the box of texels that are newer in memory; they are uploaded before the
 *   texture is used. In the system pool it is the box that UpdateTexture copies.
 * - the renderer: what is drawn to or copied by the renderer. Its memory exists only while it is locked.
 *
 * Rows of blocks are `row_bytes` apart in memory. The pitch that Lock returns is the same, except for
 * ATI1 and ATI2: there it is a size that gives the size of the image when it is multiplied by its height. */
#ifndef D3D9_IMAGE_H
#define D3D9_IMAGE_H

#include "front/d3d9/adapter/format.h"
#include "front/d3d9/resource.h"
#include "front/d3d9/types.h"
#include "triptych.h"

enum d3d9_home { D3D9_HOME_MEMORY, D3D9_HOME_RENDERER };

/* Shared by the images of one resource: while one of them has a device context of Windows, none can be
 * locked. */
struct d3d9_image_use {
    const struct d3d9_image *context; /* the image that has it; null: none */
    unsigned locks;
};

struct d3d9_image {
    struct d3d9_device *device;
    const struct d3d9_format *format;
    uint32_t width, height, depth;   /* texels */
    uint32_t samples;                /* a pixel; 1 without multisampling */
    uint32_t row_bytes, slice_bytes; /* of memory */
    uint32_t pitch;                  /* as Lock returns it */
    enum d3d9_home home;
    bool lockable;
    uint8_t *memory;
    bool borrowed; /* `memory` belongs to the texture or to the program */

    struct triptych_surface surface; /* in the renderer */
    bool has_surface, is_texture;    /* it exists; it is a level of a texture */
    uint32_t face;                   /* of a cube */

    struct d3d9_image_use *use; /* of the resource */
    bool locked;
    uint32_t lock_flags;
    struct triptych_box locked_box;
    struct triptych_box dirty; /* width 0: none */
    bool stale;                /* of the system pool: memory has changed since the last upload */
};

/* Sets the size and the layout. Does not allocate. */
void d3d9_image_begin(struct d3d9_image *, struct d3d9_device *, const struct d3d9_format *, uint32_t width,
                      uint32_t height, uint32_t depth);
/* Returns the bytes of its memory. */
size_t d3d9_image_bytes(const struct d3d9_image *);
/* Makes memory of the program the image's, whose rows have no padding. */
void d3d9_image_borrow(struct d3d9_image *, void *memory);
/* Frees its memory, unless it is borrowed. */
void d3d9_image_end(struct d3d9_image *);
/* Returns false without memory. */
bool d3d9_image_allocate(struct d3d9_image *);
/* The whole image. */
struct triptych_box d3d9_image_box(const struct d3d9_image *);
/* The address of a texel in memory. Its block contains it. */
uint8_t *d3d9_image_at(const struct d3d9_image *, uint32_t x, uint32_t y, uint32_t z);

/* How a lock checks its box. */
enum d3d9_box_check {
    D3D9_BOX_ANY,   /* any rectangle is accepted, also one outside of the image */
    D3D9_BOX_STRICT /* not empty, inside the image, made of whole blocks */
};

/* Returns true if a box is not empty, inside the image, and made of whole blocks. */
bool d3d9_image_box_fits(const struct d3d9_image *, const struct d3d9_box *);

/* Locks a box; null: all of it. *bits is the address of its first texel. */
int32_t d3d9_image_lock(struct d3d9_image *, const struct d3d9_box *, enum d3d9_box_check, uint32_t flags,
                        void **bits);
/* Ends a lock. D3D9_INVALID_CALL if there is none. */
int32_t d3d9_image_unlock(struct d3d9_image *);
/* Locks the whole image for a device context, and unlocks it. */
int32_t d3d9_image_begin_context(struct d3d9_image *, void **bits);
int32_t d3d9_image_end_context(struct d3d9_image *);

/* Extends the dirty box; null: all of the image. Parts outside of the image are ignored. */
void d3d9_image_add_dirty(struct d3d9_image *, const struct triptych_box *);

/* --- Transfer (transfer.c) --- */

/* Uploads what is dirty, if the image has a surface in the renderer. */
int32_t d3d9_image_upload(struct d3d9_image *);
/* Copies a box of texels from memory with the layout of `from` to the renderer's surface of `to`, at x, y,
 * z of it. Both have the same format. */
int32_t d3d9_image_upload_box(struct d3d9_image *to, uint32_t x, uint32_t y, uint32_t z,
                              const struct d3d9_image *from, const struct triptych_box *box);
/* Copies the renderer's surface of `from`, multisampled ones resolved, to the memory of `to`, which has the
 * same format and size. */
int32_t d3d9_image_download(struct d3d9_image *to, const struct d3d9_image *from);
/* Copies a box between the memories of two images of the same format. */
void d3d9_image_copy(struct d3d9_image *to, uint32_t x, uint32_t y, uint32_t z, const struct d3d9_image *from,
                     const struct triptych_box *box);

#endif
