/* Unrolling: which loops become their iterations, with the results of the loop, and which stay. */
#include "machine/code.h"
#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "base/bits.h"
#include "contract/lane.h"
#include "ir/bind.h"
#include "tests/support/shader/program.h"
#include <unity.h>

#include <stdio.h>

enum { VALUE, LIVE, COUNT, INNER, INNER_COUNT, PROGRAMS = 500 };

static struct builder *builder;
static struct program_data expected, got;
static struct env environment;

void setUp(void)
{
    struct error error = {""};
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
}

void tearDown(void)
{
    specialize_give(builder);
}

static struct env *start(void)
{
    ir_start(&builder->ir);
    environment = (struct env){.ir = &builder->ir};
    return &environment;
}

static unsigned count_of(enum ir_op op)
{
    unsigned n = 0;
    for (uint32_t number = 1; number < builder->ir.count; number++)
        n += builder->ir.instruction[number].op == op;
    return n;
}

static void optimize(uint32_t passes)
{
    unsigned saved = mxcsr_enter();
    builder->pass.lanes = 8;
    builder->pass.parts = 1;
    pass_run_all(&builder->ir, &builder->pass, passes, NULL, NULL);
    mxcsr_leave(saved);
    TEST_ASSERT_NULL(ir_verify(&builder->ir));
}

/* Runs the passes on the recording and compares its results. */
static void expect_equal(uint32_t passes)
{
    char message[100];
    uint64_t seed = 7;
    TEST_ASSERT_NULL(ir_verify(&builder->ir));
    program_fill(&expected, &seed);
    got = expected;
    program_interpret(&builder->ir, &expected, 8);
    optimize(passes);
    program_interpret(&builder->ir, &got, 8);
    int at = program_difference(&expected, &got);
    snprintf(message, sizeof message, "lane %d of slot %d", at % VERTEX_CAPACITY, at / VERTEX_CAPACITY);
    TEST_ASSERT_TRUE_MESSAGE(at < 0, message);
}

static uint32_t unroll(void)
{
    return 1u << PASS_unroll;
}

static uint32_t all(void)
{
    return pass_select(PROFILE_FULL, unroll(), 0);
}

/* --- The forms of loops -------------------------------------------------------------------------------- */

static void double_value(struct env *e)
{
    set_f(E, VALUE, add_f(E, get_f(E, VALUE), get_f(E, VALUE)));
}

/* As the specification records a loop of a shader: `mask` is of the lanes that execute it. */
static void begin_count(struct env *e, itg count, msk mask)
{
    set_i(E, COUNT, count);
    set_m(E, LIVE, and_m(E, gt_i(E, count, lit_i(E, 0)), mask));
}

static void count_down(struct env *e)
{
    itg fewer = add_i(E, get_i(E, COUNT), lit_i(E, -1));
    set_i(E, COUNT, fewer);
    set_m(E, LIVE, and_m(E, get_m(E, LIVE), gt_i(E, fewer, lit_i(E, 0))));
}

static void record_loop(struct env *e, itg count, msk mask)
{
    set_f(E, VALUE, load_f(E, BASE_INPUT, 0));
    begin_count(E, count, mask);
    WHEN (E, get_m(E, LIVE)) {
        LOOP(E, LIVE)
        {
            double_value(E);
            count_down(E);
        }
    }
    store_f(E, BASE_OUTPUT, 0, get_f(E, VALUE));
}

static void a_constant_loop_becomes_its_iterations(void)
{
    struct env *e = start();
    record_loop(E, lit_i(E, 5), lit_m(E, -1));
    expect_equal(unroll());
    TEST_ASSERT_EQUAL(0, count_of(IR_loop) + count_of(IR_again));
    TEST_ASSERT_EQUAL(5, count_of(IR_add_f));
    TEST_ASSERT_EQUAL(0, builder->ir.loops);
}

/* All other passes remove what counts. */
static void nothing_but_the_iterations_stays(void)
{
    struct env *e = start();
    record_loop(E, lit_i(E, 5), lit_m(E, -1));
    expect_equal(all());
    TEST_ASSERT_EQUAL(1 + 1 + 5 + 1, builder->ir.count); /* nop, load, add_f, store */
}

static void a_loop_in_a_region_is_unrolled_if_its_mask_is_the_regions(void)
{
    struct env *e = start();
    record_loop(E, lit_i(E, 3), lt_f(E, load_f(E, BASE_INPUT, 0), lit_f(E, 0)));
    expect_equal(unroll());
    TEST_ASSERT_EQUAL(0, count_of(IR_loop));
    TEST_ASSERT_EQUAL(1, count_of(IR_when));
    TEST_ASSERT_EQUAL(3, count_of(IR_add_f));
}

