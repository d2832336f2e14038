/* PNG reading and writing (image/png.h): every kind of file converts to the right RGBA8 values; damage is
 * refused. */
#include "image/png.h"

#include "base/file.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

enum { SIDE = 64 };

static char path[64];
static struct error error;

void setUp(void)
{
    strcpy(path, "/tmp/triptych-png.XXXXXX");
    close(mkstemp(path));
    error_clear(&error);
}

void tearDown(void)
{
    unlink(path);
}

/* Writes the rows with direct calls of libpng, independently of the tested code. */
static void write_kind(unsigned width, unsigned height, int depth, int kind, int interlace, const void *rows,
                       size_t row_bytes)
{
    static const png_color palette[2] = {{10, 20, 30}, {40, 50, 60}};
    static const png_byte alpha[2] = {255, 7};
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, width, height, depth, kind, interlace, 0, 0);
    if (kind == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(png, info, palette, 2);
        png_set_tRNS(png, info, alpha, 2, NULL);
    }
    png_set_gAMA(png, info, 1.0);
    png_write_info(png, info);
    int passes = png_set_interlace_handling(png);
    for (int pass = 0; pass < passes; pass++)
        for (unsigned y = 0; y < height; y++)
            png_write_row(png, (png_const_bytep)rows + y * row_bytes);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    fclose(file);
}

static void expect_pixels(unsigned width, unsigned height, const uint32_t *expected)
{
    unsigned w = 0, h = 0;
    uint32_t *rgba;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, png_load(path, &w, &h, &rgba, &error), error.text);
    TEST_ASSERT_EQUAL_UINT(width, w);
    TEST_ASSERT_EQUAL_UINT(height, h);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(expected, rgba, width * height);
    free(rgba);
}

static void rgba8_round_trips(void)
{
    static const uint32_t pixels[6] = {0xff0000ff, 0x8000ff00, 0x00ff0000, 0x12345678, 0, 0xffffffff};
    TEST_ASSERT_EQUAL_INT(0, png_save(path, 3, 2, pixels, &error));
    expect_pixels(3, 2, pixels);
}

/* The bytes of a picture with some detail, written at a level. */
static size_t bytes_at_level(unsigned level)
{
    static uint32_t pixels[SIDE * SIDE];
    char *data;
    size_t bytes;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t x = i % SIDE, y = i / SIDE, grain = i * 2654435761u >> 30;
        pixels[i] = 0xff000000u | (x * x / 40 + y + grain) * 0x10101u;
    }
    TEST_ASSERT_EQUAL_INT(0, png_save_level(path, SIDE, SIDE, pixels, level, &error));
    expect_pixels(SIDE, SIDE, pixels);
    TEST_ASSERT_EQUAL_INT(0, file_read(path, 1 << 20, &data, &bytes, &error));
    free(data);
    return bytes;
}

static void every_level_has_the_same_pixels_and_higher_levels_fewer_bytes(void)
{
    for (unsigned level = 0; level <= PNG_LEVEL_MAXIMUM; level++)
        TEST_ASSERT_GREATER_THAN_UINT64(0, bytes_at_level(level));
    TEST_ASSERT_GREATER_THAN_UINT64(SIDE * SIDE * 4, bytes_at_level(0));
    TEST_ASSERT_LESS_THAN_UINT64(bytes_at_level(0), bytes_at_level(PNG_LEVEL_DEFAULT));
    TEST_ASSERT_LESS_THAN_UINT64(bytes_at_level(PNG_LEVEL_DEFAULT), bytes_at_level(PNG_LEVEL_MAXIMUM));
}

static void grey_repeats_in_all_channels_and_gamma_is_not_applied(void)
{
    static const uint8_t row[3] = {0, 100, 255};
    static const uint32_t expected[3] = {0xff000000, 0xff646464, 0xffffffff};
    write_kind(3, 1, 8, PNG_COLOR_TYPE_GRAY, 0, row, 3);
    expect_pixels(3, 1, expected);
}

static void one_bit_grey_is_black_and_white(void)
{
    static const uint8_t row[1] = {0xa0};
    static const uint32_t expected[3] = {0xffffffff, 0xff000000, 0xffffffff};
    write_kind(3, 1, 1, PNG_COLOR_TYPE_GRAY, 0, row, 1);
    expect_pixels(3, 1, expected);
}

