#include "front/gl/texture/texel.h"
#include "front/gl/texture/block.h"

#include <string.h>

/* --- Conversions of a row --- */

#define COPY(bytes)                                                                                          \
    static void convert_copy##bytes(void *out, const void *in, unsigned texels)                              \
    {                                                                                                        \
        memcpy(out, in, (size_t)texels *(bytes));                                                            \
    }
COPY(1)
COPY(2)
COPY(4)
COPY(8)
COPY(16)

static void convert_rgb8(void *out, const void *in, unsigned texels)
{
    const uint8_t *from = in;
    uint8_t *to = out;
    for (; texels--; from += 3, to += 4) {
        memcpy(to, from, 3);
        to[3] = 0xff;
    }
}

/* OpenGL's alpha is in the low bits, that of the storage in the high ones. */
static void rotate(void *out, const void *in, unsigned texels, unsigned right)
{
    for (unsigned i = 0; i < texels; i++) {
        uint16_t word;
        memcpy(&word, (const uint8_t *)in + i * 2, 2);
        word = (uint16_t)(word >> right | word << (16 - right));
        memcpy((uint8_t *)out + i * 2, &word, 2);
    }
}

static void convert_rgba4(void *out, const void *in, unsigned texels)
{
    rotate(out, in, texels, 4);
}

static void convert_rgb5a1(void *out, const void *in, unsigned texels)
{
    rotate(out, in, texels, 1);
}

void gl_texel_rotate_back(GLenum type, void *texels, unsigned count)
{
    if (type == GL_UNSIGNED_SHORT_4_4_4_4)
        rotate(texels, texels, count, 12);
    else if (type == GL_UNSIGNED_SHORT_5_5_5_1)
        rotate(texels, texels, count, 15);
}

/* The bits of alpha are ignored: it is 1. */
static void convert_rgb10(void *out, const void *in, unsigned texels)
{
    for (unsigned i = 0; i < texels; i++) {
        uint32_t word;
        memcpy(&word, (const uint8_t *)in + i * sizeof word, sizeof word);
        word |= 3u << 30;
        memcpy((uint8_t *)out + i * sizeof word, &word, sizeof word);
    }
}

/* Four numbers from those of a texel: `red` to `alpha` are expressions of `in`. */
#define SPREAD(name, number, components, red, green, blue, alpha)                                            \
    static void convert_##name(void *out, const void *texel, unsigned texels)                                \
    {                                                                                                        \
        for (unsigned i = 0; i < texels; i++) {                                                              \
            number in[components];                                                                           \
            memcpy(in, (const uint8_t *)texel + i * sizeof in, sizeof in);                                   \
            const number to[4] = {red, green, blue, alpha};                                                  \
            memcpy((uint8_t *)out + i * sizeof to, to, sizeof to);                                           \
        }                                                                                                    \
    }
enum { HALF_ONE = 0x3c00 };
SPREAD(rgb32f, float, 3, in[0], in[1], in[2], 1)
SPREAD(alpha32f, float, 1, 0, 0, 0, in[0])
SPREAD(luminance32f, float, 1, in[0], in[0], in[0], 1)
SPREAD(pair32f, float, 2, in[0], in[0], in[0], in[1])
SPREAD(red32f, float, 1, in[0], 0, 0, 1)
SPREAD(rg32f, float, 2, in[0], in[1], 0, 1)
SPREAD(rgb16f, uint16_t, 3, in[0], in[1], in[2], HALF_ONE)
SPREAD(alpha16f, uint16_t, 1, 0, 0, 0, in[0])
SPREAD(luminance16f, uint16_t, 1, in[0], in[0], in[0], HALF_ONE)
SPREAD(pair16f, uint16_t, 2, in[0], in[0], in[0], in[1])
SPREAD(red16f, uint16_t, 1, in[0], 0, 0, HALF_ONE)
SPREAD(rg16f, uint16_t, 2, in[0], in[1], 0, HALF_ONE)

/* Depth of 24 bits, above stencil 0. */
static void store_depth(void *out, unsigned i, uint32_t depth)
{
    depth <<= 8;
    memcpy((uint8_t *)out + i * sizeof depth, &depth, sizeof depth);
}

/* The greatest number of 16 bits becomes the greatest of 24. */
static void convert_depth16(void *out, const void *in, unsigned texels)
{
    for (unsigned i = 0; i < texels; i++) {
        uint16_t depth;
        memcpy(&depth, (const uint8_t *)in + i * sizeof depth, sizeof depth);
        store_depth(out, i, (uint32_t)depth << 8 | depth >> 8);
    }
}

static void convert_depth32(void *out, const void *in, unsigned texels)
{
    for (unsigned i = 0; i < texels; i++) {
        uint32_t depth;
        memcpy(&depth, (const uint8_t *)in + i * sizeof depth, sizeof depth);
        store_depth(out, i, depth >> 8);
    }
}

/* --- Formats --- */

