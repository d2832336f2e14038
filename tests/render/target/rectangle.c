/* Rectangles of pixels in tiles and in texels, compared with pixels that the test finds one by one: rows,
 * samples, memory in every format, conversions. */
#include "tests/render/target/pixels.h"
#include "tests/support/blit/blits.h"

#include "render/target/resolve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
    error_clear(&reason);
}

void tearDown(void)
{
    drop(&pixels);
    drop(&other);
}

/* --- Rows --- */

static uint32_t averaged_number(const struct pixels *p, uint32_t x, uint32_t y, uint32_t plane)
{
    float sum = 0, number;
    uint32_t bits;
    for (uint32_t s = 0; s < p->tiles->samples; s++) {
        memcpy(&number, word_at(p, x, y, s, plane), sizeof number);
        sum += number;
    }
    sum /= (float)p->tiles->samples;
    memcpy(&bits, &sum, sizeof bits);
    return bits;
}

static void expect_rows(const struct pixels *p)
{
    uint32_t row[4 * PIXELS_ROW], words = pixels_words(p);
    for (int n = 0; n < 500; n++) {
        uint32_t x = random_word() % WIDTH, y = random_word() % HEIGHT;
        uint32_t most = 64 - x % 64 < WIDTH - x ? 64 - x % 64 : WIDTH - x;
        uint32_t count = 1 + random_word() % most;
        pixels_read_row(p, x, y, count, row);
        for (uint32_t i = 0; i < count * words; i++) {
            uint32_t at = x + i / words;
            TEST_ASSERT_EQUAL_HEX32(*word_at(p, at, y, 0, i % words), row[i]);
        }
    }
}

static void test_rows_are_read_from_tiles(void)
{
    for (int f = 0; f < 4; f++) {
        make_color(&pixels, drawn[f], 1);
        fill_random(&pixels);
        expect_rows(&pixels);
    }
}

/* Every word of the averages, but those of tiles that only remember their clear. */
static void expect_averages(const struct pixels *resolved)
{
    uint32_t words = pixels_words(&pixels);
    for (uint32_t y = 0; y < pixels.height; y++)
        for (uint32_t x = 0; x < pixels.width; x++) {
            uint32_t tile = y / TILE_SIZE * pixels.tiles->columns + x / TILE_SIZE;
            for (uint32_t p = 0; p < words && !pixels.tiles->color_clear[tile].pending; p++)
                TEST_ASSERT_EQUAL_HEX32(words == 1 ? averaged_byte_word(&pixels, x, y)
                                                   : averaged_number(&pixels, x, y, p),
                                        *word_at(resolved, x, y, 0, p));
        }
}

static void resolve_all(const struct pixels *resolved)
{
    const struct routine *routine =
        target_acquire_resolve(&emulated_blits, (enum target_storage)pixels.format->target,
                               pixels.tiles->samples, &pixels.tiles->memory->order, &reason);
    TEST_ASSERT_NOT_NULL(routine);
    for (uint32_t tile = 0; tile < pixels.tiles->columns * pixels.tiles->rows; tile++)
        pixels_resolve_tile(routine, &pixels, resolved, tile);
    blit_release(&emulated_blits, routine);
}

static void make_both(int f, uint32_t width, uint32_t height, uint32_t samples)
{
    make_color_of_size(&pixels, drawn[f], width, height, samples);
    make_color_of_size(&other, drawn[f], width, height, 1);
    other.quad_rows = false;
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(&other, &reason));
    fill_random(&pixels);
}

static void test_samples_of_tiles_are_averaged(void)
{
    for (int f = 0; f < 4; f++)
        for (uint32_t samples = 2; samples <= 8; samples *= 2) {
            make_both(f, WIDTH, HEIGHT, samples);
            pixels.tiles->color_clear[0] = (struct color_clear){{7, 8, 9, 10}, .pending = true};
            resolve_all(&other);
            expect_averages(&other);
            TEST_ASSERT_TRUE(other.tiles->color_clear[0].pending);
            TEST_ASSERT_EQUAL_HEX32(7, other.tiles->color_clear[0].word[0]);
            TEST_ASSERT_FALSE(other.tiles->color_clear[1].pending);
        }
}

/* The planes of both orders of memory then have the same distance. */
static void test_samples_of_a_single_tile_are_averaged(void)
{
    for (int f = 0; f < 4; f++) {
        make_both(f, 5, 7, 4);
        resolve_all(&other);
        expect_averages(&other);
    }
}

