/* The renderer as a whole, through the public interface, with the emulator: what is drawn, in what order, by
 * any number of threads, in bounded memory; and what is refused. */
#include "draw/device.h"

#include "emu/emulate.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unity.h>

enum { SIZE = 200 };

static triptych_device *device;
static uint32_t image[SIZE * SIZE];
static float depth[SIZE * SIZE];

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

static void open_engine(const struct engine *engine, const struct device_options *options)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(engine, options, &device, NULL));
    OK(triptych_set_target(device, SIZE, SIZE));
    OK(triptych_set_state(device, TRIPTYCH_STATE_lighting, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_cullmode, 1));
}

static void open_device_with(const struct device_options *options)
{
    open_engine(&engine_emulate, options);
}

static void open_device(unsigned threads)
{
    open_device_with(&(struct device_options){.threads = threads});
}

static void close_device(void)
{
    triptych_device_destroy(device);
    device = NULL;
}

void setUp(void)
{
    open_device(1);
}

void tearDown(void)
{
    close_device();
}

struct vertex {
    float position[4]; /* clip space: the transforms are identities */
    uint32_t color;    /* 0xAARRGGBB */
};

/* Window pixels to clip space with w = 1. */
static struct vertex at(float x, float y, float z, uint32_t color)
{
    return (struct vertex){{2 * x / SIZE - 1, 1 - 2 * y / SIZE, z, 1}, color};
}

static triptych_buffer *buffer_of(const void *data, size_t bytes)
{
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, data, bytes, &buffer));
    return buffer;
}

static void bind(triptych_buffer *buffer)
{
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof(struct vertex)};
    struct triptych_element color = {TRIPTYCH_FORMAT_COLOR, buffer, 16, sizeof(struct vertex)};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &color));
}

static void draw_list(const struct vertex *vertex, uint32_t triangles)
{
    bind(buffer_of(vertex, 3 * triangles * sizeof *vertex));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, triangles));
}

/* The pixels x0 <= x < x1, y0 <= y < y1 as two triangles. */
static void draw_rectangle(float x0, float y0, float x1, float y1, float z, uint32_t color)
{
    struct vertex vertex[6] = {at(x0, y0, z, color), at(x1, y0, z, color), at(x0, y1, z, color),
                               at(x1, y0, z, color), at(x1, y1, z, color), at(x0, y1, z, color)};
    draw_list(vertex, 2);
}

static uint32_t pixel(int x, int y)
{
    return image[y * SIZE + x];
}

static void read_image(void)
{
    OK(triptych_read_color(device, image));
    OK(triptych_read_depth(device, depth));
}

static uint32_t count_color(uint32_t color)
{
    uint32_t count = 0;
    for (int i = 0; i < SIZE * SIZE; i++)
        count += image[i] == color;
    return count;
}

enum {
    RED = 0xff0000ff,
    GREEN = 0xff00ff00,
    BLUE = 0xffff0000,
    RED_ARGB = 0xffff0000,
    GREEN_ARGB = 0xff00ff00
};

/* --- What is drawn ----------------------------------------------------------------------------------------
 */

static void a_new_target_is_zero_and_as_far_as_possible(void)
{
    read_image();
    for (int i = 0; i < SIZE * SIZE; i++) {
        TEST_ASSERT_EQUAL_HEX32(0, image[i]);
        TEST_ASSERT_EQUAL_FLOAT(1, depth[i]);
    }
}

static void a_rectangle_has_exactly_its_pixels(void)
{
    draw_rectangle(3, 5, 130, 77, 0.25f, RED_ARGB);
    read_image();
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            int inside = x >= 3 && x < 130 && y >= 5 && y < 77;
            TEST_ASSERT_EQUAL_HEX32(inside ? RED : 0, pixel(x, y));
            TEST_ASSERT_EQUAL_FLOAT(inside ? 0.25f : 1, depth[y * SIZE + x]);
        }
    struct triptych_statistics statistics;
    triptych_get_statistics(device, &statistics);
    TEST_ASSERT_EQUAL_UINT64(127 * 72, statistics.pixels_shaded);
}

