/* The span reading's copies of texels that follow each other: the same results as the emulator's for runs of
 * every length and rectangles of every height, wherever their texels stop following each other. */
#include "engines/list.h"
#include "emu/emulate/emulate.h"
#include "engines/specialize/specialize.h"
#include "machine/code.h"
#include "tests/support/differential/span_runs.h"
#include "tests/support/system/bytes.h"
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

/* The routine draws a tile by the entries of its first row, if its texels follow each other; else nothing. */
static void a_tile_is_drawn_or_left(const struct routine *const routine[2], const struct span_texels *t)
{
    struct differential *d = differential;
    span_fill_runs(d, SPAN_ROW, 0, SPAN_ROW);
    span_expect_equal(d, routine, t->what);
    TEST_ASSERT_TRUE_MESSAGE(routine[1]->takes_tiles, t->what);
    TEST_ASSERT_FALSE_MESSAGE(routine[0]->takes_tiles, t->what);
    memset(d->entries.entry + SPAN_ROW, 0, (TILE_BLOCKS - SPAN_ROW) * sizeof *d->entries.entry);
    d->count = SPAN_ROW;
    d->result[1] = d->initial;
    struct differential_arguments arguments = differential_arguments(d, &d->result[1]);
    arguments.pixel.tile = 1;
    routine_run(routine[1], &arguments.pixel, TILE_PIXELS);
    TEST_ASSERT_EQUAL_MESSAGE(t->tile, arguments.pixel.tile, t->what);
    TEST_ASSERT_SAME_BYTES(t->tile ? d->result[0].color : d->initial.color, d->result[1].color,
                           TILE_PLANE_BYTES, t->what);
}

static void all_are_equal(const struct span_texels *t)
{
    const struct engine *const engine[2] = {&engine_emulate, &engine_specialize_8};
    const union key key = span_textured(FILTER_POINT, t->address, COMPACT_NONE);
    struct routine *made[2];
    const struct routine *routine[2];
    struct error error = {""};
    for (unsigned i = 0; i < 2; i++) {
        made[i] = engine_build(engine[i], arena, UNIT_PIXEL, &key, &error);
        TEST_ASSERT_NOT_NULL_MESSAGE(made[i], error.text);
        routine[i] = made[i];
    }
    span_fill_triangles(differential, &key, t);
    span_expect_equal_shapes(differential, routine, t->what);
    a_tile_is_drawn_or_left(routine, t);
    for (unsigned i = 0; i < 2; i++)
        engine[i]->free(arena, made[i]);
}

static void runs_have_the_same_texels_wherever_their_texels_follow_each_other(void)
{
    static const struct span_texels rows[] = {
        {"a texel a pixel", ADDRESS_CLAMP, 0, 1, 1, 0, true},
        {"from the middle of a texel", ADDRESS_CLAMP, 0.5f, 1, 1, 0.5f, true},
        {"far from the origin", ADDRESS_CLAMP, -8191, 1, 1, -8191, true},
        {"upside down", ADDRESS_WRAP_POWER, 0, 1, -1, 0, true},
        {"magnified in height", ADDRESS_CLAMP, 0, 1, 0.25f, 0, true},
        {"minified in height", ADDRESS_WRAP_POWER, 0, 1, 2.5f, 17.25f, false},
        {"the seam is between two columns", ADDRESS_WRAP_POWER, 24, 1, 1, 0, false},
        {"the seam is in a column", ADDRESS_WRAP_POWER, 13, 1, 1, 0, false},
        {"both ends are clamped", ADDRESS_CLAMP, -9, 1.25f, 1, 0, false},
        {"the first columns are clamped", ADDRESS_CLAMP, -18, 1, 1, 0, false},
        {"the last columns are clamped", ADDRESS_CLAMP, 18, 1, 1, 0, false},
        {"mirrored", ADDRESS_CLAMP, 63, -1, 1, 0, false},
        {"magnified", ADDRESS_CLAMP, 3, 0.25f, 1, 0, false},
        {"a texel is repeated now and then", ADDRESS_WRAP_POWER, 7, 0.953125f, 1, 0, false},
        {"a texel is left out now and then", ADDRESS_WRAP_POWER, 7, 1.0625f, 1, 0, false},
        {"four texels a pixel", ADDRESS_WRAP_POWER, 1, 4, 1, 0, false},
    };
    if (engine_unavailable(&engine_specialize_8))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_specialize_8));
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i += test_stride_of(5))
        all_are_equal(rows + i);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(runs_have_the_same_texels_wherever_their_texels_follow_each_other);
    return UNITY_END();
}
