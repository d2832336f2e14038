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

/* The knowledge of a tile's texels: all have the values of a clear, as color_clear and depth_clear have
 * them. */
struct stored_clear {
    uint32_t word[4];
    bool known;
};

/* Where the words of tiles are in memory: distances in words. Eight words, the two upper or the two lower
 * quads of a block, follow each other in every order.
 *
 *   tiles      a tile has all its planes in turn, and the tiles follow each other (contract/layout.h)
 *   quad rows  a plane has all pixels of the memory: rows of 2x2 quads, as wide as all columns of tiles */
struct tile_order {
    size_t plane;                 /* from a plane to the next */
    size_t tile_column, tile_row; /* from a tile to the next one in its row, and in its column */
    uint32_t block, block_row;    /* from a block to the next one in its row, and in its column */
    uint32_t lower;               /* from the upper quads of a block to the lower ones */
};

/* Words of tiles. */
struct tile_memory {
    uint32_t *words;        /* 64-byte aligned */
    uint32_t columns, rows; /* tiles */
    uint32_t planes;        /* of a tile */
    uint32_t references;
    bool quad_rows;
    struct tile_order order;
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
    struct stored_clear *stored;     /* per tile, of a texture's surface; null: nothing is known */
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

struct tile_memory *attachment_memory_create(uint32_t columns, uint32_t rows, uint32_t planes, bool quad_rows,
                                             struct error *error);
/* Moves all words into the order. Nothing is queued that uses them. Nothing is changed if memory is short. */
void attachment_memory_set_order(struct tile_memory *memory, bool quad_rows);
struct tile_memory *attachment_memory_retain(struct tile_memory *memory);
void attachment_memory_release(struct tile_memory *memory);

/* The order of one tile by itself, as a pixel routine finds it. */
extern const struct tile_order tile_order_alone;

/* A tile's first word from the first tile's, in the same plane. */
static inline size_t tile_order_place(const struct tile_order *order, uint32_t column, uint32_t row)
{
    return row * order->tile_row + column * order->tile_column;
}

/* A pixel's word from the tile's first, in the same plane. */
static inline size_t tile_order_word(const struct tile_order *order, uint32_t x, uint32_t y)
{
    size_t block = (size_t)(y / BLOCK_SIZE) * order->block_row + (size_t)(x / BLOCK_SIZE) * order->block;
    return block + (y & 2 ? order->lower : 0) + (x & 2) * 2 + (y & 1) * 2 + (x & 1);
}

/* Copies a plane of a tile to another order; and sets all its words. */
void tile_order_copy(const struct tile_order *from_order, const uint32_t *from,
                     const struct tile_order *to_order, uint32_t *to);
void tile_order_fill(const struct tile_order *order, uint32_t *words, uint32_t value);

/* The first word of a plane of a tile. */
static inline uint32_t *tile_memory_words(const struct tile_memory *memory, uint32_t column, uint32_t row,
                                          uint32_t plane)
{
    return memory->words + tile_order_place(&memory->order, column, row) + plane * memory->order.plane;
}

/* Planes of one sample of the attachment. */
static inline uint32_t attachment_planes(const struct attachment *attachment)
{
    return attachment->format ? storage_planes[attachment->format->target] : 1;
}

#endif
