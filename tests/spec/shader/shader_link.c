/* The link between the vertex and the pixel side of a draw, on every engine: shaders of any models and the
 * fixed function on both sides, inputs without an output, and interpolation. */
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

/* --- Pairs --------------------------------------------------------------------------------------------- */

struct half {
    const char *name, *text;
};

/* Each of these passes colour 0 and texture coordinates 0 on without a change. */
static const struct half vertex_halves[] = {
    {"fixed function", NULL},
    {"vs_1_1",
     "vs_1_1\ndcl_position v0\ndcl_color v1\ndcl_texcoord v2\nmov oPos, v0\nmov oD0, v1\nmov oT0, v2\n"},
    {"vs_2_0",
     "vs_2_0\ndcl_position v4\ndcl_color v5\ndcl_texcoord v6\nmov oPos, v4\nmov oD0, v5\nmov oT0, v6\n"},
    {"vs_2_x",
     "vs_2_x\ndcl_texcoord v0\ndcl_position v1\ndcl_color v2\nmov oT0, v0\nmov oPos, v1\nmov oD0, v2\n"},
    {"vs_3_0", "vs_3_0\ndcl_position v0\ndcl_color v1\ndcl_texcoord v2\ndcl_texcoord o0\ndcl_color o3\n"
               "dcl_position o7\nmov o7, v0\nmov o3, v1\nmov o0, v2\n"}};

static const struct half color_halves[] = {{"stages", NULL},
                                           {"ps_1_1", "ps_1_1\nmov r0, v0\n"},
                                           {"ps_1_2", "ps_1_2\nmov r0, v0\n"},
                                           {"ps_1_3", "ps_1_3\nmov r0, v0\n"},
                                           {"ps_1_4", "ps_1_4\nmov r0, v0\n"},
                                           {"ps_2_0", "ps_2_0\ndcl v0\nmov oC0, v0\n"},
                                           {"ps_2_x", "ps_2_x\ndcl v0\nmov r3, v0\nmov oC0, r3\n"},
                                           {"ps_3_0", "ps_3_0\ndcl_color v6\nmov oC0, v6\n"}};

static const struct half coordinate_halves[] = {
    {"ps_1_1", "ps_1_1\ntexcoord t0\nmov r0, t0\n"},
    {"ps_1_4", "ps_1_4\ndef c0, 0, 0, 0, 1\ntexcrd r0.xyz, t0\nmov r0.a, c0\n"},
    {"ps_2_0", "ps_2_0\ndcl t0.xyz\ndef c0, 0, 0, 0, 1\nmov r0.xyz, t0\nmov r0.w, c0\nmov oC0, r0\n"},
    {"ps_3_0", "ps_3_0\ndcl_texcoord v1.xyz\ndef c0, 0, 0, 0, 1\nmov oC0.xyz, v1\nmov oC0.w, c0\n"}};

#define COUNT(array) (sizeof(array) / sizeof *(array))

static void check_half(const struct half *pixel, const float expected[4])
{
    struct drawn_element elements[2] = {
        drawn_constant(TRIPTYCH_USAGE_COLOR, 0, 0.25f, 0.5f, 0.75f, 0.5f),
        drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 0, 0.125f, 0.375f, 0.625f, 1)};
    for (unsigned v = 0; v < COUNT(vertex_halves); v++) {
        char what[64];
        snprintf(what, sizeof what, "%s, %s", vertex_halves[v].name, pixel->name);
        use_shaders(vertex_halves[v].text, pixel->text);
        draw_declared(TRIPTYCH_USAGE_POSITION, elements, 2);
        read_numbers(0);
        expect_numbers(1, 1, expected, what);
        expect_numbers(SIZE - 1, SIZE / 2, expected, what);
    }
}

static void check_pairs(void)
{
    use_float_target();
    for (unsigned p = 0; p < COUNT(color_halves); p++)
        check_half(&color_halves[p], (const float[4]){0.25f, 0.5f, 0.75f, 0.5f});
    for (unsigned p = 0; p < COUNT(coordinate_halves); p++)
        check_half(&coordinate_halves[p], (const float[4]){0.125f, 0.375f, 0.625f, 1});
}

static void test_all_models_and_the_fixed_function_are_linked(void)
{
    on_every_engine(check_pairs);
}

/* Each set of coordinates selects another texel. With a vertex shader, a stage has the set of its own number,
 * whatever texcoordindex and the matrices are. */
