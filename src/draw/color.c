#include "draw/color.h"

#include "def/lane.h"

static int has_bits(const struct format *format, int storage)
{
    for (int c = 0; c < 4; c++)
        if (format->channel[c].type == CHANNEL_UNSIGNED && format->channel[c].bits != target_bits[storage][c])
            return 0;
    return 1;
}

enum target_storage color_storage(const struct format *format)
{
    int planes = format->storage == STORAGE_RGBA8 ? 1 : 4;
    if (format->channel[0].type == CHANNEL_FLOAT)
        return format->channel[0].bits == 16 ? TARGET_HALF : TARGET_FLOAT;
    int storage = 0;
    while (target_planes[storage] != planes || (planes == 4 && !target_bits[storage][0]) ||
           !has_bits(format, storage))
        storage++;
    return (enum target_storage)storage;
}

uint8_t color_channels(const struct format *format)
{
    uint8_t mask = 0;
    for (int c = 0; c < 4; c++)
        if (format->channel[c].type != CHANNEL_ONE)
            mask |= (uint8_t)(1 << c);
    return mask;
}

/* NaN gives 0. */
static float saturate(float value)
{
    return lane_min(lane_max(value, 0), 1);
}

static float quantized(int storage, int c, float value)
{
    int levels = (1 << target_bits[storage][c]) - 1;
    if (levels)
        return (float)lane_round(saturate(value) * (float)levels) / (float)levels;
    return storage == TARGET_HALF ? lane_half(value) : value;
}

static uint32_t byte_of(float value)
{
    return (uint32_t)lane_round(saturate(value) * 255.0f);
}

void color_encode(const struct format *format, const float color[4], uint32_t words[4])
{
    enum target_storage storage = color_storage(format);
    words[0] = 0;
    for (int c = 0; c < 4; c++) {
        float value = color_channels(format) >> c & 1 ? quantized(storage, c, color[c]) : 1;
        if (target_planes[storage] == 1)
            words[0] |= byte_of(value) << 8 * c;
        else
            words[c] = lane_bits(value);
    }
}

void color_numbers(enum target_storage storage, const uint32_t words[4], float color[4])
{
    for (int c = 0; c < 4; c++)
        color[c] = target_planes[storage] == 1 ? (float)(words[0] >> 8 * c & 255) / 255.0f
                                               : lane_from_bits(words[c]);
}

uint32_t color_bytes(enum target_storage storage, const uint32_t words[4])
{
    if (target_planes[storage] == 1)
        return words[0];
    uint32_t bytes = 0;
    for (int c = 0; c < 4; c++)
        bytes |= byte_of(lane_from_bits(words[c])) << 8 * c;
    return bytes;
}
