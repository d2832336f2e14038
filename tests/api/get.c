/* Every getter returns what its setter has set, and refuses what its setter refuses. */
#include "triptych.h"

#include <string.h>
#include <unity.h>

enum { SIDE = 32 };

static triptych_device *device;

static void good(enum triptych_result result)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, result, triptych_error(device));
}

static void refused(enum triptych_result result, const char *reason)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, result);
    TEST_ASSERT_EQUAL_STRING(reason, triptych_error(device));
}

void setUp(void)
{
    const struct triptych_options options = {.engine = "emulate", .threads = 1};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &device, NULL, 0));
    good(triptych_set_target(device, SIDE, SIDE));
}

void tearDown(void)
{
    triptych_device_destroy(device);
}

static void states_start_with_their_defaults(void)
{
    uint32_t value;
    for (unsigned row = 0; row < TRIPTYCH_STATE_COUNT; row++) {
        good(triptych_get_state(device, (enum triptych_state)row, &value));
        TEST_ASSERT_EQUAL_HEX32(triptych_state_default(TRIPTYCH_RENDER_STATES, row, 0), value);
    }
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        for (unsigned row = 0; row < TRIPTYCH_SAMPLER_STATE_COUNT; row++) {
            good(triptych_get_sampler_state(device, i, (enum triptych_sampler_state)row, &value));
            TEST_ASSERT_EQUAL_HEX32(triptych_state_default(TRIPTYCH_SAMPLER_STATES, row, i), value);
        }
    for (unsigned i = 0; i < TRIPTYCH_STAGES; i++)
        for (unsigned row = 0; row < TRIPTYCH_STAGE_STATE_COUNT; row++) {
            good(triptych_get_stage_state(device, i, (enum triptych_stage_state)row, &value));
            TEST_ASSERT_EQUAL_HEX32(triptych_state_default(TRIPTYCH_STAGE_STATES, row, i), value);
        }
}

static void states_have_the_values_that_were_set(void)
{
    uint32_t value;
    unsigned convention;
    good(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, TRIPTYCH_CULL_CW));
    good(triptych_get_state(device, TRIPTYCH_STATE_CULLMODE, &value));
    TEST_ASSERT_EQUAL_UINT(TRIPTYCH_CULL_CW, value);
    good(triptych_set_sampler_state(device, 17, TRIPTYCH_SAMPLER_MINFILTER, TRIPTYCH_FILTER_LINEAR));
    good(triptych_get_sampler_state(device, 17, TRIPTYCH_SAMPLER_MINFILTER, &value));
    TEST_ASSERT_EQUAL_UINT(TRIPTYCH_FILTER_LINEAR, value);
    good(triptych_set_stage_state(device, 3, TRIPTYCH_STAGE_COLOROP, TRIPTYCH_TEXTUREOP_LERP));
    good(triptych_get_stage_state(device, 3, TRIPTYCH_STAGE_COLOROP, &value));
    TEST_ASSERT_EQUAL_UINT(TRIPTYCH_TEXTUREOP_LERP, value);
    good(triptych_set_convention(device, TRIPTYCH_DEPTH_RANGE, TRIPTYCH_DEPTH_RANGE_MINUS));
    good(triptych_get_convention(device, TRIPTYCH_DEPTH_RANGE, &convention));
    TEST_ASSERT_EQUAL_UINT(TRIPTYCH_DEPTH_RANGE_MINUS, convention);
}

static void geometry_is_what_was_set(void)
{
    float matrix[4][4] = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}, {13, 14, 15, 16}}, found[4][4];
    good(triptych_set_transform(device, TRIPTYCH_TRANSFORM_TEXTURE7, matrix));
    good(triptych_get_transform(device, TRIPTYCH_TRANSFORM_TEXTURE7, found));
    TEST_ASSERT_EQUAL_MEMORY(matrix, found, sizeof matrix);
    const struct triptych_viewport viewport = {1, 2, 8, 9, 0.25f, 0.75f};
    struct triptych_viewport found_viewport;
    good(triptych_set_viewport(device, &viewport));
    good(triptych_get_viewport(device, &found_viewport));
    TEST_ASSERT_EQUAL_MEMORY(&viewport, &found_viewport, sizeof viewport);
    struct triptych_rectangle scissor;
    good(triptych_get_scissor(device, &scissor));
    TEST_ASSERT_EQUAL_UINT(SIDE, scissor.width);
    good(triptych_set_scissor(device, 3, 4, 5, 6));
    good(triptych_get_scissor(device, &scissor));
    TEST_ASSERT_EQUAL_MEMORY((&(struct triptych_rectangle){3, 4, 5, 6}), &scissor, sizeof scissor);
    const float plane[4] = {1, -2, 3, -4};
    float found_plane[4];
    good(triptych_set_clip_plane(device, 5, plane));
    good(triptych_get_clip_plane(device, 5, found_plane));
    TEST_ASSERT_EQUAL_MEMORY(plane, found_plane, sizeof plane);
}

