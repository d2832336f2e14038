/* The routine cache, with an engine that counts its builds: equality of keys, order and budget of eviction,
 * and routines that recorded draws use. */
#include "render/cache/cache.h"
#include "tests/support/shader/random_key.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { CODE_BYTES = 100000 };

static struct cache *cache;
static int built, freed, refuse, capacity;
static struct error error;

/* The linker replaces key_hash by this function (see the Makefile): all keys collide where a test requires
 * it. */
static int collide;
uint64_t __real_key_hash(enum unit unit, const struct packed_key *packed);
uint64_t __wrap_key_hash(enum unit unit, const struct packed_key *packed);
uint64_t __wrap_key_hash(enum unit unit, const struct packed_key *packed)
{
    return collide ? 77 : __real_key_hash(unit, packed);
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *reason)
{
    (void)arena;
    if (refuse || built - freed == capacity) {
        error_set(reason, "no room for the %s routine", unit_name[unit]);
        return NULL;
    }
    struct routine *routine = calloc(1, sizeof *routine);
    TEST_ASSERT_NOT_NULL(routine);
    routine->engine = self;
    routine->unit = unit;
    routine->key = *key;
    routine->code_bytes = CODE_BYTES;
    built++;
    return routine;
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    (void)arena;
    freed++;
    free(routine);
}

static const struct engine engine = {.name = "count",
                                     .description = "counts",
                                     .width = 4,
                                     .without_arena = true,
                                     .build = build,
                                     .free = free_routine};

/* Keys that differ: `n` is below 16. */
static union key key_number(int n)
{
    union key key;
    memset(&key, 0, sizeof key);
    key.pixel.write_mask[0] = (uint8_t)n;
    return key;
}

static const struct routine *acquire(int n)
{
    union key key = key_number(n);
    return cache_acquire(cache, UNIT_PIXEL, &key, &error);
}

static void touch(int n)
{
    const struct routine *routine = acquire(n);
    TEST_ASSERT_NOT_NULL(routine);
    TEST_ASSERT_EQUAL_INT(n, routine->key.pixel.write_mask[0]);
    cache_release(cache, routine);
}

/* Returns true if a second request builds nothing. */
static int present(int n)
{
    struct routine routine;
    for (size_t i = 0; cache_get(cache, i, &routine); i++)
        if (routine.key.pixel.write_mask[0] == n)
            return 1;
    return 0;
}

/* Creates a cache with room for this number of routines of the counting engine. */
static void start(int routines)
{
    cache = cache_create(&engine, NULL, (size_t)routines * (CODE_BYTES + 1000), &error);
    TEST_ASSERT_NOT_NULL(cache);
}

void setUp(void)
{
    built = freed = refuse = collide = 0;
    capacity = 1000;
    error_clear(&error);
}

void tearDown(void)
{
    cache_destroy(cache);
    cache = NULL;
    TEST_ASSERT_EQUAL_INT(built, freed);
}

static void a_key_is_built_once(void)
{
    start(8);
    for (int i = 0; i < 3; i++)
        for (int n = 0; n < 4; n++)
            touch(n);
    struct cache_statistics statistics = cache_statistics(cache);
    TEST_ASSERT_EQUAL_INT(4, built);
    TEST_ASSERT_EQUAL_UINT64(4, statistics.misses);
    TEST_ASSERT_EQUAL_UINT64(8, statistics.hits);
    TEST_ASSERT_EQUAL_UINT64(0, statistics.evictions);
    TEST_ASSERT_EQUAL_UINT64(4, statistics.routines);
}

/* --- Policies and counts ------------------------------------------------------------------------------ */

static void the_oldest_is_evicted_first_in_first_out(void)
{
    start(3);
    cache_evict_by(cache, SETTING_replace_fifo);
    for (int n = 0; n < 3; n++)
        touch(n);
    touch(0);
    touch(3);
    TEST_ASSERT_FALSE(present(0));
    TEST_ASSERT_TRUE(present(1) && present(2) && present(3));
    const struct routine *held = acquire(1);
    touch(4);
    TEST_ASSERT_TRUE(present(1) && present(3) && present(4));
    TEST_ASSERT_FALSE(present(2));
    cache_release(cache, held);
}

