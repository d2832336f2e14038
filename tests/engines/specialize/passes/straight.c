/* The span reading's copies of texels that follow each other: the same results as the emulator's for runs of
 * every length and rectangles of every height, wherever their texels stop following each other. */
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

enum { SIDE = 64, ROW = TILE_SIZE / BLOCK_SIZE, RUNS = 2, RECORDS = 2 };

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

/* How the texels of a triangle follow each other: u, in texels, begins at `first` and grows by `step` from
 * pixel to pixel; v begins at 0 and grows by `down`. The origin is a number of 1/256 pixels. */
struct texels {
    const char *what;
    int address;
    float first, step, down, origin;
    bool tile; /* those of a whole tile do, from its first column to its last */
};

static void fill_record(unsigned number, const struct texels *t)
{
    struct differential *d = differential;
    uint8_t *record = d->triangles + number * d->layout.stride;
    const struct plane one = {1, 0, 0}, u = {t->first / SIDE, t->step / SIDE, 0}, v = {0, 0, t->down / SIDE};
    struct triangle_head *head = (void *)record;
    head->origin_x = head->origin_y = t->origin;
    memcpy(record + d->layout.reciprocal_w, &one, sizeof one);
    memcpy(record + d->layout.varying[VARYING_texcoord0], &u, sizeof u);
    memcpy(record + d->layout.varying[VARYING_texcoord0] + sizeof u, &v, sizeof v);
}

/* A triangle, and one that is half a texture further. */
static void fill_triangles(const union key *key, const struct texels *t)
{
    struct differential *d = differential;
    struct texels further = *t;
    further.first += SIDE / 2;
    differential_fill(d, UNIT_PIXEL, key, RECORDS);
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
    fill_record(0, t);
    fill_record(1, &further);
}

static void add_run(unsigned row, unsigned start, unsigned end, unsigned triangle)
{
    struct differential *d = differential;
    for (unsigned x = start; x < end; x++)
        d->entries.entry[d->count++] = (struct entry){.x = (float)(BLOCK_SIZE * x),
                                                      .y = (float)(BLOCK_SIZE * row),
                                                      .coverage = UINT16_MAX,
                                                      .block = (uint16_t)(row * ROW + x),
                                                      .triangle = triangle * d->layout.stride};
}

/* Runs of `length` blocks, one below the other. */
static void fill_runs(unsigned rows, unsigned start, unsigned length)
{
    differential->count = 0;
    for (unsigned row = 0; row < rows; row++)
        add_run(row, start, start + length, 0);
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
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(d->result[0].color, d->result[1].color, TILE_PLANE_BYTES, what);
}

static void runs_of_every_length(const struct routine *const routine[2], const char *what)
{
    for (unsigned rows = 1; rows <= RUNS; rows++)
        for (unsigned start = 0; start < ROW; start++)
            for (unsigned length = 1; start + length <= ROW; length++) {
                fill_runs(rows, start, length);
                expect_equal(routine, what);
            }
}

static void rectangles_of_every_height(const struct routine *const routine[2], const char *what)
{
    for (unsigned rows = 1; rows <= ROW; rows++)
        for (unsigned length = 1; length <= ROW; length += 5) {
            fill_runs(rows, (ROW - length) / 2, length);
            expect_equal(routine, what);
        }
}

/* The columns of the runs of a triangle and of the next one change at a row, by these blocks. */
static void shapes_that_are_no_rectangles(const struct routine *const routine[2], const char *what)
{
    for (unsigned change = 0; change < ROW; change++)
        for (int left = -1; left <= 1; left++)
            for (int right = -1; right <= 1; right++) {
                differential->count = 0;
                for (unsigned row = 0; row < ROW; row++) {
                    const bool moved = row >= change;
                    add_run(row, 3u + (moved ? (unsigned)left : 0), 9u + (moved ? (unsigned)right : 0), 0);
                }
                for (unsigned row = 0; row < ROW; row++)
                    add_run(row, row / 2, ROW - change, 1);
                expect_equal(routine, what);
            }
}

/* Runs with equal columns, of two triangles. */
static void triangles_after_each_other(const struct routine *const routine[2], const char *what)
{
    for (unsigned change = 0; change < ROW; change++) {
        differential->count = 0;
        for (unsigned row = 0; row < ROW; row++)
            add_run(row, 2, 14, row >= change);
        expect_equal(routine, what);
    }
}

/* The routine draws a tile by the entries of its first row, if its texels follow each other; else nothing. */
static void a_tile_is_drawn_or_left(const struct routine *const routine[2], const struct texels *t)
{
    struct differential *d = differential;
    fill_runs(ROW, 0, ROW);
    expect_equal(routine, t->what);
    TEST_ASSERT_TRUE_MESSAGE(routine[1]->takes_tiles, t->what);
    TEST_ASSERT_FALSE_MESSAGE(routine[0]->takes_tiles, t->what);
    memset(d->entries.entry + ROW, 0, (TILE_BLOCKS - ROW) * sizeof *d->entries.entry);
    d->count = ROW;
    d->result[1] = d->initial;
    struct differential_arguments arguments = differential_arguments(d, &d->result[1]);
    arguments.pixel.tile = 1;
    routine_run(routine[1], &arguments.pixel, TILE_PIXELS);
    TEST_ASSERT_EQUAL_MESSAGE(t->tile, arguments.pixel.tile, t->what);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(t->tile ? d->result[0].color : d->initial.color, d->result[1].color,
                                     TILE_PLANE_BYTES, t->what);
}

static void all_are_equal(const struct texels *t)
{
    const struct engine *const engine[2] = {&engine_emulate, &engine_specialize_8};
    const union key key = copy(t->address);
    struct routine *made[2];
    const struct routine *routine[2];
    struct error error = {""};
    for (unsigned i = 0; i < 2; i++) {
        made[i] = engine_build(engine[i], arena, UNIT_PIXEL, &key, &error);
        TEST_ASSERT_NOT_NULL_MESSAGE(made[i], error.text);
        routine[i] = made[i];
    }
    fill_triangles(&key, t);
    runs_of_every_length(routine, t->what);
    rectangles_of_every_height(routine, t->what);
    shapes_that_are_no_rectangles(routine, t->what);
    triangles_after_each_other(routine, t->what);
    a_tile_is_drawn_or_left(routine, t);
    for (unsigned i = 0; i < 2; i++)
        engine[i]->free(arena, made[i]);
}

static void runs_have_the_same_texels_wherever_their_texels_follow_each_other(void)
{
    static const struct texels rows[] = {
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
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        all_are_equal(rows + i);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(runs_have_the_same_texels_wherever_their_texels_follow_each_other);
    return UNITY_END();
}
