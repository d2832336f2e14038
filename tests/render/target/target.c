/* The target: the position of each pixel in its tile, clears of any part, and images of any size that are
 * read. */
#include "tests/support/blit/blits.h"
#include "render/target/target.h"

#include "base/bits.h"

#include <stdlib.h>
#include <unity.h>

static struct target target;
static uint32_t *image;
static float *depth;

static const uint32_t sizes[][2] = {{1, 1}, {3, 2}, {64, 64}, {65, 63}, {130, 129}, {2, 200}, {191, 7}};
enum { SIZES = sizeof sizes / sizeof *sizes };

static void open_target_of(const uint32_t size[2], enum triptych_depth_format format)
{
    struct triptych_target_description description = {
        .width = size[0], .height = size[1], .depth_format = format};
    TEST_ASSERT_EQUAL_INT(0, target_create(&target, &description, false, NULL));
    image = malloc(sizeof *image * size[0] * size[1]);
    depth = malloc(sizeof *depth * size[0] * size[1]);
    TEST_ASSERT_TRUE(image && depth);
}

static void open_target(const uint32_t size[2])
{
    open_target_of(size, TRIPTYCH_DEPTH_D32F_LOCKABLE);
}

static void close_target(void)
{
    target_destroy(&target);
    free(image);
    free(depth);
    image = NULL;
    depth = NULL;
}

void setUp(void)
{
}

void tearDown(void)
{
    close_target();
}

static void read_all(void)
{
    const struct target_reading reading = {.target = &target, .sample = SAMPLE_RESOLVED};
    for (uint32_t row = 0; row < target.rows; row++) {
        target_read_color(&reading, row, image, target.width);
        target_read_depth(&target, SAMPLE_RESOLVED, row, depth);
    }
}

/* The position of a pixel according to contract/layout.h: the number of its tile, and of its word in the
 * tile. */
static uint32_t tile_of(uint32_t x, uint32_t y)
{
    return y / TILE_SIZE * target.columns + x / TILE_SIZE;
}

static uint32_t word_of(uint32_t x, uint32_t y)
{
    static const uint8_t lane[4][4] = {{0, 1, 4, 5}, {2, 3, 6, 7}, {8, 9, 12, 13}, {10, 11, 14, 15}};
    return (y % TILE_SIZE / 4 * 16 + x % TILE_SIZE / 4) * 16 + lane[y % 4][x % 4];
}

static void every_pixel_is_read_from_its_place(void)
{
    for (int s = 0; s < SIZES; s++) {
        open_target(sizes[s]);
        for (uint32_t y = 0; y < target.height; y++)
            for (uint32_t x = 0; x < target.width; x++) {
                target_fill_color(&target, tile_of(x, y))[word_of(x, y)] = y << 16 | x;
                target_fill_depth(&target, tile_of(x, y))[word_of(x, y)] =
                    bits_of_float((float)(y * 1000 + x));
            }
        read_all();
        for (uint32_t y = 0; y < target.height; y++)
            for (uint32_t x = 0; x < target.width; x++) {
                TEST_ASSERT_EQUAL_HEX32(y << 16 | x, image[y * target.width + x]);
                TEST_ASSERT_EQUAL_FLOAT(y * 1000 + x, depth[y * target.width + x]);
            }
        close_target();
    }
}

static void apply(const struct clear *clear)
{
    struct error error = {{0}};
    struct clear whole = *clear;
    const struct rectangle *area = clear->parts ? NULL : &clear->area;
    TEST_ASSERT_EQUAL_INT(0, target_acquire_clear(&target, &emulated_blits, area, &whole, &error));
    for (uint32_t tile = 0; tile < target.columns * target.rows; tile++)
        target_clear_tile(&target, tile, &whole);
    target_release_clear(&emulated_blits, &whole);
}