static void light_is_what_was_set(void)
{
    const struct triptych_material material = {.diffuse = {1, 0.5f, 0.25f, 1}, .power = 3};
    struct triptych_material found_material;
    good(triptych_set_material(device, &material));
    good(triptych_get_material(device, &found_material));
    TEST_ASSERT_EQUAL_MEMORY(&material, &found_material, sizeof material);
    const struct triptych_light light = {
        .type = TRIPTYCH_LIGHT_POINT, .diffuse = {1, 1, 0, 1}, .range = 10, .attenuation = {1, 0, 0}};
    struct triptych_light found_light;
    int enabled = -1;
    good(triptych_set_light(device, 7, &light));
    good(triptych_get_light(device, 7, &found_light));
    TEST_ASSERT_EQUAL_MEMORY(&light, &found_light, sizeof light);
    good(triptych_get_light_enable(device, 7, &enabled));
    TEST_ASSERT_EQUAL_INT(0, enabled);
    good(triptych_enable_light(device, 7, 5));
    good(triptych_get_light_enable(device, 7, &enabled));
    TEST_ASSERT_EQUAL_INT(1, enabled);
}

static void objects_are_those_that_were_set(void)
{
    const uint32_t texel = 0xffffffff;
    static const char vertex[] = "vs_2_0\ndcl_position v0\nmov oPos, v0\n", pixel[] = "ps_2_0\nmov oC0, c0\n";
    triptych_texture *texture, *found_texture = NULL;
    triptych_shader *shader[2], *found[2] = {NULL, NULL};
    good(triptych_texture_create(device, &texel, 1, 1, &texture));
    good(triptych_set_texture(device, 19, texture));
    good(triptych_get_texture(device, 19, &found_texture));
    TEST_ASSERT_EQUAL_PTR(texture, found_texture);
    good(triptych_get_texture(device, 18, &found_texture));
    TEST_ASSERT_NULL(found_texture);
    good(triptych_shader_assemble(device, NULL, vertex, strlen(vertex), &shader[0]));
    good(triptych_shader_assemble(device, NULL, pixel, strlen(pixel), &shader[1]));
    good(triptych_set_vertex_shader(device, shader[0]));
    good(triptych_set_pixel_shader(device, shader[1]));
    good(triptych_get_vertex_shader(device, &found[0]));
    good(triptych_get_pixel_shader(device, &found[1]));
    TEST_ASSERT_EQUAL_MEMORY(shader, found, sizeof shader);
    good(triptych_shader_destroy(device, shader[1]));
    good(triptych_get_pixel_shader(device, &found[1]));
    TEST_ASSERT_NULL(found[1]);
}

static void constants_are_what_was_set(void)
{
    const float floats[2][4] = {{1, 2, 3, 4}, {5, 6, 7, 8}};
    const int32_t integers[4] = {9, 8, 7, 6}, booleans[3] = {1, 0, 7};
    float found_floats[3][4];
    int32_t found[4];
    good(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 10, floats[0], 2));
    good(triptych_get_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 10, found_floats[0], 3));
    TEST_ASSERT_EQUAL_MEMORY(floats, found_floats, sizeof floats);
    TEST_ASSERT_EQUAL_FLOAT(0, found_floats[2][0]);
    good(triptych_set_shader_integers(device, TRIPTYCH_SHADER_VERTEX, 15, integers, 1));
    good(triptych_get_shader_integers(device, TRIPTYCH_SHADER_VERTEX, 15, found, 1));
    TEST_ASSERT_EQUAL_MEMORY(integers, found, sizeof integers);
    good(triptych_set_shader_booleans(device, TRIPTYCH_SHADER_VERTEX, 13, booleans, 3));
    good(triptych_get_shader_booleans(device, TRIPTYCH_SHADER_VERTEX, 13, found, 3));
    TEST_ASSERT_EQUAL_INT32_ARRAY(((const int32_t[3]){1, 0, 1}), found, 3);
    good(triptych_get_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, NULL, 0));
    refused(triptych_get_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 8191, found_floats[0], 2),
            "float constants 8191 to 8192: expected them below 8192");
}

