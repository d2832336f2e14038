#include "gles_texel.h"

uint32_t gles_rgba(uint32_t argb)
{
    return (argb & 0xff00ff00) | (argb >> 16 & 255) | (argb & 255) << 16;
}

uint32_t gles_checker(unsigned x, unsigned y, unsigned side)
{
    (void)side;
    return gles_rgba((x / 4 + y / 4) % 2 ? 0x80203060 : 0xffe0a040);
}

/* From 0 at the first texel of a side to 255 at the last. */
static uint32_t ramp(unsigned at, unsigned side)
{
    return (510 * at + side - 1) / (2 * (side - 1));
}

uint32_t gles_gradient(unsigned x, unsigned y, unsigned side)
{
    return 0xff000000 | ramp(y, side) << 8 | ramp(x, side);
}

uint8_t gles_mask(unsigned x, unsigned y)
{
    return (x / 24 + y / 24) % 2 ? 0x60 : 0xff;
}

/* The mean of four texels, channel by channel, rounded. */
void gles_halve(const uint32_t *from, uint32_t *to, unsigned side)
{
    for (unsigned y = 0; y < side; y++)
        for (unsigned x = 0; x < side; x++) {
            uint32_t mean = 0;
            for (unsigned shift = 0; shift < 32; shift += 8) {
                const uint32_t *texel = from + (2 * y * 2 * side) + 2 * x;
                uint32_t sum = (texel[0] >> shift & 255) + (texel[1] >> shift & 255) +
                               (texel[2 * side] >> shift & 255) + (texel[2 * side + 1] >> shift & 255);
                mean |= (sum + 2) / 4 << shift;
            }
            to[y * side + x] = mean;
        }
}
