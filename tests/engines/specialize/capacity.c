/* Programs at the limits of the specializer: programs within a limit run correctly, programs beyond it are
 * refused with a reason. */
#include "machine/code.h"
#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "tests/support/shader/program.h"
#include <unity.h>

#include <string.h>

static struct code_arena *arena;
static struct builder *builder;
static struct program_data expected, got;
static struct error error;

void setUp(void)
{
    memset(&error, 0, sizeof error);
    arena = code_create(0, NULL, &error);
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    ir_start(&builder->ir);
}

void tearDown(void)
{
    specialize_give(builder);
    code_destroy(arena);
}

static uint16_t literal(uint32_t bits)
{
    return ir_append(&builder->ir,
                     (struct ir_instruction){.op = IR_literal, .type = TYPE_itg, .k = (int32_t)bits});
}

static uint16_t load(int array)
{
    return ir_append(&builder->ir, (struct ir_instruction){.op = IR_load,
                                                           .type = TYPE_itg,
                                                           .base = BASE_INPUT,
                                                           .k = array * PROGRAM_LANES * 4});
}

static uint16_t binary(enum ir_op op, uint16_t a, uint16_t b)
{
    return ir_append(
        &builder->ir,
        (struct ir_instruction){.op = (uint8_t)op, .type = ir_op_information[op].result, .operand = {a, b}});
}

static void store(uint16_t value)
{
    ir_append(&builder->ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {value}});
}

static void effect(enum ir_op op, uint16_t a)
{
    ir_append(&builder->ir, (struct ir_instruction){.op = (uint8_t)op, .operand = {a}});
}

static void set(int variable, uint16_t value)
{
    ir_append(&builder->ir,
              (struct ir_instruction){.op = IR_set, .type = TYPE_itg, .operand = {value}, .k = variable});
}

static uint16_t get(int variable)
{
    return ir_append(&builder->ir, (struct ir_instruction){.op = IR_get, .type = TYPE_itg, .k = variable});
}

/* Ends a loop that variable `counter` counts down. */
static void again(int counter)
{
    uint16_t less = binary(IR_sub_i, get(counter), literal(1));
    set(counter, less);
    effect(IR_again, binary(IR_gt_i, less, literal(0)));
}

static int compile_and_run(void)
{
    uint64_t seed = 1;
    TEST_ASSERT_FALSE(builder->ir.overflow);
    TEST_ASSERT_NULL(ir_verify(&builder->ir));
    program_fill(&expected, &seed);
    got = expected;
    program_interpret(&builder->ir, &expected, 8);
    return program_compile_and_run(builder, arena, 8, ALLOCATABLE, &got, &error);
}

static void expect_equal(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(0, compile_and_run(), error.text);
    TEST_ASSERT_EQUAL(-1, program_difference(&expected, &got));
}

/* The same after all passes. */
static void expect_equal_optimized(void)
{
    uint64_t seed = 1;
    TEST_ASSERT_FALSE(builder->ir.overflow);
    TEST_ASSERT_NULL(ir_verify(&builder->ir));
    program_fill(&expected, &seed);
    got = expected;
    program_interpret(&builder->ir, &expected, 8);
    unsigned saved = mxcsr_enter();
    pass_run_all(&builder->ir, &builder->pass, pass_select(PROFILE_FULL, 0, 0), NULL, NULL);
    mxcsr_leave(saved);
    TEST_ASSERT_NULL(ir_verify(&builder->ir));
    int result = program_compile_and_run(builder, arena, 8, ALLOCATABLE, &got, &error);
    TEST_ASSERT_EQUAL_MESSAGE(0, result, error.text);
    TEST_ASSERT_EQUAL(-1, program_difference(&expected, &got));
}

static void expect_refusal(const char *reason)
{
    TEST_ASSERT_EQUAL(-1, compile_and_run());
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, reason), error.text);
}

/* All values are different, and all are used after the last one is computed. */
static void keep_alive(int count)
{
    static uint16_t alive[IR_CAPACITY];
    alive[0] = binary(IR_add_i, load(0), load(1));
    uint16_t step = literal(0x9e3779b9);
    for (int i = 1; i < count; i++)
        alive[i] = binary(IR_add_i, alive[i - 1], step);
    uint16_t sum = alive[0];
    for (int i = 1; i < count; i++)
        sum = binary(i % 2 ? IR_xor_i : IR_add_i, sum, alive[i]);
    store(sum);
    expect_equal();
    TEST_ASSERT_GREATER_THAN(count - ALLOCATABLE - 10, builder->allocation.slots);
}

