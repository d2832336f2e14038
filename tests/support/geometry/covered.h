/* Counts how often triangles cover each pixel of a scissor rectangle, with the renderer's rasterizer. */
#ifndef TESTS_SUPPORT_GEOMETRY_COVERED_H
#define TESTS_SUPPORT_GEOMETRY_COVERED_H

#include "render/raster/raster.h"

/* One byte for each pixel of an area of the window, which is the scissor rectangle and some pixels around it.
 */
struct covered {
    struct rectangle cut;
    int32_t width, height;
    uint8_t *count;
};

struct covered covered_make(struct rectangle cut);

void covered_fail(const struct triangle_head *h, const struct rectangle *cut, int x, int y, const char *what);

void covered_count_tile(struct covered *a, const struct triangle_head *h, int column, int row);

/* Counts the pixels of a triangle in the tiles that the binner would not reject. */
void covered_count(struct covered *a, const struct triangle_head *h);

/* Makes the area positive by an exchange of two vertices. Returns false for triangles without area. */
bool covered_orient(struct triangle_head *h);

#endif