/* The lower left half of a square: pixels whose centre is under the diagonal; of those on it, a left edge's
 * are in. */
static void a_triangle_covers_half_of_its_square(void)
{
    struct vertex vertex[3] = {at(0, 0, 0, RED_ARGB), at(100, 100, 0, RED_ARGB), at(0, 100, 0, RED_ARGB)};
    draw_list(vertex, 1);
    read_image();
    uint32_t under = 100 * 99 / 2, red = count_color(RED);
    TEST_ASSERT_TRUE(red == under || red == under + 100);
}

static void a_gradient_has_the_right_value_at_every_pixel(void)
{
    struct vertex vertex[6] = {at(0, 0, 0, 0xff000000),     at(200, 0, 0, 0xffff0000),
                               at(0, 200, 1, 0xff0000ff),   at(200, 0, 0, 0xffff0000),
                               at(200, 200, 1, 0xffff00ff), at(0, 200, 1, 0xff0000ff)};
    draw_list(vertex, 2);
    read_image();
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            TEST_ASSERT_INT_WITHIN(1, (int)lrint((x + .5) * 255 / SIZE), pixel(x, y) & 255);
            TEST_ASSERT_INT_WITHIN(1, (int)lrint((y + .5) * 255 / SIZE), pixel(x, y) >> 16 & 255);
            TEST_ASSERT_FLOAT_WITHIN(1e-6f, (y + .5f) / SIZE, depth[y * SIZE + x]);
        }
}

/* Colour over w and 1/w are linear on the screen: halfway between w = 1 and w = 3 lies a quarter of the way.
 */
static void interpolation_is_perspective_correct(void)
{
    struct vertex vertex[6] = {at(0, 0, 0, 0xff000000),     at(200, 0, 0, 0xffff0000),
                               at(0, 200, 0, 0xff000000),   at(200, 0, 0, 0xffff0000),
                               at(200, 200, 0, 0xffff0000), at(0, 200, 0, 0xff000000)};
    for (int i = 0; i < 6; i++)
        if (vertex[i].color == 0xffff0000)
            for (int c = 0; c < 4; c++)
                vertex[i].position[c] *= 3;
    draw_list(vertex, 2);
    read_image();
    for (int x = 0; x < SIZE; x++) {
        double s = (x + .5) / SIZE, expected = s / 3 / ((1 - s) + s / 3);
        TEST_ASSERT_INT_WITHIN(1, (int)lrint(expected * 255), pixel(x, 90) & 255);
    }
}

static void depth_decides_whatever_the_order(void)
{
    draw_rectangle(0, 0, 100, 100, 0.3f, RED_ARGB);
    draw_rectangle(50, 50, 150, 150, 0.6f, GREEN_ARGB);
    draw_rectangle(0, 0, 200, 200, 0.9f, 0xff0000ff);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(10000, count_color(RED));
    TEST_ASSERT_EQUAL_UINT32(7500, count_color(GREEN));
    TEST_ASSERT_EQUAL_UINT32(22500, count_color(BLUE));
}

static void later_draws_cover_earlier_ones(void)
{
    OK(triptych_set_state(device, TRIPTYCH_STATE_zenable, 0));
    for (int i = 0; i < 100; i++)
        draw_rectangle(10, 10, 90, 90, 0.5f, 0xff000000 | (uint32_t)i);
    draw_rectangle(10, 10, 90, 90, 0.5f, RED_ARGB);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(6400, count_color(RED));
}

