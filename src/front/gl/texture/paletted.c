/* The data of a paletted image are its palette, of 16 or 256 texels, and then the indices of each level. An
 * index of 4 bits is half of a byte, the first one the upper half. Rows have no gaps, a level begins at a
 * byte. */
#include "front/gl/texture/paletted.h"
#include "front/gl/constant.h"
#include "front/gl/texture/texture.h"

#include <stdlib.h>
#include <string.h>

/* The texels of the palettes, in the order of the formats; first those with indices of 4 bits. */
static const struct {
    GLenum format, type;
} palettes[] = {
    {GL_RGB, GL_UNSIGNED_BYTE},           {GL_RGBA, GL_UNSIGNED_BYTE},
    {GL_RGB, GL_UNSIGNED_SHORT_5_6_5},    {GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4},
    {GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1},
};
enum { PALETTES = sizeof palettes / sizeof *palettes };

struct paletted {
    const struct gl_texel *texel;
    unsigned index_bits;
    size_t palette_bytes;
    unsigned levels, width, height; /* of the first level */
};

bool gl_paletted_has(GLenum format)
{
    return format >= GL_PALETTE4_RGB8_OES && format < GL_PALETTE4_RGB8_OES + GL_PALETTED_FORMATS;
}

static struct paletted describe(GLenum format, GLint level, GLsizei width, GLsizei height)
{
    unsigned row = format - GL_PALETTE4_RGB8_OES, palette = row % PALETTES;
    struct paletted image = {.texel = gl_texel_find(palettes[palette].format, palettes[palette].type),
                             .index_bits = row < PALETTES ? 4 : 8,
                             .levels = 1 + (unsigned)-level,
                             .width = (unsigned)width,
                             .height = (unsigned)height};
    image.palette_bytes = (size_t)image.texel->bytes << image.index_bits;
    return image;
}

/* The side of a level, at least 1; 0 of an image without texels. */
static unsigned side(unsigned first, unsigned level)
{
    return first >> level ? first >> level : first > 0;
}

static size_t index_bytes(const struct paletted *image, unsigned level)
{
    size_t texels = (size_t)side(image->width, level) * side(image->height, level);
    return (texels * image->index_bits + 7) / 8;
}

static size_t all_bytes(const struct paletted *image)
{
    size_t bytes = image->palette_bytes;
    for (unsigned i = 0; i < image->levels; i++)
        bytes += index_bytes(image, i);
    return bytes;
}

/* Writes the texels of the indices, without gaps. */
static void look_up(const struct paletted *image, const uint8_t *palette, const uint8_t *indices,
                    size_t texels, uint8_t *out)
{
    size_t bytes = image->texel->bytes;
    for (size_t i = 0; i < texels; i++) {
        unsigned index = image->index_bits == 8 ? indices[i]
                         : i % 2                ? indices[i / 2] & 15
                                                : indices[i / 2] >> 4;
        memcpy(out + i * bytes, palette + index * bytes, bytes);
    }
}

static bool write_level(struct gl_context *context, struct gl_texture *texture, unsigned face, unsigned level,
                        const struct paletted *image, const uint8_t *palette, const uint8_t *indices)
{
    const struct gl_texel *texel = image->texel;
    struct triptych_rectangle all = {0, 0, side(image->width, level), side(image->height, level)};
    size_t texels = (size_t)all.width * all.height, pitch = (size_t)all.width * texel->storage_bytes;
    uint8_t *plain = malloc(texels * texel->bytes + 1), *stored = malloc(pitch * all.height + 1);
    bool written = plain && stored;
    if (written) {
        look_up(image, palette, indices, texels, plain);
        gl_texel_convert(texel, all.width, all.height, plain, (size_t)all.width * texel->bytes, stored,
                         pitch);
        written = gl_texture_write(context, texture, face, level, texel, &all, stored, pitch);
    }
    free(plain);
    free(stored);
    return written;
}

static bool check(struct gl_context *context, const struct gl_texture *texture, GLint level, GLsizei width,
                  GLsizei height, GLint border)
{
    if (level > 0 || level <= -GL_LEVELS)
        gl_error(context, GL_INVALID_VALUE, "found level %d of a paletted image, expected %d to 0", level,
                 1 - GL_LEVELS);
    else if (width < 0 || height < 0 || width > GL_SIDE || height > GL_SIDE)
        gl_error(context, GL_INVALID_VALUE, "found a size of %d x %d, expected sides of 0 to %d", width,
                 height, GL_SIDE);
    else if (-level && !(width >> -level) && !(height >> -level))
        gl_error(context, GL_INVALID_VALUE, "found level %d, which an image of %d x %d does not have", level,
                 width, height);
    else if (texture->target == GL_TEXTURE_CUBE_MAP && width != height)
        gl_error(context, GL_INVALID_VALUE, "found a face of %d x %d, expected a square", width, height);
    else if (border)
        gl_error(context, GL_INVALID_VALUE, "found a border of %d, expected 0", border);
    else
        return true;
    return false;
}

/* Defines the levels; `data` may be null. */
static void load(struct gl_context *context, struct gl_texture *texture, unsigned face,
                 const struct paletted *image, const uint8_t *data)
{
    bool written = true;
    const uint8_t *indices = data ? data + image->palette_bytes : NULL;
    for (unsigned level = 0; level < image->levels && written; level++) {
        gl_texture_define(context, texture, face, level, image->texel, image->texel->format,
                          side(image->width, level), side(image->height, level));
        if (!data)
            continue;
        written = write_level(context, texture, face, level, image, data, indices);
        indices += index_bytes(image, level);
    }
    if (!written)
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for texels");
    if (image->levels == 1)
        gl_texture_wrote(context, texture, 0);
}

void gl_paletted_image(struct gl_context *context, GLenum target, GLint level, GLenum format, GLsizei width,
                       GLsizei height, GLint border, GLsizei bytes, const void *data)
{
    unsigned face;
    struct gl_texture *texture = gl_texture_of_image(context, target, &face);
    if (!texture || !check(context, texture, level, width, height, border))
        return;
    const struct paletted image = describe(format, level, width, height);
    if (bytes < 0 || (size_t)bytes != all_bytes(&image))
        gl_error(context, GL_INVALID_VALUE, "found %d bytes, expected %zu of %s", bytes, all_bytes(&image),
                 gl_constant_name(format));
    else
        load(context, texture, face, &image, data);
}
