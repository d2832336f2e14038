/* Rectangles of surfaces, fills and copies on a device: the main target, images, and textures with newest
 * pixels in tiles or as texels, before and after draws. */
#include "tests/render/device/surface.h"

#include <stdbool.h>

static const struct triptych_surface the_target;

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static void draw_to(struct triptych_surface color, struct triptych_surface depth)
{
    OK(triptych_set_target_surfaces(
        device, &(struct triptych_target_surfaces){
                    .color = {color}, .depth = depth, .depth_format = TRIPTYCH_DEPTH_D24S8}));
}

static void draw_to_color(struct triptych_surface color)
{
    OK(triptych_set_target_surfaces(device, &(struct triptych_target_surfaces){.color = {color}}));
}

static void expect_picture(struct triptych_surface surface)
{
    fill_memory();
    memset(back, 0, sizeof back);
    OK(triptych_read_rectangle(device, &surface, NULL, TRIPTYCH_SURFACE_A8R8G8B8, back, 4 * SIZE));
    TEST_ASSERT_EQUAL_HEX32_ARRAY((uint32_t *)(void *)memory, (uint32_t *)(void *)back, SIZE * SIZE);
}

/* --- Every kind of surface --- */

static void write_and_read(void)
{
    triptych_texture *texture = make(TRIPTYCH_SURFACE_A8R8G8B8), *drawn = make(TRIPTYCH_SURFACE_A8R8G8B8);
    draw_to_color(of_texture(drawn));
    clear_to(0xff00ff00);
    draw_to_color(of_texture(texture));
    OK(triptych_set_target_surfaces(device, NULL));
    const struct triptych_surface surfaces[] = {the_target,
                                                of_texture(texture),
                                                of_texture(drawn),
                                                of_image(make_image(TRIPTYCH_SURFACE_A8R8G8B8, 0, 1)),
                                                of_image(make_image(TRIPTYCH_SURFACE_A8R8G8B8, 0, 4)),
                                                of_texture(make(TRIPTYCH_SURFACE_A8B8G8R8))};
    for (unsigned i = 0; i < sizeof surfaces / sizeof *surfaces; i++) {
        write_picture(surfaces[i]);
        expect_picture(surfaces[i]);
    }
}

static void test_what_is_written_is_read_from_every_kind_of_surface(void)
{
    on_every_engine(write_and_read);
}

static void read_parts(void)
{
    const struct triptych_rectangle part = {5, 7, 33, 21};
    triptych_image *multisampled = make_image(TRIPTYCH_SURFACE_A8R8G8B8, 0, 4);
    draw_to_color(of_image(multisampled));
    clear_to(0xff102030);
    extent = 0.37f;
    draw_square(0, 0xff80ff01, NULL, 0, 0, 1, 1);
    extent = 1;
    OK(triptych_read_color(device, image, sizeof image));
    const struct triptych_surface surface = of_image(multisampled);
    memset(back, 0x5a, sizeof back);
    OK(triptych_read_rectangle(device, &surface, &part, TRIPTYCH_SURFACE_A8R8G8B8, back, 200));
    for (unsigned y = 0; y < part.height; y++) {
        for (unsigned x = 0; x < part.width; x++) {
            uint32_t word;
            memcpy(&word, back + 200 * y + 4 * x, 4);
            TEST_ASSERT_EQUAL_HEX32(image_word(image[(y + part.y) * SIZE + x + part.x]), word);
        }
        TEST_ASSERT_EACH_EQUAL_HEX8(0x5a, back + 200 * y + 4 * part.width, 200 - 4 * part.width);
    }
}

/* A part of a surface of four samples is copied to a surface of one, and within the first. */
static void copy_samples(void)
{
    const struct triptych_rectangle part = {5, 7, 33, 21};
    triptych_image *multisampled = make_image(TRIPTYCH_SURFACE_A8R8G8B8, 0, 4);
    triptych_image *single = make_image(TRIPTYCH_SURFACE_A8R8G8B8, 0, 1);
    draw_to_color(of_image(multisampled));
    clear_to(0xff102030);
    extent = 0.37f;
    draw_square(0, 0xff80ff01, NULL, 0, 0, 1, 1);
    extent = 1;
    OK(triptych_read_color(device, image, sizeof image));
    const struct triptych_surface from = of_image(multisampled), to[] = {of_image(single), from};
    const struct triptych_rectangle place[] = {{0, 0, 33, 21}, {30, 40, 33, 21}};
    for (int i = 0; i < 2; i++) {
        OK(triptych_copy(device, &from, &part, &to[i], &place[i], TRIPTYCH_COPY_POINT));
        OK(triptych_read_rectangle(device, &to[i], &place[i], TRIPTYCH_SURFACE_A8R8G8B8, back, 4 * 33));
        for (unsigned n = 0; n < 33 * 21; n++) {
            uint32_t word;
            memcpy(&word, back + 4 * n, 4);
            TEST_ASSERT_EQUAL_HEX32(image_word(image[(n / 33 + 7) * SIZE + n % 33 + 5]), word);
        }
    }
}

