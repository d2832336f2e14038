/* Passes and allocation on random programs: results stay the same to the bit after each pass, after all of
 * them, and with any number of registers. Further tests check the rules of single passes. */
#include "base/bits.h"
#include "machine/code.h"
#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "contract/lane.h"
#include "tests/support/routine/routines.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <math.h>
#include <stdio.h>

enum { PROGRAMS = 3000 };

static struct code_arena *arena;
static struct builder *builder;
static struct program_data expected, got;

static unsigned lanes = 16; /* of the routine that is optimised */

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
    lanes = 16;
    specialize_give(builder);
    code_destroy(arena);
}

static void optimize_under_contract(enum profile profile, uint32_t disabled)
{
    unsigned saved = mxcsr_enter();
    builder->pass.lanes = lanes;
    pass_run_all(&builder->ir, &builder->pass, pass_select(profile, 0, disabled), NULL, NULL);
    mxcsr_leave(saved);
}

static void fail_if_different(const char *what, uint64_t number)
{
    int at = program_difference(&expected, &got);
    char message[160];
    if (at < 0)
        return;
    snprintf(message, sizeof message, "%s, program %llu: lane %d of slot %d: expected %08x, got %08x", what,
             (unsigned long long)number, at % VERTEX_CAPACITY, at / VERTEX_CAPACITY,
             bits_of_float(expected.output[at]), bits_of_float(got.output[at]));
    TEST_FAIL_MESSAGE(message);
}

/* Makes program `number`, optimises it, and compares its results before and after. */
static void check_optimized(uint64_t number, enum profile profile, uint32_t disabled, const char *what)
{
    uint64_t seed = number * 0x9e3779b97f4a7c15ull | 1;
    program_make(&builder->ir, 10 + program_random(&seed) % 150, &seed);
    TEST_ASSERT_NULL(ir_verify(&builder->ir));
    program_fill(&expected, &seed);
    got = expected;
    program_interpret(&builder->ir, &expected, 8);
    optimize_under_contract(profile, disabled);
    TEST_ASSERT_NULL_MESSAGE(ir_verify(&builder->ir), what);
    program_interpret(&builder->ir, &got, 8);
    fail_if_different(what, number);
}

static void test_all_passes_keep_results(void)
{
    for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 9); n++) {
        check_optimized(n, PROFILE_FULL, 0, "full profile");
        check_optimized(n, PROFILE_THESIS, 0, "thesis profile");
    }
}

static void test_each_pass_keeps_results(void)
{
    for (unsigned pass = 0; pass < PASS_COUNT; pass++)
        for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 9) / 2; n++)
            check_optimized(n, PROFILE_FULL, ~(1u << pass), "one pass");
}

static void test_all_passes_but_one_keep_results(void)
{
    for (unsigned pass = 0; pass < PASS_COUNT; pass++)
        for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 9) / 2; n++)
            check_optimized(n, PROFILE_FULL, 1u << pass, "all but one pass");
}

static void test_optimizing_twice_changes_nothing(void)
{
    for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 9) / 4; n++) {
        check_optimized(n, PROFILE_FULL, 0, "first time");
        uint32_t count = builder->ir.count;
        optimize_under_contract(PROFILE_FULL, 0);
        TEST_ASSERT_EQUAL_UINT32(count, builder->ir.count);
    }
}

static void test_machine_code_with_few_registers_equals_the_interpreter(void)
{
    struct error error = {{0}};
    uint32_t spills = 0;
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    for (unsigned registers = 4; registers <= ALLOCATABLE; registers += 3)
        for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 9) / 2; n++) {
            unsigned width = lanes = program_width(n);
            check_optimized(n, PROFILE_FULL, n % 3 ? 0 : ~0u, "before compiling");
            uint64_t seed = n;
            program_fill(&expected, &seed);
            got = expected;
            program_interpret(&builder->ir, &expected, width);
            TEST_ASSERT_EQUAL_MESSAGE(
                0, program_compile_and_run(builder, arena, width, registers, &got, &error), error.text);
            fail_if_different("machine code", n);
            spills += builder->allocation.spills;
        }
    TEST_ASSERT_GREATER_THAN(test_share_of(1000, 9), spills);
}