static void test_rows_are_read_from_texels_and_from_depth(void)
{
    make_texels(&pixels, TRIPTYCH_SURFACE_A8R8G8B8);
    fill_random(&pixels);
    expect_rows(&pixels);
    make_texels(&pixels, TRIPTYCH_SURFACE_G16R16);
    fill_random(&pixels);
    expect_rows(&pixels);
    make_depth(&pixels, TRIPTYCH_DEPTH_D24S8);
    fill_random(&pixels);
    expect_rows(&pixels);
}

/* Writes parts of rows with all samples, and nothing else. */
static void test_rows_are_written_to_all_samples_and_nowhere_else(void)
{
    for (uint32_t samples = 1; samples <= 4; samples *= 4)
        for (int f = 0; f < 4; f++) {
            static uint32_t before[4][HEIGHT][WIDTH][4];
            make_color(&pixels, drawn[f], samples);
            fill_random(&pixels);
            uint32_t words = pixels_words(&pixels), row[4 * PIXELS_ROW];
            for (uint32_t y = 0; y < HEIGHT; y++)
                for (uint32_t x = 0; x < WIDTH; x++)
                    for (uint32_t i = 0; i < samples * words; i++)
                        before[i / words][y][x][i % words] = *word_at(&pixels, x, y, i / words, i % words);
            for (int n = 0; n < 50; n++) {
                uint32_t x = random_word() % WIDTH, y = random_word() % HEIGHT;
                uint32_t most = 64 - x % 64 < WIDTH - x ? 64 - x % 64 : WIDTH - x;
                uint32_t count = 1 + random_word() % most;
                for (uint32_t i = 0; i < count * words; i++) {
                    row[i] = random_word();
                    for (uint32_t s = 0; s < samples; s++)
                        before[s][y][x + i / words][i % words] = row[i];
                }
                pixels_write_row(&pixels, x, y, count, row);
            }
            for (uint32_t y = 0; y < HEIGHT; y++)
                for (uint32_t x = 0; x < WIDTH; x++)
                    for (uint32_t i = 0; i < samples * words; i++)
                        TEST_ASSERT_EQUAL_HEX32(before[i / words][y][x][i % words],
                                                *word_at(&pixels, x, y, i / words, i % words));
        }
}

static void test_a_clear_is_read_and_remains_around_what_is_written(void)
{
    uint32_t row[4 * PIXELS_ROW];
    make_color(&pixels, TRIPTYCH_SURFACE_G16R16, 2);
    for (int i = 0; i < 6; i++)
        memcpy(pixels.tiles->color_clear[i].word, ((uint32_t[]){1, 2, 3, 4}), 16);
    pixels_read_row(&pixels, 10, 10, 2, row);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(((uint32_t[]){1, 2, 3, 4, 1, 2, 3, 4}), row, 8);
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(&pixels, &reason));
    pixels_write_row(&pixels, 70, 10, 1, (uint32_t[]){5, 6, 7, 8});
    for (uint32_t s = 0; s < 2; s++)
        for (uint32_t p = 0; p < 4; p++) {
            TEST_ASSERT_EQUAL_HEX32(5 + p, *word_at(&pixels, 70, 10, s, p));
            TEST_ASSERT_EQUAL_HEX32(1 + p, *word_at(&pixels, 71, 10, s, p));
            TEST_ASSERT_EQUAL_HEX32(1 + p, *word_at(&pixels, 64, 63, s, p));
        }
    TEST_ASSERT_TRUE(pixels.tiles->color_clear[0].pending);
    TEST_ASSERT_FALSE(pixels.tiles->color_clear[1].pending);
}

static void test_fills_of_whole_tiles_are_remembered_and_others_are_written(void)
{
    const uint32_t word = 0x12345678;
    uint32_t row[PIXELS_ROW];
    make_color(&pixels, TRIPTYCH_SURFACE_A8R8G8B8, 1);
    fill_random(&pixels);
    uint32_t kept = *word_at(&pixels, 9, 3, 0, 0);
    pixels_fill(&pixels, &(struct triptych_rectangle){128, 64, 22, 6}, &word);
    pixels_fill(&pixels, &(struct triptych_rectangle){10, 3, 50, 2}, &word);
    TEST_ASSERT_TRUE(pixels.tiles->color_clear[5].pending);
    TEST_ASSERT_FALSE(pixels.tiles->color_clear[0].pending);
    pixels_read_row(&pixels, 149, 69, 1, row);
    TEST_ASSERT_EQUAL_HEX32(word, row[0]);
    pixels_read_row(&pixels, 9, 3, 52, row);
    TEST_ASSERT_EQUAL_HEX32(kept, row[0]);
    TEST_ASSERT_EACH_EQUAL_HEX32(word, row + 1, 50);
    TEST_ASSERT_TRUE(row[51] != word);
}

