/* Surfaces of textures on every engine: draws to them, samples of them, reads, copies and scaling. */
#include "tests/support/picture/canvas.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static float numbers[SIZE * SIZE][4];
static uint32_t other[SIZE * SIZE];

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static triptych_texture *make(enum triptych_texture_type type, enum triptych_surface_format format,
                              unsigned size, unsigned depth, unsigned levels)
{
    struct triptych_texture_description description = {type, format, size, size, depth, levels};
    triptych_texture *texture;
    OK(triptych_texture_define(device, &description, &texture));
    return texture;
}

static triptych_texture *make_flat(enum triptych_surface_format format)
{
    return make(TRIPTYCH_TEXTURE_2D, format, SIZE, 1, 1);
}

static void draw_to(triptych_texture *texture, unsigned level, unsigned slice)
{
    struct triptych_target_surfaces textures = {
        .color = {{.texture = texture, .level = level, .slice = slice}}};
    OK(triptych_set_target_surfaces(device, &textures));
}

static void draw_to_target(void)
{
    OK(triptych_set_target_surfaces(device, NULL));
}

static void sample(triptych_texture *texture)
{
    OK(triptych_set_texture(device, 0, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
}

static void expect_image(const uint32_t *expected, const char *what)
{
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, expected[p], what);
}

/* --- Drawing to textures --- */

/* Draws to a texture, and samples it for a draw to the next texture, twice. */
static void check_chain(void)
{
    triptych_texture *first = make_flat(TRIPTYCH_SURFACE_A8R8G8B8),
                     *second = make_flat(TRIPTYCH_SURFACE_A8R8G8B8);
    clear_to(0x12345678);
    bind_random_texture(SIZE, SIZE);
    draw_to(first, 0, 0);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    draw_to(second, 0, 0);
    sample(first);
    draw_square(0, 0xffffffff, NULL, 0, 1, 1, 0); /* upside down */
    draw_to_target();
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, 0x12345678, "the target");
    sample(second);
    draw_square(0, 0xffffffff, NULL, 0, 1, 1, 0);
    OK(triptych_read_color(device, image, sizeof image));
    expect_image(texel, "through two textures");
}

static void test_a_texture_that_was_drawn_to_is_sampled(void)
{
    on_every_engine(check_chain);
}

/* A draw to a texture keeps its other pixels. A draw that was recorded before a texture is drawn to samples
 * the earlier texels. */
static void check_order(void)
{
    triptych_texture *texture = make_flat(TRIPTYCH_SURFACE_A8R8G8B8);
    bind_random_texture(SIZE, SIZE);
    draw_to(texture, 0, 0);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    draw_to_target();
    sample(texture);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    draw_to(texture, 0, 0);
    OK(triptych_set_scissor(device, 0, 0, SIZE, SIZE / 2));
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
    OK(triptych_clear(device, (const float[4]){1, 1, 1, 1}, 1));
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "false");
    draw_to_target();
    OK(triptych_read_color(device, image, sizeof image));
    expect_image(texel, "before the clear");
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, p < SIZE * SIZE / 2 ? 0xffffffff : texel[p], "after it");
}

static void test_draws_sample_textures_as_they_were(void)
{
    on_every_engine(check_order);
}

/* The texture after a clear to the colour, as texels. */
static void expect_cleared(triptych_texture *texture, float shade, const char *what)
{
    draw_to(texture, 0, 0);
    OK(triptych_clear(device, (const float[4]){shade, shade, shade, 1}, 1));
    draw_to_target();
    sample(texture);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, shade != 0 ? 0xffffffff : 0xff000000, what);
}

/* A clear is not stored again while the texels have its values. They get others by a different clear, by a
 * draw, and by an update. */