static void test_samples_are_averaged_by_a_copy(void)
{
    on_every_engine(copy_samples);
}

static void test_parts_of_samples_are_read_with_a_pitch(void)
{
    on_every_engine(read_parts);
}

/* --- In order with draws --- */

static void sample(triptych_texture *texture)
{
    OK(triptych_set_texture(device, 0, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_set_texture(device, 0, NULL));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg2");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg2");
}

/* A write to a texture between a draw that samples it and one that draws to it. */
static void write_between_draws(void)
{
    triptych_texture *texture = make(TRIPTYCH_SURFACE_A8R8G8B8);
    const struct triptych_rectangle left = {0, 0, SIZE / 2, SIZE};
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg2");
    draw_to_color(of_texture(texture));
    clear_to(0xff0000ff);
    OK(triptych_set_target_surfaces(device, NULL));
    sample(texture);
    const struct triptych_surface surface = of_texture(texture);
    OK(triptych_fill(device, &surface, &left, (const float[4]){0, 1, 0, 1}));
    TEST_ASSERT_EQUAL_HEX32(0xffff0000, read_at(the_target, 10, 10));
    sample(texture);
    TEST_ASSERT_EQUAL_HEX32(0xff00ff00, read_at(the_target, 10, 10));
    TEST_ASSERT_EQUAL_HEX32(0xffff0000, read_at(the_target, 40, 10));
    draw_to_color(surface);
    extent = 0.5f;
    draw_square(0, 0xff0000ff, NULL, 0, 0, 1, 1);
    extent = 1;
    TEST_ASSERT_EQUAL_HEX32(0xff00ff00, read_at(surface, 2, 2));
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, read_at(surface, 32, 32));
    OK(triptych_fill(device, &surface, &left, (const float[4]){1, 1, 1, 1}));
    draw_square(0, 0x00000000, NULL, 0, 0, 1, 1);
    write_picture(surface);
    OK(triptych_set_target_surfaces(device, NULL));
    sample(texture);
    expect_picture(the_target);
}

static void test_writes_are_in_order_with_draws(void)
{
    on_every_engine(write_between_draws);
}

/* --- Depth --- */

static void copy_depth(void)
{
    triptych_image *color = make_image(TRIPTYCH_SURFACE_A8R8G8B8, 0, 1);
    triptych_image *depth[2] = {make_image(0, TRIPTYCH_DEPTH_D24S8, 1),
                                make_image(0, TRIPTYCH_DEPTH_D24S8, 1)};
    const struct triptych_surface from = of_image(depth[0]), to = of_image(depth[1]);
    uint32_t words[2][SIZE][SIZE];
    draw_to(of_image(color), from);
    OK(triptych_clear_buffers(device, TRIPTYCH_CLEAR_DEPTH | TRIPTYCH_CLEAR_STENCIL, NULL, 0.5f, 0x7b));
    set(TRIPTYCH_STATE_ZENABLE, "true");
    extent = 0.5f;
    draw_square(0.25f, 0xffffffff, NULL, 0, 0, 1, 1);
    extent = 1;
    OK(triptych_copy(device, &from, NULL, &to, NULL, TRIPTYCH_COPY_POINT));
    OK(triptych_read_rectangle(device, &from, NULL, 0, words[0], sizeof words[0][0]));
    OK(triptych_read_rectangle(device, &to, NULL, 0, words[1], sizeof words[1][0]));
    TEST_ASSERT_EQUAL_HEX32(0x8000007b, words[0][0][0]);
    TEST_ASSERT_EQUAL_HEX32(0x4000007b, words[0][SIZE / 2][SIZE / 2]);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(words[0][0], words[1][0], SIZE * SIZE);
}

static void test_depth_and_stencil_of_images_are_copied_and_read(void)
{
    on_every_engine(copy_depth);
}

/* Depth that is written to a texture is compared with and sampled, and its stencil stays. */
static void write_depth_texture(void)
{
    triptych_texture *texture = make(TRIPTYCH_SURFACE_INTZ);
    triptych_image *color = make_image(TRIPTYCH_SURFACE_A8R8G8B8, 0, 1);
    const struct triptych_surface surface = of_texture(texture);
    const uint32_t word = 0x4000007b;
    uint32_t read = 0;
    const struct triptych_rectangle place = {3, 4, 1, 1};
    OK(triptych_read_rectangle(device, &surface, &place, 0, &read, 4));
    TEST_ASSERT_EQUAL_HEX32(0, read);
    OK(triptych_write_rectangle(device, &surface, &place, 0, &word, 4));
    OK(triptych_read_rectangle(device, &surface, &place, 0, &read, 4));
    TEST_ASSERT_EQUAL_HEX32(word, read);
    float numbers[SIZE * SIZE][4];
    OK(triptych_read_surface_numbers(device, &surface, &numbers[0][0], sizeof numbers));
    TEST_ASSERT_TRUE(numbers[4 * SIZE + 3][0] == (float)(0x400000 / 16777215.0));
    TEST_ASSERT_TRUE(numbers[4 * SIZE + 4][0] == 0);
    sample(texture);
    TEST_ASSERT_EQUAL_HEX32(0x40404040, read_at(the_target, 3, 4));
    draw_to(of_image(color), surface);
    set(TRIPTYCH_STATE_STENCILENABLE, "true");
    set(TRIPTYCH_STATE_STENCILFUNC, "equal");
    OK(triptych_set_state(device, TRIPTYCH_STATE_STENCILREF, 0x7b));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, read_at(of_image(color), 3, 4));
    TEST_ASSERT_EQUAL_HEX32(0, read_at(of_image(color), 4, 4));
    set(TRIPTYCH_STATE_STENCILENABLE, "false");
}

