/* Images and changes of the target on every engine: contents stay while others are drawn to. */
#include "tests/support/picture/canvas.h"
#include "render/device/device.h"

#include <string.h>

enum { RED = 0xff0000ffu, GREEN = 0xff00ff00u, BLUE = 0xffff0000u, WHITE = 0xffffffffu };

static uint32_t big[130 * 70];
static float depth[130 * 70];
static uint8_t stencil[130 * 70];

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static triptych_image *make(struct triptych_image_description description)
{
    triptych_image *made;
    OK(triptych_image_create(device, &description, &made));
    return made;
}

static triptych_image *make_color(enum triptych_surface_format format, unsigned width, unsigned height)
{
    return make((struct triptych_image_description){.format = format, .width = width, .height = height});
}

static triptych_image *make_depth(unsigned width, unsigned height)
{
    return make((struct triptych_image_description){
        .depth_format = TRIPTYCH_DEPTH_D24S8, .width = width, .height = height});
}

static void draw_to(triptych_image *color, triptych_image *z)
{
    OK(triptych_set_target_surfaces(device,
                                    &(struct triptych_target_surfaces){.color = {{.image = color}},
                                                                       .depth = {.image = z},
                                                                       .depth_format = TRIPTYCH_DEPTH_NONE}));
}

static void draw_to_both(triptych_image *first, triptych_image *second)
{
    OK(triptych_set_target_surfaces(
        device, &(struct triptych_target_surfaces){.color = {{.image = first}, {.image = second}},
                                                   .depth_format = TRIPTYCH_DEPTH_NONE}));
}

static void draw_to_target(void)
{
    OK(triptych_set_target_surfaces(device, NULL));
}

static void clear_color(uint32_t word)
{
    const float color[4] = {(float)(word & 255) / 255, (float)(word >> 8 & 255) / 255,
                            (float)(word >> 16 & 255) / 255, (float)(word >> 24) / 255};
    OK(triptych_clear(device, color, -1));
}

/* The pixels of the image are all the word. */
static void expect_color(triptych_image *made, uint32_t word, const char *what)
{
    struct triptych_image_description description;
    triptych_image_get_description(made, &description);
    memset(big, 0, sizeof big);
    OK(triptych_read_surface(device, &(struct triptych_surface){.image = made}, big, sizeof big));
    for (unsigned p = 0; p < description.width * description.height; p++)
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(word, big[p], what);
}

/* --- Contents --- */

/* Depth that is shared by two colours, and its stencil, are those of the draws before. */
static void check_contents(void)
{
    triptych_image *a = make_color(TRIPTYCH_SURFACE_A8R8G8B8, SIZE, SIZE),
                   *b = make_color(TRIPTYCH_SURFACE_R5G6B5, SIZE, SIZE), *z = make_depth(SIZE, SIZE);
    clear_to(WHITE);
    draw_to(a, z);
    set(TRIPTYCH_STATE_ZENABLE, "true");
    OK(triptych_clear_buffers(device, 7, (const float[4]){1, 0, 0, 1}, 1, 77));
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, SIZE, SIZE / 2, 0, 1}));
    draw_square(0.25f, 0xff00ff00, NULL, 0, 0, 1, 1);
    draw_to(b, z);
    draw_square(0.5f, 0xff0000ff, NULL, 0, 0, 1, 1);
    draw_to_target();
    draw_to(a, z);
    OK(triptych_read_stencil(device, stencil, sizeof stencil));
    OK(triptych_read_depth(device, depth, sizeof depth));
    for (int p = 0; p < SIZE * SIZE; p++) {
        TEST_ASSERT_EQUAL_UINT8(77, stencil[p]);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, p < SIZE * SIZE / 2 ? 0.25f : 0.5f, depth[p]);
    }
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, p < SIZE * SIZE / 2 ? GREEN : RED, "the first");
    OK(triptych_read_surface(device, &(struct triptych_surface){.image = b}, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, p < SIZE * SIZE / 2 ? 0xff000000 : BLUE, "the second");
    draw_to_target();
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(5, 5, WHITE, "the target");
}

static void test_contents_stay_while_others_are_drawn_to(void)
{
    on_every_engine(check_contents);
}

