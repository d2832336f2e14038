/* The clip mask (src/spec/pixel/clip_mask.h), on every engine: which pixels a draw changes, and each colour
 * multiplied by its mask, computed from the definition. */
#include "tests/support/picture/canvas.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 37, HEIGHT = 29 };

static uint8_t mask[HEIGHT][WIDTH];
static triptych_texture *bound;

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static triptych_texture *make_texture(enum triptych_surface_format format, unsigned width, unsigned height,
                                      const void *data, size_t pitch)
{
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, format, width, height, 1, 1};
    triptych_texture *texture;
    OK(triptych_texture_define(device, &description, &texture));
    if (data)
        OK(triptych_texture_update(device, texture, 0, 0, NULL, data, pitch, 0));
    return texture;
}

static void make_mask(enum triptych_surface_format format)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        mask[i / WIDTH][i % WIDTH] = (uint8_t)(i % 5 ? random_word() : i % 2 ? 255 : 0);
    bound = make_texture(format, WIDTH, HEIGHT, mask, WIDTH);
}

/* Returns the mask of a pixel, or -1 if the draw does not change it. */
static int mask_at(int x, int y, int mask_x, int mask_y, const struct triptych_rectangle *box)
{
    int u = x - mask_x, v = y - mask_y;
    bool inside = x >= (int)box->x && y >= (int)box->y && x < (int)(box->x + box->width) &&
                  y < (int)(box->y + box->height);
    return inside && u >= 0 && v >= 0 && u < WIDTH && v < HEIGHT ? mask[v][u] : -1;
}

static unsigned product(unsigned a, unsigned b)
{
    return (2 * a * b + 255) / 510; /* the nearest: no product of bytes is a half */
}

/* A colour of bytes, which replaces the target's or is added to it. */
static void check_bytes(enum triptych_surface_format format, int x, int y, struct triptych_rectangle box,
                        bool added)
{
    const uint32_t background = 0x40302010;
    char what[64];
    make_mask(format);
    bind_random_texture(SIZE, SIZE);
    clear_to(background);
    set(TRIPTYCH_STATE_SRCBLEND, "one");
    set(TRIPTYCH_STATE_DESTBLEND, added ? "one" : "zero");
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    OK(triptych_set_clip_mask(device, bound, x, y, box.x, box.y, box.width, box.height));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    snprintf(what, sizeof what, "mask at %d, %d, box of %u x %u", x, y, box.width, box.height);
    for (int i = 0; i < SIZE * SIZE; i++) {
        int byte = mask_at(i % SIZE, i / SIZE, x, y, &box);
        uint32_t word = byte < 0 ? background : 0;
        for (int c = 0; c < 4 && byte >= 0; c++) {
            unsigned value = product(channel(texel[i], c), (unsigned)byte);
            value += added ? channel(background, c) : 0;
            word |= (value < 255 ? value : 255) << 8 * c;
        }
        expect_pixel(i % SIZE, i / SIZE, word, what);
    }
    OK(triptych_texture_destroy(device, bound)); /* which is the mask no longer */
}

static void check_all_bytes(void)
{
    check_bytes(TRIPTYCH_SURFACE_R8, 0, 0, (struct triptych_rectangle){0, 0, SIZE, SIZE}, false);
    check_bytes(TRIPTYCH_SURFACE_A8, -5, 9, (struct triptych_rectangle){0, 0, 8192, 8192}, true);
    check_bytes(TRIPTYCH_SURFACE_L8, 31, -7, (struct triptych_rectangle){35, 3, 17, 9}, true);
    check_bytes(TRIPTYCH_SURFACE_R8, -40, 3, (struct triptych_rectangle){0, 0, SIZE, SIZE}, false);
    check_bytes(TRIPTYCH_SURFACE_R8, 20, 20, (struct triptych_rectangle){5, 5, 9, 9}, false);
}

static void test_colors_of_bytes_are_multiplied_where_the_mask_is(void)
{
    on_every_engine(check_all_bytes);
}

/* Colours in binary32: the product of two rounded quotients is rounded. */
static void check_numbers(void)
{
    static float numbers[SIZE * SIZE][4];
    const struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {TRIPTYCH_SURFACE_A32B32G32R32F}};
    const struct triptych_rectangle box = {1, 2, 50, 50};
    OK(triptych_set_target_description(device, &description));
    make_mask(TRIPTYCH_SURFACE_R8);
    bind_random_texture(SIZE, SIZE);
    OK(triptych_set_clip_mask(device, bound, 6, -2, box.x, box.y, box.width, box.height));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_target_numbers(device, 0, numbers[0], sizeof numbers));
    for (int i = 0; i < SIZE * SIZE; i++)
        for (int c = 0; c < 4; c++) {
            int byte = mask_at(i % SIZE, i / SIZE, 6, -2, &box);
            float share = (float)byte / 255.0f, value = (float)channel(texel[i], c) / 255.0f;
            float expected = byte < 0 ? 0 : value * share;
            TEST_ASSERT_TRUE_MESSAGE(expected == numbers[i][c], "binary32");
        }
}

static void test_numbers_are_multiplied_by_the_mask_as_a_number(void)
{
    on_every_engine(check_numbers);
}