/* The numbers that are left after 40 of them, as bits. */
static uint64_t left_by(enum setting_replace policy)
{
    uint64_t left = 0;
    start(8);
    cache_evict_by(cache, policy);
    for (int n = 0; n < 40; n++)
        touch(n);
    for (int n = 0; n < 40; n++)
        left |= (uint64_t)present(n) << n;
    TEST_ASSERT_EQUAL_UINT64(8, cache_statistics(cache).routines);
    cache_destroy(cache);
    cache = NULL;
    return left;
}

static void random_eviction_is_the_same_in_each_run(void)
{
    uint64_t left = left_by(SETTING_replace_random);
    TEST_ASSERT_EQUAL_HEX64(left, left_by(SETTING_replace_random));
    TEST_ASSERT_EQUAL_HEX64(0xffull << 32, left_by(SETTING_replace_lru));
    TEST_ASSERT_NOT_EQUAL(0xffull << 32, left);
}

static void routines_in_use_are_not_evicted_by_any_policy(void)
{
    static const enum setting_replace policies[] = {SETTING_replace_lru, SETTING_replace_fifo,
                                                    SETTING_replace_random};
    for (size_t i = 0; i < sizeof policies / sizeof *policies; i++) {
        start(2);
        cache_evict_by(cache, policies[i]);
        const struct routine *held = acquire(0);
        for (int n = 1; n < 30; n++)
            touch(n);
        TEST_ASSERT_TRUE(present(0));
        cache_release(cache, held);
        cache_destroy(cache);
        cache = NULL;
    }
}

/* The classes of a histogram are the widths of its values in bits. */
static void each_unit_has_its_counts(void)
{
    enum { CODE_CLASS = 64 - __builtin_clzll(CODE_BYTES) };
    union key key;
    memset(&key, 0, sizeof key);
    start(3);
    cache_release(cache, cache_acquire(cache, UNIT_SETUP, &key, &error));
    for (int n = 0; n < 4; n++)
        touch(n);
    touch(3);
    const struct cache_statistics all = cache_statistics(cache);
    const struct cache_unit *pixel = &all.unit[UNIT_PIXEL], *setup = &all.unit[UNIT_SETUP];
    TEST_ASSERT_EQUAL_UINT64(1, setup->misses);
    TEST_ASSERT_EQUAL_UINT64(1, setup->evictions);
    TEST_ASSERT_EQUAL_UINT64(0, setup->routines + setup->bytes);
    TEST_ASSERT_EQUAL_UINT64(4, pixel->misses);
    TEST_ASSERT_EQUAL_UINT64(1, pixel->hits);
    TEST_ASSERT_EQUAL_UINT64(5, pixel->lookups);
    TEST_ASSERT_EQUAL_UINT64(1, pixel->evictions);
    TEST_ASSERT_EQUAL_UINT64(3, pixel->routines);
    TEST_ASSERT_EQUAL_UINT64(all.bytes, pixel->bytes);
    TEST_ASSERT_EQUAL_UINT32(4, pixel->code_bytes[CODE_CLASS]);
    TEST_ASSERT_EQUAL_UINT64(0, pixel->lookup_ns);
    uint32_t builds = 0;
    for (int i = 0; i < CACHE_CLASSES; i++)
        builds += pixel->build_us[i];
    TEST_ASSERT_EQUAL_UINT32(4, builds);
}

static void units_with_equal_bytes_are_different(void)
{
    union key key;
    memset(&key, 0, sizeof key);
    const struct routine *setup = cache_acquire(cache, UNIT_SETUP, &key, &error);
    const struct routine *pixel = cache_acquire(cache, UNIT_PIXEL, &key, &error);
    TEST_ASSERT_TRUE(setup != pixel);
    TEST_ASSERT_EQUAL_INT(UNIT_SETUP, setup->unit);
    TEST_ASSERT_EQUAL_INT(UNIT_PIXEL, pixel->unit);
    cache_release(cache, setup);
    cache_release(cache, pixel);
}

