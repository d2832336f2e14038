/* Exact comparison of two rendered pictures, and the picture of their difference.
 *
 * Equal means equal bytes: depths are compared as words, so 0 differs from -0, and every NaN from every
 * other. */
#ifndef BASE_COMPARE_H
#define BASE_COMPARE_H

#include <stdbool.h>
#include <stdint.h>

/* Rows from the top, without gaps; two pictures that are compared have one size. */
struct picture {
    unsigned width, height;
    const uint32_t *color;  /* RGBA8, red in the low byte */
    const float *depth;     /* null in both pictures: not compared */
    const uint8_t *stencil; /* likewise */
    const float *numbers;   /* likewise: `numbers_each` a pixel, what color has rounded and more */
    unsigned numbers_each;
};

struct difference {
    /* How many pixels differ in each. */
    uint64_t color_pixels, depth_pixels, stencil_pixels, number_pixels;
    unsigned x, y;     /* the first pixel, in row order, that differs in any */
    uint32_t color[2]; /* its values in the two pictures */
    float depth[2];
    uint8_t stencil[2];
    unsigned number_place; /* of the first of its numbers that differ, and both */
    float number[2];
    uint32_t color_distance; /* the largest difference of one channel of any pixel, 0 to 255 */
};

/* Whether the pictures differ; if they do, *difference tells how, otherwise it is all zero. */
bool compare_pictures(const struct picture *first, const struct picture *second,
                      struct difference *difference);

/* Paints width * height words: the first picture's brightness, darkened, where both agree; red where the
 * colours differ, brighter the larger the distance; blue where only the rest differs. Opaque. */
void compare_paint(const struct picture *first, const struct picture *second, uint32_t *painting);

#endif
