/* Smooth lines, on every engine: the rectangles that they are, compared with the area of the polygon that
 * rectangle and square have in common; widths, wireframe, and targets with several samples. */
#include "tests/support/smooth/smooth.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* The largest error at the corners of lines that are at least 1 pixel wide and long, and of all. */
#define LINE_CORNER 0.027
#define LINE_NARROW 0.05

static bool first_engine;

void setUp(void)
{
    first_engine = true;
}

void tearDown(void)
{
    close_canvas();
}

/* The long sides of the line's rectangle, then the short ones. */
static void sides_of(const struct shape_vertex v[2], double width, struct area_side side[4])
{
    double x = (double)v[0].x, y = (double)v[0].y, dx = (double)v[1].x - x, dy = (double)v[1].y - y;
    double length = hypot(dx, dy), c = dx / length, s = dy / length;
    side[0] = (struct area_side){-s, c, s * x - c * y + width / 2};
    side[1] = (struct area_side){s, -c, c * y - s * x + width / 2};
    side[2] = (struct area_side){c, s, -c * x - s * y};
    side[3] = (struct area_side){-c, -s, c * x + s * y + length};
}

static void expect_line(const struct shape_vertex v[2], double width, double corner, const char *what)
{
    struct area_side side[4];
    sides_of(v, width, side);
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int x = p % SIZE, y = p / SIZE;
        double area = area_within(side, 4, x, y);
        bool along = !area_cuts(side, 2, x, y), across = !area_cuts(side + 2, 2, x, y);
        if (area > 1e-9)
            expect_drawn(true, p, what);
        if (!area_touches(side, 4, x, y))
            expect_drawn(false, p, what);
        expect_area(area, p, along || across ? SMOOTH_STRAIGHT : corner, what);
    }
}

static void random_line(struct shape_vertex v[2])
{
    do
        for (int i = 0; i < 2; i++)
            v[i] = smooth_vertex(random_between(-6, SIZE + 6), random_between(-6, SIZE + 6));
    while (hypot((double)(v[1].x - v[0].x), (double)(v[1].y - v[0].y)) < 2);
}

static void begin_lines(float width)
{
    smooth_begin(0);
    set(TRIPTYCH_STATE_ANTIALIASEDLINEENABLE, "true");
    set_real(TRIPTYCH_STATE_LINEWIDTH, width);
}

static void check_lines(void)
{
    static const float widths[] = {1, 1.5f, 2.75f, 7, 0.375f};
    unsigned count = first_engine ? test_share_of(400, 20) : 15;
    first_engine = false;
    for (unsigned i = 0; i < count; i++) {
        struct shape_vertex v[2];
        float width = widths[i % 5];
        random_line(v);
        if (i % 7 == 0)
            v[1].y = v[0].y;
        begin_lines(width);
        set(TRIPTYCH_STATE_LASTPIXEL, i & 1 ? "true" : "false"); /* is for other lines */
        draw_shape(TRIPTYCH_LINE_LIST, v, 2);
        read_shapes();
        if (hypot((double)(v[1].x - v[0].x), (double)(v[1].y - v[0].y)) >= 2)
            expect_line(v, (double)width, width < 1 ? LINE_NARROW : LINE_CORNER, "a line");
    }
}

static void test_lines_cover_the_area_of_their_rectangle(void)
{
    on_every_engine(check_lines);
}

static void check_no_length(void)
{
    const struct shape_vertex v[2] = {smooth_vertex(20.3, 20.6), smooth_vertex(20.3, 20.6)};
    begin_lines(4);
    draw_shape(TRIPTYCH_LINE_LIST, v, 2);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_drawn(false, p, "a line without length");
}

static void test_a_line_without_length_is_not_drawn(void)
{
    on_every_engine(check_no_length);
}

/* The state linewidth is for lines, not for the edges of triangles. The edges add up; where only one of
 * them is, it is a line of one pixel. */
static void check_wireframe(void)
{
    const struct shape_vertex v[3] = {smooth_vertex(9.2, 12.4), smooth_vertex(55.7, 21.1),
                                      smooth_vertex(24.3, 57.8)};
    begin_lines(5);
    set(TRIPTYCH_STATE_FILLMODE, "wireframe");
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int lines = 0;
        double area = 0;
        for (int i = 0; i < 3; i++) {
            const struct shape_vertex line[2] = {v[i], v[(i + 1) % 3]};
            struct area_side side[4];
            sides_of(line, 1, side);
            lines += area_touches(side, 4, p % SIZE, p / SIZE);
            area += area_within(side, 4, p % SIZE, p / SIZE);
        }
        if (lines <= 1)
            expect_area(area, p, LINE_CORNER, "wireframe");
    }
}

static void test_wireframe_has_smooth_lines_of_one_pixel(void)
{
    on_every_engine(check_wireframe);
}

static void check_samples(void)
{
    static uint32_t plain[SIZE * SIZE];
    const struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {TRIPTYCH_SURFACE_A8R8G8B8}, .samples = 2};
    const float black[4] = {0};
    const struct shape_vertex v[2] = {smooth_vertex(4.2, 9.3), smooth_vertex(57.7, 40.1)};
    OK(triptych_set_target_description(device, &description));
    for (int smooth = 0; smooth < 2; smooth++) {
        set(TRIPTYCH_STATE_ANTIALIASEDLINEENABLE, smooth ? "true" : "false");
        OK(triptych_clear(device, black, 1));
        draw_shape(TRIPTYCH_LINE_LIST, v, 2);
        OK(triptych_read_color(device, image, sizeof image));
        if (!smooth)
            memcpy(plain, image, sizeof plain);
    }
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, plain[p], "several samples");
}

static void test_targets_with_several_samples_have_no_smooth_lines(void)
{
    on_every_engine(check_samples);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lines_cover_the_area_of_their_rectangle);
    RUN_TEST(test_a_line_without_length_is_not_drawn);
    RUN_TEST(test_wireframe_has_smooth_lines_of_one_pixel);
    RUN_TEST(test_targets_with_several_samples_have_no_smooth_lines);
    return UNITY_END();
}
