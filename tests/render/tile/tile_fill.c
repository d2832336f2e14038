/* Triangles of one colour are stored as their routines store them. Random scenes are drawn by engines that
 * fill (the setting `uniform`), and by the emulator that shades every pixel. */
#include "base/random.h"
#include "tests/support/system/seed.h"
#include "triptych.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unity.h>

enum {
    WIDTH = 200,
    HEIGHT = 150, /* the last tiles are not whole */
    SCENES = 40,
    DRAWS = 12,
    TRIANGLES = 24,
    DEVICES = 4,
    PIXELS = WIDTH * HEIGHT,
    FVF_XYZRHW_DIFFUSE = 0x044
};

static struct random source;
static triptych_device *device[DEVICES];

#define OK(which, call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device[which]))
#define EACH(call)                                                                                           \
    for (int which = 0; which < DEVICES; which++)                                                            \
    OK(which, call)

void setUp(void)
{
    source = random_start(test_seed(), 0);
}

void tearDown(void)
{
}

static uint32_t below(uint32_t bound)
{
    return random_below(&source, bound);
}

/* --- Devices --- */

static void open(int which, const char *engine, const char *settings, unsigned threads)
{
    const struct triptych_options options = {
        .engine = engine, .threads = threads, .measure = 1, .settings = settings};
    char reason[256];
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        TRIPTYCH_OK, triptych_device_create(&options, &device[which], reason, sizeof reason), reason);
}

static void set(enum triptych_state state, uint32_t value)
{
    EACH(triptych_set_state(device[which], state, value));
}

static void open_devices(const struct triptych_target_description *target, const char *order)
{
    char fills[64], shades[64];
    snprintf(fills, sizeof fills, "uniform=on,target=%s", order);
    snprintf(shades, sizeof shades, "uniform=off,target=%s", order);
    open(0, "emulate", shades, 1);
    open(1, "emulate", fills, 1);
    open(2, "stitch", fills, 1);
    open(3, "batch", fills, 1);
    EACH(triptych_set_target_description(device[which], target));
    EACH(triptych_set_fvf(device[which], FVF_XYZRHW_DIFFUSE));
    set(TRIPTYCH_STATE_LIGHTING, 0);
    set(TRIPTYCH_STATE_ZENABLE, 0);
    set(TRIPTYCH_STATE_CULLMODE, 1);
    set(TRIPTYCH_STATE_SHADEMODE, 1);
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, 1);
}

static void close_devices(void)
{
    for (int i = 0; i < DEVICES; i++)
        triptych_device_destroy(device[i]);
}

static uint64_t pixels_shaded(int which)
{
    struct triptych_statistics statistics;
    triptych_get_statistics(device[which], &statistics);
    return statistics.pixels_shaded;
}

/* The pixels for which pixel routines ran. */
static uint64_t routines_pixels(int which)
{
    struct triptych_routine_info info;
    uint64_t sum = 0;
    for (unsigned i = 0; triptych_get_routine(device[which], i, &info); i++)
        sum += strcmp(info.unit, "pixel") ? 0 : info.elements;
    return sum;
}

static void expect_equal_targets(void)
{
    static uint32_t color[2][PIXELS];
    struct triptych_target_description target;
    triptych_get_target(device[0], &target);
    for (unsigned t = 0; t < TRIPTYCH_TARGETS; t++)
        for (int i = 0; i < DEVICES && target.color_format[t]; i++) {
            OK(i, triptych_read_target(device[i], t, color[i > 0], sizeof color[0]));
            if (i)
                TEST_ASSERT_EQUAL_MEMORY(color[0], color[1], sizeof color[0]);
        }
}

/* --- Shapes --- */

struct vertex {
    float x, y, z, rhw;
    uint32_t color;
};

static float place(unsigned pixels, bool whole)
{
    return whole ? (float)below(pixels) : (float)below(pixels * 256) / 256;
}

static struct vertex *add_rectangle(struct vertex *to, unsigned most, uint32_t color, bool whole)
{
    float x = place(WIDTH + 20, whole) - 10, y = place(HEIGHT + 20, whole) - 10;
    float right = x + place(most, whole), bottom = y + place(most, whole);
    const struct vertex corner[4] = {
        {x, y, 0, 1, color}, {right, y, 0, 1, color}, {x, bottom, 0, 1, color}, {right, bottom, 0, 1, color}};
    static const uint8_t order[6] = {0, 1, 2, 2, 1, 3};
    for (int i = 0; i < 6; i++)
        *to++ = corner[order[i]];
    return to;
}

static struct vertex *add_triangle(struct vertex *to, unsigned most, uint32_t color)
{
    float x = place(WIDTH + 20, false) - 10, y = place(HEIGHT + 20, false) - 10;
    for (int i = 0; i < 3; i++)
        *to++ = (struct vertex){x + place(most, false), y + place(most, false), 0, 1, color};
    return to;
}

/* Draws triangles and rectangles, large or tiny, that lie over each other. */
static void draw(unsigned most)
{
    static struct vertex vertex[6 * TRIANGLES];
    struct vertex *next = vertex;
    unsigned count = 1 + below(TRIANGLES);
    bool whole = below(2), tiny = below(4) == 0;
    for (unsigned i = 0; i < count; i++)
        next = below(3) ? add_rectangle(next, tiny ? 9 : most, (uint32_t)random_u64(&source), whole)
                        : add_triangle(next, tiny ? 9 : most, (uint32_t)random_u64(&source));
    unsigned x = below(WIDTH / 2), y = below(HEIGHT / 2);
    bool all = below(2);
    EACH(triptych_set_scissor(device[which], all ? 0 : x, all ? 0 : y, all ? WIDTH : WIDTH / 2,
                              all ? HEIGHT : HEIGHT / 2));
    EACH(triptych_draw_user(device[which], TRIPTYCH_TRIANGLE_LIST, (uint32_t)(next - vertex) / 3, vertex,
                            sizeof *vertex));
}

