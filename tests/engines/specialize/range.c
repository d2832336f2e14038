/* Range analysis on random programs: every computed value is in its range, and strength reduction, which
 * relies on the ranges, does not change a bit.
 *
 * The programs have the operations with a range rule, on literals at critical values of binary32: around the
 * least normal number, where flushing may change a result by all of its value, around one, and around the
 * largest number. */
#include "base/bits.h"
#include "machine/mxcsr.h"
#include "contract/lane.h"
#include "engines/specialize/passes/range.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PROGRAMS = 20000, SOURCES = 4, LENGTH = 40, RECENT = 8 };

static struct ir ir;
static struct pass_memory memory;
static struct range_memory ranges;
static struct program_data data;
static uint64_t seed;
static char wrong[256];

/* The values computed so far, by type. */
static uint16_t made[TYPE_msk + 1][IR_CAPACITY];
static unsigned count[TYPE_msk + 1];

void setUp(void)
{
}

void tearDown(void)
{
}

static uint32_t below(uint32_t limit)
{
    return program_random(&seed) % limit;
}

static uint16_t pick(enum ir_type type)
{
    unsigned back = below(3) ? below(count[type] < RECENT ? count[type] : RECENT) : below(count[type]);
    return made[type][count[type] - 1 - back];
}

static void make(struct ir_instruction i)
{
    made[i.type][count[i.type]++] = ir_append(&ir, i);
}

static void make_literal(enum ir_type type)
{
    static const uint32_t ends[] = {0x00000000, 0x80000000, 0x00800000, 0x80800000, 0x00800001, 0x00ffffff,
                                    0x01000000, 0x00000001, 0x80000001, 0x007fffff, 0x1f800000, 0x20000000,
                                    0xa0000000, 0x3f000000, 0xbf000000, 0x3f7fffff, 0x3f800000, 0x3f800001,
                                    0xbf800000, 0x40400000, 0x437f0000, 0x7f7fffff, 0xff7fffff, 0x7f800000,
                                    0xff800000, 0x7fc00000};
    uint32_t small = below(300) - 20, word = below(2) ? small : program_random(&seed);
    if (type == TYPE_flt)
        word = ends[below(sizeof ends / sizeof *ends)];
    make((struct ir_instruction){.op = IR_literal, .type = (uint8_t)type, .k = (int32_t)word});
}

static void make_load(enum ir_type type, int array)
{
    make((struct ir_instruction){
        .op = IR_load, .type = (uint8_t)type, .base = BASE_INPUT, .k = array * PROGRAM_LANES * 4});
}

static void make_operation(void)
{
    static const uint8_t operations[] = {
        IR_add_f,   IR_sub_f, IR_mul_f,  IR_mul_f, IR_mad_f,  IR_mad_f,    IR_div_f,   IR_div_f,   IR_min_f,
        IR_min_f,   IR_max_f, IR_max_f,  IR_neg_f, IR_sqrt_f, IR_select_f, IR_lt_f,    IR_float_f, IR_round_i,
        IR_trunc_i, IR_and_i, IR_ushr_i, IR_shr_i, IR_min_i,  IR_max_i,    IR_select_i};
    unsigned op = operations[below(sizeof operations)];
    const struct ir_op_information *information = &ir_op_information[op];
    struct ir_instruction i = {.op = (uint8_t)op, .type = information->result};
    for (int o = 0; o < information->operands; o++)
        i.operand[o] = pick(information->operand[o]);
    if (information->properties & IR_SHIFTS)
        i.k = (int32_t)below(32);
    make(i);
}

/* Stores the values that were computed last. */
static void make_stores(void)
{
    for (unsigned n = 0; n < PROGRAM_STORES; n++) {
        enum ir_type type = n % 2 ? TYPE_itg : TYPE_flt;
        unsigned back = n / 2 < count[type] ? n / 2 : 0;
        ir_append(&ir, (struct ir_instruction){.op = IR_store,
                                               .base = BASE_OUTPUT,
                                               .operand = {made[type][count[type] - 1 - back]},
                                               .k = (int32_t)n * VERTEX_SLOT_BYTES});
    }
}

static void make_program(void)
{
    memset(count, 0, sizeof count);
    ir_start(&ir);
    for (int array = 0; array < PROGRAM_ARRAYS; array++)
        make_load(array % 2 ? TYPE_flt : TYPE_itg, array);
    for (int i = 0; i < SOURCES; i++) {
        make_literal(TYPE_flt);
        make_literal(TYPE_itg);
    }
    make((struct ir_instruction){
        .op = IR_lt_f, .type = TYPE_msk, .operand = {pick(TYPE_flt), pick(TYPE_flt)}});
    for (unsigned length = below(LENGTH); length; length--)
        if (below(6))
            make_operation();
        else
            make_literal(below(3) ? TYPE_flt : TYPE_itg);
}

static uint16_t append(enum ir_op op, enum ir_type type, uint16_t a, uint16_t b, int32_t k)
{
    return ir_append(
        &ir, (struct ir_instruction){.op = (uint8_t)op, .type = (uint8_t)type, .operand = {a, b}, .k = k});
}

enum { LOOP_VARIABLES = 6, COUNTER = LOOP_VARIABLES };

static enum ir_type variable_type(int variable)
{
    return variable % 3 ? TYPE_flt : TYPE_itg;
}

/* Sets some variables to recent values. */
static void make_sets(unsigned chance)
{
    for (int variable = 0; variable < LOOP_VARIABLES; variable++)
        if (!below(chance))
            append(IR_set, variable_type(variable), pick(variable_type(variable)), 0, variable);
}

static void make_gets(void)
{
    for (int variable = 0; variable < LOOP_VARIABLES; variable++)
        make((struct ir_instruction){.op = IR_get, .type = (uint8_t)variable_type(variable), .k = variable});
}