/* Clears random rectangles of colour, depth or both, and compares with pixels that are set one by one. */
static void clears_set_their_pixels_and_no_others(void)
{
    uint32_t seed = 9;
    for (int s = 0; s < SIZES; s++) {
        open_target(sizes[s]);
        uint32_t pixels = target.width * target.height;
        uint32_t *color = calloc(pixels, sizeof *color);
        float *z = malloc(pixels * sizeof *z);
        TEST_ASSERT_TRUE(color && z);
        for (uint32_t i = 0; i < pixels; i++)
            z[i] = 1;
        for (int n = 0; n < 20; n++) {
            int32_t edge[4];
            for (int i = 0; i < 4; i++) {
                seed = seed * 1664525 + 1013904223;
                edge[i] = (int32_t)((seed >> 8) % ((i & 1 ? target.height : target.width) + 1));
            }
            struct clear clear = {.area = {edge[0], edge[1], edge[2], edge[3]},
                                  .color = {seed},
                                  .depth = n % 3 != 1 ? bits_of_float((float)n) : 0,
                                  .set_color = n % 3 != 0,
                                  .depth_mask = n % 3 != 1 ? 0xffffffff : 0};
            if (n % 5 == 4)
                clear.area = (struct rectangle){0, 0, (int32_t)target.width, (int32_t)target.height};
            apply(&clear);
            for (int32_t y = clear.area.y0; y < clear.area.y1; y++)
                for (int32_t x = clear.area.x0; x < clear.area.x1; x++) {
                    uint32_t i = (uint32_t)y * target.width + (uint32_t)x;
                    color[i] = clear.set_color ? clear.color[0] : color[i];
                    z[i] = clear.depth_mask ? (float)n : z[i];
                }
            read_all();
            TEST_ASSERT_EQUAL_MEMORY(color, image, pixels * sizeof *color);
            TEST_ASSERT_EQUAL_MEMORY(z, depth, pixels * sizeof *z);
        }
        free(color);
        free(z);
        close_target();
    }
}

/* Clears random rectangles of depth, stencil or both, which share a word. */
static void depth_and_stencil_are_cleared_apart(void)
{
    uint32_t seed = 5;
    open_target_of((uint32_t[2]){130, 70}, TRIPTYCH_DEPTH_D24S8);
    uint32_t pixels = target.width * target.height;
    uint8_t *stencil = calloc(pixels, 1), *got = malloc(pixels);
    float *z = malloc(pixels * sizeof *z);
    TEST_ASSERT_TRUE(stencil && got && z);
    for (uint32_t i = 0; i < pixels; i++)
        z[i] = 1;
    for (int n = 0; n < 60; n++) {
        int32_t edge[4];
        for (int i = 0; i < 4; i++) {
            seed = seed * 1664525 + 1013904223;
            edge[i] = (int32_t)((seed >> 8) % ((i & 1 ? target.height : target.width) + 1));
        }
        int which = 1 + n % 3;
        uint32_t code = seed >> 8, value = (uint32_t)n * 3;
        struct clear clear = {.area = {edge[0], edge[1], edge[2], edge[3]},
                              .depth = (which & 1 ? code << 8 : 0) | (which & 2 ? value : 0),
                              .depth_mask = (which & 1 ? 0xffffff00 : 0) | (which & 2 ? 255 : 0)};
        if (n % 5 == 4)
            clear.area = (struct rectangle){0, 0, 130, 70};
        apply(&clear);
        for (int32_t y = clear.area.y0; y < clear.area.y1; y++)
            for (int32_t x = clear.area.x0; x < clear.area.x1; x++) {
                uint32_t i = (uint32_t)y * target.width + (uint32_t)x;
                z[i] = which & 1 ? (float)(code / 16777215.0) : z[i];
                stencil[i] = which & 2 ? (uint8_t)value : stencil[i];
            }
        for (uint32_t row = 0; row < target.rows; row++) {
            target_read_depth(&target, SAMPLE_RESOLVED, row, depth);
            target_read_stencil(&target, SAMPLE_RESOLVED, row, got);
        }
        TEST_ASSERT_EQUAL_MEMORY(z, depth, pixels * sizeof *z);
        TEST_ASSERT_EQUAL_MEMORY(stencil, got, pixels);
    }
    free(stencil);
    free(got);
    free(z);
}