static void a_loop_of_one_iteration_is_unrolled(void)
{
    struct env *e = start();
    record_loop(E, lit_i(E, 1), lit_m(E, -1));
    expect_equal(unroll());
    TEST_ASSERT_EQUAL(0, count_of(IR_loop));
    TEST_ASSERT_EQUAL(1, count_of(IR_add_f));
}

static void a_count_that_is_not_constant_stays_a_loop(void)
{
    struct env *e = start();
    itg count = and_i(E, load_i(E, BASE_INPUT, 0), lit_i(E, 7));
    record_loop(E, count, lit_m(E, -1));
    expect_equal(unroll());
    TEST_ASSERT_EQUAL(1, count_of(IR_loop));
}

/* The mask of a region that has ended, and one that the loop changes, do not repeat a loop. */
static void an_unknown_mask_stays_a_loop(void)
{
    struct env *e = start();
    msk some = lt_f(E, load_f(E, BASE_INPUT, 0), lit_f(E, 0));
    set_f(E, VALUE, lit_f(E, 1));
    begin_count(E, lit_i(E, 3), some);
    WHEN (E, some)
        double_value(E);
    LOOP(E, LIVE)
    {
        double_value(E);
        count_down(E);
    }
    store_f(E, BASE_OUTPUT, 0, get_f(E, VALUE));
    expect_equal(unroll());
    TEST_ASSERT_EQUAL(1, count_of(IR_loop));
}

static void a_loop_that_lanes_leave_stays_a_loop(void)
{
    struct env *e = start();
    set_f(E, VALUE, load_f(E, BASE_INPUT, 0));
    begin_count(E, lit_i(E, 4), lit_m(E, -1));
    LOOP(E, LIVE)
    {
        double_value(E);
        set_m(E, LIVE, and_m(E, get_m(E, LIVE), lt_f(E, get_f(E, VALUE), lit_f(E, 100))));
        count_down(E);
    }
    store_f(E, BASE_OUTPUT, 0, get_f(E, VALUE));
    expect_equal(unroll());
    TEST_ASSERT_EQUAL(1, count_of(IR_loop));
}

/* The count is set again in a region that may be skipped. */
static void a_count_that_a_region_changes_stays_a_loop(void)
{
    struct env *e = start();
    msk some = lt_f(E, load_f(E, BASE_INPUT, 0), lit_f(E, 0));
    set_f(E, VALUE, load_f(E, BASE_INPUT, 0));
    begin_count(E, lit_i(E, 4), lit_m(E, -1));
    WHEN (E, some)
        set_i(E, COUNT, lit_i(E, 2));
    LOOP(E, LIVE)
    {
        double_value(E);
        count_down(E);
        WHEN (E, some)
            set_m(E, LIVE, lit_m(E, 0));
    }
    store_f(E, BASE_OUTPUT, 0, get_f(E, VALUE));
    expect_equal(unroll());
    TEST_ASSERT_EQUAL(1, count_of(IR_loop));
}

/* The inner count is set once; the second iteration of the outer loop finds what the first has left. */
static void record_nested(struct env *e, bool begins_anew)
{
    set_f(E, VALUE, load_f(E, BASE_INPUT, 0));
    begin_count(E, lit_i(E, 3), lit_m(E, -1));
    set_i(E, INNER_COUNT, lit_i(E, 4));
    LOOP(E, LIVE)
    {
        if (begins_anew)
            set_i(E, INNER_COUNT, lit_i(E, 4));
        LOOP(E, INNER)
        {
            double_value(E);
            itg fewer = add_i(E, get_i(E, INNER_COUNT), lit_i(E, -1));
            set_i(E, INNER_COUNT, fewer);
            set_m(E, INNER, gt_i(E, fewer, lit_i(E, 0)));
        }
        count_down(E);
    }
    store_f(E, BASE_OUTPUT, 0, get_f(E, VALUE));
}

static void nested_loops_are_unrolled(void)
{
    record_nested(start(), true);
    expect_equal(unroll());
    TEST_ASSERT_EQUAL(0, count_of(IR_loop));
    TEST_ASSERT_EQUAL(12, count_of(IR_add_f));
}

static void what_an_outer_loop_changes_is_unknown(void)
{
    record_nested(start(), false);
    expect_equal(unroll());
    TEST_ASSERT_EQUAL(2, count_of(IR_loop));
}

/* A value of the loop that is used after it is that of the last iteration. */
static void values_leave_the_loop(void)
{
    struct env *e = start();
    flt last = {0};
    set_f(E, VALUE, load_f(E, BASE_INPUT, 0));
    begin_count(E, lit_i(E, 3), lit_m(E, -1));
    LOOP(E, LIVE)
    {
        last = mul_f(E, get_f(E, VALUE), lit_f(E, 3));
        set_f(E, VALUE, last);
        count_down(E);
    }
    store_f(E, BASE_OUTPUT, 0, last);
    expect_equal(unroll());
    TEST_ASSERT_EQUAL(0, count_of(IR_loop));
}

