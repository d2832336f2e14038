/* Workers receive chunks and tiles in a random order, given by a seed, and work with any settings. The image,
 * the depths and the counts of queries must always be the same. Every draw is blended over earlier ones, so
 * that a wrong order of a bin changes the image. An arena of little more than a block makes chunks fail in
 * the middle of a round. */
#include "render/device/device.h"
#include "emu/emulate/emulate.h"
#include "tests/support/system/seed.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { SIZE = 200, TILES = 16, DRAWS = 7, LARGE = 60, SMALL = 2 * CHUNK_PRIMITIVES + 100 };

struct vertex {
    float position[4];
    uint32_t color;
};

struct result {
    uint32_t image[SIZE * SIZE];
    float depth[SIZE * SIZE];
    uint64_t passed[DRAWS];
};

static triptych_device *device;
static struct result expected, got;

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

static void close_device(void)
{
    device_destroy(device);
    device = NULL;
}

static void open_device(unsigned threads, uint32_t arena_bytes, uint64_t seed)
{
    close_device();
    TEST_ASSERT_EQUAL_INT(
        TRIPTYCH_OK, device_create(&engine_emulate,
                                   &(struct device_options){.threads = threads, .arena_bytes = arena_bytes},
                                   &device, NULL));
    device_shuffle(device, seed);
    OK(triptych_set_target(device, SIZE, SIZE));
    OK(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHABLENDENABLE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_SRCBLEND, 5));
    OK(triptych_set_state(device, TRIPTYCH_STATE_DESTBLEND, 6));
}

void setUp(void)
{
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

/* `count` triangles with corners up to `size` from the first. */
static void draw_triangles(uint32_t *seed, uint32_t count, float size)
{
    struct vertex *vertex = malloc(3 * count * sizeof *vertex);
    TEST_ASSERT_NOT_NULL(vertex);
    for (uint32_t i = 0; i < 3 * count; i++) {
        const float *first = vertex[i - i % 3].position;
        for (int c = 0; c < 3; c++)
            vertex[i].position[c] =
                i % 3 ? first[c] + random_float(seed, -size, size) : random_float(seed, -1, 1);
        vertex[i].position[3] = 1;
        vertex[i].color = next_random(seed) << 8 | next_random(seed);
    }
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, vertex, 3 * count * sizeof *vertex, &buffer));
    free(vertex);
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof *vertex};
    struct triptych_element color = {TRIPTYCH_FORMAT_COLOR, buffer, 16, sizeof *vertex};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &color));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, count));
}

/* Draws a few large triangles and several chunks of small ones in turn, with a clear of depth between
 * them. */
static void draw_scene(struct result *result)
{
    triptych_query *query[DRAWS];
    /* Sanitizers need accesses of each kind, not many pixels. */
    uint32_t seed = 11, side = test_stride() > 1 ? 2 * TILE_SIZE + 8 : SIZE;
    memset(result, 0, sizeof *result);
    OK(triptych_set_target(device, side, side));
    for (int d = 0; d < DRAWS; d++) {
        OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query[d]));
        OK(triptych_query_begin(device, query[d]));
        draw_triangles(&seed, d % 2 ? SMALL : LARGE, d % 2 ? 0.06f : 0.7f);
        OK(triptych_query_end(device, query[d]));
        if (d == 3)
            OK(triptych_clear(device, NULL, 0.6f));
    }
    OK(triptych_read_color(device, result->image, side * side * sizeof *result->image));
    OK(triptych_read_depth(device, result->depth, side * side * sizeof *result->depth));
    for (int d = 0; d < DRAWS; d++)
        OK(triptych_query_result(device, query[d], &result->passed[d]));
}

static void expect_the_same(const char *what)
{
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &got, sizeof got, what);
}

static void any_order_of_tasks_gives_the_same_image(void)
{
    open_device(1, 0, 0);
    draw_scene(&expected);
    TEST_ASSERT_TRUE(expected.passed[0] > SIZE && expected.passed[DRAWS - 1] > SIZE);
    for (unsigned threads = 1; threads <= 3; threads += 2)
        for (uint64_t seed = 1; seed <= test_share(3); seed++) {
            open_device(threads, 0, seed);
            draw_scene(&got);
            expect_the_same("with an arena as large as ever");
        }
}

