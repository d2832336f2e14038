/* User clip planes and the state clipping, on every engine. A pixel of a flat picture stays if its centre is
 * on the inner side of every plane, which the test computes in double precision. */
#include "tests/support/picture/shape.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static const float identity[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

/* World coordinates of a pixel's centre while the matrices are identities. */
static double distance(const float plane[4], int x, int y, double z)
{
    double px = (x + 0.5) / (SIZE / 2.0) - 1, py = 1 - (y + 0.5) / (SIZE / 2.0);
    return (double)plane[0] * px + (double)plane[1] * py + (double)plane[2] * z + (double)plane[3];
}

static void set_planes(const float plane[][4], unsigned enabled)
{
    for (unsigned i = 0; i < TRIPTYCH_CLIP_PLANES; i++)
        OK(triptych_set_clip_plane(device, i, plane[i]));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CLIPPLANEENABLE, enabled));
}

static void random_planes(float plane[TRIPTYCH_CLIP_PLANES][4])
{
    for (int i = 0; i < TRIPTYCH_CLIP_PLANES; i++) {
        for (int c = 0; c < 3; c++)
            plane[i][c] = (float)random_between(-2, 2);
        plane[i][3] = (float)random_between(0, 1.5);
    }
}

/* Pixels whose distance from a plane is at most 1/100 pixel may be inside or outside. */
static void expect_kept(const float plane[][4], unsigned enabled, double z)
{
    for (int p = 0; p < SIZE * SIZE; p++) {
        double least = 1;
        for (int i = 0; i < TRIPTYCH_CLIP_PLANES; i++)
            if (enabled >> i & 1)
                least = fmin(least, distance(plane[i], p % SIZE, p / SIZE, z) /
                                        fmax(1e-9, hypot((double)plane[i][0], (double)plane[i][1])));
        if (fabs(least) > 0.02 * 2 / SIZE)
            expect_pixel(p % SIZE, p / SIZE, least > 0 ? ~0u : 0, "user clip planes");
    }
}

static void check_planes(void)
{
    for (int round = 0; round < 64; round++) {
        float plane[TRIPTYCH_CLIP_PLANES][4];
        float z = (float)random_between(0, 1);
        random_planes(plane);
        set_planes((const float(*)[4])plane, (unsigned)round);
        clear_shapes();
        draw_square(z, ~0u, NULL, 0, 0, 1, 1);
        read_shapes();
        expect_kept((const float(*)[4])plane, (unsigned)round, (double)z);
    }
}

static void test_parts_outside_of_an_enabled_plane_are_cut(void)
{
    on_every_engine(check_planes);
}

/* The planes are in world space, independent of the camera and the object. The object is moved by (0.25,
 * -0.5). The camera rotates by 90 degrees and scales by a half, and the projection scales by two. */
static void check_spaces(void)
{
    static const float world[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0.25f, -0.5f, 0, 1}};
    static const float view[4][4] = {{0, 0.5f, 0, 0}, {-0.5f, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    static const float projection[4][4] = {{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    static const float plane[TRIPTYCH_CLIP_PLANES][4] = {{0}, {1, 0, 0, -0.25f}};
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_WORLD, world));
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_VIEW, view));
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_PROJECTION, projection));
    set_planes(plane, 2);
    extent = 4;
    clear_shapes();
    draw_square(0.5f, ~0u, NULL, 0, 0, 1, 1);
    extent = 1;
    read_shapes();
    /* world x is screen y upwards: kept where y > 0.25, that is above row (1 - 0.25) * 32 */
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, p / SIZE < 24 ? ~0u : 0, "a plane in world space");
}

static void test_planes_are_in_world_space(void)
{
    on_every_engine(check_spaces);
}

/* A camera matrix that drops one axis has no inverse. The planes then do not cut. */
static void check_singular(void)
{
    float flat[4][4];
    static const float plane[TRIPTYCH_CLIP_PLANES][4] = {{0, 0, 1, -5}};
    memcpy(flat, identity, sizeof flat);
    flat[2][2] = 0;
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_VIEW, (const float(*)[4])flat));
    set_planes(plane, 1);
    clear_shapes();
    draw_square(0.5f, ~0u, NULL, 0, 0, 1, 1);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, ~0u, "without an inverse");
}

