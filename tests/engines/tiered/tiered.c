/* Tiers: pictures drawn before, during and after the change to specialized routines are equal, and no
 * event during a build in the background causes an error. */
#include "engines/tiered/tiered.h"

#include "machine/code.h"
#include "engines/list.h"
#include "engines/specialize/specialize.h"
#include "engines/stitch/stitch.h"
#include "tests/support/picture/varied.h"
#include "engines/tiered/tier.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

static struct code_arena *arena;
static struct error error;

void setUp(void)
{
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
}

void tearDown(void)
{
    background_create_with(NULL);
    code_destroy(arena);
    arena = NULL;
}

static struct routine *build(const struct engine *engine, enum unit unit)
{
    union key key;
    memset(&key, 0, sizeof key);
    struct routine *routine = engine_build(engine, arena, unit, &key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    return routine;
}

static unsigned threads(void)
{
    unsigned count = 0;
    DIR *folder = opendir("/proc/self/task");
    TEST_ASSERT_NOT_NULL(folder);
    while (readdir(folder))
        count++;
    closedir(folder);
    return count - 2;
}

static int refuse(pthread_t *thread, const pthread_attr_t *attributes, void *(*function)(void *),
                  void *argument)
{
    (void)thread, (void)attributes, (void)function, (void)argument;
    return EAGAIN;
}

/* --- A routine --------------------------------------------------------------------------------------- */

static void a_routine_is_specialized_after_a_wait(void)
{
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        struct routine *routine = build(&engine_tiered, unit);
        tiered_wait(routine);
        TEST_ASSERT_TRUE(tiered_is_specialized(routine));
        TEST_ASSERT_EQUAL_PTR(&engine_tiered, routine->engine);
        engine_tiered.free(arena, routine);
    }
    TEST_ASSERT_EQUAL_UINT64(0, code_statistics(arena).used);
}

/* A thread can decide to request a tier just before the job ends that makes it. */
static void a_request_after_the_last_tier_builds_nothing(void)
{
    struct routine *routine = build(&engine_tiered, UNIT_PIXEL);
    struct tiered *tiered = tiered_of(routine);
    tiered_wait(routine);
    size_t used = code_statistics(arena).used;
    background_request(&tiered->job);
    background_wait(&tiered->job);
    TEST_ASSERT_TRUE(tiered_is_specialized(routine));
    TEST_ASSERT_EQUAL_UINT64(used, code_statistics(arena).used);
    engine_tiered.free(arena, routine);
}

static void a_refused_thread_leaves_routines_stitched_until_one_is_given(void)
{
    background_create_with(refuse);
    struct routine *routine = build(&engine_tiered, UNIT_PIXEL);
    tiered_wait(routine);
    TEST_ASSERT_FALSE(tiered_is_specialized(routine));
    background_create_with(NULL);
    struct routine *other = build(&engine_tiered, UNIT_SETUP);
    tiered_wait(other);
    tiered_wait(routine);
    TEST_ASSERT_TRUE(tiered_is_specialized(other));
    TEST_ASSERT_TRUE(tiered_is_specialized(routine));
    engine_tiered.free(arena, routine);
    engine_tiered.free(arena, other);
}

static void a_full_arena_leaves_routines_stitched(void)
{
    struct code_span span;
    TEST_ASSERT_EQUAL_INT(0, code_reserve(arena, code_statistics(arena).capacity / 2 + 4096, &span, &error));
    struct routine *routine = build(&engine_tiered, UNIT_PIXEL);
    tiered_wait(routine);
    TEST_ASSERT_FALSE(tiered_is_specialized(routine));
    engine_tiered.free(arena, routine);
    code_free(arena, &span);
}

