#include "setting.h"

#include "emu/emulate/emulate.h"

#include <assert.h>
#include <string.h>
#include <unity.h>

triptych_device *setting_device;
static triptych_buffer *buffer[2];
static triptych_texture *texture[SETTING_VARIANTS];
static triptych_shader *shader[SHADER_STAGES];
static triptych_query *query;

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(setting_device))

static void set_transform(unsigned which, unsigned variant)
{
    const float v = (float)variant;
    const float matrix[SETTING_VARIANTS][4][4] = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}},
                                                  {{2, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1}, {0, 0, -1, 0}},
                                                  {{v, 0, 1, 0}, {0, v, 0, 0}, {1, 0, v, 0}, {v, 0, 0, 1}},
                                                  {{0, v, 0, 0}, {v, 0, 0, 0}, {0, 0, v, 0}, {0, v, 0, 1}}};
    OK(triptych_set_transform(setting_device, (enum triptych_transform)which, matrix[variant % 4]));
}

static void set_world(unsigned variant)
{
    set_transform(TRIPTYCH_TRANSFORM_WORLD, variant);
}

static void set_view(unsigned variant)
{
    set_transform(TRIPTYCH_TRANSFORM_VIEW, variant);
}

static void set_projection(unsigned variant)
{
    set_transform(TRIPTYCH_TRANSFORM_PROJECTION, variant);
}

static void set_texture_matrix(unsigned variant)
{
    set_transform(TRIPTYCH_TRANSFORM_TEXTURE0 + variant / 4, variant);
}

static void set_second_world(unsigned variant)
{
    set_transform(TRIPTYCH_TRANSFORM_WORLD1 + variant % 3, variant);
}

static void set_viewport(unsigned variant)
{
    const float v = (float)variant;
    const struct triptych_viewport viewport = {
        v, v, 50 - 2 * v, 40 - v, variant & 1 ? 0.25f : 0, variant & 2 ? 0.75f : 1};
    OK(triptych_set_viewport(setting_device, &viewport));
}

static void set_scissor(unsigned variant)
{
    OK(triptych_set_scissor(setting_device, variant, 2 * variant, 20, 30 - variant));
}

static void set_clip_plane(unsigned variant)
{
    OK(triptych_set_clip_plane(setting_device, variant % TRIPTYCH_CLIP_PLANES,
                               (float[]){1, 2, (float)variant, 4}));
}

static void set_convention(unsigned variant)
{
    unsigned which = variant % TRIPTYCH_CONVENTION_COUNT;
    OK(triptych_set_convention(setting_device, which, !setting_device->state.convention[which]));
}

static void set_material(unsigned variant)
{
    struct triptych_material material = setting_device->state.material;
    float *values = (float *)(void *)&material;
    values[3 * variant % (sizeof material / sizeof(float))] += 0.25f;
    OK(triptych_set_material(setting_device, &material));
}

static void set_power(unsigned variant)
{
    struct triptych_material material = setting_device->state.material;
    material.power = (float)variant / 2;
    OK(triptych_set_material(setting_device, &material));
}

static void set_light(unsigned variant)
{
    struct triptych_light light = setting_device->state.light[variant & 1 ? 3 : 0];
    light.type = (enum triptych_light_type)(variant % 3);
    light.falloff = (float)(variant / 4);
    light.phi = 1;
    light.theta = 0.5f;
    light.diffuse[0] += 0.125f;
    OK(triptych_set_light(setting_device, variant & 1 ? 3 : 0, &light));
}

static void set_light_color(unsigned variant)
{
    unsigned i = variant & 1 ? 3 : 0;
    struct triptych_light light = setting_device->state.light[i];
    light.diffuse[variant % 3] += 0.125f;
    light.direction[0] += 1;
    light.position[2] += 1;
    OK(triptych_set_light(setting_device, i, &light));
}

static void enable_light(unsigned variant)
{
    OK(triptych_enable_light(setting_device, variant / 2, variant & 1));
}

static void set_texture(unsigned variant)
{
    OK(triptych_set_texture(setting_device, 0, texture[variant]));
}

static void set_other_texture(unsigned variant)
{
    OK(triptych_set_texture(setting_device, variant & 1 ? 1 : TRIPTYCH_VERTEX_SAMPLER + 3,
                            texture[variant / 2]));
}

static void set_element(unsigned variant)
{
    static const enum triptych_attribute attribute[] = {TRIPTYCH_POSITION, TRIPTYCH_NORMAL, TRIPTYCH_DIFFUSE,
                                                        TRIPTYCH_POSITIONT};
    const struct triptych_element element = {variant & 1 ? TRIPTYCH_FORMAT_FLOAT4 : TRIPTYCH_FORMAT_NONE,
                                             variant & 1 ? buffer[0] : NULL, 16, 32};
    OK(triptych_set_element(setting_device, attribute[variant / 2], &element));
}

static void set_declaration(unsigned variant)
{
    const struct triptych_declaration_element elements[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {0, 12, TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 0},
        {1, 0, TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_USAGE_TEXCOORD, 0},
        {1, 8, TRIPTYCH_FORMAT_UBYTE4, TRIPTYCH_USAGE_BLENDINDICES, 0}};
    OK(triptych_set_declaration(setting_device, elements, 1 + variant % 4));
    OK(triptych_set_stream(setting_device, 0, buffer[0], 0, 16));
}

