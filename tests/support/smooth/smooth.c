#include "smooth.h"

#include <math.h>
#include <stdio.h>

static double snapped(double position)
{
    return round(position * 256) / 256;
}

struct shape_vertex smooth_vertex(double x, double y)
{
    return (struct shape_vertex){(float)snapped(x), (float)snapped(y), 0.5f, 0xffffffff, 0, 0};
}

double smooth_twice_area(const struct shape_vertex v[3])
{
    double x0 = (double)v[0].x, y0 = (double)v[0].y;
    return ((double)v[1].x - x0) * ((double)v[2].y - y0) - ((double)v[1].y - y0) * ((double)v[2].x - x0);
}

struct area_side smooth_line_side(const struct shape_vertex *from, const struct shape_vertex *to, int turned)
{
    return area_side_of((double)from->x, (double)from->y, (double)to->x, (double)to->y, turned);
}

struct area_side smooth_side(const struct shape_vertex v[3], int i)
{
    return smooth_line_side(&v[i], &v[(i + 1) % 3], smooth_twice_area(v) < 0);
}

void smooth_begin(unsigned edges)
{
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "always");
    set_number(TRIPTYCH_STATE_EDGEANTIALIAS, edges);
    clear_shapes();
}

bool smooth_is_drawn(int p)
{
    return shape_depth[p] < 1;
}

double smooth_coverage(int p)
{
    return channel(image[p], 3) / 255.0;
}

void expect_area(double expected, int p, double tolerance, const char *what)
{
    char text[160];
    double got = smooth_coverage(p);
    if (fabs(expected - got) <= tolerance)
        return;
    snprintf(text, sizeof text, "%s at (%d, %d): area %.5f, got %.5f", what, p % SIZE, p / SIZE, expected,
             got);
    TEST_FAIL_MESSAGE(text);
}

void expect_drawn(bool expected, int p, const char *what)
{
    char text[120];
    if (smooth_is_drawn(p) == expected)
        return;
    snprintf(text, sizeof text, "%s at (%d, %d): expected %s", what, p % SIZE, p / SIZE,
             expected ? "a fragment" : "none");
    TEST_FAIL_MESSAGE(text);
}

void smooth_far_triangle(struct shape_vertex v[3], double angle, double distance, bool turned)
{
    double c = cos(angle), s = sin(angle), x = SIZE / 2.0 + c * distance, y = SIZE / 2.0 + s * distance;
    v[0] = smooth_vertex(x + 400 * s, y - 400 * c);
    v[1] = smooth_vertex(x - 400 * s, y + 400 * c);
    v[2] = smooth_vertex(x - 300 * c, y - 300 * s);
    if (turned) {
        struct shape_vertex swap = v[0];
        v[0] = v[1];
        v[1] = swap;
    }
}
