/* Counts of states a frame, of the cache and of tiers. */
#include "command/count/counted.h"
#include "command/stream/stream.h"
#include "engines/list.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

static struct count_states states;

void setUp(void)
{
    states = (struct count_states){0};
}

void tearDown(void)
{
    count_states_free(&states);
}

/* Draws with one of the numbered states. */
static void note(unsigned number)
{
    union key key[UNIT_COUNT];
    memset(key, 0, sizeof key);
    key[UNIT_PIXEL].pixel.write_mask[0] = (uint8_t)(number % 16);
    key[UNIT_SETUP].setup.cull = (uint8_t)(number / 16);
    count_states_note(&states, key);
}

static void expect_frame(unsigned draws, unsigned different, unsigned fresh, unsigned changes,
                         unsigned returns)
{
    const struct count_states_frame *frame = &states.frame;
    TEST_ASSERT_EQUAL(draws, frame->draws);
    TEST_ASSERT_EQUAL(different, frame->states);
    TEST_ASSERT_EQUAL(fresh, frame->fresh);
    TEST_ASSERT_EQUAL(changes, frame->changes);
    TEST_ASSERT_EQUAL(returns, frame->returns);
}

static void states_are_counted_by_frame(void)
{
    static const unsigned first[] = {1, 1, 2, 1, 2, 17}, second[] = {2, 3, 3, 2};
    count_states_begin_frame(&states);
    expect_frame(0, 0, 0, 0, 0);
    for (size_t i = 0; i < sizeof first / sizeof *first; i++)
        note(first[i]);
    expect_frame(6, 3, 3, 5, 2);
    count_states_begin_frame(&states);
    for (size_t i = 0; i < sizeof second / sizeof *second; i++)
        note(second[i]);
    expect_frame(4, 2, 1, 3, 1);
    TEST_ASSERT_EQUAL(4, states.sets.count);
    TEST_ASSERT_EQUAL(1, states.keys[UNIT_VERTEX].count);
    TEST_ASSERT_EQUAL(2, states.keys[UNIT_SETUP].count);
    TEST_ASSERT_EQUAL(3, states.keys[UNIT_PIXEL].count);
}

static int go_on(void)
{
    return 0;
}

static struct count_frame frames[8];

static void play(const char *engine, size_t budget, struct counted *c)
{
    struct error error = {""};
    struct stream *stream;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_read("tests/data/streams/blend-factors.tri", &stream, &error),
                                  error.text);
    *c = (struct counted){.stream = stream,
                          .name = "test",
                          .engine = engine_named(engine, &error),
                          .frames = stream->frame_count < 8 ? stream->frame_count : 8,
                          .frame = frames,
                          .budget = budget};
    TEST_ASSERT_NOT_NULL_MESSAGE(c->engine, error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, count_play(c, 1, &(struct setting_values){{0}}, go_on, &error),
                                  error.text);
    stream_free(stream);
}

/* With the usual budget each key is built once. With that of one routine, keys that return are built
 * again. */
static void a_small_budget_costs_evictions(void)
{
    for (int small = 0; small < 2; small++) {
        struct counted c;
        play("batch", small, &c);
        uint64_t misses = 0, keys = 0, evictions = 0;
        for (enum unit unit = 0; unit < UNIT_COUNT; unit++) {
            const struct cache_unit *counts = &c.cache.unit[unit];
            misses += counts->misses;
            evictions += counts->evictions;
            keys += c.states.keys[unit].count;
            TEST_ASSERT_TRUE(counts->lookups >= counts->misses);
            TEST_ASSERT_TRUE(counts->lookup_ns > 0 && counts->build_ns > 0);
        }
        TEST_ASSERT_TRUE(keys > 3);
        TEST_ASSERT_EQUAL_UINT64(misses - evictions, c.cache.routines);
        if (!small)
            TEST_ASSERT_EQUAL_UINT64(keys, misses);
        TEST_ASSERT_EQUAL(small, evictions > 0);
        TEST_ASSERT_EQUAL(0, c.tiers.count);
        count_states_free(&c.states);
    }
}

static void tiers_are_summed_over_routines(void)
{
    struct counted c;
    if (engine_unavailable(engine_find("tiered")))
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    play("tiered:tiers=batch+stitch:runs=3:wait", 0, &c);
    TEST_ASSERT_EQUAL(2, c.tiers.count);
    TEST_ASSERT_EQUAL_STRING("batch", c.tiers.tier[0].engine);
    TEST_ASSERT_EQUAL(c.cache.routines, c.tiers.tier[0].builds);
    TEST_ASSERT_TRUE(c.tiers.tier[0].runs > 0 && c.tiers.tier[0].runs <= 3 * c.cache.routines);
    TEST_ASSERT_EQUAL(c.tiers.tier[1].builds > 0, c.tiers.tier[1].runs > 0);
    count_states_free(&c.states);
}

static void second_codes_are_counted(void)
{
    struct counted c;
    if (engine_unavailable(engine_find("specialize-8")))
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    play("specialize-8", 0, &c);
    TEST_ASSERT_EQUAL_UINT32(0, c.second.routines);
    count_states_free(&c.states);
    play("specialize-8:sixteen=1", 0, &c);
    TEST_ASSERT_EQUAL_UINT32(c.cache.unit[UNIT_PIXEL].routines, c.second.routines);
    TEST_ASSERT_GREATER_THAN_UINT64(0, c.second.blocks);
    TEST_ASSERT_EQUAL(c.second.built > 0, c.second.bytes > 0);
    count_states_free(&c.states);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(states_are_counted_by_frame);
    RUN_TEST(a_small_budget_costs_evictions);
    RUN_TEST(tiers_are_summed_over_routines);
    RUN_TEST(second_codes_are_counted);
    return UNITY_END();
}
