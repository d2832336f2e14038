/* The application's objects and the budgets bound the used memory; the number of draws does not. A process
 * that draws many triangles, states, shaders or constants has the same largest resident size as a process
 * that draws a few, except for additional buffers.
 *
 * Each measurement is a process of its own. With TRIPTYCH_SOAK set: 10 million triangles and 100,000
 * states. */
#define _GNU_SOURCE
#include "engines/list.h"
#include "tests/support/system/seed.h"
#include "triptych.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

enum { SIDE = 128, SLACK_KIB = 2048 };

static bool soak;
static triptych_device *device;
static const char *engine;
static unsigned threads;
static size_t cache_bytes;

#define OK(call)                                                                                             \
    do                                                                                                       \
        if (call) {                                                                                          \
            fprintf(stderr, "%s: %s\n", #call, device ? triptych_error(device) : "no device");               \
            _exit(1);                                                                                        \
        }                                                                                                    \
    while (0)

void setUp(void)
{
    engine = "specialize";
    threads = 1;
    cache_bytes = 0;
}

void tearDown(void)
{
}

/* Sanitizers keep freed memory. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { INSTRUMENTED = 1 };
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
enum { INSTRUMENTED = 1 };
#else
enum { INSTRUMENTED = 0 };
#endif
#else
enum { INSTRUMENTED = 0 };
#endif

/* --- Measuring ------------------------------------------------------------------------------------------ */

typedef void workload(unsigned long amount);

static long peak_kib(void)
{
    char line[256];
    long peak = 0;
    FILE *status = fopen("/proc/self/status", "r");
    while (status && fgets(line, sizeof line, status))
        if (sscanf(line, "VmHWM: %ld kB", &peak) == 1)
            break;
    if (status)
        fclose(status);
    return peak;
}

static void open_device(void)
{
    struct triptych_options options = {.engine = engine, .threads = threads, .cache_bytes = cache_bytes};
    OK(triptych_device_create(&options, &device, NULL, 0));
    OK(triptych_set_target(device, SIDE, SIDE));
    OK(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    OK(triptych_clear(device, (const float[4]){0}, 1));
}

/* Returns the largest resident size, in KiB, of a process that does this work. */
static long measure(workload *work, unsigned long amount)
{
    int ends[2], status;
    long peak = 0;
    TEST_ASSERT_EQUAL_INT(0, pipe(ends));
    fflush(NULL);
    pid_t process = fork();
    TEST_ASSERT_GREATER_OR_EQUAL(0, process);
    if (!process) {
        open_device();
        work(amount);
        OK(triptych_finish(device));
        peak = peak_kib();
        triptych_device_destroy(device);
        _exit(write(ends[1], &peak, sizeof peak) != sizeof peak);
    }
    close(ends[1]);
    TEST_ASSERT_EQUAL_INT(sizeof peak, read(ends[0], &peak, sizeof peak));
    close(ends[0]);
    TEST_ASSERT_EQUAL_INT(process, waitpid(process, &status, 0));
    TEST_ASSERT_EQUAL_INT(0, status);
    return peak;
}

/* Fails if the larger amount of work needs more memory than the smaller one, apart from `held_kib` KiB of
 * additional buffers. A build with sanitizers does a share of the work. */
static void expect_bounded(workload *work, unsigned long few, unsigned long many, long held_kib)
{
    char message[256];
    few /= test_stride_of(8);
    many /= test_stride_of(8);
    long small = measure(work, few), large = measure(work, many);
    snprintf(message, sizeof message,
             "%s, %u threads: %ld KiB for %lu, %ld KiB for %lu, of them %ld KiB of buffers", engine, threads,
             small, few, large, many, held_kib);
    if (soak)
        printf("%s\n", message);
    if (INSTRUMENTED)
        return;
    TEST_ASSERT_TRUE_MESSAGE(large <= small + held_kib + SLACK_KIB, message);
}

/* --- Triangles ------------------------------------------------------------------------------------------ */

enum { GRID = 100, FILLING = 1500000 }; /* vertices a side; triangles that fill the arena of a round */

static void use_grid(void)
{
    static float vertices[GRID * GRID][3];
    triptych_buffer *buffer;
    for (unsigned i = 0; i < GRID * GRID; i++) {
        vertices[i][0] = (float)(i % GRID) / (GRID / 2) - 1;
        vertices[i][1] = (float)(i / GRID) / (GRID / 2) - 1;
        vertices[i][2] = 0.5f;
    }
    OK(triptych_buffer_create(device, vertices, sizeof vertices, &buffer));
    OK(triptych_set_element(device, TRIPTYCH_POSITION,
                            &(struct triptych_element){TRIPTYCH_FORMAT_FLOAT3, buffer, 0, 12}));
}

static uint16_t corner(unsigned long i)
{
    unsigned long cell = i / 3 % ((GRID - 1) * (GRID - 1)),
                  first = cell / (GRID - 1) * GRID + cell % (GRID - 1);
    return (uint16_t)(first + (i % 3 == 1) + (i % 3 == 2) * GRID);
}

/* One call draws all triangles. The indices are in a buffer of the application. */
static void draw_at_once(unsigned long triangles)
{
    uint16_t *indices = malloc(triangles * 3 * sizeof *indices);
    triptych_buffer *buffer;
    for (unsigned long i = 0; i < 3 * triangles; i++)
        indices[i] = corner(i);
    use_grid();
    OK(triptych_buffer_create(device, indices, triangles * 3 * sizeof *indices, &buffer));
    free(indices);
    OK(triptych_set_indices(device, buffer, 16));
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, (uint32_t)triangles));
}