static void check_clears(void)
{
    triptych_texture *texture = make_flat(TRIPTYCH_SURFACE_A8R8G8B8);
    expect_cleared(texture, 1, "the first clear");
    expect_cleared(texture, 1, "the same again");
    expect_cleared(texture, 0, "another clear");
    bind_random_texture(SIZE, SIZE);
    draw_to(texture, 0, 0);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    draw_to_target();
    sample(texture);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    expect_image(texel, "a draw");
    expect_cleared(texture, 0, "after a draw");
    OK(triptych_texture_update(device, texture, 0, 0, NULL, texel, SIZE * sizeof *texel, 0));
    expect_cleared(texture, 0, "after an update");
}

static void test_a_clear_replaces_whatever_the_texels_have(void)
{
    on_every_engine(check_clears);
}

/* Of the second level. */
static void clear_lower_half(float shade)
{
    OK(triptych_set_scissor(device, 0, SIZE / 2, SIZE, SIZE / 2));
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
    OK(triptych_clear(device, (const float[4]){shade, shade, shade, 1}, 1));
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "false");
}

/* Mip levels are made, and one is updated, while the first level is drawn to: it keeps what is drawn. A level
 * that is made again begins with its new texels when it is drawn to. */
static void check_levels(void)
{
    triptych_texture *texture = make(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 2 * SIZE, 1, 2);
    struct triptych_surface second = {texture, 1, 0, NULL};
    draw_to(texture, 1, 0);
    OK(triptych_clear(device, (const float[4]){0, 0, 0, 1}, 1));
    draw_to(texture, 0, 0);
    OK(triptych_clear(device, (const float[4]){1, 1, 1, 1}, 1));
    OK(triptych_texture_generate_mips(device, texture));
    clear_lower_half(0);
    draw_to(texture, 1, 0);
    clear_lower_half(0);
    OK(triptych_read_surface(device, &second, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, p < SIZE * SIZE / 2 ? 0xffffffff : 0xff000000, "the second level");
    OK(triptych_texture_generate_mips(device, texture));
    OK(triptych_read_surface(device, &second, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++) {
        bool black = p % SIZE < SIZE / 2 && p / SIZE / (SIZE / 4) == 1;
        expect_pixel(p % SIZE, p / SIZE, black ? 0xff000000 : 0xffffffff, "made again");
    }
}

static void test_levels_are_drawn_to_while_others_are_made(void)
{
    on_every_engine(check_levels);
}

static float shade(unsigned type, unsigned level, unsigned slice)
{
    return (float)(1 + type * 37 + level * 20 + slice) / 255.0f;
}

/* Every level and slice of cubes and volumes is an image of its own. */
static void check_slices(void)
{
    triptych_texture *texture[3] = {make(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 16, 1, 3),
                                    make(TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_A8R8G8B8, 16, 1, 3),
                                    make(TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_A32B32G32R32F, 16, 16, 3)};
    const unsigned slices[3][3] = {{1, 1, 1}, {6, 6, 6}, {16, 8, 4}};
    for (unsigned type = 0; type < 3; type++)
        for (unsigned level = 0; level < 3; level++)
            for (unsigned slice = 0; slice < slices[type][level]; slice++) {
                float color[4] = {shade(type, level, slice), 0.2f, 0, 1};
                draw_to(texture[type], level, slice);
                OK(triptych_clear(device, color, 1));
            }
    draw_to_target();
    for (unsigned type = 0; type < 3; type++)
        for (unsigned level = 0; level < 3; level++)
            for (unsigned slice = 0; slice < slices[type][level]; slice++) {
                struct triptych_surface surface = {texture[type], level, slice, NULL};
                OK(triptych_read_surface_numbers(device, &surface, numbers[0], sizeof numbers));
                for (unsigned i = 0; i < (16u >> level) * (16u >> level); i++)
                    TEST_ASSERT_TRUE(numbers[i][0] == shade(type, level, slice));
            }
}

static void test_every_level_and_slice_is_drawn_to(void)
{
    on_every_engine(check_slices);
}

/* Draws to two colour textures of different formats and a depth texture, then to others, then to the first
 * again. */
static void check_several(void)
{
    triptych_texture *bytes = make_flat(TRIPTYCH_SURFACE_R5G6B5),
                     *halves = make_flat(TRIPTYCH_SURFACE_A16B16G16R16F),
                     *depth = make_flat(TRIPTYCH_SURFACE_D24S8);
    struct triptych_target_surfaces textures = {.color = {{.texture = bytes}, {.texture = halves}},
                                                .depth = {.texture = depth}};
    OK(triptych_set_target_surfaces(device, &textures));
    set(TRIPTYCH_STATE_ZENABLE, "true");
    OK(triptych_clear(device, (const float[4]){0, 0, 0, 0}, 1));
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, SIZE, SIZE / 2, 0, 1}));
    draw_square(0.25f, 0xffff0000, NULL, 0, 0, 1, 1);
    draw_to_target();
    OK(triptych_set_target_surfaces(device, &textures));
    draw_square(0.5f, 0xff00ff00, NULL, 0, 0, 1, 1);
    for (int t = 0; t < 2; t++) {
        OK(triptych_read_target_numbers(device, (unsigned)t, numbers[0], sizeof numbers));
        for (int p = 0; p < SIZE * SIZE; p++) {
            TEST_ASSERT_TRUE(numbers[p][0] == (p < SIZE * SIZE / 2 ? 1 : 0));
            TEST_ASSERT_TRUE(numbers[p][1] == (p < SIZE * SIZE / 2 ? 0 : 1));
        }
    }
    struct triptych_surface surface = {depth, 0, 0, NULL};
    OK(triptych_read_surface_numbers(device, &surface, numbers[0], sizeof numbers));
    for (int p = 0; p < SIZE * SIZE; p++)
        for (int c = 0; c < 4; c++)
            TEST_ASSERT_TRUE(fabsf(numbers[p][c] - (p < SIZE * SIZE / 2 ? 0.25f : 0.5f)) < 1e-7f);
    draw_to_target();
}

