/* The class of triangles that the span reading draws, by itself and as engines draw it. */
#include "render/tile/span.h"

#include "base/bits.h"
#include "base/random.h"
#include "emu/emulate/emulate.h"
#include "engines/list.h"
#include "ir/ir.h"
#include "machine/code.h"
#include "machine/mxcsr.h"
#include "tests/support/differential/differential.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <string.h>
#include <unity.h>

enum { PLANES = 20000, PLACES = 8, ROUNDS = 600 };

static struct random source;

void setUp(void)
{
    source = random_start(test_seed(), 0);
}

void tearDown(void)
{
}

static uint32_t word(void)
{
    return (uint32_t)random_u64(&source);
}

/* --- The class --- */

struct member {
    struct plane plane;
    enum axes axes;
    bool included;
};

static bool includes(struct plane plane, enum axes axes)
{
    struct span_class class = {.count = 1, .plane = {{.axes = (uint8_t)axes}}};
    return span_includes(&class, (const uint8_t *)&plane);
}

static void test_planes_are_in_the_class_by_their_steps_and_sizes(void)
{
    static const struct member members[] = {
        {{1, 0, 0}, AXES_NONE, true},
        {{0, -0.0f, 0}, AXES_NONE, true},
        {{1, 0x1p-149f, 0}, AXES_NONE, false},
        {{1, 0, 1}, AXES_NONE, false},
        {{1, 2, 0}, AXES_X, true},
        {{1, -2, -0.0f}, AXES_X, true},
        {{1, 2, 0x1p-100f}, AXES_X, false},
        {{1, 0, 2}, AXES_X, false},
        {{1, 0, 2}, AXES_Y, true},
        {{1, 2, 0}, AXES_Y, false},
        {{-0.0f, 1, 0}, AXES_X, false},
        {{-0.0f, 0, 1}, AXES_Y, false},
        {{-0.0f, 0, 0}, AXES_NONE, false},
        {{0x1p-90f, 0, -0x1p-90f}, AXES_Y, true},
        {{0x1p-91f, 0, 1}, AXES_Y, false},
        {{1, 0, 0x1p-91f}, AXES_Y, false},
        {{0x1p-140f, 1, 0}, AXES_X, false},
        {{INFINITY, 1, 0}, AXES_X, false},
        {{1, NAN, 0}, AXES_X, false},
        {{1, 1, NAN}, AXES_X, false},
        {{0x1.fffffep127f, -0x1.fffffep127f, 0}, AXES_X, true},
    };
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        TEST_ASSERT_EQUAL_MESSAGE(members[i].included, includes(members[i].plane, members[i].axes),
                                  "a plane's membership");
}

static uint32_t mad(float a, float b, float c)
{
    return ir_evaluate(IR_mad_f, bits_of_float(a), bits_of_float(b), bits_of_float(c), 0);
}

static uint32_t evaluate(struct plane plane, enum axes axes, float x, float y)
{
    uint32_t row = axes & AXES_Y ? mad(y, plane.dy, plane.value) : bits_of_float(plane.value);
    return axes & AXES_X ? mad(x, plane.dx, bits_to_float((int32_t)row)) : row;
}

/* Bits of any magnitude; every fourth number is at the edge of the class. */
static float any_number(void)
{
    uint32_t bits = word();
    return bits_to_float((int32_t)(word() % 4 ? bits : (bits & 0x807fffff) | (127u - 90) << 23));
}

static float any_distance(void)
{
    return (float)((int32_t)word() >> 8) * 0x1p-8f / (float)(1u << word() % 2 * 8);
}

/* With the steps that the axes allow, and often a value that a distance cancels, or almost. */
static struct plane any_plane(enum axes axes)
{
    float zero = word() % 2 ? 0.0f : -0.0f, step = any_number();
    struct plane plane = {any_number(), axes & AXES_X ? step : zero, axes & AXES_Y ? step : zero};
    if (word() % 2)
        plane.value = -floorf(any_distance()) * step;
    return plane;
}

