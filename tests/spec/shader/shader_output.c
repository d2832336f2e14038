/* The results of a shader, on every engine: positions and clip planes, point sizes, fog, several targets,
 * and the position and the face of a pixel. */
#include "tests/support/picture/drawn.h"

#include <stdio.h>
#include <string.h>

void setUp(void)
{
    drawn_begin();
}

void tearDown(void)
{
    close_canvas();
}

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const char plain[] = "vs_2_0\ndcl_position v0\nmov oPos, v0\n";
static const char red[] = "ps_2_0\ndef c0, 1, 0, 0, 1\nmov oC0, c0\n";

static float depth[SIZE * SIZE];

static void draw(void)
{
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
}

static unsigned count_words(uint32_t word)
{
    unsigned r = 0;
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        r += image[p] == word;
    return r;
}

/* --- Vertices ------------------------------------------------------------------------------------------ */

/* The plane x >= 0 is in clip space, and the matrices, which would reverse it, have no effect. */
static void check_clip_planes(void)
{
    static const float turned[4][4] = {{0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_VIEW, turned));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CLIPPLANEENABLE, 1));
    use_shaders(plain, red);
    OK(triptych_set_clip_plane(device, 0, (float[4]){1, 0, 0, 0}));
    clear_to(0);
    draw();
    TEST_ASSERT_EQUAL_UINT(SIZE * SIZE / 2, count_words(0xff0000ff));
    expect_pixel(SIZE / 2, 5, 0xff0000ff, "inside");
    expect_pixel(SIZE / 2 - 1, 5, 0, "outside");
    OK(triptych_set_clip_plane(device, 0, (float[4]){0, 0, 1, -0.25f}));
    clear_to(0);
    draw(); /* depth 0.5 of the shader's own clip space */
    TEST_ASSERT_EQUAL_UINT(SIZE * SIZE, count_words(0xff0000ff));
    OK(triptych_set_clip_plane(device, 0, (float[4]){0, 0, 1, -0.75f}));
    clear_to(0);
    draw();
    TEST_ASSERT_EQUAL_UINT(0, count_words(0xff0000ff));
}

static void test_clip_planes_are_in_clip_space(void)
{
    on_every_engine(check_clip_planes);
}

/* In the range from -1 to 1, depth 0.5 becomes 0.75 and -1 is the nearest depth. Clip planes use the same
 * range. */
static void check_depth_range(void)
{
    OK(triptych_set_convention(device, TRIPTYCH_DEPTH_RANGE, TRIPTYCH_DEPTH_RANGE_MINUS));
    set(TRIPTYCH_STATE_ZENABLE, "true");
    use_shaders(plain, red);
    clear_to(0);
    draw();
    OK(triptych_read_depth(device, depth, sizeof depth));
    TEST_ASSERT_EQUAL_FLOAT(0.75f, depth[77]);
    for (int i = 0; i < 4; i++)
        drawn_position[i][2] = -1;
    draw();
    OK(triptych_read_depth(device, depth, sizeof depth));
    TEST_ASSERT_EQUAL_FLOAT(0, depth[77]);
    OK(triptych_set_state(device, TRIPTYCH_STATE_CLIPPLANEENABLE, 4));
    OK(triptych_set_clip_plane(device, 2, (float[4]){0, 0, -1, -0.75f}));
    clear_to(0);
    draw();
    TEST_ASSERT_EQUAL_UINT(SIZE * SIZE, count_words(0xff0000ff));
    for (int i = 0; i < 4; i++)
        drawn_position[i][2] = -0.5f;
    clear_to(0);
    draw();
    TEST_ASSERT_EQUAL_UINT(0, count_words(0xff0000ff));
    drawn_begin();
}

static void test_clip_depth_follows_the_convention(void)
{
    on_every_engine(check_depth_range);
}

static unsigned point_pixels(float size)
{
    struct drawn_element given = drawn_constant(TRIPTYCH_USAGE_PSIZE, 0, size, 0, 0, 0);
    clear_to(0);
    draw_points(&given, 1);
    return count_words(0xff0000ff);
}

