/* Fill modes, on every engine. A triangle in wireframe is drawn as its three edges (lines with the pixels of
 * tests/support/picture/diamond.h). In point mode it is drawn as its three corners. Both have the triangle's
 * culling, colours and depth bias. */
#include "tests/support/picture/diamond.h"
#include "tests/support/picture/shape.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static struct diamond_line edge(const struct shape_vertex *a, const struct shape_vertex *b, int last)
{
    return (struct diamond_line){(int32_t)(a->x * 256), (int32_t)(a->y * 256), (int32_t)(b->x * 256),
                                 (int32_t)(b->y * 256), last};
}

static struct shape_vertex random_vertex(uint32_t color)
{
    struct shape_vertex v = {(float)(int)random_between(0, SIZE * 256) / 256,
                             (float)(int)random_between(0, SIZE * 256) / 256,
                             (float)random_between(0, 1),
                             color,
                             0,
                             0};
    return v;
}

/* Clockwise on the screen, y down: positive. */
static double area(const struct shape_vertex v[3])
{
    return (double)(v[1].x - v[0].x) * (double)(v[2].y - v[0].y) -
           (double)(v[2].x - v[0].x) * (double)(v[1].y - v[0].y);
}

static int on_outline(const struct shape_vertex v[3], int last, int x, int y)
{
    for (int i = 0; i < 3; i++) {
        struct diamond_line line = edge(&v[i], &v[(i + 1) % 3], last);
        if (diamond_covers(&line, x, y))
            return 1;
    }
    return 0;
}

static void check_wireframe(void)
{
    static const char *const cull[] = {"none", "cw", "ccw"};
    set(TRIPTYCH_STATE_FILLMODE, "wireframe");
    for (unsigned i = 0; i < test_share_of(60, 6); i++) {
        struct shape_vertex v[3];
        for (int k = 0; k < 3; k++)
            v[k] = random_vertex(0xff8090a0);
        set(TRIPTYCH_STATE_CULLMODE, cull[i % 3]);
        set(TRIPTYCH_STATE_LASTPIXEL, i & 1 ? "true" : "false");
        clear_shapes();
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        read_shapes();
        int visible = i % 3 == 0 || (i % 3 == 1 ? area(v) < 0 : area(v) > 0);
        for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
            int drawn = visible && on_outline(v, i & 1, p % SIZE, p / SIZE);
            expect_pixel(p % SIZE, p / SIZE, drawn ? image_word(0xff8090a0) : 0, "wireframe");
        }
    }
}

static void test_wireframe_is_the_edges_of_visible_triangles(void)
{
    on_every_engine(check_wireframe);
}

static void check_colours(void)
{
    struct shape_vertex v[3] = {{4.5f, 4.5f, 0.5f, 0xffff0000, 0, 0},
                                {54.5f, 4.5f, 0.5f, 0xff0000ff, 0, 0},
                                {4.5f, 54.5f, 0.5f, 0xff00ff00, 0, 0}};
    set(TRIPTYCH_STATE_FILLMODE, "wireframe");
    clear_shapes();
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    for (int i = 1; i < 50; i++) {
        TEST_ASSERT_UINT8_WITHIN(1, 255 - 255 * i / 50, channel(image[4 * SIZE + 4 + i], 0));
        TEST_ASSERT_UINT8_WITHIN(1, 255 * i / 50, channel(image[4 * SIZE + 4 + i], 2));
        TEST_ASSERT_UINT8_WITHIN(1, 255 * i / 50, channel(image[(4 + i) * SIZE + 4], 1));
        TEST_ASSERT_UINT8_WITHIN(1, 255 * i / 50, channel(image[(4 + i) * SIZE + 54 - i], 1));
        TEST_ASSERT_UINT8_WITHIN(1, 255 - 255 * i / 50, channel(image[(4 + i) * SIZE + 54 - i], 2));
    }
    set(TRIPTYCH_STATE_SHADEMODE, "flat");
    clear_shapes();
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, on_outline(v, 1, p % SIZE, p / SIZE) ? image_word(0xffff0000) : 0,
                     "flat wireframe");
}

static void test_edges_have_the_triangles_colours(void)
{
    on_every_engine(check_colours);
}

static void expect_corners(const struct shape_vertex v[3], const uint32_t color[3], double half,
                           const char *what)
{
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        uint32_t expected = 0;
        for (int i = 0; i < 3; i++) {
            double dx = p % SIZE + 0.5 - (double)v[i].x, dy = p / SIZE + 0.5 - (double)v[i].y;
            if (dx >= -half && dx < half && dy >= -half && dy < half)
                expected = image_word(color[i]);
        }
        expect_pixel(p % SIZE, p / SIZE, expected, what);
    }
}