static void test_written_depth_forgets_its_bounds(void)
{
    const uint32_t word = 0x80000003;
    make_depth(&pixels, TRIPTYCH_DEPTH_D24S8);
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(&pixels, &reason));
    TEST_ASSERT_EQUAL_HEX32(0xffffff00, pixels.tiles->depth_clear[0].range.least);
    pixels_write_row(&pixels, 1, 1, 1, &word);
    TEST_ASSERT_EQUAL_HEX32(0, pixels.tiles->depth_clear[0].range.least);
    TEST_ASSERT_EQUAL_HEX32(0xffffff00, *word_at(&pixels, 2, 1, 0, 0));
    pixels_fill(&pixels, &(struct triptych_rectangle){0, 0, 64, 64}, &word);
    TEST_ASSERT_EQUAL_HEX32(0x80000000, pixels.tiles->depth_clear[0].range.least);
    TEST_ASSERT_EQUAL_HEX32(0x80000000, pixels.tiles->depth_clear[0].range.most);
    TEST_ASSERT_EQUAL_HEX32(word, pixels.tiles->depth_clear[0].word);
}

/* --- Memory --- */

static void test_parts_cover_a_rectangle_once(void)
{
    static uint8_t covered[HEIGHT][WIDTH];
    for (int n = 0; n < 200; n++) {
        struct triptych_rectangle r = {random_word() % WIDTH, random_word() % HEIGHT, 0, 0};
        r.width = 1 + random_word() % (WIDTH - r.x);
        r.height = 1 + random_word() % (HEIGHT - r.y);
        memset(covered, 0, sizeof covered);
        for (uint32_t i = 0; i < pixels_parts(&r); i++) {
            struct triptych_rectangle part = pixels_part(&r, i);
            TEST_ASSERT_EQUAL_UINT(part.x / 64, (part.x + part.width - 1) / 64);
            TEST_ASSERT_EQUAL_UINT(part.y / 64, (part.y + part.height - 1) / 64);
            for (uint32_t y = part.y; y < part.y + part.height; y++)
                for (uint32_t x = part.x; x < part.x + part.width; x++)
                    covered[y][x]++;
        }
        for (uint32_t y = 0; y < HEIGHT; y++)
            for (uint32_t x = 0; x < WIDTH; x++)
                TEST_ASSERT_EQUAL_UINT8(x - r.x < r.width && y - r.y < r.height, covered[y][x]);
    }
}

enum { PITCH = 16 * WIDTH + 5, GUARD = 0x5a };

static uint8_t memory[HEIGHT][PITCH], back[HEIGHT][PITCH];

static struct pixels_memory memory_of(const struct pixels *p, const struct triptych_rectangle *r,
                                      const struct format *format, void *data)
{
    return (struct pixels_memory){*p, *r, format, data, PITCH};
}

static void read_all(const struct pixels_memory *m)
{
    for (uint32_t i = 0; i < pixels_parts(&m->rectangle); i++)
        pixels_read_part(m, i);
}

static void write_all(const struct pixels_memory *m)
{
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(&m->pixels, &reason));
    for (uint32_t i = 0; i < pixels_parts(&m->rectangle); i++)
        pixels_write_part(m, i);
}

/* Pixels of every format of targets, written from memory of the same format, are the same bytes in memory;
 * other bytes do not change. Bits of no channel are 0, and numbers are of the format. */
static void test_memory_of_the_same_format_comes_back(void)
{
    const struct triptych_rectangle r = {13, 5, 125, 62};
    for (unsigned f = 0; format_at(f); f++) {
        const struct format *format = format_at(f);
        if (!(format->roles & ROLE_TARGET) || !pixels_is_memory_format(format))
            continue;
        make_color(&pixels, (enum triptych_surface_format)format->number, 1);
        for (uint32_t y = 0; y < r.height; y++)
            for (uint32_t x = 0; x < r.width; x++) {
                float number[4];
                uint8_t texel[16];
                for (int c = 0; c < 4; c++)
                    number[c] = (float)(random_word() % 256) / 255;
                format_encode(format_find(TRIPTYCH_SURFACE_A32B32G32R32F), number, 1, 1, 1, texel, 16);
                uint32_t word = random_word();
                format_encode(format, format->storage == STORAGE_RGBA8 ? (void *)&word : (void *)number, 1, 1,
                              1, memory[y] + x * format->bytes, 16);
            }
        memset(back, GUARD, sizeof back);
        struct pixels_memory in = memory_of(&pixels, &r, format, memory),
                             out = memory_of(&pixels, &r, format, back);
        write_all(&in);
        read_all(&out);
        for (uint32_t y = 0; y < r.height; y++) {
            TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(memory[y], back[y], r.width * format->bytes, format->name);
            TEST_ASSERT_EACH_EQUAL_HEX8_MESSAGE(GUARD, back[y] + r.width * format->bytes,
                                                PITCH - r.width * format->bytes, format->name);
        }
        TEST_ASSERT_EACH_EQUAL_HEX8(GUARD, back[r.height], PITCH);
    }
}