/* The places where a reading along `axes` of planes that `accepts` chooses differs from the whole one. */
static unsigned differences(bool (*accepts)(struct plane, enum axes), unsigned *accepted)
{
    static const enum axes some[] = {AXES_NONE, AXES_X, AXES_Y};
    unsigned saved = mxcsr_enter(), different = 0;
    for (unsigned i = 0; i < PLANES; i++) {
        enum axes axes = some[word() % 3];
        struct plane plane = any_plane(axes);
        if (!accepts(plane, axes))
            continue;
        (*accepted)++;
        for (unsigned p = 0; p < PLACES; p++) {
            float x = any_distance(), y = any_distance();
            different += evaluate(plane, axes, x, y) != evaluate(plane, AXES_BOTH, x, y);
        }
    }
    mxcsr_leave(saved);
    return different;
}

static bool accepts_all(struct plane plane, enum axes axes)
{
    (void)plane, (void)axes;
    return true;
}

static void test_planes_of_the_class_have_the_same_bits_along_their_axes(void)
{
    unsigned accepted = 0;
    TEST_ASSERT_EQUAL(0, differences(includes, &accepted));
    TEST_ASSERT_GREATER_THAN(PLANES / 8, accepted);
    accepted = 0;
    TEST_ASSERT_GREATER_THAN(0, differences(accepts_all, &accepted));
}

/* --- Colours that vary --- */

/* A triangle in pixels, and a colour's plane. */
static struct {
    struct triangle_head head;
    struct plane plane;
} colored;

static void place_color(int x0, int y0, int x1, int y1, struct plane plane)
{
    const int one = 1 << SUBPIXEL_BITS;
    colored.head = (struct triangle_head){.visible = 1,
                                          .x = {x0 * one, x1 * one, x0 * one},
                                          .y = {y0 * one, y0 * one, y1 * one},
                                          .origin_x = (float)x0,
                                          .origin_y = (float)y0};
    colored.plane = plane;
}

static bool includes_color(bool is_one)
{
    struct span_class class = {
        .count = 1, .plane = {{sizeof colored.head, is_one ? AXES_NONE : AXES_BOTH, is_one, false}}};
    return span_includes(&class, (const uint8_t *)&colored);
}

static void test_colors_are_in_the_class_by_the_corners_of_their_bounds(void)
{
    const float stray = 0.99f * (float)SPAN_STRAY, more = 1.01f * (float)SPAN_STRAY;
    const struct {
        struct plane plane;
        bool included;
    } members[] = {
        {{0, 0, 0}, true},
        {{1, -0.0f, 0}, true},
        {{-0.0f, 0x1p-140f, 0}, true},
        {{-stray, 0, 0}, true},
        {{-more, 0, 0}, false},
        {{1 + stray, 0, 0}, true},
        {{1 + more, 0, 0}, false},
        {{0, 1.0f / 20, 0}, true},
        {{0, 0, 1.0f / 10}, true},
        {{0, 1.0f / 19, 0}, false}, /* 19.5 pixels from the origin */
        {{0, 0, 1.0f / 9}, false},
        {{0, 1.0f / 30, 1.0f / 30}, true},
        {{0, 1.0f / 25, 1.0f / 25}, false}, /* the third corner of the bounds */
        {{1, -1.0f / 20, 0}, true},
        {{1, 0, -1.0f / 9}, false},
        {{0.5f, 1.0f / 30, -1.0f / 19}, false},
        {{NAN, 0, 0}, false},
        {{0, NAN, 0}, false},
        {{0, 0, INFINITY}, false},
    };
    for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
        place_color(4, 8, 24, 18, members[i].plane);
        TEST_ASSERT_EQUAL_MESSAGE(members[i].included, includes_color(false), "a colour's membership");
    }
    place_color(4, 8, 5, 9, (struct plane){2.5f, -4, 0});
    TEST_ASSERT_FALSE(includes_color(false)); /* 0.5 at the only centre */
    place_color(4, 8, 24, 18, (struct plane){1, 0, -0.0f});
    TEST_ASSERT_TRUE(includes_color(true));
    colored.plane.value = 0.5f;
    TEST_ASSERT_FALSE(includes_color(true));
}

