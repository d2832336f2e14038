#include "image/compare.h"

#include <unity.h>

#include <math.h>
#include <string.h>

enum { WIDTH = 7, HEIGHT = 5, PIXELS = WIDTH * HEIGHT };

static uint32_t color[2][PIXELS], painting[PIXELS];
static float depth[2][PIXELS];
static uint8_t stencil[2][PIXELS];
static struct picture first = {WIDTH, HEIGHT, color[0], depth[0], stencil[0], NULL, 0},
                      second = {WIDTH, HEIGHT, color[1], depth[1], stencil[1], NULL, 0};
static struct difference found;

void setUp(void)
{
    for (unsigned i = 0; i < PIXELS; i++) {
        color[0][i] = color[1][i] = 0xff000000 | i * 0x030507;
        depth[0][i] = depth[1][i] = (float)i / PIXELS;
        stencil[0][i] = stencil[1][i] = (uint8_t)(i * 7);
    }
}

void tearDown(void)
{
}

static void test_equal_pictures_are_equal(void)
{
    memset(&found, 1, sizeof found);
    TEST_ASSERT_FALSE(compare_pictures(&first, &second, &found));
    TEST_ASSERT_EACH_EQUAL_UINT8(0, &found, sizeof found);
}

/* One bit is planted at every pixel and at every bit of a stencil in turn, and its position is found. */
static void test_every_planted_stencil_bit_is_found(void)
{
    for (unsigned i = 0; i < PIXELS; i++)
        for (unsigned bit = 0; bit < 8; bit++) {
            stencil[1][i] ^= (uint8_t)(1u << bit);
            TEST_ASSERT_TRUE(compare_pictures(&first, &second, &found));
            TEST_ASSERT_EQUAL_UINT(1, found.stencil_pixels);
            TEST_ASSERT_EQUAL_UINT(0, found.color_pixels + found.depth_pixels);
            TEST_ASSERT_EQUAL_UINT(i, found.y * WIDTH + found.x);
            TEST_ASSERT_EQUAL_UINT8(stencil[1][i], found.stencil[1]);
            compare_paint(&first, &second, painting);
            TEST_ASSERT_EQUAL_HEX32(0xffff0000, painting[i]);
            stencil[1][i] = stencil[0][i];
        }
}

/* One bit is planted at every pixel and at every bit of a colour in turn, and its position is found. */
static void test_every_planted_colour_bit_is_found(void)
{
    for (unsigned i = 0; i < PIXELS; i++)
        for (unsigned bit = 0; bit < 32; bit++) {
            color[1][i] ^= 1u << bit;
            TEST_ASSERT_TRUE(compare_pictures(&first, &second, &found));
            TEST_ASSERT_EQUAL_UINT(i % WIDTH, found.x);
            TEST_ASSERT_EQUAL_UINT(i / WIDTH, found.y);
            TEST_ASSERT_EQUAL_HEX32(color[0][i], found.color[0]);
            TEST_ASSERT_EQUAL_HEX32(color[1][i], found.color[1]);
            TEST_ASSERT_EQUAL_UINT64(1, found.color_pixels);
            TEST_ASSERT_EQUAL_UINT64(0, found.depth_pixels);
            TEST_ASSERT_EQUAL_UINT32(1u << bit % 8, found.color_distance);
            color[1][i] ^= 1u << bit;
        }
}

static void test_one_ulp_of_depth_is_found(void)
{
    depth[1][17] = nextafterf(depth[1][17], 1);
    TEST_ASSERT_TRUE(compare_pictures(&first, &second, &found));
    TEST_ASSERT_EQUAL_UINT(17 % WIDTH, found.x);
    TEST_ASSERT_EQUAL_UINT(17 / WIDTH, found.y);
    TEST_ASSERT_EQUAL_UINT64(0, found.color_pixels);
    TEST_ASSERT_EQUAL_UINT64(1, found.depth_pixels);
    TEST_ASSERT_EQUAL_FLOAT(depth[0][17], found.depth[0]);
    TEST_ASSERT_TRUE(found.depth[0] != found.depth[1]);
}

/* One ulp is planted in every number of every pixel in turn, and its position is found. */
static void test_every_number_is_compared(void)
{
    enum { EACH = 8 };
    static float numbers[2][PIXELS * EACH];
    struct picture exact[2] = {first, second};
    for (int i = 0; i < PIXELS * EACH; i++)
        numbers[0][i] = numbers[1][i] = (float)i - 20;
    for (int i = 0; i < 2; i++) {
        exact[i].numbers = numbers[i];
        exact[i].numbers_each = EACH;
    }
    TEST_ASSERT_FALSE(compare_pictures(exact, exact + 1, &found));
    for (unsigned i = 0; i < PIXELS * EACH; i++) {
        numbers[1][i] = nextafterf(numbers[0][i], 1000);
        TEST_ASSERT_TRUE(compare_pictures(exact, exact + 1, &found));
        TEST_ASSERT_EQUAL_UINT(i / EACH % WIDTH, found.x);
        TEST_ASSERT_EQUAL_UINT(i / EACH / WIDTH, found.y);
        TEST_ASSERT_EQUAL_UINT64(1, found.number_pixels);
        TEST_ASSERT_EQUAL_UINT64(0, found.color_pixels);
        TEST_ASSERT_EQUAL_UINT(i % EACH, found.number_place);
        TEST_ASSERT_TRUE(found.number[0] == numbers[0][i] && found.number[1] == numbers[1][i]);
        numbers[1][i] = numbers[0][i];
    }
}