/* The depth that a code represents has this code again. Larger depths have larger codes. */
static void depth_codes_survive_reading(void)
{
    static const struct {
        enum triptych_depth_format format;
        uint32_t last, step;
    } rows[] = {{TRIPTYCH_DEPTH_D16, 0xffff, 1},
                {TRIPTYCH_DEPTH_D15S1, 0x7fff, 1},
                {TRIPTYCH_DEPTH_D24S8, 0xffffff, 97},
                {TRIPTYCH_DEPTH_D24X4S4, 0xffffff, 89},
                {TRIPTYCH_DEPTH_D24FS8, 0xf00000, 13}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        float before = -1;
        for (uint32_t code = 0;;
             code = rows[r].last - code < rows[r].step ? rows[r].last : code + rows[r].step) {
            float value = depth_decode(rows[r].format, code << 8);
            TEST_ASSERT_TRUE(value > before);
            before = value;
            if (depth_encode(rows[r].format, value) != code << 8)
                TEST_ASSERT_EQUAL_HEX32(code << 8, depth_encode(rows[r].format, value));
            if (code == rows[r].last)
                break;
        }
        TEST_ASSERT_EQUAL_FLOAT(1, before);
    }
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, depth_encode(TRIPTYCH_DEPTH_D32, 1));
    TEST_ASSERT_EQUAL_HEX32(0x80000000, depth_encode(TRIPTYCH_DEPTH_D32, 0.5f));
    TEST_ASSERT_EQUAL_HEX32(0x7fffff80, depth_encode(TRIPTYCH_DEPTH_D32, 0x0.ffffffp-1f));
    TEST_ASSERT_EQUAL_HEX32(0xbfffffff, depth_encode(TRIPTYCH_DEPTH_D32, 0.75f));
    TEST_ASSERT_EQUAL_HEX32(0, depth_encode(TRIPTYCH_DEPTH_D32, 0));
    TEST_ASSERT_EQUAL_FLOAT(1, depth_decode(TRIPTYCH_DEPTH_D32, 0xffffffff));
}

static void whole_clears_touch_no_pixel_until_one_is_needed(void)
{
    open_target((uint32_t[2]){128, 64});
    target_fill_color(&target, 0)[5] = 77;
    apply(&(struct clear){.area = {0, 0, 128, 64}, .color = {3}, .set_color = true});
    TEST_ASSERT_EQUAL_UINT32(77, target.color[5]);
    TEST_ASSERT_EQUAL_UINT32(3, target_fill_color(&target, 0)[5]);
    TEST_ASSERT_EQUAL_UINT32(3, target.color[5]);
}

static void a_clear_that_is_replaced_writes_nothing(void)
{
    open_target((uint32_t[2]){128, 64});
    target_fill_color(&target, 0)[5] = 77;
    apply(&(struct clear){.area = {0, 0, 128, 64}, .color = {3}, .set_color = true});
    target_replace_color(&target, 0);
    TEST_ASSERT_EQUAL_UINT32(77, target_fill_color(&target, 0)[5]);
    TEST_ASSERT_TRUE(target_color_clear(&target, 0, 0)->changed);
    TEST_ASSERT_EQUAL_UINT32(3, target_fill_color(&target, 1)[5]);
}

/* In both orders. */
static void a_fill_sets_a_tile_and_no_other(void)
{
    for (int quad_rows = 0; quad_rows < 2; quad_rows++) {
        struct tile_memory *memory = attachment_memory_create(2, 3, 1, quad_rows, NULL);
        TEST_ASSERT_NOT_NULL(memory);
        for (uint32_t i = 0; i < 6 * TILE_PIXELS; i++)
            memory->words[i] = 1;
        tile_order_fill(&memory->order, tile_memory_words(memory, 1, 1, 0), 0x12345678);
        for (uint32_t tile = 0; tile < 6; tile++)
            for (uint32_t i = 0; i < TILE_PIXELS; i++) {
                const uint32_t *words = tile_memory_words(memory, tile % 2, tile / 2, 0);
                uint32_t word = words[tile_order_word(&memory->order, i % TILE_SIZE, i / TILE_SIZE)];
                TEST_ASSERT_EQUAL_HEX32(tile == 3 ? 0x12345678 : 1, word);
            }
        attachment_memory_release(memory);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_pixel_is_read_from_its_place);
    RUN_TEST(clears_set_their_pixels_and_no_others);
    RUN_TEST(depth_and_stencil_are_cleared_apart);
    RUN_TEST(depth_codes_survive_reading);
    RUN_TEST(whole_clears_touch_no_pixel_until_one_is_needed);
    RUN_TEST(a_clear_that_is_replaced_writes_nothing);
    RUN_TEST(a_fill_sets_a_tile_and_no_other);
    return UNITY_END();
}