static void test_pixels_are_read_in_other_formats(void)
{
    const struct triptych_rectangle r = {70, 3, 1, 1};
    make_color(&pixels, TRIPTYCH_SURFACE_A8R8G8B8, 1);
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(&pixels, &reason));
    pixels_write_row(&pixels, 70, 3, 1, &(uint32_t){0x80ff3311});
    struct pixels_memory m = memory_of(&pixels, &r, format_find(TRIPTYCH_SURFACE_A8R8G8B8), back);
    read_all(&m);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0xff, 0x33, 0x11, 0x80}), back[0], 4);
    m.format = format_find(TRIPTYCH_SURFACE_R5G6B5);
    read_all(&m); /* 17 * 31 / 255 = 2.07, 51 * 63 / 255 = 12.6 */
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){(13 & 7) << 5 | 31, 2 << 3 | 13 >> 3}), back[0], 2);
    m.format = format_find(TRIPTYCH_SURFACE_L8);
    read_all(&m);
    TEST_ASSERT_EQUAL_HEX8(0x11, back[0][0]);
    m.format = format_find(TRIPTYCH_SURFACE_L16);
    read_all(&m);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x11, 0x11}), back[0], 2);
    m.format = format_find(TRIPTYCH_SURFACE_R8G8B8);
    read_all(&m);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0xff, 0x33, 0x11}), back[0], 3);
}

static const struct depth_case {
    enum triptych_depth_format format;
    uint8_t bytes;
    uint32_t memory, word; /* in memory, and as stored */
} depth_cases[] = {
    {TRIPTYCH_DEPTH_D16, 2, 0x1234, 0x123400},
    {TRIPTYCH_DEPTH_D16_LOCKABLE, 2, 0xffff, 0xffff00},
    {TRIPTYCH_DEPTH_D15S1, 2, 0x8003, 0x400101},
    {TRIPTYCH_DEPTH_D24S8, 4, 0x123456ab, 0x123456ab},
    {TRIPTYCH_DEPTH_D24X8, 4, 0x12345600, 0x12345600},
    {TRIPTYCH_DEPTH_D24X4S4, 4, 0x12345609, 0x12345609},
    {TRIPTYCH_DEPTH_D24FS8, 4, 0x12345607, 0x12345607},
    {TRIPTYCH_DEPTH_D32, 4, 0x12345678, 0x12345678},
    {TRIPTYCH_DEPTH_D32F_LOCKABLE, 4, 0x3f123456, 0x3f123456},
};

static void test_depth_is_in_memory_as_in_direct3d(void)
{
    const struct triptych_rectangle r = {3, 1, 1, 1};
    for (unsigned i = 0; i < sizeof depth_cases / sizeof *depth_cases; i++) {
        const struct depth_case *c = depth_cases + i;
        uint32_t read = 0, written = c->memory;
        make_depth(&pixels, c->format);
        struct pixels_memory in = memory_of(&pixels, &r, NULL, &written);
        struct pixels_memory out = memory_of(&pixels, &r, NULL, &read);
        TEST_ASSERT_EQUAL_UINT(c->bytes, pixels_memory_bytes(&pixels, NULL));
        write_all(&in);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(c->word, *word_at(&pixels, 3, 1, 0, 0),
                                        depth_formats[c->format].name);
        read_all(&out);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(c->memory, read, depth_formats[c->format].name);
    }
}

static void test_depth_that_drawing_cannot_write_is_limited(void)
{
    static const uint32_t words[][2] = {{0x7fc00000, 0},
                                        {0x40000000, 0x3f800000},
                                        {0xbf800000, 0},
                                        {0x80000000, 0},
                                        {0x3f800000, 0x3f800000}};
    make_depth(&pixels, TRIPTYCH_DEPTH_D32F_LOCKABLE);
    for (int i = 0; i < 5; i++) {
        uint32_t word = words[i][0];
        struct pixels_memory in = memory_of(&pixels, &(struct triptych_rectangle){0, 0, 1, 1}, NULL, &word);
        write_all(&in);
        TEST_ASSERT_EQUAL_HEX32(words[i][1], *word_at(&pixels, 0, 0, 0, 0));
    }
}

