/* Mixed: each unit's routines are those of its engine, pictures are equal, and wrong names are refused. */
#include "emu/emulate/emulate.h"
#include "engines/list.h"
#include "engines/mixed.h"
#include "engines/variant.h"
#include "tests/support/picture/varied.h"
#include <unity.h>

#include <stdlib.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static const struct engine *make(const char *name)
{
    struct error error = {""};
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
    TEST_ASSERT_TRUE(mixed_is_engine(engine));
    return engine;
}

static void expect_engines(const char *name, const char *vertex, const char *setup, const char *pixel)
{
    const struct engine *engine = make(name);
    TEST_ASSERT_EQUAL_STRING(vertex, mixed_engine(engine, UNIT_VERTEX)->name);
    TEST_ASSERT_EQUAL_STRING(setup, mixed_engine(engine, UNIT_SETUP)->name);
    TEST_ASSERT_EQUAL_STRING(pixel, mixed_engine(engine, UNIT_PIXEL)->name);
}

static void each_unit_has_the_engine_of_its_option(void)
{
    expect_engines("mixed", "emulate", "stitch", "specialize");
    expect_engines("mixed:pixel=batch-16", "emulate", "stitch", "batch-16");
    expect_engines("mixed:setup=specialize-4:vertex=stitch", "stitch", "specialize-4", "specialize");
    expect_engines("mixed:pixel=batch:pixel=emulate", "emulate", "stitch", "emulate");
    expect_engines("mixed:vertex=specialize-8+registers=6+without=fold",
                   "specialize-8:registers=6:without=fold", "stitch", "specialize");
}

static void an_engine_that_is_not_mixed_has_no_engines_of_units(void)
{
    TEST_ASSERT_NULL(mixed_engine(engine_find("emulate"), UNIT_VERTEX));
    TEST_ASSERT_NULL(mixed_engine(engine_find("tiered"), UNIT_PIXEL));
}

static void wrong_engines_are_refused(void)
{
    static const char *const rows[][2] = {
        {"mixed:pixel", "pixel has no value, expected an engine"},
        {"mixed:pixels=stitch", "did you mean \"pixel\"?"},
        {"mixed:pixel=stich", "there is none of that name, expected one of: emulate"},
        {"mixed:pixel=mixed", "pixel is \"mixed\", expected an engine that is not mixed"},
        {"mixed:setup=mixed+setup=stitch", "expected an engine that is not mixed"},
        {"mixed:vertex=specialize-8+registers=14",
         "registers is \"14\", expected a whole number from 0 to 13"},
        {"mixed:registers=6", "found the option \"registers\", expected one of: vertex, setup, pixel"},
        {"specialize:pixel=stitch", "found the option \"pixel\", expected one of: registers"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct error error = {""};
        TEST_ASSERT_NULL_MESSAGE(engine_named(rows[i][0], &error), rows[i][0]);
        if (!strstr(error.text, rows[i][1]))
            TEST_ASSERT_EQUAL_STRING(rows[i][1], error.text);
    }
}

enum { STATES = 40 };

/* The routines of a device that has drawn are those of the unit's engine. */
static void check_routines(const char *name)
{
    struct error error = {""};
    triptych_device *device;
    TEST_ASSERT_EQUAL_MESSAGE(
        TRIPTYCH_OK, device_create(make(name), &(struct device_options){.threads = 1}, &device, &error),
        error.text);
    varied_begin(device);
    varied_draw(device, 31);
    struct routine routine;
    unsigned units = 0;
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++) {
        TEST_ASSERT_EQUAL_PTR(mixed_engine(make(name), routine.unit), routine.engine);
        units |= 1u << routine.unit;
    }
    triptych_device_destroy(device);
    TEST_ASSERT_EQUAL_HEX(7, units);
}

/* Engines with other widths, with and without code, and with a background thread. */
static void every_mixture_draws_the_same(void)
{
    static const char *const names[] = {
        "mixed", "mixed:vertex=batch:setup=specialize-4:pixel=stitch",
        "mixed:vertex=specialize-8:setup=emulate:pixel=batch-16",
        "mixed:vertex=stitch-operation:setup=batch-256:pixel=emulate",
        "mixed:vertex=tiered:setup=tiered-swap:pixel=specialize-8+registers=6+without=fold"};
    struct varied_image expected, found;
    varied_render(engine_find("emulate"), &(struct device_options){.threads = 1}, 0, STATES, &expected);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (engine_unavailable(make(names[i])))
            continue;
        check_routines(names[i]);
        varied_render(make(names[i]), &(struct device_options){.threads = 2}, 0, STATES, &found);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &found, sizeof found, names[i]);
    }
}

/* Routines are freed by their engines, too. */
static void routines_of_mixed_engines_are_evicted(void)
{
    struct varied_image expected, found;
    if (engine_unavailable(make("mixed")))
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    varied_render(engine_find("emulate"), &(struct device_options){.threads = 1}, 7, STATES, &expected);
    varied_render(make("mixed:vertex=batch:pixel=stitch"),
                  &(struct device_options){.threads = 1, .cache_bytes = 1}, 7, STATES, &found);
    TEST_ASSERT_EQUAL_MEMORY(&expected, &found, sizeof found);
}

/* --- A faulty engine -------------------------------------------------------------------------------- */

/* Emulates, but culls the wrong side. */
static struct routine *build_faulty(const struct engine *self, struct code_arena *arena, enum unit unit,
                                    const union key *key, struct error *error)
{
    union key wrong = *key;
    (void)self;
    if (unit == UNIT_SETUP)
        wrong.setup.cull = key->setup.cull == CULL_NONE ? CULL_CLOCKWISE : CULL_NONE;
    return engine_build(&engine_emulate, arena, unit, &wrong, error);
}

/* The picture by the engine, with only the given unit, or all units, by the faulty one. */
static void draw_with_faulty(const struct engine *faulty, unsigned units, struct varied_image *image)
{
    struct engine mixed = engine_mixed;
    void *options = mixed_copy_options(&mixed);
    TEST_ASSERT_NOT_NULL(options);
    for (enum unit unit = 0; unit < UNIT_COUNT; unit++)
        mixed_use(options, unit, units >> unit & 1 ? faulty : &engine_emulate);
    mixed.options = options;
    varied_render(&mixed, &(struct device_options){.threads = 1}, 0, STATES, image);
    free(options);
}

/* As docs/debugging.md describes. */
static void only_the_mixture_with_the_faulty_unit_differs(void)
{
    struct engine faulty = engine_emulate;
    struct varied_image expected, found;
    faulty.build = build_faulty;
    draw_with_faulty(&faulty, 0, &expected);
    for (enum unit unit = 0; unit < UNIT_COUNT; unit++) {
        draw_with_faulty(&faulty, 1u << unit, &found);
        TEST_ASSERT_EQUAL_MESSAGE(unit == UNIT_SETUP, memcmp(&expected, &found, sizeof found) != 0,
                                  unit_name[unit]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_unit_has_the_engine_of_its_option);
    RUN_TEST(an_engine_that_is_not_mixed_has_no_engines_of_units);
    RUN_TEST(wrong_engines_are_refused);
    RUN_TEST(every_mixture_draws_the_same);
    RUN_TEST(routines_of_mixed_engines_are_evicted);
    RUN_TEST(only_the_mixture_with_the_faulty_unit_differs);
    return UNITY_END();
}
