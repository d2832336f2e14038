/* Exact comparison of two rendered pictures, and a picture of their differences.
 *
 * Equal means equal bytes. Depths and numbers are compared as words, so 0 differs from -0, and two NaNs are
 * equal only if their payloads are. */
#ifndef IMAGE_COMPARE_H
#define IMAGE_COMPARE_H

#include <stdbool.h>
#include <stdint.h>

/* Rows from the top, without gaps. Two pictures can be compared only if their sizes are equal. */
struct picture {
    unsigned width, height;
    const uint32_t *color;  /* RGBA8, red in the low byte */
    const float *depth;     /* null in both pictures: not compared */
    const uint8_t *stencil; /* null in both pictures if not compared */
    const float *numbers; /* null if not compared: `numbers_each` floats per pixel, of targets beyond RGBA8 */
    unsigned numbers_each;
};

struct difference {
    /* The number of pixels that differ in each. */
    uint64_t color_pixels, depth_pixels, stencil_pixels, number_pixels;
    unsigned x, y;     /* the first pixel, in row order, that differs in anything */
    uint32_t color[2]; /* its values in both pictures */
    float depth[2];
    uint8_t stencil[2];
    unsigned number_place; /* the index of its first number that differs, and both values */
    float number[2];
    uint32_t color_distance; /* the largest difference of one channel of any pixel, 0 to 255 */
};

/* Returns true if the pictures differ. Fills *difference, which is zero for equal pictures. */
bool compare_pictures(const struct picture *first, const struct picture *second,
                      struct difference *difference);

/* How far apart the colours of two pictures are. */
struct compare_distance {
    uint64_t pixels;    /* those whose difference in one channel is more than the tolerance */
    uint32_t largest;   /* the largest difference of one channel, 0 to 255 */
    double mean_square; /* of the differences of all four channels of all pixels */
};

struct compare_distance compare_distance(const struct picture *first, const struct picture *second,
                                         uint32_t tolerance);

/* The peak signal-to-noise ratio in decibels: 10 log10 (255^2 / mean square). Infinite for equal colours. */
double compare_psnr(const struct compare_distance *distance);

/* Paints width * height opaque RGBA8 words. Equal pixels have the first picture's brightness, darkened.
 * Pixels of different colour are red, brighter the larger the distance. Pixels that differ only in depth,
 * stencil or numbers are blue. */
void compare_paint(const struct picture *first, const struct picture *second, uint32_t *painting);

#endif
