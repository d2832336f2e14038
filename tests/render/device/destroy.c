/* Destroyed buffers, textures and queries. Draws that were recorded with them are unchanged, and nothing
 * refers to the objects afterwards; builds with sanitizers check this. */
#include "render/device/device.h"
#include "emu/emulate/emulate.h"

#include <string.h>
#include <unity.h>

enum { SIZE = 16, RED = 0xff0000ff, BLACK = 0xff000000 };

static triptych_device *device;
static uint32_t image[SIZE * SIZE];

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

static const float square[4][4] = {{-1, -1, 0, 1}, {-1, 1, 0, 1}, {1, -1, 0, 1}, {1, 1, 0, 1}};

void setUp(void)
{
    struct device_options options = {.threads = 1};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(&engine_emulate, &options, &device, NULL));
    OK(triptych_set_target(device, SIZE, SIZE));
    OK(triptych_clear(device, (float[]){0, 0, 0, 1}, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
}

void tearDown(void)
{
    triptych_device_destroy(device);
}

static triptych_buffer *bind_square(void)
{
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, square, sizeof square, &buffer));
    OK(triptych_set_fvf(device, 0x4002)); /* xyzw */
    OK(triptych_set_stream(device, 0, buffer, 0, sizeof square[0]));
    return buffer;
}

static triptych_texture *bind_red(void)
{
    triptych_texture *texture;
    OK(triptych_texture_create(device, &(uint32_t){RED}, 1, 1, &texture));
    OK(triptych_set_texture(device, 0, texture));
    return texture;
}

static void expect_all(uint32_t color)
{
    OK(triptych_read_color(device, image, sizeof image));
    for (int i = 0; i < SIZE * SIZE; i++)
        TEST_ASSERT_EQUAL_HEX32(color, image[i]);
}

static void a_draw_outlives_its_buffers(void)
{
    triptych_buffer *vertices = bind_square(), *indices;
    bind_red();
    OK(triptych_buffer_create(device, (uint16_t[]){0, 1, 2, 3}, 8, &indices));
    OK(triptych_set_indices(device, indices, 16));
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 0, 2));
    OK(triptych_buffer_destroy(device, indices));
    OK(triptych_buffer_destroy(device, vertices));
    expect_all(RED);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    bind_square();
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 0, 2));
}

static void a_draw_outlives_its_texture(void)
{
    bind_square();
    triptych_texture *texture = bind_red();
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    OK(triptych_texture_destroy(device, texture));
    expect_all(RED);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    expect_all(0xffffffff); /* the vertices' default colour */
}

static void drawing_goes_back_to_the_target(void)
{
    struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, SIZE / 2, SIZE / 2, 1, 1};
    struct triptych_target_surfaces surfaces = {.depth_format = TRIPTYCH_DEPTH_NONE};
    triptych_texture *texture;
    OK(triptych_texture_define(device, &description, &texture));
    surfaces.color[0].texture = texture;
    OK(triptych_set_target_surfaces(device, &surfaces));
    bind_square();
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    OK(triptych_texture_destroy(device, texture));
    expect_all(BLACK);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    expect_all(0xffffffff);
}

static void a_query_that_has_begun_stops_counting(void)
{
    triptych_query *first, *second;
    uint64_t passed;
    bind_square();
    OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &first));
    OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &second));
    OK(triptych_query_begin(device, first));
    OK(triptych_query_begin(device, second));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    OK(triptych_query_destroy(device, first));
    OK(triptych_query_end(device, second));
    OK(triptych_query_result(device, second, &passed));
    TEST_ASSERT_EQUAL_UINT64(SIZE * SIZE, passed);
    TEST_ASSERT_EQUAL_UINT32(0, device->queries.counting);
    OK(triptych_query_destroy(device, second));
    TEST_ASSERT_NULL(device->queries.first);
}

static void others_are_refused_and_null_is_allowed(void)
{
    triptych_device *own = device;
    setUp();
    triptych_buffer *buffer = bind_square();
    triptych_texture *texture = bind_red();
    triptych_query *query;
    OK(triptych_query_create(device, TRIPTYCH_QUERY_EVENT, &query));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_buffer_destroy(own, buffer));
    TEST_ASSERT_EQUAL_STRING("buffer to destroy: expected one of this device", triptych_error(own));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_texture_destroy(own, texture));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_query_destroy(own, query));
    OK(triptych_buffer_destroy(device, NULL));
    OK(triptych_texture_destroy(device, NULL));
    OK(triptych_query_destroy(device, NULL));
    triptych_device_destroy(own);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_draw_outlives_its_buffers);
    RUN_TEST(a_draw_outlives_its_texture);
    RUN_TEST(drawing_goes_back_to_the_target);
    RUN_TEST(a_query_that_has_begun_stops_counting);
    RUN_TEST(others_are_refused_and_null_is_allowed);
    return UNITY_END();
}