static void strips_fans_and_indices_draw_the_same_square(void)
{
    static const uint16_t list[] = {9, 0, 1, 2, 1, 3, 2};
    static const uint32_t fan[] = {1000, 1001, 1003, 1002};
    struct vertex v[4] = {at(20, 20, 0, RED_ARGB), at(90, 20, 0, RED_ARGB), at(20, 90, 0, RED_ARGB),
                          at(90, 90, 0, RED_ARGB)};
    uint32_t expected[SIZE * SIZE];
    OK(triptych_set_state(device, TRIPTYCH_STATE_cullmode, 3));
    bind(buffer_of(v, sizeof v));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    read_image();
    TEST_ASSERT_EQUAL_UINT32(4900, count_color(RED));
    memcpy(expected, image, sizeof expected);
    for (int i = 0; i < 2; i++) {
        OK(triptych_clear(device, (float[4]){0, 0, 0, 0}, 1));
        if (i == 0) {
            OK(triptych_set_indices(device, buffer_of(list, sizeof list), 16));
            OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 1, 2));
        } else {
            OK(triptych_set_indices(device, buffer_of(fan, sizeof fan), 32));
            OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_FAN, -1000, 0, 2));
        }
        read_image();
        TEST_ASSERT_EQUAL_MEMORY(expected, image, sizeof image);
    }
}

static void flat_shading_takes_the_first_vertex(void)
{
    struct vertex v[5] = {at(0, 0, 0, 0xff000001), at(100, 0, 0, 0xff000002), at(0, 100, 0, 0xff000003),
                          at(100, 100, 0, 0xff000004), at(0, 200, 0, 0xff000005)};
    OK(triptych_set_state(device, TRIPTYCH_STATE_shademode, 1));
    bind(buffer_of(v, sizeof v));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 3));
    read_image();
    TEST_ASSERT_EQUAL_HEX32(0xff010000, pixel(10, 10));
    TEST_ASSERT_EQUAL_HEX32(0xff020000, pixel(90, 90));
    TEST_ASSERT_EQUAL_HEX32(0xff030000, pixel(10, 150));
}

static void clipping_at_the_eye_leaves_no_hole(void)
{
    struct vertex v[3] = {
        {{-9, -9, .5f, 1}, RED_ARGB}, {{0, 30, .5f, -1}, RED_ARGB}, {{9, -9, .5f, 1}, RED_ARGB}};
    OK(triptych_set_state(device, TRIPTYCH_STATE_zenable, 0));
    draw_list(v, 1);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(SIZE * SIZE, count_color(RED));
}

static void culling_goes_by_the_winding_on_the_screen(void)
{
    static const uint32_t visible[4] = {0, 6400, 0, 6400};
    struct vertex clockwise[6] = {at(10, 10, 0, RED_ARGB), at(90, 10, 0, RED_ARGB), at(10, 90, 0, RED_ARGB),
                                  at(90, 10, 0, RED_ARGB), at(90, 90, 0, RED_ARGB), at(10, 90, 0, RED_ARGB)};
    for (uint32_t mode = 1; mode <= 3; mode++) {
        OK(triptych_clear(device, (float[4]){0, 0, 0, 0}, 1));
        OK(triptych_set_state(device, TRIPTYCH_STATE_cullmode, mode));
        draw_list(clockwise, 2);
        read_image();
        TEST_ASSERT_EQUAL_UINT32(visible[mode], count_color(RED));
    }
}

/* --- Clears and the viewport ------------------------------------------------------------------------------
 */

static void clears_come_in_their_turn_and_stay_in_the_viewport(void)
{
    draw_rectangle(0, 0, 200, 200, 0.5f, RED_ARGB);
    OK(triptych_set_viewport(device, &(struct triptych_viewport){30, 40, 100, 64, 0, 1}));
    OK(triptych_clear(device, (float[4]){0, 1, 0, 1}, 0.75f));
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, 64, 64, 0, 1}));
    OK(triptych_clear(device, (float[4]){0, 0, 1, 1}, -1));
    OK(triptych_clear(device, NULL, 0.25f));
    read_image();
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            int green = x >= 30 && x < 130 && y >= 40 && y < 104, blue = x < 64 && y < 64;
            TEST_ASSERT_EQUAL_HEX32(blue ? BLUE : green ? GREEN : RED, pixel(x, y));
            TEST_ASSERT_EQUAL_FLOAT(blue ? 0.25f : green ? 0.75f : 0.5f, depth[y * SIZE + x]);
        }
}