static void units_with_equal_bytes_are_different_routines(void)
{
    start(8);
    units_with_equal_bytes_are_different();
}

/* A hash only selects a bucket. Two keys with the same hash are improbable, but an error there would
 * return the wrong routine. */
static void keys_with_equal_hashes_are_different_routines(void)
{
    collide = 1;
    start(16);
    for (int i = 0; i < 3; i++)
        for (int n = 0; n < 12; n++)
            touch(n);
    TEST_ASSERT_EQUAL_INT(12, built);
    units_with_equal_bytes_are_different();
}

static void the_least_recently_used_leaves_first(void)
{
    start(3);
    touch(0);
    touch(1);
    touch(2);
    touch(0);
    touch(3);
    TEST_ASSERT_TRUE(present(0) && !present(1) && present(2) && present(3));
    touch(4);
    TEST_ASSERT_TRUE(present(0) && !present(2) && present(3) && present(4));
    TEST_ASSERT_EQUAL_UINT64(2, cache_statistics(cache).evictions);
    TEST_ASSERT_EQUAL_INT(2, freed);
}

static void routines_in_use_stay_even_above_the_budget(void)
{
    start(2);
    const struct routine *held[5];
    for (int n = 0; n < 5; n++) {
        TEST_ASSERT_FALSE(cache_is_crowded(cache));
        held[n] = acquire(n);
    }
    TEST_ASSERT_TRUE(cache_is_crowded(cache));
    touch(5);
    TEST_ASSERT_EQUAL_INT(1, freed); /* routine 5, the only idle one */
    for (int n = 0; n < 5; n++) {
        const struct routine *again = acquire(n);
        TEST_ASSERT_EQUAL_PTR(held[n], again);
        TEST_ASSERT_EQUAL_INT(n, again->key.pixel.write_mask[0]);
        cache_release(cache, again);
    }
    TEST_ASSERT_EQUAL_INT(6, built);
    TEST_ASSERT_EQUAL_UINT64(5, cache_statistics(cache).routines);
    for (int n = 4; n >= 0; n--)
        cache_release(cache, held[n]);
    TEST_ASSERT_FALSE(cache_is_crowded(cache));
    TEST_ASSERT_EQUAL_INT(4, freed);
    TEST_ASSERT_TRUE(present(0) && present(1));
}

static void a_routine_leaves_when_its_last_user_has_released_it(void)
{
    start(1);
    const struct routine *held = acquire(0), *again = acquire(0), *other = acquire(1);
    cache_release(cache, held);
    TEST_ASSERT_EQUAL_INT(0, freed);
    TEST_ASSERT_EQUAL_INT(0, again->key.pixel.write_mask[0]);
    cache_release(cache, again);
    TEST_ASSERT_EQUAL_INT(1, freed);
    TEST_ASSERT_FALSE(present(0));
    cache_release(cache, other);
    TEST_ASSERT_TRUE(present(1));
}

static void one_routine_larger_than_the_budget_still_works(void)
{
    cache = cache_create(&engine, NULL, 10, &error);
    touch(0);
    touch(0);
    TEST_ASSERT_EQUAL_INT(1, built);
    touch(1);
    TEST_ASSERT_TRUE(present(1) && !present(0));
}

static void a_refusal_gives_the_reason_and_changes_nothing(void)
{
    start(4);
    refuse = 1;
    TEST_ASSERT_NULL(acquire(0));
    TEST_ASSERT_EQUAL_STRING("no room for the pixel routine", error.text);
    refuse = 0;
    touch(0);
    TEST_ASSERT_EQUAL_UINT64(1, cache_statistics(cache).routines);
}

static void the_last_try_has_the_memory_of_all_idle_routines(void)
{
    start(8);
    capacity = 3;
    const struct routine *held = acquire(0);
    touch(1);
    touch(2);
    touch(3);
    TEST_ASSERT_TRUE(present(0) && !present(1) && !present(2) && present(3));
    cache_release(cache, held);
}

