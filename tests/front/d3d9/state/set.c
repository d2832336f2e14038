/* Values of a device (front/d3d9/state): getters return what was set, the renderer gets what it accepts;
 * declarations, vertex format codes, shaders and constants. */
#include "front/d3d9/state/declaration.h"
#include "tests/support/front/device.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { INVALID = D3D9_INVALID_CALL };
/* D3DDECLTYPE, D3DDECLUSAGE. */
enum { FLOAT1, FLOAT2, FLOAT3, FLOAT4, COLOR, UBYTE4, UNUSED = 17 };
enum { POSITION, WEIGHT, INDICES, NORMAL, PSIZE, TEXCOORD, POSITIONT = 9, COLORS = 10 };

static struct d3d9_device *device;

void setUp(void)
{
    device = bare_device_make(D3D9_CREATE_HARDWARE_VERTICES);
}

void tearDown(void)
{
    bare_device_free(device);
}

/* --- States --- */

static void any_value_of_a_state_is_returned(void)
{
    static const uint32_t values[] = {0, 1, 2, 77, 0x7fc00000, 0xffffffff};
    for (uint32_t state = 0; state < 256; state++)
        for (unsigned i = 0; i < sizeof values / sizeof *values; i++) {
            uint32_t value = 5;
            TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_render_state(device, state, values[i]));
            TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_render_state(device, state, &value));
            TEST_ASSERT_EQUAL_HEX32(values[i], value);
        }
}

static void expect_renderer(uint32_t number, enum triptych_state state, uint32_t set, uint32_t expected)
{
    uint32_t value;
    d3d9_device_set_render_state(device, number, set);
    triptych_get_state(device->renderer, state, &value);
    TEST_ASSERT_EQUAL_HEX32(expected, value);
}

static void the_renderer_gets_values_that_exist(void)
{
    expect_renderer(137, TRIPTYCH_STATE_LIGHTING, 128, 1);
    expect_renderer(24, TRIPTYCH_STATE_ALPHAREF, 0x1ff, 0xff);
    expect_renderer(152, TRIPTYCH_STATE_CLIPPLANEENABLE, 0x80000041, 1);
    expect_renderer(38, TRIPTYCH_STATE_FOGDENSITY, 0x7fc00000, 0);
    expect_renderer(37, TRIPTYCH_STATE_FOGEND, 0x7f800000, 0x7f7fffff);
    expect_renderer(154, TRIPTYCH_STATE_POINTSIZE, 0xbf800000, 0);
    expect_renderer(209, TRIPTYCH_STATE_BLENDOPALPHA, 0, TRIPTYCH_BLENDOP_ADD);
    expect_renderer(22, TRIPTYCH_STATE_CULLMODE, 2, TRIPTYCH_CULL_CW);
}

/* Every state of every sampler and stage takes any value without an error of the renderer. */
static void no_value_makes_the_renderer_fail(void)
{
    srand(7);
    for (int i = 0; i < 20000; i++) {
        uint32_t value = rand() % 2 ? (uint32_t)rand() % 32 : (uint32_t)rand() * 5u;
        d3d9_device_set_render_state(device, (uint32_t)rand() % 210, value);
        d3d9_device_set_sampler_state(device, (uint32_t)rand() % 300, (uint32_t)rand() % 16, value);
        d3d9_device_set_texture_stage_state(device, (uint32_t)rand() % 10, (uint32_t)rand() % 34, value);
    }
    TEST_ASSERT_EQUAL_STRING("", triptych_error(device->renderer));
}

static void numbers_of_transforms_lights_and_materials_become_finite(void)
{
    struct d3d9_matrix matrix = {{{NAN, INFINITY, 1, 2}}}, got;
    struct d3d9_material material = {.diffuse = {NAN, 1, 2, 3}, .power = -1};
    struct d3d9_light light = {.type = 2, .range = INFINITY, .theta = 9, .phi = 7};
    float plane[4] = {NAN, -INFINITY, 0, 1};
    d3d9_device_set_transform(device, 256, &matrix);
    d3d9_device_get_transform(device, 256, &got);
    TEST_ASSERT_EQUAL_MEMORY(&matrix, &got, sizeof got);
    d3d9_device_set_material(device, &material);
    d3d9_device_set_light(device, 0, &light);
    d3d9_device_light_enable(device, 0, 1);
    d3d9_device_set_clip_plane(device, 0, plane);
    d3d9_lights_forward(device);
    TEST_ASSERT_EQUAL_STRING("", triptych_error(device->renderer));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_light(device, 0, &(struct d3d9_light){.type = 0}));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_get_transform(device, 4, &got));
}

/* --- Declarations --- */

static struct d3d9_vertex_element element(unsigned offset, unsigned type, unsigned usage, unsigned index)
{
    return (struct d3d9_vertex_element){.offset = (uint16_t)offset,
                                        .type = (uint8_t)type,
                                        .usage = (uint8_t)usage,
                                        .usage_index = (uint8_t)index};
}

