/* Programs that ir_verify refuses: a valid program of loops, regions, variables, phis, joins and subroutines,
 * with one error at a time. */
#include "tests/ir/program.h"

void setUp(void)
{
    ir_start(&ir);
}

void tearDown(void)
{
}

static void test_operands_are_defined_before_their_use(void)
{
    append(IR_add_i, TYPE_itg, 2, 2, 0);
    number(1);
    refuse("not defined before");
}

static void test_operands_are_values(void)
{
    uint16_t one = number(1);
    append(IR_add_i, TYPE_itg, one, set(0, one), 0);
    refuse("is not a value");
}

static void test_nothing_leaves_a_region(void)
{
    uint16_t m = mask();
    effect(IR_when, m, 0);
    uint16_t inside = number(1);
    effect(IR_end, 0, 0);
    append(IR_add_i, TYPE_itg, inside, inside, 0);
    refuse("leaves its region");
}

static void test_values_of_a_loop_can_be_used_after_it(void)
{
    uint16_t m = mask();
    effect(IR_loop, 0, 0);
    uint16_t inside = number(1);
    effect(IR_again, m, 0);
    append(IR_add_i, TYPE_itg, inside, inside, 0);
    accept();
}

static void test_values_of_a_loop_cannot_be_used_after_a_region_around_it(void)
{
    uint16_t m = mask();
    effect(IR_when, m, 0);
    effect(IR_loop, 0, 0);
    uint16_t inside = number(1);
    effect(IR_again, m, 0);
    effect(IR_end, 0, 0);
    append(IR_add_i, TYPE_itg, inside, inside, 0);
    refuse("leaves its region");
}

static void test_regions_nest(void)
{
    uint16_t m = mask();
    effect(IR_when, m, 0);
    effect(IR_loop, 0, 0);
    effect(IR_end, 0, 0);
    refuse("no region of its kind");
    ir_start(&ir);
    effect(IR_loop, 0, 0);
    refuse("not ended");
    ir_start(&ir);
    effect(IR_again, mask(), 0);
    refuse("no region of its kind");
}

static void test_a_variable_has_one_type(void)
{
    set(3, number(1));
    append(IR_get, TYPE_flt, 0, 0, 3);
    refuse("another type");
    ir_start(&ir);
    append(IR_set, TYPE_fix, append(IR_literal, TYPE_fix, 0, 0, 0), 0, 0);
    refuse("another type");
}

static void test_a_variable_is_set_before_it_is_got(void)
{
    get(0);
    refuse("may have no value");
}

static void test_a_set_in_a_region_may_be_skipped(void)
{
    uint16_t m = mask(), one = number(1);
    effect(IR_when, m, 0);
    set(0, one);
    get(0);
    effect(IR_end, 0, 0);
    accept();
    get(0);
    refuse("may have no value");
}

static void test_a_set_in_a_loop_is_not_skipped(void)
{
    uint16_t m = mask(), one = number(1);
    effect(IR_loop, 0, 0);
    set(0, one);
    effect(IR_again, m, 0);
    get(0);
    accept();
}

static void test_a_set_in_a_loop_does_not_reach_the_first_iteration(void)
{
    uint16_t m = mask(), one = number(1);
    effect(IR_loop, 0, 0);
    get(0);
    set(0, one);
    effect(IR_again, m, 0);
    refuse("may have no value");
}

static void test_a_variable_exists(void)
{
    set(0, number(1));
    ir.instruction[ir.count - 1].k = VARIABLES;
    refuse("there is no variable");
}

/* A square of a word of the job, before the section, and its store. */
static uint16_t begin_sections(void)
{
    ir_start(&ir);
    ir.preamble = true;
    uint16_t word = append(IR_uniform, TYPE_itg, 0, 0, 0);
    ir.instruction[word].base = BASE_JOB;
    uint16_t square = append(IR_mul_i, TYPE_itg, word, word, 0);
    append(IR_section, TYPE_non, 0, 0, IR_SECTION_BODY);
    return square;
}

static void test_a_section_is_repeated_to_the_end(void)
{
    begin_sections();
    refuse("a section is not ended");
    effect(IR_repeat, 0, 0);
    accept();
    number(1);
    refuse("the sections have ended");
    begin_sections();
    append(IR_section, TYPE_non, 0, 0, IR_SECTION_BODY);
    refuse("no section begins here");
    begin_sections();
    ir.preamble = false;
    effect(IR_repeat, 0, 0);
    refuse("no section begins here");
    begin_sections();
    effect(IR_when, mask(), 0);
    effect(IR_repeat, 0, 0);
    refuse("no section ends here");
}

