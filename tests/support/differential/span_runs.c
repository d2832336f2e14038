#include "tests/support/differential/span_runs.h"
#include "tests/support/system/bytes.h"

#include <string.h>
#include <unity.h>

enum { RUNS = 2, RECORDS = 2 };

union key span_textured(int filter, int address, int compact)
{
    union key key;
    memset(&key, 0, sizeof key);
    key.pixel.span = SPAN_LEVEL;
    key.pixel.depth_function = COMPARE_ALWAYS;
    key.pixel.stages = key.pixel.texture[0] = 1;
    key.pixel.write_mask[0] = 15;
    key.pixel.varying[VARYING_texcoord0] = INTERPOLATION_SMOOTH;
    key.pixel.filter[0] = (uint8_t)filter;
    key.pixel.compact[0] = (uint8_t)compact;
    key.pixel.address_u[0] = key.pixel.address_v[0] = (uint8_t)address;
    key.pixel.color_argument[0] = key.pixel.alpha_argument[0] = 1;
    return key;
}

static void fill_record(struct differential *d, unsigned number, const struct span_texels *t)
{
    uint8_t *record = d->triangles + number * d->layout.stride;
    const struct plane one = {1, 0, 0}, u = {t->first / SPAN_SIDE, t->step / SPAN_SIDE, 0},
                       v = {0, 0, t->down / SPAN_SIDE};
    struct triangle_head *head = (void *)record;
    head->origin_x = head->origin_y = t->origin;
    memcpy(record + d->layout.reciprocal_w, &one, sizeof one);
    memcpy(record + d->layout.varying[VARYING_texcoord0], &u, sizeof u);
    memcpy(record + d->layout.varying[VARYING_texcoord0] + sizeof u, &v, sizeof v);
}

void span_fill_triangles(struct differential *d, const union key *key, const struct span_texels *t)
{
    struct span_texels further = *t;
    further.first += SPAN_SIDE / 2;
    differential_fill(d, UNIT_PIXEL, key, RECORDS);
    d->job.texture[0] = (struct texture_job){.texels = (const uint32_t *)(const void *)d->texels,
                                             .width = SPAN_SIDE,
                                             .height = SPAN_SIDE,
                                             .width_256 = 256 * SPAN_SIDE,
                                             .height_256 = 256 * SPAN_SIDE,
                                             .last_u = SPAN_SIDE - 1,
                                             .last_v = SPAN_SIDE - 1,
                                             .pitch = SPAN_SIDE,
                                             .last_u_256 = 256 * (SPAN_SIDE - 1),
                                             .last_v_256 = 256 * (SPAN_SIDE - 1)};
    fill_record(d, 0, t);
    fill_record(d, 1, &further);
}

void span_add_run(struct differential *d, unsigned row, unsigned start, unsigned end, unsigned triangle)
{
    for (unsigned x = start; x < end; x++)
        d->entries.entry[d->count++] = (struct entry){.x = (float)(BLOCK_SIZE * x),
                                                      .y = (float)(BLOCK_SIZE * row),
                                                      .coverage = UINT16_MAX,
                                                      .block = (uint16_t)(row * SPAN_ROW + x),
                                                      .triangle = triangle * d->layout.stride};
}

void span_fill_runs(struct differential *d, unsigned rows, unsigned start, unsigned length)
{
    d->count = 0;
    for (unsigned row = 0; row < rows; row++)
        span_add_run(d, row, start, start + length, 0);
}

void span_expect_equal(struct differential *d, const struct routine *const routine[2], const char *what)
{
    for (unsigned i = 0; i < 2; i++) {
        d->result[i] = d->initial;
        const struct differential_arguments arguments = differential_arguments(d, &d->result[i]);
        routine_run(routine[i], &arguments.pixel, d->count * BLOCK_PIXELS);
    }
    TEST_ASSERT_SAME_BYTES(d->result[0].color, d->result[1].color, TILE_PLANE_BYTES, what);
}

static void runs_of_every_length(struct differential *d, const struct routine *const routine[2],
                                 const char *what)
{
    for (unsigned rows = 1; rows <= RUNS; rows++)
        for (unsigned start = 0; start < SPAN_ROW; start++)
            for (unsigned length = 1; start + length <= SPAN_ROW; length++) {
                span_fill_runs(d, rows, start, length);
                span_expect_equal(d, routine, what);
            }
}

static void rectangles_of_every_height(struct differential *d, const struct routine *const routine[2],
                                       const char *what)
{
    for (unsigned rows = 1; rows <= SPAN_ROW; rows++)
        for (unsigned length = 1; length <= SPAN_ROW; length += 5) {
            span_fill_runs(d, rows, (SPAN_ROW - length) / 2, length);
            span_expect_equal(d, routine, what);
        }
}

/* The columns of the runs of a triangle and of the next one change at a row, by these blocks. */
static void shapes_that_are_no_rectangles(struct differential *d, const struct routine *const routine[2],
                                          const char *what)
{
    for (unsigned change = 0; change < SPAN_ROW; change++)
        for (int left = -1; left <= 1; left++)
            for (int right = -1; right <= 2; right++) {
                d->count = 0;
                for (unsigned row = 0; row < SPAN_ROW; row++) {
                    const bool moved = row >= change;
                    span_add_run(d, row, 3u + (moved ? (unsigned)left : 0),
                                 9u + (moved ? (unsigned)right : 0), 0);
                }
                for (unsigned row = 0; row < SPAN_ROW; row++)
                    span_add_run(d, row, row / 2, SPAN_ROW - change, 1);
                span_expect_equal(d, routine, what);
            }
}

/* Runs with equal columns, of two triangles. */
static void triangles_after_each_other(struct differential *d, const struct routine *const routine[2],
                                       const char *what)
{
    for (unsigned change = 0; change < SPAN_ROW; change++) {
        d->count = 0;
        for (unsigned row = 0; row < SPAN_ROW; row++)
            span_add_run(d, row, 2, 14, row >= change);
        span_expect_equal(d, routine, what);
    }
}

void span_expect_equal_shapes(struct differential *d, const struct routine *const routine[2],
                              const char *what)
{
    runs_of_every_length(d, routine, what);
    rectangles_of_every_height(d, routine, what);
    shapes_that_are_no_rectangles(d, routine, what);
    triangles_after_each_other(d, routine, what);
}
