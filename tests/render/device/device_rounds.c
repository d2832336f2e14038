/* The whole renderer through the public interface, with the emulator. The image does not depend on the number
 * of threads, the time of rendering or the rounds, and memory is bounded. */
#include "tests/render/device/screen.h"
#include "tests/support/system/seed.h"

#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

void setUp(void)
{
    open_device(1);
}

void tearDown(void)
{
    close_device();
}

/* --- Threads --- */

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525 + 1013904223;
    return *seed >> 8;
}

static float random_float(uint32_t *seed, float low, float high)
{
    return low + (high - low) * (float)next_random(seed) / (1 << 24);
}

/* Blended triangles of all sizes, some of them cut by the eye plane, in many draws with clears between. */
static void draw_scene(bool finish_each)
{
    uint32_t seed = 5;
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHABLENDENABLE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_SRCBLEND, 5));
    OK(triptych_set_state(device, TRIPTYCH_STATE_DESTBLEND, 6));
    for (int d = 0; d < (int)test_share_of(120, 6); d++) {
        struct vertex vertex[3 * 300];
        for (int i = 0; i < 900; i++) {
            float size = d % 3 ? 0.2f : 4, *p = vertex[i].position;
            const float *first = vertex[i - i % 3].position;
            for (int c = 0; c < 3; c++)
                p[c] = i % 3 ? first[c] + random_float(&seed, -size, size) : random_float(&seed, -1, 1);
            p[3] = random_float(&seed, d % 3 ? 0.5f : -0.5f, 2);
            vertex[i].color = next_random(&seed) << 8 | next_random(&seed);
        }
        draw_list(vertex, 300);
        if (d == 7)
            OK(triptych_clear(device, NULL, 0.6f));
        if (finish_each)
            OK(triptych_finish(device));
    }
}

static void the_image_does_not_depend_on_the_number_of_threads(void)
{
    static uint32_t first_image[SIZE * SIZE];
    static float first_depth[SIZE * SIZE];
    static const unsigned threads[] = {2, 4, 7};
    draw_scene(false);
    read_image();
    TEST_ASSERT_TRUE(count_color(0) < SIZE * SIZE / 4);
    memcpy(first_image, image, sizeof image);
    memcpy(first_depth, depth, sizeof depth);
    for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
        close_device();
        open_device(threads[i]);
        draw_scene(false);
        read_image();
        TEST_ASSERT_EQUAL_MEMORY(first_image, image, sizeof image);
        TEST_ASSERT_EQUAL_MEMORY(first_depth, depth, sizeof depth);
    }
}

/* Rendering all draws together or each draw by itself gives the same image. */
static void the_image_does_not_depend_on_when_it_is_rendered(void)
{
    static uint32_t first_image[SIZE * SIZE];
    draw_scene(false);
    read_image();
    memcpy(first_image, image, sizeof image);
    close_device();
    open_device(2);
    draw_scene(true);
    read_image();
    TEST_ASSERT_EQUAL_MEMORY(first_image, image, sizeof image);
}

/* The arena has little more than one block. The threads compete for it, and the scene needs many rounds. */
static void the_image_does_not_depend_on_the_size_of_the_arena(void)
{
    static uint32_t first_image[SIZE * SIZE];
    draw_scene(false);
    read_image();
    memcpy(first_image, image, sizeof image);
    for (unsigned threads = 1; threads <= 4; threads++)
        for (unsigned repeat = 0; repeat < test_share_of(5, 5); repeat++) {
            close_device();
            open_device_with(
                &(struct device_options){.threads = threads, .arena_bytes = ARENA_BLOCK * 5 / 4});
            draw_scene(false);
            read_image();
            TEST_ASSERT_EQUAL_MEMORY(first_image, image, sizeof image);
            TEST_ASSERT_TRUE(device->queue->statistics.rounds > test_share_of(12, 12));
        }
}

/* The emulator, except that the first batch with vertex 0 waits until another chunk has filled the arena, for
 * at most ten seconds. */
static routine_function *emulate_vertices;
static bool lingered;

static void linger_over_vertex_0(const void *arguments, const struct routine *routine)
{
    bool lingers = ((const struct vertex_arguments *)arguments)->index[0] == 0 && !lingered;
    if (lingers)
        lingered = true;
    for (int i = 0; lingers && i < 10000 && device->queue->round.first_stopped == UINT32_MAX; i++)
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    emulate_vertices(arguments, routine);
}

static struct routine *build_lingering(const struct engine *self, struct code_arena *arena, enum unit unit,
                                       const union key *key, struct error *error)
{
    (void)self;
    struct routine *routine = engine_build(&engine_emulate, arena, unit, key, error);
    if (routine && unit == UNIT_VERTEX) {
        emulate_vertices = routine->run;
        routine->run = linger_over_vertex_0;
    }
    return routine;
}

