/* The definition of the pixels that a line covers (render/raster/raster_line.c), computed for each pixel with
 * exact fractions. It is slow and shares no method with a rasterizer. Positions are in 1/256 pixel; the
 * centre of pixel (x, y) is (256 x + 128, 256 y + 128). */
#ifndef TESTS_SUPPORT_PICTURE_DIAMOND_H
#define TESTS_SUPPORT_PICTURE_DIAMOND_H

#include <stdint.h>

struct diamond_line {
    int32_t x0, y0, x1, y1;
    int last; /* 1: the last pixel is drawn */
};

int diamond_covers(const struct diamond_line *line, int32_t x, int32_t y);
/* The same for a line of `width` pixels across: OpenGL ES 2.0, section 3.4.2. */
int diamond_covers_wide(const struct diamond_line *line, int width, int32_t x, int32_t y);

#endif
