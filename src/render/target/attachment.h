/* Attachments: what a target consists of. An attachment is one colour, or depth with stencil, in tiles
 * (contract/layout.h). It belongs to an image or to a surface of a texture, and keeps its contents while it
 * is not drawn to.
 *
 * A pixel routine finds the colours of a tile one after the other (struct pixel_arguments). So colours that
 * are drawn to together share memory: each tile of that memory has the planes of all of them in turn. An
 * attachment that is drawn to by itself uses its planes of the same memory, at the same place. Its words move
 * only if it is drawn to together with other colours than before (struct tile_move).
 *
 * A tile that has been cleared as a whole only remembers the value; its words are written when something else
 * needs them. So a clear costs nothing where nothing is drawn, and elsewhere it fills a cache that is about
 * to be used. Each tile is touched by one thread at a time; different tiles by any.
 *
 * Attachments and their memory are counted: images, surfaces of textures and targets hold them. The device's
 * thread counts. */
#ifndef RENDER_TARGET_ATTACHMENT_H
#define RENDER_TARGET_ATTACHMENT_H

#include "base/error.h"
#include "contract/layout.h"
#include "render/target/color.h"
#include "render/target/depth.h"

#include <stdbool.h>

/* Depths, as words without the stencil: their order is that of the depths. */
struct depth_range {
    uint32_t least, most;
};

/* The last clear of a tile of a colour: each plane's word. */
struct color_clear {
    uint32_t word[4];
    bool pending; /* the words are not valid: all have these values */
    bool changed; /* the tile may have changed since the last transfer (render/target/surface.h) */
};

/* The same of depth: the word, stencil included. */
struct depth_clear {
    uint32_t word;
    struct depth_range range; /* no stored depth is outside of it; of one sample per pixel */
    bool pending, changed;
};

/* Words of tiles. */
struct tile_memory {
    uint32_t *words;        /* 64-byte aligned; tiles in row order */
    uint32_t columns, rows; /* tiles */
    uint32_t stride;        /* words of a tile */
    uint32_t references;
};

struct attachment {
    uint32_t references;
    uint32_t width, height;      /* pixels */
    uint32_t columns, rows;      /* tiles */
    uint32_t samples;            /* per pixel */
    const struct format *format; /* of a colour; null: depth */
    enum triptych_depth_format depth_format;
    struct tile_memory *memory;      /* null: it was never drawn to, and every tile is pending */
    uint32_t plane;                  /* of a tile of the memory: its first */
    struct color_clear *color_clear; /* per tile; null: depth */
    struct depth_clear *depth_clear; /* per tile; null: a colour */
    /* A surface of a texture has its pixels in tiles and as texels. At the end of the queue at least one of
     * both is valid (render/target/surface.h). */
    bool tiles_newer, texels_newer;
};

/* New attachments with one reference: zeros, depth 1, stencil 0. The format can be a target, and its storage
 * is not nothing. Null with the reason when memory is short. */
struct attachment *attachment_create_color(const struct format *format, uint32_t width, uint32_t height,
                                           uint32_t samples, struct error *error);
struct attachment *attachment_create_depth(enum triptych_depth_format format, uint32_t width, uint32_t height,
                                           uint32_t samples, struct error *error);

/* Add and remove a reference; null is allowed. */
struct attachment *attachment_retain(struct attachment *attachment);
void attachment_release(struct attachment *attachment);

struct tile_memory *attachment_memory_create(uint32_t columns, uint32_t rows, uint32_t stride,
                                             struct error *error);
struct tile_memory *attachment_memory_retain(struct tile_memory *memory);
void attachment_memory_release(struct tile_memory *memory);

/* Planes of one sample of the attachment. */
static inline uint32_t attachment_planes(const struct attachment *attachment)
{
    return attachment->format ? storage_planes[attachment->format->target] : 1;
}

#endif