/* A stack frame whose pages are touched by straight-line code. */
static void test_a_thousand_values_can_be_alive_together(void)
{
    keep_alive(1000);
}

/* A stack frame of 640 KiB, touched in a loop. */
static void test_twenty_thousand_values_can_be_alive_together(void)
{
    keep_alive(20000);
}

/* Each operation reads two values, so the program has the largest possible number of them. */
static void test_too_many_spilled_values_are_refused(void)
{
    enum { LANES = 16, ALIVE = SPILL_BYTES / (LANES * 4) + 2 * ALLOCATABLE + 1 };
    static uint16_t alive[ALIVE];
    uint16_t sum = load(0), step = load(1);
    builder->ir.instruction[sum].type = builder->ir.instruction[step].type = TYPE_flt;
    alive[0] = sum;
    for (int i = 1; i < ALIVE; i++)
        alive[i] = binary(IR_add_f, alive[i - 1], step);
    for (int i = 1; i + 1 < ALIVE; i += 2)
        sum = ir_append(&builder->ir, (struct ir_instruction){.op = IR_mad_f,
                                                              .type = TYPE_flt,
                                                              .operand = {alive[i], alive[i + 1], sum}});
    store(sum);
    TEST_ASSERT_EQUAL(-1, program_compile_and_run(builder, arena, LANES, ALLOCATABLE, &got, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "too many spill slots, expected at most 32768"),
                                 error.text);
}

static void test_every_value_of_the_longest_program_has_a_home(void)
{
    const struct register_file file = {.allocator = ALLOCATOR_none};
    uint64_t seed = 1;
    uint16_t sum = load(0), step = load(1);
    while (builder->ir.count + 2 < IR_CAPACITY)
        sum = binary(IR_add_i, sum, step);
    store(sum);
    program_fill(&expected, &seed);
    got = expected;
    program_interpret(&builder->ir, &expected, 8);
    TEST_ASSERT_EQUAL_MESSAGE(0, program_compile_with(builder, arena, 8, &file, &got, &error), error.text);
    TEST_ASSERT_EQUAL(-1, program_difference(&expected, &got));
    TEST_ASSERT_GREATER_THAN(IR_CAPACITY - 10, builder->allocation.slots);
}

static void test_a_program_of_twenty_thousand_operations(void)
{
    uint64_t seed = 0x20000;
    program_make(&builder->ir, 20000, &seed);
    TEST_ASSERT_GREATER_THAN(20000, builder->ir.count);
    program_fill(&expected, &seed);
    got = expected;
    program_interpret(&builder->ir, &expected, 8);
    unsigned saved = mxcsr_enter();
    pass_run_all(&builder->ir, &builder->pass, pass_select(PROFILE_FULL, 0, 0), NULL, NULL);
    mxcsr_leave(saved);
    int result = program_compile_and_run(builder, arena, 8, ALLOCATABLE, &got, &error);
    TEST_ASSERT_EQUAL_MESSAGE(0, result, error.text);
    TEST_ASSERT_EQUAL(-1, program_difference(&expected, &got));
}

static void add_literals(int count)
{
    uint16_t sum = load(0);
    for (int i = 0; i < count; i++)
        sum = binary(IR_xor_i, sum, literal(0x1000u + (uint32_t)i));
    store(sum);
}

static void test_the_largest_number_of_literals(void)
{
    add_literals(LITERAL_CAPACITY);
    expect_equal();
}

static void test_too_many_literals_are_refused(void)
{
    add_literals(LITERAL_CAPACITY + 100);
    expect_refusal("literals");
}

static void nest(int depth)
{
    uint16_t value = load(0), mask = binary(IR_gt_i, value, load(1));
    for (int i = 0; i < depth; i++)
        ir_append(&builder->ir, (struct ir_instruction){.op = IR_when, .operand = {mask}});
    store(value);
    for (int i = 0; i < depth; i++)
        ir_append(&builder->ir, (struct ir_instruction){.op = IR_end});
}

static void test_deep_regions(void)
{
    nest(REGION_DEPTH);
    expect_equal();
}