/* --- Limits -------------------------------------------------------------------------------------------- */

/* Returns the length of the program that a loop of `count` iterations becomes. */
static uint32_t length_of(int count)
{
    struct env *e = start();
    record_loop(E, lit_i(E, count), lit_m(E, -1));
    optimize(unroll());
    return builder->ir.count;
}

static void long_loops_stay(void)
{
    uint32_t loop = length_of(1 << 20);
    TEST_ASSERT_EQUAL(1, count_of(IR_loop));
    TEST_ASSERT_LESS_THAN(50, loop);
    TEST_ASSERT_LESS_THAN(2100, length_of(100));
    TEST_ASSERT_EQUAL(0, count_of(IR_loop));
    length_of(200);
    TEST_ASSERT_EQUAL(1, count_of(IR_loop));
}

static void a_program_grows_to_a_limit(void)
{
    struct env *e = start();
    for (int n = 0; n < 100; n++)
        record_loop(E, lit_i(E, 100), lit_m(E, -1));
    optimize(unroll());
    TEST_ASSERT_LESS_OR_EQUAL(16384, builder->ir.count);
    TEST_ASSERT_GREATER_THAN(10000, builder->ir.count);
    TEST_ASSERT_GREATER_THAN(50, count_of(IR_loop));
    TEST_ASSERT_LESS_THAN(99, count_of(IR_loop));
}

static void an_endless_loop_stays(void)
{
    struct env *e = start();
    set_m(E, LIVE, lit_m(E, -1));
    LOOP(E, LIVE)
    set_f(E, VALUE, lit_f(E, 1));
    optimize(unroll());
    TEST_ASSERT_EQUAL(1, count_of(IR_loop));
}

static void deep_regions_stay(void)
{
    struct env *e = start();
    msk some = lt_f(E, load_f(E, BASE_INPUT, 0), lit_f(E, 0));
    for (int n = 0; n < 1000; n++)
        ir_append(e->ir, (struct ir_instruction){.op = IR_when, .operand = {some.id}});
    record_loop(E, lit_i(E, 3), lit_m(E, -1));
    for (int n = 0; n < 1000; n++)
        ir_append(e->ir, (struct ir_instruction){.op = IR_end});
    optimize(unroll());
    TEST_ASSERT_EQUAL(1, count_of(IR_loop));
}

/* --- Random programs ----------------------------------------------------------------------------------- */

/* The passes of variants with the pass: by itself, with all, with those of the thesis, and without some. */
static void random_programs_keep_their_results(void)
{
    const uint32_t sets[] = {unroll(), all(), pass_select(PROFILE_THESIS, unroll(), 0),
                             all() & ~(1u << PASS_phi), all() & ~(1u << PASS_fold)};
    unsigned unrolled = 0;
    for (unsigned n = 1; n <= PROGRAMS; n++)
        for (size_t s = 0; s < sizeof sets / sizeof *sets; s++) {
            uint64_t seed = n * 0x9e3779b97f4a7c15ull | 1;
            program_make_counted(&builder->ir, 5 + program_random(&seed) % 50, &seed);
            uint32_t loops = builder->ir.loops;
            expect_equal(sets[s]);
            unrolled += loops - builder->ir.loops;
        }
    TEST_ASSERT_GREATER_THAN(PROGRAMS / 4, unrolled);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(random_programs_keep_their_results);
    RUN_TEST(a_constant_loop_becomes_its_iterations);
    RUN_TEST(nothing_but_the_iterations_stays);
    RUN_TEST(a_loop_in_a_region_is_unrolled_if_its_mask_is_the_regions);
    RUN_TEST(a_loop_of_one_iteration_is_unrolled);
    RUN_TEST(a_count_that_is_not_constant_stays_a_loop);
    RUN_TEST(an_unknown_mask_stays_a_loop);
    RUN_TEST(a_loop_that_lanes_leave_stays_a_loop);
    RUN_TEST(a_count_that_a_region_changes_stays_a_loop);
    RUN_TEST(nested_loops_are_unrolled);
    RUN_TEST(what_an_outer_loop_changes_is_unknown);
    RUN_TEST(values_leave_the_loop);
    RUN_TEST(long_loops_stay);
    RUN_TEST(a_program_grows_to_a_limit);
    RUN_TEST(an_endless_loop_stays);
    RUN_TEST(deep_regions_stay);
    return UNITY_END();
}
