/* Points and point sprites, on every engine: squares whose pixels are all computed from the definition. */
#include "tests/support/picture/shape.h"

#include <math.h>
#include <stdio.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static void draw_point(float x, float y, float z, uint32_t color, float u, float v)
{
    struct shape_vertex vertex = {x, y, z, color, u, v};
    clear_shapes();
    draw_shape(TRIPTYCH_POINT_LIST, &vertex, 1);
    read_shapes();
}

/* Returns true if a point of this size around (x, y) covers the centre of a pixel. */
static int covers(double x, double y, double size, int column, int row)
{
    double half = nearbyint(size * 128) / 256;
    return column + 0.5 >= x - half && column + 0.5 < x + half && row + 0.5 >= y - half &&
           row + 0.5 < y + half;
}

static void expect_square(double x, double y, double size, uint32_t color, const char *what)
{
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, covers(x, y, size, p % SIZE, p / SIZE) ? image_word(color) : 0,
                     what);
}

static void check_squares(void)
{
    char what[80];
    set(TRIPTYCH_STATE_ZENABLE, "true");
    for (int i = 0; i < 100; i++) {
        int step = i & 1 ? 128 : 1;
        float x = (float)((int)random_between(-10 * 256, (SIZE + 10) * 256) / step * step) / 256;
        float y = (float)((int)random_between(-10 * 256, (SIZE + 10) * 256) / step * step) / 256;
        float size = i & 2 ? (float)(int)random_between(1, 20) : (float)random_between(0, 40);
        uint32_t color = random_word();
        set_real(TRIPTYCH_STATE_POINTSIZE_MIN, 0);
        set_real(TRIPTYCH_STATE_POINTSIZE, size);
        snprintf(what, sizeof what, "a point of size %g at (%g, %g)", (double)size, (double)x, (double)y);
        draw_point(x, y, 0.25f, color, 0, 0);
        expect_square((double)x, (double)y, (double)size, color, what);
        for (int p = 0; p < SIZE * SIZE; p++)
            if (covers((double)x, (double)y, (double)size, p % SIZE, p / SIZE))
                TEST_ASSERT_EQUAL_FLOAT(0.25f, shape_depth[p]);
    }
}

static void test_points_are_squares_of_their_colour_and_depth(void)
{
    on_every_engine(check_squares);
}

static void check_size_limits(void)
{
    static const struct {
        float size, least, most, expected;
    } cases[] = {{5, 1, 64, 5}, {5, 8, 64, 8},    {5, 1, 4, 4}, {70, 1, 64, 64},
                 {0, 0, 64, 0}, {0.5f, 1, 64, 1}, {5, 8, 4, 4}, {30000, 0, 1e30f, 8192}};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        set_real(TRIPTYCH_STATE_POINTSIZE, cases[i].size);
        set_real(TRIPTYCH_STATE_POINTSIZE_MIN, cases[i].least);
        set_real(TRIPTYCH_STATE_POINTSIZE_MAX, cases[i].most);
        draw_point(20, 30, 0.5f, 0xff123456, 0, 0);
        expect_square(20, 30, (double)cases[i].expected, 0xff123456, "a limited size");
    }
    draw_point(20 - 4000, 30 + 4000, 0.5f, 0xff123456, 0, 0);
    expect_square(20 - 4000, 30 + 4000, 8192, 0xff123456, "the largest point");
}

static void test_sizes_are_limited(void)
{
    on_every_engine(check_size_limits);
}

/* A point of 8 pixels with a texture of 8 x 8 texels has one texel in each pixel. A point of 16 pixels has
 * each texel in four pixels. */
static void check_sprites(void)
{
    bind_random_texture(8, 8);
    for (int size = 8; size <= 16; size += 8)
        for (int sprite = 0; sprite < 2; sprite++) {
            set_real(TRIPTYCH_STATE_POINTSIZE, (float)size);
            set(TRIPTYCH_STATE_POINTSPRITEENABLE, sprite ? "true" : "false");
            draw_point(30, 20, 0.5f, ~0u, 0.8f, 0.3f);
            for (int y = 0; y < size; y++)
                for (int x = 0; x < size; x++) {
                    int u = sprite ? 8 * x / size : 6, v = sprite ? 8 * y / size : 2;
                    expect_pixel(30 - size / 2 + x, 20 - size / 2 + y, texel[v * 8 + u],
                                 sprite ? "a sprite" : "a point with a texture");
                }
        }
}