static void test_without_an_inverse_nothing_is_cut(void)
{
    on_every_engine(check_singular);
}

/* Lines and the edges of wireframes are cut. Points are inside or outside according to their centres. */
static void check_lines_and_points(void)
{
    static const float plane[TRIPTYCH_CLIP_PLANES][4] = {{1, 0, 0, 0.0078125f}}; /* x > 31.75 */
    struct shape_vertex line[2] = {{4.5f, 10.5f, 0.5f, ~0u, 0, 0}, {60.5f, 10.5f, 0.5f, ~0u, 0, 0}};
    struct shape_vertex point[2] = {{31.5f, 20, 0.5f, ~0u, 0, 0}, {32, 40, 0.5f, ~0u, 0, 0}};
    set_planes(plane, 1);
    set_real(TRIPTYCH_STATE_POINTSIZE, 8);
    clear_shapes();
    draw_shape(TRIPTYCH_LINE_LIST, line, 2);
    draw_shape(TRIPTYCH_POINT_LIST, point, 2);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++) {
        int x = p % SIZE, y = p / SIZE;
        int drawn = (y == 10 && x >= 32 && x <= 60) || (x >= 28 && x < 36 && y >= 36 && y < 44);
        if (!(y == 10 && x == 31)) /* the pixel in which the line is cut */
            expect_pixel(x, y, drawn ? ~0u : 0, "lines and points");
    }
}

static void test_lines_are_cut_and_points_are_not(void)
{
    on_every_engine(check_lines_and_points);
}

/* With clipping off, user planes and the near and far planes have no effect. The viewport's sides still cut,
 * and parts behind the eye are not drawn. */
static void check_clipping_off(void)
{
    static const float plane[TRIPTYCH_CLIP_PLANES][4] = {{0, 0, 0, -1}};
    static const float depths[] = {-3, 0.5f, 7};
    set_planes(plane, 1);
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "always");
    clear_shapes();
    draw_square(0.5f, ~0u, NULL, 0, 0, 1, 1);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, 0, "everything cut away");
    set(TRIPTYCH_STATE_CLIPPING, "false");
    for (int i = 0; i < 3; i++) {
        clear_shapes();
        draw_square(depths[i], ~0u, NULL, 0, 0, 1, 1);
        read_shapes();
        for (int p = 0; p < SIZE * SIZE; p++) {
            expect_pixel(p % SIZE, p / SIZE, ~0u, "clipping off");
            TEST_ASSERT_EQUAL_FLOAT(fminf(fmaxf(depths[i], 0), 1), shape_depth[p]);
        }
    }
    OK(triptych_set_viewport(device, &(struct triptych_viewport){8, 8, 16, 16, 0, 1}));
    extent = 100000;
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, SIZE, SIZE, 0, 1}));
    clear_shapes();
    OK(triptych_set_viewport(device, &(struct triptych_viewport){8, 8, 16, 16, 0, 1}));
    draw_square(0.5f, ~0u, NULL, 0, 0, 1, 1);
    extent = 1;
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++) {
        int x = p % SIZE, y = p / SIZE;
        expect_pixel(x, y, x >= 8 && x < 24 && y >= 8 && y < 24 ? ~0u : 0, "a viewport with clipping off");
    }
}

static void test_clipping_can_be_off(void)
{
    on_every_engine(check_clipping_off);
}

static void check_errors(void)
{
    static const float infinite[4] = {0, 0, INFINITY, 0};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_clip_plane(device, 6, identity[0]));
    TEST_ASSERT_EQUAL_STRING("clip plane 6: expected 0 to 5", triptych_error(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_clip_plane(device, 0, infinite));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_clip_plane(device, 0, NULL));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_set_state(device, TRIPTYCH_STATE_CLIPPLANEENABLE, 64));
}

static void test_bad_planes_are_refused(void)
{
    on_every_engine(check_errors);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_parts_outside_of_an_enabled_plane_are_cut);
    RUN_TEST(test_planes_are_in_world_space);
    RUN_TEST(test_without_an_inverse_nothing_is_cut);
    RUN_TEST(test_lines_are_cut_and_points_are_not);
    RUN_TEST(test_clipping_can_be_off);
    RUN_TEST(test_bad_planes_are_refused);
    return UNITY_END();
}