static void test_colours_and_depth_stay_in_their_textures(void)
{
    on_every_engine(check_several);
}

/* Draws only depth, as for shadow maps. */
static void check_only_depth(void)
{
    triptych_texture *depth = make_flat(TRIPTYCH_SURFACE_D24X8);
    struct triptych_target_surfaces textures = {.depth = {.texture = depth}};
    struct triptych_surface surface = {depth, 0, 0, NULL};
    OK(triptych_set_target_surfaces(device, &textures));
    set(TRIPTYCH_STATE_ZENABLE, "true");
    OK(triptych_clear(device, NULL, 1));
    draw_square(0.75f, 0xffffffff, NULL, 0, 0, 1, 1);
    draw_to_target();
    OK(triptych_read_surface_numbers(device, &surface, numbers[0], sizeof numbers));
    for (int p = 0; p < SIZE * SIZE; p++)
        TEST_ASSERT_TRUE(fabsf(numbers[p][0] - 0.75f) < 1e-7f);
}

static void test_depth_is_drawn_without_colour(void)
{
    on_every_engine(check_only_depth);
}

/* An update of a texture that is drawn to takes effect after earlier draws and before later ones. */
static void check_update(void)
{
    static uint32_t row[SIZE];
    triptych_texture *texture = make_flat(TRIPTYCH_SURFACE_A8B8G8R8);
    struct triptych_surface surface = {texture, 0, 0, NULL};
    const struct triptych_box box = {0, 3, 0, SIZE, 1, 1};
    for (int x = 0; x < SIZE; x++)
        row[x] = random_word();
    draw_to(texture, 0, 0);
    OK(triptych_clear(device, (const float[4]){0, 0, 1, 1}, 1));
    OK(triptych_texture_update(device, texture, 0, 0, &box, row, sizeof row, 0));
    OK(triptych_set_scissor(device, 0, 0, SIZE / 2, SIZE));
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
    OK(triptych_clear(device, (const float[4]){1, 0, 0, 1}, 1));
    OK(triptych_read_surface(device, &surface, image, sizeof image));
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            expect_pixel(x, y, x < SIZE / 2 ? 0xff0000ff : y == 3 ? row[x] : 0xffff0000, "updated");
    draw_to_target();
}