/* A colour of a pixel as 0 to 255, with or without limits. */
static uint32_t quantized(float x, float y, bool limited)
{
    uint32_t bits = ir_evaluate(IR_mul_f, evaluate(colored.plane, AXES_BOTH, x, y), bits_of_float(255), 0, 0);
    if (limited) {
        bits = ir_evaluate(IR_max_f, bits, 0, 0, 0);
        bits = ir_evaluate(IR_min_f, bits, bits_of_float(255), 0, 0);
    }
    return ir_evaluate(IR_round_i, bits, 0, 0, 0);
}

/* A triangle whose colours are about 0 to 1, or somewhat outside. */
static void make_color(void)
{
    int x = (int)(word() % 4000), y = (int)(word() % 4000);
    int width = 1 + (int)(word() % 300), height = 1 + (int)(word() % 300);
    float from = (float)(word() % 1100) / 1000 - 0.05f, to = (float)(word() % 1100) / 1000 - 0.05f;
    float part = (float)(word() % 256) / 255, change = to - from;
    from = word() % 4 ? from : (float)(word() % 2);
    place_color(x, y, x + width, y + height,
                (struct plane){from, change * part / (float)width, change * (1 - part) / (float)height});
}

/* The pixels of random triangles whose colour the limits change. */
static unsigned limited_pixels(bool members_only, unsigned *accepted)
{
    unsigned saved = mxcsr_enter(), different = 0;
    for (unsigned i = 0; i < PLANES; i++) {
        make_color();
        if (members_only && !includes_color(false))
            continue;
        (*accepted)++;
        int width = (colored.head.x[1] - colored.head.x[0]) >> SUBPIXEL_BITS;
        int height = (colored.head.y[2] - colored.head.y[0]) >> SUBPIXEL_BITS;
        for (unsigned p = 0; p < 2 * PLACES; p++) {
            int x = p < 4 ? (p & 1 ? width - 1 : 0) : (int)(word() % (unsigned)width);
            int y = p < 4 ? (p & 2 ? height - 1 : 0) : (int)(word() % (unsigned)height);
            different += quantized((float)x + 0.5f, (float)y + 0.5f, true) !=
                         quantized((float)x + 0.5f, (float)y + 0.5f, false);
        }
    }
    mxcsr_leave(saved);
    return different;
}

static void test_colors_of_the_class_need_no_limits(void)
{
    unsigned accepted = 0;
    TEST_ASSERT_EQUAL(0, limited_pixels(true, &accepted));
    TEST_ASSERT_GREATER_THAN(PLANES / 8, accepted);
    TEST_ASSERT_GREATER_THAN(0, limited_pixels(false, &accepted));
}

/* --- White --- */

static bool includes_one(struct plane plane, bool is_flat)
{
    struct span_class class = {.count = 1,
                               .plane = {{.axes = AXES_NONE, .is_one = true, .is_flat = is_flat}}};
    return span_includes(&class, (const uint8_t *)&plane);
}

/* A flat number has no steps, so what follows it does not matter. */
static void test_white_is_exactly_one_without_steps(void)
{
    static const struct {
        struct plane plane;
        bool smooth, flat;
    } members[] = {
        {{1, 0, 0}, true, true},
        {{1, -0.0f, 0}, true, true},
        {{0x1.fffffep-1f, 0, 0}, false, false},
        {{0x1.000002p0f, 0, 0}, false, false},
        {{-1, 0, 0}, false, false},
        {{0, 0, 0}, false, false},
        {{-0.0f, 0, 0}, false, false},
        {{NAN, 0, 0}, false, false},
        {{1, 0x1p-149f, 0}, false, true},
        {{1, 0, 0x1p-20f}, false, true},
        {{1, NAN, NAN}, false, true},
    };
    for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(members[i].smooth, includes_one(members[i].plane, false), "a plane");
        TEST_ASSERT_EQUAL_MESSAGE(members[i].flat, includes_one(members[i].plane, true), "a flat number");
    }
}

