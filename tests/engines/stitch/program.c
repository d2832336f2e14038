/* Programs joined from operation fragments: random programs compute the rows of def/op.def, values stay in
 * registers while there are enough, values with separate lifetimes share slots of the stack frame, and
 * large programs fit. */
#include "machine/code.h"
#include "engines/stitch/stitch.h"
#include "tests/support/routine/stitched.h"

#include <string.h>
#include <unity.h>

enum { WIDTH = 8 };

static struct code_arena *arena;
static struct plan *plan;
static struct ir ir;
static struct program_data expected, got;

static void expect_equal(const char *what)
{
    struct error error = {{0}};
    struct program_data given = expected;
    TEST_ASSERT_NULL(ir_verify(&ir));
    program_interpret(&ir, &expected, WIDTH);
    got = given;
    TEST_ASSERT_EQUAL_MESSAGE(0, stitched_run(plan, &ir, arena, &got, &error), error.text);
    TEST_ASSERT_EQUAL_MESSAGE(-1, program_difference(&expected, &got), what);
    TEST_ASSERT_EQUAL_MESSAGE(0, plan_check(plan, &error), error.text);
}

static void random_programs_agree(void)
{
    uint64_t seed = 0x57175;
    for (int round = 0; round < 600; round++) {
        char what[64];
        snprintf(what, sizeof what, "program %d", round);
        program_make(&ir, 1 + program_random(&seed) % 120, &seed);
        program_fill(&expected, &seed);
        expect_equal(what);
    }
}

static void random_programs_with_loops_and_variables_agree(void)
{
    uint64_t seed = 0x100b5;
    for (int round = 0; round < 600; round++) {
        char what[64];
        snprintf(what, sizeof what, "program %d", round);
        program_make_loops(&ir, 1 + program_random(&seed) % 120, &seed);
        program_fill(&expected, &seed);
        expect_equal(what);
    }
}

static void programs_whose_operations_fuse_agree(void)
{
    uint64_t seed = 0xf05e;
    unsigned fused = 0, operations = 0;
    for (int round = 0; round < 600; round++) {
        char what[64];
        snprintf(what, sizeof what, "program %d", round);
        stitched_make_fusing(&ir, 1 + program_random(&seed) % 80, &seed);
        program_fill(&expected, &seed);
        expect_equal(what);
        fused += plan->counts.fused;
        operations += plan->counts.operations;
    }
    TEST_ASSERT_GREATER_THAN(operations / 30, fused);
}

static void a_program_of_twenty_thousand_operations_agrees(void)
{
    uint64_t seed = 0x20000;
    program_make(&ir, 20000, &seed);
    TEST_ASSERT_GREATER_THAN(20000, ir.count);
    program_fill(&expected, &seed);
    expect_equal("20000 operations");
}

static uint16_t append_ir(enum ir_op op, uint16_t a, uint16_t b)
{
    return ir_append(&ir, (struct ir_instruction){
                              .op = (uint8_t)op, .type = ir_op_information[op].result, .operand = {a, b}});
}

static uint16_t load(int array)
{
    return ir_append(
        &ir, (struct ir_instruction){
                 .op = IR_load, .type = TYPE_itg, .base = BASE_INPUT, .k = array * PROGRAM_LANES * 4});
}

static void store(uint16_t value)
{
    ir_append(&ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {value}});
}

static int slots(void)
{
    return stitched_plan(plan, &ir) / SLOT_BYTES;
}

/* An operand that is read twice, a value that is read at the end, and results that are never read. */
static void values_that_fit_into_registers_are_never_stored(void)
{
    uint64_t seed = 3;
    ir_start(&ir);
    uint16_t step = load(0), sum = load(1);
    for (int i = 0; i < 10000; i++) {
        sum = append_ir(IR_add_i, sum, sum);
        append_ir(IR_sub_i, sum, step);
        sum = append_ir(IR_xor_i, sum, step);
    }
    store(sum);
    program_fill(&expected, &seed);
    expect_equal("chain");
    TEST_ASSERT_EQUAL(0, slots());
    TEST_ASSERT_EQUAL(2 + 20000 + 1, plan->counts.operations);
}

/* Twice the number of registers, repeatedly. */
static void values_with_separate_lifetimes_share_slots(void)
{
    enum { ALIVE = 30 };
    uint64_t seed = 5;
    ir_start(&ir);
    uint16_t sum = load(0);
    for (int round = 0; round < 300; round++) {
        uint16_t alive[ALIVE];
        for (int i = 0; i < ALIVE; i++)
            sum = alive[i] = append_ir(IR_add_i, sum, sum);
        for (int i = 0; i < ALIVE; i++)
            sum = append_ir(IR_xor_i, sum, alive[i]);
    }
    store(sum);
    program_fill(&expected, &seed);
    expect_equal("rounds");
    TEST_ASSERT_GREATER_THAN(ALIVE - 16, slots());
    TEST_ASSERT_LESS_OR_EQUAL(ALIVE, slots());
}

/* Appends `count` values, an odd number, before any but the first is read, then reads two in each
 * operation. */
