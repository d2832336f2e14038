#include "command/view/font.h"

enum { FIRST = ' ', GLYPH_COLUMNS = 5, GLYPH_ROWS = 8 };

static const uint8_t glyphs[][GLYPH_COLUMNS] = {
#define GLYPH(character, ...) {__VA_ARGS__},
#include "command/view/font.def"
#undef GLYPH
};

enum { GLYPHS = sizeof glyphs / sizeof *glyphs };

/* A quarter of each channel but alpha. */
static uint32_t darkened(uint32_t color)
{
    return (color >> 2 & 0x003f3f3f) | (color & 0xff000000);
}

/* Column -1 and row -1 are the margins of a cell. */
static int has_dot(const uint8_t *glyph, int column, int row)
{
    return column >= 0 && column < GLYPH_COLUMNS && row >= 0 && row < GLYPH_ROWS && glyph[column] >> row & 1;
}

static void draw_cell(const struct font_picture *picture, int x, int y, int scale, uint32_t color,
                      const uint8_t *glyph)
{
    for (int row = 0; row < FONT_HEIGHT * scale; row++)
        for (int column = 0; column < FONT_WIDTH * scale; column++) {
            int px = x + column, py = y + row;
            if (px < 0 || py < 0 || px >= (int)picture->width || py >= (int)picture->height)
                continue;
            uint32_t *pixel = picture->color + (unsigned)py * (size_t)picture->width + (unsigned)px;
            *pixel = has_dot(glyph, column / scale, row / scale - 1) ? color : darkened(*pixel);
        }
}

void font_draw(const struct font_picture *picture, int x, int y, int scale, uint32_t color, const char *text)
{
    for (; *text; text++, x += FONT_WIDTH * scale) {
        unsigned number = (unsigned)(unsigned char)*text - FIRST;
        draw_cell(picture, x, y, scale, color, glyphs[number < GLYPHS ? number : '?' - FIRST]);
    }
}
