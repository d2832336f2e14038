/* If the arena for code is full, routines are evicted. Draws never fail for this reason, whatever the sizes
 * of routines, and routines in use are not evicted. */
#include "machine/code.h"
#include "render/device/device.h"
#include "engines/list.h"
#include "tests/support/picture/varied.h"
#include "tests/support/system/tried.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

/* --- The cache over an arena, with an engine whose routines have random sizes --- */

enum { ARENA = 1 << 20, SMALLEST = 100, LARGEST = ARENA / 5 };

static struct code_arena *arena;
static struct cache *cache;
static struct error error;
static uint32_t random_state;
static uint32_t next_bytes; /* the size of the next routine */

static uint32_t random_below(uint32_t limit)
{
    random_state = random_state * 1664525 + 1013904223;
    return (uint32_t)((uint64_t)random_state * limit >> 32);
}

/* Returns a random size whose logarithm is uniformly distributed. */
static uint32_t random_bytes(void)
{
    uint32_t bytes = SMALLEST << random_below(11);
    return bytes + random_below(bytes < LARGEST - bytes ? bytes : LARGEST - bytes);
}

static uint8_t pattern(const union key *key)
{
    return (uint8_t)(key->pixel.write_mask[0] * 31 + key->pixel.write_mask[1]);
}

static struct routine *build(const struct engine *self, struct code_arena *where, enum unit unit,
                             const union key *key, struct error *reason)
{
    struct code_span span;
    struct routine *routine = calloc(1, sizeof *routine);
    TEST_ASSERT_NOT_NULL(routine);
    if (code_reserve(where, next_bytes, &span, reason)) {
        free(routine);
        return NULL;
    }
    memset(span.writable, pattern(key), next_bytes);
    routine->engine = self;
    routine->unit = unit;
    routine->key = *key;
    routine->code = code_commit(where, &span, next_bytes);
    routine->code_bytes = next_bytes;
    return routine;
}

static void free_routine(struct code_arena *where, struct routine *routine)
{
    struct code_span span = {code_writable(where, routine->code), routine->code, routine->code_bytes};
    code_free(where, &span);
    free(routine);
}

static const struct engine sized = {
    .name = "sized", .description = "sizes", .width = 8, .build = build, .free = free_routine};

