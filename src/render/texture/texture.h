/* Textures: chains of levels in one allocation, in the storage of their format, or compact
 * (render/texture/format.h).
 *
 *   face 0: level 0, level 1, ... | face 1: ... | ...        a cube has six faces, others one
 *   level:  slice 0, slice 1, ...                            a volume has its depth of them, others one
 *   slice:  rows of texels from the top, each padded with a copy of its first texel
 *
 * The padding lets linear filtering load two neighbours of a row with one access, even where the row wraps
 * around. Code that changes texels must call texture_close_rows, which writes the padding. Only routines and
 * this folder access it.
 *
 * Texels are in this order, or in tiles without that padding (render/texture/order.h). The order changes no
 * result: a key's field `tiled` selects the routine's addresses.
 *
 * After the last texel there is a margin that may be read and has no meaning (contract/job.h).
 *
 * The size of level l is that of level 0 divided by 2^l, rounded down, at least 1. Every texel's index within
 * the allocation is below 2^30, so that generated code addresses words with 32 bits.
 *
 * Texels change only while no queued draw reads them. If one does, they move: see render/device/storage.c. */
#ifndef RENDER_TEXTURE_TEXTURE_H
#define RENDER_TEXTURE_TEXTURE_H

#include "base/error.h"
#include "render/blit/blit.h"
#include "render/texture/format.h"
#include "render/texture/order.h"
#include "contract/job.h"
#include "triptych.h"

enum { TEXTURE_LEVELS = 14, CUBE_FACES = 6 };

struct drawn_surface;

struct triptych_texture {
    struct triptych_texture *next;
    const struct format *format;
    enum triptych_texture_type type;
    uint32_t width, height, depth; /* of level 0 */
    uint32_t levels, faces;
    bool tiled;           /* texels are in tiles of 4x4 instead of rows */
    uint32_t face_texels; /* from a face to the next, rows' ends included */
    uint32_t *texels;     /* 64-byte aligned: an extent (memory/extent.h), like the texture itself */
    uint8_t *blocks;      /* of a compressed format, as they were given (texture_blocks.c); otherwise null */
    uint16_t stale[CUBE_FACES]; /* bit l: the blocks of level l are not those of the texels */
    struct texture_level level[TEXTURE_LEVELS];
    struct drawn_surface *drawn; /* its surfaces that have been drawn to (render/target/surface.h) */
    uint32_t recorded;           /* its number while calls are recorded */
    uint64_t epoch;              /* the device's, when a command was last queued that may use the texels */
    uint64_t written;            /* the same of a command that writes them */
};

/* Everything of a texture but its texels: what a description means, without the memory. */
enum triptych_result texture_describe(const struct triptych_texture_description *description,
                                      struct triptych_texture *texture, struct error *error);

/* A texture as described, every texel what zeros in its format mean. `tiled` orders its texels by
 * texture_order_tiles. Refused, with the reason: what Direct3D 9 does not allow, and storage of more than 4
 * GiB. */
enum triptych_result texture_create(const struct triptych_texture_description *description, bool tiled,
                                    struct triptych_texture **texture, struct error *error);
void texture_destroy(struct triptych_texture *texture);

/* For tests: orders the texels of a described texture, which has no memory yet, in tiles; in rows if tiles
 * need more memory than a texture may have. */
void texture_order_tiles(struct triptych_texture *texture);

/* Bytes of texels in the format's form, for the smallest pitches: of a row of blocks of `width` texels, and
 * of `rows` of it. */
size_t texture_row_bytes(const struct format *format, uint32_t width);

/* Bytes of a level of one face in the format's form, without gaps. */
size_t texture_level_bytes(const struct triptych_texture *texture, unsigned level);

/* Texels of a level of one face. */
size_t texture_level_count(const struct texture_level *level);

/* Bytes of all texels, face by face and level by level, in the storage of the format without gaps (compact
 * texels are words there); and a copy of them. */
size_t texture_texel_bytes(const struct triptych_texture *texture);
void texture_read_texels(const struct triptych_texture *texture, void *data);
void texture_write_texels(struct triptych_texture *texture, const void *data);

/* Orders the texels of a texture that no queued draw uses in tiles or in rows. It keeps its order if memory
 * is short, or if tiles need more than a texture may have. */
void texture_set_order(struct triptych_texture *texture, bool tiled);

