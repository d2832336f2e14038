#include "render/texture/format.h"

#include "base/bits.h"
#include "base/half.h"
#include "base/minmax.h"

#include <math.h>
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

/* --- Channels --- */

static uint32_t largest(const struct channel *channel)
{
    int bits = channel->bits - (channel->type == CHANNEL_SIGNED);
    return (uint32_t)((1ull << bits) - 1);
}

/* The channel's bits, in the low ones of the result. */
static uint32_t get_bits(const struct channel *channel, const uint8_t *block)
{
    uint64_t bits = 0;
    int last = (channel->shift + channel->bits - 1) / 8;
    for (int i = last; i >= channel->shift / 8; i--)
        bits = bits << 8 | block[i];
    return (uint32_t)(bits >> channel->shift % 8 & ((1ull << channel->bits) - 1));
}

static void put_bits(const struct channel *channel, uint32_t value, uint8_t *block)
{
    uint64_t bits = (uint64_t)value << channel->shift % 8;
    for (int i = channel->shift / 8; bits; i++, bits >>= 8)
        block[i] |= (uint8_t)bits;
}

static uint32_t decode_byte(const struct channel *channel, const uint8_t *block)
{
    if (channel->type != CHANNEL_UNSIGNED)
        return channel->type == CHANNEL_ONE ? 255 : 0;
    uint32_t most = largest(channel);
    return (get_bits(channel, block) * 510 + most) / (2 * most);
}

static float decode_signed(const struct channel *channel, uint32_t bits)
{
    int unused = 32 - channel->bits;
    double value = (int32_t)(bits << unused) >> unused;
    return (float)fmax(value / largest(channel), -1);
}

static float decode_number(const struct channel *channel, const uint8_t *block)
{
    if (channel->type == CHANNEL_ZERO || channel->type == CHANNEL_ONE)
        return channel->type == CHANNEL_ONE;
    uint32_t bits = get_bits(channel, block);
    if (channel->type == CHANNEL_UNSIGNED)
        return (float)((double)bits / largest(channel));
    if (channel->type == CHANNEL_SIGNED)
        return decode_signed(channel, bits);
    if (channel->bits == 16)
        return half_to_float((uint16_t)bits);
    return bits_to_float(bits);
}

static uint32_t encode_byte(const struct channel *channel, uint32_t byte)
{
    uint32_t most = largest(channel);
    return (byte * 2 * most + 255) / 510;
}

/* Nearest even; NaN is 0. */
static uint32_t encode_number(const struct channel *channel, float number)
{
    if (channel->type == CHANNEL_FLOAT)
        return channel->bits == 16 ? float_to_half(number) : bits_of_float(number);
    double low = channel->type == CHANNEL_SIGNED ? -1 : 0;
    double inside = number >= 1 ? 1 : number > low ? number : isnan(number) ? 0 : low;
    return (uint32_t)llrint(inside * largest(channel)) & (uint32_t)((1ull << channel->bits) - 1);
}

/* Returns true if the channel is stored in bits of its own, not in those of an earlier channel. */
static bool is_stored(const struct format *format, int c)
{
    if (format->channel[c].type == CHANNEL_ZERO || format->channel[c].type == CHANNEL_ONE)
        return 0;
    for (int before = 0; before < c; before++)
        if (!memcmp(&format->channel[before], &format->channel[c], sizeof format->channel[c]))
            return 0;
    return 1;
}

/* --- Texels --- */

static void decode_texel(const struct format *format, const uint8_t *block, uint8_t *texel)
{
    uint32_t word = 0;
    float number[4];
    if (format->storage == STORAGE_RGBA8) {
        for (int c = 0; c < 4; c++)
            word |= decode_byte(&format->channel[c], block) << 8 * c;
        memcpy(texel, &word, sizeof word);
        return;
    }
    for (int c = 0; c < 4; c++)
        number[c] = decode_number(&format->channel[c], block);
    if (format->coding == CODING_NORMAL) {
        double x = (double)number[0], y = (double)number[1];
        number[2] = (float)sqrt(fmax(1 - x * x - y * y, 0));
    }
    memcpy(texel, number, sizeof number);
}

static void encode_texel(const struct format *format, const uint8_t *texel, uint8_t *block)
{
    memset(block, 0, format->bytes);
    for (int c = 0; c < 4; c++) {
        const struct channel *channel = &format->channel[c];
        float number;
        if (!is_stored(format, c))
            continue;
        if (format->storage == STORAGE_FLOAT4)
            memcpy(&number, texel + 4 * c, sizeof number);
        put_bits(channel,
                 format->storage == STORAGE_RGBA8 ? encode_byte(channel, texel[c])
                                                  : encode_number(channel, number),
                 block);
    }
}

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
    size_t size = format_texel_bytes(format);
    if (format->side > 1) {
        decode_blocks(format, data, pitch, width, height, texels, texels_stride);
        return;
    }
    for (uint32_t y = 0; y < height; y++) {
        const uint8_t *from = (const uint8_t *)data + y * pitch;
        uint8_t *to = (uint8_t *)texels + y * texels_stride * size;
        for (uint32_t x = 0; x < width; x++, from += format->bytes, to += size)
            decode_texel(format, from, to);
    }
}

void format_encode(const struct format *format, const void *texels, size_t texels_stride, uint32_t width,
                   uint32_t height, void *data, size_t pitch)
{
    size_t size = format_texel_bytes(format);
    for (uint32_t y = 0; y < height; y++) {
        const uint8_t *from = (const uint8_t *)texels + y * texels_stride * size;
        uint8_t *to = (uint8_t *)data + y * pitch;
        for (uint32_t x = 0; x < width; x++, from += size, to += format->bytes)
            encode_texel(format, from, to);
    }
}