static void test_updates_are_in_order_with_draws(void)
{
    on_every_engine(check_update);
}

/* --- Copies --- */

static const struct triptych_surface the_target;

static void draw_random(void)
{
    bind_random_texture(SIZE, SIZE);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
}

static void check_copies(void)
{
    triptych_texture *texture = make_flat(TRIPTYCH_SURFACE_A8R8G8B8);
    struct triptych_surface surface = {texture, 0, 0, NULL};
    draw_random();
    OK(triptych_copy(device, &the_target, NULL, &surface, NULL, TRIPTYCH_COPY_POINT));
    OK(triptych_read_surface(device, &surface, image, sizeof image));
    expect_image(texel, "the target's copy");
    const struct triptych_rectangle from = {5, 6, 20, 10}, to = {30, 40, 20, 10};
    OK(triptych_copy(device, &surface, &from, &the_target, &to, TRIPTYCH_COPY_LINEAR));
    OK(triptych_read_color(device, image, sizeof image));
    for (unsigned y = 0; y < SIZE; y++)
        for (unsigned x = 0; x < SIZE; x++) {
            int inside = x >= 30 && x < 50 && y >= 40 && y < 50;
            expect_pixel((int)x, (int)y, inside ? texel[(y - 34) * SIZE + x - 25] : texel[y * SIZE + x],
                         "part");
        }
}

static void test_parts_are_copied_both_ways(void)
{
    on_every_engine(check_copies);
}

/* Copies at twice the size with point filtering, and at half the size with linear filtering, which gives the
 * mean of each four pixels. */