static void keep_alive(int count)
{
    static uint16_t alive[IR_CAPACITY];
    ir_start(&ir);
    uint16_t step = load(1), sum = load(0);
    ir.instruction[step].type = ir.instruction[sum].type = TYPE_flt;
    alive[0] = sum;
    for (int i = 1; i < count; i++)
        alive[i] = append_ir(IR_add_f, alive[i - 1], step);
    for (int i = 1; i + 1 < count; i += 2) {
        uint16_t operands[] = {alive[i], alive[i + 1], sum};
        sum = append_ir(IR_mad_f, 0, 0);
        memcpy(ir.instruction[sum].operand, operands, sizeof operands);
    }
    store(sum);
}

static void values_with_overlapping_lifetimes_have_separate_slots(void)
{
    enum { ALIVE = 20001 };
    uint64_t seed = 4;
    keep_alive(ALIVE);
    program_fill(&expected, &seed);
    expect_equal("all alive");
    TEST_ASSERT_GREATER_THAN(ALIVE - 16, slots());
}

static void stack_frames_that_are_too_large_are_refused(void)
{
    struct error error = {{0}};
    keep_alive(FRAME_BYTES_MAXIMUM / SLOT_BYTES + 17);
    TEST_ASSERT_FALSE(ir.overflow);
    TEST_ASSERT_EQUAL(-1, stitched_run(plan, &ir, arena, &got, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "exceeds its room of 1048576"), error.text);
}

static void programs_that_are_too_large_are_refused(void)
{
    struct error error = {{0}};
    struct code_span span;
    ir_start(&ir);
    uint16_t value = load(0);
    for (int i = 0; i < IR_CAPACITY - 4; i++)
        value = append_ir(IR_add_i, value, value);
    store(value);
    TEST_ASSERT_FALSE(ir.overflow);
    stitched_plan(plan, &ir);
    while (!plan->dropped)
        plan_append(plan, &fragment_leave, (union arguments){{0}});
    TEST_ASSERT_EQUAL(-1, plan_join(plan, arena, &span, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "parts exceeds its room of 131072"), error.text);
    error_clear(&error);
    TEST_ASSERT_EQUAL(-1, plan_check(plan, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "parts exceeds its room of 131072"), error.text);
}

static void refuse(const char *what)
{
    struct error error = {{0}};
    TEST_ASSERT_EQUAL(-1, stitched_run(plan, &ir, arena, &got, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, what), error.text);
}

static void regions_nested_too_deeply_are_refused(void)
{
    for (int more = 0; more < 2; more++) {
        uint64_t seed = 6;
        ir_start(&ir);
        uint16_t value = load(0), mask = append_ir(IR_eq_i, value, value);
        for (int i = 0; i < NESTING_MAXIMUM + more; i++)
            ir_append(&ir, (struct ir_instruction){.op = IR_when, .operand = {mask}});
        store(value);
        for (int i = 0; i < NESTING_MAXIMUM + more; i++)
            ir_append(&ir, (struct ir_instruction){.op = IR_end});
        program_fill(&expected, &seed);
        if (more)
            refuse("plan of 257 regions in one another exceeds its room of 256");
        else
            expect_equal("nested");
    }
}

static void too_many_literals_are_refused(void)
{
    ir_start(&ir);
    uint16_t sum = load(0);
    for (int i = 0; i < POOL_CAPACITY; i++) {
        struct ir_instruction literal = {.op = IR_literal, .type = TYPE_itg, .k = i + 2};
        sum = append_ir(IR_add_i, sum, ir_append(&ir, literal));
    }
    store(sum);
    refuse("plan of 8193 literals exceeds its room of 8192");
}

/* The IR forbids this. An error in the specification would be reported. */
static void values_that_leave_their_region_are_refused(void)
{
    ir_start(&ir);
    uint16_t value = load(0), mask = append_ir(IR_eq_i, value, value);
    ir_append(&ir, (struct ir_instruction){.op = IR_when, .operand = {mask}});
    uint16_t inside = append_ir(IR_add_i, value, value);
    ir_append(&ir, (struct ir_instruction){.op = IR_end});
    store(inside);
    refuse("reads 1 values outside of their region");
}

void setUp(void)
{
    struct error error = {{0}};
    if (engine_unavailable(&engine_stitch_operation))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_stitch_operation));
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    plan = plan_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(plan, error.text);
}

void tearDown(void)
{
    if (plan)
        plan_give(plan);
    code_destroy(arena);
    plan = NULL;
    arena = NULL;
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(random_programs_agree);
    RUN_TEST(random_programs_with_loops_and_variables_agree);
    RUN_TEST(programs_whose_operations_fuse_agree);
    RUN_TEST(a_program_of_twenty_thousand_operations_agrees);
    RUN_TEST(values_that_fit_into_registers_are_never_stored);
    RUN_TEST(values_with_separate_lifetimes_share_slots);
    RUN_TEST(values_with_overlapping_lifetimes_have_separate_slots);
    RUN_TEST(stack_frames_that_are_too_large_are_refused);
    RUN_TEST(programs_that_are_too_large_are_refused);
    RUN_TEST(regions_nested_too_deeply_are_refused);
    RUN_TEST(too_many_literals_are_refused);
    RUN_TEST(values_that_leave_their_region_are_refused);
    return UNITY_END();
}