static void expect_elements(uint32_t fvf, unsigned count, const struct d3d9_vertex_element *expected)
{
    struct d3d9_vertex_element elements[TRIPTYCH_DECLARATION_ELEMENTS];
    TEST_ASSERT_EQUAL_UINT32(count, d3d9_state_fvf_elements(fvf, elements));
    TEST_ASSERT_EQUAL_MEMORY(expected, elements, count * sizeof *elements);
}

static void codes_have_direct3d_s_elements(void)
{
    expect_elements(0x4002, 1, (struct d3d9_vertex_element[]){element(0, FLOAT4, POSITION, 0)});
    expect_elements(0x004, 1, (struct d3d9_vertex_element[]){element(0, FLOAT4, POSITIONT, 0)});
    expect_elements(0x010, 1, (struct d3d9_vertex_element[]){element(0, FLOAT3, NORMAL, 0)});
    expect_elements(0x00e, 3,
                    (struct d3d9_vertex_element[]){element(0, FLOAT3, POSITION, 0),
                                                   element(12, FLOAT4, WEIGHT, 0),
                                                   element(28, FLOAT1, INDICES, 0)});
    expect_elements(
        0x1006, 2,
        (struct d3d9_vertex_element[]){element(0, FLOAT3, POSITION, 0), element(12, UBYTE4, INDICES, 0)});
    expect_elements(0x8008, 3,
                    (struct d3d9_vertex_element[]){element(0, FLOAT3, POSITION, 0),
                                                   element(12, COLOR, WEIGHT, 0),
                                                   element(16, UBYTE4, INDICES, 0)});
    expect_elements(0x800a, 3,
                    (struct d3d9_vertex_element[]){element(0, FLOAT3, POSITION, 0),
                                                   element(12, FLOAT2, WEIGHT, 0),
                                                   element(20, COLOR, INDICES, 0)});
    /* position, normal, size, diffuse, specular, sets of 1, 3 and 4 numbers */
    expect_elements(
        0x003 << 16 | 1 << 18 | 2 << 20 | 0x3f2, 8,
        (struct d3d9_vertex_element[]){element(0, FLOAT3, POSITION, 0), element(12, FLOAT3, NORMAL, 0),
                                       element(24, FLOAT1, PSIZE, 0), element(28, COLOR, COLORS, 0),
                                       element(32, COLOR, COLORS, 1), element(36, FLOAT1, TEXCOORD, 0),
                                       element(40, FLOAT3, TEXCOORD, 1), element(52, FLOAT4, TEXCOORD, 2)});
}

static struct d3d9_declaration *current(void)
{
    struct d3d9_declaration *declaration = NULL;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_vertex_declaration(device, &declaration));
    return declaration;
}

static void a_code_has_one_declaration(void)
{
    uint32_t fvf;
    d3d9_device_set_fvf(device, 0x004);
    struct d3d9_declaration *first = current(), *second = current();
    TEST_ASSERT_EQUAL_PTR(first, second);
    d3d9_device_set_fvf(device, 0x042);
    struct d3d9_declaration *other = current();
    TEST_ASSERT_TRUE(other != first);
    d3d9_device_set_fvf(device, 0);
    d3d9_device_get_fvf(device, &fvf);
    TEST_ASSERT_EQUAL_HEX32(0x042, fvf);
    d3d9_device_set_fvf(device, 0x004);
    struct d3d9_declaration *again = current();
    TEST_ASSERT_EQUAL_PTR(first, again);
    TEST_ASSERT_EQUAL_UINT32(3, first->object.references);
    TEST_ASSERT_EQUAL_UINT32(1, other->object.references);
    for (int i = 0; i < 3; i++)
        d3d9_object_release(&first->object);
    d3d9_object_release(&other->object);
}

static int32_t create(struct d3d9_vertex_element last)
{
    struct d3d9_declaration *declaration = NULL;
    struct d3d9_vertex_element elements[3] = {
        element(0, FLOAT3, POSITION, 0), last, {.stream = 255, .type = UNUSED}};
    int32_t result = d3d9_device_create_vertex_declaration(device, elements, &declaration);
    if (declaration)
        d3d9_object_release(&declaration->object);
    return result;
}

static void declarations_that_no_device_has_are_refused(void)
{
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, create(element(16, COLOR, COLORS, 0)));
    TEST_ASSERT_EQUAL_INT32(D3D9_FAIL, create(element(17, COLOR, COLORS, 0)));
    TEST_ASSERT_EQUAL_INT32(D3D9_FAIL, create(element(16, UNUSED, COLORS, 0)));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, create(element(16, COLOR, POSITION, 0)));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_create_vertex_declaration(device, NULL, NULL));
}

/* --- Shaders --- */

static const uint32_t vertex_code[] = {0xfffe0101, 0x0000001f, 0x80000000, 0x900f0000,
                                       0x00000001, 0xc00f0000, 0x90e40000, 0x0000ffff};
static const uint32_t constant_256[] = {0xfffe0200, 0x0200001f, 0x80000000, 0x900f0000, 0x05000051,
                                        0xa00f0100, 0x3f800000, 0x3f800000, 0x3f800000, 0x3f800000,
                                        0x02000001, 0xd00f0000, 0xa0e40100, 0x02000001, 0xc00f0000,
                                        0x90e40000, 0x0000ffff};

