/* Loops, nested regions and variables: random programs have the same results after every pass and every
 * combination of passes, and machine code with any number of registers has the results of the interpreter.
 * Further tests check the purpose of each pass. */
#include "base/bits.h"
#include "machine/code.h"
#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "contract/lane.h"
#include "ir/bind.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stdio.h>

enum { PROGRAMS = 700 };

static struct code_arena *arena;
static struct builder *builder;
static struct program_data expected, got;
static char message[200];

void setUp(void)
{
    struct error error = {{0}};
    arena = code_create(0, NULL, &error);
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
}

void tearDown(void)
{
    specialize_give(builder);
    code_destroy(arena);
}

static void verify_after(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    (void)changed;
    const char *wrong = ir_verify(ir);
    if (!wrong)
        return;
    snprintf(message, sizeof message, "program %u after pass %u: %s", *(const unsigned *)context,
             (unsigned)pass, wrong);
    TEST_FAIL_MESSAGE(message);
}

static void fail_if_different(const char *what, unsigned number)
{
    int at = program_difference(&expected, &got);
    if (at < 0)
        return;
    snprintf(message, sizeof message, "%s, program %u: lane %d of slot %d: expected %08x, got %08x", what,
             number, at % VERTEX_CAPACITY, at / VERTEX_CAPACITY, bits_of_float(expected.output[at]),
             bits_of_float(got.output[at]));
    TEST_FAIL_MESSAGE(message);
}

static void make(unsigned number, unsigned width)
{
    uint64_t seed = number * 0x9e3779b97f4a7c15ull | 1;
    program_make_loops(&builder->ir, 5 + program_random(&seed) % 50, &seed);
    TEST_ASSERT_NULL(ir_verify(&builder->ir));
    program_fill(&expected, &seed);
    got = expected;
    program_interpret(&builder->ir, &expected, width);
}

static void optimize_verified(unsigned number, enum profile profile, uint32_t disabled)
{
    unsigned saved = mxcsr_enter();
    pass_run_all(&builder->ir, &builder->pass, pass_select(profile, number % 2 << PASS_unroll, disabled),
                 verify_after, &number);
    mxcsr_leave(saved);
    const char *wrong = ir_verify(&builder->ir);
    TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
}

static void check_optimized(unsigned number, enum profile profile, uint32_t disabled, const char *what)
{
    make(number, 8);
    optimize_verified(number, profile, disabled);
    program_interpret(&builder->ir, &got, 8);
    fail_if_different(what, number);
}

static void test_all_passes_keep_results(void)
{
    for (unsigned n = 1; n <= test_share_of(PROGRAMS, 8); n++) {
        check_optimized(n, PROFILE_FULL, 0, "full profile");
        check_optimized(n, PROFILE_THESIS, 0, "thesis profile");
    }
}

static void test_any_set_of_passes_keeps_results(void)
{
    for (unsigned pass = 0; pass < PASS_COUNT; pass++)
        for (unsigned n = 1; n <= test_share_of(PROGRAMS / 8, 8); n++) {
            check_optimized(n, PROFILE_FULL, ~(1u << pass), "one pass");
            check_optimized(n, PROFILE_FULL, 1u << pass, "all but one pass");
        }
    for (unsigned n = 1; n <= test_share_of(PROGRAMS, 8); n++)
        check_optimized(n, PROFILE_FULL, n, "a set of passes");
}

static void test_machine_code_equals_the_interpreter(void)
{
    static const uint32_t disabled[] = {0, ~0u,
                                        0, 1u << PASS_phi,
                                        0, 1u << PASS_copy | 1u << PASS_fold,
                                        0, 1u << PASS_phi | 1u << PASS_reduce | 1u << PASS_common};
    static const uint8_t registers[] = {4, 5, 7, 10, ALLOCATABLE};
    struct error error = {{0}};
    uint32_t spills = 0;
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    for (unsigned n = 1; n <= test_share_of(2 * PROGRAMS, 8); n++)
        for (unsigned r = n % 2; r < sizeof registers; r += 2) {
            unsigned width = program_width(n);
            make(n, width);
            optimize_verified(n, n % 7 ? PROFILE_FULL : PROFILE_THESIS, disabled[n % 8]);
            TEST_ASSERT_EQUAL_MESSAGE(
                0, program_compile_and_run(builder, arena, width, registers[r], &got, &error), error.text);
            char what[64];
            snprintf(what, sizeof what, "%u lanes, %u registers", width, registers[r]);
            fail_if_different(what, n);
            spills += builder->allocation.spills;
        }
    TEST_ASSERT_GREATER_THAN(test_share_of(1000, 8), spills);
}