static void check_point_size(void)
{
    memcpy(drawn_position[0], (float[4]){0, 0, 0.5f, 1}, sizeof drawn_position[0]);
    use_shaders("vs_2_0\ndcl_position v0\ndcl_psize v1\nmov oPos, v0\nmov oPts, v1.x\n", red);
    TEST_ASSERT_EQUAL_UINT(100, point_pixels(10));
    OK(triptych_set_state(device, TRIPTYCH_STATE_POINTSIZE_MAX, triptych_float_bits(6)));
    TEST_ASSERT_EQUAL_UINT(36, point_pixels(10));
    OK(triptych_set_state(device, TRIPTYCH_STATE_POINTSIZE_MIN, triptych_float_bits(4)));
    TEST_ASSERT_EQUAL_UINT(16, point_pixels(1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_POINTSIZE_MAX, triptych_float_bits(64)));
    OK(triptych_set_state(device, TRIPTYCH_STATE_POINTSIZE, triptych_float_bits(8)));
    set(TRIPTYCH_STATE_POINTSCALEENABLE, "true");
    use_shaders("vs_3_0\ndcl_position v0\ndcl_psize v1\ndcl_position o0\ndcl_psize o4.x\nmov o0, v0\nadd "
                "o4.x, v1.x, v1.x\n",
                red);
    TEST_ASSERT_EQUAL_UINT(144, point_pixels(6));
    use_shaders(plain, red); /* vertices have a size, and the shader has none */
    TEST_ASSERT_EQUAL_UINT(64, point_pixels(20));
    drawn_begin();
}

static void test_points_have_the_size_that_the_shader_writes(void)
{
    on_every_engine(check_point_size);
}

/* --- Fog ----------------------------------------------------------------------------------------------- */

static const char fogged[] = "vs_2_0\ndcl_position v0\ndcl_texcoord v1\nmov oPos, v0\nmov oFog, v1.x\n";
static const char fogged_3[] =
    "vs_3_0\ndcl_position v0\ndcl_texcoord v1\ndcl_position o0\ndcl_fog o1.x\nmov o0, v0\nmov o1.x, v1.x\n";

static void expect_fog(const char *vertex, const char *pixel, float factor, uint32_t expected,
                       const char *what)
{
    struct drawn_element given = drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 0, factor, 0, 0, 0);
    use_shaders(vertex, pixel);
    draw_declared(TRIPTYCH_USAGE_POSITION, &given, 1);
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(9, 9, expected, what);
}

static void check_fog(void)
{
    static const char *const pixels[] = {"ps_1_1\ndef c0, 1, 0, 0, 1\nmov r0, c0\n",
                                         "ps_1_4\ndef c0, 1, 0, 0, 1\nmov r0, c0\n", red};
    static const char third[] = "ps_3_0\ndef c0, 1, 0, 0, 1\nmov oC0, c0\n";
    uint32_t whole = 0xff0000ff, none = 0xff00ff00, part = 0xff00cc33; /* fog of 4/5 green */
    set(TRIPTYCH_STATE_FOGENABLE, "true");
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGCOLOR, 0xff00ff00));
    for (unsigned i = 0; i < COUNT(pixels); i++) {
        expect_fog(fogged, pixels[i], 0.2f, part, "a factor");
        expect_fog(fogged_3, pixels[i], 0.2f, part, "a factor of vs_3_0");
        expect_fog(fogged, pixels[i], 7, whole, "beyond one");
        expect_fog(fogged, pixels[i], -7, none, "below zero");
        expect_fog(fogged_3, pixels[i], -7, none, "below zero in vs_3_0");
        expect_fog(plain, pixels[i], 0, none, "no factor");
    }
    expect_fog(fogged_3, third, 0.2f, whole, "ps_3_0");
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGVERTEXMODE, 3)); /* the shader's fog replaces it */
    expect_fog(fogged, red, 0.2f, part, "a mode of vertices");
    set(TRIPTYCH_STATE_FOGTABLEMODE, "linear");
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGSTART, triptych_float_bits(0)));
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGEND, triptych_float_bits(0.625f)));
    expect_fog(fogged, red, 1, part, "a table, at depth 0.5");
    expect_fog(plain, red, 1, part, "only a table");
    expect_fog(plain, third, 1, whole, "a table in ps_3_0");
    expect_fog(fogged, NULL, 1, 0xff33ff33, "a table after stages");
}

static void test_fog_is_applied_below_3_0(void)
{
    on_every_engine(check_fog);
}

/* --- What is left of pixels ---------------------------------------------------------------------------- */

