/* Every fragment is executed in routines that are compared with the specializer's: of random keys, of shaders
 * and of streams. Fragments of operations that the specification does not use are executed in random
 * programs.
 *
 * Each part of a plan is preceded by a mark, one instruction that sets a byte of the fragment and changes
 * neither registers nor flags. The byte of a fragment that is planned but jumped over is not set. */
#define _GNU_SOURCE
#include "machine/code.h"
#include "engines/specialize/specialize.h"
#include "engines/stitch/cover.h"
#include "engines/stitch/stitch.h"
#include "tests/support/differential/differential.h"
#include "tests/support/routine/routines.h"
#include "tests/support/system/seed.h"
#include "tests/support/routine/stitched.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unity.h>

enum { RANDOM_KEYS = 10000, RANDOM_SHADERS = 90, PROGRAMS = 4000, MARKS = 4096 };

static struct code_arena *arena;
static struct differential *differential;
static uint8_t *marks; /* by fragment, in the lowest 2 GiB */
static uint64_t seed;

static unsigned fragment_number(const struct fragment *fragment)
{
    return (unsigned)(fragment - __start_stitch_fragments);
}

static unsigned fragment_count(void)
{
    return fragment_number(__stop_stitch_fragments);
}

/* mov byte [address], 1: the address is the hole. */
static const struct hole mark_hole = {.offset = 3, .kind = HOLE_WORD, .argument = 0};
static const uint8_t mark_code[16] = {0xc6, 0x04, 0x25, 0, 0, 0, 0, 1};
static const struct fragment mark = {
    .name = "mark", .code = mark_code, .hole = &mark_hole, .bytes = 8, .holes = 1};

/* Returns the part with its new number 2 i + 1 after its mark. Jumps to it are redirected to the mark. */
static struct part behind_mark(const struct part *part)
{
    struct part result = *part;
    unsigned jumps = 0;
    for (unsigned h = 0; h < part->fragment->holes; h++)
        if (part->fragment->hole[h].kind == HOLE_JUMP)
            jumps |= 1u << part->fragment->hole[h].argument;
    for (int n = 0; n < ARGUMENT_COUNT; n++)
        if (jumps >> n & 1)
            result.arguments.value[n] *= 2;
    return result;
}

static void add_marks(struct plan *plan)
{
    TEST_ASSERT_LESS_THAN(PART_CAPACITY / 2, plan->count);
    for (unsigned i = plan->count; i--;) {
        struct part part = plan->part[i];
        uintptr_t address = (uintptr_t)(marks + fragment_number(part.fragment));
        plan->part[2 * i + 1] = behind_mark(&part);
        plan->part[2 * i] = (struct part){.fragment = &mark, .arguments = {{(int32_t)address}}};
    }
    plan->count *= 2;
}

/* --- Marked routines --------------------------------------------------------------------------------- */

struct marked {
    struct routine routine; /* first */
    struct code_span span;
};

static struct routine *build_marked(const struct engine *self, struct code_arena *where, enum unit unit,
                                    const union key *key, struct error *error)
{
    struct plan *plan = plan_take(error);
    struct marked *marked = calloc(1, sizeof *marked);
    TEST_ASSERT_TRUE(plan && marked);
    const struct stitch_options *options = self->options;
    if (options->lack(unit, key))
        plan_operations(plan, unit, key);
    else
        plan_stages(plan, unit, key);
    add_marks(plan);
    int failed = plan_join(plan, where, &marked->span, error);
    plan_give(plan);
    if (failed) {
        free(marked);
        return NULL;
    }
    marked->routine =
        (struct routine){.engine = self, .unit = unit, .key = *key, .code = marked->span.executable};
    memcpy(&marked->routine.run, &marked->routine.code, sizeof marked->routine.run);
    return &marked->routine;
}

static void free_marked(struct code_arena *where, struct routine *routine)
{
    struct marked *marked = (struct marked *)routine;
    code_free(where, &marked->span);
    free(marked);
}

static struct engine marked_engine(const struct engine *engine)
{
    struct engine marked = *engine;
    marked.build = build_marked;
    marked.free = free_marked;
    return marked;
}

