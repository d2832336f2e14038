/* The convention of the window's origin, on every engine. With row 0 at the bottom, clip space's y increases
 * with rows: pictures are upside down in memory, and everything that counts rows agrees with that. */
#include "tests/support/picture/drawn.h"
#include "tests/support/picture/shape.h"

#include <stdbool.h>
#include <string.h>

void setUp(void)
{
    drawn_begin();
}

void tearDown(void)
{
    close_canvas();
}

static void use_origin(enum triptych_window_origin origin)
{
    OK(triptych_set_convention(device, TRIPTYCH_WINDOW_ORIGIN, origin));
}

static void draw_rectangle(float x0, float y0, float x1, float y1)
{
    const struct shape_vertex v[4] = {{x0, y0, 0.5f, ~0u, 0, 0},
                                      {x1, y0, 0.5f, ~0u, 0, 0},
                                      {x0, y1, 0.5f, ~0u, 0, 0},
                                      {x1, y1, 0.5f, ~0u, 0, 0}};
    clear_shapes();
    draw_shape(TRIPTYCH_TRIANGLE_STRIP, v, 4);
    read_shapes();
}

static void expect_rectangle(int x0, int y0, int x1, int y1, const char *what)
{
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            expect_pixel(x, y, x >= x0 && x < x1 && y >= y0 && y < y1 ? ~0u : 0, what);
}

/* draw_shape takes y from the top of clip space. A rectangle from 1 to 5 is in the rows from 59 to 63. One
 * from 0.5 to 2.5 has its sides at 61.5 and 63.5, on the centres of rows 61 and 63: the fill rule keeps the
 * first and drops the last. The guard band is far from all of this, so a large rectangle tests its two ends.
 */
static void check_rows(void)
{
    use_origin(TRIPTYCH_WINDOW_ORIGIN_LOWER);
    draw_rectangle(2, 1, 7, 5);
    expect_rectangle(2, 59, 7, 63, "from 1 to 5");
    draw_rectangle(2, 0.5f, 7, 2.5f);
    expect_rectangle(2, 61, 7, 63, "sides on centres");
    draw_rectangle(2, -20000, 7, 5);
    expect_rectangle(2, 59, 7, 64, "beyond the upper end of the guard band");
    draw_rectangle(2, 5, 7, 20000);
    expect_rectangle(2, 0, 7, 59, "beyond the lower end of the guard band");
    use_origin(TRIPTYCH_WINDOW_ORIGIN_UPPER);
    draw_rectangle(2, 1, 7, 5);
    expect_rectangle(2, 1, 7, 5, "the default");
}

static void test_the_lower_origin_turns_rows_over(void)
{
    on_every_engine(check_rows);
}

/* Viewports, scissors and clears count rows of memory with both origins. */
static void check_rectangles(void)
{
    use_origin(TRIPTYCH_WINDOW_ORIGIN_LOWER);
    clear_shapes();
    OK(triptych_set_viewport(device, &(struct triptych_viewport){8, 16, 24, 32, 0, 1}));
    draw_square(0, ~0u, NULL, 0, 0, 1, 1);
    read_shapes();
    expect_rectangle(8, 16, 32, 48, "a viewport");
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, SIZE, SIZE, 0, 1}));
    clear_shapes();
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
    OK(triptych_set_scissor(device, 3, 5, 7, 11));
    draw_square(0, ~0u, NULL, 0, 0, 1, 1);
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "false");
    read_shapes();
    expect_rectangle(3, 5, 10, 16, "a scissor rectangle");
}

static void test_rectangles_count_rows(void)
{
    on_every_engine(check_rectangles);
}

/* In clip space, with y up, the triangle is counter-clockwise. */
static bool drawn_with(const char *cull, enum triptych_window_origin origin)
{
    const struct shape_vertex v[3] = {
        {8, 56, 0.5f, ~0u, 0, 0}, {56, 56, 0.5f, ~0u, 0, 0}, {32, 8, 0.5f, ~0u, 0, 0}};
    set(TRIPTYCH_STATE_CULLMODE, cull);
    use_origin(origin);
    clear_shapes();
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    return image[32 * SIZE + 32] != 0;
}

static void check_winding(void)
{
    TEST_ASSERT_TRUE(drawn_with("cw", TRIPTYCH_WINDOW_ORIGIN_UPPER));
    TEST_ASSERT_FALSE(drawn_with("ccw", TRIPTYCH_WINDOW_ORIGIN_UPPER));
    TEST_ASSERT_FALSE(drawn_with("cw", TRIPTYCH_WINDOW_ORIGIN_LOWER));
    TEST_ASSERT_TRUE(drawn_with("ccw", TRIPTYCH_WINDOW_ORIGIN_LOWER));
}

static void test_windings_are_those_of_rows(void)
{
    on_every_engine(check_winding);
}

/* The texture coordinate is 0 at the bottom of clip space and SIZE at its top: it increases by one from row
 * to row, and is y + 1/2 at row y. */