static void clear_colours_round_as_the_pipelines(void)
{
    OK(triptych_clear(device, (float[4]){0.5f, -3, 7, 1.0f / 255}, 1e-42f));
    read_image();
    TEST_ASSERT_EQUAL_HEX32(0x01ff0080, pixel(7, 9));
    TEST_ASSERT_EQUAL_FLOAT(0, depth[0]);
}

static void nothing_is_drawn_outside_the_viewport(void)
{
    OK(triptych_set_viewport(device, &(struct triptych_viewport){33, 21, 70, 90, 0, 1}));
    struct vertex v[3] = {
        {{-50, -50, 0, 1}, RED_ARGB}, {{0, 90, 0, 1}, RED_ARGB}, {{50, -50, 0, 1}, RED_ARGB}};
    draw_list(v, 1);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(70 * 90, count_color(RED));
    TEST_ASSERT_EQUAL_HEX32(RED, pixel(33, 21));
    TEST_ASSERT_EQUAL_HEX32(RED, pixel(102, 110));
}

static void a_new_target_forgets_the_old_one(void)
{
    draw_rectangle(0, 0, 200, 200, 0.5f, RED_ARGB);
    OK(triptych_set_target(device, 1, 1));
    uint32_t one = 7;
    OK(triptych_read_color(device, &one));
    TEST_ASSERT_EQUAL_HEX32(0, one);
    unsigned width, height;
    triptych_target_size(device, &width, &height);
    TEST_ASSERT_TRUE(width == 1 && height == 1);
}

/* --- Snapshots --------------------------------------------------------------------------------------------
 */

static void later_changes_do_not_reach_a_recorded_draw(void)
{
    static const float far_away[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {9, 9, 0, 1}};
    draw_rectangle(10, 10, 90, 90, 0.5f, RED_ARGB);
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_WORLD, far_away));
    OK(triptych_set_state(device, TRIPTYCH_STATE_colorwriteenable, 0));
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, 20, 20, 0, 1}));
    struct triptych_element none = {.format = TRIPTYCH_FORMAT_NONE};
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &none));
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &none));
    read_image();
    TEST_ASSERT_EQUAL_UINT32(6400, count_color(RED));
}

/* --- Threads ----------------------------------------------------------------------------------------------
 */

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
    OK(triptych_set_state(device, TRIPTYCH_STATE_alphablendenable, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_srcblend, 5));
    OK(triptych_set_state(device, TRIPTYCH_STATE_destblend, 6));
    for (int d = 0; d < 30; d++) {
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

/* Whether everything is rendered at once or each draw on its own makes no difference. */
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

/* An arena of little more than one block: threads take it from one another, and the scene takes many rounds.
 */
static void the_image_does_not_depend_on_the_size_of_the_arena(void)
{
    static uint32_t first_image[SIZE * SIZE];
    draw_scene(false);
    read_image();
    memcpy(first_image, image, sizeof image);
    for (unsigned threads = 1; threads <= 4; threads++)
        for (int repeat = 0; repeat < 5; repeat++) {
            close_device();
            open_device_with(
                &(struct device_options){.threads = threads, .arena_bytes = ARENA_BLOCK * 5 / 4});
            draw_scene(false);
            read_image();
            TEST_ASSERT_EQUAL_MEMORY(first_image, image, sizeof image);
            TEST_ASSERT_TRUE(device->frame->statistics.rounds > 3);
        }
}

/* The emulator, except that the batch with vertex 0, the first time, takes as long as another chunk to fill the
 * arena; ten seconds are enough for that on any machine. */
static routine_function *emulate_vertices;
static bool lingered;

static void linger_over_vertex_0(const void *arguments, const struct routine *routine)
{
    bool lingers = ((const struct vertex_call *)arguments)->index[0] == 0 && !lingered;
    if (lingers)
        lingered = true;
    for (int i = 0; lingers && i < 10000 && device->frame->first_stopped == UINT32_MAX; i++)
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    emulate_vertices(arguments, routine);
}

static struct routine *build_lingering(struct code_arena *arena, enum unit unit, const union key *key,
                                       struct error *error)
{
    struct routine *routine = engine_emulate.build(arena, unit, key, error);
    if (routine && unit == UNIT_VERTEX) {
        emulate_vertices = routine->run;
        routine->run = linger_over_vertex_0;
    }
    return routine;
}

/* One thread lingers over the first chunk while the other takes the whole arena for the second. */
static void a_chunk_that_others_starved_is_rendered_alone(void)
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
    OK(triptych_set_state(device, TRIPTYCH_STATE_zfunc, 8));
    draw_list(vertex, TRIANGLES);
    free(vertex);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(28, count_color(RED)); /* 36 less the 8 centres on the diagonal */
    TEST_ASSERT_TRUE(device->frame->statistics.starved_rounds > 0);
    TEST_ASSERT_EQUAL_UINT64(TRIANGLES, device->frame->statistics.triangles_visible);
    TEST_ASSERT_EQUAL_UINT64(28 * TRIANGLES, device->frame->statistics.pixels_shaded);
}