static const char with_sides[] = "vs_2_0\ndcl_position v0\ndcl_texcoord v1\nmov oPos, v0\nmov oT0, v1\n";

/* --- Targets ------------------------------------------------------------------------------------------- */

static const char four[] =
    "ps_2_0\ndef c0, 0.25, 0.5, 0.75, 1\ndef c1, 2, -1, 0.5, 0.25\ndef c2, 1, 1, 0, 0\n"
    "def c3, 0.125, 8, -4, 3\nmov r0, c0\nmov oC0, r0\nmov r0, c1\nmov oC1, r0\nmov r0, c2\n"
    "mov oC2, r0\nmov r0, c3\nmov oC3, r0\n";

static void expect_target(unsigned t, float r, float g, float b, float a)
{
    char what[16];
    snprintf(what, sizeof what, "target %u", t);
    read_numbers(t);
    EXPECT_CENTRE(what, r, g, b, a);
}

static void check_targets(void)
{
    struct triptych_target_description description = {
        .width = SIZE,
        .height = SIZE,
        .color_format = {TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_A32B32G32R32F, TRIPTYCH_SURFACE_R5G6B5,
                         TRIPTYCH_SURFACE_A16B16G16R16F}};
    OK(triptych_set_target_description(device, &description));
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE1, 11));
    use_shaders(plain, four);
    clear_to(0xffffffff);
    draw();
    expect_target(0, 64 / 255.0f, 128 / 255.0f, 191 / 255.0f, 1);
    expect_target(1, 2, -1, 1, 0.25f);
    expect_target(2, 1, 1, 0, 1);
    expect_target(3, 0.125f, 8, -4, 3);
    use_shaders(plain, "ps_3_0\ndef c0, 0.5, 0.5, 0.5, 0.5\nmov oC0, c0\nmov oC3, c0\n");
    draw();
    expect_target(1, 2, -1, 1, 0.25f);
    expect_target(2, 1, 1, 0, 1);
    expect_target(3, 0.5f, 0.5f, 0.5f, 0.5f);
}

/* All targets have 8 bits a channel. Each is blended with its own colour, and only the first has fog. */
static void check_packed_targets(void)
{
    struct triptych_target_description description = {
        .width = SIZE,
        .height = SIZE,
        .color_format = {TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_X8R8G8B8}};
    OK(triptych_set_target_description(device, &description));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "srcalpha");
    set(TRIPTYCH_STATE_DESTBLEND, "zero");
    use_shaders(plain, four);
    clear_to(0xffffffff);
    draw();
    OK(triptych_read_target(device, 0, image, sizeof image));
    TEST_ASSERT_EQUAL_HEX32(0xffbf8040, image[0]);
    OK(triptych_read_target(device, 1, image, sizeof image));
    TEST_ASSERT_EQUAL_HEX32(0x10200040, image[0]); /* 1 0 1/2 1/4, times 1/4 */
    OK(triptych_read_target(device, 2, image, sizeof image));
    TEST_ASSERT_EQUAL_HEX32(0xff000000, image[0]);
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "false");
    set(TRIPTYCH_STATE_FOGENABLE, "true");
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGCOLOR, 0xff00ff00));
    set(TRIPTYCH_STATE_FOGTABLEMODE, "linear");
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGEND, triptych_float_bits(0.25f)));
    draw();
    OK(triptych_read_target(device, 0, image, sizeof image));
    TEST_ASSERT_EQUAL_HEX32(0xff00ff00, image[0]);
    OK(triptych_read_target(device, 2, image, sizeof image));
    TEST_ASSERT_EQUAL_HEX32(0xff00ffff, image[0]);
}

static void test_targets_have_colours_of_their_own(void)
{
    on_every_engine(check_targets);
    on_every_engine(check_packed_targets);
}

/* --- Position and face --------------------------------------------------------------------------------- */

static void check_place(void)
{
    use_float_target();
    for (unsigned centre = 0; centre < 2; centre++) {
        OK(triptych_set_convention(device, TRIPTYCH_PIXEL_CENTER, centre));
        use_shaders("vs_3_0\ndcl_position v0\ndcl_position o0\nmov o0, v0\n",
                    "ps_3_0\ndcl vPos.xy\ndef c0, 5, 6, 7, 8\nmov oC0.xy, vPos\nmov oC0.zw, c0\n");
        draw();
        read_numbers(0);
        for (int y = 1; y < SIZE; y += 3)
            for (int x = 1; x < SIZE; x++)
                expect_numbers(x, y, (const float[4]){(float)x, (float)y, 7, 8}, "a place");
    }
}

