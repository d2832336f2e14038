/* The pass near: which gathers of the span reading it marks, results at every scale, and the instructions
 * that routines execute, which show the way that the texels of a column took. */
#include "base/minmax.h"
#include "engines/list.h"
#include "emu/emulate/emulate.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "ir/near.h"
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
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
}

void tearDown(void)
{
    differential_destroy(differential);
    code_destroy(arena);
}

/* --- Hints ---------------------------------------------------------------------------------------------- */

struct seen {
    unsigned hints, gathers, columns, rows;
};

static void count_hints(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    struct seen *seen = context;
    if (pass != PASS_near || !changed)
        return;
    *seen = (struct seen){.columns = ir->near_columns, .rows = ir->near_rows};
    for (uint32_t number = 1; number < ir->count; number++)
        if (ir->instruction[number].op == IR_near) {
            seen->hints++;
            seen->gathers += ir_near_gathers(ir->instruction[number].k);
        }
}

static void expect_hints(const char *name, const union key *key, struct seen expected)
{
    struct seen seen = {0};
    struct error error = {""};
    struct builder *b = specialize_take(&error);
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_TRUE_MESSAGE(b && engine, error.text);
    const struct build_options options = specialize_options(engine, UNIT_PIXEL);
    TEST_ASSERT_MESSAGE(specialize_code(b, &options, UNIT_PIXEL, key, count_hints, &seen, &error),
                        error.text);
    specialize_give(b);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(expected.hints, seen.hints, name);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(expected.gathers, seen.gathers, name);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(expected.columns, seen.columns, name);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(expected.rows, seen.rows, name);
}

static void texels_that_a_column_and_a_row_determine_have_hints(void)
{
    static const struct seen none = {0, 0, 0, 0};
    union key point = span_textured(FILTER_POINT, ADDRESS_WRAP_POWER, COMPACT_NONE),
              linear = span_textured(FILTER_LINEAR, ADDRESS_CLAMP, COMPACT_NONE),
              byte = span_textured(FILTER_POINT, ADDRESS_CLAMP, COMPACT_A8),
              pair = span_textured(FILTER_LINEAR, ADDRESS_CLAMP, COMPACT_A8L8);
    expect_hints("specialize-8", &point, (struct seen){1, 2, 1, 2});
    expect_hints("specialize-8", &linear, (struct seen){1, 4, 1, 2});
    expect_hints("specialize-8", &byte, (struct seen){1, 2, 1, 2});
    expect_hints("specialize-8", &pair, (struct seen){2, 2, 1, 2});
    byte.pixel.clip_mask = CLIP_MASK_ROWS;
    expect_hints("specialize-8", &byte, (struct seen){2, 2, 2, 2});
    expect_hints("specialize-8:without=near", &linear, none);
    expect_hints("specialize-8:without=separate", &linear, none);
    expect_hints("specialize-4", &linear, none);
    expect_hints("specialize-8x2", &linear, none);
    linear.pixel.span = 0;
    expect_hints("specialize-8", &linear, none);
}

/* The right neighbour can be at the other end of the row: it is a column of its own. */
static void neighbours_that_do_not_follow_each_other_have_columns_of_their_own(void)
{
    union key mirror = span_textured(FILTER_LINEAR, ADDRESS_MIRROR_ONCE, COMPACT_NONE);
    expect_hints("specialize-8", &mirror, (struct seen){4, 4, 2, 2});
}

/* --- Results -------------------------------------------------------------------------------------------- */