/* A record with a diffuse colour, and w if it is interpolated. */
static bool includes_diffuse(enum span span, enum interpolation interpolation, const float color[4], float w)
{
    static uint8_t record[1024];
    struct pixel_key key = {.span = SPAN_NONE};
    key.varying[VARYING_diffuse] = (uint8_t)interpolation;
    key.varying[VARYING_texcoord0] = INTERPOLATION_SMOOTH;
    const struct triangle_layout layout = layout_of_pixel(&key);
    const struct plane reciprocal = {w, 0, 0};
    const size_t stride = interpolation == INTERPOLATION_FLAT ? sizeof(float) : sizeof(struct plane);
    memset(record, 0, sizeof record);
    memcpy(record + layout.reciprocal_w, &reciprocal, sizeof reciprocal);
    for (unsigned c = 0; c < 4; c++)
        memcpy(record + layout.varying[VARYING_diffuse] + stride * c, &color[c], sizeof color[c]);
    const struct span_class class = span_class(&key, span);
    return span_includes(&class, record);
}

static void test_white_triangles_have_ones_in_all_four_components(void)
{
    for (int i = INTERPOLATION_SMOOTH; i < INTERPOLATION_COUNT; i++) {
        enum interpolation how = (enum interpolation)i;
        TEST_ASSERT_TRUE(includes_diffuse(SPAN_WHITE, how, (const float[]){1, 1, 1, 1}, 1));
        TEST_ASSERT_FALSE(includes_diffuse(SPAN_WHITE, how, (const float[]){1, 1, 1, 1}, 2));
        TEST_ASSERT_TRUE(includes_diffuse(SPAN_LEVEL, how, (const float[]){1, 1, 1, 1}, 2));
        for (unsigned c = 0; c < 4; c++) {
            float color[4] = {1, 1, 1, 1};
            color[c] = 0x1.fffffep-1f;
            TEST_ASSERT_FALSE(includes_diffuse(SPAN_WHITE, how, color, 1));
            TEST_ASSERT_TRUE(includes_diffuse(SPAN_LEVEL, how, color, 1));
        }
    }
}

static void test_a_class_has_the_planes_of_its_key(void)
{
    struct pixel_key key = {.span = SPAN_NONE};
    TEST_ASSERT_EQUAL(0, span_class(&key, SPAN_LEVEL).count);
    TEST_ASSERT_EQUAL(SPAN_LEVEL, span_narrowest(&key));
    TEST_ASSERT_EQUAL(SPAN_LEVEL, span_widest(&key));
    memset(key.varying, INTERPOLATION_FLAT, sizeof key.varying);
    TEST_ASSERT_EQUAL(4, span_class(&key, SPAN_WHITE).count);
    TEST_ASSERT_EQUAL(0, span_class(&key, SPAN_FADE).count);
    TEST_ASSERT_EQUAL(SPAN_WHITE, span_narrowest(&key));
    TEST_ASSERT_EQUAL(SPAN_LEVEL, span_widest(&key));
    memset(key.varying, INTERPOLATION_SMOOTH, sizeof key.varying);
    TEST_ASSERT_EQUAL(SPAN_WHITE, span_narrowest(&key));
    TEST_ASSERT_EQUAL(SPAN_FADE, span_widest(&key));
    struct span_class class = span_class(&key, SPAN_LEVEL);
    struct triangle_layout layout = layout_of_pixel(&key);
    TEST_ASSERT_EQUAL(SPAN_PLANES, class.count);
    TEST_ASSERT_EQUAL(layout.reciprocal_w, class.plane[0].offset);
    for (unsigned i = 0; i < class.count; i++) {
        unsigned u = layout.varying[VARYING_texcoord3], at = class.plane[i].offset;
        unsigned axes = at == u ? AXES_X : at == u + sizeof(struct plane) ? AXES_Y : AXES_NONE;
        if (at == u || at == u + sizeof(struct plane) || at == layout.varying[VARYING_diffuse])
            TEST_ASSERT_EQUAL(axes, class.plane[i].axes);
    }
}