static void check_positions(void)
{
    static const char vertex[] =
        "vs_3_0\ndcl_position v0\ndcl_texcoord v1\ndcl_position o0\ndcl_texcoord o1\n"
        "mov o0, v0\nmov o1, v1\n";
    static const char pixel[] = "ps_3_0\ndcl vPos.xy\ndcl_texcoord v0\n"
                                "mov oC0.xy, vPos\nmov oC0.z, v0.y\ndsy oC0.w, v0.y\n";
    const struct drawn_element height = {TRIPTYCH_USAGE_TEXCOORD, 0, {{0, SIZE}, {0, SIZE}, {0, 0}, {0, 0}}};
    use_float_target();
    use_shaders(vertex, pixel);
    use_origin(TRIPTYCH_WINDOW_ORIGIN_LOWER);
    draw_declared(TRIPTYCH_USAGE_POSITION, &height, 1);
    read_numbers(0);
    for (int y = 0; y < SIZE; y += 7)
        expect_numbers(5, y, (const float[4]){5, (float)y, (float)y + 0.5f, 1}, "increasing");
    use_origin(TRIPTYCH_WINDOW_ORIGIN_UPPER);
    draw_declared(TRIPTYCH_USAGE_POSITION, &height, 1);
    read_numbers(0);
    for (int y = 0; y < SIZE; y += 7)
        expect_numbers(5, y, (const float[4]){5, (float)y, SIZE - 0.5f - (float)y, -1}, "decreasing");
}

static void test_positions_and_derivatives_of_pixels_count_rows(void)
{
    on_every_engine(check_positions);
}

/* Vertices in the window have rows already. */
static void check_window(void)
{
    const float rectangle[4][4] = {{2, 1, 0.5f, 1}, {7, 1, 0.5f, 1}, {2, 5, 0.5f, 1}, {7, 5, 0.5f, 1}};
    struct drawn_element white = drawn_constant(TRIPTYCH_USAGE_COLOR, 0, 1, 1, 1, 1);
    memcpy(drawn_position, rectangle, sizeof drawn_position);
    use_origin(TRIPTYCH_WINDOW_ORIGIN_LOWER);
    clear_shapes();
    draw_declared(TRIPTYCH_USAGE_POSITIONT, &white, 1);
    read_shapes();
    expect_rectangle(2, 1, 7, 5, "in the window");
}

static void test_vertices_in_the_window_keep_their_rows(void)
{
    on_every_engine(check_window);
}

static void expect_processed(float row)
{
    struct triptych_processed_vertex out;
    OK(triptych_process_vertices(device, 0, 1, &out));
    TEST_ASSERT_EQUAL_FLOAT(48, out.position[0]);
    TEST_ASSERT_EQUAL_FLOAT(row, out.position[1]);
}

/* (1/2, 1/4): y is 5/8 of the viewport's height from the bottom of clip space. */
static void check_processed(void)
{
    static const float position[3] = {0.5f, 0.25f, 0.5f};
    struct triptych_element element = {TRIPTYCH_FORMAT_FLOAT3, NULL, 0, sizeof position};
    OK(triptych_buffer_create(device, position, sizeof position, &element.buffer));
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &element));
    use_origin(TRIPTYCH_WINDOW_ORIGIN_LOWER);
    expect_processed(40);
    use_origin(TRIPTYCH_WINDOW_ORIGIN_UPPER);
    expect_processed(24);
}

static void test_processed_vertices_have_rows(void)
{
    on_every_engine(check_processed);
}

/* Without their last pixels lines are OpenGL's half-open ones: the pixel of the start is drawn, that of the
 * end is not. */
static void expect_line(float x0, float y0, float x1, float y1, int left, int first, int right, int last)
{
    const struct shape_vertex v[2] = {{x0, y0, 0.5f, ~0u, 0, 0}, {x1, y1, 0.5f, ~0u, 0, 0}};
    clear_shapes();
    draw_shape(TRIPTYCH_LINE_LIST, v, 2);
    read_shapes();
    expect_rectangle(left, first, right + 1, last + 1, "a line");
}

static void check_lines(void)
{
    use_origin(TRIPTYCH_WINDOW_ORIGIN_LOWER);
    set(TRIPTYCH_STATE_LASTPIXEL, "false");
    expect_line(8.5f, 10.5f, 16.5f, 10.5f, 8, 53, 15, 53);
    expect_line(16.5f, 10.5f, 8.5f, 10.5f, 9, 53, 16, 53);
    expect_line(8.5f, 10.5f, 8.5f, 20.5f, 8, 44, 8, 53);
    expect_line(8.5f, 20.5f, 8.5f, 10.5f, 8, 43, 8, 52);
}

static void test_lines_without_last_pixels_are_half_open(void)
{
    on_every_engine(check_lines);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_lower_origin_turns_rows_over);
    RUN_TEST(test_rectangles_count_rows);
    RUN_TEST(test_windings_are_those_of_rows);
    RUN_TEST(test_positions_and_derivatives_of_pixels_count_rows);
    RUN_TEST(test_vertices_in_the_window_keep_their_rows);
    RUN_TEST(test_processed_vertices_have_rows);
    RUN_TEST(test_lines_without_last_pixels_are_half_open);
    return UNITY_END();
}