static void vertices_are_what_was_set(void)
{
    static const struct triptych_declaration_element declared[] = {
        {1, 4, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {2, 8, TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_USAGE_TANGENT, 3},
    };
    struct triptych_declaration_element found[TRIPTYCH_DECLARATION_ELEMENTS];
    struct triptych_element element;
    const float data[16] = {0};
    triptych_buffer *buffer, *bound;
    unsigned count, bits;
    size_t offset, stride;
    enum triptych_frequency frequency;
    uint32_t repeats;
    good(triptych_buffer_create(device, data, sizeof data, &buffer));
    TEST_ASSERT_EQUAL_UINT(sizeof data, triptych_buffer_get_bytes(buffer));
    good(triptych_set_declaration(device, declared, 2));
    good(triptych_set_element(device, TRIPTYCH_NORMAL,
                              &(struct triptych_element){TRIPTYCH_FORMAT_FLOAT3, buffer, 1, 13}));
    refused(triptych_get_declaration(device, found, 1, &count),
            "an array of 1 elements: expected at least 2");
    good(triptych_get_declaration(device, found, 2, &count));
    TEST_ASSERT_EQUAL_UINT(2, count);
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_UINT(declared[i].stream, found[i].stream);
        TEST_ASSERT_EQUAL_UINT(declared[i].offset, found[i].offset);
        TEST_ASSERT_EQUAL_INT(declared[i].format, found[i].format);
        TEST_ASSERT_EQUAL_INT(declared[i].usage, found[i].usage);
        TEST_ASSERT_EQUAL_UINT(declared[i].usage_index, found[i].usage_index);
    }
    good(triptych_get_element(device, TRIPTYCH_NORMAL, &element));
    TEST_ASSERT_EQUAL_PTR(buffer, element.buffer);
    TEST_ASSERT_EQUAL_UINT(13, element.stride);
    good(triptych_get_element(device, TRIPTYCH_POSITION, &element));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_FORMAT_NONE, element.format);
    good(triptych_set_stream(device, 15, buffer, 8, 16));
    good(triptych_get_stream(device, 15, &bound, &offset, &stride));
    TEST_ASSERT_EQUAL_PTR(buffer, bound);
    TEST_ASSERT_EQUAL_UINT(8, offset);
    TEST_ASSERT_EQUAL_UINT(16, stride);
    good(triptych_get_stream_frequency(device, 15, &frequency, &repeats));
    TEST_ASSERT_EQUAL_UINT(1, repeats);
    good(triptych_set_stream_frequency(device, 15, TRIPTYCH_FREQUENCY_INSTANCE, 4));
    good(triptych_get_stream_frequency(device, 15, &frequency, &repeats));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_FREQUENCY_INSTANCE, frequency);
    TEST_ASSERT_EQUAL_UINT(4, repeats);
    good(triptych_set_indices(device, buffer, 32));
    good(triptych_get_indices(device, &bound, &bits));
    TEST_ASSERT_EQUAL_PTR(buffer, bound);
    TEST_ASSERT_EQUAL_UINT(32, bits);
    good(triptych_buffer_destroy(device, buffer));
    good(triptych_get_indices(device, &bound, &bits));
    TEST_ASSERT_NULL(bound);
    TEST_ASSERT_EQUAL_UINT(0, bits);
}

static void a_vertex_format_code_is_a_declaration(void)
{
    struct triptych_declaration_element found[TRIPTYCH_DECLARATION_ELEMENTS];
    unsigned count;
    good(triptych_set_fvf(device, TRIPTYCH_FVF_XYZ | TRIPTYCH_FVF_NORMAL | TRIPTYCH_FVF_TEX1));
    good(triptych_get_declaration(device, found, TRIPTYCH_DECLARATION_ELEMENTS, &count));
    TEST_ASSERT_EQUAL_UINT(3, count);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_USAGE_NORMAL, found[1].usage);
    TEST_ASSERT_EQUAL_UINT(12, found[1].offset);
    TEST_ASSERT_EQUAL_UINT(24, found[2].offset);
}

static void textures_that_are_targets_are_found(void)
{
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 16, 8, 1, 0};
    struct triptych_texture_description described;
    struct triptych_target_surfaces textures = {.depth_format = TRIPTYCH_DEPTH_NONE}, found;
    good(triptych_texture_define(device, &description, &textures.color[0].texture));
    triptych_texture_get_description(textures.color[0].texture, &described);
    TEST_ASSERT_EQUAL_UINT(16, described.width);
    TEST_ASSERT_EQUAL_UINT(5, described.levels);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_SURFACE_A8R8G8B8, described.format);
    good(triptych_get_target_surfaces(device, &found));
    TEST_ASSERT_NULL(found.color[0].texture);
    good(triptych_set_target_surfaces(device, &textures));
    good(triptych_get_target_surfaces(device, &found));
    TEST_ASSERT_EQUAL_PTR(textures.color[0].texture, found.color[0].texture);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_DEPTH_NONE, found.depth_format);
}

