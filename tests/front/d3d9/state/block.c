/* State blocks (front/d3d9/state/block.c): which values belong to a type, recording, Capture and Apply. */
#include "front/d3d9/state/declaration.h"
#include "tests/support/front/device.h"

#include <string.h>
#include <unity.h>

enum { ALL = 1, PIXEL, VERTEX };
/* D3DRENDERSTATETYPE and the like. */
enum { ZENABLE = 7, CULLMODE = 22, FOGSTART = 36, LIGHTING = 137, MONITOR = 165, CCW_FUNC = 189 };
enum {
    TEXCOORDINDEX = 11,
    COLOROP = 1,
    ADDRESSU = 1,
    DMAPOFFSET = 13,
    WORLD = 256,
    INVALID = D3D9_INVALID_CALL
};

static struct d3d9_device *device;

void setUp(void)
{
    device = bare_device_make(D3D9_CREATE_HARDWARE_VERTICES);
}

void tearDown(void)
{
    bare_device_free(device);
}

static uint32_t render(uint32_t state)
{
    uint32_t value = 0xdeadbeef;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_render_state(device, state, &value));
    return value;
}

static struct d3d9_state_block *created(uint32_t type)
{
    struct d3d9_state_block *block = NULL;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_state_block(device, type, &block));
    return block;
}

static void release(void *object)
{
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(object));
}

/* Every value that has a setter, as a number. */
static void set_all(uint32_t value)
{
    float number = (float)value, four[4] = {number, number, number, number};
    int32_t integers[4] = {(int32_t)value, 0, 0, 0};
    struct d3d9_matrix matrix = {{{number}}};
    for (uint32_t i = 0; i < 256; i++)
        d3d9_device_set_render_state(device, i, value);
    for (uint32_t i = 0; i < 14; i++)
        d3d9_device_set_sampler_state(device, 3, i, value);
    for (uint32_t i = 0; i < 33; i++)
        d3d9_device_set_texture_stage_state(device, 2, i, value);
    d3d9_device_set_transform(device, WORLD, &matrix);
    d3d9_device_set_clip_plane(device, 1, four);
    d3d9_device_set_vertex_shader_constant_f(device, 5, four, 1);
    d3d9_device_set_pixel_shader_constant_f(device, 5, four, 1);
    d3d9_device_set_vertex_shader_constant_i(device, 5, integers, 1);
    d3d9_device_set_pixel_shader_constant_b(device, 5, integers, 1);
}

static uint32_t constant(bool vertex)
{
    float four[4];
    if (vertex)
        d3d9_device_get_vertex_shader_constant_f(device, 5, four, 1);
    else
        d3d9_device_get_pixel_shader_constant_f(device, 5, four, 1);
    return (uint32_t)four[0];
}

static uint32_t sampler(uint32_t state)
{
    uint32_t value;
    d3d9_device_get_sampler_state(device, 3, state, &value);
    return value;
}

static uint32_t stage(uint32_t state)
{
    uint32_t value;
    d3d9_device_get_texture_stage_state(device, 2, state, &value);
    return value;
}

/* Makes a block of the values 3, sets all to 5, and applies the block. */
static void restore(uint32_t type)
{
    set_all(3);
    struct d3d9_state_block *block = created(type);
    set_all(5);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_state_block_apply(block));
    release(block);
}

static void a_block_of_all_values_restores_all_but_the_monitor(void)
{
    struct d3d9_matrix matrix;
    restore(ALL);
    for (uint32_t i = 0; i < 256; i++)
        TEST_ASSERT_EQUAL_UINT32(d3d9_state_render_row(i) < 0 || i == MONITOR ? 5 : 3, render(i));
    TEST_ASSERT_EQUAL_UINT32(3, sampler(ADDRESSU));
    TEST_ASSERT_EQUAL_UINT32(3, stage(COLOROP));
    TEST_ASSERT_EQUAL_UINT32(3, constant(true));
    TEST_ASSERT_EQUAL_UINT32(3, constant(false));
    d3d9_device_get_transform(device, WORLD, &matrix);
    TEST_ASSERT_EQUAL_FLOAT(3, matrix.m[0][0]);
}