static void test_sprites_show_the_whole_texture_and_points_one_place(void)
{
    on_every_engine(check_sprites);
}

/* The second coordinate is 0 at the upper side of the picture, or at the last row. */
static void check_sprite_origins(void)
{
    bind_random_texture(8, 8);
    set_real(TRIPTYCH_STATE_POINTSIZE, 8);
    set(TRIPTYCH_STATE_POINTSPRITEENABLE, "true");
    for (uint32_t window = TRIPTYCH_WINDOW_ORIGIN_UPPER; window <= TRIPTYCH_WINDOW_ORIGIN_LOWER; window++)
        for (uint32_t origin = TRIPTYCH_SPRITE_ORIGIN_UPPER; origin <= TRIPTYCH_SPRITE_ORIGIN_LAST;
             origin++) {
            int lower = window == TRIPTYCH_WINDOW_ORIGIN_LOWER;
            int turned = lower || origin == TRIPTYCH_SPRITE_ORIGIN_LAST;
            OK(triptych_set_convention(device, TRIPTYCH_WINDOW_ORIGIN, window));
            OK(triptych_set_convention(device, TRIPTYCH_SPRITE_ORIGIN, origin));
            draw_point(30, 20, 0.5f, ~0u, 0.8f, 0.3f);
            for (int y = 0; y < 8; y++)
                for (int x = 0; x < 8; x++)
                    expect_pixel(26 + x, (lower ? SIZE - 24 : 16) + y, texel[(turned ? 7 - y : y) * 8 + x],
                                 turned ? "from the last row" : "from the first row");
        }
}

static void test_sprites_begin_at_the_side_of_their_convention(void)
{
    on_every_engine(check_sprite_origins);
}

/* The same with a projection that sets w to z, and with fog by w. The coordinates do not change. The point is
 * at w = 2, where the fog factor is one half, and (28, 16) is projected to (30, 24). */
static void check_sprites_in_fog(void)
{
    static const float projection[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1}, {0, 0, 0, 0}};
    bind_random_texture(8, 8);
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_PROJECTION, projection));
    set(TRIPTYCH_STATE_POINTSPRITEENABLE, "true");
    set(TRIPTYCH_STATE_FOGENABLE, "true");
    set(TRIPTYCH_STATE_FOGTABLEMODE, "linear");
    set_number(TRIPTYCH_STATE_FOGCOLOR, 0xff40c020);
    set_real(TRIPTYCH_STATE_FOGEND, 4);
    set_real(TRIPTYCH_STATE_POINTSIZE, 8);
    draw_point(28, 16, 2, ~0u, 0, 0);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            for (int c = 0; c < 3; c++) {
                unsigned fog = channel(image_word(0xff40c020), c), own = channel(texel[y * 8 + x], c);
                TEST_ASSERT_UINT8_WITHIN(1, (fog + own) / 2, channel(image[(20 + y) * SIZE + 26 + x], c));
            }
}

static void test_sprites_keep_their_coordinates_in_perspective(void)
{
    on_every_engine(check_sprites_in_fog);
}

/* The depth of its centre decides if a point is drawn. If the centre is next to the viewport, the part inside
 * of the viewport is drawn. */
static void check_clipping(void)
{
    static const float outside[] = {-0.01f, 1.01f, -3, 7};
    set_real(TRIPTYCH_STATE_POINTSIZE, 8);
    for (int i = 0; i < 4; i++) {
        draw_point(20, 30, outside[i], 0xffffffff, 0, 0);
        expect_square(20, 30, 0, 0xffffffff, "a point outside of the depth range");
    }
    draw_point(-3, 66, 0, 0xffffffff, 0, 0);
    expect_square(-3, 66, 8, 0xffffffff, "a point beside the viewport");
    draw_point(-1e6f, 1e7f, 0, 0xffffffff, 0, 0);
    expect_square(0, 0, 0, 0xffffffff, "a point far away");
}