static void every_filter_address_and_size_of_texels_has_the_same_results(void)
{
    static const char *const names[] = {"specialize-8", "specialize-8:without=near",
                                        "specialize-8:registers=4", "specialize-8:addresses=patched"};
    static const uint8_t addresses[] = {ADDRESS_CLAMP, ADDRESS_WRAP_POWER,  ADDRESS_MIRROR_POWER,
                                        ADDRESS_WRAP,  ADDRESS_MIRROR_ONCE, ADDRESS_BORDER};
    enum { ENGINES = 1 + sizeof names / sizeof *names, WAYS = 2 * 3 * sizeof addresses, ROUNDS = 6 };
    const struct engine *engines[ENGINES] = {&engine_emulate};
    struct error error = {""};
    unsigned count = 1;
    for (unsigned n = 0; n < ENGINES - 1; n++) {
        engines[count] = engine_named(names[n], &error);
        TEST_ASSERT_NOT_NULL_MESSAGE(engines[count], error.text);
        count += !engine_unavailable(engines[count]);
    }
    /* Every way with every clip mask. */
    const unsigned rounds = max_u32(test_share(ROUNDS * WAYS), CLIP_MASK_COUNT * WAYS);
    for (unsigned i = 0; i < rounds; i++) {
        static const uint8_t compact[] = {COMPACT_NONE, COMPACT_A8, COMPACT_A8L8};
        union key key = span_textured(i % 2 ? FILTER_LINEAR : FILTER_POINT,
                                      addresses[i / 6 % sizeof addresses], compact[i / 2 % 3]);
        key.pixel.clip_mask = i / WAYS % CLIP_MASK_COUNT;
        const char *difference =
            differential_run(differential, engines, count, UNIT_PIXEL, &key, test_seed() + i);
        if (difference)
            TEST_FAIL_MESSAGE(difference);
    }
}

/* --- Instructions --------------------------------------------------------------------------------------- */

enum { SIDE = SPAN_SIDE, PITCH = SIDE + 1, RUN = SPAN_ROW, RUN_PIXELS = RUN * BLOCK_PIXELS };

/* Runs of whole blocks of one triangle across a tile, whose texture is as wide as the tile; `scale` texels a
 * pixel. */
static void fill_runs(const union key *key, unsigned runs, float scale)
{
    struct differential *d = differential;
    differential_fill(d, UNIT_PIXEL, key, 1);
    d->job.texture[0] = (struct texture_job){.texels = (const uint32_t *)(const void *)d->texels,
                                             .width = SIDE,
                                             .height = SIDE,
                                             .width_256 = 256 * SIDE,
                                             .height_256 = 256 * SIDE,
                                             .last_u = SIDE - 1,
                                             .last_v = SIDE - 1,
                                             .pitch = PITCH,
                                             .last_u_256 = 256 * (SIDE - 1),
                                             .last_v_256 = 256 * (SIDE - 1)};
    d->job.clip_mask =
        (struct clip_mask_job){.texels = d->texels, .last_u = SIDE - 1, .last_v = SIDE - 1, .pitch = SIDE};
    const struct plane one = {1, 0, 0}, u = {0, scale / SIDE, 0}, v = {0, 0, scale / SIDE};
    struct triangle_head *head = (void *)d->triangles;
    head->origin_x = head->origin_y = 0;
    memcpy(d->triangles + d->layout.reciprocal_w, &one, sizeof one);
    memcpy(d->triangles + d->layout.varying[VARYING_texcoord0], &u, sizeof u);
    memcpy(d->triangles + d->layout.varying[VARYING_texcoord0] + sizeof u, &v, sizeof v);
    for (unsigned b = 0; b < runs * RUN; b++)
        d->entries.entry[b] = (struct entry){.x = (float)(BLOCK_SIZE * (b % RUN)),
                                             .y = (float)(BLOCK_SIZE * (b / RUN)),
                                             .coverage = UINT16_MAX,
                                             .block = (uint16_t)b};
    d->count = runs * RUN;
    d->result[0] = d->initial;
}

static void count_instruction(void *user, const uint64_t value[UNWINDER_REGISTERS])
{
    (void)value;
    ++*(unsigned *)user;
}

static unsigned instructions(const struct routine *routine, const union key *key, unsigned runs, float scale)
{
    unsigned count = 0;
    void (*function)(const void *, const void *);
    fill_runs(key, runs, scale);
    struct differential_arguments arguments = differential_arguments(differential, &differential->result[0]);
    memcpy(&function, &routine->code, sizeof function);
    stepper_call(function, &arguments.pixel, routine, routine->code, ROUTINE_BYTES_MAXIMUM, count_instruction,
                 &count);
    return count;
}

