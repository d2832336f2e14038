#include "command/assets/dds.h"

#include "render/texture/texture.h"

#include <stdbool.h>
#include <string.h>

enum { HEADER_BYTES = 128, HEADER_SIZE = 124, PIXEL_FORMAT_SIZE = 32 };

/* Byte offsets in the file. */
enum {
    AT_SIZE = 4,
    AT_FLAGS = 8,
    AT_HEIGHT = 12,
    AT_WIDTH = 16,
    AT_DEPTH = 24,
    AT_LEVELS = 28,
    AT_PIXEL_FORMAT = 76, /* size, flags, FourCC, bits, then the masks */
    AT_PIXEL_FLAGS = 80,
    AT_FOURCC = 84,
    AT_BITS = 88,
    AT_MASKS = 92,
    AT_CAPS2 = 112
};

enum { HAS_LEVELS = 0x20000 };
enum {
    PIXEL_ALPHA = 1,
    PIXEL_ALPHA_ONLY = 2,
    PIXEL_FOURCC = 4,
    PIXEL_LUMINANCE = 0x20000,
    PIXEL_SIGNED = 0xc0000 /* bump maps, with and without luminance */
};
enum { CAPS2_CUBE = 0x200, CAPS2_ALL_FACES = 0xfc00, CAPS2_VOLUME = 0x200000 };

static uint32_t word(const uint8_t *data, int at)
{
    data += at;
    return (uint32_t)data[0] | (uint32_t)data[1] << 8 | (uint32_t)data[2] << 16 | (uint32_t)data[3] << 24;
}

bool dds_is(const void *data, size_t bytes)
{
    return bytes >= 4 && !memcmp(data, "DDS ", 4);
}

static uint32_t mask_of(const struct channel *channel)
{
    return channel->bits ? (uint32_t)((1ull << channel->bits) - 1) << channel->shift : 0;
}

/* Returns true if the masks are those of the format. Luminance uses only the red mask. Without the alpha
 * flag, the format is one without alpha. */
static bool has_masks(const struct format *format, const uint8_t *data)
{
    uint32_t flags = word(data, AT_PIXEL_FLAGS);
    bool luminance = !memcmp(&format->channel[0], &format->channel[1], sizeof format->channel[0]) &&
                     format->channel[0].bits;
    if (format->coding != CODING_PACKED || format->side > 1 || format->bytes > 4 ||
        format->roles & ROLE_DEPTH || format->bytes * 8u != word(data, AT_BITS) ||
        luminance != !!(flags & PIXEL_LUMINANCE) ||
        (format->channel[0].type == CHANNEL_SIGNED) != !!(flags & PIXEL_SIGNED))
        return false;
    for (int c = 0; c < 4; c++) {
        bool alpha = c == 3;
        bool there = alpha ? flags & (PIXEL_ALPHA | PIXEL_ALPHA_ONLY) : !(luminance && c > 0);
        uint32_t expected = luminance && !alpha && c > 0 ? 0 : mask_of(&format->channel[c]);
        if ((there ? word(data, AT_MASKS + 4 * c) : 0) != expected)
            return false;
    }
    return true;
}

static const struct format *find_format(const uint8_t *data)
{
    const struct format *format;
    if (word(data, AT_PIXEL_FLAGS) & PIXEL_FOURCC)
        return format_find(word(data, AT_FOURCC));
    for (unsigned i = 0; (format = format_at(i)); i++)
        if (has_masks(format, data))
            return format;
    return NULL;
}

static int read_header(const char *path, const uint8_t *data, struct triptych_texture_description *texture,
                       struct error *error)
{
    uint32_t caps = word(data, AT_CAPS2);
    const struct format *format = find_format(data);
    if (word(data, AT_SIZE) != HEADER_SIZE || word(data, AT_PIXEL_FORMAT) != PIXEL_FORMAT_SIZE)
        return error_set(error, "%s: DDS header of %u and %u bytes, expected %d and %d", path,
                         word(data, AT_SIZE), word(data, AT_PIXEL_FORMAT), HEADER_SIZE, PIXEL_FORMAT_SIZE);
    if (!format)
        return error_set(error,
                         "%s: a DDS pixel format with flags 0x%x, FourCC 0x%08x, %u bits and masks %08x %08x "
                         "%08x %08x, expected one of Direct3D 9's",
                         path, word(data, AT_PIXEL_FLAGS), word(data, AT_FOURCC), word(data, AT_BITS),
                         word(data, AT_MASKS), word(data, AT_MASKS + 4), word(data, AT_MASKS + 8),
                         word(data, AT_MASKS + 12));
    if (caps & CAPS2_CUBE && (caps & CAPS2_ALL_FACES) != CAPS2_ALL_FACES)
        return error_set(error, "%s: a DDS cube without some of its faces, expected all six", path);
    bool levels = word(data, AT_FLAGS) & HAS_LEVELS && word(data, AT_LEVELS);
    *texture = (struct triptych_texture_description){
        .type = caps & CAPS2_CUBE     ? TRIPTYCH_TEXTURE_CUBE
                : caps & CAPS2_VOLUME ? TRIPTYCH_TEXTURE_VOLUME
                                      : TRIPTYCH_TEXTURE_2D,
        .format = (enum triptych_surface_format)format->number,
        .width = word(data, AT_WIDTH),
        .height = word(data, AT_HEIGHT),
        .depth = caps & CAPS2_VOLUME ? word(data, AT_DEPTH) : 1,
        .levels = levels ? word(data, AT_LEVELS) : 1,
    };
    return 0;
}

int dds_read(const char *path, const void *data, size_t bytes, struct triptych_texture_description *texture,
             size_t *offset, struct error *error)
{
    struct triptych_texture shape;
    struct error reason = {{0}};
    size_t expected = 0;
    if (!dds_is(data, bytes) || bytes < HEADER_BYTES)
        return error_set(error, "%s: no DDS file, expected one that begins with \"DDS \" and has %d bytes",
                         path, HEADER_BYTES);
    if (read_header(path, data, texture, error))
        return -1;
    if (texture_describe(texture, &shape, &reason))
        return error_set(error, "%s: %s", path, reason.text);
    for (unsigned level = 0; level < shape.levels; level++)
        expected += shape.faces * texture_level_bytes(&shape, level);
    if (bytes - HEADER_BYTES != expected)
        return error_set(error, "%s: %zu bytes of texels, expected %zu", path, bytes - HEADER_BYTES,
                         expected);
    *offset = HEADER_BYTES;
    return 0;
}
