/* Text in pictures: a fixed font of 5 x 8 dots in cells of 6 x 10. */
#ifndef COMMAND_VIEW_FONT_H
#define COMMAND_VIEW_FONT_H

#include <stddef.h>
#include <stdint.h>

enum { FONT_WIDTH = 6, FONT_HEIGHT = 10 };

/* A picture of RGBA8 words, red in the low byte. */
struct font_picture {
    unsigned width, height;
    uint32_t *color;
};

/* Draws the text with its upper left corner at (x, y), each dot `scale` pixels wide, on a background that is
 * darkened. Characters without a glyph are drawn as "?"; what lies outside of the picture is left out. */
void font_draw(const struct font_picture *picture, int x, int y, int scale, uint32_t color, const char *text);

#endif