static void check_stage_coordinates(void)
{
    static const float turned[4][4] = {{0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    uint32_t words[4] = {0xff000040, 0xff004000, 0xff400000, 0xff404040};
    triptych_texture *texture;
    OK(triptych_texture_create(device, words, 4, 1, &texture));
    use_shaders("vs_1_1\ndcl_position v0\ndef c0, 0.125, 0.375, 0.625, 0.875\nmov oPos, v0\nmov oT0, c0.z\n"
                "mov oT1, c0.y\nmov oT2, c0.x\n",
                NULL);
    for (unsigned i = 0; i < 3; i++) {
        OK(triptych_set_texture(device, i, texture));
        set_stage(i, TRIPTYCH_STAGE_COLOROP, i ? "add" : "selectarg1");
        set_stage(i, TRIPTYCH_STAGE_COLORARG1, "texture");
        OK(triptych_set_stage_state(device, i, TRIPTYCH_STAGE_TEXCOORDINDEX, 1));
        set_stage(i, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, "count2");
        OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_TEXTURE0 + i, turned));
    }
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(3, 3, 0xff404040, "three stages");
    OK(triptych_set_texture(device, 1, NULL));
    OK(triptych_set_texture(device, 2, NULL));
    set_stage(1, TRIPTYCH_STAGE_COLOROP, "disable");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(3, 3, 0xff400000, "the first stage");
}

static void test_stages_have_the_coordinates_of_their_number(void)
{
    on_every_engine(check_stage_coordinates);
}

static void expect_projected(uint32_t flags, const struct drawn_element *coordinates, uint32_t expected,
                             const char *what)
{
    OK(triptych_set_stage_state(device, 0, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, flags));
    draw_declared(TRIPTYCH_USAGE_POSITION, coordinates, coordinates ? 1 : 0);
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(3, 3, expected, what);
}

/* The same draw again, with the first three coordinates. */
static void expect_three(uint32_t expected, const char *what)
{
    static const struct triptych_declaration_element declared[2] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITION, 0},
        {0, 16, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_TEXCOORD, 0}};
    OK(triptych_set_declaration(device, declared, 2));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(3, 3, expected, what);
}

/* With `projected`, coordinates are divided: the fixed function's by the last of their count, the outputs of
 * a vertex shader by the fourth, whatever the count. Each divisor selects another texel. */
