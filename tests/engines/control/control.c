/* Loops and jumps of lanes (contract/control.h) on every engine: a program for each construct, and random
 * programs of nested ones. Each lane's result is that of C, computed for this lane by itself. */
#include "machine/code.h"
#include "emu/batch/batch.h"
#include "engines/external/external.h"
#include "engines/list.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "engines/stitch/stitch.h"
#include "command/fuzz/bisect/probe.h"
#include "tests/support/control/nest.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stdlib.h>
#include <string.h>

enum { PROGRAMS = 400 };

static struct code_arena *arena;
static struct error error;
static struct ir recording;
static struct nest nest;
static const union key key;
static const struct job job;
static uint32_t input[NEST_DATA * NEST_LANES];
static alignas(64) float output[SLOT_COUNT * VERTEX_CAPACITY];
static int32_t expected[NEST_LANES][NEST_DATA];
static const struct vertex_arguments arguments = {&job, input, output, NEST_LANES};

void setUp(void)
{
    memset(&error, 0, sizeof error);
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
}

void tearDown(void)
{
    code_destroy(arena);
}

/* --- Engines -------------------------------------------------------------------------------------------- */

static struct routine *build_stitched(void)
{
    struct routine *like = engine_build(&engine_stitch_operation, arena, UNIT_VERTEX, &key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(like, error.text);
    struct routine *routine = probe_build(like, arena, &recording, &(struct probe_options){0}, &error);
    engine_stitch_operation.free(arena, like);
    return routine;
}

/* A routine of the recording. */
static struct routine *build(const struct engine *engine)
{
    if (specialize_is_engine(engine))
        return specialize_routine_of(engine, &recording, 0, NULL, NULL, arena, UNIT_VERTEX, &key, &error);
    if (engine == &engine_stitch_operation)
        return build_stitched();
    if (engine == &engine_batch)
        return batch_routine(&recording, NEST_LANES, false, UNIT_VERTEX, &key, &error);
    return NULL;
}

static void expect(const char *engine, uint64_t program)
{
    char message[200];
    for (int d = 0; d < NEST_DATA; d++)
        for (int l = 0; l < NEST_LANES; l++) {
            int32_t got;
            memcpy(&got, output + d * VERTEX_CAPACITY + l, sizeof got);
            snprintf(message, sizeof message, "%s, program %llu, lane %d, datum %d", engine,
                     (unsigned long long)program, l, d);
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(expected[l][d], got, message);
        }
}

static void run(const char *name, uint64_t program)
{
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
    if (engine_unavailable(engine))
        return;
    struct routine *routine = build(engine);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    memset(output, 0, sizeof output);
    routine->run(&arguments, routine);
    engine->free(arena, routine);
    expect(name, program);
}

static const char *const engines[] = {"batch",          "stitch-operation", "specialize-1",
                                      "specialize-4",   "specialize-8",     "specialize-16",
                                      "specialize-8x2", "specialize-none",  "specialize-thesis"};

/* --- Programs ------------------------------------------------------------------------------------------- */

static void fill(uint64_t *seed)
{
    for (int l = 0; l < NEST_LANES; l++)
        for (int d = 0; d < NEST_DATA; d++) {
            *seed = *seed * 6364136223846793005u + 1442695040888963407u;
            expected[l][d] = (int32_t)(*seed >> 33) & 0xff;
            input[d * NEST_LANES + l] = (uint32_t)expected[l][d];
        }
    for (int l = 0; l < NEST_LANES; l++)
        nest_compute(&nest, expected[l]);
}

static void run_all(uint64_t program)
{
    nest_record(&nest, &recording);
    const char *wrong = ir_verify(&recording);
    TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
    memset(output, 0, sizeof output);
    nest_emulate(&nest, &arguments);
    expect("emulate", program);
    for (size_t n = 0; n < sizeof engines / sizeof *engines; n++)
        run(engines[n], program);
}

static void append(struct nest_node node)
{
    nest.node[nest.nodes++] = node;
}

static void start(void)
{
    memset(&nest, 0, sizeof nest);
    nest.nodes = 1;
}

static void run_small(void)
{
    uint64_t seed = test_seed();
    fill(&seed);
    run_all(0);
}

static void test_lanes_repeat_a_while_by_themselves(void)
{
    start();
    append((struct nest_node){.kind = NEST_WHILE, .data = 1, .body = {2}});
    append((struct nest_node){.kind = NEST_STEP, .data = 0, .number = 5});
    run_small();
}

static void test_a_break_leaves_the_loop(void)
{
    start();
    append((struct nest_node){.kind = NEST_WHILE, .data = 1, .body = {2}});
    append((struct nest_node){.kind = NEST_STEP, .data = 0, .number = 5, .next = 3});
    append((struct nest_node){.kind = NEST_BREAK, .data = 0, .number = 1, .next = 4});
    append((struct nest_node){.kind = NEST_STEP, .data = 2, .number = 3});
    run_small();
}

static void test_a_continue_leaves_the_pass(void)
{
    start();
    append((struct nest_node){.kind = NEST_WHILE, .data = 1, .body = {2}});
    append((struct nest_node){.kind = NEST_STEP, .data = 0, .number = 5, .next = 3});
    append((struct nest_node){.kind = NEST_CONTINUE, .data = 0, .number = 1, .next = 4});
    append((struct nest_node){.kind = NEST_STEP, .data = 2, .number = 3});
    run_small();
}

/* Forward over a block, backward, and to the end. */
static void test_a_goto_continues_at_another_block(void)
{
    for (uint8_t block = 0; block <= NEST_BLOCKS; block++) {
        start();
        append((struct nest_node){.kind = NEST_FLOW, .body = {2, 4, 6}, .next = 8});
        append((struct nest_node){.kind = NEST_STEP, .data = 0, .number = 1, .next = 3});
        append((struct nest_node){.kind = NEST_GOTO, .data = 0, .number = 1, .block = block});
        append((struct nest_node){.kind = NEST_STEP, .data = 1, .number = 2, .next = 5});
        append((struct nest_node){.kind = NEST_GOTO, .data = 1, .number = 2, .block = 0, .next = 7});
        append((struct nest_node){.kind = NEST_STEP, .data = 2, .number = 3});
        append((struct nest_node){.kind = NEST_STEP, .data = 2, .number = 4});
        append((struct nest_node){.kind = NEST_STEP, .data = 3, .number = 5});
        run_small();
    }
}

static void test_random_nests(void)
{
    unsigned kinds[NEST_KINDS] = {0};
    for (uint64_t n = 1; n <= test_share(PROGRAMS); n++) {
        uint64_t seed = (test_seed() + n * 0x9e3779b97f4a7c15u) | 1;
        nest_make(&nest, &seed);
        fill(&seed);
        run_all(n);
        for (int k = 0; k < NEST_KINDS; k++)
            kinds[k] += nest.kinds[k];
    }
    for (int k = 0; k < NEST_KINDS; k++)
        TEST_ASSERT_GREATER_THAN(test_share(PROGRAMS) / 20, kinds[k]);
}

/* The external compiler takes a tenth of a second for each. */
static void test_random_nests_by_the_external_compiler(void)
{
    if (engine_unavailable(&engine_external))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_external));
    for (uint64_t n = 1; n <= 6; n++) {
        uint64_t seed = (test_seed() + n * 0x9e3779b97f4a7c15u) | 1;
        nest_make(&nest, &seed);
        fill(&seed);
        nest_record(&nest, &recording);
        struct routine *routine = external_routine(&engine_external, &recording, UNIT_VERTEX, &key, &error);
        TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
        memset(output, 0, sizeof output);
        routine->run(&arguments, routine);
        engine_external.free(arena, routine);
        expect("external", n);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lanes_repeat_a_while_by_themselves);
    RUN_TEST(test_a_break_leaves_the_loop);
    RUN_TEST(test_a_continue_leaves_the_pass);
    RUN_TEST(test_a_goto_continues_at_another_block);
    RUN_TEST(test_random_nests);
    RUN_TEST(test_random_nests_by_the_external_compiler);
    return UNITY_END();
}