static void test_wider_readings_have_a_diffuse_colour_that_varies(void)
{
    struct pixel_key key = {.span = SPAN_NONE};
    key.varying[VARYING_diffuse] = key.varying[VARYING_specular] = INTERPOLATION_SMOOTH;
    for (enum span span = SPAN_WHITE; span < SPAN_COUNT; span++) {
        struct span_class class = span_class(&key, span);
        TEST_ASSERT_EQUAL(9, class.count);
        for (unsigned i = 0; i < class.count; i++) {
            bool varies = (span >= SPAN_GRADIENT && i >= 1 && i <= 3) || (span == SPAN_FADE && i == 4);
            TEST_ASSERT_EQUAL(varies ? AXES_BOTH : AXES_NONE, class.plane[i].axes);
            bool is_one = i ? span == SPAN_WHITE && i <= 4 : span != SPAN_LEVEL;
            TEST_ASSERT_EQUAL(is_one, class.plane[i].is_one);
            TEST_ASSERT_FALSE(class.plane[i].is_flat);
        }
    }
}

/* --- Blocks --- */

static void test_whole_blocks_are_taken_in_order_if_there_are_enough(void)
{
    struct entry entries[6], spans[6] = {{0}};
    for (unsigned i = 0; i < 6; i++)
        entries[i] = (struct entry){.coverage = i % 3 ? UINT16_MAX : 0x7fff, .block = (uint16_t)i};
    uint32_t count = 6;
    TEST_ASSERT_EQUAL(4, tile_take_spans(entries, &count, 5, spans));
    TEST_ASSERT_EQUAL(6, count);
    TEST_ASSERT_EQUAL(0, spans[0].coverage);
    TEST_ASSERT_EQUAL(4, tile_take_spans(entries, &count, 4, spans));
    TEST_ASSERT_EQUAL(2, count);
    const uint16_t whole[] = {1, 2, 4, 5}, left[] = {0, 3};
    for (unsigned i = 0; i < 4; i++)
        TEST_ASSERT_EQUAL(whole[i], spans[i].block);
    for (unsigned i = 0; i < 2; i++)
        TEST_ASSERT_EQUAL(left[i], entries[i].block);
}

static void test_whole_blocks_meet_those_that_wait_for_the_ordinary_routine(void)
{
    static struct tile_spans spans;
    struct entry entries[] = {{.block = 3}, {.block = 64}, {.block = 255}, {.block = 7}};
    tile_begin_spans(&spans);
    spans.entry[0].block = 255;
    TEST_ASSERT_FALSE(tile_spans_meet(&spans, entries, 2, 1));
    TEST_ASSERT_TRUE(tile_spans_meet(&spans, entries, 3, 1));
    TEST_ASSERT_FALSE(tile_spans_meet(&spans, entries, 4, 0));
    spans.count = 1;
    spans.entry[1].block = 6;
    spans.entry[2].block = 7;
    TEST_ASSERT_FALSE(tile_spans_meet(&spans, entries, 4, 1));
    TEST_ASSERT_TRUE(tile_spans_meet(&spans, entries, 4, 2));
    tile_begin_spans(&spans);
    TEST_ASSERT_FALSE(tile_spans_meet(&spans, entries, 0, 1));
}

/* --- Routines --- */