/* The target has the pixels of the colour; depth outside of these does not change, and no other tile. */
static void check_sizes(void)
{
    triptych_image *small = make_color(TRIPTYCH_SURFACE_A8R8G8B8, 70, 65),
                   *large = make_color(TRIPTYCH_SURFACE_A8R8G8B8, 130, 70), *z = make_depth(130, 70);
    struct triptych_target_description target;
    draw_to(large, z);
    OK(triptych_clear_buffers(device, 7, (const float[4]){0}, 0.75f, 1));
    draw_to(small, z);
    triptych_get_target(device, &target);
    TEST_ASSERT_EQUAL_UINT(70, target.width);
    TEST_ASSERT_EQUAL_UINT(65, target.height);
    OK(triptych_clear_buffers(device, 7, (const float[4]){0, 1, 0, 1}, 0.5f, 2));
    set(TRIPTYCH_STATE_ZENABLE, "true");
    draw_square(0.25f, 0xffff0000, NULL, 0, 0, 1, 1);
    expect_color(small, RED, "drawn");
    draw_to(large, z);
    draw_square(0.6f, 0xff0000ff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, big, sizeof big));
    OK(triptych_read_depth(device, depth, sizeof depth));
    OK(triptych_read_stencil(device, stencil, sizeof stencil));
    for (int p = 0; p < 130 * 70; p++) {
        bool inside = p % 130 < 70 && p / 130 < 65;
        TEST_ASSERT_EQUAL_HEX32(inside ? 0 : BLUE, big[p]);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, inside ? 0.25f : 0.6f, depth[p]);
        TEST_ASSERT_EQUAL_UINT8(inside ? 2 : 1, stencil[p]);
    }
}

static void test_depth_may_be_larger_than_the_colour(void)
{
    on_every_engine(check_sizes);
}

/* Colours that are drawn to together share memory: contents move with them. */
static void check_groups(void)
{
    triptych_image *a = make_color(TRIPTYCH_SURFACE_A8R8G8B8, 100, 70),
                   *b = make_color(TRIPTYCH_SURFACE_A16B16G16R16F, 100, 70),
                   *c = make_color(TRIPTYCH_SURFACE_A8R8G8B8, 130, 70);
    draw_to(a, NULL);
    clear_color(RED);
    draw_square(0, 0xffff0000, NULL, 0, 0, 1, 1);
    draw_to_both(a, b);
    draw_to(b, NULL);
    clear_color(GREEN);
    draw_square(0, 0xff00ff00, NULL, 0, 0, 1, 1);
    draw_to_both(c, b);
    clear_color(BLUE);
    draw_to_both(NULL, a);
    draw_to(c, NULL);
    OK(triptych_set_viewport(device, &(struct triptych_viewport){100, 0, 30, 70, 0, 1}));
    clear_color(BLUE);
    expect_color(a, RED, "the first");
    expect_color(b, BLUE, "the second");
    expect_color(c, BLUE, "the third");
}

static void test_contents_stay_when_colours_are_drawn_to_together(void)
{
    on_every_engine(check_groups);
}

/* Half of the samples of pixels on the edge are inside. */
static uint32_t diagonal(int sum)
{
    return sum < SIZE - 1 ? WHITE : sum > SIZE - 1 ? 0 : 0x80808080;
}

/* Four samples a pixel of a triangle's edge, and their average. */
static void check_samples(void)
{
    struct triptych_image_description description = {
        .format = TRIPTYCH_SURFACE_A8R8G8B8, .width = SIZE, .height = SIZE, .samples = 4};
    triptych_image *several = make(description), *one = make_color(TRIPTYCH_SURFACE_A8R8G8B8, SIZE, SIZE);
    draw_to(several, NULL);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    clear_color(0);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 1)); /* the upper left half */
    draw_to(one, NULL);
    struct triptych_surface from = {.image = several}, to = {.image = one};
    OK(triptych_copy(device, &from, NULL, &to, NULL, TRIPTYCH_COPY_POINT));
    OK(triptych_read_surface(device, &to, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, diagonal(p % SIZE + p / SIZE), "resolved");
    OK(triptych_image_destroy(device, several));
}

static void test_images_have_several_samples(void)
{
    on_every_engine(check_samples);
}

/* --- Textures --- */

static triptych_texture *make_texture(void)
{
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, SIZE, SIZE, 1, 1};
    triptych_texture *texture;
    OK(triptych_texture_define(device, &description, &texture));
    return texture;
}

static void draw_to_texture(triptych_texture *texture)
{
    OK(triptych_set_target_surfaces(device,
                                    &(struct triptych_target_surfaces){.color = {{.texture = texture}},
                                                                       .depth_format = TRIPTYCH_DEPTH_NONE}));
}