static const uint32_t first_model_256[] = {0xfffe0101, 0x0000001f, 0x80000000, 0x900f0000, 0x00000051,
                                           0xa00f0100, 0x3f800000, 0x3f800000, 0x3f800000, 0x3f800000,
                                           0x00000002, 0x800f0000, 0x90e40000, 0xa0e40100, 0x00000001,
                                           0xc00f0000, 0x80e40000, 0x0000ffff};

static void shaders_return_their_code(void)
{
    struct d3d9_vertex_shader *shader = NULL, *bound = NULL;
    uint32_t code[8], bytes = 0;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_vertex_shader(device, vertex_code, &shader));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_vertex_shader_get_function(shader, NULL, &bytes));
    TEST_ASSERT_EQUAL_UINT32(sizeof vertex_code, bytes);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_vertex_shader_get_function(shader, code, &bytes));
    TEST_ASSERT_EQUAL_MEMORY(vertex_code, code, sizeof code);
    bytes = 4;
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_vertex_shader_get_function(shader, code, &bytes));
    d3d9_device_set_vertex_shader(device, shader);
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release((struct d3d9_object *)shader));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_vertex_shader(device, &bound));
    TEST_ASSERT_EQUAL_PTR(shader, bound);
    d3d9_object_release((struct d3d9_object *)bound);
}

static void shaders_that_are_not_valid_are_refused(void)
{
    struct d3d9_vertex_shader *vertex = NULL;
    struct d3d9_pixel_shader *pixel = NULL;
    const uint32_t wrong[] = {0xfffe0101, 0x00000099, 0x0000ffff};
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_create_vertex_shader(device, wrong, &vertex));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_create_pixel_shader(device, vertex_code, &pixel));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_create_vertex_shader(device, constant_256, &vertex));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_create_vertex_shader(device, first_model_256, &vertex));
    TEST_ASSERT_NULL(vertex);
}

static void software_devices_have_more_constants(void)
{
    struct d3d9_vertex_shader *shader = NULL;
    float four[4] = {1, 2, 3, 4}, got[4];
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_vertex_shader_constant_f(device, 256, four, 1));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_vertex_shader_constant_f(device, 255, four, 4));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_vertex_shader_constant_f(device, UINT32_MAX, four, 1));
    bare_device_free(device);
    device = bare_device_make(D3D9_CREATE_MIXED_VERTICES);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_vertex_shader_constant_f(device, 8191, four, 1));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_vertex_shader_constant_f(device, 8191, got, 1));
    TEST_ASSERT_EQUAL_MEMORY(four, got, sizeof got);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_vertex_shader_constant_f(device, 8192, four, 1));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_vertex_shader(device, constant_256, &shader));
    d3d9_object_release((struct d3d9_object *)shader);
}

/* A shader of model 1 has them too. The program gets back the code that it gave. */
static void software_devices_have_more_constants_in_model_1(void)
{
    struct d3d9_vertex_shader *shader = NULL;
    uint32_t code[sizeof first_model_256 / sizeof *first_model_256], bytes = sizeof code;
    bare_device_free(device);
    device = bare_device_make(D3D9_CREATE_SOFTWARE_VERTICES);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_vertex_shader(device, first_model_256, &shader));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_vertex_shader_get_function(shader, code, &bytes));
    TEST_ASSERT_EQUAL_MEMORY(first_model_256, code, sizeof code);
    d3d9_object_release((struct d3d9_object *)shader);
}

/* --- Streams --- */

static void frequencies_that_no_device_has_are_refused(void)
{
    enum { INDEXED = 1 << 30 };
    const uint32_t instance = UINT32_C(2) << 30;
    uint32_t frequency = 0;
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_stream_source_freq(device, 0, instance | 1));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_stream_source_freq(device, 1, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_stream_source_freq(device, 1, instance | INDEXED));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_stream_source_freq(device, 1, &frequency));
    TEST_ASSERT_EQUAL_UINT32(1, frequency);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_stream_source_freq(device, 1, instance));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_stream_source_freq(device, 1, &frequency));
    TEST_ASSERT_EQUAL_HEX32(instance, frequency);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(any_value_of_a_state_is_returned);
    RUN_TEST(the_renderer_gets_values_that_exist);
    RUN_TEST(no_value_makes_the_renderer_fail);
    RUN_TEST(numbers_of_transforms_lights_and_materials_become_finite);
    RUN_TEST(codes_have_direct3d_s_elements);
    RUN_TEST(a_code_has_one_declaration);
    RUN_TEST(declarations_that_no_device_has_are_refused);
    RUN_TEST(shaders_return_their_code);
    RUN_TEST(shaders_that_are_not_valid_are_refused);
    RUN_TEST(software_devices_have_more_constants);
    RUN_TEST(software_devices_have_more_constants_in_model_1);
    RUN_TEST(frequencies_that_no_device_has_are_refused);
    return UNITY_END();
}
