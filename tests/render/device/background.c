/* Rendering in the background while draws are recorded. The image, depths and counts of queries are those of
 * one thread, whatever changes between the draws. Other tests check when threads are woken. */
#include "render/device/device.h"
#include "emu/emulate/emulate.h"
#include "engines/list.h"
#include "tests/support/system/seed.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unity.h>

enum { SIZE = 200, TEXELS = 8, DRAWS = 3 * QUEUE_COMMANDS + 77, QUERIES = 4 };

struct result {
    uint32_t image[SIZE * SIZE];
    float depth[SIZE * SIZE];
    uint64_t passed[QUERIES];
};

static triptych_device *device;
static struct result expected, got;
static uint32_t in_background; /* the number of draws after which a background round was running */

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

static const char shader_text[] = "vs_2_0\n"
                                  "dcl_position v0\n"
                                  "mul r0, v0, c5\n"
                                  "add oPos, r0, c4\n"
                                  "mov oD0, c6\n"
                                  "mov oT0, v0\n";

static void close_device(void)
{
    device_destroy(device);
    device = NULL;
}

static void open_device(const struct engine *engine, const struct device_options *options)
{
    static const float corner[6][4] = {{-1, -1, 0, 1},   {1, -1, 0.5f, 1}, {-1, 1, 1, 1},
                                       {1, -1, 0.5f, 1}, {1, 1, 0, 1},     {-1, 1, 1, 1}};
    triptych_shader *shader;
    triptych_buffer *buffer;
    close_device();
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(engine, options, &device, NULL));
    OK(triptych_set_target(device, SIZE, SIZE));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    OK(triptych_shader_assemble(device, "place", shader_text, sizeof shader_text - 1, &shader));
    OK(triptych_set_vertex_shader(device, shader));
    OK(triptych_buffer_create(device, corner, sizeof corner, &buffer));
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof *corner};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
}

void setUp(void)
{
    in_background = 0;
}

void tearDown(void)
{
    close_device();
}

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525 + 1013904223;
    return *seed >> 8;
}

static float random_float(uint32_t *seed, float low, float high)
{
    return low + (high - low) * (float)next_random(seed) / (1 << 24);
}

static void place(uint32_t *seed)
{
    float size = random_float(seed, 0.02f, next_random(seed) % 64 ? 0.1f : 1.2f);
    float at[4] = {random_float(seed, -1, 1), random_float(seed, -1, 1), random_float(seed, 0, 0.5f), 0};
    float scale[4] = {size, size, 0.4f, 1}, color[4];
    for (int c = 0; c < 4; c++)
        color[c] = random_float(seed, 0, 1);
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 4, at, 1));
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 5, scale, 1));
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 6, color, 1));
}

/* Changes states so that keys change, and earlier keys occur again. */
static void change_states(uint32_t *seed)
{
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHABLENDENABLE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_SRCBLEND, 2 + next_random(seed) % 7));
    OK(triptych_set_state(device, TRIPTYCH_STATE_DESTBLEND, 2 + next_random(seed) % 7));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZFUNC, 2 + next_random(seed) % 7));
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 1 + next_random(seed) % 15));
}

static void fill_texture(triptych_texture *texture, uint32_t *seed)
{
    uint32_t texel[TEXELS * TEXELS];
    for (int i = 0; i < TEXELS * TEXELS; i++)
        texel[i] = next_random(seed) << 8 | next_random(seed);
    OK(triptych_texture_update(device, texture, 0, 0, NULL, texel, TEXELS * sizeof *texel, 0));
}

static triptych_texture *make_texture(uint32_t *seed)
{
    struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, TEXELS, TEXELS, 1, 1};
    triptych_texture *texture;
    OK(triptych_texture_define(device, &description, &texture));
    fill_texture(texture, seed);
    return texture;
}

/* Changes a texture while draws that use it may be rendered in the background: first when the newest draws do
 * not use it, and later when they do. */
static void change_texture(triptych_texture *texture, uint32_t i, uint32_t *seed)
{
    if (i == QUEUE_COMMANDS - 10)
        OK(triptych_set_texture(device, 0, NULL));
    if (i == QUEUE_COMMANDS + 40 || i == 2 * QUEUE_COMMANDS + 200)
        fill_texture(texture, seed);
    if (i == QUEUE_COMMANDS + 50)
        OK(triptych_set_texture(device, 0, texture));
}