static void check_projected_stage(void)
{
    enum { PROJECTED = TRIPTYCH_TEXTURETRANSFORM_DISABLE_PROJECTED };
    uint32_t words[4] = {0xff000010, 0xff000020, 0xff000030, 0xff000040};
    struct drawn_element coordinates = drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 0, 0.75f, 0.5f, 2, 6);
    triptych_texture *texture;
    OK(triptych_texture_create(device, words, 4, 1, &texture));
    OK(triptych_set_texture(device, 0, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    for (int shader = 0; shader < 2; shader++) {
        const char *pixel = shader ? "ps_1_1\ntex t0\nmov r0, t0\n" : NULL;
        use_shaders("vs_1_1\ndcl_position v0\ndef c0, 0.75, 0.5, 2, 6\nmov oPos, v0\nmov oT0, c0\n", pixel);
        expect_projected(0, NULL, words[3], "not divided");
        for (uint32_t count = 0; count <= 4; count++)
            expect_projected(PROJECTED | count, NULL, words[0], "a shader's, divided by the fourth");
        use_shaders(NULL, pixel);
        expect_projected(PROJECTED | 2, &coordinates, words[3], "two are not divided");
        expect_projected(PROJECTED | 3, &coordinates, words[1], "divided by the third");
        expect_projected(PROJECTED | 4, &coordinates, words[0], "divided by the fourth");
        expect_projected(PROJECTED, &coordinates, words[0], "without a count, divided by the fourth");
        expect_three(words[1], "without a count, three are divided by the third");
    }
}

static void test_projected_stages_divide_the_outputs_of_shaders(void)
{
    on_every_engine(check_projected_stage);
}

/* --- Inputs without an output -------------------------------------------------------------------------- */

static const char position_only[] = "vs_2_0\ndcl_position v0\nmov oPos, v0\n";

/* A shader has ports for ten inputs. Of ten other usages, two are in the ports of the colours. */
static const char in_the_ports_of_colours[] =
    "ps_3_0\ndcl_tangent v0\ndcl_tangent1 v1\ndcl_tangent2 v2\ndcl_tangent3 v3\ndcl_tangent4 v4\n"
    "dcl_tangent5 v5\ndcl_tangent6 v6\ndcl_tangent7 v7\ndcl_tangent8 v8\ndcl_tangent9 v9\n"
    "mov r0, v0\nadd r0, r0, v1\nadd r0, r0, v2\nadd r0, r0, v3\nadd r0, r0, v4\nadd r0, r0, v5\n"
    "add r0, r0, v6\nadd r0, r0, v7\nadd r0, r0, v8\nadd oC0, r0, v9\n";

static void check_defaults(void)
{
    use_float_target();
    use_shaders(position_only, "ps_2_0\ndcl v0\nmov oC0, v0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("the first colour", 1, 1, 1, 1);
    use_shaders(position_only, "ps_2_0\ndcl v1\nmov oC0, v1\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("the second colour", 0, 0, 0, 0);
    use_shaders("vs_3_0\ndcl_position v0\ndcl_position o0\ndcl_color1 o1\ndef c0, 0.5, 0, 0, 0\n"
                "mov o0, v0\nmov o1.x, c0\n",
                "ps_3_0\ndcl_color1 v1\nmov oC0, v1\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("a quarter of the second colour", 0.5f, 0, 0, 0);
    use_shaders("vs_2_0\ndcl_position v0\ndef c0, 3, 4, 5, 6\nmov oPos, v0\nmov oT3.xy, c0\n",
                "ps_2_0\ndcl t3\nmov r0, t3\nmov oC0, r0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("half of a coordinate", 3, 4, 0, 1);
    use_shaders(position_only, NULL);
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("stages without a colour", 1, 1, 1, 1);
    use_shaders(NULL, "ps_3_0\ndcl_color v0\ndcl_tangent v1\ndcl_texcoord9 v2\nmov r1, v1\nmul r0, v0, "
                      "r1\nadd oC0, r0, v2\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("what the fixed function does not have", 0, 0, 0, 2);
    use_shaders(position_only, in_the_ports_of_colours);
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("ten inputs of other usages", 0, 0, 0, 10);
}

static void test_inputs_without_an_output_have_their_default(void)
{
    on_every_engine(check_defaults);
}

static const char two_colours[] =
    "vs_2_0\ndcl_position v0\ndcl_color1 v1\ndef c0, 0.25, 0.25, 0.25, 1\nmov oPos, v0\n"
    "mov oD1, v1\nmov oD0, c0\n";

static void check_unlike_fixed(void)
{
    struct drawn_element specular = drawn_constant(TRIPTYCH_USAGE_COLOR, 1, 0.5f, 0.25f, 0.125f, 1);
    use_float_target();
    set(TRIPTYCH_STATE_SPECULARENABLE, "true");
    use_shaders(two_colours, NULL);
    draw_declared(TRIPTYCH_USAGE_POSITION, &specular, 1);
    read_numbers(0);
    EXPECT_CENTRE("stages add the specular colour", 0.75f, 0.5f, 0.375f, 1);
    use_shaders(two_colours, "ps_2_0\ndcl v0\nmov oC0, v0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, &specular, 1);
    read_numbers(0);
    EXPECT_CENTRE("shaders do not", 0.25f, 0.25f, 0.25f, 1);
}

static void test_specular_colours_are_added_after_stages_only(void)
{
    on_every_engine(check_unlike_fixed);
}

/* --- Clamping ------------------------------------------------------------------------------------------ */

static void check_clamped(void)
{
    struct drawn_element wide = drawn_constant(TRIPTYCH_USAGE_COLOR, 0, 2, -1, 0.5f, 3);
    static const char third[] =
        "vs_3_0\ndcl_position v0\ndcl_color v1\ndcl_position o0\ndcl_color o1\nmov o0, v0\nmov o1, v1\n";
    static const char second[] =
        "vs_2_0\ndcl_position v0\ndcl_color v1\nmov oPos, v0\nmov oD0, v1\nmov oT0, v1\n";
    use_float_target();
    use_shaders(third, "ps_3_0\ndcl_color v0\nmov oC0, v0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, &wide, 1);
    read_numbers(0);
    EXPECT_CENTRE("3.0 to 3.0", 2, -1, 0.5f, 3);
    use_shaders(third, "ps_2_0\ndcl v0\nmov oC0, v0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, &wide, 1);
    read_numbers(0);
    EXPECT_CENTRE("3.0 to 2.0", 1, 0, 0.5f, 1);
    use_shaders(second, "ps_3_0\ndcl_color v0\nmov oC0, v0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, &wide, 1);
    read_numbers(0);
    EXPECT_CENTRE("2.0 to 3.0", 1, 0, 0.5f, 1);
    use_shaders(second, "ps_3_0\ndcl_texcoord v0\nmov oC0, v0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, &wide, 1);
    read_numbers(0);
    EXPECT_CENTRE("coordinates", 2, -1, 0.5f, 3);
}

/* Colours are clamped at the vertices. In the middle between 2 and -1 the colour is 0.5 with and without
 * clamping, but at a quarter it differs. */
static void check_clamped_at_vertices(void)
{
    struct drawn_element ramp = {
        TRIPTYCH_USAGE_COLOR, 0, {{-1, 0, 0, 1}, {3, 0, 0, 1}, {-1, 0, 0, 1}, {3, 0, 0, 1}}};
    use_float_target();
    use_shaders("vs_2_0\ndcl_position v0\ndcl_color v1\nmov oPos, v0\nmov oD0, v1\n",
                "ps_2_0\ndcl v0\nmov oC0, v0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, &ramp, 1);
    read_numbers(0);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 16.5f / SIZE, drawn[16][0]);
    use_shaders(
        "vs_3_0\ndcl_position v0\ndcl_color v1\ndcl_position o0\ndcl_color o1\nmov o0, v0\nmov o1, v1\n",
        "ps_2_0\ndcl v0\nmov oC0, v0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, &ramp, 1);
    read_numbers(0);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 4 * 16.5f / SIZE - 1, drawn[16][0]);
}

static void test_colours_are_clamped_below_3_0_at_both_ends(void)
{
    on_every_engine(check_clamped);
    on_every_engine(check_clamped_at_vertices);
}

/* --- Ports --------------------------------------------------------------------------------------------- */

/* There are ten inputs of ten usages, in a different order on each side. Each is weighted by another power of
 * two. */
static void check_ten(void)
{
    struct drawn_element elements[10] = {drawn_constant(TRIPTYCH_USAGE_TANGENT, 0, 1, 0, 0, 0),
                                         drawn_constant(TRIPTYCH_USAGE_BINORMAL, 7, 2, 0, 0, 0),
                                         drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 12, 4, 0, 0, 0),
                                         drawn_constant(TRIPTYCH_USAGE_COLOR, 0, 8, 0, 0, 0),
                                         drawn_constant(TRIPTYCH_USAGE_COLOR, 5, 16, 0, 0, 0),
                                         drawn_constant(TRIPTYCH_USAGE_FOG, 0, 32, 0, 0, 0),
                                         drawn_constant(TRIPTYCH_USAGE_PSIZE, 1, 64, 0, 0, 0),
                                         drawn_constant(TRIPTYCH_USAGE_NORMAL, 0, 128, 0, 0, 0),
                                         drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 0, 256, 0, 0, 0),
                                         drawn_constant(TRIPTYCH_USAGE_DEPTH, 3, 512, 0, 0, 0)};
    static const char *const names[10] = {"tangent", "binormal7", "texcoord12", "color",    "color5",
                                          "fog",     "psize1",    "normal",     "texcoord", "depth3"};
    char vertex[1024] = "vs_3_0\ndcl_position v15\ndcl_position o11\n", pixel[1024] = "ps_3_0\n", line[64];
    for (int i = 0; i < 10; i++) {
        snprintf(line, sizeof line, "dcl_%s v%d\ndcl_%s o%d\n", names[i], i, names[i], 9 - i);
        strcat(vertex, line);
        snprintf(line, sizeof line, "dcl_%s v%d\n", names[i], (i * 3 + 1) % 10);
        strcat(pixel, line);
    }
    strcat(vertex, "mov o11, v15\n");
    for (int i = 0; i < 10; i++) {
        snprintf(line, sizeof line, "mov o%d, v%d\n", 9 - i, i);
        strcat(vertex, line);
    }
    use_float_target();
    for (int which = 0; which < 10; which++) {
        char text[1200];
        snprintf(text, sizeof text, "%sdef c0, 1, 0, 0, 0\nmov r0, c0.y\n", pixel);
        for (int i = 0; i < 10; i++) {
            snprintf(line, sizeof line, "mad r0.%s, v%d.x, c0.x, r0\n", i == which ? "xy" : "x",
                     (i * 3 + 1) % 10);
            strcat(text, line);
        }
        strcat(text, "mov oC0, r0\n");
        use_shaders(vertex, text);
        draw_declared(TRIPTYCH_USAGE_POSITION, elements, 10);
        read_numbers(0);
        EXPECT_CENTRE(names[which], 1023, (float)(1 << which), 0, 0);
    }
}

static void test_ten_inputs_of_any_usage_are_linked(void)
{
    on_every_engine(check_ten);
}

/* Two usages are in one register, in the same components on both sides. The loop's counter addresses an
 * input. */
static void check_packed_registers(void)
{
    struct drawn_element elements[2] = {drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 3, 1, 2, 3, 4),
                                        drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 4, 5, 6, 7, 8)};
    use_float_target();
    use_shaders("vs_3_0\ndcl_position v0\ndcl_texcoord3 v1\ndcl_texcoord4 v2\ndcl_position o0\n"
                "dcl_texcoord6 o4.xy\ndcl_tangent o4.zw\nmov o0, v0\nmov o4.xy, v1\nmov o4.zw, v2\n",
                "ps_3_0\ndcl_texcoord6 v2.xy\ndcl_tangent v2.zw\nmov oC0, v2\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, elements, 2);
    read_numbers(0);
    EXPECT_CENTRE("two in one", 1, 2, 7, 8);
    use_shaders(
        "vs_3_0\ndcl_position v0\ndcl_texcoord3 v1\ndcl_texcoord4 v2\ndcl_position o0\n"
        "dcl_texcoord6 o1\ndcl_tangent o2\nmov o0, v0\nmov o1, v1\nmov o2, v2\n",
        "ps_3_0\ndcl_texcoord6 v2\ndcl_tangent v3\ndefi i0, 2, 2, 1, 0\ndef c0, 0, 0, 0, 0\nmov r0, c0\n"
        "loop aL, i0\nadd r0, r0, v[aL]\nendloop\nmov oC0, r0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, elements, 2);
    read_numbers(0);
    EXPECT_CENTRE("by the counter", 6, 8, 10, 12);
}

static void test_registers_hold_several_usages_and_are_indexed(void)
{
    on_every_engine(check_packed_registers);
}

/* --- Interpolation ------------------------------------------------------------------------------------- */

static void check_flat(void)
{
    struct drawn_element elements[2] = {
        {TRIPTYCH_USAGE_COLOR, 0, {{0.25f, 0, 0, 1}, {0.5f, 0, 0, 1}, {0.75f, 0, 0, 1}, {1, 0, 0, 1}}},
        {TRIPTYCH_USAGE_TEXCOORD, 0, {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 0, 1}}}};
    static const char third[] = "vs_3_0\ndcl_position v0\ndcl_color v1\ndcl_texcoord v2\ndcl_position "
                                "o0\ndcl_color o1\ndcl_texcoord o2\n"
                                "mov o0, v0\nmov o1, v1\nmov o2, v2\n";
    static const char *const pixel[] = {
        "ps_2_0\ndcl v0\ndcl t0\nmov r0.x, v0.x\nmov r0.yzw, t0.y\nmov oC0, r0\n",
        "ps_3_0\ndcl_color v8\ndcl_texcoord v1\nmov oC0.x, v8.x\nmov oC0.yzw, v1.y\n"};
    use_float_target();
    set(TRIPTYCH_STATE_SHADEMODE, "flat");
    for (int i = 0; i < 2; i++) {
        use_shaders(third, pixel[i]);
        draw_declared(TRIPTYCH_USAGE_POSITION, elements, 2);
        read_numbers(0);
        TEST_ASSERT_EQUAL_FLOAT(0.25f, drawn[0][0]);
        TEST_ASSERT_EQUAL_FLOAT(0.25f, drawn[20 * SIZE + 20][0]);
        TEST_ASSERT_EQUAL_FLOAT(0.5f, drawn[(SIZE - 1) * SIZE + SIZE - 1][0]);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, 20.5f / SIZE, drawn[20 * SIZE + 20][1]);
    }
}

static void test_flat_shading_affects_colours_only(void)
{
    on_every_engine(check_flat);
}

static void check_sprites(void)
{
    struct drawn_element elements[2] = {drawn_constant(TRIPTYCH_USAGE_COLOR, 0, 0.25f, 0.5f, 0.75f, 0.5f),
                                        drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 2, 7, 8, 9, 10)};
    static const float middle[4] = {0, 0, 0.5f, 1};
    memcpy(drawn_position[0], middle, sizeof middle);
    use_float_target();
    OK(triptych_set_state(device, TRIPTYCH_STATE_POINTSIZE, triptych_float_bits(32)));
    for (int sprite = 0; sprite < 2; sprite++)
        for (int tangent = 0; tangent < 2; tangent++) {
            use_shaders(tangent ? "vs_3_0\ndcl_position v0\ndcl_texcoord2 v1\ndcl_position o0\ndcl_tangent "
                                  "o1\nmov o0, v0\nmov o1, v1\n"
                                : "vs_2_0\ndcl_position v0\ndcl_texcoord2 v1\nmov oPos, v0\nmov oT2, v1\n",
                        tangent ? "ps_3_0\ndcl_tangent v0\nmov oC0, v0\n"
                                : "ps_2_0\ndcl t2\nmov r0, t2\nmov oC0, r0\n");
            set(TRIPTYCH_STATE_POINTSPRITEENABLE, sprite ? "true" : "false");
            draw_points(elements, 2);
            read_numbers(0);
            if (sprite && !tangent)
                expect_numbers(20, 40, (const float[4]){4.5f / 32, 24.5f / 32, 0, 1}, "a sprite");
            else
                expect_numbers(20, 40, (const float[4]){7, 8, 9, 10}, "a point");
        }
    drawn_begin();
}

static void test_sprites_replace_coordinates_only(void)
{
    on_every_engine(check_sprites);
}

/* With wrapping, the shorter way from 0.9 to 0.1 passes 1. */
static void check_wrap(void)
{
    struct drawn_element ends = {TRIPTYCH_USAGE_TEXCOORD,
                                 1,
                                 {{0.875f, 0.875f, 0.875f, 0.875f},
                                  {0.125f, 0.125f, 0.125f, 0.125f},
                                  {0.875f, 0.875f, 0.875f, 0.875f},
                                  {0.125f, 0.125f, 0.125f, 0.125f}}};
    use_float_target();
    use_shaders("vs_3_0\ndcl_position v0\ndcl_texcoord1 v1\ndcl_position o0\ndcl_texcoord11 o1\nmov o0, "
                "v0\nmov o1, v1\n",
                "ps_3_0\ndcl_texcoord11 v0\nmov oC0, v0\n");
    for (uint32_t bits = 0; bits < 16; bits++) {
        OK(triptych_set_state(device, TRIPTYCH_STATE_WRAP11, bits));
        draw_declared(TRIPTYCH_USAGE_POSITION, &ends, 1);
        read_numbers(0);
        for (int c = 0; c < 4; c++) {
            float along = 48.5f / SIZE;
            float expected = bits >> c & 1 ? 0.875f + 0.25f * along : 0.875f - 0.75f * along;
            float got = drawn[48][c];
            TEST_ASSERT_FLOAT_WITHIN(
                1e-5f, 0, (got - expected) - (float)(int)(got - expected + (got < expected ? -0.5f : 0.5f)));
        }
    }
}

static void test_coordinates_of_shaders_wrap(void)
{
    on_every_engine(check_wrap);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_all_models_and_the_fixed_function_are_linked);
    RUN_TEST(test_stages_have_the_coordinates_of_their_number);
    RUN_TEST(test_projected_stages_divide_the_outputs_of_shaders);
    RUN_TEST(test_inputs_without_an_output_have_their_default);
    RUN_TEST(test_specular_colours_are_added_after_stages_only);
    RUN_TEST(test_colours_are_clamped_below_3_0_at_both_ends);
    RUN_TEST(test_ten_inputs_of_any_usage_are_linked);
    RUN_TEST(test_registers_hold_several_usages_and_are_indexed);
    RUN_TEST(test_flat_shading_affects_colours_only);
    RUN_TEST(test_sprites_replace_coordinates_only);
    RUN_TEST(test_coordinates_of_shaders_wrap);
    return UNITY_END();
}