static void test_parts_have_values_of_their_own(void)
{
    uint16_t square = begin_sections(), first = number(1);
    ir.early = true;
    append(IR_rest, TYPE_non, 0, 0, 0);
    append(IR_mul_i, TYPE_itg, square, square, 0);
    effect(IR_repeat, 0, 0);
    accept();
    ir.count--;
    append(IR_mul_i, TYPE_itg, square, first, 0);
    refuse("operand 1 is a value of the first part");
    ir.count -= 2;
    append(IR_rest, TYPE_non, 0, 0, 0);
    refuse("no second part begins here");
    begin_sections();
    append(IR_rest, TYPE_non, 0, 0, 0);
    refuse("no second part begins here");
    ir.early = true;
    ir.count--;
    effect(IR_when, mask(), 0);
    append(IR_rest, TYPE_non, 0, 0, 0);
    refuse("no second part begins here");
}

static void test_a_preamble_has_values_of_the_call_only(void)
{
    uint16_t square = begin_sections();
    effect(IR_repeat, 0, 0);
    ir.instruction[square].op = IR_load;
    ir.instruction[square].base = BASE_INPUT;
    ir.instruction[square].operand[0] = ir.instruction[square].operand[1] = 0;
    refuse("not the same in all lanes");
    ir.instruction[square].op = IR_uniform;
    refuse("not the same in all lanes");
    ir.instruction[square].base = BASE_CONSTANT;
    accept();
}

static void test_a_phi_precedes_its_loop_and_has_one_next_value(void)
{
    uint16_t m = mask(), one = number(1), phi = append(IR_phi, TYPE_itg, one, 0, 0);
    effect(IR_loop, 0, 0);
    uint16_t more = append(IR_add_i, TYPE_itg, phi, one, 0);
    effect(IR_next, phi, more);
    uint16_t again = effect(IR_again, m, 0);
    accept();
    ir.instruction[again - 1] = (struct ir_instruction){0};
    refuse("has no next value");
    ir.instruction[again - 1] = (struct ir_instruction){.op = IR_next, .operand = {one, more}};
    refuse("is not a phi of this loop");
    ir.instruction[again - 2] = ir.instruction[again - 1] =
        (struct ir_instruction){.op = IR_next, .operand = {phi, one}};
    refuse("without a next value");
}

static void test_a_phi_without_a_loop_is_refused(void)
{
    uint16_t one = number(1);
    append(IR_phi, TYPE_itg, one, 0, 0);
    number(2);
    refuse("does not precede a loop");
    ir_start(&ir);
    append(IR_phi, TYPE_itg, number(1), 0, 0);
    refuse("not ended");
}

static void test_next_values_end_their_loop(void)
{
    uint16_t m = mask(), one = number(1), phi = append(IR_phi, TYPE_itg, one, 0, 0);
    effect(IR_loop, 0, 0);
    effect(IR_next, phi, one);
    number(2);
    effect(IR_again, m, 0);
    refuse("does not precede a loop's end");
}

static void test_an_inner_loop_has_no_next_value_of_an_outer_phi(void)
{
    uint16_t m = mask(), one = number(1), phi = append(IR_phi, TYPE_itg, one, 0, 0);
    effect(IR_loop, 0, 0);
    effect(IR_loop, 0, 0);
    effect(IR_next, phi, one);
    effect(IR_again, m, 0);
    refuse("is not a phi of this loop");
}

static void test_joins_follow_their_region(void)
{
    uint16_t m = mask(), one = number(1);
    effect(IR_when, m, 0);
    uint16_t two = number(2);
    effect(IR_end, 0, 0);
    uint16_t join = append(IR_join, TYPE_itg, one, two, 0);
    accept();
    append(IR_join, TYPE_itg, one, join, 0);
    refuse("a join of the same region");
    ir.instruction[join + 1].operand[1] = one;
    accept();
    number(3);
    append(IR_join, TYPE_itg, one, one, 0);
    refuse("does not follow a region's end");
}

static void test_the_first_operand_of_a_join_is_defined_before_the_region(void)
{
    uint16_t m = mask(), one = number(1);
    effect(IR_when, m, 0);
    uint16_t two = number(2);
    effect(IR_end, 0, 0);
    append(IR_join, TYPE_itg, two, one, 0);
    refuse("leaves its region");
}

/* --- Subroutines ---------------------------------------------------------------------------------------- */

