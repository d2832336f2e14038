/* Smooth edges of triangles, on every engine: which pixels are drawn, and how much of them is covered,
 * compared with the area of the polygon that the triangle and the pixel's square have in common. The
 * target's alpha is the coverage, since what is drawn is opaque. */
#include "tests/support/smooth/smooth.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <stdbool.h>

static bool first_engine;

void setUp(void)
{
    first_engine = true;
}

void tearDown(void)
{
    close_canvas();
}

/* Compares the canvas with a triangle whose edges are all smooth. */
static void expect_triangle(const struct shape_vertex v[3], double corner, const char *what)
{
    const struct area_side side[3] = {smooth_side(v, 0), smooth_side(v, 1), smooth_side(v, 2)};
    float left = fminf(v[0].x, fminf(v[1].x, v[2].x)), right = fmaxf(v[0].x, fmaxf(v[1].x, v[2].x));
    float top = fminf(v[0].y, fminf(v[1].y, v[2].y)), bottom = fmaxf(v[0].y, fmaxf(v[1].y, v[2].y));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int x = p % SIZE, y = p / SIZE;
        bool near = (float)x + 1 > left && (float)x < right && (float)y + 1 > top && (float)y < bottom;
        double area = area_within(side, 3, x, y);
        expect_drawn(near && area_touches(side, 3, x, y), p, what);
        expect_area(area, p, area_cuts(side, 3, x, y) <= 1 ? SMOOTH_STRAIGHT : corner, what);
        if (area == 1) {
            TEST_ASSERT_EQUAL_UINT(255, channel(image[p], 3));
        }
    }
}

/* --- One edge ------------------------------------------------------------------------------------------- */

/* The first engine takes a thousand angles and more, the others some. */
static void check_one_edge(void)
{
    unsigned count = first_engine ? test_share_of(1500, 50) : 20;
    first_engine = false;
    for (unsigned i = 0; i < count; i++) {
        struct shape_vertex v[3];
        double angle = i % 16 ? random_between(0, 6.2831853) : i / 16 * 0.78539816;
        smooth_far_triangle(v, angle, random_between(-25, 25), i & 1);
        struct area_side side = smooth_side(v, 0);
        smooth_begin(1);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        read_shapes();
        for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
            double area = area_within(&side, 1, p % SIZE, p / SIZE);
            expect_drawn(area_touches(&side, 1, p % SIZE, p / SIZE), p, "one edge");
            expect_area(area, p, SMOOTH_STRAIGHT, "one edge");
        }
    }
}

static void test_one_edge_covers_its_area_within_1_of_255(void)
{
    on_every_engine(check_one_edge);
}

/* In binary32 the error is that of the distance, which is far below the step of a byte. */
static void check_numbers(void)
{
    static float numbers[SIZE * SIZE][4];
    const struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {TRIPTYCH_SURFACE_A32B32G32R32F}};
    OK(triptych_set_target_description(device, &description));
    for (unsigned i = 0; i < 6; i++) {
        struct shape_vertex v[3];
        const float black[4] = {0};
        smooth_far_triangle(v, random_between(0, 6.2831853), random_between(-25, 25), i & 1);
        struct area_side side = smooth_side(v, 0);
        set_number(TRIPTYCH_STATE_EDGEANTIALIAS, 1);
        set(TRIPTYCH_STATE_COVERAGETARGET, i & 1 ? "color" : "alpha");
        OK(triptych_clear(device, black, 1));
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        OK(triptych_read_target_numbers(device, 0, numbers[0], sizeof numbers));
        for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
            double area = area_within(&side, 1, p % SIZE, p / SIZE);
            float color = area > 1e-6 ? 1 : 0;
            TEST_ASSERT_FLOAT_WITHIN(2e-4f, (float)area, numbers[p][3]);
            if (area == 1) {
                TEST_ASSERT_TRUE(numbers[p][3] == 1);
            }
            if (area < 1e-9 || area > 1e-6) {
                TEST_ASSERT_FLOAT_WITHIN(2e-4f, i & 1 ? (float)area : color, numbers[p][0]);
            }
        }
    }
}

static void test_numbers_are_multiplied_by_the_area(void)
{
    on_every_engine(check_numbers);
}

/* --- Triangles ------------------------------------------------------------------------------------------ */

static void random_triangle(struct shape_vertex v[3], double size)
{
    double x = random_between(8, SIZE - 8), y = random_between(8, SIZE - 8);
    do
        for (int i = 0; i < 3; i++)
            v[i] = smooth_vertex(x + random_between(-size, size), y + random_between(-size, size));
    while (fabs(smooth_twice_area(v)) < 0.01);
}

