/* The definition of the pixels that a line covers (render/raster/raster_line.c), decided pixel by pixel with
 * exact fractions: slow, and unlike any rasterizer. Positions are in 1/256 pixel, the centre of pixel (x, y)
 * at (256 x + 128, 256 y + 128). */
#ifndef TESTS_SUPPORT_PICTURE_DIAMOND_H
#define TESTS_SUPPORT_PICTURE_DIAMOND_H

#include <stdint.h>

struct diamond_line {
    int32_t x0, y0, x1, y1;
    int last; /* whether the last pixel is drawn */
};

int diamond_covers(const struct diamond_line *line, int32_t x, int32_t y);

#endif
