/* The granularity of a routine: a key that stage fragments do not cover is joined from operation fragments,
 * with the same results, and the routine and its listing have the granularity.
 *
 * The tests replace the decision: half of all keys, whatever their values, count as not covered. */
#define _GNU_SOURCE
#include "engines/stitch/cover.h"
#include "machine/code.h"
#include "emu/emulate/emulate.h"
#include "engines/stitch/stitch.h"
#include "tests/support/differential/differential.h"
#include "tests/support/shader/random_key.h"
#include "tests/support/system/seed.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

static const char reason[] = "keys whose hash is odd";

static struct code_arena *arena;
static unsigned built[2]; /* by stages, by operations */

static const char *odd(enum unit unit, const union key *key)
{
    struct packed_key packed = key_pack(unit, key);
    return key_hash(unit, &packed) & 1 ? reason : NULL;
}

/* Odd, or not covered. */
static const char *lack(enum unit unit, const union key *key)
{
    const char *lacks = stages_lack(unit, key);
    return lacks ? lacks : odd(unit, key);
}

static struct routine *build(const struct engine *self, struct code_arena *code, enum unit unit,
                             const union key *key, struct error *error)
{
    struct routine *routine = engine_stitch.build(self, code, unit, key, error);
    if (routine)
        built[!strcmp(routine->granularity, "operation")]++;
    return routine;
}

static struct routine *build_by(const struct engine *engine, enum unit unit, const union key *key)
{
    struct error error = {{0}};
    struct routine *routine = engine_build(engine, arena, unit, key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    return routine;
}

/* A covered key that `odd` rejects or accepts. */
static union key draw_key(enum unit unit, int wanted, uint64_t *seed)
{
    union key key;
    do {
        key_random(unit, seed, &key);
        stages_reduce(unit, &key);
    } while ((odd(unit, &key) != NULL) != wanted);
    return key;
}

static void mixed_granularities_give_the_emulators_bytes(void)
{
    struct engine mixed = engine_stitch;
    mixed.build = build;
    mixed.options = &(const struct stitch_options){lack};
    struct differential *differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
    memset(built, 0, sizeof built);
    const unsigned rounds = 600 / test_stride();
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        const char *difference = differential_rounds(differential, &engine_emulate, &mixed, unit,
                                                     stages_reduce, 0xc0fe, (int)rounds);
        TEST_ASSERT_NULL_MESSAGE(difference, difference);
    }
    differential_destroy(differential);
    TEST_ASSERT_GREATER_THAN(rounds, built[0]);
    TEST_ASSERT_GREATER_THAN(rounds, built[1]);
}

/* Both routines read the same constants, so equal plans are equal bytes. */
static void the_other_granularity_is_the_operation_stitchers(void)
{
    struct engine mixed = engine_stitch;
    uint64_t seed = 0x0dd;
    mixed.build = build;
    mixed.options = &(const struct stitch_options){lack};
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        union key key = draw_key(unit, 1, &seed);
        struct routine *ours = build_by(&mixed, unit, &key);
        struct routine *theirs = build_by(&engine_stitch_operation, unit, &key);
        TEST_ASSERT_EQUAL_STRING("operation", ours->granularity);
        TEST_ASSERT_EQUAL_STRING("operation", theirs->granularity);
        TEST_ASSERT_EQUAL_PTR(&mixed, ours->engine);
        TEST_ASSERT_EQUAL_UINT32(theirs->code_bytes, ours->code_bytes);
        TEST_ASSERT_EQUAL_MEMORY(theirs->code, ours->code, ours->code_bytes);
        engine_stitch.free(arena, ours);
        engine_stitch_operation.free(arena, theirs);
    }
}

static void covered_keys_are_joined_from_stages(void)
{
    uint64_t seed = 0xe7e4;
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        union key key = draw_key(unit, 0, &seed);
        struct routine *routine = build_by(&engine_stitch, unit, &key);
        TEST_ASSERT_EQUAL_STRING("stage", routine->granularity);
        engine_stitch.free(arena, routine);
    }
    union key key = {.pixel = {.write_mask = {15}}};
    struct routine *emulated = build_by(&engine_emulate, UNIT_PIXEL, &key);
    TEST_ASSERT_NULL(emulated->granularity);
    engine_emulate.free(NULL, emulated);
}

static char *list(enum unit unit, const union key *key)
{
    struct error error = {{0}};
    struct engine mixed = engine_stitch;
    mixed.options = &(const struct stitch_options){lack};
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_EQUAL_MESSAGE(0, stitch_dump(&mixed, arena, unit, key, out, &error), error.text);
    fclose(out);
    return text;
}

static void listings_have_the_granularity_and_its_reason(void)
{
    uint64_t seed = 0x115;
    union key by_operation = draw_key(UNIT_PIXEL, 1, &seed), by_stage = draw_key(UNIT_PIXEL, 0, &seed);
    char *operations = list(UNIT_PIXEL, &by_operation), *stages = list(UNIT_PIXEL, &by_stage);
    char line[128];
    snprintf(line, sizeof line, "\ngranularity: operation, since stage fragments do not cover %s\n", reason);
    TEST_ASSERT_NOT_NULL(strstr(operations, line));
    TEST_ASSERT_NOT_NULL(strstr(operations, "src/spec/"));
    TEST_ASSERT_NOT_NULL(strstr(stages, "\ngranularity: stage\n"));
    TEST_ASSERT_NULL(strstr(stages, "src/spec/"));
    free(operations);
    free(stages);
}

static void a_reduced_key_is_covered_and_covered_keys_stay_the_same(void)
{
    uint64_t seed = 0x5eed;
    for (int i = 0; i < 3000; i++) {
        enum unit unit = i % UNIT_COUNT;
        union key key, reduced, again;
        key_random(unit, &seed, &key);
        reduced = key;
        stages_reduce(unit, &reduced);
        TEST_ASSERT_NULL(stages_lack(unit, &reduced));
        again = reduced;
        stages_reduce(unit, &again);
        TEST_ASSERT_EQUAL_MEMORY(&reduced, &again, sizeof again);
        if (stages_cover(unit, &key))
            TEST_ASSERT_EQUAL_MEMORY(&key, &reduced, sizeof key);
    }
}

void setUp(void)
{
    struct error error = {{0}};
    if (engine_unavailable(&engine_stitch))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_stitch));
    arena = code_create(1 << 24, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
}

void tearDown(void)
{
    code_destroy(arena);
    arena = NULL;
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(mixed_granularities_give_the_emulators_bytes);
    RUN_TEST(the_other_granularity_is_the_operation_stitchers);
    RUN_TEST(covered_keys_are_joined_from_stages);
    RUN_TEST(listings_have_the_granularity_and_its_reason);
    RUN_TEST(a_reduced_key_is_covered_and_covered_keys_stay_the_same);
    return UNITY_END();
}