/* Depth is stored where the mask has a texel, and nowhere else. A query counts these pixels. */
static void check_tests(void)
{
    const struct triptych_rectangle box = {10, 12, 20, 11};
    triptych_query *query;
    uint64_t count;
    static float depth[SIZE * SIZE];
    make_mask(TRIPTYCH_SURFACE_R8);
    clear_to(0);
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "always");
    OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
    OK(triptych_set_clip_mask(device, bound, 3, 3, box.x, box.y, box.width, box.height));
    OK(triptych_query_begin(device, query));
    draw_square(0.25f, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_query_end(device, query));
    OK(triptych_query_result(device, query, &count));
    TEST_ASSERT_EQUAL_UINT64(20 * 11, count);
    OK(triptych_read_depth(device, depth, sizeof depth));
    for (int i = 0; i < SIZE * SIZE; i++) {
        float expected = mask_at(i % SIZE, i / SIZE, 3, 3, &box) < 0 ? 1 : 0.25f;
        TEST_ASSERT_TRUE(expected == depth[i]);
    }
    set(TRIPTYCH_STATE_ZENABLE, "false");
}

static void test_pixels_outside_are_discarded_and_pixels_inside_are_drawn(void)
{
    on_every_engine(check_tests);
}

/* Whatever is drawn with an empty box or without a texture is drawn as if no mask was ever set. Clears have
 * no mask. */
static void check_without(void)
{
    make_mask(TRIPTYCH_SURFACE_R8);
    for (int i = 0; i < 3; i++) {
        OK(triptych_set_clip_mask(device, i ? bound : NULL, 0, 0, 0, 0, i == 1 ? 0 : 8, i == 2 ? 0 : 8));
        clear_to(0);
        draw_square(0, 0xff336699, NULL, 0, 0, 1, 1);
        OK(triptych_read_color(device, image, sizeof image));
        for (int p = 0; p < SIZE * SIZE; p++)
            expect_pixel(p % SIZE, p / SIZE, image_word(0xff336699), "no mask");
    }
    OK(triptych_set_clip_mask(device, bound, 0, 0, 1, 1, 2, 2));
    clear_to(0x12345678);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, 0x12345678, "cleared");
}

static void test_an_empty_box_means_that_nothing_is_masked(void)
{
    on_every_engine(check_without);
}

/* A mask that was drawn: a triangle in a texture, then that triangle in white, with each sample's colour
 * multiplied by the same byte. */
static void check_drawn_mask(void)
{
    const struct triptych_target_description several = {.width = SIZE, .height = SIZE, .samples = 4};
    triptych_texture *drawn = make_texture(TRIPTYCH_SURFACE_R8, SIZE, SIZE, NULL, 0);
    const struct triptych_target_surfaces surfaces = {.color = {{.texture = drawn}}};
    OK(triptych_set_target_surfaces(device, &surfaces));
    clear_to(0);
    draw_square(0, 0xff800000, NULL, 0, 0, 1, 1); /* red 128 */
    OK(triptych_set_target_surfaces(device, NULL));
    OK(triptych_set_target_description(device, &several));
    OK(triptych_set_clip_mask(device, drawn, 0, 0, 0, 0, SIZE / 2, SIZE));
    clear_to(0);
    draw_square(0, 0xffff0080, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, p % SIZE < SIZE / 2 ? 0x80400080 : 0, "drawn");
}

static void test_a_mask_that_was_drawn_masks_all_samples(void)
{
    on_every_engine(check_drawn_mask);
}

static void check_refusals(void)
{
    triptych_texture *words = make_texture(TRIPTYCH_SURFACE_A8R8G8B8, 4, 4, NULL, 0);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_clip_mask(device, words, 0, 0, 0, 0, 4, 4));
    TEST_ASSERT_EQUAL_STRING("clip mask of format A8R8G8B8: expected a 2d texture of A8, L8 or R8",
                             triptych_error(device));
    make_mask(TRIPTYCH_SURFACE_R8);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_clip_mask(device, bound, 16385, 0, 0, 0, 4, 4));
    TEST_ASSERT_EQUAL_STRING("clip mask at 16385, 0: expected -16384 to 16384", triptych_error(device));
    struct triptych_clip_mask found;
    OK(triptych_set_clip_mask(device, bound, -3, 4, 5, 6, 7, 8));
    OK(triptych_get_clip_mask(device, &found));
    TEST_ASSERT_EQUAL_PTR(bound, found.texture);
    TEST_ASSERT_EQUAL_INT(-3, found.x);
    TEST_ASSERT_EQUAL_INT(4, found.y);
    TEST_ASSERT_EQUAL_UINT(5, found.box.x);
    TEST_ASSERT_EQUAL_UINT(6, found.box.y);
    TEST_ASSERT_EQUAL_UINT(7, found.box.width);
    TEST_ASSERT_EQUAL_UINT(8, found.box.height);
    OK(triptych_texture_destroy(device, bound));
    OK(triptych_get_clip_mask(device, &found));
    TEST_ASSERT_NULL(found.texture);
}

static void test_other_textures_and_places_are_refused(void)
{
    on_every_engine(check_refusals);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_colors_of_bytes_are_multiplied_where_the_mask_is);
    RUN_TEST(test_numbers_are_multiplied_by_the_mask_as_a_number);
    RUN_TEST(test_pixels_outside_are_discarded_and_pixels_inside_are_drawn);
    RUN_TEST(test_an_empty_box_means_that_nothing_is_masked);
    RUN_TEST(test_a_mask_that_was_drawn_masks_all_samples);
    RUN_TEST(test_other_textures_and_places_are_refused);
    return UNITY_END();
}