static void palettes_give_their_colors_and_transparency(void)
{
    static const uint8_t row[1] = {0x40};
    static const uint32_t expected[2] = {0xff1e140a, 0x073c3228};
    write_kind(2, 1, 1, PNG_COLOR_TYPE_PALETTE, 0, row, 1);
    expect_pixels(2, 1, expected);
}

/* Divided by 257: 127.498, 0.502, 255. */
static void sixteen_bits_round_to_the_nearest_eight(void)
{
    static const uint8_t row[6] = {0x7f, 0xff, 0x00, 0x81, 0xff, 0xff};
    static const uint32_t expected[1] = {0xffff017f};
    write_kind(1, 1, 16, PNG_COLOR_TYPE_RGB, 0, row, 6);
    expect_pixels(1, 1, expected);
}

static void interlaced_pixels_are_in_order(void)
{
    uint32_t pixels[9 * 9];
    for (uint32_t i = 0; i < 81; i++)
        pixels[i] = 0xff000000u + i * 0x10203u;
    write_kind(9, 9, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_ADAM7, pixels, 36);
    expect_pixels(9, 9, pixels);
}

static void expect_refused(const char *reason)
{
    unsigned w, h;
    uint32_t *rgba;
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, png_load(path, &w, &h, &rgba, &error));
    TEST_ASSERT_NULL(rgba);
    TEST_ASSERT_EQUAL_MEMORY(path, error.text, strlen(path));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, reason), error.text);
}

static void every_cut_and_every_damaged_byte_is_refused_or_read_but_never_crashes(void)
{
    static const uint32_t pixels[4] = {0xff0000ff, 0x8000ff00, 0x00ff0000, 0x12345678};
    char *data;
    size_t bytes;
    unsigned w, h;
    uint32_t *rgba;
    TEST_ASSERT_EQUAL_INT(0, png_save(path, 2, 2, pixels, &error));
    TEST_ASSERT_EQUAL_INT(0, file_read(path, 1 << 16, &data, &bytes, &error));
    for (size_t cut = 0; cut < bytes; cut++) {
        TEST_ASSERT_EQUAL_INT(0, file_write(path, data, cut, &error));
        expect_refused("");
    }
    for (size_t i = 0; i < bytes; i++) {
        data[i] ^= 0x5a;
        TEST_ASSERT_EQUAL_INT(0, file_write(path, data, bytes, &error));
        error_clear(&error);
        if (!png_load(path, &w, &h, &rgba, &error))
            free(rgba);
        error_clear(&error);
        data[i] ^= 0x5a;
    }
    free(data);
}

static void text_and_oversize_are_refused(void)
{
    TEST_ASSERT_EQUAL_INT(0, file_write(path, "this is a text", 14, &error));
    expect_refused("Not a PNG file");
    static uint8_t row[8193];
    write_kind(8193, 1, 8, PNG_COLOR_TYPE_GRAY, 0, row, 8193);
    expect_refused("8192");
}

static void an_impossible_size_cannot_be_saved(void)
{
    static const uint32_t pixel;
    TEST_ASSERT_EQUAL_INT(-1, png_save(path, 0, 1, &pixel, &error));
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, png_save("/nonexistent/x.png", 1, 1, &pixel, &error));
    TEST_ASSERT_NOT_NULL(strstr(error.text, "No such file"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(rgba8_round_trips);
    RUN_TEST(every_level_has_the_same_pixels_and_higher_levels_fewer_bytes);
    RUN_TEST(grey_repeats_in_all_channels_and_gamma_is_not_applied);
    RUN_TEST(one_bit_grey_is_black_and_white);
    RUN_TEST(palettes_give_their_colors_and_transparency);
    RUN_TEST(sixteen_bits_round_to_the_nearest_eight);
    RUN_TEST(interlaced_pixels_are_in_order);
    RUN_TEST(every_cut_and_every_damaged_byte_is_refused_or_read_but_never_crashes);
    RUN_TEST(text_and_oversize_are_refused);
    RUN_TEST(an_impossible_size_cannot_be_saved);
    return UNITY_END();
}
