/* Lines, on every engine: the pixels of the definition (tests/support/picture/diamond.h), and colour and
 * depth along the line, computed in double precision. */
#include "tests/support/picture/diamond.h"
#include "tests/support/picture/shape.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <stdio.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static struct diamond_line window_line(const struct shape_vertex v[2], int last)
{
    return (struct diamond_line){(int32_t)(v[0].x * 256), (int32_t)(v[0].y * 256), (int32_t)(v[1].x * 256),
                                 (int32_t)(v[1].y * 256), last};
}

static float random_position(void)
{
    int step = random_word() & 1 ? 64 : 1;
    return (float)((int)random_between(-8 * 256, (SIZE + 8) * 256) / step * step) / 256;
}

static struct shape_vertex random_vertex(void)
{
    struct shape_vertex v = {
        random_position(), random_position(), (float)random_between(0, 1), random_word() | 0xff000000, 0, 0};
    return v;
}

/* Returns the position of a pixel's centre along the line: 0 at the start, 1 at the end, or slightly outside
 * of this range. */
static double progress(const struct shape_vertex v[2], int x, int y)
{
    double dx = (double)v[1].x - (double)v[0].x, dy = (double)v[1].y - (double)v[0].y;
    return ((x + 0.5 - (double)v[0].x) * dx + (y + 0.5 - (double)v[0].y) * dy) / (dx * dx + dy * dy);
}

static void expect_near(double expected, double got, double tolerance, const char *what, int x, int y)
{
    char text[120];
    snprintf(text, sizeof text, "%s at (%d, %d): expected %g, got %g", what, x, y, expected, got);
    TEST_ASSERT_TRUE_MESSAGE(fabs(expected - got) <= tolerance, text);
}

static void expect_along(const struct shape_vertex v[2], int x, int y, int flat)
{
    uint32_t got = image[y * SIZE + x], from = image_word(v[0].color), to = image_word(v[1].color);
    double t = progress(v, x, y);
    for (int c = 0; c < 4; c++) {
        double value = channel(from, c) + (flat ? 0 : t * ((double)channel(to, c) - channel(from, c)));
        value = value < 0 ? 0 : value > 255 ? 255 : value;
        expect_near(value, channel(got, c), flat ? 0 : 0.51, "colour", x, y);
    }
    double depth = (double)v[0].z + t * ((double)v[1].z - (double)v[0].z);
    depth = depth < 0 ? 0 : depth > 1 ? 1 : depth;
    expect_near(depth, (double)shape_depth[y * SIZE + x], 1e-5, "depth", x, y);
}

static void expect_line(const struct shape_vertex v[2], int last, int flat)
{
    struct diamond_line line = window_line(v, last);
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int x = p % SIZE, y = p / SIZE;
        if (diamond_covers(&line, x, y))
            expect_along(v, x, y, flat);
        else
            expect_pixel(x, y, 0, "beside the line");
    }
}

static void check_lines(void)
{
    set(TRIPTYCH_STATE_ZENABLE, "true");
    for (unsigned i = 0; i < test_share_of(60, 5); i++) {
        struct shape_vertex v[2] = {random_vertex(), random_vertex()};
        if (hypot((double)(v[1].x - v[0].x), (double)(v[1].y - v[0].y)) < 2)
            continue;
        set(TRIPTYCH_STATE_LASTPIXEL, i & 1 ? "true" : "false");
        set(TRIPTYCH_STATE_SHADEMODE, i & 2 ? "flat" : i & 4 ? "phong" : "gouraud");
        set(TRIPTYCH_STATE_ZFUNC, "always");
        clear_shapes();
        draw_shape(TRIPTYCH_LINE_LIST, v, 2);
        read_shapes();
        expect_line(v, i & 1, i & 2);
    }
}

static void test_lines_are_as_defined(void)
{
    on_every_engine(check_lines);
}

static void expect_wide(const struct shape_vertex v[2], int last, int width)
{
    struct diamond_line line = window_line(v, last);
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int x = p % SIZE, y = p / SIZE;
        if (diamond_covers_wide(&line, width, x, y))
            expect_along(v, x, y, 0);
        else
            expect_pixel(x, y, 0, "beside the line");
    }
}

static void check_wide_lines(void)
{
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "always");
    for (unsigned i = 0; i < test_share_of(24, 5); i++) {
        static const float widths[] = {1.4f, 2, 2.6f, 7, 20};
        struct shape_vertex v[2] = {random_vertex(), random_vertex()};
        if (hypot((double)(v[1].x - v[0].x), (double)(v[1].y - v[0].y)) < 2)
            continue;
        set_real(TRIPTYCH_STATE_LINEWIDTH, widths[i % 5]);
        set(TRIPTYCH_STATE_LASTPIXEL, i & 1 ? "true" : "false");
        clear_shapes();
        draw_shape(TRIPTYCH_LINE_LIST, v, 2);
        read_shapes();
        expect_wide(v, i & 1, (int)(widths[i % 5] + 0.5f));
    }
}

