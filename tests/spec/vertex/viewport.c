/* Viewports and scissor rectangles anywhere, on every engine: a square fills exactly the pixels whose centres
 * are in all of viewport, scissor rectangle and target, and each pixel has the texel of its place in the
 * viewport. */
#include "tests/support/picture/canvas.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static void set_viewport(float x, float y, float width, float height)
{
    OK(triptych_set_viewport(device, &(struct triptych_viewport){x, y, width, height, 0, 1}));
}

static bool inside(double centre, double from, double length)
{
    return centre >= from && centre < from + length;
}

static void read_color(void)
{
    OK(triptych_read_color(device, image, sizeof image));
}

/* Fails unless the square of a viewport with these edges covers its pixels, each with the texel that repeats
 * every SIZE pixels from the viewport's corner. */
static void expect_square(double x, double y, double width, double height, const char *what)
{
    set_viewport((float)x, (float)y, (float)width, (float)height);
    draw_square(0.5f, ~0u, NULL, 0, 0, (float)(width / SIZE), (float)(height / SIZE));
    read_color();
    for (int j = 0; j < SIZE; j++)
        for (int i = 0; i < SIZE; i++) {
            double u = floor(i + 0.5 - x), v = floor(j + 0.5 - y);
            int column = (int)(u - SIZE * floor(u / SIZE)), row = (int)(v - SIZE * floor(v / SIZE));
            bool covered = inside(i + 0.5, x, width) && inside(j + 0.5, y, height);
            expect_pixel(i, j, covered ? texel[row * SIZE + column] : 0xff336699, what);
        }
}

static void begin_textured(void)
{
    bind_random_texture(SIZE, SIZE);
    extent = 1;
}

static void clear_whole(void)
{
    set_viewport(0, 0, SIZE, SIZE);
    clear_to(0xff336699);
}

static void check_places(void)
{
    static const float places[][4] = {
        {0, 0, SIZE, SIZE},
        {-20, -7, 64, 64},
        {40, 50, 64, 64},
        {-64, -64, 192, 192},
        {-30, 10, 35, 1000},
        {3, -8000, 17, 9000},
        {0, 0, 8192, 8192},
        {-8192, -8192, 16384, 16384},
        {0, 0, 40000, 40000},
        {-39990, 20, 40000, 9},
        {-30000, -100, 30064, 130},
        {0, -65536, 64, 65600},
        {-64, 0, 64, 64},
        {64, 0, 64, 64},
        {0, 64, 64, 1},
        {0, -64, 64, 64},
        {500, 500, 10, 10},
        {-20000, 5, 10, 10},
    };
    begin_textured();
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        char what[80];
        const float *p = places[i];
        snprintf(what, sizeof what, "viewport %g x %g at %g, %g", (double)p[2], (double)p[3], (double)p[0],
                 (double)p[1]);
        clear_whole();
        expect_square((double)p[0], (double)p[1], (double)p[2], (double)p[3], what);
    }
}

static void test_a_square_fills_its_viewport_wherever_that_is(void)
{
    on_every_engine(check_places);
}

static void expect_rectangle(int x0, int y0, int x1, int y1, const char *what)
{
    read_color();
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            expect_pixel(x, y, x >= x0 && x < x1 && y >= y0 && y < y1 ? ~0u : 0xff336699, what);
}

/* Draws a white square in the viewport on a new background; each pixel inside is white. */
static void expect_white(const float viewport[4], int x0, int y0, int x1, int y1)
{
    char what[80];
    snprintf(what, sizeof what, "viewport %g x %g at %g, %g", (double)viewport[2], (double)viewport[3],
             (double)viewport[0], (double)viewport[1]);
    clear_whole();
    set_viewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    draw_square(0.5f, ~0u, NULL, 0, 0, 1, 1);
    expect_rectangle(x0, y0, x1, y1, what);
}

static void check_extremes(void)
{
    static const float whole[][4] = {{-0x1p30f, -0x1p30f, 0x1p31f, 0x1p31f},
                                     {-0x1p31f, -1, 0x1p32f, 66},
                                     {-0x1p20f, -0x1p20f, 0x1p21f, 0x1p21f}};
    static const float none[][4] = {
        {0x1p31f, 0, 0x1p31f, 64},
        {0, -0x1p31f, 64, 0x1p30f},
        {FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX},
        {-FLT_MAX, 0, 0, 64},
        {0, 0, 0, 0},
        {10, 10, 0, 20},
        {10, 10, 20, 0},
        {-5, -5, 5, 5},
        {0x1p31f, 0x1p31f, 0, 0},
        {64, 64, FLT_MAX, FLT_MAX},
        {10.6f, 10.6f, 0.5f, 0.5f},
    };
    extent = 1;
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        expect_white(whole[i], 0, 0, SIZE, SIZE);
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
        expect_white(none[i], 0, 0, 0, 0);
    expect_white((const float[4]){10.5f, 10.5f, 0.25f, 0.5f}, 10, 10, 11, 11);
}

