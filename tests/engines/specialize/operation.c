/* Every row of def/op.def, compiled for 1, 4, 8 and 16 lanes and compared with the row's expression, for all
 * combinations of edge values: operands in registers, in memory and literal, each in every position. */
#include "machine/code.h"
#include "machine/cpu.h"
#include "tests/support/avx512/avx512.h"
#include "tests/support/shader/edges.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stdio.h>
#include <string.h>

static struct code_arena *arena;
static struct builder *builder;
static struct program_data expected, got;

void setUp(void)
{
    struct error error = {{0}};
    arena = code_create(0, NULL, &error);
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
    if (cpu_has_avx2_fma() && test_stride() == 1) /* sanitizers do not check generated code */
        avx512_begin(arena);
}

void tearDown(void)
{
    avx512_end();
    specialize_give(builder);
    code_destroy(arena);
}

/* The largest number of lanes that can be executed. */
static unsigned widest(void)
{
    return avx512_runs() ? 16 : 8;
}

/* The next number of lanes of a register. */
static unsigned wider(unsigned width)
{
    return width == 1 ? 4 : 2 * width;
}

enum operand_form { FROM_REGISTER, FROM_MEMORY, FROM_LITERAL, FORMS };

/* An operand; a second use of a load keeps it in a register. */
static uint16_t make_operand(struct ir *ir, enum operand_form form, enum ir_type type, int position,
                             uint32_t literal)
{
    struct ir_instruction i = {.type = (uint8_t)type, .op = IR_load, .base = BASE_INPUT};
    i.k = position * PROGRAM_LANES * 4;
    if (form == FROM_LITERAL)
        i = (struct ir_instruction){.type = (uint8_t)type, .op = IR_literal, .k = (int32_t)literal};
    uint16_t value = ir_append(ir, i);
    if (form == FROM_REGISTER)
        ir_append(ir, (struct ir_instruction){.op = IR_store,
                                              .base = BASE_OUTPUT,
                                              .operand = {value},
                                              .k = (1 + position) * VERTEX_SLOT_BYTES});
    return value;
}

/* Masks are words of memory here, which recordings do not have. */
static enum ir_type operand_type(enum ir_op op, int o)
{
    uint8_t type = ir_op_information[op].operand[o];
    return type == TYPE_msk || type == TYPE_any ? TYPE_itg : (enum ir_type)type;
}

static bool has_masks(enum ir_op op)
{
    return memchr(ir_op_information[op].operand, TYPE_msk, sizeof ir_op_information[op].operand) != NULL;
}

static void make_program(enum ir_op op, const enum operand_form form[3], uint32_t literal, int k)
{
    struct ir *ir = &builder->ir;
    const struct ir_op_information *information = &ir_op_information[op];
    struct ir_instruction i = {.op = (uint8_t)op, .type = information->result, .k = k};
    ir_start(ir);
    for (int o = 0; o < information->operands; o++)
        i.operand[o] = make_operand(ir, form[o], operand_type(op, o), o, literal);
    uint16_t result = ir_append(ir, i);
    ir_append(ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {result}});
}

/* The lanes of the inputs are the edge values in turn; `step` selects their combinations. Masks are 0 or -1.
 */
static void fill_inputs(enum ir_op op, unsigned step)
{
    memset(&expected, 0, sizeof expected);
    for (unsigned lane = 0; lane < PROGRAM_LANES; lane++) {
        unsigned n = step * PROGRAM_LANES + lane, base = edge_count;
        unsigned digit[3] = {n % base, n / base % base, n / base / base % base};
        for (int o = 0; o < 3; o++) {
            uint32_t word = edges[digit[o]];
            if (ir_op_information[op].operand[o] == TYPE_msk)
                word = word & 1 ? 0xffffffff : 0;
            expected.input[o * PROGRAM_LANES + (int)lane] = word;
        }
    }
    got = expected;
}

static void check(enum ir_op op, unsigned width)
{
    struct error error = {{0}};
    char message[128];
    if (!has_masks(op)) {
        TEST_ASSERT_NULL(ir_verify(&builder->ir));
    }
    program_interpret(&builder->ir, &expected, program_lanes(&builder->ir, width, 1));
    builder->pass.lanes = width;
    builder->pass.parts = 1;
    pass_split(&builder->ir, &builder->pass);
    TEST_ASSERT_EQUAL_MESSAGE(0, program_compile_and_run(builder, arena, width, ALLOCATABLE, &got, &error),
                              error.text);
    int at = program_difference(&expected, &got);
    if (at < 0)
        return;
    snprintf(message, sizeof message, "%s at width %u, lane %d of slot %d: expected %08x, got %08x",
             ir_op_information[op].name, width, at % VERTEX_CAPACITY, at / VERTEX_CAPACITY,
             ((unsigned *)(void *)expected.output)[at], ((unsigned *)(void *)got.output)[at]);
    TEST_FAIL_MESSAGE(message);
}

