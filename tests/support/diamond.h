/* The definition of which pixels a line covers (draw/raster_line.c), decided pixel by pixel with exact
 * fractions: slow, and unlike any rasterizer. Positions are in 1/256 pixel, the centre of pixel (x, y) at
 * (256 x + 128, 256 y + 128). */
#ifndef TESTS_DIAMOND_H
#define TESTS_DIAMOND_H

#include <stdint.h>

struct diamond_line {
    int32_t x0, y0, x1, y1;
    int last; /* whether the last pixel is drawn */
};

int diamond_covers(const struct diamond_line *line, int32_t x, int32_t y);

#endif