/* Each call draws ten thousand triangles. */
static void draw_in_parts(unsigned long triangles)
{
    enum { PART = 10000 };
    static uint16_t indices[PART * 3];
    triptych_buffer *buffer;
    for (unsigned i = 0; i < 3 * PART; i++)
        indices[i] = corner(i);
    use_grid();
    OK(triptych_buffer_create(device, indices, sizeof indices, &buffer));
    OK(triptych_set_indices(device, buffer, 16));
    for (unsigned long done = 0; done < triangles; done += PART)
        OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, PART));
}

/* While the indices are copied, memory contains them twice. */
static void test_a_draw_of_many_triangles(void)
{
    unsigned long few = FILLING, many = soak ? 10000000 : 2 * FILLING;
    for (threads = 1; threads <= 2; threads++)
        expect_bounded(draw_at_once, few, many, (long)((many - few) * 3 * sizeof(uint16_t) * 2 >> 10));
}

static void test_many_draws_of_triangles(void)
{
    for (threads = 1; threads <= 2; threads++)
        expect_bounded(draw_in_parts, FILLING, soak ? 10000000 : 3 * FILLING, 0);
}

/* --- States --------------------------------------------------------------------------------------------- */

static unsigned digit(unsigned long *number, unsigned base)
{
    unsigned value = (unsigned)(*number % base);
    *number /= base;
    return value;
}

/* Nearly all numbers below 151,200 give different keys. The test requires five of six. */
static void set_state(unsigned long number)
{
    OK(triptych_set_state(device, TRIPTYCH_STATE_SRCBLEND, 1 + digit(&number, 10)));
    OK(triptych_set_state(device, TRIPTYCH_STATE_DESTBLEND, 1 + digit(&number, 10)));
    OK(triptych_set_state(device, TRIPTYCH_STATE_BLENDOP, 1 + digit(&number, 3)));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZFUNC, 2 + digit(&number, 6)));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAFUNC, 2 + digit(&number, 6)));
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 1 + digit(&number, 14)));
}