/* All pairs of edge values; the first 41 * 41 triples, and every n-th of the others. */
static void check_values(enum ir_op op, const enum operand_form form[3], int k, unsigned width)
{
    unsigned operands = ir_op_information[op].operands;
    unsigned cells = edge_count * (operands > 1 ? edge_count : 1);
    unsigned steps = cells / PROGRAM_LANES + 1;
    for (unsigned step = 0; step < steps; step++) {
        uint32_t literal = edges[step % edge_count];
        if (ir_op_information[op].operand[0] == TYPE_msk)
            literal = literal & 1 ? 0xffffffff : 0;
        if (ir_op_information[op].operand[0] == TYPE_fix)
            literal = (literal & 0xffff) * 0x10001u;
        make_program(op, form, literal, k);
        fill_inputs(op, operands == 3 ? step * 39 + step / 3 : step);
        check(op, width);
    }
}

static void check_forms(enum ir_op op, int k)
{
    unsigned operands = ir_op_information[op].operands, combinations = 1;
    for (unsigned o = 0; o < operands; o++)
        combinations *= FORMS;
    for (unsigned n = 0; n < combinations; n++) {
        enum operand_form form[3] = {n % FORMS, n / FORMS % FORMS, n / FORMS / FORMS};
        for (unsigned width = 1; width <= widest(); width = wider(width))
            check_values(op, form, k, width);
    }
}

static void test_every_operation_equals_its_expression(void)
{
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    for (unsigned op = 1; op <= IR_COMPUTED; op++) {
        unsigned bits = ir_op_information[op].result == TYPE_fix ? 16 : 32;
        if (!(ir_op_information[op].properties & IR_SHIFTS))
            check_forms(op, 0);
        else
            for (unsigned k = 0; k < bits; k++)
                check_forms(op, (int)k);
    }
}

static void test_a_permutation_reads_the_lanes_of_its_immediate(void)
{
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    for (int lanes = 0; lanes < 256; lanes++)
        for (enum operand_form from = 0; from < FORMS; from++) {
            const enum operand_form form[3] = {from};
            for (unsigned width = 1; width <= widest(); width = wider(width))
                check_values(IR_permute, form, lanes, width);
        }
}

/* The same register in two or three operands: the forms of the fused multiply-add depend on it. */
static void test_operands_may_be_the_same_value(void)
{
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    for (unsigned sharing = 0; sharing < 8; sharing++)
        for (unsigned width = 1; width <= widest(); width = wider(width)) {
            enum operand_form form[3] = {FROM_REGISTER, FROM_REGISTER, FROM_REGISTER};
            make_program(IR_mad_f, form, 0, 0);
            struct ir_instruction *mad = &builder->ir.instruction[builder->ir.count - 2];
            uint16_t operand[3] = {mad->operand[0], mad->operand[1], mad->operand[2]};
            mad->operand[1] = operand[sharing & 1 ? 0 : 1];
            mad->operand[2] = operand[sharing & 2 ? 0 : sharing & 4 ? 1 : 2];
            fill_inputs(IR_mad_f, sharing * 7);
            check(IR_mad_f, width);
        }
}

/* `words` neighbouring words of records, and a separate one if `last` is set. Every third is a mask, the
 * others are literals. */
static void make_scatters(unsigned words, int stride, unsigned literals, int last)
{
    struct ir *ir = &builder->ir;
    uint16_t value[6];
    ir_start(ir);
    for (unsigned n = 0; n < words; n++) {
        value[n] = make_operand(ir, literals >> n & 1 ? FROM_LITERAL : FROM_MEMORY, TYPE_itg,
                                (int)n % PROGRAM_ARRAYS, n);
        if (n % 3 == 2)
            value[n] = ir_append(ir, (struct ir_instruction){
                                         .op = IR_gt_i, .type = TYPE_msk, .operand = {value[n], value[0]}});
    }
    for (unsigned n = 0; n < words; n++)
        ir_append(ir, (struct ir_instruction){.op = IR_scatter,
                                              .base = BASE_OUTPUT,
                                              .operand = {value[n]},
                                              .k = 64 + 4 * (int)n,
                                              .field = stride});
    if (last)
        ir_append(ir, (struct ir_instruction){.op = IR_scatter,
                                              .base = BASE_OUTPUT,
                                              .operand = {value[0]},
                                              .k = 64 + 4 * (int)words + (last - 1) * 4,
                                              .field = stride});
}

/* Records that are adjacent, overlap, or have padding after them. */
static void test_scattered_words_are_in_their_records(void)
{
    static const int strides[] = {-16, 0, 4, 8, 12, 16, 20, 64};
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    for (unsigned n = 0; n < 6 * 8 * 16 * 3; n++) {
        unsigned words = 1 + n % 6;
        make_scatters(words, strides[n / 6 % 8], n / 48 % 16, (int)(n / 768));
        for (unsigned width = 1; width <= widest(); width = wider(width)) {
            fill_inputs(IR_add_i, n);
            check(IR_scatter, width);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_operation_equals_its_expression);
    RUN_TEST(test_a_permutation_reads_the_lanes_of_its_immediate);
    RUN_TEST(test_operands_may_be_the_same_value);
    RUN_TEST(test_scattered_words_are_in_their_records);
    return UNITY_END();
}