static void any_order_of_tasks_gives_the_same_image_when_the_arena_fills_up(void)
{
    open_device(1, 0, 0);
    draw_scene(&expected);
    for (unsigned threads = 1; threads <= 3; threads += 2) {
        open_device(threads, ARENA_BLOCK * 5 / 4, 4 + threads);
        draw_scene(&got);
        expect_the_same("with an arena of little more than a block");
        TEST_ASSERT_TRUE(device->queue->statistics.rounds > 3);
    }
}

static void open_with(unsigned threads, uint32_t arena_bytes, unsigned setting, unsigned value)
{
    struct setting_values settings = {{0}};
    settings.of[setting] = (uint8_t)value;
    open_device(threads, arena_bytes, 0);
    device_set_settings(device, &settings);
}

static void every_value_of_every_setting_gives_the_same_image(void)
{
    static const uint32_t arenas[] = {0, ARENA_BLOCK * 5 / 4};
    unsigned number = 0;
    open_device(1, 0, 0);
    draw_scene(&expected);
    for (unsigned setting = 0; setting_name(setting); setting++)
        for (unsigned value = 0; setting_value_name(setting, value); value++) {
            if (number++ % test_stride_of(3))
                continue;
            for (unsigned i = test_stride() - 1; i < 4; i++) {
                open_with(i % 2 ? 3 : 1, arenas[i / 2], setting, value);
                draw_scene(&got);
                expect_the_same(setting_value_name(setting, value));
            }
        }
}

static void stripes_are_rows_of_tiles(void)
{
    open_with(2, 0, SETTING_order, SETTING_order_stripes);
    OK(triptych_clear(device, NULL, 0.6f));
    OK(triptych_finish(device));
    TEST_ASSERT_EQUAL_UINT32(4, device->queue->phase.tasks);
    open_with(2, 0, SETTING_order, SETTING_order_tiles);
    OK(triptych_clear(device, NULL, 0.6f));
    OK(triptych_finish(device));
    TEST_ASSERT_EQUAL_UINT32(TILES, device->queue->phase.tasks);
}

/* Covers the target with one depth and colour, by triangles that are 64 times as large: no edge meets it. */
static void cover(float depth, uint32_t color)
{
    struct vertex vertex[3] = {
        {{-64, -64, depth, 1}, color}, {{-64, 192, depth, 1}, color}, {{192, -64, depth, 1}, color}};
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof *vertex};
    struct triptych_element diffuse = {TRIPTYCH_FORMAT_COLOR, buffer, 16, sizeof *vertex};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &diffuse));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
}

/* The pixels that are shaded where a second triangle covers a first, or is hidden by it. */
static uint64_t count_shaded(unsigned setting, unsigned value, bool hidden)
{
    open_with(1, 0, setting, value);
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHABLENDENABLE, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, hidden));
    OK(triptych_clear(device, NULL, 1));
    cover(0.25f, 0xff336699);
    cover(0.75f, 0xff996633);
    OK(triptych_finish(device));
    return device->queue->statistics.pixels_shaded;
}

/* In the nine whole tiles. Of the others only a part belongs to the target, so nothing covers them. */
static void expect_more(unsigned setting, unsigned on, unsigned off, bool hidden)
{
    TEST_ASSERT_EQUAL_UINT64(count_shaded(setting, on, hidden) + 9 * TILE_SIZE * TILE_SIZE,
                             count_shaded(setting, off, hidden));
}

static void without_ranges_hidden_pixels_are_tested(void)
{
    expect_more(SETTING_range, SETTING_range_on, SETTING_range_off, true);
}

static void without_uniform_tiles_overwritten_pixels_are_shaded(void)
{
    expect_more(SETTING_uniform, SETTING_uniform_on, SETTING_uniform_off, false);
}

/* The pixels that are shaded for a rectangle of one colour. Its diagonal goes through the corners of tiles.
 * */
