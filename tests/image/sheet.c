#include "image/png.h"
#include "image/sheet.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

static struct error error;

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

static void pictures_are_placed_row_by_row(void)
{
    static const uint32_t expected[] = {0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 0, 0, 2, 2, 0, 0};
    struct sheet sheet = sheet_create(2, 3);
    for (uint32_t i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_INT(0, sheet_add(&sheet, 2, 2, (uint32_t[]){i, i, i, i}, &error));
    TEST_ASSERT_EQUAL_UINT(4, sheet_width(&sheet));
    TEST_ASSERT_EQUAL_UINT(4, sheet_height(&sheet));
    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected, sheet.rgba, 16);
    sheet_free(&sheet);
}

static void a_row_is_not_longer_than_the_number_of_pictures(void)
{
    struct sheet sheet = sheet_create(100, 2);
    TEST_ASSERT_EQUAL_INT(0, sheet_add(&sheet, 1, 1, (uint32_t[]){7}, &error));
    TEST_ASSERT_EQUAL_UINT(2, sheet_width(&sheet));
    sheet_free(&sheet);
}

/* Two pictures of 8191 pixels in a row are reduced to half. A pixel is the mean of four. */
static void a_sheet_that_is_too_large_is_reduced(void)
{
    enum { WIDTH = PNG_SIDE_MAXIMUM - 1, HEIGHT = 3 };
    static const uint32_t block[] = {0xff000000, 0xff000001, 0x01020302, 0x01020303};
    struct sheet sheet = sheet_create(2, 2);
    uint32_t *rgba = malloc(WIDTH * HEIGHT * sizeof *rgba);
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++)
        rgba[i] = block[i / WIDTH % 2 * 2 + i % WIDTH % 2];
    TEST_ASSERT_EQUAL_INT(0, sheet_add(&sheet, WIDTH, HEIGHT, rgba, &error));
    TEST_ASSERT_EQUAL_INT(0, sheet_add(&sheet, WIDTH, HEIGHT, rgba, &error));
    TEST_ASSERT_EQUAL_UINT(2, sheet.factor);
    TEST_ASSERT_EQUAL_UINT(WIDTH / 2 * 2, sheet_width(&sheet));
    TEST_ASSERT_EQUAL_UINT(1, sheet_height(&sheet));
    TEST_ASSERT_EACH_EQUAL_HEX32(0x80010202, sheet.rgba, WIDTH / 2 * 2);
    free(rgba);
    sheet_free(&sheet);
}

static void a_picture_of_another_size_is_refused(void)
{
    struct sheet sheet = sheet_create(2, 2);
    TEST_ASSERT_EQUAL_INT(0, sheet_add(&sheet, 1, 2, (uint32_t[]){7, 8}, &error));
    TEST_ASSERT_EQUAL_INT(-1, sheet_add(&sheet, 2, 1, (uint32_t[]){7, 8}, &error));
    TEST_ASSERT_EQUAL_STRING("picture 1 has 2 x 1 pixels, expected 1 x 2, like the first", error.text);
    sheet_free(&sheet);
}

static void more_pictures_than_pixels_are_refused(void)
{
    struct sheet sheet = sheet_create(PNG_SIDE_MAXIMUM + 1, PNG_SIDE_MAXIMUM + 1);
    TEST_ASSERT_EQUAL_INT(-1, sheet_add(&sheet, 1, 1, (uint32_t[]){7}, &error));
    TEST_ASSERT_EQUAL_STRING(
        "a sheet of 8193 columns and 1 rows of pictures has too many, expected at most 8192 "
        "pixels a side",
        error.text);
    sheet_free(&sheet);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(pictures_are_placed_row_by_row);
    RUN_TEST(a_row_is_not_longer_than_the_number_of_pictures);
    RUN_TEST(a_sheet_that_is_too_large_is_reduced);
    RUN_TEST(a_picture_of_another_size_is_refused);
    RUN_TEST(more_pictures_than_pixels_are_refused);
    return UNITY_END();
}
