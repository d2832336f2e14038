/* Squares on the canvas, drawn by shaders. Vertices have any elements, and each corner has its own values.
 * Targets are read as numbers. */
#ifndef TESTS_SUPPORT_PICTURE_DRAWN_H
#define TESTS_SUPPORT_PICTURE_DRAWN_H

#include "canvas.h"

enum { DRAWN_ELEMENTS = 16 };

/* Elements of the vertices that draw_declared makes, after position 0; each is four floats. */
struct drawn_element {
    enum triptych_usage usage;
    unsigned index;
    float value[4][4]; /* at the upper left, upper right, lower left, lower right */
};

extern float drawn_position[4][4];  /* drawn_begin sets it to the whole target at depth 0.5 */
extern float drawn[SIZE * SIZE][4]; /* the result of read_numbers */

void drawn_begin(void);

/* Sets both shaders from text; null: the fixed function. */
void use_shaders(const char *vertex, const char *pixel);

/* Returns an element with the same value at all corners. */
struct drawn_element drawn_constant(enum triptych_usage usage, unsigned index, float x, float y, float z,
                                    float w);

/* Draws the square, as a strip or as points; `position` is POSITION or POSITIONT. */
void draw_declared(enum triptych_usage position, const struct drawn_element *elements, unsigned count);
void draw_points(const struct drawn_element *elements, unsigned count);

/* Sets a target whose channels are binary32, so that it stores the shader's results without rounding. */
void use_float_target(void);

/* Reads target t; fails unless the pixel has these channels. */
void read_numbers(unsigned t);
void expect_numbers(int x, int y, const float expected[4], const char *what);
#define EXPECT_CENTRE(what, ...) expect_numbers(SIZE / 2, SIZE / 2, (const float[4]){__VA_ARGS__}, what)

#endif
