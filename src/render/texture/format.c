#include "render/texture/format.h"

#include "base/minmax.h"
#include "render/texture/convert.h"

#include <string.h>

/* The words of def/state/format.def. */
#define TEXTURE ROLE_TEXTURE
#define COMPARE ROLE_COMPARE

#define ROLE_OF_COLOR(storage)  ROLE_TARGET
#define ROLE_OF_DEPTH(format)   ROLE_DEPTH
#define ROLE_OF_NOTHING         0
#define COLOR_OF_COLOR(storage) TARGET_##storage
#define COLOR_OF_DEPTH(format)  0
#define COLOR_OF_NOTHING        0
#define DEPTH_OF_COLOR(storage) TRIPTYCH_DEPTH_NONE
#define DEPTH_OF_DEPTH(format)  TRIPTYCH_DEPTH_##format
#define DEPTH_OF_NOTHING        TRIPTYCH_DEPTH_NONE

#define COMPACT_RGBA8  COMPACT_NONE
#define COMPACT_FLOAT4 COMPACT_NONE

/* The words of compact texels in rows are RGBA8. */
enum {
#define COMPACT(name, bytes, first, second, constant) STORAGE_##name = STORAGE_RGBA8,
#include "def/state/compact.def"
#undef COMPACT
};

/* clang-format off */
#define U(shift, count) {CHANNEL_UNSIGNED, shift, count}
#define S(shift, count) {CHANNEL_SIGNED, shift, count}
#define F(shift, count) {CHANNEL_FLOAT, shift, count}
#define ZERO            {CHANNEL_ZERO, 0, 0}
#define ONE             {CHANNEL_ONE, 0, 0}
/* clang-format on */

static const struct format formats[] = {
#define FORMAT(name, number, bytes, side, storage, sampled, drawn, coding, red, green, blue, alpha)          \
    {#name,                                                                                                  \
     number,                                                                                                 \
     bytes,                                                                                                  \
     side,                                                                                                   \
     STORAGE_##storage,                                                                                      \
     COMPACT_##storage,                                                                                      \
     (sampled) | ROLE_OF_##drawn,                                                                            \
     CODING_##coding,                                                                                        \
     COLOR_OF_##drawn,                                                                                       \
     DEPTH_OF_##drawn,                                                                                       \
     {red, green, blue, alpha}},
#include "def/state/format.def"
#undef FORMAT
};

#undef TEXTURE
#undef COMPARE
#undef U
#undef S
#undef F
#undef ZERO
#undef ONE

enum { FORMATS = sizeof formats / sizeof *formats };

const struct format *format_at(unsigned i)
{
    return i < FORMATS ? &formats[i] : NULL;
}

const struct format *format_find(uint32_t number)
{
    for (int i = 0; i < FORMATS; i++)
        if (formats[i].number == number)
            return &formats[i];
    return NULL;
}

const struct format *format_named(const char *name, size_t length)
{
    for (int i = 0; i < FORMATS; i++)
        if (strlen(formats[i].name) == length && !memcmp(formats[i].name, name, length))
            return &formats[i];
    return NULL;
}

const char *format_stored_name(const struct format *format)
{
    static const char *const compact[COMPACT_COUNT] = {
#define COMPACT(name, bytes, first, second, constant) [COMPACT_##name] = #name,
#include "def/state/compact.def"
#undef COMPACT
    };
    if (format->compact)
        return compact[format->compact];
    return format->storage == STORAGE_RGBA8 ? "rgba8" : "float4";
}

bool format_channel_is_stored(const struct format *format, unsigned c)
{
    if (format->channel[c].type == CHANNEL_ZERO || format->channel[c].type == CHANNEL_ONE)
        return false;
    if (format->coding == CODING_NORMAL && c == 2)
        return false;
    for (unsigned before = 0; before < c; before++)
        if (!memcmp(&format->channel[before], &format->channel[c], sizeof format->channel[c]))
            return false;
    return true;
}

/* --- Texels --- */

static void decode_blocks(const struct format *format, const uint8_t *data, size_t pitch, uint32_t width,
                          uint32_t height, uint8_t *texels, size_t stride)
{
    uint32_t side = format->side, block[16];
    for (uint32_t y = 0; y < height; y += side, data += pitch)
        for (uint32_t x = 0; x < width; x += side) {
            block_decode((enum coding)format->coding, data + x / side * format->bytes, block);
            for (uint32_t row = 0; row < min_u32(side, height - y); row++)
                memcpy(texels + ((y + row) * stride + x) * 4, block + row * side,
                       4 * min_u32(side, width - x));
        }
}

void format_decode(const struct format *format, const void *data, size_t pitch, uint32_t width,
                   uint32_t height, void *texels, size_t texels_stride)
{
    size_t size = format_row_bytes(format);
    if (format->side > 1) {
        decode_blocks(format, data, pitch, width, height, texels, texels_stride);
        return;
    }
    for (uint32_t y = 0; y < height; y++)
        format_decode_row(format, (const uint8_t *)data + y * pitch, width,
                          (uint8_t *)texels + y * texels_stride * size);
}

static void encode_blocks(const struct format *format, const uint8_t *texels, size_t stride, uint32_t width,
                          uint32_t height, uint8_t *data, size_t pitch)
{
    uint32_t side = format->side, block[16];
    for (uint32_t y = 0; y < height; y += side, data += pitch)
        for (uint32_t x = 0; x < width; x += side) {
            for (uint32_t i = 0; i < side * side; i++) {
                uint32_t column = min_u32(x + i % side, width - 1), row = min_u32(y + i / side, height - 1);
                memcpy(block + i, texels + (row * stride + column) * 4, 4);
            }
            block_encode((enum coding)format->coding, block, data + x / side * format->bytes);
        }
}

void format_encode(const struct format *format, const void *texels, size_t texels_stride, uint32_t width,
                   uint32_t height, void *data, size_t pitch)
{
    size_t size = format_row_bytes(format);
    if (format->side > 1) {
        encode_blocks(format, texels, texels_stride, width, height, data, pitch);
        return;
    }
    for (uint32_t y = 0; y < height; y++)
        format_encode_row(format, (enum storage)format->storage,
                          (const uint8_t *)texels + y * texels_stride * size, width,
                          (uint8_t *)data + y * pitch);
}