static void test_regions_too_deep_are_refused(void)
{
    nest(REGION_DEPTH + 1);
    expect_refusal("regions");
}

static void test_too_many_regions_are_refused(void)
{
    uint16_t value = load(0), mask = binary(IR_gt_i, value, load(1));
    for (int i = 0; i <= REGION_CAPACITY; i++) {
        ir_append(&builder->ir, (struct ir_instruction){.op = IR_when, .operand = {mask}});
        store(value);
        ir_append(&builder->ir, (struct ir_instruction){.op = IR_end});
    }
    expect_refusal("regions");
}

/* In each of five iterations of a loop, every variable becomes the next one. */
static void rotate_variables(void)
{
    enum { COUNTER = VARIABLES - 1 };
    static uint16_t value[VARIABLES];
    uint16_t step = literal(0x9e3779b9), sum = load(0);
    for (int v = 0; v < COUNTER; v++)
        set(v, sum = binary(IR_add_i, sum, step));
    set(COUNTER, literal(5));
    effect(IR_loop, 0);
    for (int v = 0; v < COUNTER; v++)
        value[v] = get(v);
    for (int v = 0; v < COUNTER; v++)
        set(v, value[(v + 1) % COUNTER]);
    again(COUNTER);
    for (int v = 0; v < COUNTER; v++)
        sum = binary(v % 2 ? IR_xor_i : IR_add_i, sum, get(v));
    store(sum);
}

static void test_all_variables_can_be_exchanged(void)
{
    rotate_variables();
    expect_equal();
    ir_start(&builder->ir);
    rotate_variables();
    expect_equal_optimized();
}

static void test_deep_loops(void)
{
    uint16_t never = binary(IR_gt_i, literal(0), literal(0));
    set(0, load(0));
    for (int i = 0; i < REGION_DEPTH; i++)
        effect(IR_loop, 0);
    set(0, binary(IR_add_i, get(0), load(1)));
    for (int i = 0; i < REGION_DEPTH; i++)
        effect(IR_again, never);
    store(get(0));
    expect_equal_optimized();
}

/* The longest possible recording, of loops, regions and sets. */
static void test_the_longest_recording_of_loops(void)
{
    uint16_t mask = binary(IR_gt_i, load(0), load(1));
    for (int v = 0; v < 64; v++)
        set(v, load(v % PROGRAM_ARRAYS));
    for (int n = 0; builder->ir.count + 40 < IR_CAPACITY; n++) {
        set(64, literal(2));
        effect(IR_loop, 0);
        for (int inner = 0; inner < 2; inner++) {
            effect(IR_when, mask);
            set((n + inner) % 64, binary(IR_add_i, get(n % 64), get((n + 7) % 64)));
            effect(IR_end, 0);
        }
        again(64);
    }
    for (int v = 0; v < 8; v++)
        store(get(v));
    expect_equal_optimized();
}

static void test_recording_beyond_the_capacity_is_reported(void)
{
    while (builder->ir.count < IR_CAPACITY)
        TEST_ASSERT_NOT_EQUAL(0, literal(1));
    TEST_ASSERT_FALSE(builder->ir.overflow);
    TEST_ASSERT_EQUAL(0, literal(1));
    TEST_ASSERT_TRUE(builder->ir.overflow);
    TEST_ASSERT_EQUAL(IR_CAPACITY, builder->ir.count);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_thousand_values_can_be_alive_together);
    RUN_TEST(test_twenty_thousand_values_can_be_alive_together);
    RUN_TEST(test_too_many_spilled_values_are_refused);
    RUN_TEST(test_every_value_of_the_longest_program_has_a_home);
    RUN_TEST(test_a_program_of_twenty_thousand_operations);
    RUN_TEST(test_the_largest_number_of_literals);
    RUN_TEST(test_too_many_literals_are_refused);
    RUN_TEST(test_deep_regions);
    RUN_TEST(test_regions_too_deep_are_refused);
    RUN_TEST(test_too_many_regions_are_refused);
    RUN_TEST(test_all_variables_can_be_exchanged);
    RUN_TEST(test_deep_loops);
    RUN_TEST(test_the_longest_recording_of_loops);
    RUN_TEST(test_recording_beyond_the_capacity_is_reported);
    return UNITY_END();
}
