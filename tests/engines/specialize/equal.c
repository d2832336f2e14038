/* Every engine of the specializer writes the same bytes as the emulator, for random keys and inputs of every
 * unit. TRIPTYCH_SEED selects others. */
#include "machine/code.h"
#include "emu/emulate/emulate.h"
#include "engines/list.h"
#include "engines/specialize/specialize.h"
#include "tests/support/differential/differential.h"
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

/* Engines without a variant, then variants. The inputs of each key are at other addresses, and routines are
 * built again for each. */
static const char *const names[] = {
    "specialize-8",
    "specialize-4",
    "specialize-16",
    "specialize-1",
    "specialize-4x2",
    "specialize-4x4",
    "specialize-8x2",
    "specialize",
    "specialize-thesis",
    "specialize-simple",
    "specialize-1:addresses=patched",
    "specialize-4:addresses=shared",
    "specialize-8:addresses=patched",
    "specialize-8x2:addresses=shared",
    "specialize-16:addresses=patched",
    "specialize-1:calls=sampling",
    "specialize-8:calls=sampling:addresses=patched",
    "specialize-8x2:calls=shared:registers=5",
};

enum { ROUNDS = 1000, ENGINES = 1 + sizeof names / sizeof *names };

/* Stores the emulator and the engines that this machine can execute. Returns their number. */
static unsigned find_engines(const struct engine *engines[ENGINES])
{
    unsigned count = 0;
    engines[count++] = &engine_emulate;
    for (unsigned n = 0; n < ENGINES - 1; n++) {
        struct error error = {""};
        const struct engine *engine = engine_named(names[n], &error);
        TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
        if (!engine_unavailable(engine))
            engines[count++] = engine;
    }
    return count;
}

/* All engines get the inputs of a key, which take longer to make than a routine takes to run. */
static void compare(enum unit unit)
{
    const struct engine *engines[ENGINES];
    uint64_t seed = test_seed() + (uint64_t)unit;
    unsigned count = find_engines(engines), rounds = test_share_of(ROUNDS, 16);
    if (count == 1)
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_specialize));
    for (unsigned i = 0; i < rounds; i++) {
        union key key;
        differential_key(unit, &seed, &key);
        const char *difference = differential_run(differential, engines, count, unit, &key, seed);
        if (difference)
            TEST_FAIL_MESSAGE(difference);
    }
}

static void test_vertex_routines_of_every_engine_equal_the_emulator(void)
{
    compare(UNIT_VERTEX);
}

static void test_setup_routines_of_every_engine_equal_the_emulator(void)
{
    compare(UNIT_SETUP);
}

static void test_pixel_routines_of_every_engine_equal_the_emulator(void)
{
    compare(UNIT_PIXEL);
}

/* The lanes of a routine have the texture's levels of their own quads. */
static void test_lanes_of_different_levels_equal_the_emulator(void)
{
    enum { KEYS = 4 * FILTER_COUNT };
    const struct engine *engines[ENGINES];
    const unsigned count = find_engines(engines);
    if (count == 1)
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_specialize));
    for (unsigned i = 0; i < KEYS; i++) {
        union key key = {.pixel = {.depth_function = COMPARE_ALWAYS,
                                   .stages = 1,
                                   .write_mask = {15},
                                   .varying[1] = 1,
                                   .texture[0] = 1,
                                   .filter[0] = (uint8_t)(i % FILTER_COUNT),
                                   .mip[0] = i / FILTER_COUNT % 2 ? MIP_POINT : MIP_LINEAR,
                                   .address_u[0] = ADDRESS_WRAP_POWER,
                                   .address_v[0] = ADDRESS_WRAP_POWER,
                                   .color_argument[0] = 1,
                                   .alpha_argument[0] = 1}};
        const char *difference =
            differential_run(differential, engines, count, UNIT_PIXEL, &key, test_seed() + i);
        if (difference)
            TEST_FAIL_MESSAGE(difference);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_vertex_routines_of_every_engine_equal_the_emulator);
    RUN_TEST(test_setup_routines_of_every_engine_equal_the_emulator);
    RUN_TEST(test_pixel_routines_of_every_engine_equal_the_emulator);
    RUN_TEST(test_lanes_of_different_levels_equal_the_emulator);
    return UNITY_END();
}
