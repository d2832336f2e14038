/* The conversion against its definition in double precision, and every engine against plain C. */
#include "bench/clients/filter/convert.h"
#include <unity.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 203, HEIGHT = 6, PITCH = WIDTH + 13 };

static const char *const engines[] = {"emulate",        "batch",        "specialize-1",
                                      "specialize-4",   "specialize-8", "specialize-16",
                                      "specialize-8x2", "specialize",   "specialize-none"};
enum { ENGINES = sizeof engines / sizeof engines[0] };

static uint8_t y_plane[HEIGHT * PITCH + 4], u_plane[HEIGHT * PITCH + 4], v_plane[HEIGHT * PITCH + 4];
static uint8_t expected[HEIGHT * WIDTH * 4], got[HEIGHT * WIDTH * 4];
static const struct convert_picture picture = {WIDTH, HEIGHT, y_plane, u_plane, v_plane, PITCH, PITCH, PITCH};

void setUp(void)
{
    uint32_t seed = 1;
    for (size_t i = 0; i < sizeof y_plane; i++) {
        seed = seed * 1664525u + 1013904223u;
        y_plane[i] = (uint8_t)(seed >> 24), u_plane[i] = (uint8_t)(seed >> 16),
        v_plane[i] = (uint8_t)(seed >> 8);
    }
}

void tearDown(void)
{
}

/* The definition of the recommendations, rounded to the nearest byte. */
static double defined(const struct convert_choice *choice, int channel, int y, int u, int v)
{
    static const double kr[] = {0.299, 0.2126, 0.2627}, kb[] = {0.114, 0.0722, 0.0593};
    double r = kr[choice->matrix], b = kb[choice->matrix];
    double luma = choice->full ? y / 255.0 : (y - 16) / 219.0;
    double cb = choice->full ? (u - 128) / 255.0 : (u - 128) / 224.0;
    double cr = choice->full ? (v - 128) / 255.0 : (v - 128) / 224.0;
    double red = luma + 2 * (1 - r) * cr, blue = luma + 2 * (1 - b) * cb;
    double rgb[3] = {red, (luma - r * red - b * blue) / (1 - r - b), blue};
    double value = 255 * rgb[channel];
    return value < 0 ? 0 : value > 255 ? 255 : value;
}

/* Each factor is wrong by at most 2^-14; three products with at most 255 and the rounding are wrong by less
 * than 0.55. */
static void test_plain_c_is_within_half_a_step_of_the_definition(void)
{
    for (int form = 0; form < 2 * CONVERT_MATRICES; form++) {
        struct convert_choice choice = {(enum convert_matrix)(form / 2), form & 1, 1, 1, {0, 1, 2, 3}};
        for (int n = 0; n < 1 << 15; n++) {
            uint8_t y = (uint8_t)((n & 31) * 255 / 31), u = (uint8_t)((n >> 5 & 31) * 255 / 31),
                    v = (uint8_t)((n >> 10) * 255 / 31), pixel[4];
            struct convert_picture one = {1, 1, &y, &u, &v, 1, 1, 1};
            convert_plain_picture(&choice, &one, pixel, 4);
            for (int channel = 0; channel < 3; channel++)
                TEST_ASSERT_DOUBLE_WITHIN(0.55, defined(&choice, channel, y, u, v), pixel[channel]);
            TEST_ASSERT_EQUAL(255, pixel[3]);
        }
    }
}

static void test_the_colours_of_the_recommendations_are_exact(void)
{
    static const uint8_t yuv[][3] = {
        {16, 128, 128}, {235, 128, 128}, {81, 90, 240}, {145, 54, 34}, {41, 240, 110}};
    static const uint8_t rgb[][3] = {{0, 0, 0}, {255, 255, 255}, {255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
    struct convert_choice choice = {CONVERT_BT601, false, 1, 1, {0, 1, 2, 3}};
    for (int i = 0; i < 5; i++) {
        uint8_t pixel[4];
        struct convert_picture one = {1, 1, yuv[i], yuv[i] + 1, yuv[i] + 2, 1, 1, 1};
        convert_plain_picture(&choice, &one, pixel, 4);
        for (int channel = 0; channel < 3; channel++)
            TEST_ASSERT_INT_WITHIN(1, rgb[i][channel], pixel[channel]);
    }
}

static void compare(const char *engine, const struct convert_choice *choice)
{
    struct error error = {{0}};
    struct kernel *kernel = kernel_create(&convert_kernel, choice, CONVERT_STRIDE, engine, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(kernel, error.text);
    memset(got, 0xee, sizeof got);
    TEST_ASSERT_EQUAL(0, convert_kernel_picture(kernel, choice, &picture, got, WIDTH * 4));
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(expected, got, sizeof got, engine);
    kernel_free(kernel);
}

/* All matrices, ranges, subsamplings and two orders of channels. */
static void test_every_engine_converts_as_plain_c_does(void)
{
    static const int places[][4] = {{0, 1, 2, 3}, {2, 1, 0, 3}, {1, 2, 3, 0}};
    for (int n = 0; n < CONVERT_MATRICES * 2 * 3 * 2 * 3; n++) {
        struct convert_choice choice = {
            (enum convert_matrix)(n % 3), n / 3 % 2, 1 << n / 6 % 3, 1 + n / 18 % 2, {0}};
        memcpy(choice.place, places[n / 36], sizeof choice.place);
        convert_plain_picture(&choice, &picture, expected, WIDTH * 4);
        for (int i = 0; i < ENGINES; i++)
            if (!kernel_unavailable(engines[i]))
                compare(engines[i], &choice);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_plain_c_is_within_half_a_step_of_the_definition);
    RUN_TEST(test_the_colours_of_the_recommendations_are_exact);
    RUN_TEST(test_every_engine_converts_as_plain_c_does);
    return UNITY_END();
}