static void set_fvf(unsigned variant)
{
    OK(triptych_set_fvf(setting_device, variant & 1 ? 0x042 : 0x112));
    OK(triptych_set_stream(setting_device, 0, buffer[0], 0, 32));
}

static void set_stream(unsigned variant)
{
    OK(triptych_set_stream(setting_device, variant / 4, variant & 1 ? buffer[variant & 2 ? 1 : 0] : NULL,
                           4 * variant, 16));
}

static void set_frequency(unsigned variant)
{
    if (variant & 1)
        OK(triptych_set_stream_frequency(setting_device, 1, TRIPTYCH_FREQUENCY_INSTANCE, 1 + variant));
    else
        OK(triptych_set_stream_frequency(setting_device, 0, TRIPTYCH_FREQUENCY_INDEXED, 1 + variant));
}

static void set_vertex_shader(unsigned variant)
{
    OK(triptych_set_vertex_shader(setting_device, variant & 1 ? shader[STAGE_VERTEX] : NULL));
}

static void set_pixel_shader(unsigned variant)
{
    OK(triptych_set_pixel_shader(setting_device, variant & 1 ? shader[STAGE_PIXEL] : NULL));
}

static void set_booleans(unsigned variant)
{
    const int32_t values[4] = {variant & 1, variant & 2, variant & 4, 1};
    OK(triptych_set_shader_booleans(setting_device, variant & 1, 2, values, 4));
}

static void set_target(unsigned variant)
{
    const struct triptych_target_description description = {
        .width = 50 + variant,
        .height = 60,
        .depth_format = (enum triptych_depth_format)(variant % TRIPTYCH_DEPTH_COUNT),
        .samples = variant & 4 ? 4 : 1};
    OK(triptych_set_target_description(setting_device, &description));
}

void setting_count_pixels(unsigned variant)
{
    OK(variant & 1 ? triptych_query_end(setting_device, query) : triptych_query_begin(setting_device, query));
}

static void destroy_buffer(unsigned variant)
{
    (void)variant;
    OK(triptych_buffer_destroy(setting_device, buffer[1]));
    OK(triptych_buffer_create(setting_device, "0123456789abcdef0123456789abcdef", 32, &buffer[1]));
    OK(triptych_set_stream(setting_device, 1, buffer[1], 0, 8));
}

const struct setting settings[] = {
    {"world", set_world},
    {"view", set_view},
    {"projection", set_projection},
    {"texture matrix", set_texture_matrix},
    {"world 1", set_second_world},
    {"viewport", set_viewport},
    {"scissor", set_scissor},
    {"clip plane", set_clip_plane},
    {"convention", set_convention},
    {"material", set_material},
    {"power", set_power},
    {"light", set_light},
    {"light's colour", set_light_color},
    {"enable light", enable_light},
    {"texture", set_texture},
    {"other textures", set_other_texture},
    {"element", set_element},
    {"declaration", set_declaration},
    {"fvf", set_fvf},
    {"stream", set_stream},
    {"frequency", set_frequency},
    {"vertex shader", set_vertex_shader},
    {"pixel shader", set_pixel_shader},
    {"Boolean constants", set_booleans},
    {"target", set_target},
    {"query", setting_count_pixels},
    {"end of a buffer", destroy_buffer},
};

static_assert(sizeof settings / sizeof *settings == SETTINGS, "a setting for each name");

static void make_texture(unsigned i, enum triptych_texture_type type, enum triptych_surface_format format,
                         unsigned size, unsigned levels)
{
    const struct triptych_texture_description description = {
        type, format, size, size, type == TRIPTYCH_TEXTURE_VOLUME ? size : 1, levels};
    OK(triptych_texture_define(setting_device, &description, &texture[i]));
}

static triptych_shader *make_shader(const char *text)
{
    triptych_shader *made;
    OK(triptych_shader_assemble(setting_device, NULL, text, strlen(text), &made));
    return made;
}

void setting_begin(void)
{
    static const uint8_t bytes[64];
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(&engine_emulate, &(struct device_options){.threads = 1},
                                                     &setting_device, NULL));
    OK(triptych_set_target(setting_device, 60, 60));
    OK(triptych_buffer_create(setting_device, bytes, 64, &buffer[0]));
    OK(triptych_buffer_create(setting_device, bytes, 32, &buffer[1]));
    OK(triptych_query_create(setting_device, TRIPTYCH_QUERY_OCCLUSION, &query));
    texture[0] = NULL;
    make_texture(1, TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 8, 1);
    make_texture(2, TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 16, 1);
    make_texture(3, TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 12, 1);
    make_texture(4, TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 8, 2);
    make_texture(5, TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_A8R8G8B8, 8, 1);
    make_texture(6, TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_A8R8G8B8, 8, 1);
    make_texture(7, TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_R32F, 8, 1);
    shader[STAGE_VERTEX] = make_shader("vs_2_0\ndcl_position v0\ndcl_texcoord v1\nmov oPos, v0\nif b3\n"
                                       "mov oT0, v1\nelse\nmov oT0, v0\nendif\nmov oD0, v0\n");
    shader[STAGE_PIXEL] =
        make_shader("ps_2_0\ndcl t0\ndcl_2d s0\ntexld r0, t0, s0\nmul r0, r0, c0\nmov oC0, r0\n");
}

void setting_end(void)
{
    triptych_device_destroy(setting_device);
    setting_device = NULL;
}