static void routines_are_freed_while_they_wait_or_are_built(void)
{
    enum { ROUNDS = 100, ROUTINES = 12 };
    for (int round = 0; round < ROUNDS; round++) {
        struct routine *routine[ROUTINES];
        for (int i = 0; i < ROUTINES; i++)
            routine[i] = build(&engine_tiered, (enum unit)(i % UNIT_COUNT));
        for (int i = 0; i < ROUTINES; i++)
            engine_tiered.free(arena, routine[(i * 5 + round) % ROUTINES]);
        TEST_ASSERT_EQUAL_UINT64(0, code_statistics(arena).used);
    }
}

static pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;

static void pass_gate(struct background_job *job)
{
    (void)job;
    pthread_mutex_lock(&gate);
    pthread_mutex_unlock(&gate);
}

static void a_full_queue_accepts_no_more_until_there_is_room(void)
{
    enum { JOBS = BACKGROUND_QUEUE + 3 };
    struct background_job *job = calloc(JOBS, sizeof *job);
    TEST_ASSERT_NOT_NULL(job);
    background_begin();
    pthread_mutex_lock(&gate);
    unsigned accepted = 0;
    for (int i = 0; i < JOBS; i++) {
        job[i].work = pass_gate;
        background_request(job + i);
        accepted += job[i].state == JOB_QUEUED;
    }
    TEST_ASSERT_TRUE(accepted == BACKGROUND_QUEUE ||
                     accepted == BACKGROUND_QUEUE + 1); /* one is at the gate */
    TEST_ASSERT_EQUAL_INT(JOB_IDLE, job[JOBS - 1].state);
    background_cancel(job + BACKGROUND_QUEUE / 2);
    TEST_ASSERT_EQUAL_INT(JOB_IDLE, job[BACKGROUND_QUEUE / 2].state);
    pthread_mutex_unlock(&gate);
    for (int i = 0; i < JOBS; i++) {
        while (job[i].state == JOB_IDLE)
            background_request(job + i);
        background_wait(job + i);
        TEST_ASSERT_EQUAL_INT(JOB_DONE, job[i].state);
    }
    background_end();
    free(job);
}

static void no_thread_outlives_the_routines(void)
{
    unsigned before = threads();
    struct routine *routine = build(&engine_tiered, UNIT_PIXEL);
    TEST_ASSERT_EQUAL_UINT(before + 1, threads());
    engine_tiered.free(arena, routine);
    for (int i = 0; i < 1000 && threads() > before; i++)
        usleep(1000); /* the list may still contain a thread that has been joined */
    TEST_ASSERT_EQUAL_UINT(before, threads());
}

/* --- Pictures ---------------------------------------------------------------------------------------- */

enum { STATES = 60 };

/* Draws twice, so that second runs use specialized routines; with and without a new frame in between. */
static void render(const struct engine *engine, const struct device_options *options,
                   struct varied_image *image)
{
    triptych_device *device;
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, device_create(engine, options, &device, &error), error.text);
    varied_begin(device);
    for (unsigned n = 0; n < 2 * STATES; n++) {
        varied_draw(device, n % STATES * 13);
        if (n % 7 == 6)
            varied_read(device, image);
    }
    varied_read(device, image);
    triptych_device_destroy(device);
}

static void check(const struct device_options *options)
{
    struct varied_image expected, found;
    render(engine_find("emulate"), &(struct device_options){.threads = 1}, &expected);
    for (int i = 0; i < 2; i++) {
        const struct engine *engine = i ? &engine_tiered_swap : &engine_tiered;
        render(engine, options, &found);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &found, sizeof found, engine->name);
    }
}

static void both_tiers_draw_the_same(void)
{
    check(&(struct device_options){.threads = 1});
    check(&(struct device_options){.threads = 3});
}

static void routines_may_be_evicted_while_they_wait(void)
{
    check(&(struct device_options){.threads = 2, .cache_bytes = 1});
    check(&(struct device_options){.threads = 2, .cache_bytes = 30000});
}

static void a_tiny_arena_is_shared_by_draws_and_the_background(void)
{
    check(&(struct device_options){.threads = 2, .cache_bytes = 1 << 30, .code_bytes = 96 << 10});
}

static void refused_threads_draw_the_same(void)
{
    background_create_with(refuse);
    check(&(struct device_options){.threads = 2});
}

