/* Windows of eight lanes: which gathers get one, and pictures at the edges of textures, of rows and of
 * windows, whose every pixel is computed here. */
#include "engines/list.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "tests/support/picture/canvas.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

/* --- Programs ------------------------------------------------------------------------------------------ */

struct seen {
    unsigned windows, gathers;
};

static void count_windows(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    struct seen *seen = context;
    if (pass != PASS_window || !changed)
        return;
    for (uint32_t number = 1; number < ir->count; number++)
        if (ir->instruction[number].op == IR_window) {
            seen->windows++;
            seen->gathers += ir->instruction[number].scale;
        }
}

static struct seen windows_of(const struct engine *engine, const union key *key)
{
    struct seen seen = {0, 0};
    struct error error = {""};
    struct builder *b = specialize_take(&error);
    const struct build_options options = specialize_options(engine, UNIT_PIXEL);
    TEST_ASSERT_NOT_NULL_MESSAGE(b, error.text);
    TEST_ASSERT_MESSAGE(specialize_code(b, &options, UNIT_PIXEL, key, count_windows, &seen, &error),
                        error.text);
    specialize_give(b);
    return seen;
}

static union key textured(int filter, int address)
{
    union key key;
    memset(&key, 0, sizeof key);
    key.pixel.depth_function = COMPARE_ALWAYS;
    key.pixel.stages = 1;
    key.pixel.write_mask[0] = 15;
    key.pixel.varying[1] = key.pixel.texture[0] = 1;
    key.pixel.filter[0] = (uint8_t)filter;
    key.pixel.address_u[0] = key.pixel.address_v[0] = (uint8_t)address;
    key.pixel.color_argument[0] = key.pixel.alpha_argument[0] = 1;
    return key;
}

static void expect_windows(const char *name, const union key *key, unsigned windows, unsigned gathers)
{
    struct error error = {""};
    const struct engine *engine = engine_named(name, &error);
    struct seen seen = windows_of(engine, key);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(windows, seen.windows, name);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(gathers, seen.gathers, name);
}

static void a_texel_or_the_four_of_a_filter_have_a_window(void)
{
    union key point = textured(FILTER_POINT, ADDRESS_CLAMP), linear = textured(FILTER_LINEAR, ADDRESS_CLAMP);
    expect_windows("specialize-8x2", &point, 1, 1);
    expect_windows("specialize-8x2", &linear, 1, 4);
    expect_windows("specialize-8x2:without=window", &linear, 0, 0);
    expect_windows("specialize-8", &point, 0, 0);
    expect_windows("specialize-8", &linear, 0, 0);
    expect_windows("specialize-4x4", &linear, 0, 0);
}

/* The neighbours of a filter's compact texels are in the same words. */
static void compact_texels_have_windows_of_one_gather(void)
{
    union key point = textured(FILTER_POINT, ADDRESS_CLAMP), linear = textured(FILTER_LINEAR, ADDRESS_CLAMP);
    point.pixel.compact[0] = COMPACT_A8;
    linear.pixel.compact[0] = COMPACT_A8L8;
    expect_windows("specialize-8x2", &point, 1, 1);
    expect_windows("specialize-8x2", &linear, 2, 2);
    expect_windows("specialize-8", &point, 0, 0);
}

/* Their second texel can be at the other end of the row. */
static void texels_that_do_not_follow_each_other_have_windows_of_their_own(void)
{
    union key mirror = textured(FILTER_LINEAR, ADDRESS_MIRROR_ONCE);
    expect_windows("specialize-8x2", &mirror, 4, 4);
}

/* --- Pictures ------------------------------------------------------------------------------------------ */

struct view {
    int width, height;  /* of the texture */
    float u, v;         /* texel coordinates of the target's corner */
    float across, down; /* texels from a pixel to the next */
    bool repeats;       /* otherwise coordinates are clamped */
};

static int addressed(const struct view *view, int index, int size)
{
    if (view->repeats)
        return (index % size + size) % size;
    return index < 0 ? 0 : index < size ? index : size - 1;
}

static uint32_t texel_at(const struct view *view, int x, int y)
{
    return texel[addressed(view, y, view->height) * view->width + addressed(view, x, view->width)];
}

/* round((a * (256 - f) + b * f) / 256) of each channel. */
static uint32_t blend(uint32_t a, uint32_t b, int f)
{
    uint32_t r = 0;
    for (int c = 0; c < 4; c++)
        r |= (channel(a, c) * (256 - (unsigned)f) + channel(b, c) * (unsigned)f + 128) / 256 << 8 * c;
    return r;
}

static uint32_t point_texel(const struct view *view, float u, float v)
{
    return texel_at(view, (int)floorf(u), (int)floorf(v));
}