/* --- Single passes ------------------------------------------------------------------------------------- */

static struct env environment;

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

static uint32_t position_of(enum ir_op op)
{
    uint32_t number = 1;
    while (number < builder->ir.count && builder->ir.instruction[number].op != op)
        number++;
    TEST_ASSERT_LESS_THAN_MESSAGE(builder->ir.count, number, ir_op_information[op].name);
    return number;
}

/* Optimises the recording, compiles it with each number of registers and compares it with the interpreter. */
static void expect_equal(void)
{
    struct error error = {{0}};
    uint64_t seed = 7;
    TEST_ASSERT_NULL(ir_verify(&builder->ir));
    program_fill(&expected, &seed);
    for (unsigned n = 0; n < PROGRAM_TABLE; n++)
        expected.table[n] = n * 52 & 0x3fc;
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        expected.job.attribute[a].data = (const uint8_t *)expected.table;
    got = expected;
    program_interpret(&builder->ir, &expected, 8);
    optimize_verified(0, PROFILE_FULL, 0);
    for (unsigned registers = 4; cpu_has_avx2_fma() && registers <= ALLOCATABLE; registers += 3) {
        TEST_ASSERT_EQUAL_MESSAGE(0, program_compile_and_run(builder, arena, 8, registers, &got, &error),
                                  error.text);
        fail_if_different("machine code", registers);
    }
}

enum { VALUE, LIVE, COUNT };

/* A loop that ends lane by lane: each lane adds its first value until the sum is at least 100, at most eight
 * times. */
static void record_sums(struct env *e)
{
    flt step = max_f(E, load_f(E, BASE_INPUT, 0), lit_f(E, 1.5f));
    set_f(E, VALUE, step);
    set_m(E, LIVE, lt_f(E, step, lit_f(E, 50)));
    set_i(E, COUNT, lit_i(E, 8));
    LOOP(E, LIVE)
    {
        WHEN (E, get_m(E, LIVE)) {
            flt sum = add_f(E, get_f(E, VALUE), mul_f(E, step, lit_f(E, 2)));
            set_f(E, VALUE, select_f(E, get_m(E, LIVE), sum, get_f(E, VALUE)));
        }
        itg left = sub_i(E, get_i(E, COUNT), lit_i(E, 1));
        set_i(E, COUNT, left);
        msk more = and_m(E, lt_f(E, get_f(E, VALUE), lit_f(E, 100)), gt_i(E, left, lit_i(E, 0)));
        set_m(E, LIVE, and_m(E, get_m(E, LIVE), more));
    }
    store_f(E, BASE_OUTPUT, 0, get_f(E, VALUE));
}

static void test_values_of_a_loop_stay_in_registers_without_moves(void)
{
    const struct ir *ir = &builder->ir;
    record_sums(start());
    expect_equal();
    TEST_ASSERT_EQUAL(0, count_of(IR_set) + count_of(IR_get));
    TEST_ASSERT_EQUAL(3, count_of(IR_phi));
    TEST_ASSERT_EQUAL(0, builder->allocation.slots);
    for (uint32_t n = position_of(IR_next); ir->instruction[n].op == IR_next; n++)
        TEST_ASSERT_EQUAL(allocate_web(&builder->allocation, ir->instruction[n].operand[0]),
                          allocate_web(&builder->allocation, ir->instruction[n].operand[1]));
}

static void test_invariant_values_are_computed_before_the_loop(void)
{
    record_sums(start());
    expect_equal();
    TEST_ASSERT_LESS_THAN(position_of(IR_loop), position_of(IR_mul_f));
}

