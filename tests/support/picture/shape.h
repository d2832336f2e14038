/* Points, lines and triangles on the canvas, given by their positions in the window. */
#ifndef TESTS_SUPPORT_PICTURE_SHAPE_H
#define TESTS_SUPPORT_PICTURE_SHAPE_H

#include "tests/support/picture/canvas.h"

/* x and y are pixels from the upper left, y down. They are exact if they are multiples of 1/256. z is the
 * depth, from 0 to 1; vertices outside of this range are clipped. */
struct shape_vertex {
    float x, y, z;
    uint32_t color; /* 0xAARRGGBB */
    float u, v;
};

/* Draws the vertices as one list or strip. */
void draw_shape(enum triptych_primitive primitive, const struct shape_vertex *vertex, unsigned count);

void set_number(enum triptych_state state, uint32_t value);
void set_real(enum triptych_state state, float value);

/* Clears colour to 0 and depth to 1. */
void clear_shapes(void);

/* Reads the target to `image`, and depth to shape_depth. */
extern float shape_depth[SIZE * SIZE];
void read_shapes(void);

#endif