static void a_block_of_pixels_restores_what_belongs_to_pixels(void)
{
    struct d3d9_matrix matrix;
    restore(PIXEL);
    TEST_ASSERT_EQUAL_UINT32(3, render(ZENABLE));
    TEST_ASSERT_EQUAL_UINT32(3, render(FOGSTART));
    TEST_ASSERT_EQUAL_UINT32(5, render(CULLMODE));
    TEST_ASSERT_EQUAL_UINT32(5, render(LIGHTING));
    TEST_ASSERT_EQUAL_UINT32(5, render(CCW_FUNC));
    TEST_ASSERT_EQUAL_UINT32(3, sampler(ADDRESSU));
    TEST_ASSERT_EQUAL_UINT32(5, sampler(DMAPOFFSET));
    TEST_ASSERT_EQUAL_UINT32(3, stage(TEXCOORDINDEX));
    TEST_ASSERT_EQUAL_UINT32(5, constant(true));
    TEST_ASSERT_EQUAL_UINT32(3, constant(false));
    d3d9_device_get_transform(device, WORLD, &matrix);
    TEST_ASSERT_EQUAL_FLOAT(5, matrix.m[0][0]);
}

static void a_block_of_vertices_restores_what_belongs_to_vertices(void)
{
    restore(VERTEX);
    TEST_ASSERT_EQUAL_UINT32(5, render(ZENABLE));
    TEST_ASSERT_EQUAL_UINT32(3, render(FOGSTART));
    TEST_ASSERT_EQUAL_UINT32(3, render(CULLMODE));
    TEST_ASSERT_EQUAL_UINT32(3, render(LIGHTING));
    TEST_ASSERT_EQUAL_UINT32(5, sampler(ADDRESSU));
    TEST_ASSERT_EQUAL_UINT32(3, sampler(DMAPOFFSET));
    TEST_ASSERT_EQUAL_UINT32(3, stage(TEXCOORDINDEX));
    TEST_ASSERT_EQUAL_UINT32(5, stage(COLOROP));
    TEST_ASSERT_EQUAL_UINT32(3, constant(true));
    TEST_ASSERT_EQUAL_UINT32(5, constant(false));
}

static struct d3d9_state_block *recorded(void (*change)(void))
{
    struct d3d9_state_block *block = NULL;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_begin_state_block(device));
    change();
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_end_state_block(device, &block));
    return block;
}

static void lighting_off(void)
{
    float four[4] = {1, 2, 3, 4};
    d3d9_device_set_render_state(device, LIGHTING, 0);
    d3d9_device_set_vertex_shader_constant_f(device, 5, four, 1);
}

static void recording_changes_the_block_and_not_the_device(void)
{
    struct d3d9_state_block *block = recorded(lighting_off);
    TEST_ASSERT_EQUAL_UINT32(1, render(LIGHTING));
    TEST_ASSERT_EQUAL_UINT32(0, constant(true));
    d3d9_device_set_render_state(device, ZENABLE, 2);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_state_block_apply(block));
    TEST_ASSERT_EQUAL_UINT32(0, render(LIGHTING));
    TEST_ASSERT_EQUAL_UINT32(2, render(ZENABLE));
    TEST_ASSERT_EQUAL_UINT32(1, constant(true));
    d3d9_device_set_render_state(device, LIGHTING, 7);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_state_block_capture(block));
    d3d9_device_set_render_state(device, LIGHTING, 0);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_state_block_apply(block));
    TEST_ASSERT_EQUAL_UINT32(7, render(LIGHTING));
    release(block);
}

static void nothing(void)
{
}

static void one_block_is_recorded_at_a_time(void)
{
    struct d3d9_state_block *block = recorded(nothing), *other = NULL;
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_end_state_block(device, &other));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_begin_state_block(device));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_begin_state_block(device));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_state_block_apply(block));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_state_block_capture(block));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_create_state_block(device, ALL, &other));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_end_state_block(device, &other));
    release(block);
    release(other);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_create_state_block(device, 0, &other));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_create_state_block(device, 4, &other));
}

