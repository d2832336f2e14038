#include "render/target/color.h"

#include "base/bits.h"
#include "contract/lane.h"

uint8_t color_channels(const struct format *format)
{
    uint8_t mask = 0;
    for (int c = 0; c < 4; c++)
        if (format->channel[c].type != CHANNEL_ONE && format->channel[c].type != CHANNEL_ZERO)
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
    int levels = (1 << storage_bits[storage][c]) - 1;
    if (levels)
        return (float)lane_round(saturate(value) * (float)levels) / (float)levels;
    return storage == TARGET_HALF ? lane_half(value) : value;
}

/* Channel c of a colour in the format. */
static float stored_value(const struct format *format, int c, const float color[4])
{
    int storage = format->target;
    if (!(color_channels(format) >> c & 1))
        return format->channel[c].type == CHANNEL_ONE;
    return quantized(storage, c, color[storage == TARGET_L8 && c < 3 ? 0 : c]);
}

static uint32_t byte_of(float value)
{
    return (uint32_t)lane_round(saturate(value) * 255.0f);
}

void color_encode(const struct format *format, const float color[4], uint32_t words[4])
{
    enum target_storage storage = (enum target_storage)format->target;
    words[0] = 0;
    for (int c = 0; c < 4; c++) {
        float value = stored_value(format, c, color);
        if (storage_planes[storage] == 1)
            words[0] |= byte_of(value) << 8 * c;
        else
            words[c] = bits_of_float(value);
    }
}

void color_numbers(enum target_storage storage, const uint32_t words[4], float color[4])
{
    for (int c = 0; c < 4; c++)
        color[c] = storage_planes[storage] == 1 ? (float)(words[0] >> 8 * c & 255) / 255.0f
                                                : bits_to_float(words[c]);
}

uint32_t color_bytes(enum target_storage storage, const uint32_t words[4])
{
    if (storage_planes[storage] == 1)
        return words[0];
    uint32_t bytes = 0;
    for (int c = 0; c < 4; c++)
        bytes |= byte_of(bits_to_float(words[c])) << 8 * c;
    return bytes;
}
