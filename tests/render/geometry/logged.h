/* A batch whose routines only record their arguments. */
#ifndef TESTS_RENDER_GEOMETRY_LOGGED_H
#define TESTS_RENDER_GEOMETRY_LOGGED_H

#include "render/geometry/batch.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { LOG_CAPACITY = 20000 };

/* The arguments of the setup routine: vertex numbers of each triangle, in order. */
static uint32_t triangle_log[LOG_CAPACITY][3];
static struct {
    uint32_t provoking, last_pixel;
} other_log[LOG_CAPACITY]; /* and of primitives that are not triangles */
static uint32_t vertex_calls, vertices_padded, triangles_padded;
static uint32_t *clip_codes; /* of each vertex number; null: all inside */
static struct arena arena;
static struct bin_writer *bins;
static struct batch *batch;
static struct job job;
static struct draw draw;
static uint32_t heads;
static uint32_t first_primitive; /* of the last setup call */

/* Writes the number of each vertex to its x, which setup reads from the batch. */
static inline void log_vertices(const void *arguments, const struct routine *routine)
{
    const struct vertex_arguments *call = arguments;
    TEST_ASSERT_EQUAL_UINT32(0, call->count % routine->lanes);
    TEST_ASSERT_TRUE(call->count <= VERTEX_CAPACITY);
    vertex_calls++;
    vertices_padded += call->count;
    for (uint32_t i = 0; i < call->count; i++) {
        uint32_t code = clip_codes ? clip_codes[call->index[i]] : 0;
        call->out[SLOT_X * VERTEX_CAPACITY + i] = (float)call->index[i];
        memcpy(call->out + SLOT_CODE * VERTEX_CAPACITY + i, &code, sizeof code);
    }
}

/* Records triangles and lets each one cover the first pixel of the target and a few next to it. */
static inline void log_triangles(const void *arguments, const struct routine *routine)
{
    const struct setup_arguments *call = arguments;
    TEST_ASSERT_EQUAL_UINT32(0, call->count % routine->lanes);
    TEST_ASSERT_TRUE(call->count <= SETUP_CAPACITY);
    triangles_padded += call->count;
    first_primitive = call->primitive;
    uint32_t first =
        (uint32_t)batch->counts.triangles_set_up; /* the padding of earlier groups is overwritten */
    for (uint32_t i = 0; i < call->count; i++) {
        struct triangle_head head = {.visible = -1, .x = {0, 2560, 0}, .y = {128, 128, 2560}};
        memcpy(call->out + (size_t)i * draw.stride, &head, sizeof head);
        for (int v = 0; v < 3 && first + i < LOG_CAPACITY; v++)
            triangle_log[first + i][v] =
                (uint32_t)call->vertices[SLOT_X * VERTEX_CAPACITY + call->index[v * SETUP_CAPACITY + i] / 4];
        if (routine->key.setup.primitive != PRIMITIVE_TRIANGLE && first + i < LOG_CAPACITY) {
            uint32_t provoking = call->index[3 * SETUP_CAPACITY + i] / 4;
            other_log[first + i].provoking = (uint32_t)call->vertices[SLOT_X * VERTEX_CAPACITY + provoking];
            other_log[first + i].last_pixel = call->index[4 * SETUP_CAPACITY + i];
        }
    }
}

static struct routine vertex_routine = {.run = log_vertices, .unit = UNIT_VERTEX, .lanes = LANES_MAXIMUM};
static struct engine engine;
static struct routine setup_routine = {
    .run = log_triangles, .engine = &engine, .unit = UNIT_SETUP, .lanes = LANES_MAXIMUM};

static inline void begin_log(void)
{
    TEST_ASSERT_EQUAL_INT(0, arena_create(&arena, ARENA_BYTES, NULL));
    bins = calloc(1, sizeof *bins);
    batch = aligned_alloc(64, (sizeof *batch + 63) / 64 * 64);
    TEST_ASSERT_TRUE(bins && batch);
    memset(batch, 0, sizeof *batch);
    memset(&draw, 0, sizeof draw);
    draw.job = &job;
    job.guard_left = job.guard_bottom = -10;
    job.guard_right = job.guard_top = 10;
    draw.routine[UNIT_VERTEX] = &vertex_routine;
    draw.routine[UNIT_SETUP] = &setup_routine;
    draw.scissor = (struct rectangle){0, 0, 128, 64};
    draw.stride = 64;
    setup_routine.key.setup.primitive = PRIMITIVE_TRIANGLE;
    clip_codes = NULL;
    engine.observes = false;
    vertex_calls = vertices_padded = triangles_padded = 0;
    vertex_routine.lanes = setup_routine.lanes = LANES_MAXIMUM;
}

static inline void end_log(void)
{
    free(batch);
    free(bins);
    arena_destroy(&arena);
}

/* Counts begin at 0. Returns the number of primitives that are finished. */
static inline uint32_t run(uint32_t first, uint32_t count)
{
    batch->counts = (struct batch_counts){0};
    bin_begin_round(bins, &arena, 2, 1, 31);
    bin_begin_chunk(bins, 7);
    uint32_t done = batch_primitives(batch, &draw, first, count, bins);
    bin_end_chunk(bins);
    heads = bins->heads[0];
    return done;
}

static inline void expect_triangle(uint32_t i, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t expected[3] = {a, b, c};
    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected, triangle_log[i], 3);
}

static inline void draw_as(enum triptych_primitive primitive, enum primitive kind, enum raster_shape shape)
{
    draw.primitive = primitive;
    draw.shape = shape;
    setup_routine.key.setup.primitive = (uint8_t)kind;
}

static inline void expect_line(uint32_t i, uint32_t a, uint32_t b, bool last_pixel)
{
    TEST_ASSERT_EQUAL_UINT32(a, triangle_log[i][0]);
    TEST_ASSERT_EQUAL_UINT32(b, triangle_log[i][1]);
    TEST_ASSERT_EQUAL_HEX32(last_pixel ? UINT32_MAX : 0, other_log[i].last_pixel);
}

#endif