static void test_huge_and_empty_viewports(void)
{
    on_every_engine(check_extremes);
}

/* Vertices far outside of the viewport: the guard band cuts on all sides. */
static void check_beyond(void)
{
    static const float places[][4] = {
        {0, 0, SIZE, SIZE}, {-6000, -6000, 8000, 8000}, {0, 0, 40000, 40000}, {-20000, -20000, 20010, 20020}};
    extent = 1000;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const float *p = places[i];
        expect_white(p, 0, 0, (int)fminf(p[0] + p[2], SIZE), (int)fminf(p[1] + p[3], SIZE));
    }
    extent = 1;
}

static void test_the_guard_band_cuts_around_every_viewport(void)
{
    on_every_engine(check_beyond);
}

static void check_clears(void)
{
    clear_whole();
    set_viewport(-10, 20, 30, 1000);
    clear_to(~0u);
    expect_rectangle(0, 20, 20, SIZE, "clear of a viewport that is partly outside");
    clear_whole();
    set_viewport(-1e9f, 20, 1e9f, 10);
    clear_to(~0u);
    set_viewport(3, 3, 0, 10);
    clear_to(~0u);
    expect_rectangle(0, 0, 0, 0, "clears of viewports without pixels");
}

static void test_clears_have_the_part_of_the_viewport_in_the_target(void)
{
    on_every_engine(check_clears);
}

static void check_scissors(void)
{
    static const struct {
        unsigned rectangle[4];
        int pixels[4];
    } cases[] = {{{10, 20, 4000, 5}, {10, 20, 64, 25}},
                 {{0, 0, UINT32_MAX, UINT32_MAX}, {0, 0, 64, 64}},
                 {{60, 60, UINT32_MAX, UINT32_MAX}, {60, 60, 64, 64}},
                 {{UINT32_MAX, 0, 2, 64}, {0, 0, 0, 0}},
                 {{64, 0, 10, 64}, {0, 0, 0, 0}},
                 {{0, 1000, 64, 10}, {0, 0, 0, 0}},
                 {{5, 5, 0, 9}, {0, 0, 0, 0}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const unsigned *r = cases[i].rectangle;
        const int *p = cases[i].pixels;
        set(TRIPTYCH_STATE_SCISSORTESTENABLE, "false");
        clear_whole();
        set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
        OK(triptych_set_scissor(device, r[0], r[1], r[2], r[3]));
        draw_square(0.5f, ~0u, NULL, 0, 0, 1, 1);
        expect_rectangle(p[0], p[1], p[2], p[3], "draw in a scissor rectangle");
        set(TRIPTYCH_STATE_SCISSORTESTENABLE, "false");
        clear_whole();
        set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
        clear_to(~0u);
        expect_rectangle(p[0], p[1], p[2], p[3], "clear in a scissor rectangle");
    }
}

static void test_scissor_rectangles_may_lie_outside_of_the_target(void)
{
    on_every_engine(check_scissors);
}

/* Depth is near + z * (far - near), whichever of the two is larger. */
static void check_depths(void)
{
    static const float ranges[][2] = {{0, 1},       {0.25f, 0.75f}, {1, 0}, {0.75f, 0.5f},
                                      {0.5f, 0.5f}, {0, 0},         {1, 1}};
    static float depth[SIZE * SIZE];
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "always");
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        const float *r = ranges[i];
        OK(triptych_set_viewport(device, &(struct triptych_viewport){-8, -8, 100, 100, r[0], r[1]}));
        draw_square(0.25f, ~0u, NULL, 0, 0, 1, 1);
        OK(triptych_read_depth(device, depth, sizeof depth));
        for (int p = 0; p < SIZE * SIZE; p++)
            TEST_ASSERT_EQUAL_FLOAT(r[0] + 0.25f * (r[1] - r[0]), depth[p]);
    }
}

static void test_depth_ranges_may_be_reversed_or_empty(void)
{
    on_every_engine(check_depths);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_square_fills_its_viewport_wherever_that_is);
    RUN_TEST(test_huge_and_empty_viewports);
    RUN_TEST(test_the_guard_band_cuts_around_every_viewport);
    RUN_TEST(test_clears_have_the_part_of_the_viewport_in_the_target);
    RUN_TEST(test_scissor_rectangles_may_lie_outside_of_the_target);
    RUN_TEST(test_depth_ranges_may_be_reversed_or_empty);
    return UNITY_END();
}