static void test_wide_lines_repeat_their_pixels_across(void)
{
    on_every_engine(check_wide_lines);
}

/* Each line adds 1, so the test reads how often each pixel was drawn. Only the last line of a strip draws its
 * last pixel. */
static void check_strips_and_lists(void)
{
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "one");
    set(TRIPTYCH_STATE_DESTBLEND, "one");
    for (unsigned i = 0; i < test_share_of(24, 5); i++) {
        struct shape_vertex v[12];
        enum triptych_primitive primitive = i & 2 ? TRIPTYCH_LINE_STRIP : TRIPTYCH_LINE_LIST;
        int step = primitive == TRIPTYCH_LINE_STRIP ? 1 : 2;
        for (int k = 0; k < 12; k++) {
            v[k] = random_vertex();
            v[k].color = 0x01010101;
        }
        set(TRIPTYCH_STATE_LASTPIXEL, i & 1 ? "true" : "false");
        clear_shapes();
        draw_shape(primitive, v, 12);
        read_shapes();
        for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
            uint32_t count = 0;
            for (int k = 0; k + 1 < 12; k += step) {
                struct diamond_line line = window_line(v + k, (i & 1) && (step == 2 || k == 10));
                count += (uint32_t)diamond_covers(&line, p % SIZE, p / SIZE);
            }
            expect_pixel(p % SIZE, p / SIZE, count * 0x01010101, "lines that add 1");
        }
    }
}

static void test_every_line_is_drawn_and_strips_have_one_last_pixel(void)
{
    on_every_engine(check_strips_and_lists);
}

static void expect_row(int y, int first, int last, const char *what)
{
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE,
                     p / SIZE == y && p % SIZE >= first && p % SIZE <= last ? 0xffffffff : 0, what);
}

/* A clipped end is not the end of the line: the line continues after it, and its last pixel is drawn. */
static void check_clipping(void)
{
    struct shape_vertex v[2] = {{8.5f, 10.5f, -0.25f, ~0u, 0, 0}, {40.5f, 10.5f, 0.75f, ~0u, 0, 0}};
    struct shape_vertex back[2] = {v[1], v[0]};
    set(TRIPTYCH_STATE_LASTPIXEL, "false");
    clear_shapes();
    draw_shape(TRIPTYCH_LINE_LIST, v, 2);
    read_shapes();
    expect_row(10, 16, 39, "a line that enters at the near plane");
    clear_shapes();
    draw_shape(TRIPTYCH_LINE_LIST, back, 2);
    read_shapes();
    expect_row(10, 16, 40, "a line that leaves at the near plane");
    v[0].z = v[1].z = -0.5f;
    clear_shapes();
    draw_shape(TRIPTYCH_LINE_LIST, v, 2);
    read_shapes();
    expect_row(10, 1, 0, "a line in front of the near plane");
    v[0] = (struct shape_vertex){-3e6f, 10.5f, 0.5f, ~0u, 0, 0};
    v[1] = (struct shape_vertex){3e6f, 10.5f, 0.5f, ~0u, 0, 0};
    clear_shapes();
    draw_shape(TRIPTYCH_LINE_LIST, v, 2);
    read_shapes();
    expect_row(10, 0, SIZE - 1, "a line across the guard band");
}

static void test_lines_are_clipped(void)
{
    on_every_engine(check_clipping);
}

/* Culling, fill modes and depth bias do not affect lines. */
static void check_triangles_states(void)
{
    struct shape_vertex v[2] = {{8.5f, 10.5f, 0.25f, ~0u, 0, 0}, {40.5f, 10.5f, 0.25f, ~0u, 0, 0}};
    static const char *const cull[] = {"cw", "ccw"}, *const fill[] = {"point", "wireframe"};
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set_real(TRIPTYCH_STATE_DEPTHBIAS, 0.5f);
    set_real(TRIPTYCH_STATE_SLOPESCALEDEPTHBIAS, 2);
    for (int i = 0; i < 4; i++) {
        set(TRIPTYCH_STATE_CULLMODE, cull[i & 1]);
        set(TRIPTYCH_STATE_FILLMODE, fill[i >> 1]);
        clear_shapes();
        draw_shape(TRIPTYCH_LINE_STRIP, v, 2);
        read_shapes();
        expect_row(10, 8, 40, "a line with a triangle's states");
        TEST_ASSERT_EQUAL_FLOAT(0.25f, shape_depth[10 * SIZE + 20]);
    }
}

static void test_triangles_states_change_no_line(void)
{
    on_every_engine(check_triangles_states);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lines_are_as_defined);
    RUN_TEST(test_wide_lines_repeat_their_pixels_across);
    RUN_TEST(test_every_line_is_drawn_and_strips_have_one_last_pixel);
    RUN_TEST(test_lines_are_clipped);
    RUN_TEST(test_triangles_states_change_no_line);
    return UNITY_END();
}
