/* Calls with a number out of its range are refused. The reason contains the number and the expected range,
 * and the state does not change. */
#include "triptych.h"

#include <string.h>
#include <unity.h>

static triptych_device *device;
static triptych_buffer *buffer;
static const float identity[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

enum { STRIDE = 16, VERTICES = 3 };

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

static void refuses(enum triptych_result result, enum triptych_result expected, const char *reason)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(expected, result, triptych_error(device));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(triptych_error(device), reason), triptych_error(device));
}

void setUp(void)
{
    static const float corners[VERTICES][4] = {{-1, 1, 0, 1}, {3, 1, 0, 1}, {-1, -3, 0, 1}};
    struct triptych_options options = {.engine = "emulate", .threads = 1};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &device, NULL, 0));
    OK(triptych_set_target(device, 8, 8));
    OK(triptych_buffer_create(device, corners, sizeof corners, &buffer));
    OK(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, STRIDE};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
}

void tearDown(void)
{
    triptych_device_destroy(device);
}

/* Fails unless the state is still that of setUp(), in which the triangle covers the target. */
static void expect_unchanged(void)
{
    uint32_t image[64];
    OK(triptych_clear(device, (const float[4]){0, 0, 0, 0}, 1));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    OK(triptych_read_color(device, image, sizeof image));
    for (int i = 0; i < 64; i++)
        TEST_ASSERT_EQUAL_HEX32(0xffffffff, image[i]);
}

static void numbers_of_transforms_and_attributes(void)
{
    struct triptych_element none = {.format = TRIPTYCH_FORMAT_NONE};
    refuses(triptych_set_transform(device, TRIPTYCH_TRANSFORM_COUNT, identity), TRIPTYCH_BAD_ARGUMENT,
            "expected 0 to ");
    refuses(triptych_set_transform(device, (enum triptych_transform) - 1, identity), TRIPTYCH_BAD_ARGUMENT,
            "transform 4294967295: expected 0 to ");
    refuses(triptych_set_element(device, TRIPTYCH_ATTRIBUTE_COUNT, &none), TRIPTYCH_BAD_ARGUMENT,
            "expected 0 to ");
    expect_unchanged();
}

static void kinds_of_lights_clears_primitives_and_copies(void)
{
    static const uint32_t texels[4] = {0};
    const float black[4] = {0, 0, 0, 1};
    struct triptych_light light = {.type = (enum triptych_light_type)7};
    struct triptych_surface surface[2] = {{0}};
    for (int i = 0; i < 2; i++)
        OK(triptych_texture_create(device, texels, 2, 2, &surface[i].texture));
    refuses(triptych_set_light(device, 0, &light), TRIPTYCH_BAD_ARGUMENT,
            "light type 7: expected directional (0), point (1) or spot (2)");
    refuses(triptych_clear_buffers(device, 8, black, 1, 0), TRIPTYCH_BAD_ARGUMENT,
            "clear flags 0x8: expected a sum");
    refuses(triptych_draw(device, TRIPTYCH_PRIMITIVE_COUNT, 0, 1), TRIPTYCH_BAD_ARGUMENT,
            "primitive 10: expected one of Triptych's, 0 to 9");
    refuses(triptych_copy(device, &surface[0], NULL, &surface[1], NULL, TRIPTYCH_COPY_COUNT),
            TRIPTYCH_BAD_ARGUMENT, "filter 2 of a copy: expected point (0) or linear (1)");
    expect_unchanged();
}

static void vertices_that_begin_after_the_end_of_their_buffer(void)
{
    struct triptych_declaration_element position = {
        .offset = STRIDE, .format = TRIPTYCH_FORMAT_FLOAT4, .usage = TRIPTYCH_USAGE_POSITION};
    OK(triptych_set_declaration(device, &position, 1));
    OK(triptych_set_stream(device, 0, buffer, (VERTICES - 1) * STRIDE, STRIDE));
    refuses(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1), TRIPTYCH_BAD_CALL,
            "lies at byte 48 past its buffer of 48 bytes");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(numbers_of_transforms_and_attributes);
    RUN_TEST(kinds_of_lights_clears_primitives_and_copies);
    RUN_TEST(vertices_that_begin_after_the_end_of_their_buffer);
    return UNITY_END();
}