static void draw_scene(struct result *result)
{
    triptych_query *query[QUERIES];
    /* Sanitizers need accesses of each kind, not many pixels. */
    uint32_t seed = 5, side = test_stride() > 1 ? SIZE / 2 : SIZE;
    memset(result, 0, sizeof *result);
    OK(triptych_set_target(device, side, side));
    triptych_texture *texture = make_texture(&seed);
    OK(triptych_set_texture(device, 0, texture));
    for (int q = 0; q < QUERIES; q++)
        OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query[q]));
    for (uint32_t i = 0; i < DRAWS; i++) {
        for (uint32_t q = 0; q < QUERIES; q++) {
            if (i == 100 + 750 * q)
                OK(triptych_query_begin(device, query[q]));
            if (i == 770 + 750 * q)
                OK(triptych_query_end(device, query[q]));
        }
        if (i % 40 == 0)
            change_states(&seed);
        if (i % 500 == 499)
            OK(triptych_clear(device, NULL, 0.9f));
        change_texture(texture, i, &seed);
        place(&seed);
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 2));
        in_background += device->rendered.commands != 0;
    }
    OK(triptych_read_color(device, result->image, side * side * sizeof *result->image));
    OK(triptych_read_depth(device, result->depth, side * side * sizeof *result->depth));
    for (int q = 0; q < QUERIES; q++)
        OK(triptych_query_result(device, query[q], &result->passed[q]));
}

static void expect_the_same(const struct engine *engine, const struct device_options *options)
{
    open_device(engine, options);
    draw_scene(&got);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &got, sizeof got, engine->name);
}

/* Draws the scene for the first test that compares with it. */
static void draw_expected(void)
{
    static bool drawn;
    if (drawn)
        return;
    open_device(&engine_emulate, &(struct device_options){.threads = 1});
    draw_scene(&expected);
    TEST_ASSERT_EQUAL_UINT32(0, in_background);
    for (int q = 0; q < QUERIES; q++)
        TEST_ASSERT_TRUE(expected.passed[q] > 0);
    drawn = true;
}

static void the_image_is_that_of_one_thread(void)
{
    draw_expected();
    for (unsigned threads = 2; threads <= 5; threads += test_stride())
        expect_the_same(&engine_emulate, &(struct device_options){.threads = threads});
    TEST_ASSERT_TRUE(in_background > test_share(4) * 100);
}

static void routines_that_are_used_in_the_background_stay(void)
{
    const struct engine *engine = engine_find("specialize");
    draw_expected();
    if (engine_unavailable(engine))
        TEST_IGNORE_MESSAGE(engine_unavailable(engine));
    expect_the_same(engine, &(struct device_options){.threads = 2});
    expect_the_same(engine, &(struct device_options){.threads = 3, .cache_bytes = 20000});
    TEST_ASSERT_TRUE(in_background > 0);
}

static void a_small_arena_takes_many_rounds_in_the_background(void)
{
    draw_expected();
    expect_the_same(&engine_emulate,
                    &(struct device_options){.threads = 2, .arena_bytes = ARENA_BLOCK * 5 / 4});
    TEST_ASSERT_TRUE(in_background > 0);
}

/* Nothing waits for the draws before the device is destroyed. */
static void a_device_may_be_destroyed_meanwhile(void)
{
    uint32_t seed = 5;
    for (unsigned times = 0; times < test_share(5); times++) {
        open_device(&engine_emulate, &(struct device_options){.threads = 2});
        for (uint32_t i = 0; i < QUEUE_COMMANDS + 3; i++) {
            place(&seed);
            OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 2));
        }
        TEST_ASSERT_EQUAL_UINT32(QUEUE_COMMANDS, device->rendered.commands);
        TEST_ASSERT_EQUAL_UINT32(3, device->queue->commands.count);
    }
}

/* --- Without waiting --- */

static void end_after_draws(triptych_query **query, uint32_t draws)
{
    uint32_t seed = 9;
    OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, query));
    OK(triptych_query_begin(device, *query));
    for (uint32_t i = 0; i < draws; i++) {
        place(&seed);
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 2));
    }
    OK(triptych_query_end(device, *query));
}

static uint64_t passed_with_one_thread(uint32_t draws)
{
    triptych_query *query;
    uint64_t passed;
    open_device(&engine_emulate, &(struct device_options){.threads = 1});
    end_after_draws(&query, draws);
    OK(triptych_query_result(device, query, &passed));
    TEST_ASSERT_GREATER_THAN_UINT64(0, passed);
    return passed;
}

static void a_flush_begins_to_render_in_the_background(void)
{
    triptych_query *query;
    open_device(&engine_emulate, &(struct device_options){.threads = 2});
    end_after_draws(&query, 100);
    OK(triptych_flush(device));
    TEST_ASSERT_EQUAL_UINT32(100, device->rendered.commands);
    TEST_ASSERT_EQUAL_UINT32(0, device->queue->commands.count);
}

