/* Heat: routines climb through the tiers when they have been used enough, and the coldest lose their code. */
#include "engines/list.h"
#include "engines/tiered/tiered.h"
#include "tests/support/picture/varied.h"
#include "tests/support/system/tried.h"

#include <string.h>
#include <unity.h>

enum { STATES = 24, ROUNDS = 6 };

static struct varied_image expected;

void setUp(void)
{
    test_needs_engine("tiered");
}

void tearDown(void)
{
}

static const struct engine *make(const char *name)
{
    struct error error = {""};
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
    return engine;
}

/* Draws all states in turn, ROUNDS times, and the first of them again and again in between. */
static struct triptych_device *draw(const struct engine *engine, unsigned threads, struct varied_image *image)
{
    struct error error = {""};
    struct triptych_device *device;
    const struct device_options options = {.threads = threads};
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, device_create(engine, &options, &device, &error), error.text);
    varied_begin(device);
    for (unsigned n = 0; n < ROUNDS * STATES; n++) {
        varied_draw(device, n % STATES * 13);
        varied_draw(device, 0);
        varied_read(device, image);
    }
    return device;
}

/* Draws with an engine, and compares the picture with that of emulate. */
static struct triptych_device *draw_equal(const char *name, unsigned threads)
{
    struct varied_image found;
    if (!expected.color[0])
        triptych_device_destroy(draw(engine_find("emulate"), 1, &expected));
    struct triptych_device *device = draw(make(name), threads, &found);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &found, sizeof found, name);
    return device;
}

/* The sums over all routines of the device. */
static struct routine_tiers sum(struct triptych_device *device)
{
    struct routine_tiers all = {0};
    struct routine routine;
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++) {
        TEST_ASSERT_NOT_NULL(routine.tiers);
        all.count = routine.tiers->count;
        for (unsigned t = 0; t < all.count; t++) {
            const struct routine_tier *tier = routine.tiers->tier + t;
            all.tier[t].engine = tier->engine;
            all.tier[t].runs += tier->runs;
            all.tier[t].elements += tier->elements;
            all.tier[t].builds += tier->builds;
            all.tier[t].drops += tier->drops;
            all.tier[t].code_bytes += tier->code_bytes;
        }
    }
    return all;
}

static void a_routine_needs_its_runs_for_each_tier(void)
{
    static const char *const engines[] = {"batch", "stitch", "specialize-thesis", "specialize"};
    static const unsigned needed[] = {2, 3, 5};
    struct triptych_device *device =
        draw_equal("tiered:tiers=batch+stitch+specialize-thesis+specialize:runs=2+3+5:wait", 1);
    struct routine routine;
    unsigned highest = 0;
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++) {
        const struct routine_tiers *tiers = routine.tiers;
        TEST_ASSERT_EQUAL(4, tiers->count);
        for (unsigned t = 0; t < tiers->current; t++)
            TEST_ASSERT_EQUAL(needed[t], tiers->tier[t].runs);
        for (unsigned t = 0; t < tiers->count; t++) {
            TEST_ASSERT_EQUAL_STRING(engines[t], tiers->tier[t].engine);
            TEST_ASSERT_EQUAL(t <= tiers->current, tiers->tier[t].builds);
        }
        highest = tiers->current > highest ? tiers->current : highest;
    }
    triptych_device_destroy(device);
    TEST_ASSERT_EQUAL(3, highest);
}

/* A last number holds for the tiers after it. */
static void elements_raise_a_routine_too(void)
{
    struct triptych_device *device = draw_equal("tiered:tiers=emulate+stitch+specialize:elements=40:wait", 1);
    struct routine routine;
    unsigned raised = 0;
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++)
        for (unsigned t = 0; t < routine.tiers->current; t++) {
            TEST_ASSERT_TRUE(routine.tiers->tier[t].elements >= 40);
            raised++;
        }
    triptych_device_destroy(device);
    TEST_ASSERT_TRUE(raised);
}