static void test_depth_with_stencil_is_written_to_a_texture(void)
{
    on_every_engine(write_depth_texture);
}

/* --- Within one surface --- */

static void copy_within(void)
{
    const struct triptych_rectangle from = {3, 5, 50, 50}, to = {7, 6, 50, 50};
    const struct triptych_surface surfaces[] = {the_target,
                                                of_image(make_image(TRIPTYCH_SURFACE_A8R8G8B8, 0, 1)),
                                                of_texture(make(TRIPTYCH_SURFACE_A8R8G8B8))};
    for (int i = 0; i < 3; i++) {
        write_picture(surfaces[i]);
        OK(triptych_copy(device, &surfaces[i], &from, &surfaces[i], &to, TRIPTYCH_COPY_POINT));
        OK(triptych_read_rectangle(device, &surfaces[i], NULL, TRIPTYCH_SURFACE_A8R8G8B8, back, 4 * SIZE));
        for (unsigned y = 0; y < SIZE; y++)
            for (unsigned x = 0; x < SIZE; x++) {
                bool moved = x - to.x < 50 && y - to.y < 50;
                uint32_t word;
                memcpy(&word, back + 4 * (y * SIZE + x), 4);
                TEST_ASSERT_EQUAL_HEX32(moved ? color_at(x - 4, y - 1) : color_at(x, y), word);
            }
    }
}

static void test_a_copy_within_a_surface_reads_all_before_it_writes(void)
{
    on_every_engine(copy_within);
}

/* --- Refusals --- */

static void expect_refused(enum triptych_result got, const char *reason)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, got);
    TEST_ASSERT_EQUAL_STRING(reason, triptych_error(device));
}

static void refuse(void)
{
    const struct triptych_surface color = of_texture(make(TRIPTYCH_SURFACE_A8R8G8B8)),
                                  depth = of_image(make_image(0, TRIPTYCH_DEPTH_D16, 1)),
                                  second = {.slice = 1}, level = {color.texture, 1, 0, NULL};
    const struct triptych_rectangle outside = {60, 0, 5, 1};
    const float white[4] = {1, 1, 1, 1};
    expect_refused(triptych_read_rectangle(device, &color, &outside, 0, back, 4 * SIZE),
                   "surface: 5 x 1 pixels at 60, 0: expected a part of 64 x 64");
    expect_refused(triptych_read_rectangle(device, &color, NULL, 0, back, 255),
                   "pitch of 255 bytes: expected at least 256");
    expect_refused(triptych_read_rectangle(device, &color, NULL, 0, back, -255),
                   "pitch of 255 bytes: expected at least 256");
    expect_refused(triptych_read_rectangle(device, &color, NULL, TRIPTYCH_SURFACE_D16, back, 4 * SIZE),
                   "format D16 for pixels in memory: expected 0, or an uncompressed format of colours");
    expect_refused(triptych_write_rectangle(device, &color, NULL, TRIPTYCH_SURFACE_DXT1, back, 4 * SIZE),
                   "format DXT1 for pixels in memory: expected 0, or an uncompressed format of colours");
    expect_refused(triptych_read_rectangle(device, &depth, NULL, TRIPTYCH_SURFACE_D16, back, 4 * SIZE),
                   "format 80 for pixels of depth: expected 0");
    expect_refused(triptych_read_rectangle(device, &second, NULL, 0, back, 4 * SIZE),
                   "surface: colour target 1: the target has none of that number");
    expect_refused(triptych_write_rectangle(device, &level, NULL, 0, back, 4 * SIZE),
                   "surface: level 1 of a texture with 1");
    expect_refused(triptych_fill(device, &depth, NULL, white),
                   "fill of format d16: expected a format of colours");
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_fill(device, &color, NULL, NULL));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_read_rectangle(device, NULL, NULL, 0, back, 4 * SIZE));
}

static void test_invalid_rectangles_and_formats_are_refused(void)
{
    on_every_engine(refuse);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_is_written_is_read_from_every_kind_of_surface);
    RUN_TEST(test_parts_of_samples_are_read_with_a_pitch);
    RUN_TEST(test_samples_are_averaged_by_a_copy);
    RUN_TEST(test_writes_are_in_order_with_draws);
    RUN_TEST(test_depth_and_stencil_of_images_are_copied_and_read);
    RUN_TEST(test_depth_with_stencil_is_written_to_a_texture);
    RUN_TEST(test_a_copy_within_a_surface_reads_all_before_it_writes);
    RUN_TEST(test_invalid_rectangles_and_formats_are_refused);
    return UNITY_END();
}
