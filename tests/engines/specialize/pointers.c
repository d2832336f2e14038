/* Addresses as literals in code: what is written when, by one thread and by two. The routine reads a word of
 * texture 0 for each vertex. */
#include "machine/code.h"
#include "engines/list.h"
#include "engines/specialize/build.h"
#include "engines/specialize/pointers.h"
#include "engines/specialize/specialize.h"
#include <unity.h>

#include <pthread.h>
#include <string.h>

enum { LANES = 16, TEXELS = 64, RUNS = 20000, JOBS = POINTER_COPIES + 3 };

static struct code_arena *arena;
static struct error error;
static struct ir program;
static const union key key;
static uint32_t texels[JOBS][TEXELS];
static struct job jobs[JOBS];

static uint16_t append(enum ir_op op, enum ir_type type, enum base base, uint16_t operand, int32_t field)
{
    return ir_append(&program, (struct ir_instruction){.op = (uint8_t)op,
                                                       .type = (uint8_t)type,
                                                       .base = (uint8_t)base,
                                                       .scale = op == IR_gather ? 4 : 0,
                                                       .operand = {operand},
                                                       .field = field});
}

static void make_program(void)
{
    ir_start(&program);
    uint16_t index = append(IR_load, TYPE_itg, BASE_INPUT, 0, 0);
    uint16_t word = append(IR_gather, TYPE_itg, BASE_JOB, index, offsetof(struct job, texture[0].texels));
    append(IR_store, TYPE_non, BASE_OUTPUT, word, 0);
}

void setUp(void)
{
    memset(&error, 0, sizeof error);
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    if (engine_unavailable(&engine_specialize_8) || !code_can_patch(arena))
        TEST_IGNORE_MESSAGE("needs AVX2, FMA and membarrier");
    make_program();
    for (uint32_t j = 0; j < JOBS; j++) {
        jobs[j].texture[0].texels = texels[j];
        for (uint32_t t = 0; t < TEXELS; t++)
            texels[j][t] = j << 16 | t;
    }
}

void tearDown(void)
{
    code_destroy(arena);
}

