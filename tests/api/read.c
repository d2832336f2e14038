/* Reads refuse arrays that are too small, and change nothing beyond what they read. */
#include "triptych.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

enum { WIDTH = 5, HEIGHT = 3, PIXELS = WIDTH * HEIGHT, GUARD = 0x5a };

static triptych_device *device;
static uint8_t array[PIXELS * 16 + 64];

static void good(enum triptych_result result)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, result, triptych_error(device));
}

/* The array is refused with one byte less than `needed`, and nothing in it changes. */
static void refused(enum triptych_result result, size_t needed, const char *what)
{
    char reason[128];
    snprintf(reason, sizeof reason, "an array of %zu bytes for %s: expected at least %zu", needed - 1, what,
             needed);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, result);
    TEST_ASSERT_EQUAL_STRING(reason, triptych_error(device));
    for (size_t i = 0; i < sizeof array; i++)
        TEST_ASSERT_EQUAL_HEX8(GUARD, array[i]);
}

/* Exactly `needed` bytes were written. */
static void wrote(enum triptych_result result, size_t needed)
{
    good(result);
    for (size_t i = needed; i < sizeof array; i++)
        TEST_ASSERT_EQUAL_HEX8(GUARD, array[i]);
    memset(array, GUARD, sizeof array);
}

void setUp(void)
{
    const struct triptych_options options = {.engine = "emulate", .threads = 1};
    const struct triptych_target_description target = {
        .width = WIDTH, .height = HEIGHT, .depth_format = TRIPTYCH_DEPTH_D24S8};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &device, NULL, 0));
    good(triptych_set_target_description(device, &target));
    memset(array, GUARD, sizeof array);
}

void tearDown(void)
{
    triptych_device_destroy(device);
}

static void short_arrays_for_pixels_are_refused(void)
{
    void *a = array;
    refused(triptych_read_color(device, a, 4 * PIXELS - 1), 4 * PIXELS, "colours");
    refused(triptych_read_target(device, 0, a, 4 * PIXELS - 1), 4 * PIXELS, "colours");
    refused(triptych_read_target_numbers(device, 0, a, 16 * PIXELS - 1), 16 * PIXELS, "numbers");
    refused(triptych_read_depth(device, a, 4 * PIXELS - 1), 4 * PIXELS, "depth");
    refused(triptych_read_stencil(device, a, PIXELS - 1), PIXELS, "stencil");
    refused(triptych_read_sample(device, 0, a, 4 * PIXELS - 1, NULL, 0, NULL, 0), 4 * PIXELS, "colours");
    refused(triptych_read_sample(device, 0, NULL, 0, a, 4 * PIXELS - 1, NULL, 0), 4 * PIXELS, "depth");
    refused(triptych_read_sample(device, 0, NULL, 0, NULL, 0, a, PIXELS - 1), PIXELS, "stencil");
}

static void arrays_of_the_right_size_are_filled(void)
{
    void *a = array;
    wrote(triptych_read_color(device, a, 4 * PIXELS), 4 * PIXELS);
    wrote(triptych_read_target_numbers(device, 0, a, sizeof array), 16 * PIXELS);
    wrote(triptych_read_depth(device, a, 4 * PIXELS), 4 * PIXELS);
    wrote(triptych_read_stencil(device, a, PIXELS), PIXELS);
    wrote(triptych_read_sample(device, 0, NULL, 0, NULL, 0, a, PIXELS), PIXELS);
}

static void short_arrays_for_contents_are_refused(void)
{
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 4, 4, 1, 1};
    struct triptych_surface surface = {.level = 0};
    void *a = array;
    good(triptych_texture_define(device, &description, &surface.texture));
    refused(triptych_read_surface(device, &surface, a, 63), 64, "colours");
    wrote(triptych_read_surface(device, &surface, a, 64), 64);
    refused(triptych_read_surface_numbers(device, &surface, a, 255), 256, "numbers");
    size_t texels = triptych_texture_texel_bytes(surface.texture);
    refused(triptych_texture_read_texels(device, surface.texture, a, texels - 1), texels, "texels");
    wrote(triptych_texture_read_texels(device, surface.texture, a, texels), texels);
    size_t contents = triptych_contents_bytes(device);
    refused(triptych_read_contents(device, a, contents - 1), contents, "contents");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(short_arrays_for_pixels_are_refused);
    RUN_TEST(arrays_of_the_right_size_are_filled);
    RUN_TEST(short_arrays_for_contents_are_refused);
    return UNITY_END();
}
