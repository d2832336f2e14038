/* Areas that shapes have in common with the square of a pixel, in binary64. */
#ifndef TESTS_SUPPORT_SMOOTH_AREA_H
#define TESTS_SUPPORT_SMOOTH_AREA_H

#include <stdbool.h>

/* Points with a x + b y + c >= 0. */
struct area_side {
    double a, b, c;
};

/* The side of the line from one point to another that has the positive edge function of the rasterizer:
 * with y down, the right one. `turned` takes the other. */
struct area_side area_side_of(double from_x, double from_y, double to_x, double to_y, int turned);

/* The area of pixel x, y on all sides; up to 4. */
double area_within(const struct area_side *side, int count, int x, int y);

/* Returns true if the pixel's square has points inside of each side. This is exact for positions in 1/256
 * pixel. */
bool area_touches(const struct area_side *side, int count, int x, int y);

/* How many of the sides cut the pixel's square in two. */
int area_cuts(const struct area_side *side, int count, int x, int y);

/* The area of pixel x, y in a circle. */
double area_in_circle(double centre_x, double centre_y, double radius, int x, int y);

#endif