static void test_pixels_read_their_position(void)
{
    on_every_engine(check_place);
}

static void check_face(void)
{
    static const char face[] = "ps_3_0\ndcl vFace\nmov oC0, vFace\n";
    static const char vertex[] = "vs_3_0\ndcl_position v0\ndcl_position o0\nmov o0, v0\n";
    use_float_target();
    use_shaders(vertex, face);
    draw(); /* clockwise */
    read_numbers(0);
    EXPECT_CENTRE("a front", 1, 1, 1, 1);
    for (int i = 0; i < 4; i++)
        drawn_position[i][0] = -drawn_position[i][0];
    draw();
    read_numbers(0);
    EXPECT_CENTRE("a back", -1, -1, -1, -1);
    set(TRIPTYCH_STATE_CULLMODE, "cw");
    use_shaders(vertex, face);
    draw();
    read_numbers(0);
    EXPECT_CENTRE("a back, the only face drawn", -1, -1, -1, -1);
    memcpy(drawn_position[0], (float[4]){0, 0, 0.5f, 1}, sizeof drawn_position[0]);
    OK(triptych_set_state(device, TRIPTYCH_STATE_POINTSIZE, triptych_float_bits(16)));
    draw_points(NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("a point", 1, 1, 1, 1);
    drawn_begin();
}

static void test_pixels_read_their_face(void)
{
    on_every_engine(check_face);
}

/* The triangle covers one of the four samples of each pixel on the diagonal. The pixels' centres are outside,
 * where a ramp exceeds its ends. */
static void check_centroid(void)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {TRIPTYCH_SURFACE_A8R8G8B8}, .samples = 4};
    /* The third side of the triangle passes the pixels' centres at a small distance, where x + y is 0. */
    float reach = 2 - 0.25f / SIZE * 2;
    struct drawn_element ramp = {TRIPTYCH_USAGE_TEXCOORD, 0, {{0}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0}}};
    float corners[4][4] = {
        {-1, 1, 0.5f, 1}, {-1 + reach, 1, 0.5f, 1}, {-1, 1 - reach, 0.5f, 1}, {-1, 1 - reach, 0.5f, 1}};
    ramp.value[0][0] = 64;
    memcpy(drawn_position, corners, sizeof corners);
    OK(triptych_set_target_description(device, &description));
    for (int declared = 0; declared < 2; declared++) {
        char pixel[160];
        unsigned negative = 0;
        snprintf(pixel, sizeof pixel,
                 "ps_2_0\ndcl%s t0\ndef c0, 0, 1, 0, 1\ndef c1, 1, 0, 0, 1\nmov r0, t0\nmov r1, c1\ncmp r0, "
                 "r0.x, c0, r1\nmov oC0, r0\n",
                 declared ? "_centroid" : "");
        use_shaders(with_sides, pixel);
        clear_to(0);
        draw_declared(TRIPTYCH_USAGE_POSITION, &ramp, 1);
        for (unsigned s = 0; s < 4; s++) {
            OK(triptych_read_sample(device, s, image, sizeof image, NULL, 0, NULL, 0));
            for (int p = 0; p < SIZE * SIZE; p++)
                negative += (image[p] & 255) == 255;
        }
        if (declared)
            TEST_ASSERT_EQUAL_UINT(0, negative);
        else
            TEST_ASSERT_GREATER_THAN_UINT(0, negative);
    }
    drawn_begin();
}

static void test_centroids_are_inside(void)
{
    on_every_engine(check_centroid);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_clip_planes_are_in_clip_space);
    RUN_TEST(test_clip_depth_follows_the_convention);
    RUN_TEST(test_points_have_the_size_that_the_shader_writes);
    RUN_TEST(test_fog_is_applied_below_3_0);
    RUN_TEST(test_targets_have_colours_of_their_own);
    RUN_TEST(test_pixels_read_their_position);
    RUN_TEST(test_pixels_read_their_face);
    RUN_TEST(test_centroids_are_inside);
    return UNITY_END();
}
