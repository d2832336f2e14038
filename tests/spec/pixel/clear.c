/* Clears of rectangles with masks, in every format of targets. A pixel in any of the rectangles has the
 * channels that are written of a picture that is cleared as a whole, and the others of the picture before. */
#include "tests/support/picture/canvas.h"
#include "tests/support/system/seed.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

enum { WIDTH = 200, HEIGHT = 150, PIXELS = WIDTH * HEIGHT, RECTANGLES = 700 };

struct picture {
    float color[PIXELS][4];
    float depth[PIXELS];
    uint8_t stencil[PIXELS];
};

static struct picture before, whole, after;
static struct triptych_rectangle rectangle[RECTANGLES];

static void read_picture(struct picture *p)
{
    OK(triptych_read_target_numbers(device, 0, p->color[0], sizeof p->color));
    OK(triptych_read_depth(device, p->depth, sizeof p->depth));
    OK(triptych_read_stencil(device, p->stencil, sizeof p->stencil));
}

static void draw_something(void)
{
    static const float colors[2][4] = {{0.25f, 0.5f, 0.75f, 1}, {1, 0.125f, 0.5f, 0.25f}};
    struct triptych_clear_values values = {7, {0}, 0.75f, 0x5a, 15, 0xff, 1};
    memcpy(values.color, colors[0], sizeof colors[0]);
    OK(triptych_clear_rectangles(device, &values, NULL, 0));
    memcpy(values.color, colors[1], sizeof colors[1]);
    values.depth = 0.25f;
    values.stencil = 0x33;
    OK(triptych_clear_rectangles(device, &values, &(struct triptych_rectangle){30, 50, 110, 70}, 1));
}

/* Some are small, some cover whole tiles, some are outside or empty. */
static unsigned make_rectangles(void)
{
    unsigned count = random_word() % 4 ? random_word() % 6 : random_word() % RECTANGLES;
    for (unsigned i = 0; i < count; i++) {
        unsigned most = count < 10 ? 220 : 9;
        rectangle[i] = (struct triptych_rectangle){random_word() % 220, random_word() % 170,
                                                   random_word() % most, random_word() % most};
    }
    if (count && random_word() % 4 == 0)
        rectangle[0] = (struct triptych_rectangle){0, 0, UINT32_MAX, UINT32_MAX};
    if (count && random_word() % 4 == 0)
        rectangle[0] = (struct triptych_rectangle){UINT32_MAX, 0, UINT32_MAX, 9};
    if (count && random_word() % 4 == 0)
        rectangle[0] = (struct triptych_rectangle){64, 64, 64, 64};
    return count;
}

static bool is_in(const struct triptych_rectangle *r, unsigned x, unsigned y)
{
    return x >= r->x && y >= r->y && x - r->x < r->width && y - r->y < r->height;
}

static bool is_cleared(unsigned count, const struct triptych_rectangle *limit, unsigned x, unsigned y)
{
    bool in = !count;
    for (unsigned i = 0; i < count && !in; i++)
        in = is_in(&rectangle[i], x, y);
    return in && is_in(limit, x, y);
}

static void expect_pixel_of(unsigned p, bool cleared, const struct triptych_clear_values *v)
{
    bool color = cleared && v->flags & TRIPTYCH_CLEAR_COLOR,
         depth = cleared && v->flags & TRIPTYCH_CLEAR_DEPTH;
    unsigned bits = cleared && v->flags & TRIPTYCH_CLEAR_STENCIL ? v->stencil_mask & 0xff : 0;
    for (unsigned c = 0; c < 4; c++)
        if (after.color[p][c] != (color && v->color_mask >> c & 1 ? whole.color[p][c] : before.color[p][c]))
            TEST_FAIL_MESSAGE("colour");
    TEST_ASSERT_EQUAL_FLOAT(depth ? whole.depth[p] : before.depth[p], after.depth[p]);
    TEST_ASSERT_EQUAL_HEX8((before.stencil[p] & ~bits) | (whole.stencil[p] & bits), after.stencil[p]);
}

static void check_clear(void)
{
    struct triptych_clear_values v = {random_word() % 8,   {0},
                                      (float)dyadic(0, 1), random_word() & 0xff,
                                      random_word() % 16,  random_word() | 0x10,
                                      random_word() % 2};
    struct triptych_rectangle limit = {0, 0, WIDTH, HEIGHT};
    unsigned count = make_rectangles();
    for (int c = 0; c < 4; c++)
        v.color[c] = (float)dyadic(0, 1);
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, WIDTH, HEIGHT, 0, 1}));
    OK(triptych_clear_buffers(device, 7, v.color, v.depth, v.stencil));
    read_picture(&whole);
    draw_something();
    read_picture(&before);
    if (random_word() % 2) /* then the tiles' words are not valid, only their values */
        draw_something();
    OK(triptych_set_viewport(device, &(struct triptych_viewport){10, 20, 150, 128, 0, 1}));
    if (!v.everywhere)
        limit = (struct triptych_rectangle){10, 20, 150, 128};
    OK(triptych_clear_rectangles(device, &v, count ? rectangle : NULL, count));
    read_picture(&after);
    for (unsigned p = 0; p < PIXELS; p += (unsigned)pixel_stride())
        expect_pixel_of(p, is_cleared(count, &limit, p % WIDTH, p / WIDTH), &v);
}

static void open_target(enum triptych_surface_format format, unsigned samples)
{
    struct triptych_options options = {.engine = "emulate", .threads = 2};
    char reason[256] = "";
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK,
                                  triptych_device_create(&options, &device, reason, sizeof reason), reason);
    OK(triptych_set_target_description(device, &(struct triptych_target_description){
                                                   WIDTH, HEIGHT, TRIPTYCH_DEPTH_D24S8, {format}, samples}));
}

static void test_rectangles_and_masks(void)
{
    static const enum triptych_surface_format formats[] = {
        TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_R5G6B5,        TRIPTYCH_SURFACE_A1R5G5B5,
        TRIPTYCH_SURFACE_G16R16,   TRIPTYCH_SURFACE_A16B16G16R16F, TRIPTYCH_SURFACE_A32B32G32R32F};
    random_begin();
    for (size_t f = 0; f < sizeof formats / sizeof *formats; f++) {
        open_target(formats[f], f == 0 ? 4 : 1);
        for (unsigned i = 0; i < test_share_of(60, 5); i++)
            check_clear();
        close_canvas();
    }
}

static void test_wrong_values_change_nothing(void)
{
    struct triptych_clear_values v = {1, {1, 1, 1, 1}, 0, 0, 16, 0, 0};
    open_target(TRIPTYCH_SURFACE_A8R8G8B8, 1);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_clear_rectangles(device, &v, NULL, 0));
    TEST_ASSERT_EQUAL_STRING("colour mask 0x10 of a clear: expected 0 to 15", triptych_error(device));
    v.color_mask = 15;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_clear_rectangles(device, &v, NULL, 1));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_clear_rectangles(device, NULL, NULL, 0));
    read_picture(&after);
    for (unsigned p = 0; p < PIXELS; p++)
        TEST_ASSERT_EQUAL_FLOAT(0, after.color[p][0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rectangles_and_masks);
    RUN_TEST(test_wrong_values_change_nothing);
    return UNITY_END();
}