static void routines_below_the_threshold_are_not_built_again(void)
{
    struct triptych_device *device = draw_equal("tiered:runs=1000000", 1);
    const struct routine_tiers all = sum(device);
    triptych_device_destroy(device);
    TEST_ASSERT_TRUE(all.tier[0].runs > 0);
    TEST_ASSERT_EQUAL(0, all.tier[1].runs);
    TEST_ASSERT_EQUAL(0, all.tier[1].builds);
}

/* The first state, which is drawn half of the time, keeps its code. */
static void the_coldest_routines_lose_their_code(void)
{
    enum { KEEP = 8 << 10 };
    struct triptych_device *device = draw_equal("tiered:runs=1:keep=8:wait", 1);
    const struct routine_tiers all = sum(device);
    struct routine routine;
    const struct routine_tiers *hottest = NULL;
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++) {
        const struct routine_tier *tier = routine.tiers->tier;
        if (!hottest || tier[0].runs + tier[1].runs > hottest->tier[0].runs + hottest->tier[1].runs)
            hottest = routine.tiers;
    }
    TEST_ASSERT_TRUE(all.tier[1].drops > 0);
    TEST_ASSERT_TRUE(all.tier[1].code_bytes > 0);
    TEST_ASSERT_TRUE(all.tier[1].code_bytes <= KEEP);
    TEST_ASSERT_EQUAL(1, hottest->current);
    triptych_device_destroy(device);
}

static unsigned builds_with(const char *name)
{
    struct triptych_device *device = draw_equal(name, 1);
    const struct routine_tiers all = sum(device);
    triptych_device_destroy(device);
    return all.tier[1].builds;
}

static void hysteresis_saves_builds(void)
{
    TEST_ASSERT_TRUE(builds_with("tiered:runs=1:keep=8:hysteresis=1:wait") >
                     builds_with("tiered:runs=1:keep=8:hysteresis=20:wait"));
}

/* Without thresholds too, and while several threads run the routines. */
static void code_is_dropped_while_threads_run(void)
{
    static const char *const names[] = {
        "tiered:keep=1", "tiered:keep=6:hysteresis=1",
        "tiered:tiers=batch+stitch+specialize:runs=1:keep=4:hysteresis=1:wait", "tiered-swap:keep=2"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        triptych_device_destroy(draw_equal(names[i], 3));
}

static void wrong_options_are_refused(void)
{
    static const char *const rows[][2] = {
        {"tiered:tiers=stitch", "tiers is \"stitch\", expected at least 2 engines"},
        {"tiered:tiers=stitch+specialise",
         "found the tier \"specialise\", expected one of: emulate, batch, "},
        {"tiered:tiers=stitch+", "found the tier \"\", expected one of"},
        {"tiered:tiers=tiered+stitch", "found the tier \"tiered\", expected one of"},
        {"tiered:tiers=emulate+batch+stitch+specialize+specialize-8", "tiers has more than 4 engines"},
        {"tiered:runs=", "runs is \"\", expected at most 4 whole numbers from 0 to 1000000"},
        {"tiered:runs=2+", "runs is \"2+\", expected at most 4"},
        {"tiered:runs=1+2+3+4+5", "expected at most 4 whole numbers"},
        {"tiered:elements=1000001", "elements is \"1000001\", expected"},
        {"tiered:keep=0", "keep is \"0\", expected a whole number from 1 to 65536"},
        {"tiered:hysteresis=x", "hysteresis is \"x\", expected a whole number from 1 to 1000"},
        {"tiered:wait=1", "wait takes no value, found \"1\""},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct error error = {""};
        TEST_ASSERT_NULL_MESSAGE(engine_named(rows[i][0], &error), rows[i][0]);
        if (!strstr(error.text, rows[i][1]))
            TEST_ASSERT_EQUAL_STRING(rows[i][1], error.text);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_routine_needs_its_runs_for_each_tier);
    RUN_TEST(elements_raise_a_routine_too);
    RUN_TEST(routines_below_the_threshold_are_not_built_again);
    RUN_TEST(the_coldest_routines_lose_their_code);
    RUN_TEST(hysteresis_saves_builds);
    RUN_TEST(code_is_dropped_while_threads_run);
    RUN_TEST(wrong_options_are_refused);
    return UNITY_END();
}