enum {
    BYTES_A8 = 1,
    BYTES_L8 = 1,
    BYTES_A8L8 = 2,
    BYTES_R8 = 1,
    BYTES_R8G8 = 2,
    BYTES_L24S8 = 4,
    BYTES_R5G6B5 = 2,
    BYTES_A4R4G4B4 = 2,
    BYTES_A1R5G5B5 = 2,
    BYTES_A8B8G8R8 = 4,
    BYTES_X8B8G8R8 = 4,
    BYTES_A8R8G8B8 = 4,
    BYTES_A2B10G10R10 = 4,
    BYTES_A16B16G16R16F = 8,
    BYTES_A32B32G32R32F = 16
};

static const struct gl_texel texels[] = {
#define convert_none NULL
#define GL_TEXEL(format, type, bytes, storage, convert, red, green, blue, alpha, depth, stencil, drawn)      \
    {format,                                                                                                 \
     type,                                                                                                   \
     bytes,                                                                                                  \
     BYTES_##storage,                                                                                        \
     TRIPTYCH_SURFACE_##storage,                                                                             \
     convert_##convert,                                                                                      \
     red,                                                                                                    \
     green,                                                                                                  \
     blue,                                                                                                   \
     alpha,                                                                                                  \
     depth,                                                                                                  \
     stencil,                                                                                                \
     drawn},
#define GL_SIZED(internal_format, format, type)
#include "front/gl/texture/texel.def"
#undef GL_TEXEL
#undef GL_SIZED
};

enum { TEXELS = sizeof texels / sizeof *texels };

const struct gl_texel *gl_texel_find(GLenum format, GLenum type)
{
    for (unsigned i = 0; i < TEXELS; i++)
        if (texels[i].format == format && texels[i].type == type)
            return texels + i;
    return NULL;
}

bool gl_texel_has_format(GLenum format)
{
    for (unsigned i = 0; i < TEXELS; i++)
        if (texels[i].format == format && texels[i].type)
            return true;
    return false;
}

static const GLenum sized[][3] = {
#define GL_TEXEL(format, type, bytes, storage, convert, red, green, blue, alpha, depth, stencil, drawn)
#define GL_SIZED(internal_format, format, type) {internal_format, format, type},
#include "front/gl/texture/texel.def"
#undef GL_TEXEL
#undef GL_SIZED
};

enum { SIZED = sizeof sized / sizeof *sized };

GLenum gl_texel_base(GLenum internal_format, GLenum type)
{
    if (gl_texel_has_format(internal_format))
        return internal_format;
    for (unsigned i = 0; i < SIZED; i++)
        if (sized[i][0] == internal_format && (!type || sized[i][2] == type))
            return sized[i][1];
    return 0;
}

const struct gl_texel *gl_texel_of_copy(GLenum internal_format)
{
    for (unsigned i = 0; i < SIZED; i++)
        if (sized[i][0] == internal_format)
            return gl_texel_find(sized[i][1], sized[i][2]);
    return gl_texel_find(internal_format, GL_UNSIGNED_BYTE);
}

bool gl_texel_has_type(GLenum type)
{
    for (unsigned i = 0; i < TEXELS; i++)
        if (type && texels[i].type == type)
            return true;
    return false;
}

/* --- Rectangles --- */

size_t gl_texel_pitch(unsigned width, unsigned bytes, unsigned alignment)
{
    return ((size_t)width * bytes + alignment - 1) & ~(size_t)(alignment - 1);
}

void gl_texel_convert(const struct gl_texel *texel, unsigned width, unsigned height, const void *in,
                      size_t from, void *out, size_t pitch)
{
    for (unsigned y = 0; y < height; y++)
        texel->convert((uint8_t *)out + y * pitch, (const uint8_t *)in + y * from, width);
}

static unsigned blocks(unsigned side)
{
    return (side + 3) / 4;
}

size_t gl_texel_compressed_bytes(const struct gl_texel *texel, unsigned width, unsigned height)
{
    return (size_t)blocks(width) * blocks(height) * texel->bytes;
}

void gl_texel_decompress(const struct gl_texel *texel, unsigned width, unsigned height, const void *in,
                         void *out, size_t pitch)
{
    uint8_t block[4][4][4];
    const uint8_t *from = in;
    for (unsigned y = 0; y < height; y += 4)
        for (unsigned x = 0; x < width; x += 4, from += texel->bytes) {
            unsigned columns = width - x < 4 ? width - x : 4, rows = height - y < 4 ? height - y : 4;
            if (texel->format == GL_ETC1_RGB8_OES)
                gl_block_etc1(from, block);
            else
                gl_block_dxt1(from, texel->format == GL_COMPRESSED_RGBA_S3TC_DXT1_EXT, block);
            for (unsigned row = 0; row < rows; row++)
                memcpy((uint8_t *)out + (y + row) * pitch + x * 4, block[row], columns * 4);
        }
}