static void a_device_that_ends_while_it_records_frees_the_block(void)
{
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_begin_state_block(device));
    bare_device_free(device);
    device = bare_device_make(D3D9_CREATE_SOFTWARE_VERTICES);
}

static void a_product_of_matrices_is_not_recorded(void)
{
    struct d3d9_matrix two = {{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 2}}}, now;
    struct d3d9_state_block *block;
    d3d9_device_begin_state_block(device);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_multiply_transform(device, WORLD, &two));
    d3d9_device_end_state_block(device, &block);
    d3d9_device_get_transform(device, WORLD, &now);
    TEST_ASSERT_EQUAL_MEMORY(&two, &now, sizeof now);
    release(block);
}

static struct d3d9_declaration *declaration_of(uint32_t fvf)
{
    struct d3d9_declaration *declaration = NULL;
    d3d9_device_set_fvf(device, fvf);
    d3d9_device_get_vertex_declaration(device, &declaration);
    d3d9_object_release(&declaration->object);
    return declaration;
}

static void a_block_without_declaration_keeps_the_device_s(void)
{
    struct d3d9_declaration *first = declaration_of(0x042);
    d3d9_device_set_vertex_declaration(device, NULL);
    struct d3d9_state_block *block = created(VERTEX);
    d3d9_device_set_vertex_declaration(device, first);
    d3d9_state_block_apply(block);
    TEST_ASSERT_EQUAL_PTR(first, device->state->declaration[0]);
    d3d9_state_block_capture(block);
    d3d9_device_set_vertex_declaration(device, NULL);
    d3d9_state_block_apply(block);
    TEST_ASSERT_EQUAL_PTR(first, device->state->declaration[0]);
    release(block);
}

/* --- Lights --- */

static void two_lights(void)
{
    struct d3d9_light light = {.type = 1, .range = 9};
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_light(device, 1000, &light));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_light_enable(device, 3, 1));
}

static void recorded_lights_exist_after_apply(void)
{
    struct d3d9_light light;
    int32_t enabled;
    struct d3d9_state_block *block = recorded(two_lights);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_get_light(device, 1000, &light));
    d3d9_state_block_apply(block);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_light(device, 1000, &light));
    TEST_ASSERT_EQUAL_FLOAT(9, light.range);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_light_enable(device, 3, &enabled));
    TEST_ASSERT_EQUAL_INT32(128, enabled);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_light(device, 3, &light));
    TEST_ASSERT_EQUAL_UINT32(3, light.type);
    TEST_ASSERT_EQUAL_FLOAT(1, light.direction.z);
    release(block);
}

static void the_renderer_has_the_first_eight_enabled_lights(void)
{
    struct triptych_light light;
    int enabled;
    for (uint32_t i = 0; i < 10; i++) {
        struct d3d9_light point = {.type = 1, .range = 100 + (float)i};
        d3d9_device_set_light(device, 50 - i, &point);
        d3d9_device_light_enable(device, 50 - i, 1);
    }
    d3d9_device_light_enable(device, 49, 0);
    d3d9_lights_forward(device);
    for (unsigned i = 0; i < 8; i++) {
        triptych_get_light(device->renderer, i, &light);
        triptych_get_light_enable(device->renderer, i, &enabled);
        TEST_ASSERT_EQUAL_FLOAT(100 + (i ? i + 1.0F : 0.0F), light.range);
        TEST_ASSERT_EQUAL_INT(1, enabled);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_block_of_all_values_restores_all_but_the_monitor);
    RUN_TEST(a_block_of_pixels_restores_what_belongs_to_pixels);
    RUN_TEST(a_block_of_vertices_restores_what_belongs_to_vertices);
    RUN_TEST(recording_changes_the_block_and_not_the_device);
    RUN_TEST(one_block_is_recorded_at_a_time);
    RUN_TEST(a_device_that_ends_while_it_records_frees_the_block);
    RUN_TEST(a_product_of_matrices_is_not_recorded);
    RUN_TEST(a_block_without_declaration_keeps_the_device_s);
    RUN_TEST(recorded_lights_exist_after_apply);
    RUN_TEST(the_renderer_has_the_first_eight_enabled_lights);
    return UNITY_END();
}