static uint32_t linear_texel(const struct view *view, float u, float v)
{
    int x = (int)floorf((u - 0.5f) * 256), y = (int)floorf((v - 0.5f) * 256);
    uint32_t row[2];
    for (int j = 0; j < 2; j++)
        row[j] =
            blend(texel_at(view, x >> 8, (y >> 8) + j), texel_at(view, (x >> 8) + 1, (y >> 8) + j), x & 255);
    return blend(row[0], row[1], y & 255);
}

static void check_view(const struct view *view, bool linear)
{
    char what[96];
    float width = (float)view->width, height = (float)view->height;
    const char *address = view->repeats ? "wrap" : "clamp", *filter = linear ? "linear" : "point";
    snprintf(what, sizeof what, "%dx%d texels from %g, %g by %g, %g, %s, %s", view->width, view->height,
             (double)view->u, (double)view->v, (double)view->across, (double)view->down, address, filter);
    set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSU, address);
    set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSV, address);
    set_sampler(0, TRIPTYCH_SAMPLER_MAGFILTER, filter);
    set_sampler(0, TRIPTYCH_SAMPLER_MINFILTER, filter);
    draw_square(0, 0xffffffff, NULL, view->u / width, view->v / height,
                (view->u + SIZE * view->across) / width, (view->v + SIZE * view->down) / height);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int x = p % SIZE, y = p / SIZE;
        float u = view->u + ((float)x + 0.5f) * view->across, v = view->v + ((float)y + 0.5f) * view->down;
        expect_pixel(x, y, (linear ? linear_texel : point_texel)(view, u, v), what);
    }
}

/* Binds a texture whose texels have one or two random bytes. */
static void bind_compact_texture(unsigned width, unsigned height, unsigned bytes)
{
    const struct triptych_texture_description description = {
        .format = bytes == 1 ? TRIPTYCH_SURFACE_L8 : TRIPTYCH_SURFACE_A8L8,
        .width = width,
        .height = height,
        .depth = 1,
        .levels = 1,
    };
    static uint8_t memory[SIZE * SIZE * 2];
    triptych_texture *texture;
    bind_random_texture(width, height);
    for (unsigned i = 0; i < width * height; i++) {
        const uint32_t first = texel[i] & 0xff, second = texel[i] >> 8 & 0xff;
        memory[bytes * i + bytes - 1] = (uint8_t)second;
        memory[bytes * i] = (uint8_t)first;
        texel[i] = first * 0x010101 | (bytes == 1 ? 0xff : second) << 24;
    }
    OK(triptych_texture_define(device, &description, &texture));
    OK(triptych_texture_update(device, texture, 0, 0, NULL, memory, width * bytes, 0));
    OK(triptych_set_texture(device, 0, texture));
}

static void bind_texture(unsigned width, unsigned height, unsigned bytes)
{
    if (bytes == 4)
        bind_random_texture(width, height);
    else
        bind_compact_texture(width, height, bytes);
}

/* Multiples of 1/8 of a texel in textures whose sides are powers of two are exact. */
static void check_views(void)
{
    static const unsigned bytes[] = {4, 1, 2};
    static const int sizes[][2] = {{1, 1}, {2, 1}, {1, 8}, {4, 4}, {8, 2}, {64, 64}, {32, 16}};
    static const float steps[][2] = {{1, 1},     {0.25f, 0.25f}, {0.5f, 1}, {1, -1}, {-1, 1}, {2, 2},
                                     {2, -0.5f}, {3, 1},         {0, 1},    {1, 0},  {1, 4}};
    enum { STEPS = sizeof steps / sizeof steps[0], SIZES = sizeof sizes / sizeof sizes[0] };
    for (unsigned i = 0; i < 3 * SIZES; i++) {
        const unsigned s = i / 3;
        bind_texture((unsigned)sizes[s][0], (unsigned)sizes[s][1], bytes[i % 3]);
        for (unsigned way = 0; way < STEPS * 4; way += test_stride_of(7)) {
            const float *step = steps[way / 4];
            struct view view = {sizes[s][0], sizes[s][1], -2.375f, -1.125f, step[0], step[1], way & 1};
            check_view(&view, way >> 1 & 1);
        }
    }
}

static void pictures_at_the_edges_of_textures_and_windows_are_as_defined(void)
{
    random_begin();
    on_every_engine(check_views);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_texel_or_the_four_of_a_filter_have_a_window);
    RUN_TEST(compact_texels_have_windows_of_one_gather);
    RUN_TEST(texels_that_do_not_follow_each_other_have_windows_of_their_own);
    RUN_TEST(pictures_at_the_edges_of_textures_and_windows_are_as_defined);
    return UNITY_END();
}