static void test_points_are_clipped_by_depth_and_cut_by_the_viewport(void)
{
    on_every_engine(check_clipping);
}

static void check_lists(void)
{
    struct shape_vertex v[40];
    set_real(TRIPTYCH_STATE_POINTSIZE, 3);
    for (int i = 0; i < 40; i++)
        v[i] = (struct shape_vertex){
            (float)(i % 8 * 8 + 4), (float)(i / 8 * 8 + 4), 0.5f, random_word() | 0xff000000, 0, 0};
    clear_shapes();
    draw_shape(TRIPTYCH_POINT_LIST, v, 40);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++) {
        uint32_t expected = 0;
        for (int i = 0; i < 40; i++)
            if (covers((double)v[i].x, (double)v[i].y, 3, p % SIZE, p / SIZE))
                expected = image_word(v[i].color);
        expect_pixel(p % SIZE, p / SIZE, expected, "a list of points");
    }
}

static void test_every_point_of_a_list_is_drawn(void)
{
    on_every_engine(check_lists);
}

/* Culling, fill modes, depth bias and flat shading do not change points. */
static void check_triangles_states(void)
{
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_CULLMODE, "ccw");
    set(TRIPTYCH_STATE_FILLMODE, "wireframe");
    set(TRIPTYCH_STATE_SHADEMODE, "flat");
    set_real(TRIPTYCH_STATE_DEPTHBIAS, 0.5f);
    set_real(TRIPTYCH_STATE_POINTSIZE, 5);
    draw_point(20, 30, 0.25f, 0xff445566, 0, 0);
    expect_square(20, 30, 5, 0xff445566, "a point with a triangle's states");
    TEST_ASSERT_EQUAL_FLOAT(0.25f, shape_depth[30 * SIZE + 20]);
}

static void test_triangles_states_change_no_point(void)
{
    on_every_engine(check_triangles_states);
}

/* --- Conventions --- */

static void expect_pixels(int x0, int y0, int x1, int y1, const char *what)
{
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++) {
        int x = p % SIZE, y = p / SIZE;
        expect_pixel(x, y, x >= x0 && x < x1 && y >= y0 && y < y1 ? ~0u : 0, what);
    }
}

/* A point where the window of the whole target has (x, y), in a viewport from 16 to 48. */
static void draw_in_viewport(enum triptych_point_clip clip, float x, float y, float z)
{
    const struct shape_vertex vertex = {x, y, z, ~0u, 0, 0};
    OK(triptych_set_convention(device, TRIPTYCH_POINT_CLIP, clip));
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, SIZE, SIZE, 0, 1}));
    clear_shapes();
    OK(triptych_set_viewport(device, &(struct triptych_viewport){16, 16, 32, 32, 0, 1}));
    draw_shape(TRIPTYCH_POINT_LIST, &vertex, 1);
}

/* Points of 16 pixels at the right side of the viewport, at x = 48, which is inside, and at 49, which is not.
 */
static void check_clips(void)
{
    set_real(TRIPTYCH_STATE_POINTSIZE, 16);
    draw_in_viewport(TRIPTYCH_POINT_CLIP_VIEWPORT, 64, 32, 0.5f);
    expect_pixels(40, 24, 48, 40, "cut by the viewport");
    draw_in_viewport(TRIPTYCH_POINT_CLIP_DEPTH, 64, 32, 0.5f);
    expect_pixels(40, 24, 56, 40, "not cut, depth");
    draw_in_viewport(TRIPTYCH_POINT_CLIP_CENTER, 64, 32, 0.5f);
    expect_pixels(40, 24, 56, 40, "not cut, center");
    draw_in_viewport(TRIPTYCH_POINT_CLIP_VIEWPORT, 66, 32, 0.5f);
    expect_pixels(41, 24, 48, 40, "beside and cut");
    draw_in_viewport(TRIPTYCH_POINT_CLIP_DEPTH, 66, 32, 0.5f);
    expect_pixels(41, 24, 57, 40, "beside and not cut");
    draw_in_viewport(TRIPTYCH_POINT_CLIP_CENTER, 66, 32, 0.5f);
    expect_pixels(0, 0, 0, 0, "its centre is outside");
    set(TRIPTYCH_STATE_CLIPPING, "false");
    draw_in_viewport(TRIPTYCH_POINT_CLIP_CENTER, 66, 32, 0.5f);
    expect_pixels(41, 24, 57, 40, "without clipping");
}