static void start(size_t budget)
{
    arena = code_create(ARENA, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    cache = cache_create(&sized, arena, budget, &error);
    TEST_ASSERT_NOT_NULL(cache);
}

void setUp(void)
{
    random_state = 1;
    error_clear(&error);
}

void tearDown(void)
{
    cache_destroy(cache);
    code_destroy(arena);
    cache = NULL;
    arena = NULL;
}

/* Acquires a routine with a key that was not used in a long time. */
static const struct routine *acquire_new(uint32_t bytes)
{
    static uint32_t number;
    union key key;
    memset(&key, 0, sizeof key);
    number++;
    for (int i = 0; i < TARGETS; i++)
        key.pixel.write_mask[i] = number >> 4 * i & 15;
    for (int i = 0; i < PIXEL_SAMPLERS && i < 16; i++)
        key.pixel.texture[i] = number >> (16 + i % 2) & 1;
    next_bytes = bytes;
    return cache_acquire(cache, UNIT_PIXEL, &key, &error);
}

static void check_code(const struct routine *routine)
{
    const uint8_t *code = routine->code, expected = pattern(&routine->key);
    for (uint32_t i = 0; i < routine->code_bytes; i++)
        if (code[i] != expected)
            TEST_FAIL_MESSAGE("a routine in use was overwritten");
}

static void random_sizes_never_fail_however_long(void)
{
    enum { HELD = 2 };
    const unsigned routines = test_share_of(50000, 20);
    const struct routine *held[HELD] = {NULL};
    start((size_t)1 << 30);
    for (unsigned i = 0; i < routines; i++) {
        int n = (int)random_below(HELD);
        if (held[n]) {
            check_code(held[n]);
            cache_release(cache, held[n]);
        }
        held[n] = acquire_new(random_bytes());
        TEST_ASSERT_NOT_NULL_MESSAGE(held[n], error.text);
    }
    for (int n = 0; n < HELD; n++)
        cache_release(cache, held[n]);
    TEST_ASSERT_TRUE(cache_statistics(cache).evictions > routines / 2);
}

/* The worst case of a draw: two of its routines have the largest size and are anywhere in the arena. The
 * third routine still finds a hole. */
static void two_of_the_largest_leave_room_for_a_third_wherever_they_are(void)
{
    start((size_t)1 << 30);
    for (unsigned i = 0; i < test_share_of(2000, 20); i++) {
        const struct routine *draw[UNIT_COUNT];
        for (int other = 0; other < 5; other++)
            cache_release(cache, acquire_new(random_bytes()));
        for (int unit = 0; unit < UNIT_COUNT; unit++) {
            draw[unit] = acquire_new(LARGEST);
            TEST_ASSERT_NOT_NULL_MESSAGE(draw[unit], error.text);
        }
        for (int unit = 0; unit < UNIT_COUNT; unit++) {
            check_code(draw[unit]);
            cache_release(cache, draw[unit]);
        }
    }
}

/* Only the necessary number of routines is evicted. The most recently used routines stay. */
static void a_full_arena_loses_the_oldest_only(void)
{
    enum { BYTES = ARENA / 64 };
    start((size_t)1 << 30);
    for (int i = 0; i < 64; i++)
        cache_release(cache, acquire_new(BYTES));
    TEST_ASSERT_EQUAL_UINT64(0, cache_statistics(cache).evictions);
    for (int i = 1; i <= 20; i++) {
        cache_release(cache, acquire_new(BYTES));
        TEST_ASSERT_EQUAL_UINT64(i, cache_statistics(cache).evictions);
    }
}

static void more_than_the_arena_is_refused_and_evicts_nothing(void)
{
    start((size_t)1 << 30);
    const struct routine *held = acquire_new(ARENA / 2);
    TEST_ASSERT_NOT_NULL(held);
    TEST_ASSERT_NULL(acquire_new(ARENA / 2 + 1));
    TEST_ASSERT_NOT_NULL(strstr(error.text, "no hole of 524289 bytes"));
    check_code(held);
    cache_release(cache, held);
    held = acquire_new(ARENA);
    TEST_ASSERT_NOT_NULL(held);
    cache_release(cache, held);
}

/* --- Whole devices --- */

enum { STATES = 1500, STATES_EACH = 100 };

static struct varied_image expected[STATES / STATES_EACH], found[STATES / STATES_EACH];

/* Draws STATES states or a share of them, in pictures of STATES_EACH states. The queue contains up to 1024 of
 * these draws. */
static void render_all(const struct engine *engine, const struct device_options *options,
                       struct varied_image *image)
{
    const unsigned states = test_share_of(STATES, 3);
    triptych_device *device;
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, device_create(engine, options, &device, &error), error.text);
    varied_begin(device);
    for (unsigned n = 0; n < states; n++) {
        varied_draw(device, n * 7 % VARIED_STATES);
        if (n % STATES_EACH == STATES_EACH - 1)
            varied_read(device, image + n / STATES_EACH);
    }
    struct triptych_statistics statistics;
    triptych_get_statistics(device, &statistics);
    if (device->arena) {
        struct code_statistics code = code_statistics(device->arena);
        TEST_ASSERT_TRUE(code.used <= code.capacity);
        TEST_ASSERT_TRUE(statistics.cache_evictions > states / 2);
    }
    triptych_device_destroy(device);
}

/* Draws the expected pictures once. */
static void draw_expected(void)
{
    static bool drawn;
    if (drawn)
        return;
    render_all(engine_find("emulate"), &(struct device_options){.threads = 1}, expected);
    TEST_ASSERT_TRUE(memcmp(expected, expected + 1, sizeof *expected));
    drawn = true;
}

