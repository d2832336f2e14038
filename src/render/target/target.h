/* The render target: up to four colours and depth in tiles (contract/layout.h), cleared lazily, made linear
 * when read.
 *
 * A tile that has been cleared as a whole only remembers the value; its words are written when something
 * else needs them. So a clear costs nothing where nothing is drawn, and elsewhere it fills a cache that is
 * about to be used. Each tile is touched by one thread at a time; different tiles by any. */
#ifndef RENDER_TARGET_TARGET_H
#define RENDER_TARGET_TARGET_H

#include "base/error.h"
#include "contract/arguments.h"
#include "render/target/color.h"
#include "render/target/depth.h"
#include "render/raster/raster.h"

#include <stdbool.h>

enum { TARGET_PLANES = 4 * TARGETS };

/* Depths, as words without the stencil: their order is that of the depths. */
struct depth_range {
    uint32_t least, most;
};

struct tile_clear {
    uint32_t color[TARGET_PLANES];     /* each plane's word */
    uint32_t depth;                    /* the word, stencil included */
    struct depth_range range;          /* no stored depth is outside of it; of one sample per pixel */
    bool color_pending, depth_pending; /* the words are not valid: every one has this value */
};

/* A colour of the target. A tile has one or four planes for it (def/state/target.def). */
struct target_color {
    const struct format *format; /* null: there is none */
    enum target_storage storage;
    uint32_t plane; /* its first */
};

struct target {
    uint32_t width, height; /* pixels, 0 when there is no target */
    uint32_t columns, rows; /* tiles */
    uint32_t samples;       /* per pixel */
    uint32_t *color; /* `planes` planes of TILE_PIXELS words per tile and sample, in turn, tiles in row order,
                        64-byte aligned */
    uint32_t planes; /* of all colours */
    struct target_color colors[TARGETS];
    uint32_t *depth; /* a plane per tile and sample (render/target/depth.h); null in a target without */
    enum triptych_depth_format depth_format;
    struct tile_clear *clear; /* per tile */
};

/* The values and the area of a clear. */
struct clear {
    struct rectangle area;
    uint32_t color[TARGET_PLANES];
    uint32_t depth;      /* new bits of the word */
    uint32_t depth_mask; /* which of them are set: depth's, stencil's, both or none */
    bool set_color;
};

/* A target of 1 to TARGET_SIZE_MAXIMUM pixels a side: colour and stencil zero, depth 1. Returns 0 or -1 with
 * the reason. */
int target_create(struct target *target, const struct triptych_target_description *description,
                  struct error *error);
void target_destroy(struct target *target);

/* The format that a description has for colour target t; null: none. Its number is a format's. */
const struct format *target_format(const struct triptych_target_description *description, unsigned t);

/* The target's own description. */
void target_describe(const struct target *target, struct triptych_target_description *description);

/* The words of a clear to a colour. Called in the contract's floating-point environment. */
void target_clear_words(const struct target *target, const float color[4], uint32_t words[TARGET_PLANES]);

/* The word of a pixel within its tile: the block, then quad order (contract/layout.h). */
static inline uint32_t pixel_word(uint32_t x, uint32_t y)
{
    uint32_t block = y / BLOCK_SIZE * (TILE_SIZE / BLOCK_SIZE) + x / BLOCK_SIZE;
    uint32_t lane = (x & 1) | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2;
    return block * BLOCK_PIXELS + lane;
}

/* The first of a tile's planes. */
static inline uint32_t *target_tile_color(const struct target *target, uint32_t tile)
{
    return target->color + (size_t)tile * target->samples * target->planes * TILE_PIXELS;
}

static inline uint32_t *target_tile_depth(const struct target *target, uint32_t tile)
{
    return target->depth + (size_t)tile * target->samples * TILE_PIXELS;
}

/* Applies the clear's part in one tile. */
void target_clear_tile(struct target *target, uint32_t tile, const struct clear *clear);

/* Makes the tile's words valid before they are read or changed; returns them. A caller that changes depth
 * then updates the known bounds, or calls target_forget_depth. */
uint32_t *target_fill_color(struct target *target, uint32_t tile);
uint32_t *target_fill_depth(struct target *target, uint32_t tile);
void target_forget_depth(struct target *target, uint32_t tile);

/* All pixels of colour target t from texels, words or four numbers each, in rows that are `pitch` apart. */
void target_write_texels(struct target *target, unsigned t, const void *texels, size_t pitch);

/* The place of a pixel's depth, made valid, and its word. */
uint32_t *target_depth_word(struct target *target, uint32_t x, uint32_t y);
uint32_t target_depth_at(const struct target *target, uint32_t x, uint32_t y);

/* Sets the pixels of a part from four numbers each, converted to the format. Called in the contract's
 * floating-point environment. */
void target_write_numbers(struct target *target, unsigned t, const struct rectangle *part,
                          const float *image);

/* Everything that the target holds, as it is stored (render/target/contents.c): the number of bytes, a
 * copy of them, and the way back. */
size_t target_contents_bytes(const struct triptych_target_description *description);
void target_read_contents(struct target *target, void *data);
void target_write_contents(struct target *target, const void *data);

/* Which of a pixel's samples is read; resolved is the average of all colours, channel by channel of bytes to
 * nearest and halves up, of numbers in binary32, summed in order; and sample 0 of depth and stencil. */
enum { SAMPLE_RESOLVED = -1 };

/* Copies one row of tiles into rows of a linear image of the target's size: colour target t as RGBA8 (what
 * has more is clamped to 0..1 and rounded) or as four numbers a pixel. A row begins `pitch` pixels after the
 * one above. */
void target_read_color(const struct target *target, unsigned t, int sample, uint32_t tile_row,
                       uint32_t *image, size_t pitch);
void target_read_numbers(const struct target *target, unsigned t, int sample, uint32_t tile_row, float *image,
                         size_t pitch);
void target_read_depth(const struct target *target, int sample, uint32_t tile_row, float *image);
void target_read_stencil(const struct target *target, int sample, uint32_t tile_row, uint8_t *image);

#endif
