/* Surfaces: what is drawn to, read and copied: images, and single levels, faces and slices of textures.
 *
 * An image is an attachment (render/target/attachment.h) and has no other storage. A texture has texels,
 * which are sampled; each of its surfaces that has been drawn to has an attachment too. Both hold the same
 * values: words where the format has 8 bits a channel, four numbers otherwise (render/texture/format.h,
 * def/state/target.def). Depth is the same number in all four channels of a texel; stencil has no place there
 * and stays in the tiles.
 *
 * Drawing makes the tiles newer than the texels, and changes of texels make these newer. A transfer brings
 * one of both up to date. Which one is newer is decided in the order of the calls, when these are queued. */
#ifndef RENDER_TARGET_SURFACE_H
#define RENDER_TARGET_SURFACE_H

#include "render/target/rectangle.h"
#include "render/target/target.h"
#include "render/texture/texture.h"

struct triptych_image {
    struct triptych_image *next; /* of the device's */
    struct triptych_image_description description;
    struct attachment *attachment; /* null: its format stores nothing */
    uint32_t recorded;             /* its number while calls are recorded */
};

/* A surface of a texture that has been drawn to. */
struct drawn_surface {
    struct drawn_surface *next; /* of the texture's */
    unsigned level, slice;
    struct attachment *attachment;
};

/* Fails if the description is not valid. */
enum triptych_result image_check(const struct triptych_image_description *description, struct error *error);

/* Bytes of the pixels of a valid description. */
size_t image_bytes(const struct triptych_image_description *description);

/* Describes a target that draws to the surfaces. Checks formats and sizes, and that there is at least one
 * surface. Images need only their descriptions, textures only what texture_describe makes. */
enum triptych_result surfaces_describe(const struct triptych_target_surfaces *surfaces,
                                       struct triptych_target_description *description, struct error *error);

/* Returns true if one of the surfaces belongs to the texture, or is the image. */
bool surfaces_include(const struct triptych_target_surfaces *surfaces,
                      const struct triptych_texture *texture);
bool surfaces_include_image(const struct triptych_target_surfaces *surfaces,
                            const struct triptych_image *image);

/* Returns true if the argument is a surface: a texture or an image. */
static inline bool surface_is_given(const struct triptych_surface *surface)
{
    return surface->texture || surface->image;
}

/* The tiles of a valid surface; null: it is a texture's that has not been drawn to, or stores nothing. */
struct attachment *surface_attachment(const struct triptych_surface *surface);
/* The same, made if it is missing: a texture's tiles are then older than its texels. Null with the reason
 * if memory is short, or without a reason if the format stores nothing. */
struct attachment *surface_make_attachment(const struct triptych_surface *surface, struct error *error);
/* Frees what a texture holds; before it is destroyed. */
void surface_free_attachments(struct triptych_texture *texture);

/* A transfer between the tiles and the texels of one surface of a texture. It holds the attachment and its
 * memory, not the texels. */
struct surface_transfer {
    bool store; /* from tiles to texels; false: the other way */
    struct attachment *attachment;
    struct tile_memory *memory;
    uint32_t plane;
    struct texture_image image;
    struct stored_clear *stored; /* the attachment's */
};

/* The surface has an attachment with memory. The transfer takes place when all of the attachment's tiles
 * have been transferred, by any threads, in the contract's floating-point environment. Then it must be
 * ended. */
void surface_begin_transfer(const struct triptych_surface *surface, bool store,
                            struct surface_transfer *transfer);
void surface_transfer_tile(const struct surface_transfer *transfer, uint32_t tile);
void surface_end_transfer(struct surface_transfer *transfer);

/* A copy from the first surface to the second one; parts of width 0 are all of them. */
struct surface_copy {
    const struct triptych_surface *surface[2];
    struct triptych_rectangle part[2];
    enum triptych_copy_filter filter;
};

/* The format and the size of a surface: an image, a surface of a texture, or a colour of the target. */
struct surface_form {
    const struct format *format;             /* of a colour; null: depth */
    enum triptych_depth_format depth_format; /* of depth */
    uint32_t width, height;
};
enum triptych_result surface_find_form(const struct triptych_surface *surface, const char *what,
                                       const struct triptych_target_description *target,
                                       struct surface_form *form, struct error *error);

/* The pixels of a surface in the tiles; null: those of a texture as texels, of a format that stores nothing
 * none. */
struct pixels surface_pixels(const struct triptych_surface *surface, const struct surface_form *form,
                             struct attachment *tiles);

/* After texels of a part have changed: compresses the blocks of a compressed texture, and writes the padding
 * of rows. */
void surface_close_texels(const struct triptych_surface *surface, const struct triptych_rectangle *part);

/* --- Checks (render/target/surface_use.c) --- */

/* Fails if the copy is not valid; otherwise finds both forms, and the parts that are meant. */
struct surface_copy_plan {
    struct surface_form form[2];
    struct triptych_rectangle part[2];
};
enum triptych_result surface_check_copy(const struct surface_copy *copy,
                                        const struct triptych_target_description *target,
                                        struct surface_copy_plan *plan, struct error *error);

/* Pixels of a part of a surface in memory. */
struct surface_memory {
    struct surface_form form;
    struct triptych_rectangle part; /* not empty */
    const struct format *format;    /* of the memory; null: depth */
    size_t row_bytes, rows;         /* of pixels or, if the format is compressed, of blocks */
};
/* Fails if the part (null, or of width 0: all) or the format (0: the surface's own) is not valid. */
enum triptych_result surface_check_memory(const struct triptych_surface *surface,
                                          const struct triptych_rectangle *part,
                                          enum triptych_surface_format format,
                                          const struct triptych_target_description *target,
                                          struct surface_memory *memory, struct error *error);

/* The same, for a part that is filled with a colour. */
enum triptych_result surface_check_fill(const struct triptych_surface *surface,
                                        const struct triptych_rectangle *part,
                                        const struct triptych_target_description *target,
                                        struct surface_memory *memory, struct error *error);

#endif