static void check_triangles(void)
{
    unsigned count = first_engine ? test_share_of(400, 25) : 12;
    double sum = 0, cut = 0;
    for (unsigned i = 0; i < count; i++) {
        struct shape_vertex v[3];
        random_triangle(v, i % 4 ? (i % 4) * 10 : 1.5);
        struct area_side side[3] = {smooth_side(v, 0), smooth_side(v, 1), smooth_side(v, 2)};
        smooth_begin(7);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        read_shapes();
        expect_triangle(v, SMOOTH_CORNER, "a triangle");
        for (int p = 0; p < SIZE * SIZE; p += pixel_stride())
            if (area_cuts(side, 3, p % SIZE, p / SIZE) > 1) {
                sum += fabs(area_within(side, 3, p % SIZE, p / SIZE) - smooth_coverage(p));
                cut++;
            }
    }
    if (first_engine) {
        TEST_ASSERT_TRUE_MESSAGE(sum < cut * 0.02, "the mean error where several edges cut a square");
    }
    first_engine = false;
}

static void test_triangles_cover_their_area_but_for_corners(void)
{
    on_every_engine(check_triangles);
}

/* Two long edges at a very small angle, and an end beside the canvas: the part between them is exact. */
static void check_thin_triangles(void)
{
    unsigned count = first_engine ? test_share_of(200, 20) : 8;
    first_engine = false;
    for (unsigned i = 0; i < count; i++) {
        struct shape_vertex v[3];
        double angle = random_between(0, 6.2831853), c = cos(angle), s = sin(angle);
        double width = random_between(0.1, 2), x = random_between(24, 40), y = random_between(24, 40);
        v[0] = smooth_vertex(x - 100 * c - s * width, y - 100 * s + c * width);
        v[1] = smooth_vertex(x - 100 * c + s * width, y - 100 * s - c * width);
        v[2] = smooth_vertex(x + 2000 * c, y + 2000 * s);
        smooth_begin(7);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        read_shapes();
        expect_triangle(v, 1.5 / 255, "a thin triangle");
    }
}

static void test_thin_triangles_cover_the_area_between_their_edges(void)
{
    on_every_engine(check_thin_triangles);
}

/* --- Quads ---------------------------------------------------------------------------------------------- */

/* A parallelogram, in the order of its corners. */
static void random_quad(struct shape_vertex v[4])
{
    double angle = random_between(0, 6.2831853), turn = random_between(0.5, 2.6);
    double a = random_between(4, 22), b = random_between(4, 22), x = random_between(24, 40),
           y = random_between(24, 40);
    double ux = a * cos(angle), uy = a * sin(angle), vx = b * cos(angle + turn), vy = b * sin(angle + turn);
    v[0] = smooth_vertex(x - ux - vx, y - uy - vy);
    v[1] = smooth_vertex(x + ux - vx, y + uy - vy);
    v[2] = smooth_vertex(x + ux + vx, y + uy + vy);
    v[3] = smooth_vertex(x - ux + vx, y - uy + vy);
}

/* Red counts the fragments of each pixel, alpha adds up coverage. A pixel on the edge that the triangles
 * share belongs to one of them, and only its edges cut it. */
static void expect_quad(const struct shape_vertex v[4], unsigned edges)
{
    struct area_side side[4], all[4], shared = smooth_line_side(&v[0], &v[2], 0);
    int count = 0, turned = smooth_twice_area(v) < 0;
    for (int i = 0; i < 4; i++) {
        all[i] = smooth_line_side(&v[i], &v[(i + 1) % 4], turned);
        if (edges >> i & 1)
            side[count++] = all[i];
    }
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int x = p % SIZE, y = p / SIZE, cuts = area_cuts(side, count, x, y);
        double area = area_within(side, count, x, y);
        unsigned fragments = channel(image[p], 0);
        TEST_ASSERT_LESS_OR_EQUAL_UINT_MESSAGE(1, fragments, "fragments of a pixel");
        if (area_within(all, 4, x, y) == 1)
            expect_pixel(x, y, 0xff000001, "a pixel of the quad");
        if (cuts == 1 && (fragments || edges == 15) && !area_cuts(&shared, 1, x, y))
            expect_area(area, p, SMOOTH_STRAIGHT, "an edge of the quad");
    }
}

static void check_quads(void)
{
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "one");
    set(TRIPTYCH_STATE_DESTBLEND, "one");
    for (unsigned i = 0; i < test_share_of(30, 6); i++) {
        struct shape_vertex v[4], two[6];
        unsigned edges = i % 3 ? 15 : random_word() % 16;
        random_quad(v);
        for (int k = 0; k < 4; k++)
            v[k].color = 0xff010000;
        for (int k = 0; k < 3; k++) {
            two[k] = v[k];
            two[3 + k] = v[k ? k + 1 : 0];
        }
        smooth_begin(edges & 3);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, two, 3);
        set_number(TRIPTYCH_STATE_EDGEANTIALIAS, edges >> 1 & 6);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, two + 3, 3);
        read_shapes();
        expect_quad(v, edges);
    }
}

static void test_two_triangles_of_a_quad_have_no_seam(void)
{
    on_every_engine(check_quads);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_one_edge_covers_its_area_within_1_of_255);
    RUN_TEST(test_numbers_are_multiplied_by_the_area);
    RUN_TEST(test_triangles_cover_their_area_but_for_corners);
    RUN_TEST(test_thin_triangles_cover_the_area_between_their_edges);
    RUN_TEST(test_two_triangles_of_a_quad_have_no_seam);
    return UNITY_END();
}