static void an_index_out_of_range_is_refused(void)
{
    uint32_t value = 77;
    int enabled;
    float numbers[4][4];
    triptych_texture *texture;
    refused(triptych_get_state(device, TRIPTYCH_STATE_COUNT, &value), "state 117: expected 0 to 116");
    TEST_ASSERT_EQUAL_UINT(77, value);
    refused(triptych_get_sampler_state(device, TRIPTYCH_SAMPLERS, TRIPTYCH_SAMPLER_ADDRESSU, &value),
            "sampler 20: expected 0 to 19");
    refused(triptych_get_stage_state(device, 0, TRIPTYCH_STAGE_STATE_COUNT, &value),
            "stage state 18: expected 0 to 17");
    refused(triptych_get_transform(device, TRIPTYCH_TRANSFORM_COUNT, numbers),
            "transform 266: expected 0 to 265");
    refused(triptych_get_clip_plane(device, TRIPTYCH_CLIP_PLANES, numbers[0]),
            "clip plane 6: expected 0 to 5");
    refused(triptych_get_light_enable(device, TRIPTYCH_LIGHTS, &enabled), "light 8: expected 0 to 7");
    refused(triptych_get_texture(device, TRIPTYCH_SAMPLERS, &texture), "sampler 20: expected 0 to 19");
    refused(triptych_get_state(device, TRIPTYCH_STATE_CULLMODE, NULL), "result is null");
}

static void null_objects_have_no_properties(void)
{
    struct triptych_texture_description description = {.width = 9};
    triptych_texture_get_description(NULL, &description);
    triptych_texture_get_description(NULL, NULL);
    TEST_ASSERT_EQUAL_UINT(0, description.width);
    TEST_ASSERT_EQUAL_UINT(0, triptych_buffer_get_bytes(NULL));
    TEST_ASSERT_NULL(triptych_get_engine(NULL));
    TEST_ASSERT_EQUAL_STRING("emulate", triptych_get_engine(device));
}

static void tables_tolerate_null_and_numbers_out_of_range(void)
{
    const struct triptych_kind *kind = triptych_kind_at(0);
    uint32_t number = 5;
    TEST_ASSERT_NULL(triptych_value_at(NULL, 0));
    TEST_ASSERT_NULL(triptych_value_find(NULL, 0));
    TEST_ASSERT_NULL(triptych_value_word(NULL, 0));
    TEST_ASSERT_NOT_EQUAL(0, triptych_value_number(NULL, "none", &number));
    TEST_ASSERT_NOT_EQUAL(0, triptych_value_number(kind, NULL, &number));
    TEST_ASSERT_NOT_EQUAL(0, triptych_value_number(kind, "true", NULL));
    TEST_ASSERT_EQUAL_UINT(5, number);
    TEST_ASSERT_NULL(triptych_kind_at(1000));
    TEST_ASSERT_NULL(triptych_value_at(kind, 1000));
    TEST_ASSERT_NULL(triptych_state_at(TRIPTYCH_STATE_TABLE_COUNT, 0));
    TEST_ASSERT_NULL(triptych_state_at(TRIPTYCH_RENDER_STATES, TRIPTYCH_STATE_COUNT));
    TEST_ASSERT_NULL(triptych_table_name(TRIPTYCH_STATE_TABLE_COUNT));
    TEST_ASSERT_EQUAL_UINT(0, triptych_state_default(TRIPTYCH_STAGE_STATES, 1000, 0));
    TEST_ASSERT_EQUAL_UINT(0, triptych_depth_bits(TRIPTYCH_DEPTH_COUNT));
    TEST_ASSERT_NULL(triptych_engine_name(1000));
    TEST_ASSERT_NULL(triptych_shader_get_model(NULL));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(states_start_with_their_defaults);
    RUN_TEST(states_have_the_values_that_were_set);
    RUN_TEST(geometry_is_what_was_set);
    RUN_TEST(light_is_what_was_set);
    RUN_TEST(objects_are_those_that_were_set);
    RUN_TEST(constants_are_what_was_set);
    RUN_TEST(vertices_are_what_was_set);
    RUN_TEST(a_vertex_format_code_is_a_declaration);
    RUN_TEST(textures_that_are_targets_are_found);
    RUN_TEST(an_index_out_of_range_is_refused);
    RUN_TEST(null_objects_have_no_properties);
    RUN_TEST(tables_tolerate_null_and_numbers_out_of_range);
    return UNITY_END();
}