static int refuse_thread(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                         void *argument)
{
    (void)thread, (void)attributes, (void)run, (void)argument;
    return EAGAIN;
}

static void without_more_threads_the_caller_renders_alone(void)
{
    close_device();
    open_device_with(&(struct device_options){.threads = 8, .create_thread = refuse_thread});
    TEST_ASSERT_EQUAL_UINT32(1, pool_workers(device->pool));
    draw_rectangle(10, 10, 90, 90, 0.5f, RED_ARGB);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(6400, count_color(RED));
}

/* --- Bounds -----------------------------------------------------------------------------------------------
 */

static size_t resident_peak(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (size_t)usage.ru_maxrss * 1024;
}

/* One draw that takes more than the arena; its last triangle is the one that stays on top. */
static void one_huge_draw_is_rendered_in_rounds(void)
{
    enum { TRIANGLES = 700000 };
    static const struct triptych_viewport corner = {0, 0, 1, 1, 0, 1};
    uint32_t *index = malloc(TRIANGLES * 3 * sizeof *index);
    TEST_ASSERT_NOT_NULL(index);
    for (uint32_t i = 0; i < TRIANGLES * 3; i++)
        index[i] = i % 3 + (i < TRIANGLES * 3 - 3 ? 0 : 3);
    struct vertex v[6] = {{{-1, 1, 0, 1}, GREEN_ARGB},  {{3, 1, 0, 1}, GREEN_ARGB},
                          {{-1, -3, 0, 1}, GREEN_ARGB}, {{-1, 1, 0, 1}, RED_ARGB},
                          {{3, 1, 0, 1}, RED_ARGB},     {{-1, -3, 0, 1}, RED_ARGB}};
    close_device();
    open_device(2);
    OK(triptych_set_viewport(device, &corner));
    OK(triptych_set_state(device, TRIPTYCH_STATE_zenable, 0));
    bind(buffer_of(v, sizeof v));
    OK(triptych_set_indices(device, buffer_of(index, TRIANGLES * 3 * sizeof *index), 32));
    free(index);
    size_t before = resident_peak();
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, TRIANGLES));
    read_image();
    TEST_ASSERT_EQUAL_UINT32(1, count_color(RED));
    TEST_ASSERT_TRUE(device->frame->statistics.rounds > 1);
    TEST_ASSERT_TRUE(resident_peak() - before < (size_t)ARENA_BYTES + (16 << 20));
    struct triptych_statistics statistics;
    triptych_get_statistics(device, &statistics);
    TEST_ASSERT_EQUAL_UINT64(TRIANGLES, statistics.triangles_set_up);
    TEST_ASSERT_EQUAL_UINT64(TRIANGLES, statistics.pixels_shaded);
}