/* Bytes that the texels take. */
size_t texture_storage_bytes(const struct triptych_texture *texture);

/* A part of these bytes: a level of one face, or of a texture of one face the levels after the first. */
struct texture_span {
    size_t begin, end;
};
struct texture_span texture_level_span(const struct triptych_texture *texture, unsigned face, unsigned level);
struct texture_span texture_mip_span(const struct triptych_texture *texture);

/* Moves the texels to another extent of the same size, and copies all but a part of them. Returns the old
 * extent. */
void *texture_move(struct triptych_texture *texture, void *texels, struct texture_span lost);

/* Writes the padding of `rows` rows of a slice from row y on: a copy of each row's first texel, after its
 * last. Tiles have no padding. */
void texture_close_rows(const struct triptych_texture *texture, unsigned face, unsigned level, unsigned slice,
                        size_t y, size_t rows);

/* Checks a change of `box` (null: all of the level), and makes it. */
enum triptych_result texture_check_update(const struct triptych_texture *texture, unsigned face,
                                          unsigned level, const struct triptych_box *box, size_t row_pitch,
                                          size_t slice_pitch, struct error *error);
void texture_update(struct triptych_texture *texture, unsigned face, unsigned level,
                    const struct triptych_box *box, const void *data, size_t row_pitch, size_t slice_pitch);

/* A level as a box. */
struct triptych_box texture_whole_level(const struct triptych_texture *texture, unsigned level);

/* The inverse of texture_update, checked by texture_check_update too (render/texture/texture_blocks.c).
 * Texels are the bytes of the updates, except for bits that the storage does not have
 * (render/texture/format.h). Blocks of texels that did not come from an update are compressed again. */
void texture_read(struct triptych_texture *texture, unsigned face, unsigned level,
                  const struct triptych_box *box, void *data, size_t row_pitch, size_t slice_pitch);

/* The blocks of a compressed texture: allocated with zeros, returns -1 without memory; updated; and
 * those of all levels from the first one on, which no longer belong to the texels. */
int texture_blocks_create(struct triptych_texture *texture);
void texture_blocks_update(struct triptych_texture *texture, unsigned face, unsigned level,
                           const struct triptych_box *box, const void *data, size_t row_pitch,
                           size_t slice_pitch);
/* Compresses the texels of whole blocks, and replaces them by what the blocks mean. */
void texture_compress(struct triptych_texture *texture, unsigned face, unsigned level,
                      const struct triptych_box *box);
void texture_blocks_all_stale(struct triptych_texture *texture, unsigned first_level);

/* The routines of mip levels of bytes, and room for their rows. */
struct texture_mips {
    const struct routine *routine[TEXTURE_LEVELS]; /* null: a level of numbers, or none */
    uint32_t *room;
};

/* Finds all that making levels needs, to be dropped. Returns 0, or -1 with the reason. */
int texture_prepare_mips(const struct triptych_texture *texture, const struct blits *blits,
                         struct texture_mips *mips, struct error *error);
void texture_drop_mips(const struct blits *blits, struct texture_mips *mips);

/* Makes every level but the first from the one above it (render/texture/mip.c). */
void texture_generate_mips(struct triptych_texture *texture, const struct texture_mips *mips);

/* The first texel of a face's level. */
static inline void *texture_level_texels(const struct triptych_texture *texture, unsigned face,
                                         unsigned level)
{
    size_t index = (size_t)face * texture->face_texels + (size_t)texture->level[level].offset;
    return (uint8_t *)texture->texels + index * format_texel_bytes(texture->format);
}

/* A slice of a face's level. */
static inline struct texture_image texture_slice(const struct triptych_texture *texture, unsigned face,
                                                 unsigned level, unsigned slice)
{
    const struct texture_level *l = &texture->level[level];
    size_t bytes = format_texel_bytes(texture->format);
    uint8_t *first = (uint8_t *)texture_level_texels(texture, face, level);
    return (struct texture_image){.texels = first + (size_t)slice * (size_t)l->slice_texels * bytes,
                                  .pitch = (size_t)l->pitch,
                                  .bytes = bytes,
                                  .compact = texture->format->compact,
                                  .tiled = texture->tiled,
                                  .opaque = texture->format->channel[3].type == CHANNEL_ONE};
}

#endif
