/* Formats: how texels lie in the application's memory (the rows of def/state/format.def), and their way into
 * and out of the two classes that rows of texels have.
 *
 *   STORAGE_RGBA8    one word a texel, red in the lowest byte
 *   STORAGE_FLOAT4   four binary32 a texel: red, green, blue, alpha
 *
 * Textures store them like that, except for compact texels (def/state/compact.def), which are one or two
 * bytes in a texture and RGBA8 words in rows (render/texture/order.h).
 *
 * Decoding is exact where the format allows it and rounds to nearest otherwise: a channel of n unsigned
 * bits is v / (2^n - 1), of n signed bits v / (2^(n-1) - 1) but at least -1; to 8 bits that is round(v *
 * 255 / (2^n - 1)), to binary32 the quotient in binary64, rounded. Of fewer than 8 signed bits, negative
 * numbers are v / 2^(n-1): Direct3D 9 documents only the range, -1 to 1, and graphics chips gave the 5 bits
 * of L6V5U5 32 different values. Encoding is the nearest value that the format has, and encoding what was
 * decoded gives the same bits back, except that a channel's second -1 becomes the first one, and that bits
 * of no channel become 0. */
#ifndef RENDER_TEXTURE_FORMAT_H
#define RENDER_TEXTURE_FORMAT_H

#include "contract/key.h"
#include "triptych.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum storage { STORAGE_RGBA8, STORAGE_FLOAT4 };

/* The uses of a surface of the format. */
enum {
    ROLE_TEXTURE = 1,
    ROLE_TARGET = 2,
    ROLE_DEPTH = 4,   /* a depth buffer */
    ROLE_COMPARE = 8, /* sampling compares with the texel */
};

enum coding {
    CODING_PACKED, /* defined by the channels */
    CODING_NORMAL, /* blue is the third component of a unit vector */
    CODING_DXT1,
    CODING_DXT3,
    CODING_DXT5,
    CODING_ATI1,
    CODING_ATI2,
};

enum channel_type { CHANNEL_ZERO, CHANNEL_ONE, CHANNEL_UNSIGNED, CHANNEL_SIGNED, CHANNEL_FLOAT };

/* Bits shift to shift + bits - 1 of a block's little-endian bits. */
struct channel {
    uint8_t type;
    uint8_t shift;
    uint8_t bits;
};

struct format {
    const char *name;
    uint32_t number; /* Direct3D 9's */
    uint8_t bytes;   /* of a block */
    uint8_t side;    /* texels of a block either way */
    uint8_t storage;
    uint8_t compact; /* enum compact: the form in textures, or none */
    uint8_t roles;
    uint8_t coding;
    uint8_t target;            /* enum target_storage of tiles that are drawn to, with ROLE_TARGET */
    uint8_t depth;             /* enum triptych_depth_format of tiles, with ROLE_DEPTH; otherwise none */
    struct channel channel[4]; /* red, green, blue, alpha */
};

/* The format of that number, or of that name (`length` bytes); null if there is none. */
const struct format *format_find(uint32_t number);
const struct format *format_named(const char *name, size_t length);

/* The name of the form of texels in textures: rgba8, float4, or a row of def/state/compact.def. */
const char *format_stored_name(const struct format *format);

/* The i-th row; null past the last. */
const struct format *format_at(unsigned i);

/* Bytes of a texel in a row, and in a texture. */
static inline size_t format_row_bytes(const struct format *format)
{
    return format->storage == STORAGE_RGBA8 ? 4 : 16;
}

static inline size_t format_texel_bytes(const struct format *format)
{
    return format->compact ? storage_compact[format->compact].bytes : format_row_bytes(format);
}

/* The word of a texel that the format can have: of a compact one the bytes that are stored. */
static inline uint32_t format_valid_word(const struct format *format, uint32_t word)
{
    const struct compact_form *form = &storage_compact[format->compact];
    if (!format->compact)
        return word;
    uint32_t first = word >> __builtin_ctz(form->first) & 255;
    uint32_t second = form->second ? word >> __builtin_ctz(form->second) & 255 : 0;
    return first * form->first + second * form->second + form->constant;
}

/* Blocks across or down `size` texels. */
static inline size_t format_blocks(const struct format *format, uint32_t size)
{
    return (size + format->side - 1u) / format->side;
}

/* Decodes width x height texels from rows of blocks, `pitch` bytes from one to the next, to rows of
 * `texels_stride` texels of the format's storage. Texels of blocks beyond the width and height are left out.
 */
void format_decode(const struct format *format, const void *data, size_t pitch, uint32_t width,
                   uint32_t height, void *texels, size_t texels_stride);

/* The way back. Bits that belong to no channel are zero. Compressed blocks are approximations, the same ones
 * on every machine (render/texture/block_encode.c); texels of blocks beyond the width and height count as
 * copies of the last ones. */
void format_encode(const struct format *format, const void *texels, size_t texels_stride, uint32_t width,
                   uint32_t height, void *data, size_t pitch);

/* Returns true if the channel is stored in bits of its own, not in those of an earlier channel. */
bool format_channel_is_stored(const struct format *format, unsigned c);

/* One block of compressed texels, row by row (render/texture/block.c, render/texture/block_encode.c). */
void block_decode(enum coding coding, const uint8_t *block, uint32_t texels[16]);
void block_encode(enum coding coding, const uint32_t texels[16], uint8_t *block);

/* The four colours that the two words at the start of a block of colours mean, and the eight values that two
 * bytes mean. `punch`: DXT1, where the order of the colours determines whether code 3 is transparent. */
void block_colors(const uint8_t *block, bool punch, uint32_t color[4]);
void block_values(unsigned a, unsigned b, unsigned value[8]);

#endif