static struct routine *build(const char *name)
{
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
    struct routine *routine =
        specialize_routine_of(engine, &program, 0, NULL, NULL, arena, UNIT_VERTEX, &key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    return routine;
}

static void destroy(struct routine *routine)
{
    routine->engine->free(arena, routine);
}

/* Runs the routine for a job. Returns true if all words are of the job's texture. */
static bool run(const struct routine *routine, unsigned job)
{
    uint32_t index[LANES];
    alignas(64) uint32_t out[LANES];
    for (uint32_t l = 0; l < LANES; l++)
        index[l] = (l * 7 + job) % TEXELS;
    const struct vertex_arguments arguments = {jobs + job, index, (float *)out, LANES};
    routine->run(&arguments, routine);
    for (uint32_t l = 0; l < LANES; l++)
        if (out[l] != texels[job][index[l]])
            return false;
    return true;
}

static void addresses_are_written_when_they_change(void)
{
    struct routine *routine = build("specialize-8:addresses=patched");
    TEST_ASSERT_EQUAL(0, routine->patches->writes);
    for (int i = 0; i < 10; i++)
        TEST_ASSERT_TRUE(run(routine, 3));
    TEST_ASSERT_EQUAL(1, routine->patches->writes);
    for (unsigned i = 0; i < 10; i++)
        TEST_ASSERT_TRUE(run(routine, i % 2));
    TEST_ASSERT_EQUAL(11, routine->patches->writes);
    TEST_ASSERT_EQUAL(1, routine->patches->copies);
    TEST_ASSERT_EQUAL(0, routine->patches->waits);
    destroy(routine);
}

static void copies_keep_addresses(void)
{
    struct routine *routine = build("specialize-8:addresses=shared");
    for (unsigned i = 0; i < 100; i++)
        TEST_ASSERT_TRUE(run(routine, i % POINTER_COPIES));
    TEST_ASSERT_EQUAL(POINTER_COPIES, routine->patches->writes);
    TEST_ASSERT_EQUAL(POINTER_COPIES, routine->patches->copies);
    destroy(routine);
}

/* The copy that was used longest ago is written again. */
static void more_addresses_than_copies_recycle_the_oldest(void)
{
    struct routine *routine = build("specialize-8:addresses=shared");
    for (unsigned i = 0; i < POINTER_COPIES; i++)
        TEST_ASSERT_TRUE(run(routine, i));
    TEST_ASSERT_TRUE(run(routine, 0));
    TEST_ASSERT_TRUE(run(routine, POINTER_COPIES)); /* to the copy of job 1 */
    TEST_ASSERT_TRUE(run(routine, 0));
    TEST_ASSERT_EQUAL(POINTER_COPIES + 1, routine->patches->writes);
    TEST_ASSERT_TRUE(run(routine, 1));
    TEST_ASSERT_EQUAL(POINTER_COPIES + 2, routine->patches->writes);
    for (unsigned i = 0; i < 5 * JOBS; i++)
        TEST_ASSERT_TRUE(run(routine, i % JOBS));
    TEST_ASSERT_EQUAL(POINTER_COPIES, routine->patches->copies);
    destroy(routine);
}

/* --- Two threads ---------------------------------------------------------------------------------------- */

struct worker {
    const struct routine *routine;
    unsigned first, jobs; /* it runs these in turn */
    unsigned wrong;
};

static void *work(void *context)
{
    struct worker *worker = context;
    for (unsigned i = 0; i < RUNS; i++)
        worker->wrong += !run(worker->routine, worker->first + i % worker->jobs);
    return NULL;
}

static void run_two_threads(const struct routine *routine, unsigned jobs_of_each)
{
    pthread_t thread[2];
    struct worker worker[2] = {{routine, 0, jobs_of_each, 0}, {routine, jobs_of_each, jobs_of_each, 0}};
    for (int t = 0; t < 2; t++)
        TEST_ASSERT_EQUAL(0, pthread_create(thread + t, NULL, work, worker + t));
    for (int t = 0; t < 2; t++)
        pthread_join(thread[t], NULL);
    TEST_ASSERT_EQUAL(0, worker[0].wrong);
    TEST_ASSERT_EQUAL(0, worker[1].wrong);
}

static void two_threads_take_turns_with_one_copy(void)
{
    struct routine *routine = build("specialize-8:addresses=patched");
    run_two_threads(routine, 1);
    TEST_ASSERT_EQUAL(1, routine->patches->copies);
    TEST_ASSERT_LESS_OR_EQUAL(2 * RUNS, routine->patches->writes);
    TEST_ASSERT_GREATER_OR_EQUAL(2, routine->patches->writes);
    destroy(routine);
}

static void two_threads_have_a_copy_each(void)
{
    struct routine *routine = build("specialize-8:addresses=shared");
    run_two_threads(routine, 1);
    TEST_ASSERT_EQUAL(2, routine->patches->copies);
    TEST_ASSERT_EQUAL(2, routine->patches->writes);
    TEST_ASSERT_EQUAL(0, routine->patches->waits);
    destroy(routine);
}

static void two_threads_with_more_addresses_than_copies(void)
{
    struct routine *routine = build("specialize-8:addresses=shared");
    run_two_threads(routine, JOBS / 2);
    TEST_ASSERT_EQUAL(0, routine->patches->waits);
    destroy(routine);
}

/* In an arena with room for one copy only, shared code is as patched code. */
static void a_full_arena_leaves_one_copy(void)
{
    struct routine *big = build("specialize-8:addresses=patched");
    size_t bytes = big->code_bytes;
    destroy(big);
    code_destroy(arena);
    arena = code_create(1, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    struct routine *routine = build("specialize-8:addresses=shared");
    struct code_span rest;
    size_t left = code_statistics(arena).largest_free;
    TEST_ASSERT_GREATER_THAN(bytes, left);
    TEST_ASSERT_EQUAL(0, code_reserve(arena, left, &rest, &error));
    run_two_threads(routine, 2);
    TEST_ASSERT_EQUAL(1, routine->patches->copies);
    TEST_ASSERT_GREATER_THAN(2, routine->patches->writes);
    code_free(arena, &rest);
    destroy(routine);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(addresses_are_written_when_they_change);
    RUN_TEST(copies_keep_addresses);
    RUN_TEST(more_addresses_than_copies_recycle_the_oldest);
    RUN_TEST(two_threads_take_turns_with_one_copy);
    RUN_TEST(two_threads_have_a_copy_each);
    RUN_TEST(two_threads_with_more_addresses_than_copies);
    RUN_TEST(a_full_arena_leaves_one_copy);
    return UNITY_END();
}
