/* Routines of 16 lanes write the same bytes as those of emulate, on every processor with AVX2: where AVX-512
 * is absent, its instructions are emulated (tests/support/avx512).
 *
 * TRIPTYCH_SEED selects other keys and inputs. */
#include "emu/emulate/emulate.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "machine/code.h"
#include "machine/cpu.h"
#include "tests/support/avx512/avx512.h"
#include "tests/support/differential/differential.h"
#include "tests/support/routine/routines.h"
#include "tests/support/system/seed.h"

#include <string.h>
#include <unity.h>

static struct code_arena *arena;
static struct differential *differential;
static uint64_t seed;

void setUp(void)
{
    struct error error = {{0}};
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
    seed = test_seed();
    avx512_begin(arena);
}

void tearDown(void)
{
    if (!arena)
        return;
    avx512_end();
    differential_destroy(differential);
    code_destroy(arena);
    arena = NULL;
}

static struct routine *build(const struct engine *self, struct code_arena *where, enum unit unit,
                             const union key *key, struct error *error)
{
    const struct build_options options = {.width = 16, .parts = 1, .profile = PROFILE_FULL};
    (void)self;
    return specialize_routine(&engine_specialize, &options, where, unit, key, error);
}

static void expect_equal(void *context, enum unit unit, const union key *key)
{
    struct engine wide = engine_specialize;
    (void)context;
    wide.name = "specialize with 16 lanes";
    wide.build = build;
    const char *found = differential_compare(differential, &engine_emulate, &wide, unit, key, seed++);
    TEST_ASSERT_NULL_MESSAGE(found, found);
}

/* The same for every fourth key: instructions that are emulated, and those between them, cost a signal. */
static void expect_some_equal(void *context, enum unit unit, const union key *key)
{
    unsigned *seen = context;
    if ((*seen)++ % 4 == 0)
        expect_equal(NULL, unit, key);
}

/* The emulator must not be left out where it is needed. */
static void expect_executed(void)
{
    if (cpu_lacks_avx512())
        TEST_ASSERT_GREATER_THAN(1000, avx512_executed());
}

static void test_random_keys(void)
{
    visit_random_keys(test_share_of(400, 9), seed, expect_equal, NULL);
    expect_executed();
}

static void test_shaders(void)
{
    unsigned seen = 0;
    visit_shaders(seed, expect_some_equal, &seen);
    expect_executed();
}

static void test_random_shaders(void)
{
    visit_random_shaders(test_share_of(60, 9), seed, expect_equal, NULL);
    expect_executed();
}

static void test_streams(void)
{
    unsigned seen = 0;
    visit_streams(expect_some_equal, &seen);
    expect_executed();
}

/* The dark rectangle of stencil shadows: its colour is the same at all corners, so no value is that of a row
 * or of a column. */
static void test_a_span_without_values_of_rows(void)
{
    union key key;
    memset(&key, 0, sizeof key);
    key.pixel.span = SPAN_LEVEL;
    key.pixel.depth_function = COMPARE_ALWAYS;
    key.pixel.depth_format = DEPTH_UNORM;
    key.pixel.stencil = STENCIL_ONE;
    key.pixel.stencil_function[0] = COMPARE_LESS;
    key.pixel.write_mask[0] = 15;
    key.pixel.varying[VARYING_diffuse] = INTERPOLATION_SMOOTH;
    for (unsigned i = 0; i < 20; i++)
        expect_equal(NULL, UNIT_PIXEL, &key);
    expect_executed();
}

int main(void)
{
    visit_fewer();
    UNITY_BEGIN();
    RUN_TEST(test_a_span_without_values_of_rows);
    RUN_TEST(test_random_keys);
    RUN_TEST(test_shaders);
    RUN_TEST(test_random_shaders);
    RUN_TEST(test_streams);
    return UNITY_END();
}
