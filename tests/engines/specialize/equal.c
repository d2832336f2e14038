/* Every engine of the specializer writes the same bytes as the emulator, for random keys and inputs of every
 * unit. TRIPTYCH_SEED selects others. */
#include "machine/code.h"
#include "emu/emulate/emulate.h"
#include "engines/list.h"
#include "engines/specialize/specialize.h"
#include "tests/support/routine/differential.h"
#include "tests/support/system/seed.h"
#include <unity.h>

static struct code_arena *arena;
static struct differential *differential;

void setUp(void)
{
    struct error error = {{0}};
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
}

void tearDown(void)
{
    differential_destroy(differential);
    code_destroy(arena);
}

static void compare_units(const struct engine *engine)
{
    enum { ROUNDS = 1000 };
    if (engine_unavailable(engine))
        TEST_IGNORE_MESSAGE(engine_unavailable(engine));
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        const char *difference = differential_rounds(differential, &engine_emulate, engine, unit, NULL,
                                                     test_seed() + (uint64_t)unit, test_share(ROUNDS));
        if (difference)
            TEST_FAIL_MESSAGE(difference);
    }
}

static void test_eight_lanes_equal_the_emulator(void)
{
    compare_units(&engine_specialize_8);
}

static void test_four_lanes_equal_the_emulator(void)
{
    compare_units(&engine_specialize_4);
}

static void test_sixteen_lanes_equal_the_emulator(void)
{
    compare_units(&engine_specialize_16);
}

static void test_one_lane_equals_the_emulator(void)
{
    compare_units(&engine_specialize_1);
}

static void test_two_quads_in_two_registers_equal_the_emulator(void)
{
    compare_units(&engine_specialize_4x2);
}

static void test_four_quads_in_four_registers_equal_the_emulator(void)
{
    compare_units(&engine_specialize_4x4);
}

static void test_sixteen_lanes_in_two_registers_equal_the_emulator(void)
{
    compare_units(&engine_specialize_8x2);
}

static void test_automatic_lanes_equal_the_emulator(void)
{
    compare_units(&engine_specialize);
}

static void test_thesis_profile_equals_the_emulator(void)
{
    compare_units(&engine_specialize_thesis);
}

static void test_code_without_allocation_equals_the_emulator(void)
{
    compare_units(&engine_specialize_simple);
}

/* The inputs of each key are at other addresses, and routines are built again for each. */
static void compare_variants(const char *const names[], unsigned count)
{
    for (unsigned n = 0; n < count; n++) {
        struct error error = {""};
        const struct engine *engine = engine_named(names[n], &error);
        TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
        if (!engine_unavailable(engine))
            compare_units(engine);
    }
}

static void test_addresses_in_code_equal_the_emulator(void)
{
    static const char *const names[] = {"specialize-1:addresses=patched", "specialize-4:addresses=shared",
                                        "specialize-8:addresses=patched", "specialize-8x2:addresses=shared",
                                        "specialize-16:addresses=patched"};
    compare_variants(names, sizeof names / sizeof *names);
}

static void test_called_sampling_equals_the_emulator(void)
{
    static const char *const names[] = {"specialize-1:calls=sampling",
                                        "specialize-8:calls=sampling:addresses=patched",
                                        "specialize-8x2:calls=shared:registers=5"};
    compare_variants(names, sizeof names / sizeof *names);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_eight_lanes_equal_the_emulator);
    RUN_TEST(test_four_lanes_equal_the_emulator);
    RUN_TEST(test_sixteen_lanes_equal_the_emulator);
    RUN_TEST(test_one_lane_equals_the_emulator);
    RUN_TEST(test_two_quads_in_two_registers_equal_the_emulator);
    RUN_TEST(test_four_quads_in_four_registers_equal_the_emulator);
    RUN_TEST(test_sixteen_lanes_in_two_registers_equal_the_emulator);
    RUN_TEST(test_automatic_lanes_equal_the_emulator);
    RUN_TEST(test_thesis_profile_equals_the_emulator);
    RUN_TEST(test_code_without_allocation_equals_the_emulator);
    RUN_TEST(test_addresses_in_code_equal_the_emulator);
    RUN_TEST(test_called_sampling_equals_the_emulator);
    return UNITY_END();
}