/* Records an operation on a loaded word and a literal. Returns its opcode after the passes of the thesis. */
static unsigned left_of(enum ir_op op, enum ir_op source, float literal)
{
    struct ir *ir = &builder->ir;
    ir_start(ir);
    uint16_t x = ir_append(ir, (struct ir_instruction){.op = IR_load, .type = TYPE_flt, .base = BASE_INPUT});
    if (source == IR_float_f)
        x = ir_append(ir, (struct ir_instruction){.op = IR_float_f, .type = TYPE_flt, .operand = {x}});
    uint16_t y = ir_append(ir, (struct ir_instruction){
                                   .op = IR_literal, .type = TYPE_flt, .k = (int32_t)bits_of_float(literal)});
    uint16_t r = ir_append(ir, (struct ir_instruction){.op = (uint8_t)op,
                                                       .type = ir_op_information[op].result,
                                                       .operand = {x, isnan(literal) ? x : y}});
    ir_append(ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {r}});
    optimize_under_contract(PROFILE_THESIS, 0);
    const struct ir_instruction *store = &ir->instruction[ir->count - 1];
    return ir->instruction[store->operand[0]].op;
}

/* float_f of an integer is finite, not a denormal and not -0; a loaded word may be anything. */
static void test_thesis_rules_apply_only_where_they_are_exact(void)
{
    TEST_ASSERT_EQUAL(IR_float_f, left_of(IR_mul_f, IR_float_f, 1.0f));
    TEST_ASSERT_EQUAL(IR_mul_f, left_of(IR_mul_f, IR_load, 1.0f));
    TEST_ASSERT_EQUAL(IR_float_f, left_of(IR_add_f, IR_float_f, 0.0f));
    TEST_ASSERT_EQUAL(IR_add_f, left_of(IR_add_f, IR_load, 0.0f));
    TEST_ASSERT_EQUAL(IR_float_f, left_of(IR_add_f, IR_float_f, -0.0f));
    TEST_ASSERT_EQUAL(IR_float_f, left_of(IR_sub_f, IR_float_f, 0.0f));
    TEST_ASSERT_EQUAL(IR_literal, left_of(IR_sub_f, IR_float_f, NAN)); /* y - y */
    TEST_ASSERT_EQUAL(IR_sub_f, left_of(IR_sub_f, IR_load, NAN));
    TEST_ASSERT_EQUAL(IR_mul_f, left_of(IR_mul_f, IR_float_f, 0.0f)); /* the sign is not known */
    TEST_ASSERT_EQUAL(IR_mul_f, left_of(IR_mul_f, IR_load, 0.0f));
    TEST_ASSERT_EQUAL(IR_max_f, left_of(IR_max_f, IR_load, 0.0f));
}

static void test_adding_a_negated_value_becomes_a_subtraction(void)
{
    struct ir *ir = &builder->ir;
    for (int o = 0; o < 2; o++) {
        ir_start(ir);
        uint16_t x =
            ir_append(ir, (struct ir_instruction){.op = IR_load, .type = TYPE_flt, .base = BASE_INPUT});
        uint16_t y = ir_append(ir, (struct ir_instruction){.op = IR_neg_f, .type = TYPE_flt, .operand = {x}});
        uint16_t z =
            ir_append(ir, (struct ir_instruction){.op = IR_sqrt_f, .type = TYPE_flt, .operand = {x}});
        uint16_t sum = ir_append(
            ir, (struct ir_instruction){.op = IR_add_f, .type = TYPE_flt, .operand = {o ? z : y, o ? y : z}});
        ir_append(ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {sum}});
        optimize_under_contract(PROFILE_THESIS, 0);
        TEST_ASSERT_EQUAL(5, ir->count);
        TEST_ASSERT_EQUAL(IR_sub_f, ir->instruction[3].op);
        TEST_ASSERT_EQUAL(2, ir->instruction[3].operand[0]);
        TEST_ASSERT_EQUAL(1, ir->instruction[3].operand[1]);
    }
}

/* The channels of a packed colour are 0 to 1, so the clamp is removed. */
static void test_clamp_of_a_packed_colour_is_removed(void)
{
    union key key = {
        .vertex = {.attribute = {ATTRIBUTE_FORMAT_FLOAT3, 0, ATTRIBUTE_FORMAT_COLOR}, .varying = {1}}};
    ir_record(&builder->ir, UNIT_VERTEX, &key);
    optimize_under_contract(PROFILE_THESIS, 0);
    for (uint32_t n = 1; n < builder->ir.count; n++) {
        TEST_ASSERT_NOT_EQUAL(IR_max_f, builder->ir.instruction[n].op);
        TEST_ASSERT_NOT_EQUAL(IR_min_f, builder->ir.instruction[n].op);
    }
}

