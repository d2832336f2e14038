/* The span reading's copies of texels that follow each other: the same results as the emulator's for runs of
 * every length, wherever their texels stop following each other. */
#include "engines/list.h"
#include "emu/emulate/emulate.h"
#include "engines/specialize/specialize.h"
#include "machine/code.h"
#include "tests/support/differential/differential_part.h"

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

enum { SIDE = 64, ROW = TILE_SIZE / BLOCK_SIZE, RUNS = 2 };

/* A texture, without a filter, replaces the colour. */
static union key copy(int address)
{
    union key key;
    memset(&key, 0, sizeof key);
    key.pixel.span = 1;
    key.pixel.depth_function = COMPARE_ALWAYS;
    key.pixel.stages = key.pixel.texture[0] = 1;
    key.pixel.write_mask[0] = 15;
    key.pixel.varying[VARYING_texcoord0] = INTERPOLATION_SMOOTH;
    key.pixel.address_u[0] = key.pixel.address_v[0] = (uint8_t)address;
    key.pixel.color_argument[0] = key.pixel.alpha_argument[0] = 1;
    return key;
}

/* A triangle whose u, in texels, begins at `first` and grows by `step` from pixel to pixel; v does by 1. */
static void fill_triangle(const union key *key, float first, float step)
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
                                             .pitch = SIDE,
                                             .last_u_256 = 256 * (SIDE - 1),
                                             .last_v_256 = 256 * (SIDE - 1)};
    const struct plane one = {1, 0, 0}, u = {first / SIDE, step / SIDE, 0}, v = {0, 0, 1.0f / SIDE};
    struct triangle_head *head = (void *)d->triangles;
    head->origin_x = head->origin_y = 0;
    memcpy(d->triangles + d->layout.reciprocal_w, &one, sizeof one);
    memcpy(d->triangles + d->layout.varying[VARYING_texcoord0], &u, sizeof u);
    memcpy(d->triangles + d->layout.varying[VARYING_texcoord0] + sizeof u, &v, sizeof v);
}

/* Two runs of `length` blocks, one below the other. */
static void fill_runs(unsigned start, unsigned length)
{
    struct differential *d = differential;
    d->count = 0;
    for (unsigned row = 0; row < RUNS; row++)
        for (unsigned x = start; x < start + length; x++)
            d->entries.entry[d->count++] = (struct entry){.x = (float)(BLOCK_SIZE * x),
                                                          .y = (float)(BLOCK_SIZE * row),
                                                          .coverage = UINT16_MAX,
                                                          .block = (uint16_t)(row * ROW + x)};
}

/* Runs the routines of both engines, and compares the tiles. */
static void expect_equal(const struct routine *const routine[2], const char *what)
{
    struct differential *d = differential;
    for (unsigned i = 0; i < 2; i++) {
        d->result[i] = d->initial;
        const struct differential_arguments arguments = differential_arguments(d, &d->result[i]);
        routine_run(routine[i], &arguments.pixel, d->count * BLOCK_PIXELS);
    }
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(d->result[0].color, d->result[1].color, RUNS * ROW * BLOCK_PIXELS * 4,
                                     what);
}

static void runs_of_every_length_are_equal(const union key *key, float first, float step, const char *what)
{
    const struct engine *const engine[2] = {&engine_emulate, &engine_specialize_8};
    struct routine *routine[2];
    struct error error = {""};
    for (unsigned i = 0; i < 2; i++)
        TEST_ASSERT_NOT_NULL_MESSAGE(routine[i] = engine_build(engine[i], arena, UNIT_PIXEL, key, &error),
                                     error.text);
    fill_triangle(key, first, step);
    for (unsigned start = 0; start < ROW; start++)
        for (unsigned length = 1; start + length <= ROW; length++) {
            fill_runs(start, length);
            expect_equal((const struct routine *const *)routine, what);
        }
    for (unsigned i = 0; i < 2; i++)
        engine[i]->free(arena, routine[i]);
}

static void runs_have_the_same_texels_wherever_their_texels_follow_each_other(void)
{
    static const struct {
        const char *what;
        int address;
        float first, step;
    } rows[] = {
        {"a texel a pixel", ADDRESS_CLAMP, 0, 1},
        {"from the middle of a texel", ADDRESS_CLAMP, 0.5f, 1},
        {"the seam is between two columns", ADDRESS_WRAP_POWER, 24, 1},
        {"the seam is in a column", ADDRESS_WRAP_POWER, 13, 1},
        {"both ends are clamped", ADDRESS_CLAMP, -9, 1.25f},
        {"the first columns are clamped", ADDRESS_CLAMP, -18, 1},
        {"mirrored", ADDRESS_CLAMP, 63, -1},
        {"magnified", ADDRESS_CLAMP, 3, 0.25f},
        {"a texel is repeated now and then", ADDRESS_WRAP_POWER, 7, 0.953125f},
        {"a texel is left out now and then", ADDRESS_WRAP_POWER, 7, 1.0625f},
        {"four texels a pixel", ADDRESS_WRAP_POWER, 1, 4},
    };
    if (engine_unavailable(&engine_specialize_8))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_specialize_8));
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const union key key = copy(rows[i].address);
        runs_of_every_length_are_equal(&key, rows[i].first, rows[i].step, rows[i].what);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(runs_have_the_same_texels_wherever_their_texels_follow_each_other);
    return UNITY_END();
}
