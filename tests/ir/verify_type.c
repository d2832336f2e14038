/* Programs whose values have wrong types, which ir_verify refuses. */
#include "tests/ir/program.h"

void setUp(void)
{
    ir_start(&ir);
}

void tearDown(void)
{
}

static uint16_t literal(enum ir_type type)
{
    return append(IR_literal, type, 0, 0, 0);
}

static void test_operands_have_the_types_of_their_operation(void)
{
    for (int op = 1; op <= IR_COMPUTED; op++)
        for (int o = 0; o < ir_op_information[op].operands; o++)
            for (enum ir_type type = TYPE_flt; type <= TYPE_msk; type++) {
                const struct ir_op_information *information = &ir_op_information[op];
                uint16_t operand[3] = {0};
                ir_start(&ir);
                for (int n = 0; n < information->operands; n++)
                    operand[n] = literal(n == o ? type : information->operand[n]);
                append((enum ir_op)op, information->result, operand[0], operand[1], 0);
                ir.instruction[ir.count - 1].operand[2] = operand[2];
                if (type == information->operand[o])
                    accept();
                else
                    refuse(", expected ");
            }
}

static void test_results_have_the_types_of_their_operation(void)
{
    uint16_t one = number(1);
    append(IR_add_i, TYPE_flt, one, one, 0);
    refuse("its value is flt, expected itg");
    ir_start(&ir);
    literal(TYPE_non);
    refuse("its value is without a type, expected a type");
    ir_start(&ir);
    append(IR_load, TYPE_msk, 0, 0, 0);
    refuse("it reads msk, expected a word");
}

static void test_regions_are_opened_by_masks(void)
{
    effect(IR_when, number(-1), 0);
    effect(IR_end, 0, 0);
    refuse("operand 0 is itg, expected msk");
    ir_start(&ir);
    effect(IR_loop, 0, 0);
    effect(IR_again, number(-1), 0);
    refuse("operand 0 is itg, expected msk");
}

static void test_indices_of_gathers_are_integers(void)
{
    append(IR_gather, TYPE_flt, literal(TYPE_flt), 0, 0);
    refuse("operand 0 is flt, expected itg");
}

static void test_variables_phis_and_joins_keep_their_type(void)
{
    append(IR_set, TYPE_itg, literal(TYPE_flt), 0, 0);
    refuse("operand 0 is flt, expected itg");
    ir_start(&ir);
    append(IR_phi, TYPE_flt, number(1), 0, 0);
    refuse("operand 0 is itg, expected flt");
    ir_start(&ir);
    uint16_t m = mask(), f = literal(TYPE_flt), phi = append(IR_phi, TYPE_itg, number(1), 0, 0);
    effect(IR_loop, 0, 0);
    effect(IR_next, phi, f);
    effect(IR_again, m, 0);
    refuse("operand 1 is flt, expected itg");
    ir_start(&ir);
    uint16_t one = number(1);
    effect(IR_when, mask(), 0);
    uint16_t inside = literal(TYPE_flt);
    effect(IR_end, 0, 0);
    append(IR_join, TYPE_itg, one, inside, 0);
    refuse("operand 1 is flt, expected itg");
}

/* Casts are copies. When copy propagation has removed them, a word may be read as any other, but never as a
 * mask: with 16 lanes, masks are in other registers. */
static void test_after_copy_propagation_only_masks_are_distinguished(void)
{
    uint16_t f = append(IR_load, TYPE_flt, 0, 0, 0), m = mask();
    append(IR_add_i, TYPE_itg, f, m, 0);
    refuse("expected itg");
    ir.typed = false;
    accept();
    append(IR_andn_m, TYPE_itg, f, m, 0); /* of words, from strength reduction */
    accept();
    append(IR_and_m, TYPE_msk, m, f, 0);
    refuse("operand 1 is flt, expected msk");
}

static void test_no_word_becomes_a_mask(void)
{
    append(IR_copy, TYPE_msk, number(1), 0, 0);
    refuse("a word is copied to a mask");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_operands_have_the_types_of_their_operation);
    RUN_TEST(test_results_have_the_types_of_their_operation);
    RUN_TEST(test_regions_are_opened_by_masks);
    RUN_TEST(test_indices_of_gathers_are_integers);
    RUN_TEST(test_variables_phis_and_joins_keep_their_type);
    RUN_TEST(test_after_copy_propagation_only_masks_are_distinguished);
    RUN_TEST(test_no_word_becomes_a_mask);
    return UNITY_END();
}
