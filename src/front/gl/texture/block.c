#include "front/gl/texture/block.h"

#include <string.h>

/* --- ETC1 --- */

/* The brightness that index 0 or 1 of a table adds; 2 and 3 subtract it. */
static const uint8_t modifiers[8][2] = {{2, 8},   {5, 17},  {9, 29},   {13, 42},
                                        {18, 60}, {24, 80}, {33, 106}, {47, 183}};

static uint8_t limit(int value)
{
    return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
}

static int widen5(int value)
{
    return value << 3 | value >> 2;
}

/* The colours of both halves. `words` is the block, the first byte highest. */
static void half_colors(uint64_t words, int color[2][3])
{
    bool differential = words >> 33 & 1;
    for (int c = 0; c < 3; c++) {
        int byte = (int)(words >> (56 - 8 * c) & 0xff);
        if (differential) {
            int base = byte >> 3, delta = (byte & 7) - (byte & 4) * 2;
            color[0][c] = widen5(base);
            color[1][c] = widen5((base + delta) & 31);
        } else {
            color[0][c] = (byte >> 4) * 17;
            color[1][c] = (byte & 15) * 17;
        }
    }
}

void gl_block_etc1(const uint8_t data[8], uint8_t block[4][4][4])
{
    uint64_t words = 0;
    int color[2][3];
    for (int i = 0; i < 8; i++)
        words = words << 8 | data[i];
    half_colors(words, color);
    bool flipped = words >> 32 & 1; /* the halves are one above the other */
    for (int i = 0; i < 16; i++) {
        int x = i / 4, y = i % 4, half = (flipped ? y : x) / 2;
        int table = (int)(words >> (half ? 34 : 37) & 7);
        int size = modifiers[table][words >> i & 1];
        for (int c = 0; c < 3; c++)
            block[y][x][c] = limit(color[half][c] + (words >> (16 + i) & 1 ? -size : size));
        block[y][x][3] = 255;
    }
}

/* --- DXT1 --- */

static void unpack565(unsigned word, uint8_t color[4])
{
    unsigned red = word >> 11, green = word >> 5 & 63, blue = word & 31;
    color[0] = (uint8_t)(red << 3 | red >> 2);
    color[1] = (uint8_t)(green << 2 | green >> 4);
    color[2] = (uint8_t)(blue << 3 | blue >> 2);
    color[3] = 255;
}

static void palette_of(unsigned first, unsigned second, bool alpha, uint8_t palette[4][4])
{
    unpack565(first, palette[0]);
    unpack565(second, palette[1]);
    for (int c = 0; c < 4; c++) {
        int a = palette[0][c], b = palette[1][c];
        palette[2][c] = (uint8_t)(first > second ? (2 * a + b) / 3 : (a + b) / 2);
        palette[3][c] = (uint8_t)(first > second ? (a + 2 * b) / 3 : c == 3 && !alpha ? 255 : 0);
    }
}

void gl_block_dxt1(const uint8_t data[8], bool alpha, uint8_t block[4][4][4])
{
    uint8_t palette[4][4];
    palette_of(data[0] | (unsigned)data[1] << 8, data[2] | (unsigned)data[3] << 8, alpha, palette);
    for (int i = 0; i < 16; i++)
        memcpy(block[i / 4][i % 4], palette[data[4 + i / 4] >> (i % 4 * 2) & 3], 4);
}