static uint64_t count_rectangle(unsigned value, struct result *result)
{
    const struct vertex corner[4] = {{{1.28f, 1.28f, 0, 1}, 0xff336699},
                                     {{-1.28f, 1.28f, 0, 1}, 0xff336699},
                                     {{1.28f, -1.28f, 0, 1}, 0xff336699},
                                     {{-1.28f, -1.28f, 0, 1}, 0xff336699}};
    triptych_buffer *buffer;
    open_with(1, 0, SETTING_pairs, value);
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHABLENDENABLE, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_SHADEMODE, 1));
    OK(triptych_clear(device, NULL, 1));
    OK(triptych_buffer_create(device, corner, sizeof corner, &buffer));
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof *corner};
    struct triptych_element diffuse = {TRIPTYCH_FORMAT_COLOR, buffer, 16, sizeof *corner};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &diffuse));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    OK(triptych_finish(device));
    OK(triptych_read_color(device, result->image, sizeof result->image));
    TEST_ASSERT_EQUAL_UINT64(2, device->queue->statistics.triangles_visible);
    return device->queue->statistics.pixels_shaded;
}

/* A rectangle covers the three tiles on its diagonal. A block of each is shaded then. */
static void the_halves_of_a_rectangle_are_drawn_as_one(void)
{
    uint64_t joined = count_rectangle(SETTING_pairs_on, &expected);
    uint64_t apart = count_rectangle(SETTING_pairs_off, &got);
    TEST_ASSERT_EQUAL_UINT64(joined + 3 * (TILE_SIZE * TILE_SIZE - BLOCK_PIXELS), apart);
    TEST_ASSERT_EQUAL_MEMORY(expected.image, got.image, sizeof got.image);
}

static void each_draw_is_a_round_of_its_own_if_drawn_immediately(void)
{
    open_with(1, 0, SETTING_order, SETTING_order_tiles);
    draw_scene(&got);
    uint64_t rounds = device->queue->statistics.rounds;
    open_with(1, 0, SETTING_order, SETTING_order_immediate);
    draw_scene(&got);
    TEST_ASSERT_TRUE(rounds < DRAWS);
    TEST_ASSERT_TRUE(device->queue->statistics.rounds >= DRAWS + 1);
}

static void with_priorities_there_are_two_rounds(void)
{
    open_device(1, 0, 0);
    draw_scene(&expected);
    TEST_ASSERT_NULL(device->queue->second);
    for (uint64_t seed = 0; seed < 4; seed++) {
        open_with(3, seed % 2 ? ARENA_BLOCK * 5 / 4 : 0, SETTING_queue, SETTING_queue_priority);
        device_shuffle(device, seed);
        TEST_ASSERT_NOT_NULL(device->queue->second);
        draw_scene(&got);
        expect_the_same("with rounds that overlap");
        TEST_ASSERT_TRUE(device->queue->second->arena.used > 0);
    }
    device_set_settings(device, &(struct setting_values){{0}});
    TEST_ASSERT_NULL(device->queue->second);
}

static void cover_twice(bool measured)
{
    close_device();
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          device_create(&engine_emulate,
                                        &(struct device_options){.threads = 1, .measure = measured}, &device,
                                        NULL));
    OK(triptych_set_target(device, SIZE, SIZE));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    cover(0.25f, 0);
    cover(0.75f, 0);
    OK(triptych_finish(device));
}

static void a_measured_device_counts_tiles_and_the_triangles_in_them(void)
{
    const struct queue_statistics *counted;
    cover_twice(true);
    counted = &device->queue->statistics;
    TEST_ASSERT_EQUAL_UINT64(TILES, counted->tiles);
    TEST_ASSERT_EQUAL_UINT64(2 * TILES, counted->tile_triangles);
    TEST_ASSERT_EQUAL_UINT64(6, device->counts.vertices);
    TEST_ASSERT_TRUE(counted->geometry_wall_ns > 0 && counted->tiles_wall_ns > 0 &&
                     counted->records_bytes > 0);
    cover_twice(false);
    counted = &device->queue->statistics;
    TEST_ASSERT_TRUE(!counted->tiles && !counted->tile_triangles && !counted->records_bytes);
    TEST_ASSERT_TRUE(!counted->geometry_wall_ns && !counted->tiles_wall_ns);
}

static void late_tests_are_a_key_of_their_own(void)
{
    open_with(1, 0, SETTING_depth, SETTING_depth_late);
    cover(0.25f, 0);
    TEST_ASSERT_EQUAL_INT(1, device->derived.now->key[UNIT_PIXEL].pixel.late);
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    cover(0.25f, 0);
    TEST_ASSERT_EQUAL_INT(0, device->derived.now->key[UNIT_PIXEL].pixel.late);
}

