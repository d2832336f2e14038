/* The pass stretch: which keys have stretched rows, the same results as the emulator's at every scale and for
 * every shape, and the instructions that routines execute. */
#include "base/random.h"
#include "engines/list.h"
#include "emu/emulate/emulate.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "machine/code.h"
#include "tests/support/differential/span_runs.h"
#include "tests/support/routine/stepper.h"
#include "tests/support/system/seed.h"

#include <string.h>
#include <unity.h>

static struct code_arena *arena;
static struct differential *differential;

void setUp(void)
{
    struct error error = {{0}};
    if (engine_unavailable(&engine_specialize_8))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_specialize_8));
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
}

void tearDown(void)
{
    if (differential)
        differential_destroy(differential);
    if (arena)
        code_destroy(arena);
    differential = NULL;
    arena = NULL;
}

static union key bilinear(int address, int compact)
{
    return span_textured(FILTER_LINEAR, address, compact);
}

/* A key in which the filtered colour is modulated and blended. */
static union key blended(void)
{
    union key key = bilinear(ADDRESS_CLAMP, COMPACT_NONE);
    key.pixel.blend[0] = key.pixel.blend[1] = 1;
    key.pixel.source_factor[0] = key.pixel.source_factor[1] = FACTOR_SOURCE_ALPHA;
    key.pixel.target_factor[0] = key.pixel.target_factor[1] = FACTOR_INVERSE_SOURCE_ALPHA;
    return key;
}

/* --- Words ---------------------------------------------------------------------------------------------- */

static void note_words(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    if (pass == PASS_stretch && changed)
        *(uint32_t *)context = ir->stretch_words;
}

static void expect_words(const char *name, const union key *key, uint32_t expected, const char *what)
{
    uint32_t words = 0;
    struct error error = {""};
    struct builder *b = specialize_take(&error);
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_TRUE_MESSAGE(b && engine, error.text);
    const struct build_options options = specialize_options(engine, UNIT_PIXEL);
    TEST_ASSERT_MESSAGE(specialize_code(b, &options, UNIT_PIXEL, key, note_words, &words, &error),
                        error.text);
    specialize_give(b);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(expected, words, what);
}

static void keys_that_filter_one_texture_have_stretched_rows(void)
{
    const union key words = bilinear(ADDRESS_WRAP_POWER, COMPACT_NONE),
                    bytes = bilinear(ADDRESS_CLAMP, COMPACT_A8),
                    pairs = bilinear(ADDRESS_CLAMP, COMPACT_A8L8), mixed = blended(),
                    point = span_textured(FILTER_POINT, ADDRESS_CLAMP, COMPACT_NONE);
    expect_words("specialize-8", &words, 2, "both pairs of channels");
    expect_words("specialize-8", &bytes, 1, "one pair of channels");
    expect_words("specialize-8", &mixed, 2, "blended");
    expect_words("specialize-8", &pairs, 0, "texels of two bytes");
    expect_words("specialize-8", &point, 0, "not filtered");
    expect_words("specialize-8:without=near", &words, 0, "without hints");
    expect_words("specialize-8:without=stretch", &words, 0, "without the pass");
    expect_words("specialize-4", &words, 0, "four lanes");
}

static void keys_whose_pixels_read_more_have_none(void)
{
    const union key mirror = bilinear(ADDRESS_MIRROR_ONCE, COMPACT_NONE),
                    border = bilinear(ADDRESS_BORDER, COMPACT_NONE);
    union key ordinary = blended(), depth = blended(), mask = blended();
    ordinary.pixel.span = 0;
    depth.pixel.depth_function = COMPARE_LESS;
    mask.pixel.clip_mask = CLIP_MASK_ROWS;
    expect_words("specialize-8", &mirror, 0, "neighbours that do not follow each other");
    expect_words("specialize-8", &border, 0, "texels whose row decides whether they are the border");
    expect_words("specialize-8", &ordinary, 0, "the ordinary reading");
    expect_words("specialize-8", &depth, 0, "a test of depth");
    expect_words("specialize-8", &mask, 0, "a clip mask");
}

/* --- Results -------------------------------------------------------------------------------------------- */

/* Compares the results of an engine with the emulator's for some calls. */
typedef void expect_calls(const struct routine *const routine[2], const char *what);

