/* The inputs of vertex shaders, on every engine: elements of any usage and any format, missing elements,
 * instances, and vertices in the window. */
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

static const char *const usage_names[TRIPTYCH_USAGE_COUNT] = {
    "position", "blendweight", "blendindices", "normal", "psize", "texcoord", "tangent",
    "binormal", "tessfactor",  "positiont",    "color",  "fog",   "depth",    "sample"};

static void check_usages(void)
{
    char text[256], what[64];
    use_float_target();
    for (unsigned usage = 0; usage < TRIPTYCH_USAGE_COUNT; usage++)
        for (unsigned index = usage % 7; index < 16; index += 7) {
            if (usage == TRIPTYCH_USAGE_POSITIONT || (usage == TRIPTYCH_USAGE_POSITION && !index))
                continue;
            float tag = (float)(usage * 16 + index);
            struct drawn_element elements[2] = {
                drawn_constant(usage, index, tag, tag + 0.25f, tag + 0.5f, tag + 0.75f),
                drawn_constant(usage == TRIPTYCH_USAGE_SAMPLE ? TRIPTYCH_USAGE_DEPTH : TRIPTYCH_USAGE_SAMPLE,
                               15, 9, 9, 9, 9)};
            snprintf(what, sizeof what, "%s%u", usage_names[usage], index);
            snprintf(text, sizeof text,
                     "vs_3_0\ndcl_position v0\ndcl_%s v7\ndcl_position o0\ndcl_tangent3 o5\n"
                     "mov o0, v0\nmov o5, v7\n",
                     what);
            use_shaders(text, "ps_3_0\ndcl_tangent3 v4\nmov oC0, v4\n");
            draw_declared(TRIPTYCH_USAGE_POSITION, elements, 2);
            read_numbers(0);
            EXPECT_CENTRE(what, tag, tag + 0.25f, tag + 0.5f, tag + 0.75f);
        }
}

static void test_elements_of_every_usage_reach_the_shader(void)
{
    on_every_engine(check_usages);
}

static void check_missing(void)
{
    use_float_target();
    use_shaders("vs_1_1\ndcl_position v0\ndcl_tangent v1\nmov oPos, v0\nmov oT0, v1\n",
                "ps_2_0\ndcl t0\nmov r0, t0\nmov oC0, r0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("nothing declared", 0, 0, 0, 1);
}

static void test_elements_that_are_missing_are_0_0_0_1(void)
{
    on_every_engine(check_missing);
}

/* Twelve elements in a stream that steps with the instance, the position in one that does not. */
static void check_instances(void)
{
    static const struct triptych_declaration_element declared[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITION, 0},
        {1, 16, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_BINORMAL, 2}};
    static const float stepped[3][2][4] = {{{0}, {1, 2, 3, 4}}, {{0}, {5, 6, 7, 8}}, {{0}, {9, 10, 11, 12}}};
    static const uint16_t index[4] = {0, 1, 2, 3};
    triptych_buffer *position, *other, *indices;
    use_float_target();
    use_shaders("vs_2_0\ndcl_position v0\ndcl_binormal2 v1\nmov oPos, v0\nmov oT5, v1\n",
                "ps_2_0\ndcl t5\nmov r0, t5\nmov oC0, r0\n");
    OK(triptych_buffer_create(device, drawn_position, sizeof drawn_position, &position));
    OK(triptych_buffer_create(device, stepped, sizeof stepped, &other));
    OK(triptych_buffer_create(device, index, sizeof index, &indices));
    OK(triptych_set_declaration(device, declared, 2));
    OK(triptych_set_stream(device, 0, position, 0, 16));
    OK(triptych_set_stream(device, 1, other, 0, 32));
    OK(triptych_set_stream_frequency(device, 0, TRIPTYCH_FREQUENCY_INDEXED, 3));
    OK(triptych_set_stream_frequency(device, 1, TRIPTYCH_FREQUENCY_INSTANCE, 1));
    OK(triptych_set_indices(device, indices, 16));
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 0, 2));
    read_numbers(0);
    EXPECT_CENTRE("the third of three instances", 9, 10, 11, 12);
    OK(triptych_set_stream_frequency(device, 0, TRIPTYCH_FREQUENCY_INDEXED, 4));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 0, 2));
    TEST_ASSERT_EQUAL_STRING("vertex 3: v1 lies past its buffer, which ends with vertex 2",
                             triptych_error(device));
    OK(triptych_set_stream(device, 1, NULL, 0, 0));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 0, 2));
    TEST_ASSERT_EQUAL_STRING("v1: no buffer in stream 1, expected set_stream first", triptych_error(device));
}