static void check_points(void)
{
    static const uint32_t none[3];
    set(TRIPTYCH_STATE_FILLMODE, "point");
    set_real(TRIPTYCH_STATE_POINTSIZE, 3);
    for (unsigned i = 0; i < test_share_of(30, 5); i++) {
        struct shape_vertex v[3];
        uint32_t color[3];
        for (int k = 0; k < 3; k++) {
            v[k] = random_vertex(random_word() | 0xff000000);
            color[k] = i & 1 ? v[0].color : v[k].color;
        }
        set(TRIPTYCH_STATE_SHADEMODE, i & 1 ? "flat" : "gouraud");
        set(TRIPTYCH_STATE_CULLMODE, i & 2 ? "ccw" : "none");
        clear_shapes();
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        read_shapes();
        expect_corners(v, (i & 2) && area(v) < 0 ? none : color, 1.5, "corners as points");
    }
}

static void test_points_are_the_corners_of_visible_triangles(void)
{
    on_every_engine(check_points);
}

/* Edges that clipping adds at the near plane are not drawn. Corners in front of the plane are not drawn
 * either. */
static void check_clipping(void)
{
    struct shape_vertex v[3] = {
        {8.5f, 8.5f, 0.5f, ~0u, 0, 0}, {56.5f, 8.5f, 0.5f, ~0u, 0, 0}, {8.5f, 56.5f, -0.5f, ~0u, 0, 0}};
    struct shape_vertex half[2] = {{32.5f, 32.5f, 0, 0, 0, 0}, {8.5f, 32.5f, 0, 0, 0, 0}};
    struct diamond_line left[3] = {edge(&v[0], &v[1], 1), edge(&v[1], &half[0], 1), edge(&half[1], &v[0], 1)};
    uint32_t corners[3] = {~0u, ~0u, 0};
    set(TRIPTYCH_STATE_FILLMODE, "wireframe");
    clear_shapes();
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++) {
        int drawn = 0;
        for (int i = 0; i < 3; i++)
            drawn |= diamond_covers(&left[i], p % SIZE, p / SIZE);
        expect_pixel(p % SIZE, p / SIZE, drawn ? ~0u : 0, "a clipped wireframe");
    }
    set(TRIPTYCH_STATE_FILLMODE, "point");
    clear_shapes();
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    expect_corners(v, corners, 0.5, "a clipped triangle's corners");
}

static void test_edges_that_clipping_adds_are_not_drawn(void)
{
    on_every_engine(check_clipping);
}

/* Edges and corners have the depth bias of the whole triangle's slope, here 1/32 per pixel. */
static void check_depth_bias(void)
{
    static const char *const mode[] = {"solid", "wireframe", "point"};
    struct shape_vertex v[3] = {
        {8.5f, 8.5f, 0, ~0u, 0, 0}, {40.5f, 8.5f, 1, ~0u, 0, 0}, {8.5f, 40.5f, 0, ~0u, 0, 0}};
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set_real(TRIPTYCH_STATE_DEPTHBIAS, 0.125f);
    set_real(TRIPTYCH_STATE_SLOPESCALEDEPTHBIAS, 2);
    for (int i = 0; i < 3; i++) {
        set(TRIPTYCH_STATE_FILLMODE, mode[i]);
        clear_shapes();
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        read_shapes();
        TEST_ASSERT_EQUAL_FLOAT(0.125f + 2.0f / 32, shape_depth[8 * SIZE + 8]);
        if (i < 2)
            TEST_ASSERT_EQUAL_FLOAT(0.125f + 2.0f / 32 + 0.25f, shape_depth[8 * SIZE + 16]);
    }
}

static void test_edges_and_corners_have_the_triangles_depth_bias(void)
{
    on_every_engine(check_depth_bias);
}

/* There are more edges than fit in one group for setup. */
static void check_many(void)
{
    static struct shape_vertex v[63];
    static uint32_t count[SIZE * SIZE];
    memset(count, 0, sizeof count);
    set(TRIPTYCH_STATE_FILLMODE, "wireframe");
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "one");
    set(TRIPTYCH_STATE_DESTBLEND, "one");
    set(TRIPTYCH_STATE_LASTPIXEL, "false");
    clear_shapes();
    for (unsigned round = 0; round < test_share(8); round++) {
        for (int i = 0; i < 63; i++)
            v[i] = random_vertex(0x01010101);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 63);
        for (int i = 0; i < 63; i += 3)
            for (int p = 0; p < SIZE * SIZE; p += pixel_stride())
                for (int k = 0; k < 3; k++) {
                    struct diamond_line line = edge(&v[i + k], &v[i + (k + 1) % 3], 0);
                    count[p] += area(v + i) != 0 && diamond_covers(&line, p % SIZE, p / SIZE);
                }
    }
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride())
        expect_pixel(p % SIZE, p / SIZE, count[p] * 0x01010101, "outlines that add 1");
}

static void test_every_edge_is_drawn_once(void)
{
    on_every_engine(check_many);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_wireframe_is_the_edges_of_visible_triangles);
    RUN_TEST(test_edges_have_the_triangles_colours);
    RUN_TEST(test_points_are_the_corners_of_visible_triangles);
    RUN_TEST(test_edges_that_clipping_adds_are_not_drawn);
    RUN_TEST(test_edges_and_corners_have_the_triangles_depth_bias);
    RUN_TEST(test_every_edge_is_drawn_once);
    return UNITY_END();
}