static void run_routines(void *context, enum unit unit, const union key *key)
{
    const struct engine stages = marked_engine(&engine_stitch);
    const struct engine operations = marked_engine(&engine_stitch_operation);
    const struct engine *engines[] = {&engine_specialize, &stages, &operations};
    (void)context;
    const char *found = differential_run(differential, engines, 3, unit, key, seed++);
    if (found)
        TEST_FAIL_MESSAGE(found);
}

/* The part of a key that stage fragments cover; of pixel keys, sometimes without varyings. */
static void run_stages(void *context, enum unit unit, const union key *key)
{
    const struct engine stages = marked_engine(&engine_stitch);
    const struct engine *engines[] = {&engine_specialize, &stages};
    union key covered = *key;
    (void)context;
    if (unit == UNIT_PIXEL && seed % 8 == 0)
        memset(covered.pixel.varying, INTERPOLATION_NONE, sizeof covered.pixel.varying);
    stages_reduce(unit, &covered);
    const char *found = differential_run(differential, engines, 2, unit, &covered, seed++);
    if (found)
        TEST_FAIL_MESSAGE(found);
}

/* --- Marked programs --------------------------------------------------------------------------------- */

static void run_program(uint64_t number)
{
    static struct ir ir;
    static struct program_data expected, got;
    struct error error = {{0}};
    uint64_t random = (seed ^ number * 0x9e3779b97f4a7c15ull) | 1;
    struct plan *plan = plan_take(&error);
    struct code_span span;
    TEST_ASSERT_NOT_NULL_MESSAGE(plan, error.text);
    if (number % 3)
        stitched_make_fusing(&ir, 120, &random);
    else
        program_make_loops(&ir, 60, &random);
    program_fill(&expected, &random);
    got = expected;
    program_interpret(&ir, &expected, 8);
    stitched_plan(plan, &ir);
    add_marks(plan);
    TEST_ASSERT_EQUAL_MESSAGE(0, plan_join(plan, arena, &span, &error), error.text);
    plan_give(plan);
    routine_function *run;
    memcpy(&run, &(const void *){span.executable}, sizeof run);
    struct vertex_arguments call = {&got.job, got.input, got.output, PROGRAM_LANES};
    run(&call, NULL);
    code_free(arena, &span);
    TEST_ASSERT_EQUAL(-1, program_difference(&expected, &got));
}

/* With a part of the cases, a few fragments have no use. */
static void expect_all_marked(void)
{
    static char missing[2000];
    unsigned count = 0;
    size_t length = 0;
    for (unsigned n = 0; n < fragment_count(); n++)
        if (!marks[n] && ++count && length < sizeof missing)
            length += (size_t)snprintf(missing + length, sizeof missing - length, " %s",
                                       __start_stitch_fragments[n].name);
    if (count > (test_stride() > 1 ? 20 : 0))
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", missing, "never executed");
}

static void every_fragment_is_executed(void)
{
    visit_random_keys(test_share_of(RANDOM_KEYS, 19), seed, run_stages, NULL);
    visit_shaders(seed, run_routines, NULL);
    visit_random_shaders(test_share_of(RANDOM_SHADERS, 9), seed, run_routines, NULL);
    visit_streams(run_routines, NULL);
    for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 9); n++)
        run_program(n);
    expect_all_marked();
}

void setUp(void)
{
    struct error error = {{0}};
    if (engine_unavailable(&engine_stitch))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_stitch));
    TEST_ASSERT_LESS_OR_EQUAL(MARKS, fragment_count());
    marks = mmap(NULL, MARKS, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_32BIT, -1, 0);
    TEST_ASSERT_TRUE(marks != MAP_FAILED);
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
    seed = test_seed();
}

void tearDown(void)
{
    differential_destroy(differential);
    code_destroy(arena);
    differential = NULL;
    arena = NULL;
}

int main(void)
{
    visit_fewer();
    UNITY_BEGIN();
    RUN_TEST(every_fragment_is_executed);
    return UNITY_END();
}
