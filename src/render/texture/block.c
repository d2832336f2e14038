/* Compressed blocks: DXT1 to DXT5 and 3Dc, as Direct3D 9 documents them.
 *
 * Colours: two R5G6B5 words c0 and c1, then 2 bits a texel, the first row's first texel lowest. c0 and c1 are
 * first expanded to 8 bits a channel, round(v * 255 / 31) and round(v * 255 / 63); codes 0 and 1 are they;
 * code 2 is (2 * c0 + c1 + 1) / 3 and code 3 (c0 + 2 * c1 + 1) / 3. In DXT1, where the word c0 is not greater
 * than c1, code 2 is (c0 + c1) / 2 and code 3 black with alpha 0; all other alphas are 255.
 *
 * Explicit alpha (DXT2, DXT3): 4 bits a texel, a * 17. Interpolated alpha (DXT4, DXT5), which is also what
 * 3Dc is made of: two bytes a0 and a1, then 3 bits a texel. Codes 0 and 1 are they; where a0 > a1 code i is
 * ((8 - i) * a0 + (i - 1) * a1 + 3) / 7, otherwise up to 5 ((6 - i) * a0 + (i - 1) * a1 + 2) / 5, 6 is 0 and
 * 7 is 255. Divisions drop the remainder.
 *
 * DXT2 and DXT4 mean colours that are multiplied by alpha; they are not divided again. ATI1 is one such block
 * in red, green and blue; ATI2 two, green first, then red. */
#include "render/texture/format.h"

static uint32_t read_16(const uint8_t *data)
{
    return (uint32_t)data[0] | (uint32_t)data[1] << 8;
}

static uint32_t read_32(const uint8_t *data)
{
    return read_16(data) | read_16(data + 2) << 16;
}

static void expand_565(uint32_t word, unsigned channel[3])
{
    channel[0] = ((word >> 11) * 510 + 31) / 62;
    channel[1] = ((word >> 5 & 63) * 510 + 63) / 126;
    channel[2] = ((word & 31) * 510 + 31) / 62;
}

void block_colors(const uint8_t *block, bool punch, uint32_t color[4])
{
    uint32_t word[2] = {read_16(block), read_16(block + 2)};
    unsigned a[3], b[3];
    bool three = punch && word[0] <= word[1];
    expand_565(word[0], a);
    expand_565(word[1], b);
    for (int i = 0; i < 4; i++)
        color[i] = 0xff000000;
    for (int c = 0; c < 3; c++) {
        color[0] |= a[c] << 8 * c;
        color[1] |= b[c] << 8 * c;
        color[2] |= (three ? (a[c] + b[c]) / 2 : (2 * a[c] + b[c] + 1) / 3) << 8 * c;
        color[3] |= ((a[c] + 2 * b[c] + 1) / 3) << 8 * c;
    }
    if (three)
        color[3] = 0;
}

static void decode_colors(const uint8_t *block, bool punch, uint32_t texels[16])
{
    uint32_t color[4], codes = read_32(block + 4);
    block_colors(block, punch, color);
    for (int i = 0; i < 16; i++)
        texels[i] = color[codes >> 2 * i & 3];
}

static void decode_explicit(const uint8_t *block, uint32_t texels[16])
{
    for (int i = 0; i < 16; i++) {
        uint32_t alpha = block[i / 2] >> 4 * (i % 2) & 15;
        texels[i] = (texels[i] & 0x00ffffff) | (alpha * 17) << 24;
    }
}

void block_values(unsigned a, unsigned b, unsigned value[8])
{
    unsigned steps = a > b ? 7 : 5;
    value[0] = a;
    value[1] = b;
    for (unsigned i = 2; i <= steps; i++)
        value[i] = ((steps + 1 - i) * a + (i - 1) * b + steps / 2) / steps;
    if (steps == 5) {
        value[6] = 0;
        value[7] = 255;
    }
}

static void decode_interpolated(const uint8_t *block, uint8_t values[16])
{
    unsigned value[8];
    uint64_t codes = (uint64_t)read_16(block + 2) | (uint64_t)read_32(block + 4) << 16;
    block_values(block[0], block[1], value);
    for (int i = 0; i < 16; i++)
        values[i] = (uint8_t)value[codes >> 3 * i & 7];
}

static void decode_ati1(const uint8_t *block, uint32_t texels[16])
{
    uint8_t values[16];
    decode_interpolated(block, values);
    for (int i = 0; i < 16; i++)
        texels[i] = 0xff000000 | values[i] * 0x010101u;
}

static void decode_ati2(const uint8_t *block, uint32_t texels[16])
{
    uint8_t green[16], red[16];
    decode_interpolated(block, green);
    decode_interpolated(block + 8, red);
    for (int i = 0; i < 16; i++)
        texels[i] = 0xffff0000 | (uint32_t)green[i] << 8 | red[i];
}

void block_decode(enum coding coding, const uint8_t *block, uint32_t texels[16])
{
    uint8_t alpha[16];
    switch (coding) {
    case CODING_DXT1: decode_colors(block, 1, texels); break;
    case CODING_DXT3:
        decode_colors(block + 8, 0, texels);
        decode_explicit(block, texels);
        break;
    case CODING_DXT5:
        decode_colors(block + 8, 0, texels);
        decode_interpolated(block, alpha);
        for (int i = 0; i < 16; i++)
            texels[i] = (texels[i] & 0x00ffffff) | (uint32_t)alpha[i] << 24;
        break;
    case CODING_ATI1: decode_ati1(block, texels); break;
    case CODING_ATI2: decode_ati2(block, texels); break;
    case CODING_PACKED:
    case CODING_NORMAL: break;
    }
}
