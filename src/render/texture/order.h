/* The order of texels in memory.
 *
 *   rows   texel x, y of a slice is number y * pitch + x. The pitch is the width + 1: each row is padded with
 *          a copy of its first texel (render/texture/texture.h)
 *   tiles  a slice is a grid of 4x4 texels, whose rows follow each other, and a tile is 16 texels in rows:
 *          64 bytes, one line of the cache, where a texel is a word. Texel x, y is number
 *
 *            (y & ~3) * pitch + (x & ~3) * 4 + (y & 3) * 4 + (x & 3)
 *
 *          The pitch is the width rounded up to a multiple of 4, so a row of tiles has 4 * pitch texels. A
 *          slice ends with a whole row of tiles. Texels beyond the width and the height are never sampled
 *
 * Compact texels are one or two bytes there; rows of them are read and written as words.
 *
 * spec/texture/sample.h has the same arithmetic for the routines, by the key's field `tiled`. A part of a
 * slice that begins at multiples of 4 is itself an image of this form with the same pitch. */
#ifndef RENDER_TEXTURE_ORDER_H
#define RENDER_TEXTURE_ORDER_H

#include "render/texture/format.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { TEXTURE_TILE = 4 };

/* A slice of a level, or a part of one. */
struct texture_image {
    uint8_t *texels; /* the first one */
    size_t pitch;    /* texels */
    size_t bytes;    /* of a texel: 1, 2, 4 or 16 */
    uint8_t compact; /* enum compact */
    bool tiled;
    bool opaque; /* alpha is not stored, and is 1 */
};

/* The number of texel x, y from the image's first one. */
static inline size_t texture_index(const struct texture_image *image, size_t x, size_t y)
{
    if (!image->tiled)
        return y * image->pitch + x;
    size_t tile = (y & ~(size_t)3) * image->pitch + (x & ~(size_t)3) * TEXTURE_TILE;
    return tile + (y & 3) * TEXTURE_TILE + (x & 3);
}

static inline void *texture_texel(const struct texture_image *image, size_t x, size_t y)
{
    return image->texels + texture_index(image, x, y) * image->bytes;
}

/* Returns true if a row of the image is a row of texels: in order, in the storage of the format. */
static inline bool texture_has_rows(const struct texture_image *image)
{
    return !image->tiled && !image->compact;
}

/* Bytes of a texel in a row. */
static inline size_t texture_row_size(const struct texture_image *image)
{
    return image->compact ? sizeof(uint32_t) : image->bytes;
}

/* Copies `count` texels of row y from x on, to or from `row`, which has them without gaps in the storage of
 * the format. */
void texture_read_row(const struct texture_image *image, size_t x, size_t y, size_t count, void *row);
void texture_write_row(const struct texture_image *image, size_t x, size_t y, size_t count, const void *row);

/* A part of a slice, x and y, width and height of `box`, from and to rows of blocks of the application's
 * memory (format_decode, format_encode). */
void texture_decode_part(const struct format *format, const void *data, size_t pitch,
                         const struct triptych_box *box, const struct texture_image *image);
void texture_encode_part(const struct format *format, const struct texture_image *image,
                         const struct triptych_box *box, void *data, size_t pitch);

#endif
