/* Textures that change or are destroyed while draws that use them are queued or rendered. Each draw reads the
 * texels of the time when it was queued, and no call waits. */
#include "tests/render/device/screen.h"
#include "engines/list.h"
#include "tests/support/system/seed.h"

#include <string.h>

enum { TEXELS = 8, STEPS = 3 * QUEUE_COMMANDS, TEXTURES = 3 };

struct corner {
    float position[4], coordinate[2];
};

void setUp(void)
{
}

void tearDown(void)
{
    close_device();
}

static const struct triptych_declaration_element elements[] = {
    {0, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITION, 0},
    {0, 16, TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_USAGE_TEXCOORD, 0}};

static void open_textured(const struct engine *engine, unsigned threads)
{
    open_engine(engine, &(struct device_options){.threads = threads});
    OK(triptych_set_declaration(device, elements, 2));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    OK(triptych_set_stage_state(device, 0, TRIPTYCH_STAGE_COLOROP, 2));
    OK(triptych_set_stage_state(device, 0, TRIPTYCH_STAGE_ALPHAOP, 2));
}

/* Draws a square of pixels with the whole texture. */
static void draw_square(float x, float y, float size)
{
    struct corner corner[4];
    for (int i = 0; i < 4; i++) {
        float u = (float)(i & 1), v = (float)(i >> 1);
        corner[i] =
            (struct corner){{2 * (x + u * size) / SIZE - 1, 1 - 2 * (y + v * size) / SIZE, 0, 1}, {u, v}};
    }
    OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_STRIP, 2, corner, sizeof *corner));
}

static triptych_texture *make_texture(unsigned levels)
{
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, TEXELS, TEXELS, 1, levels};
    triptych_texture *texture;
    OK(triptych_texture_define(device, &description, &texture));
    return texture;
}

/* Fills a level, or a part of it, with a colour. */
static void fill(triptych_texture *texture, unsigned level, const struct triptych_box *box, uint32_t color)
{
    uint32_t texel[TEXELS * TEXELS];
    for (int i = 0; i < TEXELS * TEXELS; i++)
        texel[i] = color;
    OK(triptych_texture_update(device, texture, 0, level, box, texel, TEXELS * sizeof *texel, 0));
}

/* --- Storage --- */

static void an_update_does_not_change_earlier_draws(void)
{
    open_textured(&engine_emulate, 1);
    triptych_texture *texture = make_texture(1);
    fill(texture, 0, NULL, RED_ARGB);
    OK(triptych_set_texture(device, 0, texture));
    const void *before = texture->texels;
    draw_square(0, 0, 10);
    fill(texture, 0, &(struct triptych_box){0, 0, 0, TEXELS / 2, TEXELS, 1}, GREEN_ARGB);
    TEST_ASSERT_TRUE(before != texture->texels);
    TEST_ASSERT_EQUAL_UINT32(1, device_commands(device));
    draw_square(20, 0, 10);
    const void *after = texture->texels;
    read_image();
    TEST_ASSERT_EQUAL_HEX32(RED, pixel(2, 2));
    TEST_ASSERT_EQUAL_HEX32(GREEN, pixel(22, 2));
    TEST_ASSERT_EQUAL_HEX32(RED, pixel(28, 2));
    fill(texture, 0, NULL, RED_ARGB);
    TEST_ASSERT_EQUAL_PTR(after, texture->texels);
}

static void other_levels_and_mips_move_with_the_update(void)
{
    uint8_t before[4 * (64 + 16 + 4 + 1)], after[sizeof before];
    open_textured(&engine_emulate, 1);
    triptych_texture *texture = make_texture(0);
    for (unsigned level = 0; level < 4; level++)
        fill(texture, level, NULL, 0x01020304 * (level + 1));
    OK(triptych_texture_read_texels(device, texture, before, sizeof before));
    OK(triptych_set_texture(device, 0, texture));
    for (unsigned level = 0; level < 4; level++) {
        draw_square(0, 0, 10);
        fill(texture, level, NULL, 0x01020304 * (level + 1));
        TEST_ASSERT_EQUAL_UINT32(level + 1, device_commands(device));
    }
    OK(triptych_texture_read_texels(device, texture, after, sizeof after));
    TEST_ASSERT_EQUAL_MEMORY(before, after, sizeof before);
    draw_square(0, 0, 10);
    OK(triptych_texture_generate_mips(device, texture));
    TEST_ASSERT_EQUAL_UINT32(5, device_commands(device));
    OK(triptych_texture_read_texels(device, texture, after, sizeof after));
    for (size_t i = 0; i < sizeof after; i++)
        TEST_ASSERT_EQUAL_HEX8(before[i % 4], after[i]);
}