/* --- Conversion --- */

static void test_bytes_become_what_a_draw_writes(void)
{
    for (unsigned f = 0; format_at(f); f++) {
        const struct format *format = format_at(f), *source = format_find(TRIPTYCH_SURFACE_A8B8G8R8);
        for (uint32_t byte = 0; format->roles & ROLE_TARGET && pixels_is_memory_format(format) && byte < 256;
             byte++) {
            uint32_t word[4] = {byte * 0x01010101}, converted[4], drawn_words[4];
            float color[4];
            color_numbers(TARGET_8888, word, color);
            color_encode(format, color, drawn_words);
            pixels_convert_row(source, format, word, 1, converted);
            TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(drawn_words, converted,
                                                  format->storage == STORAGE_RGBA8 ? 1 : 4, format->name);
        }
    }
}

static void test_formats_that_are_not_drawn_to_get_their_own_values(void)
{
    const float numbers[4] = {0.5f, 0.25f, 1, 0.75f};
    const struct format *source = format_find(TRIPTYCH_SURFACE_A32B32G32R32F);
    uint32_t row[4], result[4];
    memcpy(row, numbers, sizeof row);
    pixels_convert_row(source, format_find(TRIPTYCH_SURFACE_L8), row, 1, result);
    TEST_ASSERT_EQUAL_HEX32(0xff808080, result[0]);
    pixels_convert_row(source, format_find(TRIPTYCH_SURFACE_A8), row, 1, result);
    TEST_ASSERT_EQUAL_HEX32(0xbf000000, result[0]);
    pixels_convert_row(source, format_find(TRIPTYCH_SURFACE_L16), row, 1, result);
    float luminance[4];
    memcpy(luminance, result, sizeof luminance);
    TEST_ASSERT_TRUE(luminance[0] == 32768.0f / 65535 && luminance[2] == luminance[0] && luminance[3] == 1);
    pixels_convert_row(source, format_find(TRIPTYCH_SURFACE_DXT1), row, 1, result);
    TEST_ASSERT_EQUAL_HEX32(0xbfff4080, result[0]);
}

static void test_numbers_become_the_words_that_a_draw_writes(void)
{
    static const enum triptych_surface_format formats[] = {TRIPTYCH_SURFACE_A8R8G8B8,
                                                           TRIPTYCH_SURFACE_X8B8G8R8};
    for (int n = 0; n < 20000; n++) {
        const struct format *format = format_find(formats[n % 2]);
        float numbers[4];
        uint32_t expected[4], word;
        for (int c = 0; c < 4; c++)
            numbers[c] = n % 5 ? (float)(random_word() % 4096) / 2048 - 0.5f
                               : (float)(random_word() % 511) / 510; /* halves between bytes */
        if (n % 7 == 0)
            numbers[n % 4] = n % 2 ? NAN : -INFINITY;
        color_encode(format, numbers, expected);
        pixels_convert_numbers(format, numbers, 1, &word);
        TEST_ASSERT_EQUAL_HEX32(expected[0], word);
    }
}

/* Every test for both orders of words in memory. */
int main(void)
{
    UNITY_BEGIN();
    for (int order = 0; order < 2; order++) {
        quad_rows = order;
        RUN_TEST(test_rows_are_read_from_tiles);
        RUN_TEST(test_samples_of_tiles_are_averaged);
        RUN_TEST(test_samples_of_a_single_tile_are_averaged);
        RUN_TEST(test_rows_are_read_from_texels_and_from_depth);
        RUN_TEST(test_rows_are_written_to_all_samples_and_nowhere_else);
        RUN_TEST(test_a_clear_is_read_and_remains_around_what_is_written);
        RUN_TEST(test_fills_of_whole_tiles_are_remembered_and_others_are_written);
        RUN_TEST(test_written_depth_forgets_its_bounds);
        RUN_TEST(test_parts_cover_a_rectangle_once);
        RUN_TEST(test_memory_of_the_same_format_comes_back);
        RUN_TEST(test_pixels_are_read_in_other_formats);
        RUN_TEST(test_depth_is_in_memory_as_in_direct3d);
        RUN_TEST(test_depth_that_drawing_cannot_write_is_limited);
        RUN_TEST(test_bytes_become_what_a_draw_writes);
        RUN_TEST(test_formats_that_are_not_drawn_to_get_their_own_values);
        RUN_TEST(test_numbers_become_the_words_that_a_draw_writes);
    }
    return UNITY_END();
}