static void more_draws_than_the_queue_holds_are_all_drawn(void)
{
    struct vertex v[3] = {
        {{-1, 1, 0, 1}, 0x01010101}, {{3, 1, 0, 1}, 0x01010101}, {{-1, -3, 0, 1}, 0x01010101}};
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, 1, 1, 0, 1}));
    OK(triptych_set_state(device, TRIPTYCH_STATE_zenable, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_shademode, 1));
    bind(buffer_of(v, sizeof v));
    for (int i = 0; i < FRAME_COMMANDS + 100; i++)
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    OK(triptych_finish(device));
    struct triptych_statistics statistics;
    triptych_get_statistics(device, &statistics);
    TEST_ASSERT_EQUAL_UINT64(FRAME_COMMANDS + 100, statistics.draws);
    TEST_ASSERT_EQUAL_UINT64(FRAME_COMMANDS + 100, statistics.pixels_shaded);
    TEST_ASSERT_EQUAL_UINT64(3, statistics.cache_misses);
}

/* --- Refusals ---------------------------------------------------------------------------------------------
 */

static void expect_refused(enum triptych_result expected, enum triptych_result got, const char *reason)
{
    TEST_ASSERT_EQUAL_STRING(reason, triptych_error(device));
    TEST_ASSERT_EQUAL_INT(expected, got);
}

static void targets_have_a_largest_size(void)
{
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_target(device, 65536, 32768),
                   "target of 65536x32768 pixels: expected 1 to 8192 a side");
    unsigned width, height;
    triptych_target_size(device, &width, &height);
    TEST_ASSERT_EQUAL_UINT32(SIZE, width);
}

static void draws_need_a_target_a_position_and_indices(void)
{
    struct device_options options = {.threads = 1};
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1),
                   "no position: expected an element for it");
    draw_rectangle(0, 0, 1, 1, 0, 0);
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1),
                   "no indices: expected set_indices first");
    close_device();
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(&engine_emulate, &options, &device, NULL));
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1),
                   "no target: expected set_target first");
    expect_refused(TRIPTYCH_BAD_CALL, triptych_read_color(device, image),
                   "no target: expected set_target first");
    expect_refused(TRIPTYCH_BAD_CALL, triptych_clear(device, NULL, 1),
                   "no target: expected set_target first");
}

static void vertices_must_lie_in_their_buffers(void)
{
    struct vertex v[3] = {{{0}, 0}};
    static const uint16_t index[] = {0, 1, 2, 3, 1, 0};
    bind(buffer_of(v, sizeof v));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 1, 1),
                   "vertex 3: position lies past its buffer, which ends with vertex 2");
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, UINT32_MAX, 2),
                   "vertices 4294967295 to 4294967300: expected them below 2^32");
    OK(triptych_set_indices(device, buffer_of(index, sizeof index), 16));
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1));
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 2),
                   "vertex 3: position lies past its buffer, which ends with vertex 2");
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, -1, 0, 1),
                   "vertices -1 to 1: expected them from 0 to 2^32 - 1");
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 3, 2),
                   "indices 3 to 6: expected them in the buffer of 6 indices");
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, -1, 3, 0));
}

/* An attribute that this draw does not read may be anything. */
static void attributes_that_are_not_read_are_not_checked(void)
{
    float normal[3] = {0, 0, 1};
    struct triptych_element element = {TRIPTYCH_FORMAT_FLOAT3, buffer_of(normal, sizeof normal), 0, 12};
    OK(triptych_set_element(device, TRIPTYCH_NORMAL, &element));
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    OK(triptych_set_state(device, TRIPTYCH_STATE_lighting, 1));
    OK(triptych_enable_light(device, 0, 1));
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 2),
                   "vertex 5: normal lies past its buffer, which ends with vertex 0");
}

static void null_arguments_are_refused(void)
{
    triptych_buffer *buffer;
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_buffer_create(device, NULL, 4, &buffer), "data is null");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_read_color(device, NULL), "image is null");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_material(device, NULL), "material is null");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_buffer_create(device, image, 0, &buffer),
                   "buffer of 0 bytes: expected 1 to 2^31 - 1");
    TEST_ASSERT_NULL(buffer);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_finish(NULL));
    triptych_target_size(device, NULL, NULL);
    triptych_get_statistics(device, NULL);
    TEST_ASSERT_EQUAL_INT(0, triptych_get_routine(device, 0, NULL));
    triptych_device_destroy(NULL);
}