static void check_scaling(void)
{
    triptych_texture *texture = make_flat(TRIPTYCH_SURFACE_A32B32G32R32F);
    struct triptych_surface surface = {texture, 0, 0, NULL};
    const struct triptych_rectangle quarter = {0, 0, SIZE / 2, SIZE / 2};
    draw_random();
    OK(triptych_copy(device, &the_target, &quarter, &surface, NULL, TRIPTYCH_COPY_POINT));
    OK(triptych_read_surface(device, &surface, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, texel[p / SIZE / 2 * SIZE + p % SIZE / 2], "twice as large");
    OK(triptych_copy(device, &the_target, NULL, &surface, &quarter, TRIPTYCH_COPY_LINEAR));
    OK(triptych_read_surface_numbers(device, &surface, numbers[0], sizeof numbers));
    for (int y = 0; y < SIZE / 2; y++)
        for (int x = 0; x < SIZE / 2; x++)
            for (int c = 0; c < 4; c++) {
                double sum = 0;
                for (int i = 0; i < 4; i++)
                    sum += channel(texel[(2 * y + i / 2) * SIZE + 2 * x + i % 2], c) / 255.0;
                TEST_ASSERT_TRUE(fabs(sum / 4 - (double)numbers[y * SIZE + x][c]) < 1e-6);
            }
}

static void test_copies_are_scaled(void)
{
    on_every_engine(check_scaling);
}

static void check_conversion(void)
{
    triptych_texture *texture = make_flat(TRIPTYCH_SURFACE_X4R4G4B4);
    struct triptych_surface surface = {texture, 0, 0, NULL};
    draw_random();
    OK(triptych_copy(device, &the_target, NULL, &surface, NULL, TRIPTYCH_COPY_POINT));
    OK(triptych_read_surface(device, &surface, other, sizeof other));
    for (int p = 0; p < SIZE * SIZE; p++) {
        uint32_t word = 0xff000000;
        for (int c = 0; c < 3; c++)
            word |= (2 * channel(texel[p], c) * 15 + 255) / 510 * 17 << 8 * c;
        image[p] = other[p];
        expect_pixel(p % SIZE, p / SIZE, word, "four bits");
    }
}

static void test_copies_are_converted(void)
{
    on_every_engine(check_conversion);
}

/* --- Errors --- */

static void expect_refused(enum triptych_result expected, enum triptych_result got, const char *reason)
{
    TEST_ASSERT_EQUAL_INT(expected, got);
    TEST_ASSERT_EQUAL_STRING(reason, triptych_error(device));
}

static void check_refusals(void)
{
    triptych_texture *small = make(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_D16, 8, 1, 1),
                     *flat = make_flat(TRIPTYCH_SURFACE_A8R8G8B8),
                     *luminance = make_flat(TRIPTYCH_SURFACE_A4L4), *depth = make_flat(TRIPTYCH_SURFACE_D16);
    struct triptych_target_surfaces none = {0},
                                    shallow = {.color = {{flat, 0, 0, NULL}}, .depth = {small, 0, 0, NULL}},
                                    level = {.color = {{.texture = flat, .level = 1}}},
                                    slice = {.color = {{.texture = flat, .slice = 1}}},
                                    format = {.color = {{.texture = luminance}}},
                                    twice = {
                                        .color = {{.texture = flat}, {.texture = NULL}, {.texture = flat}}};
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_target_surfaces(device, &none),
                   "no surface to draw to: expected at least one");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_target_surfaces(device, &shallow),
                   "depth target of 8 x 8 pixels: expected at least 64 x 64, the size of the colours");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_target_surfaces(device, &level),
                   "colour target 0: level 1 of a texture with 1");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_target_surfaces(device, &slice),
                   "colour target 0: slice 1 of a level with 1");
    expect_refused(TRIPTYCH_UNSUPPORTED, triptych_set_target_surfaces(device, &format),
                   "colour target 0: format A4L4 cannot be drawn to");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_target_surfaces(device, &twice),
                   "colour targets 0 and 2: the same surface, expected another one");
    const struct triptych_surface surface = {flat, 0, 0, NULL}, deep = {depth, 0, 0, NULL},
                                  grey = {luminance, 0, 0, NULL};
    const struct triptych_rectangle outside = {60, 0, 5, 1};
    expect_refused(TRIPTYCH_BAD_ARGUMENT,
                   triptych_copy(device, &surface, &outside, &the_target, NULL, TRIPTYCH_COPY_POINT),
                   "source of a copy: 5 x 1 pixels at 60, 0: expected a part of 64 x 64");
    expect_refused(TRIPTYCH_BAD_ARGUMENT,
                   triptych_copy(device, &deep, NULL, &surface, NULL, TRIPTYCH_COPY_POINT),
                   "copy of format d16 to format A8R8G8B8: expected two formats of colours, or one of depth");
    expect_refused(TRIPTYCH_BAD_ARGUMENT,
                   triptych_copy(device, &deep, NULL, &deep, NULL, TRIPTYCH_COPY_LINEAR),
                   "copy of depth with a linear filter: expected point");
    expect_refused(TRIPTYCH_BAD_ARGUMENT,
                   triptych_copy(device, &surface, NULL, &grey, NULL, (enum triptych_copy_filter)2),
                   "filter 2 of a copy: expected point (0) or linear (1)");
}

static void test_invalid_surfaces_and_copies_are_refused(void)
{
    on_every_engine(check_refusals);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_texture_that_was_drawn_to_is_sampled);
    RUN_TEST(test_draws_sample_textures_as_they_were);
    RUN_TEST(test_a_clear_replaces_whatever_the_texels_have);
    RUN_TEST(test_levels_are_drawn_to_while_others_are_made);
    RUN_TEST(test_every_level_and_slice_is_drawn_to);
    RUN_TEST(test_colours_and_depth_stay_in_their_textures);
    RUN_TEST(test_depth_is_drawn_without_colour);
    RUN_TEST(test_updates_are_in_order_with_draws);
    RUN_TEST(test_parts_are_copied_both_ways);
    RUN_TEST(test_copies_are_scaled);
    RUN_TEST(test_copies_are_converted);
    RUN_TEST(test_invalid_surfaces_and_copies_are_refused);
    return UNITY_END();
}