static void expect_equal_calls(const char *name, const union key *key, const struct span_texels *t,
                               expect_calls *expect)
{
    struct error error = {""};
    const struct engine *const engine[2] = {&engine_emulate, engine_named(name, &error)};
    struct routine *made[2];
    const struct routine *routine[2];
    TEST_ASSERT_NOT_NULL_MESSAGE(engine[1], error.text);
    for (unsigned i = 0; i < 2; i++) {
        made[i] = engine_build(engine[i], arena, UNIT_PIXEL, key, &error);
        TEST_ASSERT_NOT_NULL_MESSAGE(made[i], error.text);
        routine[i] = made[i];
    }
    span_fill_triangles(differential, key, t);
    expect(routine, t->what);
    for (unsigned i = 0; i < 2; i++)
        engine[i]->free(arena, made[i]);
}

static void expect_shapes(const struct routine *const routine[2], const char *what)
{
    span_expect_equal_shapes(differential, routine, what);
}

static void expect_equal_shapes(const char *name, const union key *key, const struct span_texels *t)
{
    expect_equal_calls(name, key, t, expect_shapes);
}

static const struct span_texels scales[] = {
    {"a texel a pixel", ADDRESS_CLAMP, 0, 1, 1, 0, false},
    {"between the texels", ADDRESS_WRAP_POWER, 0.5f, 1, 1, 0.25f, false},
    {"twice as large", ADDRESS_CLAMP, 0, 0.5f, 0.5f, 0, false},
    {"three times", ADDRESS_CLAMP, 5.125f, 0.33203125f, 0.33203125f, 0.5f, false},
    {"four times as large", ADDRESS_WRAP_POWER, 7, 0.225f, 0.225f, 0, false},
    {"many rows in a row of texels", ADDRESS_CLAMP, 0, 0.5f, 0.0625f, 0, false},
    {"one row of texels", ADDRESS_CLAMP, 3, 0.5f, 0, 0, false},
    {"upside down", ADDRESS_WRAP_POWER, 9, 0.5f, -0.5f, 0, false},
    {"slowly upside down", ADDRESS_WRAP_POWER, 9, 0.75f, -0.140625f, 3.5f, false},
    {"mirrored", ADDRESS_WRAP_POWER, 60, -0.5f, 0.5f, 0, false},
    {"seven texels for eight columns", ADDRESS_WRAP_POWER, 0.9375f, 0.984375f, 0.75f, 0, false},
    {"eight columns just too far apart", ADDRESS_WRAP_POWER, 0.9375f, 1.015625f, 0.75f, 0, false},
    {"a little smaller in height", ADDRESS_WRAP_POWER, 0, 0.5f, 1.125f, 0, false},
    {"much smaller in height", ADDRESS_WRAP_POWER, 0, 0.5f, 3.25f, 0, false},
    {"smaller", ADDRESS_WRAP_POWER, 0, 2.5f, 1.5f, 0, false},
    {"the seam is in a column", ADDRESS_WRAP_POWER, 50, 0.5f, 0.75f, 0, false},
    {"all edges are clamped", ADDRESS_CLAMP, -9, 1.25f, 1.25f, -8, false},
    {"the upper rows are clamped", ADDRESS_CLAMP, 2, 0.5f, 0.5f, 24, false},
};

static void shapes_at_every_scale_have_the_same_results(void)
{
    static const uint8_t compact[] = {COMPACT_NONE, COMPACT_A8};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i += test_stride_of(11))
        for (size_t c = 0; c < sizeof compact; c++) {
            const union key key = bilinear(scales[i].address, compact[c]);
            expect_equal_shapes("specialize-8", &key, scales + i);
        }
}

/* Runs whose rows of texels go up and down, a few runs at a time. */
static void expect_orders(const struct routine *const routine[2], const char *what)
{
    enum { ORDERS = 300, FARTHEST = 3, LENGTH = 5 };
    struct random random = random_start(test_seed(), 0);
    uint32_t row = 0;
    for (unsigned order = 0; order < ORDERS / test_stride_of(10); order++) {
        span_fill_runs(differential, SPAN_ROW, 0, LENGTH);
        for (unsigned e = 0; e < differential->count; e++) {
            row = e % LENGTH ? row : random_below(&random, FARTHEST);
            differential->entries.entry[e].y = (float)(BLOCK_SIZE * row);
        }
        span_expect_equal(differential, routine, what);
    }
}

