/* Both stitchers compute the emulator's bytes, for random keys and inputs of every unit. TRIPTYCH_SEED
 * selects others. */
#include "machine/code.h"
#include "emu/emulate/emulate.h"
#include "engines/stitch/cover.h"
#include "engines/stitch/stitch.h"
#include "tests/support/differential/differential.h"
#include "tests/support/system/seed.h"
#include <unity.h>

static struct code_arena *arena;
static struct differential *differential;

void setUp(void)
{
    struct error error = {{0}};
    const char *reason = engine_unavailable(&engine_stitch);
    if (reason)
        TEST_IGNORE_MESSAGE(reason);
    arena = code_create(1 << 24, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
}

void tearDown(void)
{
    differential_destroy(differential);
    code_destroy(arena);
    differential = NULL;
    arena = NULL;
}

/* The stage stitcher runs twice: with keys that stage fragments cover, and with any keys. Most
 * of these are not covered. */
static void compare(enum unit unit)
{
    static const struct {
        const struct engine *engine;
        differential_shape *shape;
    } stitchers[] = {
        {&engine_stitch, stages_reduce}, {&engine_stitch, NULL}, {&engine_stitch_operation, NULL}};
    enum { ROUNDS = 3000 };
    for (size_t i = 0; i < sizeof stitchers / sizeof *stitchers; i++) {
        const char *difference =
            differential_rounds(differential, &engine_emulate, stitchers[i].engine, unit, stitchers[i].shape,
                                test_seed() + i, test_share_of(ROUNDS, 16));
        if (difference)
            TEST_FAIL_MESSAGE(difference);
    }
}

static void vertex_routines_agree(void)
{
    compare(UNIT_VERTEX);
}

static void setup_routines_agree(void)
{
    compare(UNIT_SETUP);
}

static void pixel_routines_agree(void)
{
    compare(UNIT_PIXEL);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(vertex_routines_agree);
    RUN_TEST(setup_routines_agree);
    RUN_TEST(pixel_routines_agree);
    return UNITY_END();
}