static void test_inputs_step_with_instances_and_are_checked(void)
{
    on_every_engine(check_instances);
}

static void check_packed_formats(void)
{
    static const struct {
        float position[4];
        uint32_t color;
        int16_t shorts[2];
    } vertex[4] = {{{-1, 1, 0, 1}, 0x80ff4000, {-3, 7}},
                   {{1, 1, 0, 1}, 0x80ff4000, {-3, 7}},
                   {{-1, -1, 0, 1}, 0x80ff4000, {-3, 7}},
                   {{1, -1, 0, 1}, 0x80ff4000, {-3, 7}}};
    static const struct triptych_declaration_element declared[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITION, 0},
        {0, 16, TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_TESSFACTOR, 1},
        {0, 20, TRIPTYCH_FORMAT_SHORT2, TRIPTYCH_USAGE_FOG, 4}};
    triptych_buffer *buffer;
    use_float_target();
    OK(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    OK(triptych_set_declaration(device, declared, 3));
    OK(triptych_set_stream(device, 0, buffer, 0, sizeof vertex[0]));
    use_shaders(
        "vs_2_0\ndcl_position v0\ndcl_tessfactor1 v3\ndcl_fog4 v9\nmov oPos, v0\nmov oT0, v3\nmov oT1, v9\n",
        "ps_2_0\ndcl t0\ndcl t1\nmov r0, t0\nadd r0, r0, t1\nmov oC0, r0\n");
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    read_numbers(0);
    float byte = 1.0f / 255;
    EXPECT_CENTRE("a colour and two shorts", 255 * byte - 3, 64 * byte + 7, 0, 128 * byte + 1);
}

static void test_inputs_have_any_format(void)
{
    on_every_engine(check_packed_formats);
}

static void check_window(void)
{
    static const float corners[4][4] = {
        {0, 0, 0.5f, 1}, {SIZE, 0, 0.5f, 1}, {0, SIZE, 0.5f, 1}, {SIZE, SIZE, 0.5f, 1}};
    struct drawn_element color = drawn_constant(TRIPTYCH_USAGE_COLOR, 0, 0.25f, 0.5f, 0.75f, 0.5f);
    use_float_target();
    memcpy(drawn_position, corners, sizeof corners);
    use_shaders("vs_2_0\ndcl_position v0\nmov oPos, v0\nmov oD0, v0.x\n", "ps_2_0\ndcl v0\nmov oC0, v0\n");
    draw_declared(TRIPTYCH_USAGE_POSITIONT, &color, 1);
    read_numbers(0);
    EXPECT_CENTRE("processed already", 0.25f, 0.5f, 0.75f, 0.5f);
    drawn_begin();
}

static void test_vertices_in_the_window_are_not_processed(void)
{
    on_every_engine(check_window);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_elements_of_every_usage_reach_the_shader);
    RUN_TEST(test_elements_that_are_missing_are_0_0_0_1);
    RUN_TEST(test_inputs_step_with_instances_and_are_checked);
    RUN_TEST(test_inputs_have_any_format);
    RUN_TEST(test_vertices_in_the_window_are_not_processed);
    return UNITY_END();
}