static void rows_in_any_order_have_the_same_results(void)
{
    static const float steps[] = {1, 0.5f, 0.25f, 0.125f};
    const union key key = bilinear(ADDRESS_WRAP_POWER, COMPACT_NONE);
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        const struct span_texels t = {
            "rows in any order", ADDRESS_WRAP_POWER, 3, 0.5f, steps[i], 0.5f, false};
        expect_equal_calls("specialize-8", &key, &t, expect_orders);
    }
}

/* Their rows of pixels have constants of the lanes. */
static void dithered_colors_have_the_same_results(void)
{
    union key key = blended();
    key.pixel.dither = 1;
    key.pixel.target[0] = TARGET_565;
    expect_words("specialize-8", &key, 0, "dithered");
    expect_equal_shapes("specialize-8", &key, scales + 2);
}

/* With few registers, words of stretched rows are spilled. */
static void few_registers_have_the_same_results(void)
{
    static const char *const names[] = {"specialize-8", "specialize-8:registers=1",
                                        "specialize-8:registers=4", "specialize-8:registers=6",
                                        "specialize-8:allocate=coloring"};
    const union key key = blended();
    for (size_t i = 0; i < sizeof names / sizeof *names; i += test_stride_of(3))
        expect_equal_shapes(names[i], &key, scales + 2);
}

/* --- Instructions --------------------------------------------------------------------------------------- */

static void count_instruction(void *user, const uint64_t value[UNWINDER_REGISTERS])
{
    (void)value;
    ++*(unsigned *)user;
}

/* The instructions of a rectangle that covers a tile, in hundredths a pixel. */
static unsigned instructions_a_pixel(const char *name, const union key *key, const struct span_texels *t)
{
    struct error error = {""};
    unsigned count = 0;
    void (*function)(const void *, const void *);
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
    struct routine *routine = engine_build(engine, arena, UNIT_PIXEL, key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    span_fill_triangles(differential, key, t);
    span_fill_runs(differential, SPAN_ROW, 0, SPAN_ROW);
    differential->result[0] = differential->initial;
    struct differential_arguments arguments = differential_arguments(differential, &differential->result[0]);
    memcpy(&function, &routine->code, sizeof function);
    stepper_call(function, &arguments.pixel, routine, routine->code, ROUTINE_BYTES_MAXIMUM, count_instruction,
                 &count);
    engine->free(arena, routine);
    return count * 100 / TILE_PIXELS;
}

/* A count that grows is a loss for every image; one that shrinks is to be noted here. Images whose rows of
 * texels are further apart than those of pixels have no stretched rows, and lose little by the tests for
 * them. */
static void instructions_a_pixel_do_not_grow(void)
{
    static const struct {
        float step, down;
        unsigned with, without;
    } rows[] = {
        {1, 1, 668, 685},        {0.5f, 0.5f, 511, 685}, {0.25f, 0.25f, 425, 717},
        {0.5f, 1.25f, 710, 685}, {0.5f, 3, 704, 685},    {1.5f, 1.5f, 768, 764},
    };
    const union key key = bilinear(ADDRESS_WRAP_POWER, COMPACT_NONE);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i += test_stride()) {
        const struct span_texels t = {"", ADDRESS_WRAP_POWER, 0.25f, rows[i].step, rows[i].down, 0, false};
        const unsigned with = instructions_a_pixel("specialize-8", &key, &t),
                       without = instructions_a_pixel("specialize-8:without=stretch", &key, &t);
        TEST_ASSERT_EQUAL_UINT(rows[i].with, with);
        TEST_ASSERT_EQUAL_UINT(rows[i].without, without);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(keys_that_filter_one_texture_have_stretched_rows);
    RUN_TEST(keys_whose_pixels_read_more_have_none);
    RUN_TEST(shapes_at_every_scale_have_the_same_results);
    RUN_TEST(rows_in_any_order_have_the_same_results);
    RUN_TEST(dithered_colors_have_the_same_results);
    RUN_TEST(few_registers_have_the_same_results);
    RUN_TEST(instructions_a_pixel_do_not_grow);
    return UNITY_END();
}