static void clear_values_are_checked(void)
{
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_clear(device, NULL, 1.5f),
                   "clear depth 1.5: expected 0 to 1");
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_clear(device, NULL, NAN));
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_clear(device, (float[4]){0, NAN, 0, 0}, 0),
                   "clear colour 1 is nan, expected a finite number");
}

static void engines_are_chosen_by_name(void)
{
    struct triptych_options options = {.engine = "voodoo"};
    triptych_device *other;
    char reason[100];
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_device_create(&options, &other, reason, sizeof reason));
    TEST_ASSERT_NULL(other);
    TEST_ASSERT_EQUAL_STRING("engine voodoo: there is none of that name", reason);
    options = (struct triptych_options){.engine = "emulate", .cache_bytes = (size_t)1 << 40};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_device_create(&options, &other, reason, sizeof reason));
    TEST_ASSERT_EQUAL_STRING("cache of 1099511627776 bytes: expected at most 1073741824", reason);
    TEST_ASSERT_EQUAL_STRING("emulate", triptych_engine_name(0));
    TEST_ASSERT_EQUAL_UINT32(4, triptych_engine_width(0));
    TEST_ASSERT_NULL(triptych_engine_unavailable(0));
    TEST_ASSERT_NULL(triptych_engine_name(1000));
}

/* --- Hooks and reports ------------------------------------------------------------------------------------
 */

static uint64_t heard;
static union key heard_key[UNIT_COUNT];

static void hear(void *user, uint64_t number, const union key key[UNIT_COUNT])
{
    TEST_ASSERT_EQUAL_PTR(&heard, user);
    TEST_ASSERT_EQUAL_UINT64(heard, number);
    heard++;
    memcpy(heard_key, key, sizeof heard_key);
}

static void tools_hear_of_each_draw_and_its_keys(void)
{
    heard = 0;
    device_on_draw(device, hear, &heard);
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    OK(triptych_set_state(device, TRIPTYCH_STATE_zenable, 0));
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    TEST_ASSERT_EQUAL_UINT64(2, heard);
    TEST_ASSERT_EQUAL_INT(COMPARE_ALWAYS, heard_key[UNIT_PIXEL].pixel.depth_function);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_COLOR, heard_key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_DIFFUSE]);
    TEST_ASSERT_EQUAL_PTR(&engine_emulate, device_engine(device));
    TEST_ASSERT_NULL(device_arena(device));
}

static void routines_report_their_identity(void)
{
    struct triptych_routine_info info;
    TEST_ASSERT_EQUAL_INT(0, triptych_get_routine(device, 0, &info));
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    TEST_ASSERT_EQUAL_INT(1, triptych_get_routine(device, 2, &info));
    TEST_ASSERT_EQUAL_UINT32(3, info.number);
    TEST_ASSERT_EQUAL_STRING("pixel", info.unit);
    TEST_ASSERT_EQUAL_STRING("depth_function=3 depth_write=1 varying=1 write_mask=15", info.key);
    TEST_ASSERT_EQUAL_UINT64(1, info.hits);
    TEST_ASSERT_EQUAL_INT(0, triptych_get_routine(device, 3, &info));
}

/* Twice 10 x 10 pixels, two triangles and four vertices. */
static void calls_are_measured_where_asked_for(void)
{
    struct triptych_routine_info info;
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    read_image();
    TEST_ASSERT_EQUAL_INT(1, triptych_get_routine(device, 2, &info));
    TEST_ASSERT_EQUAL_UINT64(0, info.run_ns + info.elements);
    close_device();
    open_device_with(&(struct device_options){.threads = 1, .measure = true});
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    read_image();
    TEST_ASSERT_EQUAL_INT(1, triptych_get_routine(device, 2, &info));
    TEST_ASSERT_EQUAL_UINT64(200, info.elements);
    TEST_ASSERT_GREATER_THAN_UINT64(0, info.run_ns);
    TEST_ASSERT_EQUAL_INT(1, triptych_get_routine(device, 1, &info));
    TEST_ASSERT_EQUAL_UINT64(4, info.elements);
}