static void check_engines(const struct device_options *options)
{
    draw_expected();
    for (unsigned i = 0; engine_at(i); i++) {
        const struct engine *engine = engine_at(i);
        if (engine->without_arena || engine_unavailable(engine) ||
            (test_stride() > 1 && !engine_is_tried(engine)))
            continue;
        render_all(engine, options, found);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(expected, found, sizeof found, engine->name);
    }
}

/* The routines of recorded draws, which cannot be evicted, fill the arena. */
static void thousands_of_states_are_drawn_with_a_tiny_arena(void)
{
    check_engines(
        &(struct device_options){.threads = 2, .cache_bytes = (size_t)1 << 30, .code_bytes = 96 << 10});
}

static void thousands_of_states_are_drawn_with_a_tiny_budget(void)
{
    check_engines(&(struct device_options){.threads = 2, .cache_bytes = 20000});
}

static void any_routine_may_be_the_one_that_is_evicted(void)
{
    static const char *const settings[] = {"replace=lru", "replace=fifo", "replace=random"};
    draw_expected();
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        render_all(engine_find("batch"),
                   &(struct device_options){.threads = 2, .cache_bytes = 20000, .settings = settings[i]},
                   found);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(expected, found, sizeof found, settings[i]);
    }
}

/* With a budget of one routine, 100 recorded draws do not use 300 routines simultaneously. */
static void a_small_budget_bounds_the_routines_of_recorded_draws(void)
{
    triptych_device *device;
    const struct device_options options = {.threads = 1, .cache_bytes = 20000};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(engine_find("batch"), &options, &device, &error));
    varied_begin(device);
    for (unsigned n = 0; n < 100; n++) {
        varied_draw(device, n);
        size_t bytes = cache_statistics(device->cache).bytes;
        TEST_ASSERT_TRUE(bytes < 5 * options.cache_bytes);
    }
    triptych_device_destroy(device);
}

static void a_routine_larger_than_the_arena_is_refused_and_nothing_is_drawn(void)
{
    struct varied_image before, after;
    for (unsigned i = 0; engine_at(i); i++) {
        const struct engine *engine = engine_at(i);
        triptych_device *device;
        const struct device_options options = {.threads = 1, .code_bytes = 1};
        if (engine->without_arena || engine_unavailable(engine))
            continue;
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(engine, &options, &device, &error));
        varied_begin(device);
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 1));
        varied_read(device, &before);
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_state(device, TRIPTYCH_STATE_FOGENABLE, 1));
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_state(device, TRIPTYCH_STATE_FOGVERTEXMODE, 1));
        for (unsigned light = 0; light < 8; light++)
            TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_enable_light(device, light, 1));
        TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_ENGINE_FAILED,
                                      triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1), engine->name);
        TEST_ASSERT_NOT_NULL(strstr(triptych_error(device), "no hole of"));
        varied_read(device, &after);
        TEST_ASSERT_EQUAL_MEMORY(&before, &after, sizeof before);
        triptych_device_destroy(device);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(random_sizes_never_fail_however_long);
    RUN_TEST(two_of_the_largest_leave_room_for_a_third_wherever_they_are);
    RUN_TEST(a_full_arena_loses_the_oldest_only);
    RUN_TEST(more_than_the_arena_is_refused_and_evicts_nothing);
    RUN_TEST(thousands_of_states_are_drawn_with_a_tiny_arena);
    RUN_TEST(thousands_of_states_are_drawn_with_a_tiny_budget);
    RUN_TEST(any_routine_may_be_the_one_that_is_evicted);
    RUN_TEST(a_small_budget_bounds_the_routines_of_recorded_draws);
    RUN_TEST(a_routine_larger_than_the_arena_is_refused_and_nothing_is_drawn);
    return UNITY_END();
}