static void make_some(unsigned limit)
{
    for (unsigned length = 1 + below(limit); length; length--)
        make_operation();
}

/* A program with a loop of three iterations over variables, some of them set in a region, as phis and joins.
 */
static void make_loop_program(void)
{
    unsigned outside[TYPE_msk + 1];
    make_program();
    make_sets(1);
    append(IR_set, TYPE_itg, append(IR_literal, TYPE_itg, 0, 0, 3), 0, COUNTER);
    append(IR_loop, TYPE_non, 0, 0, 0);
    make_gets();
    make_some(6);
    memcpy(outside, count, sizeof outside);
    append(IR_when, TYPE_non, pick(TYPE_msk), 0, 0);
    make_some(4);
    make_sets(2);
    append(IR_end, TYPE_non, 0, 0, 0);
    memcpy(count, outside, sizeof outside);
    make_some(4);
    make_sets(3);
    uint16_t less = append(IR_sub_i, TYPE_itg, append(IR_get, TYPE_itg, 0, 0, COUNTER),
                           append(IR_literal, TYPE_itg, 0, 0, 1), 0);
    append(IR_set, TYPE_itg, less, 0, COUNTER);
    append(IR_again, TYPE_non, append(IR_gt_i, TYPE_msk, less, append(IR_literal, TYPE_itg, 0, 0, 0), 0), 0,
           0);
    make_gets();
    make_some(4);
}

/* Names the property of a float with these bits that its range excludes, or returns null. */
static const char *denied_float(const struct range *r, uint32_t bits)
{
    float value = lane_flush(bits_to_float(bits));
    if (value != value)
        return r->nan ? NULL : "NaN";
    if (bits_of_float(value) != bits && !r->denormal)
        return "a denormal";
    if (value < lane_flush(r->low) || value > lane_flush(r->high))
        return "its magnitude";
    return bits_of_float(value) == 0x80000000 && !r->minus_zero ? "-0" : NULL;
}

/* The range of an integer with unknown bounds has `nan` set. */
static const char *denied(const struct range *r, enum ir_type type, uint32_t bits)
{
    double value = (int32_t)bits;
    if (type == TYPE_flt)
        return denied_float(r, bits);
    if (type != TYPE_itg || r->nan)
        return NULL;
    return value < (double)r->low || value > (double)r->high ? "its magnitude" : NULL;
}

static void check_value(void *program, uint32_t number, uint32_t bits)
{
    const struct ir_instruction *i = &ir.instruction[number];
    const struct range *r = &ranges.range[number];
    const char *what = denied(r, i->type, bits);
    if (what && !wrong[0])
        snprintf(wrong, sizeof wrong,
                 "program %d, instruction %u, %s: %08x, but its range, %a to %a, denies %s", *(int *)program,
                 (unsigned)number, ir_op_information[i->op].name, (unsigned)bits, (double)r->low,
                 (double)r->high, what);
}

static void test_values_are_in_their_ranges(void)
{
    for (int program = 1; program <= (int)test_share_of(PROGRAMS, 10); program++) {
        seed = (uint64_t)program * 0x9e3779b97f4a7c15ull | 1;
        make_program();
        TEST_ASSERT_NULL(ir_verify(&ir));
        program_fill(&data, &seed);
        unsigned saved = mxcsr_enter();
        range_analyse(&ir, &ranges);
        mxcsr_leave(saved);
        program_observe(&ir, &data, 8, check_value, &program);
        if (wrong[0])
            TEST_FAIL_MESSAGE(wrong);
    }
}

static void test_values_of_loops_are_in_their_ranges(void)
{
    unsigned phis = 0, bounded = 0;
    for (int program = 1; program <= (int)test_share_of(PROGRAMS / 4, 10); program++) {
        seed = (uint64_t)program * 0x9e3779b97f4a7c15ull | 1;
        make_loop_program();
        program_fill(&data, &seed);
        pass_phi(&ir, &memory);
        pass_copy(&ir, &memory);
        TEST_ASSERT_NULL(ir_verify(&ir));
        unsigned saved = mxcsr_enter();
        range_analyse(&ir, &ranges);
        mxcsr_leave(saved);
        program_observe(&ir, &data, 8, check_value, &program);
        if (wrong[0])
            TEST_FAIL_MESSAGE(wrong);
        for (uint32_t n = 1; n < ir.count; n++)
            if (ir.instruction[n].op == IR_phi) {
                phis++;
                bounded += ranges.range[n].low > -INFINITY || ranges.range[n].high < INFINITY;
            }
    }
    TEST_ASSERT_GREATER_THAN(phis / 8, bounded);
}

static void test_reductions_keep_every_bit(void)
{
    static struct program_data reduced;
    for (int program = 1; program <= (int)test_share_of(PROGRAMS, 10); program++) {
        seed = (uint64_t)program * 0x9e3779b97f4a7c15ull | 1;
        make_program();
        make_stores();
        program_fill(&data, &seed);
        reduced = data;
        program_interpret(&ir, &data, 8);
        unsigned saved = mxcsr_enter();
        pass_run_all(&ir, &memory, pass_select(PROFILE_THESIS, 0, 0), NULL, NULL);
        mxcsr_leave(saved);
        program_interpret(&ir, &reduced, 8);
        snprintf(wrong, sizeof wrong, "program %d", program);
        TEST_ASSERT_EQUAL_MESSAGE(-1, program_difference(&data, &reduced), wrong);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_values_are_in_their_ranges);
    RUN_TEST(test_values_of_loops_are_in_their_ranges);
    RUN_TEST(test_reductions_keep_every_bit);
    return UNITY_END();
}