/* The texture is drawn to before it is sampled and changed. */
static void an_update_of_a_drawn_texture_keeps_what_was_drawn(void)
{
    open_textured(&engine_emulate, 1);
    triptych_texture *texture = make_texture(1);
    struct triptych_target_surfaces surfaces = {.depth_format = TRIPTYCH_DEPTH_NONE};
    surfaces.color[0].texture = texture;
    OK(triptych_set_target_surfaces(device, &surfaces));
    OK(triptych_clear(device, (float[]){1, 0, 0, 1}, -1));
    OK(triptych_set_target_surfaces(device, NULL));
    OK(triptych_set_texture(device, 0, texture));
    draw_square(0, 0, 10);
    fill(texture, 0, &(struct triptych_box){0, 0, 0, TEXELS / 2, TEXELS, 1}, GREEN_ARGB);
    draw_square(20, 0, 10);
    read_image();
    TEST_ASSERT_EQUAL_HEX32(RED, pixel(2, 2));
    TEST_ASSERT_EQUAL_HEX32(GREEN, pixel(22, 2));
    TEST_ASSERT_EQUAL_HEX32(RED, pixel(28, 2));
}

static void a_destroyed_texture_is_still_drawn(void)
{
    open_textured(&engine_emulate, 1);
    triptych_texture *texture = make_texture(0);
    for (unsigned level = 0; level < 4; level++)
        fill(texture, level, NULL, RED_ARGB);
    OK(triptych_set_texture(device, 0, texture));
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_MIPFILTER, 2));
    draw_square(0, 0, 10);
    OK(triptych_texture_destroy(device, texture));
    TEST_ASSERT_EQUAL_UINT32(1, device_commands(device));
    read_image();
    TEST_ASSERT_EQUAL_HEX32(RED, pixel(2, 2));
}

/* --- Bounds --- */

static void changes_take_bounded_memory(void)
{
    static uint32_t texel[512 * 512];
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 512, 512, 1, 1};
    for (unsigned threads = 1; threads <= 2; threads++) {
        open_textured(&engine_emulate, threads);
        triptych_texture *texture;
        OK(triptych_texture_define(device, &description, &texture));
        OK(triptych_set_texture(device, 0, texture));
        for (uint32_t i = 0; i < test_share_of(300, 3); i++) {
            texel[0] = 0xff000000 | i;
            OK(triptych_texture_update(device, texture, 0, 0, NULL, texel, 4 * 512, 0));
            draw_square(0, 0, 10);
            size_t bytes = device->resources.retired.bytes + device->rendered.retired.bytes +
                           device->resources.spare.bytes;
            TEST_ASSERT_LESS_OR_EQUAL_UINT64(60, bytes >> 20);
        }
        close_device();
    }
}

/* --- Any order --- */

struct scene {
    triptych_texture *texture[TEXTURES];
    uint32_t seed;
};

static uint32_t next_random(struct scene *scene, uint32_t below)
{
    scene->seed = scene->seed * 1664525 + 1013904223;
    return (scene->seed >> 8) % below;
}

static void replace(struct scene *scene, unsigned t)
{
    if (scene->texture[t])
        OK(triptych_texture_destroy(device, scene->texture[t]));
    scene->texture[t] = make_texture(t ? 0 : 1);
    fill(scene->texture[t], 0, NULL, 0xff000000 | next_random(scene, 1 << 24));
}

static void draw_to(struct scene *scene, triptych_texture *texture)
{
    struct triptych_target_surfaces surfaces = {.depth_format = TRIPTYCH_DEPTH_NONE};
    surfaces.color[0].texture = texture;
    OK(triptych_set_texture(device, 0, NULL));
    OK(triptych_set_target_surfaces(device, &surfaces));
    OK(triptych_clear(device, (float[]){0, (float)next_random(scene, 256) / 255, 0, 1}, -1));
    OK(triptych_set_target_surfaces(device, NULL));
}

static void step(struct scene *scene)
{
    unsigned t = next_random(scene, TEXTURES), x = next_random(scene, 5), y = next_random(scene, 5);
    triptych_texture *texture = scene->texture[t];
    switch (next_random(scene, 24)) {
    case 0: fill(texture, 0, NULL, 0xff000000 | next_random(scene, 1 << 24)); break;
    case 1:
    case 2:
        fill(texture, 0, &(struct triptych_box){x, y, 0, 3, 3, 1}, 0xff000000 | next_random(scene, 1 << 24));
        break;
    case 3: OK(triptych_texture_generate_mips(device, texture)); break;
    case 4: replace(scene, t); break;
    case 5: draw_to(scene, texture); break;
    default: break;
    }
    OK(triptych_set_texture(device, 0, scene->texture[t]));
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_MIPFILTER, 1 + next_random(scene, 2)));
    draw_square((float)next_random(scene, SIZE), (float)next_random(scene, SIZE),
                (float)(1 + next_random(scene, 16)));
}

static void draw_scene(const struct engine *engine, unsigned threads, bool finish)
{
    struct scene scene = {.seed = 9};
    open_textured(engine, threads);
    for (unsigned t = 0; t < TEXTURES; t++)
        replace(&scene, t);
    for (unsigned i = 0; i < test_share_of(STEPS, 2); i++) {
        step(&scene);
        if (finish)
            OK(triptych_finish(device));
    }
    read_image();
    close_device();
}