/* States with which triangles have one colour, most of the time. */
static void set_states(void)
{
    set(TRIPTYCH_STATE_SHADEMODE, 1 + (below(6) == 0));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, below(6) == 0);
    set(TRIPTYCH_STATE_DESTBLEND, 2);
    set(TRIPTYCH_STATE_COLORWRITEENABLE, below(6) ? 15 : below(16));
    set(TRIPTYCH_STATE_COLORWRITEENABLE1, 15 * below(2));
}

static void clear(void)
{
    const float color[4] = {0.25f, 0.5f, 0.75f, 1};
    EACH(triptych_clear_buffers(device[which], TRIPTYCH_CLEAR_COLOR, color, 1, 0));
}

static void draw_scene(unsigned most)
{
    clear();
    for (unsigned i = 0; i < DRAWS; i++) {
        set_states();
        draw(most);
        if (below(8) == 0)
            clear();
        if (below(4) == 0)
            EACH(triptych_finish(device[which]));
    }
    expect_equal_targets();
}

/* --- Tests --- */

static void triangles_of_one_color_have_the_words_of_their_routines(void)
{
    static const enum triptych_surface_format formats[][TRIPTYCH_TARGETS] = {
        {TRIPTYCH_SURFACE_A8R8G8B8},
        {TRIPTYCH_SURFACE_R5G6B5, TRIPTYCH_SURFACE_A8R8G8B8},
        {TRIPTYCH_SURFACE_A16B16G16R16F},
        {TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_A16B16G16R16F, TRIPTYCH_SURFACE_L8},
        {TRIPTYCH_SURFACE_L8, TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_A8R8G8B8,
         TRIPTYCH_SURFACE_A8R8G8B8},
    };
    for (unsigned i = 0; i < test_share_of(SCENES, 5); i++) {
        struct triptych_target_description target = {
            .width = WIDTH, .height = HEIGHT, .depth_format = TRIPTYCH_DEPTH_NONE, .samples = 1};
        memcpy(target.color_format, formats[i % 5], sizeof target.color_format);
        open_devices(&target, i & 1 ? "rows" : "tiles");
        draw_scene(1 + below(2) * 50 + below(100));
        close_devices();
    }
}

static const struct triptych_target_description plain = {
    .width = WIDTH, .height = HEIGHT, .depth_format = TRIPTYCH_DEPTH_NONE, .samples = 1};

/* A rectangle in four tiles, which it does not cover, and a triangle. */
static void filled_pixels_are_counted_but_not_shaded(void)
{
    const struct vertex vertex[9] = {{20, 30, 0, 1, 1}, {80, 30, 0, 1, 1}, {20, 90, 0, 1, 1},
                                     {20, 90, 0, 1, 1}, {80, 30, 0, 1, 1}, {80, 90, 0, 1, 1},
                                     {130, 4, 0, 1, 2}, {190, 4, 0, 1, 2}, {130, 60, 0, 1, 2}};
    open_devices(&plain, "tiles");
    EACH(triptych_draw_user(device[which], TRIPTYCH_TRIANGLE_LIST, 3, vertex, sizeof *vertex));
    expect_equal_targets();
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(60 * 60 + 60 * 56 / 2, pixels_shaded(0) + 60);
    for (int i = 1; i < DEVICES; i++)
        TEST_ASSERT_EQUAL_UINT64(pixels_shaded(0), pixels_shaded(i));
    TEST_ASSERT_EQUAL_UINT64(pixels_shaded(0), routines_pixels(0));
    TEST_ASSERT_EQUAL_UINT64(2, routines_pixels(1)); /* one a triangle, wherever it is met */
    close_devices();
}

/* A colour times a clip mask is not one colour. */
static void triangles_below_a_clip_mask_are_shaded(void)
{
    static uint8_t texels[PIXELS];
    static const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_L8, WIDTH, HEIGHT, 1, 1};
    const struct vertex vertex[3] = {{-9, -9, 0, 1, ~0u}, {999, -9, 0, 1, ~0u}, {-9, 999, 0, 1, ~0u}};
    for (int i = 0; i < PIXELS; i++)
        texels[i] = (uint8_t)i;
    open_devices(&plain, "tiles");
    for (int i = 0; i < DEVICES; i++) {
        triptych_texture *mask;
        OK(i, triptych_texture_define(device[i], &description, &mask));
        OK(i, triptych_texture_update(device[i], mask, 0, 0, NULL, texels, WIDTH, PIXELS));
        OK(i, triptych_set_clip_mask(device[i], mask, 0, 0, 0, 0, WIDTH, HEIGHT));
    }
    EACH(triptych_draw_user(device[which], TRIPTYCH_TRIANGLE_LIST, 1, vertex, sizeof *vertex));
    expect_equal_targets();
    close_devices();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(triangles_of_one_color_have_the_words_of_their_routines);
    RUN_TEST(filled_pixels_are_counted_but_not_shaded);
    RUN_TEST(triangles_below_a_clip_mask_are_shaded);
    return UNITY_END();
}