/* The emulator's routine of the same key's ordinary reading. */
static struct routine *build_by_blocks(const struct engine *self, struct code_arena *arena, enum unit unit,
                                       const union key *key, struct error *error)
{
    union key blocks = *key;
    (void)self;
    blocks.pixel.span = blocks.pixel.joined = 0;
    return engine_build(&engine_emulate, arena, unit, &blocks, error);
}

/* One sample, and a plane for every varying that is read. Random keys may lack some. */
static void make_spanned(struct pixel_key *key)
{
    key->span = (uint8_t)(SPAN_WHITE + word() % (SPAN_COUNT - SPAN_WHITE));
    key->joined = 0;
    if (word() % 2 && key->varying[VARYING_diffuse])
        key->varying[VARYING_diffuse] = INTERPOLATION_SMOOTH;
    key->samples = 0;
    for (int v = 0; v < VARYING_COUNT; v++)
        if (!key->varying[v] && (varying_is_texcoord(v) || v == VARYING_fog || key_program(key->shader)))
            key->varying[v] = INTERPOLATION_SMOOTH;
}

/* In most keys the diffuse colour is flat. */
static void make_joined(struct pixel_key *key)
{
    make_spanned(key);
    key->span = SPAN_NONE;
    key->joined = 1;
    if (word() % 4)
        key->varying[VARYING_diffuse] = INTERPOLATION_FLAT;
}

static void expect_the_ordinary_reading(void (*make)(struct pixel_key *))
{
    static const char *const names[] = {"emulate",        "batch",
                                        "stitch",         "specialize-8",
                                        "specialize-4",   "specialize-8:without=memory",
                                        "specialize-8x2", "specialize-8:registers=4"};
    enum { ENGINES = 1 + sizeof names / sizeof *names };
    struct error error = {""};
    struct engine by_blocks = engine_emulate;
    const struct engine *engines[ENGINES] = {&by_blocks};
    struct code_arena *arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    struct differential *differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
    by_blocks.build = build_by_blocks;
    unsigned count = 1;
    for (unsigned n = 0; n < ENGINES - 1; n++) {
        engines[count] = engine_named(names[n], &error);
        TEST_ASSERT_NOT_NULL_MESSAGE(engines[count], error.text);
        count += !engine_unavailable(engines[count]);
    }
    uint64_t seed = test_seed();
    for (unsigned i = 0; i < test_share_of(ROUNDS, 16); i++) {
        union key key;
        differential_key(UNIT_PIXEL, &seed, &key);
        make(&key.pixel);
        const char *difference = differential_run(differential, engines, count, UNIT_PIXEL, &key, seed);
        if (difference)
            TEST_FAIL_MESSAGE(difference);
    }
    differential_destroy(differential);
    code_destroy(arena);
}

static void test_the_span_reading_of_every_engine_equals_the_reading_by_blocks(void)
{
    expect_the_ordinary_reading(make_spanned);
}

static void test_the_reading_for_joined_rectangles_equals_the_ordinary_one(void)
{
    expect_the_ordinary_reading(make_joined);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_planes_are_in_the_class_by_their_steps_and_sizes);
    RUN_TEST(test_planes_of_the_class_have_the_same_bits_along_their_axes);
    RUN_TEST(test_white_is_exactly_one_without_steps);
    RUN_TEST(test_white_triangles_have_ones_in_all_four_components);
    RUN_TEST(test_a_class_has_the_planes_of_its_key);
    RUN_TEST(test_colors_are_in_the_class_by_the_corners_of_their_bounds);
    RUN_TEST(test_colors_of_the_class_need_no_limits);
    RUN_TEST(test_wider_readings_have_a_diffuse_colour_that_varies);
    RUN_TEST(test_whole_blocks_are_taken_in_order_if_there_are_enough);
    RUN_TEST(test_whole_blocks_meet_those_that_wait_for_the_ordinary_routine);
    RUN_TEST(test_the_span_reading_of_every_engine_equals_the_reading_by_blocks);
    RUN_TEST(test_the_reading_for_joined_rectangles_equals_the_ordinary_one);
    return UNITY_END();
}