static void a_flush_while_draws_are_rendered_leaves_later_ones_in_the_queue(void)
{
    triptych_query *query;
    open_device(&engine_emulate, &(struct device_options){.threads = 2});
    end_after_draws(&query, QUEUE_COMMANDS);
    OK(triptych_flush(device));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 2));
    OK(triptych_flush(device));
    bool busy = pool_is_busy(device->pool); /* also before the second flush, then */
    TEST_ASSERT_TRUE(!busy || device->queue->commands.count <= 1);
    TEST_ASSERT_EQUAL_UINT32(device->queue->commands.count ? QUEUE_COMMANDS : 1, device->rendered.commands);
}

static void a_poll_finds_the_result_without_waiting(void)
{
    uint64_t passed = 0, expected_count = passed_with_one_thread(200);
    triptych_query *query;
    unsigned polls = 0;
    int ready = 0;
    open_device(&engine_emulate, &(struct device_options){.threads = 2});
    end_after_draws(&query, 200);
    while (!ready) {
        OK(triptych_query_poll(device, query, &ready, &passed));
        polls++;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(1, polls); /* the first one only begins */
    TEST_ASSERT_EQUAL_UINT64(expected_count, passed);
}

static void with_one_thread_a_poll_renders(void)
{
    uint64_t passed = 0, expected_count = passed_with_one_thread(30);
    triptych_query *query;
    int ready = 0;
    open_device(&engine_emulate, &(struct device_options){.threads = 1});
    end_after_draws(&query, 30);
    OK(triptych_query_poll(device, query, &ready, &passed));
    TEST_ASSERT_EQUAL_INT(1, ready);
    TEST_ASSERT_EQUAL_UINT64(expected_count, passed);
}

static void a_poll_of_a_query_that_has_not_ended_is_refused(void)
{
    triptych_query *query;
    uint64_t passed = 77;
    int ready = 5;
    open_device(&engine_emulate, &(struct device_options){.threads = 1});
    OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_query_poll(device, query, &ready, &passed));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_query_poll(device, query, NULL, &passed));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_query_poll(device, NULL, &ready, &passed));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_flush(NULL));
    TEST_ASSERT_TRUE(passed == 77 && ready == 5);
}

static void limited_to_one_thread_nothing_is_in_the_background(void)
{
    const struct engine *engine = engine_find("specialize");
    draw_expected();
    open_device(engine_unavailable(engine) ? &engine_emulate : engine,
                &(struct device_options){.threads = 3});
    device_limit_threads(device, 1);
    draw_scene(&got);
    TEST_ASSERT_EQUAL_MEMORY(&expected, &got, sizeof got);
    TEST_ASSERT_EQUAL_UINT32(0, in_background);
}

/* --- Which threads are woken --- */

static void let_workers_sleep(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 20 * 1000 * 1000}, NULL);
}

static void draw_square(float x, float y, float size)
{
    const float at[4] = {x, y, 0, 0}, scale[4] = {size, size, 1, 1}, color[4] = {1, 1, 1, 1};
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 4, at, 1));
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 5, scale, 1));
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 6, color, 1));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 2));
    OK(triptych_finish(device));
}

/* The draw is within one tile, so other threads have no work. */
static void a_small_draw_wakes_no_thread(void)
{
    open_device(&engine_emulate, &(struct device_options){.threads = 4});
    let_workers_sleep();
    for (int i = 0; i < 50; i++)
        draw_square(-0.8f, 0.8f, 0.01f);
    TEST_ASSERT_EQUAL_UINT64(0, pool_wakes(device->pool));
}

/* Threads that do not sleep yet are not woken, so the test draws again. */
static void a_large_draw_wakes_threads(void)
{
    open_device(&engine_emulate, &(struct device_options){.threads = 4});
    for (int i = 0; i < 500 && !pool_wakes(device->pool); i++) {
        let_workers_sleep();
        for (int layer = 0; layer < 4; layer++)
            draw_square(0, 0, 1);
    }
    TEST_ASSERT_TRUE(pool_wakes(device->pool) > 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_image_is_that_of_one_thread);
    RUN_TEST(routines_that_are_used_in_the_background_stay);
    RUN_TEST(a_small_arena_takes_many_rounds_in_the_background);
    RUN_TEST(a_device_may_be_destroyed_meanwhile);
    RUN_TEST(a_flush_begins_to_render_in_the_background);
    RUN_TEST(a_flush_while_draws_are_rendered_leaves_later_ones_in_the_queue);
    RUN_TEST(a_poll_finds_the_result_without_waiting);
    RUN_TEST(with_one_thread_a_poll_renders);
    RUN_TEST(a_poll_of_a_query_that_has_not_ended_is_refused);
    RUN_TEST(limited_to_one_thread_nothing_is_in_the_background);
    RUN_TEST(a_small_draw_wakes_no_thread);
    RUN_TEST(a_large_draw_wakes_threads);
    return UNITY_END();
}