/* Each draw adds the diffuse colour to what the draws before have made. */
static void check_feedback(void)
{
    triptych_texture *texture = make_texture();
    draw_to_texture(texture);
    clear_color(0xff000003);
    OK(triptych_set_texture(device, 0, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "add");
    for (int n = 0; n < 3; n++)
        draw_square(0, 0xff0b0000, NULL, 0, 0, 1, 1);
    draw_to_target();
    OK(triptych_read_surface(device, &(struct triptych_surface){.texture = texture}, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, 0xff000000 | (3 + 3 * 11), "added up");
}

static void test_a_texture_is_sampled_as_it_was_before_the_draw(void)
{
    on_every_engine(check_feedback);
}

static unsigned transfers(void)
{
    unsigned found = 0;
    for (uint32_t i = 0; i < device->queue->commands.count; i++)
        found += device->queue->commands.command[i].kind == COMMAND_TRANSFER;
    return found;
}

/* One transfer makes the tiles from the texels, and one the texels from the tiles. Changes of the target make
 * none. */
static void check_transfers(void)
{
    triptych_texture *texture = make_texture();
    clear_to(WHITE);
    for (int n = 0; n < 3; n++) {
        draw_to_texture(texture);
        clear_color(RED);
        draw_to_target();
    }
    TEST_ASSERT_EQUAL_UINT(1, transfers());
    OK(triptych_set_texture(device, 0, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    for (int n = 0; n < 3; n++)
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    TEST_ASSERT_EQUAL_UINT(2, transfers());
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(9, 9, RED, "sampled");
}

static void test_changes_of_the_target_copy_nothing(void)
{
    on_every_engine(check_transfers);
}

/* --- The end of images --- */

static void check_destruction(void)
{
    triptych_image *a = make_color(TRIPTYCH_SURFACE_A8R8G8B8, SIZE, SIZE), *z = make_depth(SIZE, SIZE);
    clear_to(GREEN);
    draw_to(a, z);
    clear_color(RED);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_image_destroy(device, z));
    OK(triptych_image_destroy(device, a));
    TEST_ASSERT_GREATER_THAN_UINT32(2, device->queue->commands.count);
    draw_to_texture(make_texture());
    clear_color(BLUE);
    OK(triptych_texture_destroy(device, device->resources.textures));
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, GREEN, "the target");
}

static void test_what_is_drawn_to_may_be_destroyed(void)
{
    on_every_engine(check_destruction);
}

/* --- Errors --- */

static void expect_refused(enum triptych_result expected, struct triptych_image_description description,
                           const char *reason)
{
    triptych_image *made = NULL;
    TEST_ASSERT_EQUAL_INT(expected, triptych_image_create(device, &description, &made));
    TEST_ASSERT_NULL(made);
    TEST_ASSERT_EQUAL_STRING(reason, triptych_error(device));
}

static void check_refusals(void)
{
    expect_refused(TRIPTYCH_BAD_ARGUMENT, (struct triptych_image_description){.width = 4},
                   "image of 4 x 0 pixels: expected 1 to 8192 a side");
    expect_refused(TRIPTYCH_BAD_ARGUMENT,
                   (struct triptych_image_description){.width = 4, .height = 4, .samples = 3},
                   "3 samples per pixel: expected 1, 2, 4 or 8");
    expect_refused(
        TRIPTYCH_BAD_ARGUMENT,
        (struct triptych_image_description){.width = 4, .height = 4, .depth_format = TRIPTYCH_DEPTH_NONE},
        "image without a format: expected one of a colour or one of depth");
    expect_refused(
        TRIPTYCH_UNSUPPORTED,
        (struct triptych_image_description){.width = 4, .height = 4, .format = TRIPTYCH_SURFACE_A4L4},
        "format A4L4 of an image: expected one that can be a target");
    struct triptych_surface several = {
        .image = make((struct triptych_image_description){
            .format = TRIPTYCH_SURFACE_A8R8G8B8, .width = 4, .height = 4, .samples = 2})};
    struct triptych_target_surfaces mixed = {.color = {several}, .depth = {.image = make_depth(4, 4)}};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_target_surfaces(device, &mixed));
    TEST_ASSERT_EQUAL_STRING("depth target with 1 samples per pixel: expected 2, the number of the others",
                             triptych_error(device));
    mixed.depth.texture = make_texture();
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_target_surfaces(device, &mixed));
    TEST_ASSERT_EQUAL_STRING("depth target: a texture and an image, expected one of them",
                             triptych_error(device));
}

static void test_invalid_images_are_refused(void)
{
    on_every_engine(check_refusals);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_contents_stay_while_others_are_drawn_to);
    RUN_TEST(test_depth_may_be_larger_than_the_colour);
    RUN_TEST(test_contents_stay_when_colours_are_drawn_to_together);
    RUN_TEST(test_images_have_several_samples);
    RUN_TEST(test_a_texture_is_sampled_as_it_was_before_the_draw);
    RUN_TEST(test_changes_of_the_target_copy_nothing);
    RUN_TEST(test_what_is_drawn_to_may_be_destroyed);
    RUN_TEST(test_invalid_images_are_refused);
    return UNITY_END();
}