static void draws_read_what_was_there_with_any_number_of_threads(void)
{
    static uint32_t expected[SIZE * SIZE];
    draw_scene(&engine_emulate, 1, true);
    memcpy(expected, image, sizeof expected);
    for (unsigned threads = 1; threads <= 4; threads *= test_stride() > 1 ? 4 : 2) {
        draw_scene(&engine_emulate, threads, false);
        TEST_ASSERT_EQUAL_MEMORY(expected, image, sizeof expected);
        draw_scene(engine_find("tiered"), threads, false);
        TEST_ASSERT_EQUAL_MEMORY(expected, image, sizeof expected);
    }
}

/* --- Orders --------------------------------------------------------------------------------------------- */

static void set_order(uint8_t order)
{
    struct setting_values settings = {{0}};
    settings.of[SETTING_texels] = order;
    device_set_settings(device, &settings);
}

/* The texture is drawn to, then sampled, to the target. */
static void draw_chain(triptych_texture *source, triptych_texture *drawn)
{
    const struct triptych_target_surfaces surfaces = {.color = {{.texture = drawn}}};
    OK(triptych_set_target_surfaces(device, &surfaces));
    OK(triptych_set_texture(device, 0, source));
    draw_square(0, 0, SIZE);
    OK(triptych_set_target_surfaces(device, NULL));
    OK(triptych_set_texture(device, 0, drawn));
    draw_square(0, 0, SIZE);
    read_image();
}

static void expect_orders(const struct engine *engine)
{
    static uint32_t before[SIZE * SIZE];
    open_textured(engine, 2);
    triptych_texture *source = make_texture(1), *drawn = make_texture(1);
    fill(source, 0, NULL, RED_ARGB);
    fill(source, 0, &(struct triptych_box){1, 2, 0, 5, 3, 1}, GREEN_ARGB);
    draw_chain(source, drawn);
    memcpy(before, image, sizeof before);
    TEST_ASSERT_EQUAL_HEX32(GREEN, pixel(SIZE / 2, 3 * SIZE / 8));
    static const uint8_t orders[] = {SETTING_texels_tiles, SETTING_texels_rows};
    for (unsigned i = 0; i < sizeof orders; i++) {
        uint8_t order = orders[i];
        set_order(order);
        TEST_ASSERT_EQUAL_INT(order == SETTING_texels_tiles, source->tiled);
        TEST_ASSERT_EQUAL_INT(order == SETTING_texels_tiles, drawn->tiled);
        OK(triptych_clear(device, (const float[4]){0}, 1));
        draw_chain(source, drawn);
        TEST_ASSERT_EQUAL_HEX32_ARRAY(before, image, SIZE * SIZE);
    }
    close_device();
}

/* The target and a texture that is drawn to keep their pixels, and draws that follow change them. */
static void expect_target_orders(const struct engine *engine)
{
    static const uint8_t orders[] = {SETTING_target_rows, SETTING_target_tiles, SETTING_target_rows};
    static uint32_t before[SIZE * SIZE];
    open_textured(engine, 2);
    triptych_texture *source = make_texture(1), *drawn = make_texture(1);
    fill(source, 0, NULL, RED_ARGB);
    fill(source, 0, &(struct triptych_box){1, 2, 0, 5, 3, 1}, GREEN_ARGB);
    draw_chain(source, drawn);
    memcpy(before, image, sizeof before);
    for (unsigned i = 0; i < sizeof orders; i++) {
        struct setting_values settings = {{0}};
        settings.of[SETTING_target] = orders[i];
        device_set_settings(device, &settings);
        TEST_ASSERT_EQUAL_INT(orders[i] == SETTING_target_rows, device_target(device)->memory[0]->quad_rows);
        memset(image, 0, sizeof image);
        read_image();
        TEST_ASSERT_EQUAL_HEX32_ARRAY(before, image, SIZE * SIZE);
        OK(triptych_clear(device, (const float[4]){0}, 1));
        draw_chain(source, drawn);
        TEST_ASSERT_EQUAL_HEX32_ARRAY(before, image, SIZE * SIZE);
    }
    close_device();
}

static void targets_keep_their_pixels_when_their_order_changes(void)
{
    static const char *const engines[] = {"emulate", "batch", "stitch", "stitch-operation", "specialize-8"};
    for (unsigned i = 0; i < sizeof engines / sizeof *engines; i++)
        expect_target_orders(engine_find(engines[i]));
}

static void textures_keep_their_texels_when_their_order_changes(void)
{
    static const char *const engines[] = {"emulate", "batch", "stitch", "stitch-operation", "specialize-8"};
    for (unsigned i = 0; i < sizeof engines / sizeof *engines; i++)
        expect_orders(engine_find(engines[i]));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(an_update_does_not_change_earlier_draws);
    RUN_TEST(other_levels_and_mips_move_with_the_update);
    RUN_TEST(an_update_of_a_drawn_texture_keeps_what_was_drawn);
    RUN_TEST(a_destroyed_texture_is_still_drawn);
    RUN_TEST(changes_take_bounded_memory);
    RUN_TEST(draws_read_what_was_there_with_any_number_of_threads);
    RUN_TEST(textures_keep_their_texels_when_their_order_changes);
    RUN_TEST(targets_keep_their_pixels_when_their_order_changes);
    return UNITY_END();
}