/* One thread waits in the first chunk while the other one uses the whole arena for the second chunk. */
static void a_starved_chunk_is_rendered_in_a_round_of_its_own(void)
{
    enum { TRIANGLES = 2 * CHUNK_PRIMITIVES };
    static struct engine lingering;
    struct vertex *vertex = malloc(3 * TRIANGLES * sizeof *vertex);
    TEST_ASSERT_NOT_NULL(vertex);
    for (int i = 0; i < 3 * TRIANGLES; i += 3) {
        float z = 1 - (float)i / (3 * TRIANGLES);
        vertex[i] = at(0, 0, z, i == 0 ? GREEN_ARGB : RED_ARGB);
        vertex[i + 1] = at(8, 0, z, i == 0 ? GREEN_ARGB : RED_ARGB);
        vertex[i + 2] = at(0, 8, z, i == 0 ? GREEN_ARGB : RED_ARGB);
    }
    lingering = engine_emulate;
    lingering.build = build_lingering;
    lingered = false;
    close_device();
    open_engine(&lingering, &(struct device_options){.threads = 2, .arena_bytes = ARENA_BLOCK * 5 / 4});
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZFUNC, 8));
    draw_list(vertex, TRIANGLES);
    free(vertex);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(28, count_color(RED)); /* 36 less the 8 centres on the diagonal */
    TEST_ASSERT_TRUE(device->queue->statistics.starved_rounds > 0);
    TEST_ASSERT_EQUAL_UINT64(TRIANGLES, device->queue->statistics.triangles_visible);
    TEST_ASSERT_EQUAL_UINT64(28 * TRIANGLES, device->queue->statistics.pixels_shaded);
}

static int refuse_thread(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                         void *argument)
{
    (void)thread, (void)attributes, (void)run, (void)argument;
    return EAGAIN;
}

static void without_more_threads_only_the_caller_renders(void)
{
    close_device();
    open_device_with(&(struct device_options){.threads = 8, .create_thread = refuse_thread});
    TEST_ASSERT_EQUAL_UINT32(1, pool_workers(device->pool));
    draw_rectangle(10, 10, 90, 90, 0.5f, RED_ARGB);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(6400, count_color(RED));
}

/* --- Bounds --- */

static size_t resident_peak(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (size_t)usage.ru_maxrss * 1024;
}

/* One draw needs more than the arena. Its last triangle is visible. */
static void one_huge_draw_is_rendered_in_rounds(void)
{
    const unsigned triangles = test_share(700000), arena = ARENA_BYTES / test_stride();
    static const struct triptych_viewport corner = {0, 0, 1, 1, 0, 1};
    uint32_t *index = malloc(triangles * 3 * sizeof *index);
    TEST_ASSERT_NOT_NULL(index);
    for (uint32_t i = 0; i < triangles * 3; i++)
        index[i] = i % 3 + (i < triangles * 3 - 3 ? 0 : 3);
    struct vertex v[6] = {{{-1, 1, 0, 1}, GREEN_ARGB},  {{3, 1, 0, 1}, GREEN_ARGB},
                          {{-1, -3, 0, 1}, GREEN_ARGB}, {{-1, 1, 0, 1}, RED_ARGB},
                          {{3, 1, 0, 1}, RED_ARGB},     {{-1, -3, 0, 1}, RED_ARGB}};
    close_device();
    open_device_with(&(struct device_options){.threads = 2, .arena_bytes = arena});
    OK(triptych_set_viewport(device, &corner));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    bind(buffer_of(v, sizeof v));
    OK(triptych_set_indices(device, buffer_of(index, triangles * 3 * sizeof *index), 32));
    free(index);
    size_t before = resident_peak();
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, triangles));
    read_image();
    TEST_ASSERT_EQUAL_UINT32(1, count_color(RED));
    TEST_ASSERT_TRUE(device->queue->statistics.rounds > 1);
    TEST_ASSERT_TRUE(resident_peak() - before < (size_t)arena + (16 << 20));
    struct triptych_statistics statistics;
    triptych_get_statistics(device, &statistics);
    TEST_ASSERT_EQUAL_UINT64(triangles, statistics.triangles_set_up);
    TEST_ASSERT_EQUAL_UINT64(triangles, statistics.pixels_shaded);
}

static void more_draws_than_the_queue_holds_are_all_drawn(void)
{
    struct vertex v[3] = {
        {{-1, 1, 0, 1}, 0x01010101}, {{3, 1, 0, 1}, 0x01010101}, {{-1, -3, 0, 1}, 0x01010101}};
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, 1, 1, 0, 1}));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_SHADEMODE, 1));
    bind(buffer_of(v, sizeof v));
    for (int i = 0; i < QUEUE_COMMANDS + 100; i++)
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    OK(triptych_finish(device));
    struct triptych_statistics statistics;
    triptych_get_statistics(device, &statistics);
    TEST_ASSERT_EQUAL_UINT64(QUEUE_COMMANDS + 100, statistics.draws);
    TEST_ASSERT_EQUAL_UINT64(QUEUE_COMMANDS + 100, statistics.pixels_shaded);
    TEST_ASSERT_EQUAL_UINT64(3, statistics.cache_misses);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_image_does_not_depend_on_the_number_of_threads);
    RUN_TEST(the_image_does_not_depend_on_when_it_is_rendered);
    RUN_TEST(the_image_does_not_depend_on_the_size_of_the_arena);
    RUN_TEST(a_starved_chunk_is_rendered_in_a_round_of_its_own);
    RUN_TEST(without_more_threads_only_the_caller_renders);
    RUN_TEST(one_huge_draw_is_rendered_in_rounds);
    RUN_TEST(more_draws_than_the_queue_holds_are_all_drawn);
    return UNITY_END();
}
