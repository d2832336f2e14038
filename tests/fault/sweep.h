/* Refuses each request of a device once: each memory block, mapping and thread that a call of the interface
 * requests. It refuses the request by itself, and together with all later requests.
 *
 * A call that fails must change nothing. The test repeats it and refuses its next request, until no request
 * is left to refuse. The picture at the end must be the picture of an undisturbed device. If a call succeeds
 * although a request was refused, its later requests are refused when the scene is drawn again. A build with
 * sanitizers refuses every third request of a call, from the first.
 *
 * A source that includes it defines _GNU_SOURCE first. */
#ifndef TESTS_FAULT_SWEEP_H
#define TESTS_FAULT_SWEEP_H

#include "tests/support/system/fault.h"

#include "engines/list.h"
#include "tests/support/system/tried.h"
#include "triptych.h"

#include <unity.h>

enum { CALLS = 1024, PASSES = 400 };

static triptych_device *device;
static char reason[512];
static const char *engine;
static uint64_t digest;

/* Each call of a scene, in order: the first of its requests that has not been refused yet. */
static struct {
    bool injecting, onwards, more;
    unsigned call;
    unsigned long next[CALLS], stride;
    unsigned long refused, gone_on; /* calls that failed, and calls that succeeded in spite of a refusal */
} sweep;

static inline void begin_call(void)
{
    reason[0] = 0;
    TEST_ASSERT_LESS_THAN(CALLS, sweep.call);
    if (sweep.injecting)
        fault_arm(sweep.next[sweep.call], sweep.onwards);
}

/* Checks the result of a call. Returns true if the call must be repeated. */
static inline bool again(enum triptych_result result, const char *text)
{
    bool refused = fault.armed && fault.refused;
    unsigned long number = fault.at;
    char message[1024];
    fault_disarm();
    const char *told = reason[0] || !device ? reason : triptych_error(device);
    snprintf(message, sizeof message, "%s: request %lu%s of %s: result %d, \"%s\"", engine, number,
             sweep.onwards ? " and all later" : "", text, result, told);
    if (result == TRIPTYCH_OK) {
        sweep.next[sweep.call] += refused * sweep.stride;
        sweep.more |= refused;
        sweep.gone_on += refused;
        sweep.call++;
        return false;
    }
    TEST_ASSERT_TRUE_MESSAGE(refused, message);
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_NO_MEMORY, result, message);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "memory"), message);
    TEST_ASSERT_NULL_MESSAGE(strchr(told, '\n'), message);
    sweep.refused++;
    sweep.next[sweep.call] += sweep.stride;
    begin_call();
    return true;
}

/* Makes the call until it succeeds. */
#define TRY(call)                                                                                            \
    do                                                                                                       \
        begin_call();                                                                                        \
    while (again((call), #call))

static inline void open_device(unsigned threads, size_t cache_bytes)
{
    struct triptych_options options = {.engine = engine, .threads = threads, .cache_bytes = cache_bytes};
    begin_call();
    while (again(triptych_device_create(&options, &device, reason, sizeof reason), "triptych_device_create"))
        TEST_ASSERT_NULL(device);
    reason[0] = 0;
}

typedef void scene(unsigned threads);

static inline uint64_t draw_scene(scene *draw, unsigned threads)
{
    digest = 1;
    sweep.call = 0;
    sweep.more = false;
    draw(threads);
    triptych_device_destroy(device);
    device = NULL;
    return digest;
}

/* Draws the scene until no request is left to refuse. The memory of recordings and plans is kept until the
 * process ends, so the scene requests it only the first time. */
static inline void refuse_everything(scene *draw, unsigned threads, bool onwards)
{
    uint64_t expected = 0;
    memset(&sweep, 0, sizeof sweep);
    sweep.onwards = onwards;
    sweep.stride = test_stride_of(3);
    for (unsigned i = 0; i < CALLS; i++)
        sweep.next[i] = 1;
    for (unsigned pass = 0; !pass || sweep.more; pass++) {
        TEST_ASSERT_LESS_THAN(PASSES, pass);
        sweep.injecting = true;
        if (pass)
            fault_watch();
        uint64_t got = draw_scene(draw, threads);
        const char *lost = pass ? fault_lost() : NULL;
        TEST_ASSERT_NULL_MESSAGE(lost, lost);
        bool more = sweep.more;
        sweep.injecting = false;
        if (!pass)
            expected = draw_scene(draw, threads);
        sweep.more = more || !pass;
        TEST_ASSERT_EQUAL_HEX64_MESSAGE(expected, got, engine);
    }
    TEST_ASSERT_GREATER_THAN(5, sweep.refused);
}

static inline void on_engines(scene *draw)
{
    bool soak = getenv("TRIPTYCH_SOAK") != NULL;
    for (unsigned i = 0; triptych_engine_name(i); i++) {
        engine = triptych_engine_name(i);
        if (!engine_is_tried(engine_at(i)) &&
            (triptych_engine_unavailable(i) || !soak || !strcmp(engine, "external")))
            continue;
        refuse_everything(draw, 1, true); /* first, because calls then fail before memory is kept */
        refuse_everything(draw, 1, false);
        if (soak || !strcmp(engine, "specialize"))
            refuse_everything(draw, 2, false);
    }
}

#endif
