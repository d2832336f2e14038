/* Pixels of a surface in rows, wherever they are stored: in the tiles of an attachment, or as texels of a
 * texture (render/target/surface.h).
 *
 * A row of a colour has the storage of its format: a word or four numbers a pixel (def/state/target.def), so
 * it is also a row of texels (render/texture/format.h). A row of depth has one word a pixel
 * (render/target/depth.h). Reading reads sample 0, so colours of several samples are resolved first
 * (render/target/resolve.h). Writing sets all samples.
 *
 * Nothing is queued that draws to the pixels. Functions are called in the contract's floating-point
 * environment. Each tile is touched by one thread at a time; different tiles by any. */
#ifndef RENDER_TARGET_PIXELS_H
#define RENDER_TARGET_PIXELS_H

#include "render/target/attachment.h"
#include "render/texture/order.h"
#include "triptych.h"

/* The most pixels of a row that are read or written together; they are in one column of tiles. */
enum { PIXELS_ROW = TILE_SIZE };

struct pixels {
    const struct format *format;             /* of a colour; null: depth */
    enum triptych_depth_format depth_format; /* of depth */
    uint32_t width, height;
    struct attachment *tiles;   /* null: texels */
    bool quad_rows;             /* the order of the tiles' memory if it has to be made */
    struct texture_image image; /* without texels and tiles: a format that stores nothing, which reads 1 */
};

/* Words of a pixel in a row. */
static inline uint32_t pixels_words(const struct pixels *pixels)
{
    return pixels->format && pixels->format->storage == STORAGE_FLOAT4 ? 4 : 1;
}

/* The storage of a row of a colour. */
static inline enum storage pixels_storage(const struct pixels *pixels)
{
    return (enum storage)pixels->format->storage;
}

/* Returns true if all pixels of the tile with this one have the words of a clear. */
bool pixels_are_cleared(const struct pixels *pixels, uint32_t x, uint32_t y);

/* `count` pixels of row y from x on, all in one column of tiles. */
void pixels_read_row(const struct pixels *pixels, uint32_t x, uint32_t y, uint32_t count, uint32_t *row);
/* The pixels have tiles with memory, or texels. Texels that follow a row as its padding are not written. */
void pixels_write_row(const struct pixels *pixels, uint32_t x, uint32_t y, uint32_t count,
                      const uint32_t *row);

/* Sets all pixels of a part of one tile to the same words. The part begins and ends within the tile. */
void pixels_fill(const struct pixels *pixels, const struct triptych_rectangle *part, const uint32_t *words);

/* Copies a whole tile of one attachment to another one of the same format, or returns false: the places are
 * not corners of tiles, a tile is not whole, or samples are averaged. A tile that only remembers its clear
 * gives another one that does. */
bool pixels_copy_tile(const struct pixels *from, uint32_t from_x, uint32_t from_y, const struct pixels *to,
                      const struct triptych_rectangle *part);

/* Copies a part of an attachment to another place of the same attachment, which may overlap; or returns
 * false: the sizes differ, or the pixels are texels or have several samples. The pixels have memory. One
 * thread at a time. */
bool pixels_move(const struct pixels *pixels, const struct triptych_rectangle *from,
                 const struct triptych_rectangle *to);

/* Gives memory to an attachment that was never drawn to, before it is written. Returns 0, or -1 with the
 * reason. */
int pixels_prepare(const struct pixels *pixels, struct error *error);

#endif