static void check_other_limits(void)
{
    for (unsigned clip = 0; clip < 3; clip++) {
        set_real(TRIPTYCH_STATE_POINTSIZE, 16);
        draw_in_viewport(clip, 32, 32, -0.0625f);
        expect_pixels(0, 0, 0, 0, "before the near plane");
        draw_in_viewport(clip, 32, 32, 1.0625f);
        expect_pixels(0, 0, 0, 0, "after the far plane");
    }
    OK(triptych_set_scissor(device, 0, 30, 50, 30));
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
    draw_in_viewport(TRIPTYCH_POINT_CLIP_DEPTH, 66, 32, 0.5f);
    expect_pixels(41, 30, 50, 40, "the scissor rectangle limits points");
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "false");
    set_real(TRIPTYCH_STATE_POINTSIZE, 256);
    set_real(TRIPTYCH_STATE_POINTSIZE_MAX, 256);
    draw_in_viewport(TRIPTYCH_POINT_CLIP_DEPTH, 150, 32, 0.5f); /* at x = 91 */
    expect_pixels(0, 0, SIZE, SIZE, "a large point far beside the viewport");
    set(TRIPTYCH_STATE_FILLMODE, "point");
    set_real(TRIPTYCH_STATE_POINTSIZE, 16);
    const struct shape_vertex corner[3] = {
        {64, 32, 0.5f, ~0u, 0, 0}, {64, 32.5f, 0.5f, ~0u, 0, 0}, {63.5f, 32, 0.5f, ~0u, 0, 0}};
    draw_in_viewport(TRIPTYCH_POINT_CLIP_DEPTH, 500, 500, 2);
    draw_shape(TRIPTYCH_TRIANGLE_LIST, corner, 3);
    read_shapes();
    for (int y = 0; y < SIZE; y++)
        expect_pixel(48, y, 0, "corners of triangles stay in the viewport");
    expect_pixel(47, 32, ~0u, "a corner");
}

static void test_points_are_cut_by_the_viewport_or_clipped_by_their_centres(void)
{
    on_every_engine(check_clips);
    on_every_engine(check_other_limits);
}

/* With row 0 at the bottom of the picture, the first row of texels is in the last row of the point. */
static void check_turned(void)
{
    bind_random_texture(8, 8);
    set_real(TRIPTYCH_STATE_POINTSIZE, 8);
    set(TRIPTYCH_STATE_POINTSPRITEENABLE, "true");
    OK(triptych_set_convention(device, TRIPTYCH_WINDOW_ORIGIN, TRIPTYCH_WINDOW_ORIGIN_LOWER));
    draw_point(30, 20, 0.5f, ~0u, 0.8f, 0.3f);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            expect_pixel(30 - 4 + x, SIZE - 20 - 4 + y, texel[(7 - y) * 8 + x], "a turned sprite");
}

static void test_sprites_begin_at_the_upper_side_of_the_picture(void)
{
    on_every_engine(check_turned);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_points_are_squares_of_their_colour_and_depth);
    RUN_TEST(test_sizes_are_limited);
    RUN_TEST(test_sprites_show_the_whole_texture_and_points_one_place);
    RUN_TEST(test_sprites_begin_at_the_side_of_their_convention);
    RUN_TEST(test_sprites_keep_their_coordinates_in_perspective);
    RUN_TEST(test_points_are_clipped_by_depth_and_cut_by_the_viewport);
    RUN_TEST(test_every_point_of_a_list_is_drawn);
    RUN_TEST(test_triangles_states_change_no_point);
    RUN_TEST(test_points_are_cut_by_the_viewport_or_clipped_by_their_centres);
    RUN_TEST(test_sprites_begin_at_the_upper_side_of_the_picture);
    return UNITY_END();
}