/* If the pixel routine does not read a colour, the normal, the lights and their operations are removed too.
 */
static void test_computation_of_an_unread_output_is_removed(void)
{
    union key key = {.vertex = {.attribute = {ATTRIBUTE_FORMAT_FLOAT3, ATTRIBUTE_FORMAT_FLOAT3},
                                .lighting = 1,
                                .light = {LIGHT_DIRECTIONAL, LIGHT_POINT},
                                .varying = {1}}};
    ir_record(&builder->ir, UNIT_VERTEX, &key);
    optimize_under_contract(PROFILE_THESIS, 0);
    uint32_t lit = builder->ir.count;
    key.vertex.varying[VARYING_diffuse] = 0;
    ir_record(&builder->ir, UNIT_VERTEX, &key);
    optimize_under_contract(PROFILE_THESIS, 0);
    TEST_ASSERT_GREATER_THAN(40, lit - builder->ir.count);
    for (uint32_t n = 1; n < builder->ir.count; n++)
        TEST_ASSERT_NOT_EQUAL(IR_sqrt_f, builder->ir.instruction[n].op);
}

/* --- Routines ------------------------------------------------------------------------------------------ */

static unsigned visited, copies;

/* Also a copy of a copy, and one of a literal. */
static void count_copies(void *context, enum unit unit, const union key *key)
{
    (void)context;
    ir_record(&builder->ir, unit, key);
    if (builder->ir.overflow)
        return;
    for (uint32_t n = 1; n < builder->ir.count; n++)
        copies += builder->ir.instruction[n].op == IR_copy;
    lanes = 8;
    optimize_under_contract(visited++ % 2 ? PROFILE_FULL : PROFILE_THESIS, 1u << PASS_preload);
    for (uint32_t n = 1; n < builder->ir.count; n++) {
        char text[KEY_TEXT_CAPACITY];
        TEST_ASSERT_NOT_EQUAL_MESSAGE(IR_copy, builder->ir.instruction[n].op, key_print(unit, key, text));
    }
}

/* The pass preload copies literals to registers before a loop. */
static void test_no_copy_is_left_in_routines(void)
{
    visited = copies = 0;
    visit_random_keys(test_share_of(300, 9), test_seed(), count_copies, NULL);
    visit_streams(count_copies, NULL);
    TEST_ASSERT_GREATER_THAN(test_share_of(300, 9), visited);
}

static uint32_t operations_with(unsigned format)
{
    union key key = {.vertex = {.attribute = {ATTRIBUTE_FORMAT_FLOAT3, 0, (uint8_t)format}, .varying = {1}}};
    ir_record(&builder->ir, UNIT_VERTEX, &key);
    optimize_under_contract(PROFILE_THESIS, 0);
    return builder->ir.count;
}

/* The colour of vertices without one is constant, so its clamps and conversions are computed while compiling.
 */
static void test_the_default_of_an_absent_attribute_folds(void)
{
    uint32_t absent = operations_with(0), present = operations_with(ATTRIBUTE_FORMAT_COLOR);
    TEST_ASSERT_LESS_THAN(present, absent + 8);
    operations_with(0);
    for (uint32_t n = 1; n < builder->ir.count; n++) {
        TEST_ASSERT_NOT_EQUAL(IR_max_f, builder->ir.instruction[n].op);
        TEST_ASSERT_NOT_EQUAL(IR_min_f, builder->ir.instruction[n].op);
        TEST_ASSERT_NOT_EQUAL(IR_float_f, builder->ir.instruction[n].op);
    }
}

int main(void)
{
    visit_fewer();
    UNITY_BEGIN();
    RUN_TEST(test_all_passes_keep_results);
    RUN_TEST(test_each_pass_keeps_results);
    RUN_TEST(test_all_passes_but_one_keep_results);
    RUN_TEST(test_optimizing_twice_changes_nothing);
    RUN_TEST(test_machine_code_with_few_registers_equals_the_interpreter);
    RUN_TEST(test_thesis_rules_apply_only_where_they_are_exact);
    RUN_TEST(test_adding_a_negated_value_becomes_a_subtraction);
    RUN_TEST(test_clamp_of_a_packed_colour_is_removed);
    RUN_TEST(test_computation_of_an_unread_output_is_removed);
    RUN_TEST(test_no_copy_is_left_in_routines);
    RUN_TEST(test_the_default_of_an_absent_attribute_folds);
    return UNITY_END();
}
