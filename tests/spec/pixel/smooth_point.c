/* Smooth points, on every engine: circles, compared with the area that circle and square have in common;
 * sizes of vertices, corners of triangles, and sprites, which are never smooth. */
#include "tests/support/smooth/smooth.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <stdbool.h>

/* The largest error, of points that are smaller than 2 pixels and of others, with half a step of a byte. */
#define DISC_SMALL (0.0145 + 0.5 / 255)
#define DISC       (1.5 / 255)

static bool first_engine;

void setUp(void)
{
    first_engine = true;
}

void tearDown(void)
{
    close_canvas();
}

static bool disc_touches(const struct shape_vertex *v, double radius, int x, int y)
{
    double dx = fmax(fabs(x + 0.5 - (double)v->x) - 0.5, 0), dy = fmax(fabs(y + 0.5 - (double)v->y) - 0.5, 0);
    return dx * dx + dy * dy < radius * radius;
}

static void expect_disc(const struct shape_vertex *v, double size, const char *what)
{
    double radius = round(size * 128) / 256;
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        double area = area_in_circle((double)v->x, (double)v->y, radius, p % SIZE, p / SIZE);
        expect_drawn(disc_touches(v, radius, p % SIZE, p / SIZE), p, what);
        expect_area(area, p, size < 2 ? DISC_SMALL : DISC, what);
    }
}

static void begin_points(float size)
{
    smooth_begin(0);
    set(TRIPTYCH_STATE_ANTIALIASEDPOINTENABLE, "true");
    set_real(TRIPTYCH_STATE_POINTSIZE_MIN, 0);
    set_real(TRIPTYCH_STATE_POINTSIZE, size);
}

static void check_points(void)
{
    static const float sizes[] = {1, 0.5f, 1.75f, 3, 5.5f, 12, 40};
    unsigned count = first_engine ? test_share_of(280, 20) : 14;
    first_engine = false;
    for (unsigned i = 0; i < count; i++) {
        float size = sizes[i % 7];
        struct shape_vertex v = smooth_vertex(random_between(0, SIZE), random_between(0, SIZE));
        begin_points(size);
        draw_shape(TRIPTYCH_POINT_LIST, &v, 1);
        read_shapes();
        expect_disc(&v, (double)size, "a point");
    }
}

static void test_points_cover_the_area_of_their_circle(void)
{
    on_every_engine(check_points);
}

static void check_corners(void)
{
    const struct shape_vertex v[3] = {smooth_vertex(9.2, 12.4), smooth_vertex(55.7, 21.1),
                                      smooth_vertex(24.3, 53.8)};
    begin_points(6.5f);
    set(TRIPTYCH_STATE_FILLMODE, "point");
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        double area = 0;
        for (int i = 0; i < 3; i++)
            area += area_in_circle((double)v[i].x, (double)v[i].y, 3.25, p % SIZE, p / SIZE);
        expect_area(area, p, DISC, "a corner");
    }
}

static void test_corners_of_triangles_are_points(void)
{
    on_every_engine(check_corners);
}

static void check_sprites(void)
{
    const struct shape_vertex v = smooth_vertex(30, 30);
    begin_points(10);
    set(TRIPTYCH_STATE_POINTSPRITEENABLE, "true");
    draw_shape(TRIPTYCH_POINT_LIST, &v, 1);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++) {
        bool inside = p % SIZE >= 25 && p % SIZE < 35 && p / SIZE >= 25 && p / SIZE < 35;
        expect_pixel(p % SIZE, p / SIZE, inside ? 0xffffffff : 0, "a sprite");
    }
}

static void test_sprites_are_squares(void)
{
    on_every_engine(check_sprites);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_points_cover_the_area_of_their_circle);
    RUN_TEST(test_corners_of_triangles_are_points);
    RUN_TEST(test_sprites_are_squares);
    return UNITY_END();
}