/* The instructions for one more run of blocks, in hundredths a pixel, on average of four runs: the rows of
 * rectangles are computed for four together. */
static unsigned instructions_a_pixel(const char *name, const union key *key, float scale)
{
    struct error error = {""};
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
    struct routine *routine = engine_build(engine, arena, UNIT_PIXEL, key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    unsigned four = instructions(routine, key, 4, scale), eight = instructions(routine, key, 8, scale);
    engine->free(arena, routine);
    return (eight - four) * 100 / (4 * RUN_PIXELS);
}

/* The keys are those of the streams of bench/streams/rectangles and bench/streams/micro. */
#define COPY                                                                                                 \
    "depth_function=7 varying=0,1 stages=1 texture=1 color_argument=1 alpha_argument=1 write_mask=15 "       \
    "span=2 "
#define MODULATED                                                                                            \
    "depth_function=7 varying=1,1 stages=1 texture=1 address_u=1 address_v=1 color_stage=1 alpha_stage=1 "   \
    "alpha_argument=1 blend=1,1 source_factor=1,1 target_factor=5,5 write_mask=15 span=2 "
#define PRODUCT                                                                                              \
    "depth_function=7 varying=1,1 stages=1 texture=1 address_u=2 address_v=2 color_stage=1 "                 \
    "color_argument=1 alpha_stage=1 alpha_argument=1 write_mask=15 "
#define BILINEAR                                                                                             \
    "depth_function=7 varying=0,1 stages=1 texture=1 filter=1 address_u=2 address_v=2 color_argument=1 "     \
    "alpha_argument=1 write_mask=15 span=2 "
#define BLENDED "blend=1,1 source_factor=1,1 target_factor=5,5"

/* All that is executed for a run: the loop of blocks, and what precedes it for each chunk of lanes. A count
 * that grows is a loss for every rectangle; one that shrinks is to be noted here. */
static void instructions_a_pixel_do_not_grow(void)
{
    static const struct {
        const char *what, *key;
        float scale;
        unsigned hundredths;
    } rows[] = {
        {"copy", COPY, 1, 82},
        {"magnified copy", COPY, 0.225f, 138},
        {"mirrored copy", COPY, -1, 138},
        {"minified copy", COPY, 3, 213},
        {"modulate", MODULATED "color_argument=1", 1, 443},
        {"modulate, bilinear", PRODUCT "span=2 filter=1", 1, 714},
        {"modulate by white", PRODUCT "span=1 ", 1, 80},
        {"modulate by white, blended", PRODUCT "span=1 " BLENDED, 1, 369},
        {"modulate by white, bilinear", PRODUCT "span=1 filter=1", 1, 637},
        {"mask", MODULATED "compact=1 color_argument=8", 1, 468},
        {"bilinear copy", BILINEAR, 1, 640},
        {"bilinear", BILINEAR, 0.225f, 391},
        {"bilinear, blended", BILINEAR BLENDED, 0.225f, 580},
        {"copy with a clip mask", COPY "clip_mask=1", 1, 480},
        {"bilinear bytes", BILINEAR "compact=2", 1, 570},
        {"bilinear bytes, magnified", BILINEAR "compact=2", 0.225f, 336},
    };
    if (engine_unavailable(&engine_specialize_8))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_specialize_8));
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        union key key;
        const char *where = "";
        TEST_ASSERT_EQUAL_MESSAGE(0, key_parse(UNIT_PIXEL, rows[i].key, &key, &where), where);
        unsigned count = instructions_a_pixel("specialize-8", &key, rows[i].scale);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(rows[i].hundredths, count, rows[i].what);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(texels_that_a_column_and_a_row_determine_have_hints);
    RUN_TEST(neighbours_that_do_not_follow_each_other_have_columns_of_their_own);
    RUN_TEST(every_filter_address_and_size_of_texels_has_the_same_results);
    RUN_TEST(instructions_a_pixel_do_not_grow);
    return UNITY_END();
}