static void draw_with_states(unsigned long states)
{
    struct triptych_statistics statistics;
    use_grid();
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHABLENDENABLE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHATESTENABLE, 1));
    for (unsigned long i = 0; i < states; i++) {
        set_state(i);
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    }
    triptych_get_statistics(device, &statistics);
    if (statistics.cache_misses < states * 5 / 6) {
        fprintf(stderr, "%lu states have only %lu routines\n", states,
                (unsigned long)statistics.cache_misses);
        _exit(1);
    }
}

static void test_many_states(void)
{
    static const char *const engines[] = {"specialize", "stitch", "stitch-operation", "batch", "emulate"};
    for (unsigned i = 0; i < sizeof engines / sizeof *engines; i++) {
        engine = engines[i];
        cache_bytes = soak ? 0 : 256 << 10; /* the smaller amount fills it */
        if (soak || i < 2)
            expect_bounded(draw_with_states, soak ? 40000 : 1000, soak ? 120000 : 4000, 0);
    }
}

/* --- Shaders and constants ------------------------------------------------------------------------------ */

static void draw_with_shaders(unsigned long shaders)
{
    use_grid();
    for (unsigned long i = 0; i < shaders; i++) {
        char text[128];
        triptych_shader *shader;
        snprintf(text, sizeof text, "ps_2_0\ndef c0, %lu, %lu, 0, 1\nmov r0, c0\nmov oC0, r0\n", i % 1000,
                 i / 1000);
        OK(triptych_shader_assemble(device, NULL, text, strlen(text), &shader));
        OK(triptych_set_pixel_shader(device, shader));
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
        OK(triptych_shader_destroy(device, shader));
    }
}

static void test_many_shaders_that_come_and_go(void)
{
    cache_bytes = soak ? 0 : 256 << 10;
    expect_bounded(draw_with_shaders, soak ? 20000 : 500, soak ? 100000 : 2000, 0);
}

static void draw_with_constants(unsigned long changes)
{
    static const char text[] =
        "vs_2_0\ndcl_position v0\nmova a0.x, c0.x\nmov r0, c[a0.x]\nadd oPos, r0, v0\n";
    triptych_shader *shader;
    use_grid();
    OK(triptych_shader_assemble(device, NULL, text, strlen(text), &shader));
    OK(triptych_set_vertex_shader(device, shader));
    for (unsigned long i = 0; i < changes; i++) {
        OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 7, (const float[4]){(float)i}, 1));
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    }
}

static void test_many_constants(void)
{
    expect_bounded(draw_with_constants, 4000, soak ? 1000000 : 20000, 0);
}

/* --- Objects that are created and destroyed ------------------------------------------------------------- */

static void make_and_destroy(unsigned long count)
{
    static const uint32_t texels[64 * 64];
    for (unsigned long i = 0; i < count; i++) {
        triptych_buffer *buffer;
        triptych_texture *texture;
        triptych_query *query;
        OK(triptych_buffer_create(device, texels, sizeof texels, &buffer));
        OK(triptych_texture_create(device, texels, 64, 64, &texture));
        OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
        OK(triptych_set_texture(device, 0, texture));
        OK(triptych_buffer_destroy(device, buffer));
        OK(triptych_texture_destroy(device, texture));
        OK(triptych_query_destroy(device, query));
    }
}

static void test_buffers_textures_and_queries_that_come_and_go(void)
{
    expect_bounded(make_and_destroy, 100, soak ? 100000 : 2000, 0);
}

int main(void)
{
    soak = getenv("TRIPTYCH_SOAK") != NULL;
    UNITY_BEGIN();
    RUN_TEST(test_a_draw_of_many_triangles);
    RUN_TEST(test_many_draws_of_triangles);
    RUN_TEST(test_many_states);
    RUN_TEST(test_many_shaders_that_come_and_go);
    RUN_TEST(test_many_constants);
    RUN_TEST(test_buffers_textures_and_queries_that_come_and_go);
    return UNITY_END();
}