static void test_invariant_values_leave_all_loops(void)
{
    struct env *e = start();
    set_m(E, LIVE, lit_m(E, 0));
    set_f(E, VALUE, lit_f(E, 0));
    flt start = load_f(E, BASE_INPUT, 0);
    LOOP(E, LIVE)
    {
        flt outer = add_f(E, get_f(E, VALUE), start);
        LOOP(E, LIVE)
        set_f(E, VALUE, add_f(E, get_f(E, VALUE), sub_f(E, sqrt_f(E, start), neg_f(E, outer))));
    }
    store_f(E, BASE_OUTPUT, 0, get_f(E, VALUE));
    expect_equal();
    TEST_ASSERT_LESS_THAN(position_of(IR_loop), position_of(IR_sqrt_f));
    TEST_ASSERT_GREATER_THAN(position_of(IR_loop), position_of(IR_neg_f));
    TEST_ASSERT_GREATER_THAN(position_of(IR_neg_f), position_of(IR_sub_f));
    uint32_t behind = position_of(IR_sub_f) + 1;
    while (builder->ir.instruction[behind].op == IR_phi)
        behind++;
    TEST_ASSERT_EQUAL(IR_loop, builder->ir.instruction[behind].op);
}

/* A read is not moved before a region that may be skipped. */
static void test_reads_are_not_moved_before_their_region(void)
{
    struct env *e = start();
    set_f(E, VALUE, lit_f(E, 0));
    set_m(E, LIVE, lit_m(E, 0));
    itg place = and_i(E, load_i(E, BASE_INPUT, 0), lit_i(E, 0x3fc));
    msk some = gt_i(E, load_i(E, BASE_INPUT, 4 * PROGRAM_LANES), lit_i(E, 0));
    LOOP(E, LIVE)
    {
        WHEN (E, some) {
            flt word = gather_f(E, BASE_JOB, offsetof(struct job, attribute[0].data), place, 1, 0);
            set_f(E, VALUE, add_f(E, get_f(E, VALUE), word));
        }
    }
    store_f(E, BASE_OUTPUT, 0, get_f(E, VALUE));
    expect_equal();
    TEST_ASSERT_GREATER_THAN(position_of(IR_when), position_of(IR_gather));
}

static void test_a_loop_without_results_is_removed(void)
{
    struct env *e = start();
    record_sums(e);
    builder->ir.count--; /* the store */
    store_f(E, BASE_OUTPUT, 0, load_f(E, BASE_INPUT, 0));
    optimize_verified(0, PROFILE_FULL, 0);
    TEST_ASSERT_EQUAL(3, builder->ir.count);
    start();
    record_sums(e);
    builder->ir.count--;
    store_f(E, BASE_OUTPUT, 0, load_f(E, BASE_INPUT, 0));
    optimize_verified(0, PROFILE_THESIS, 0);
    TEST_ASSERT_EQUAL(3, builder->ir.count);
}

/* Sets without effect, in nested loops. */
static void test_a_phi_of_one_value_is_that_value(void)
{
    struct env *e = start();
    flt value = load_f(E, BASE_INPUT, 0);
    set_f(E, VALUE, value);
    set_m(E, LIVE, lit_m(E, 0));
    LOOP(E, LIVE)
    {
        LOOP(E, LIVE)
        {
            WHEN (E, lt_f(E, value, lit_f(E, 1)))
                set_f(E, VALUE, get_f(E, VALUE));
            store_f(E, BASE_OUTPUT, 0, get_f(E, VALUE));
        }
        set_f(E, VALUE, value);
    }
    expect_equal();
    TEST_ASSERT_EQUAL(0, count_of(IR_phi) + count_of(IR_join) + count_of(IR_when));
}

static void test_a_region_with_a_literal_condition_is_removed(void)
{
    struct env *e = start();
    flt value = load_f(E, BASE_INPUT, 0);
    set_f(E, VALUE, value);
    WHEN (E, lit_m(E, -1))
        WHEN (E, lit_m(E, 0)) {
            store_f(E, BASE_OUTPUT, 0, value);
            set_f(E, VALUE, neg_f(E, value));
        }
    WHEN (E, lit_m(E, -1))
        set_f(E, VALUE, sqrt_f(E, get_f(E, VALUE)));
    store_f(E, BASE_OUTPUT, VERTEX_SLOT_BYTES, get_f(E, VALUE));
    expect_equal();
    TEST_ASSERT_EQUAL(4, builder->ir.count);
    TEST_ASSERT_EQUAL(IR_sqrt_f, builder->ir.instruction[2].op);
}