static void routines_have_numbers_hits_and_build_times(void)
{
    start(8);
    for (int n = 0; n < 5; n++)
        touch(n);
    touch(2);
    touch(2);
    struct routine routine;
    for (int n = 0; n < 5; n++) {
        TEST_ASSERT_TRUE(cache_get(cache, (size_t)n, &routine));
        TEST_ASSERT_EQUAL_UINT32(n + 1, routine.number);
        TEST_ASSERT_EQUAL_INT(n, routine.key.pixel.write_mask[0]);
        TEST_ASSERT_EQUAL_UINT64(n == 2 ? 2 : 0, routine.hits);
    }
    TEST_ASSERT_FALSE(cache_get(cache, 5, &routine));
}

static void hundreds_of_keys_are_all_found_again(void)
{
    start(1000);
    uint64_t seed = 11;
    static union key keys[600];
    for (int i = 0; i < 600; i++) {
        key_random(UNIT_VERTEX, &seed, &keys[i]);
        cache_release(cache, cache_acquire(cache, UNIT_VERTEX, &keys[i], &error));
    }
    int first_built = built;
    for (int i = 0; i < 600; i++) {
        const struct routine *routine = cache_acquire(cache, UNIT_VERTEX, &keys[i], &error);
        TEST_ASSERT_EQUAL_MEMORY(&keys[i], &routine->key, sizeof keys[i]);
        cache_release(cache, routine);
    }
    TEST_ASSERT_EQUAL_INT(first_built, built);
}

/* A thread that acquires, uses and releases routines. The small budget evicts routines all the time. */
static void *churn(void *argument)
{
    unsigned seed = (unsigned)(uintptr_t)argument;
    for (int i = 0; i < 3000; i++) {
        seed = seed * 1664525 + 1013904223;
        int n = (int)(seed >> 24) % 12;
        union key key = key_number(n);
        const struct routine *routine = cache_acquire(cache, UNIT_PIXEL, &key, NULL);
        if (!routine || routine->key.pixel.write_mask[0] != n)
            return "wrong routine";
        cache_release(cache, routine);
    }
    return NULL;
}

static void threads_may_share_it(void)
{
    start(3);
    pthread_t thread[4];
    for (uintptr_t i = 0; i < 4; i++)
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&thread[i], NULL, churn, (void *)(i + 1)));
    for (int i = 0; i < 4; i++) {
        void *result;
        pthread_join(thread[i], &result);
        TEST_ASSERT_NULL(result);
    }
    struct cache_statistics statistics = cache_statistics(cache);
    TEST_ASSERT_EQUAL_UINT64(12000, statistics.hits + statistics.misses);
    TEST_ASSERT_EQUAL_UINT64(statistics.misses, (uint64_t)built);
    TEST_ASSERT_TRUE(statistics.bytes <= 3 * (CODE_BYTES + 1000));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_key_is_built_once);
    RUN_TEST(the_oldest_is_evicted_first_in_first_out);
    RUN_TEST(random_eviction_is_the_same_in_each_run);
    RUN_TEST(routines_in_use_are_not_evicted_by_any_policy);
    RUN_TEST(each_unit_has_its_counts);
    RUN_TEST(units_with_equal_bytes_are_different_routines);
    RUN_TEST(keys_with_equal_hashes_are_different_routines);
    RUN_TEST(the_least_recently_used_leaves_first);
    RUN_TEST(routines_in_use_stay_even_above_the_budget);
    RUN_TEST(a_routine_leaves_when_its_last_user_has_released_it);
    RUN_TEST(one_routine_larger_than_the_budget_still_works);
    RUN_TEST(a_refusal_gives_the_reason_and_changes_nothing);
    RUN_TEST(the_last_try_has_the_memory_of_all_idle_routines);
    RUN_TEST(routines_have_numbers_hits_and_build_times);
    RUN_TEST(hundreds_of_keys_are_all_found_again);
    RUN_TEST(threads_may_share_it);
    return UNITY_END();
}