static void draws_without_effect_build_nothing(void)
{
    OK(triptych_set_state(device, TRIPTYCH_STATE_zfunc, 1));
    draw_rectangle(0, 0, 100, 100, 0.5f, RED_ARGB);
    struct triptych_routine_info info;
    TEST_ASSERT_EQUAL_INT(0, triptych_get_routine(device, 0, &info));
    read_image();
    TEST_ASSERT_EQUAL_UINT32(0, count_color(RED));
}

static void states_are_set_by_table(void)
{
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_addressv, 3));
    OK(triptych_set_stage_state(device, 0, TRIPTYCH_STAGE_colorop, 7));
    OK(triptych_set_state(device, TRIPTYCH_STATE_fogend, triptych_float_bits(1)));
    TEST_ASSERT_EQUAL_UINT32(3, device->state.sampler[0][TRIPTYCH_SAMPLER_addressv]);
    TEST_ASSERT_EQUAL_UINT32(7, device->state.stage[0][TRIPTYCH_STAGE_colorop]);
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_addressv, 6),
                   "sampler 0 addressv: value 6 does not exist, expected wrap (1), mirror (2), clamp (3), "
                   "border (4), mirroronce (5)");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_stage_state(device, 8, TRIPTYCH_STAGE_colorop, 1),
                   "stage 8: expected 0 to 7");
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_set_sampler_state(NULL, 0, TRIPTYCH_SAMPLER_addressv, 3));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_set_stage_state(NULL, 0, TRIPTYCH_STAGE_colorop, 1));
    TEST_ASSERT_EQUAL_UINT32(3, device->state.sampler[0][TRIPTYCH_SAMPLER_addressv]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_new_target_is_zero_and_as_far_as_possible);
    RUN_TEST(a_rectangle_has_exactly_its_pixels);
    RUN_TEST(a_triangle_covers_half_of_its_square);
    RUN_TEST(a_gradient_has_the_right_value_at_every_pixel);
    RUN_TEST(interpolation_is_perspective_correct);
    RUN_TEST(depth_decides_whatever_the_order);
    RUN_TEST(later_draws_cover_earlier_ones);
    RUN_TEST(strips_fans_and_indices_draw_the_same_square);
    RUN_TEST(flat_shading_takes_the_first_vertex);
    RUN_TEST(clipping_at_the_eye_leaves_no_hole);
    RUN_TEST(culling_goes_by_the_winding_on_the_screen);
    RUN_TEST(clears_come_in_their_turn_and_stay_in_the_viewport);
    RUN_TEST(clear_colours_round_as_the_pipelines);
    RUN_TEST(nothing_is_drawn_outside_the_viewport);
    RUN_TEST(a_new_target_forgets_the_old_one);
    RUN_TEST(later_changes_do_not_reach_a_recorded_draw);
    RUN_TEST(the_image_does_not_depend_on_the_number_of_threads);
    RUN_TEST(the_image_does_not_depend_on_when_it_is_rendered);
    RUN_TEST(the_image_does_not_depend_on_the_size_of_the_arena);
    RUN_TEST(a_chunk_that_others_starved_is_rendered_alone);
    RUN_TEST(without_more_threads_the_caller_renders_alone);
    RUN_TEST(one_huge_draw_is_rendered_in_rounds);
    RUN_TEST(more_draws_than_the_queue_holds_are_all_drawn);
    RUN_TEST(targets_have_a_largest_size);
    RUN_TEST(draws_need_a_target_a_position_and_indices);
    RUN_TEST(vertices_must_lie_in_their_buffers);
    RUN_TEST(attributes_that_are_not_read_are_not_checked);
    RUN_TEST(null_arguments_are_refused);
    RUN_TEST(clear_values_are_checked);
    RUN_TEST(engines_are_chosen_by_name);
    RUN_TEST(tools_hear_of_each_draw_and_its_keys);
    RUN_TEST(routines_report_their_identity);
    RUN_TEST(calls_are_measured_where_asked_for);
    RUN_TEST(draws_without_effect_build_nothing);
    RUN_TEST(states_are_set_by_table);
    return UNITY_END();
}