static void settings_are_read_when_the_device_is_made(void)
{
    struct error error = {""};
    close_device();
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(&engine_emulate,
                                                     &(struct device_options){.settings = "geometry=serial"},
                                                     &device, &error));
    TEST_ASSERT_EQUAL_UINT8(SETTING_geometry_serial, device->queue->round.settings.of[SETTING_geometry]);
    close_device();
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          device_create(&engine_emulate,
                                        &(struct device_options){.settings = "geometry=slow"}, &device,
                                        &error));
    TEST_ASSERT_NULL(device);
    TEST_ASSERT_EQUAL_STRING("settings have \"slow\", expected one of: parallel, serial", error.text);
}

static uint8_t order_of_device(const char *settings)
{
    char reason[256];
    close_device();
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        TRIPTYCH_OK,
        triptych_device_create(
            &(struct triptych_options){.engine = "emulate", .threads = 1, .settings = settings}, &device,
            reason, sizeof reason),
        reason);
    return device->queue->round.settings.of[SETTING_order];
}

static void settings_come_from_the_options_or_else_from_the_environment(void)
{
    setenv("TRIPTYCH_SETTINGS", "order=stripes", 1);
    TEST_ASSERT_EQUAL_UINT8(SETTING_order_stripes, order_of_device(NULL));
    TEST_ASSERT_EQUAL_UINT8(SETTING_order_immediate, order_of_device("order=immediate"));
    TEST_ASSERT_EQUAL_UINT8(SETTING_order_tiles, order_of_device(""));
    unsetenv("TRIPTYCH_SETTINGS");
    TEST_ASSERT_EQUAL_UINT8(SETTING_order_tiles, order_of_device(NULL));
}

/* Copies the order in which the last phase processed tiles. */
static void copy_order(uint16_t order[TILES])
{
    static bool seen[TILES];
    memset(seen, 0, sizeof seen);
    for (int i = 0; i < TILES; i++) {
        order[i] = device->queue->phase.order[i];
        TEST_ASSERT_TRUE(order[i] < TILES && !seen[order[i]]);
        seen[order[i]] = true;
    }
}

static void clear_every_tile(void)
{
    OK(triptych_clear(device, NULL, 0.6f));
    OK(triptych_finish(device));
}

static void orders_contain_every_task_once_and_change_with_seed_and_phase(void)
{
    uint16_t first[TILES], second[TILES], again[TILES], in_order[TILES];
    for (int i = 0; i < TILES; i++)
        in_order[i] = (uint16_t)i;
    open_device(2, 0, 7);
    clear_every_tile();
    copy_order(first);
    clear_every_tile();
    copy_order(second);
    open_device(1, 0, 7);
    clear_every_tile();
    copy_order(again);
    TEST_ASSERT_EQUAL_MEMORY(first, again, sizeof first);
    TEST_ASSERT_TRUE(memcmp(first, second, sizeof first) != 0);
    TEST_ASSERT_TRUE(memcmp(first, in_order, sizeof first) != 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(any_order_of_tasks_gives_the_same_image);
    RUN_TEST(any_order_of_tasks_gives_the_same_image_when_the_arena_fills_up);
    RUN_TEST(every_value_of_every_setting_gives_the_same_image);
    RUN_TEST(stripes_are_rows_of_tiles);
    RUN_TEST(without_ranges_hidden_pixels_are_tested);
    RUN_TEST(without_uniform_tiles_overwritten_pixels_are_shaded);
    RUN_TEST(the_halves_of_a_rectangle_are_drawn_as_one);
    RUN_TEST(each_draw_is_a_round_of_its_own_if_drawn_immediately);
    RUN_TEST(with_priorities_there_are_two_rounds);
    RUN_TEST(a_measured_device_counts_tiles_and_the_triangles_in_them);
    RUN_TEST(late_tests_are_a_key_of_their_own);
    RUN_TEST(settings_are_read_when_the_device_is_made);
    RUN_TEST(settings_come_from_the_options_or_else_from_the_environment);
    RUN_TEST(orders_contain_every_task_once_and_change_with_seed_and_phase);
    return UNITY_END();
}
