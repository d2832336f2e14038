/* Smooth primitives on the canvas: opaque white, so that the target's alpha is the part of a pixel that is
 * covered, at depth 0.5, by which fragments are found. */
#ifndef TESTS_SUPPORT_SMOOTH_SMOOTH_H
#define TESTS_SUPPORT_SMOOTH_SMOOTH_H

#include "tests/support/smooth/area.h"
#include "tests/support/picture/shape.h"

/* The largest error where one edge cuts a square, or two parallel ones; and at a triangle's corner. */
#define SMOOTH_STRAIGHT (1.0 / 255)
#define SMOOTH_CORNER   0.112

/* A vertex at the nearest position in 1/256 pixel. */
struct shape_vertex smooth_vertex(double x, double y);

/* Positive if the vertices are clockwise on the screen. */
double smooth_twice_area(const struct shape_vertex v[3]);

/* The side of the line from one vertex to another; of edge i of a triangle the inner one. */
struct area_side smooth_line_side(const struct shape_vertex *from, const struct shape_vertex *to, int turned);
struct area_side smooth_side(const struct shape_vertex v[3], int i);

/* A triangle whose edge 0 crosses the canvas at a distance from its centre, while the others are far away. */
void smooth_far_triangle(struct shape_vertex v[3], double angle, double distance, bool turned);

/* Clears the canvas, and sets the state edgeantialias. */
void smooth_begin(unsigned edges);

/* Of pixel p of what read_shapes has read. */
bool smooth_is_drawn(int p);
double smooth_coverage(int p);
void expect_area(double expected, int p, double tolerance, const char *what);
void expect_drawn(bool expected, int p, const char *what);

#endif