static void test_depths_are_compared_as_bytes(void)
{
    depth[0][0] = depth[1][0] = NAN;
    TEST_ASSERT_FALSE(compare_pictures(&first, &second, &found));
    depth[1][0] = -depth[0][0];
    TEST_ASSERT_TRUE(compare_pictures(&first, &second, &found));
    depth[0][0] = 0.0f;
    depth[1][0] = -0.0f;
    TEST_ASSERT_TRUE(compare_pictures(&first, &second, &found));
}

static void test_without_depths_only_colours_count(void)
{
    const struct picture flat[2] = {{.width = WIDTH, .height = HEIGHT, .color = color[0]},
                                    {.width = WIDTH, .height = HEIGHT, .color = color[1]}};
    depth[1][3] = 9;
    TEST_ASSERT_FALSE(compare_pictures(flat, flat + 1, &found));
    color[1][3]++;
    TEST_ASSERT_TRUE(compare_pictures(flat, flat + 1, &found));
}

static void test_the_first_difference_is_described_and_all_are_counted(void)
{
    depth[1][4] = 2;
    color[1][9] ^= 0x40;
    color[1][PIXELS - 1] ^= 0x8000;
    depth[1][PIXELS - 1] = 2;
    TEST_ASSERT_TRUE(compare_pictures(&first, &second, &found));
    TEST_ASSERT_EQUAL_UINT(4, found.x);
    TEST_ASSERT_EQUAL_UINT(0, found.y);
    TEST_ASSERT_EQUAL_HEX32(found.color[0], found.color[1]);
    TEST_ASSERT_EQUAL_UINT64(2, found.color_pixels);
    TEST_ASSERT_EQUAL_UINT64(2, found.depth_pixels);
    TEST_ASSERT_EQUAL_UINT32(0x80, found.color_distance);
}

static void test_the_picture_marks_only_differing_pixels(void)
{
    color[1][9] ^= 1;
    color[1][10] ^= 0x80;
    depth[1][11] = 2;
    compare_paint(&first, &second, painting);
    for (unsigned i = 0; i < PIXELS; i++) {
        unsigned red = painting[i] & 255, green = painting[i] >> 8 & 255, blue = painting[i] >> 16 & 255;
        TEST_ASSERT_EQUAL_HEX32(0xff, painting[i] >> 24);
        if (i == 9 || i == 10) {
            TEST_ASSERT_TRUE(red > 90 && !green && !blue);
        } else if (i == 11) {
            TEST_ASSERT_TRUE(!red && !green && blue == 255);
        } else {
            TEST_ASSERT_TRUE(red == green && green == blue && red < 64);
        }
    }
    TEST_ASSERT_TRUE((painting[10] & 255) > (painting[9] & 255));
}

static void the_distance_is_that_of_all_channels(void)
{
    color[1][3] = color[0][3] ^ 0x80000000; /* alpha, by 128 */
    color[1][4] += 2;
    struct compare_distance distance = compare_distance(&first, &second, 1);
    TEST_ASSERT_EQUAL_UINT64(2, distance.pixels);
    TEST_ASSERT_EQUAL_UINT32(128, distance.largest);
    TEST_ASSERT_EQUAL_DOUBLE((128.0 * 128 + 4) / (4 * PIXELS), distance.mean_square);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10 * log10(65025 / distance.mean_square), compare_psnr(&distance));
    TEST_ASSERT_EQUAL_UINT64(1, compare_distance(&first, &second, 2).pixels);
    TEST_ASSERT_EQUAL_UINT64(0, compare_distance(&first, &second, 128).pixels);
}

static void equal_pictures_have_an_infinite_ratio(void)
{
    struct compare_distance distance = compare_distance(&first, &second, 0);
    TEST_ASSERT_EQUAL_UINT64(0, distance.pixels);
    TEST_ASSERT_TRUE(isinf(compare_psnr(&distance)));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_equal_pictures_are_equal);
    RUN_TEST(test_every_planted_colour_bit_is_found);
    RUN_TEST(test_every_planted_stencil_bit_is_found);
    RUN_TEST(test_every_number_is_compared);
    RUN_TEST(test_one_ulp_of_depth_is_found);
    RUN_TEST(test_depths_are_compared_as_bytes);
    RUN_TEST(test_without_depths_only_colours_count);
    RUN_TEST(test_the_first_difference_is_described_and_all_are_counted);
    RUN_TEST(test_the_picture_marks_only_differing_pixels);
    RUN_TEST(the_distance_is_that_of_all_channels);
    RUN_TEST(equal_pictures_have_an_infinite_ratio);
    return UNITY_END();
}