static void devices_are_destroyed_while_routines_are_built(void)
{
    for (unsigned i = 0; i < 50; i++) {
        triptych_device *device;
        const struct device_options options = {.threads = 2};
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(&engine_tiered, &options, &device, &error));
        varied_begin(device);
        for (unsigned n = 0; n < i % 8 + 1; n++)
            varied_draw(device, (i + n) * 31);
        triptych_device_destroy(device);
    }
}

static const char shader_text[] =
    "ps_2_0\ndef c0, 0.25, 0.5, 0.75, 1\nmul r0, c0, c0\nmad r0, r0, c0, c0\nmov oC0, r0\n";

/* The key has only the number of the shader. */
static void shaders_may_be_released_while_their_routines_wait(void)
{
    const struct device_options options = {.threads = 1};
    for (unsigned i = 0; i < 50; i++) {
        triptych_device *device;
        triptych_shader *shader;
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(&engine_tiered, &options, &device, &error));
        varied_begin(device);
        varied_draw(device, i);
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            TRIPTYCH_OK, triptych_shader_assemble(device, "test", shader_text, strlen(shader_text), &shader),
            triptych_error(device));
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_pixel_shader(device, shader));
        TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1),
                                      triptych_error(device));
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_shader_destroy(device, shader));
        triptych_device_destroy(device);
    }
}

/* --- Forks ------------------------------------------------------------------------------------------- */

/* The exit status of the child is its result. */
static int use_in_child(struct routine *waiting)
{
    union key key;
    memset(&key, 0, sizeof key);
    alarm(60);
    tiered_wait(waiting); /* no thread builds it: it returns */
    struct routine *routine = engine_build(&engine_tiered, arena, UNIT_SETUP, &key, &error);
    if (!routine)
        return 1;
    tiered_wait(routine);
    tiered_wait(waiting);
    if (!tiered_is_specialized(routine) || !tiered_is_specialized(waiting))
        return 2;
    engine_tiered.free(arena, routine);
    engine_tiered.free(arena, waiting);
    return 0;
}

/* ThreadSanitizer aborts child processes that create threads. */
static void a_child_has_a_thread_of_its_own(void)
{
#ifdef __SANITIZE_THREAD__
    TEST_IGNORE();
#endif
    for (int i = 0; i < 20; i++) {
        struct routine *routine[4];
        for (int n = 0; n < 4; n++)
            routine[n] = build(&engine_tiered, (enum unit)(n % UNIT_COUNT));
        pid_t child = fork();
        TEST_ASSERT_TRUE(child >= 0);
        if (!child)
            _exit(use_in_child(routine[3]));
        int status;
        TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
        TEST_ASSERT_EQUAL_INT(0, status);
        for (int n = 0; n < 4; n++) {
            tiered_wait(routine[n]);
            TEST_ASSERT_TRUE(tiered_is_specialized(routine[n]));
            engine_tiered.free(arena, routine[n]);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_routine_is_specialized_after_a_wait);
    RUN_TEST(a_request_after_the_last_tier_builds_nothing);
    RUN_TEST(a_refused_thread_leaves_routines_stitched_until_one_is_given);
    RUN_TEST(a_full_arena_leaves_routines_stitched);
    RUN_TEST(routines_are_freed_while_they_wait_or_are_built);
    RUN_TEST(a_full_queue_accepts_no_more_until_there_is_room);
    RUN_TEST(no_thread_outlives_the_routines);
    RUN_TEST(both_tiers_draw_the_same);
    RUN_TEST(routines_may_be_evicted_while_they_wait);
    RUN_TEST(a_tiny_arena_is_shared_by_draws_and_the_background);
    RUN_TEST(refused_threads_draw_the_same);
    RUN_TEST(devices_are_destroyed_while_routines_are_built);
    RUN_TEST(shaders_may_be_released_while_their_routines_wait);
    RUN_TEST(a_child_has_a_thread_of_its_own);
    return UNITY_END();
}