static void begin_with_a_call(void)
{
    ir_start(&ir);
    ir.subroutines = ir.exchanged = 1;
    append(IR_put, TYPE_itg, number(1), 0, 0);
    effect(IR_call, 0, 0);
    append(IR_take, TYPE_itg, 0, 0, 0);
}

static void test_subroutines_follow_the_program(void)
{
    begin_with_a_call();
    effect(IR_subroutine, 0, 0);
    append(IR_put, TYPE_itg, append(IR_take, TYPE_itg, 0, 0, 0), 0, 0);
    refuse("a subroutine is not ended");
    effect(IR_leave, 0, 0);
    accept();
    number(1);
    refuse("a subroutine has ended");
    begin_with_a_call();
    effect(IR_leave, 0, 0);
    refuse("no subroutine ends here");
    begin_with_a_call();
    effect(IR_loop, 0, 0);
    effect(IR_subroutine, 0, 0);
    refuse("a subroutine begins before the end of what precedes it");
}

static void test_subroutines_use_no_value_of_their_caller(void)
{
    begin_with_a_call();
    effect(IR_subroutine, 0, 0);
    append(IR_put, TYPE_itg, 1, 0, 0);
    effect(IR_leave, 0, 0);
    refuse("operand 0 is a value of another subroutine");
    begin_with_a_call();
    set(0, 1);
    effect(IR_subroutine, 0, 0);
    get(0);
    effect(IR_leave, 0, 0);
    refuse("variable 0 may have no value");
}

static void test_calls_are_of_subroutines_that_exist(void)
{
    begin_with_a_call();
    append(IR_call, TYPE_non, 0, 0, 1);
    refuse("there is no subroutine 1");
    begin_with_a_call();
    append(IR_put, TYPE_itg, number(1), 0, 1);
    refuse("there is no argument or result 1");
    begin_with_a_call();
    append(IR_put, TYPE_flt, number(1), 0, 0);
    refuse("operand 0 is itg, expected flt");
    begin_with_a_call();
    append(IR_put, TYPE_fix, append(IR_literal, TYPE_fix, 0, 0, 1), 0, 0);
    refuse("its type cannot be passed on");
    begin_with_a_call();
    effect(IR_subroutine, 0, 0);
    effect(IR_call, 0, 0);
    effect(IR_leave, 0, 0);
    refuse("a subroutine calls another");
}

/* With CHECK_IR the reason begins with the name of the program. */
static void test_a_check_names_the_program(void)
{
    struct error error = {{0}};
    mask();
    TEST_ASSERT_EQUAL(0, ir_check(&ir, "the result of pass dead", &error));
    effect(IR_end, 0, 0);
    TEST_ASSERT_EQUAL(-1, ir_check(&ir, "the result of pass dead", &error));
    TEST_ASSERT_EQUAL_STRING(
        "the result of pass dead is not a valid program: instruction 2: no region of its kind is open",
        error.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_operands_are_defined_before_their_use);
    RUN_TEST(test_operands_are_values);
    RUN_TEST(test_nothing_leaves_a_region);
    RUN_TEST(test_values_of_a_loop_can_be_used_after_it);
    RUN_TEST(test_values_of_a_loop_cannot_be_used_after_a_region_around_it);
    RUN_TEST(test_regions_nest);
    RUN_TEST(test_a_variable_has_one_type);
    RUN_TEST(test_a_variable_is_set_before_it_is_got);
    RUN_TEST(test_a_set_in_a_region_may_be_skipped);
    RUN_TEST(test_a_set_in_a_loop_is_not_skipped);
    RUN_TEST(test_a_set_in_a_loop_does_not_reach_the_first_iteration);
    RUN_TEST(test_a_variable_exists);
    RUN_TEST(test_a_section_is_repeated_to_the_end);
    RUN_TEST(test_parts_have_values_of_their_own);
    RUN_TEST(test_a_preamble_has_values_of_the_call_only);
    RUN_TEST(test_a_phi_precedes_its_loop_and_has_one_next_value);
    RUN_TEST(test_a_phi_without_a_loop_is_refused);
    RUN_TEST(test_next_values_end_their_loop);
    RUN_TEST(test_an_inner_loop_has_no_next_value_of_an_outer_phi);
    RUN_TEST(test_joins_follow_their_region);
    RUN_TEST(test_the_first_operand_of_a_join_is_defined_before_the_region);
    RUN_TEST(test_subroutines_follow_the_program);
    RUN_TEST(test_subroutines_use_no_value_of_their_caller);
    RUN_TEST(test_calls_are_of_subroutines_that_exist);
    RUN_TEST(test_a_check_names_the_program);
    return UNITY_END();
}