/* 36 joins of one region, of values that stay alive: some are evicted for others. */
static void change_everything(int regions)
{
    enum { MANY = 36 };
    struct env *e = start();
    flt before[MANY], value[MANY], sum = lit_f(E, 0);
    for (int v = 0; v < MANY; v++)
        set_f(E, v, before[v] = add_f(E, load_f(E, BASE_INPUT, 0), lit_f(E, (float)v)));
    for (int region = 0; region < regions; region++)
        WHEN (E, lt_f(E, load_f(E, BASE_INPUT, 4 * PROGRAM_LANES * region), lit_f(E, -3.5f))) {
            for (int v = 0; v < MANY; v++)
                value[v] = get_f(E, v);
            for (int v = 0; v < MANY; v++)
                set_f(E, v, v % 3 ? value[(7 * v + 1) % MANY] : add_f(E, value[v], value[(v + 5) % MANY]));
        }
    for (int v = 0; v < MANY; v++)
        sum = sub_f(E, get_f(E, MANY - 1 - v), sum);
    for (int v = 0; v < MANY; v++)
        sum = sub_f(E, before[v], sum);
    store_f(E, BASE_OUTPUT, 0, sum);
    expect_equal();
}

static void test_a_region_that_changes_everything(void)
{
    change_everything(1);
}

static void test_two_regions_that_change_everything(void)
{
    change_everything(2);
}

/* Each gathered word is the next index, so the index and the result must not share a register. */
static void test_a_gather_whose_index_was_gathered(void)
{
    struct env *e = start();
    set_i(E, VALUE, and_i(E, load_i(E, BASE_INPUT, 0), lit_i(E, 0x3fc)));
    set_i(E, COUNT, lit_i(E, 5));
    LOOP(E, LIVE)
    {
        set_i(E, VALUE,
              gather_i(E, BASE_JOB, offsetof(struct job, attribute[0].data), get_i(E, VALUE), 1, 0));
        itg left = sub_i(E, get_i(E, COUNT), lit_i(E, 1));
        set_i(E, COUNT, left);
        set_m(E, LIVE, gt_i(E, left, lit_i(E, 0)));
    }
    store_i(E, BASE_OUTPUT, 0, get_i(E, VALUE));
    expect_equal();
}

static void test_a_literal_that_needs_a_register_is_loaded_before_the_loop(void)
{
    struct env *e = start();
    set_f(E, VALUE, load_f(E, BASE_INPUT, 0));
    set_i(E, COUNT, lit_i(E, 5));
    LOOP(E, LIVE)
    {
        set_f(E, VALUE, sub_f(E, lit_f(E, 3), get_f(E, VALUE)));
        itg left = sub_i(E, get_i(E, COUNT), lit_i(E, 1));
        set_i(E, COUNT, left);
        set_m(E, LIVE, gt_i(E, left, lit_i(E, 0)));
    }
    store_f(E, BASE_OUTPUT, 0, get_f(E, VALUE));
    expect_equal();
    TEST_ASSERT_LESS_THAN(position_of(IR_loop), position_of(IR_copy));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_all_passes_keep_results);
    RUN_TEST(test_any_set_of_passes_keeps_results);
    RUN_TEST(test_machine_code_equals_the_interpreter);
    RUN_TEST(test_values_of_a_loop_stay_in_registers_without_moves);
    RUN_TEST(test_invariant_values_are_computed_before_the_loop);
    RUN_TEST(test_invariant_values_leave_all_loops);
    RUN_TEST(test_reads_are_not_moved_before_their_region);
    RUN_TEST(test_a_loop_without_results_is_removed);
    RUN_TEST(test_a_phi_of_one_value_is_that_value);
    RUN_TEST(test_a_region_with_a_literal_condition_is_removed);
    RUN_TEST(test_a_region_that_changes_everything);
    RUN_TEST(test_two_regions_that_change_everything);
    RUN_TEST(test_a_gather_whose_index_was_gathered);
    RUN_TEST(test_a_literal_that_needs_a_register_is_loaded_before_the_loop);
    return UNITY_END();
}
