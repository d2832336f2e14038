/* The peephole rules of def/engine/peephole.def: each applies, and changes no bit of a result. */
#include "base/bits.h"
#include "contract/job.h"
#include "machine/code.h"
#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "emu/emulate/emulate.h"
#include "engines/list.h"
#include "engines/variant.h"
#include "engines/specialize/parts.h"
#include "engines/specialize/specialize.h"
#include "tests/support/differential/differential.h"
#include "tests/support/routine/routines.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stddef.h>
#include <stdio.h>
#include <string.h>

static struct code_arena *arena;
static struct builder *builder;
static struct program_data given, expected, got;

void setUp(void)
{
    struct error error = {{0}};
    arena = code_create(0, NULL, &error);
    builder = specialize_take(&error);
    TEST_ASSERT_TRUE_MESSAGE(arena && builder, error.text);
}

void tearDown(void)
{
    specialize_give(builder);
    code_destroy(arena);
}

/* --- Rules of the pass reduce --------------------------------------------------------------------------- */

/* Operands of a tried operation. */
enum {
    NONE,
    WORD,       /* a loaded word: any float */
    WHOLE,      /* the float of a loaded integer from 0 to 255 */
    INTEGER,    /* a loaded integer */
    MASK,       /* a comparison */
    NEGATED,    /* -WORD */
    COMPLEMENT, /* not INTEGER */
    QUADRUPLED, /* WHOLE * 4: exact */
    THIRD,      /* WHOLE * 1/3: not exact */
    SCALED,     /* WORD * 2: infinity, where the fused operation has a number */
    SPLIT,      /* INTEGER and 0x00ff00ff */
    SPARSE,     /* INTEGER and 0x00ff00fe */
    SHIFTED,    /* the other bytes of INTEGER, shifted right and left */
    LIFTED,     /* a byte, shifted left by 16 */
    CUT,        /* INTEGER, shifted left by 16 */
    BRIGHT,     /* SPLIT * 255 + 128 */
    BEYOND,     /* INTEGER and 0x01ff00ff, * 255 + 128 */
    DARK,       /* SPLIT * 254 + 128 */
    LOW,        /* SPLIT * 255 + 127 */
    KINDS,
    LITERAL /* and above: the literal of a row, as bits */
};

#define BITS(bits) (LITERAL + (int64_t)(uint32_t)(bits))

static uint16_t value[KINDS];

static uint16_t append(enum ir_op op, enum ir_type type, uint16_t a, uint16_t b, int32_t k)
{
    return ir_append(&builder->ir, (struct ir_instruction){.op = (uint8_t)op,
                                                           .type = (uint8_t)type,
                                                           .base = op == IR_store ? BASE_OUTPUT : BASE_INPUT,
                                                           .operand = {a, b},
                                                           .k = k});
}

static uint16_t literal(uint32_t bits, enum ir_type type)
{
    return append(IR_literal, type, 0, 0, (int32_t)bits);
}

/* Channels * factor + bias. */
static uint16_t weighted(uint16_t channels, uint32_t factor, uint32_t bias)
{
    uint16_t halves = append(IR_copy, TYPE_fix, channels, 0, 0);
    uint16_t product = append(IR_mul_x, TYPE_fix, halves, literal(factor, TYPE_fix), 0);
    return append(IR_add_x, TYPE_fix, literal(bias, TYPE_fix), product, 0);
}

static void begin_program(void)
{
    ir_start(&builder->ir);
    value[WORD] = append(IR_load, TYPE_flt, 0, 0, 0);
    value[INTEGER] = append(IR_load, TYPE_itg, 0, 0, PROGRAM_LANES * 4);
    uint16_t byte = append(IR_and_i, TYPE_itg, value[INTEGER], literal(255, TYPE_itg), 0);
    value[WHOLE] = append(IR_float_f, TYPE_flt, byte, 0, 0);
    value[MASK] = append(IR_lt_f, TYPE_msk, value[WORD], value[WHOLE], 0);
    value[NEGATED] = append(IR_neg_f, TYPE_flt, value[WORD], 0, 0);
    value[COMPLEMENT] = append(IR_xor_i, TYPE_itg, value[INTEGER], literal(~0u, TYPE_itg), 0);
    value[QUADRUPLED] = append(IR_mul_f, TYPE_flt, value[WHOLE], literal(0x40800000, TYPE_flt), 0);
    value[THIRD] = append(IR_mul_f, TYPE_flt, value[WHOLE], literal(0x3eaaaaab, TYPE_flt), 0);
    value[SCALED] = append(IR_mul_f, TYPE_flt, value[WORD], literal(0x40000000, TYPE_flt), 0);
    value[SPLIT] = append(IR_and_i, TYPE_itg, value[INTEGER], literal(0x00ff00ff, TYPE_itg), 0);
    value[SPARSE] = append(IR_and_i, TYPE_itg, literal(0x00ff00fe, TYPE_itg), value[INTEGER], 0);
    uint16_t halves = append(IR_copy, TYPE_fix, value[INTEGER], 0, 0);
    uint16_t right = append(IR_ushr_x, TYPE_fix, halves, 0, 8);
    uint16_t left = append(IR_shl_x, TYPE_fix, right, 0, 8);
    value[SHIFTED] = append(IR_copy, TYPE_itg, left, 0, 0);
    value[LIFTED] = append(IR_shl_i, TYPE_itg, byte, 0, 16);
    value[CUT] = append(IR_shl_i, TYPE_itg, value[INTEGER], 0, 16);
    uint16_t more = append(IR_and_i, TYPE_itg, value[INTEGER], literal(0x01ff00ff, TYPE_itg), 0);
    value[BRIGHT] = weighted(value[SPLIT], 0x00ff00ff, 0x00800080);
    value[BEYOND] = weighted(more, 0x00ff00ff, 0x00800080);
    value[DARK] = weighted(value[SPLIT], 0x00ff00fe, 0x00800080);
    value[LOW] = weighted(value[SPLIT], 0x00ff00ff, 0x007f0080);
}

struct trial {
    enum peephole rule;
    enum ir_op op;
    int64_t operand[3];
    int32_t k;
};

enum { ONE = 0x3f800000 };
#define MINUS_ZERO 0x80000000

/* Where a rule needs a proof, the operands allow it. */
static const struct trial trials[] = {
    {PEEPHOLE_add_zero, IR_add_f, {WHOLE, BITS(0)}, 0},
    {PEEPHOLE_add_zero, IR_add_f, {BITS(MINUS_ZERO), WHOLE}, 0},
    {PEEPHOLE_add_negated, IR_add_f, {WHOLE, NEGATED}, 0},
    {PEEPHOLE_sub_zero, IR_sub_f, {WHOLE, BITS(0)}, 0},
    {PEEPHOLE_sub_self, IR_sub_f, {WHOLE, WHOLE}, 0},
    {PEEPHOLE_mul_one, IR_mul_f, {BITS(ONE), WHOLE}, 0},
    {PEEPHOLE_mul_zero, IR_mul_f, {WHOLE, BITS(0)}, 0},
    {PEEPHOLE_mad_one, IR_mad_f, {WORD, BITS(ONE), WHOLE}, 0},
    {PEEPHOLE_mad_zero, IR_mad_f, {WHOLE, BITS(0), WHOLE}, 0},
    {PEEPHOLE_mad_product, IR_mad_f, {WORD, WHOLE, BITS(MINUS_ZERO)}, 0},
    {PEEPHOLE_fuse, IR_add_f, {QUADRUPLED, WORD}, 0},
    {PEEPHOLE_fuse, IR_add_f, {WORD, QUADRUPLED}, 0},
    {PEEPHOLE_div_one, IR_div_f, {WHOLE, BITS(ONE)}, 0},
    {PEEPHOLE_extreme, IR_max_f, {WHOLE, BITS(0xbf800000)}, 0},
    {PEEPHOLE_extreme, IR_min_f, {WHOLE, BITS(0x43800000)}, 0},
    {PEEPHOLE_select_same, IR_select_f, {MASK, WORD, WORD}, 0},
    {PEEPHOLE_select_same, IR_select_f, {BITS(0), WORD, WHOLE}, 0},
    {PEEPHOLE_neutral, IR_add_i, {INTEGER, BITS(0)}, 0},
    {PEEPHOLE_neutral, IR_mul_i, {BITS(1), INTEGER}, 0},
    {PEEPHOLE_neutral, IR_shl_i, {INTEGER}, 0},
    {PEEPHOLE_neutral, IR_or_i, {INTEGER, BITS(0)}, 0},
    {PEEPHOLE_absorbing, IR_mul_i, {INTEGER, BITS(0)}, 0},
    {PEEPHOLE_absorbing, IR_and_i, {BITS(0), INTEGER}, 0},
    {PEEPHOLE_same, IR_and_i, {INTEGER, INTEGER}, 0},
    {PEEPHOLE_difference, IR_sub_i, {INTEGER, INTEGER}, 0},
    {PEEPHOLE_difference, IR_xor_i, {INTEGER, INTEGER}, 0},
    {PEEPHOLE_complement, IR_and_i, {INTEGER, COMPLEMENT}, 0},
    {PEEPHOLE_rejoin, IR_or_i, {SPLIT, SHIFTED}, 0},
    {PEEPHOLE_rejoin, IR_or_i, {SHIFTED, SPLIT}, 0},
    {PEEPHOLE_rejoin, IR_ushr_i, {LIFTED}, 16},
    {PEEPHOLE_white, IR_high_x, {BRIGHT, BITS(0x01010101)}, 0},
    {PEEPHOLE_white, IR_high_x, {BITS(0x01010101), BRIGHT}, 0},
};

static uint16_t operand_of(const struct trial *t, int o)
{
    unsigned type = ir_op_information[t->op].operand[o];
    if (t->operand[o] < LITERAL)
        return value[t->operand[o]];
    return literal((uint32_t)(t->operand[o] - LITERAL), type ? type : TYPE_itg);
}

static void make_program(const struct trial *t)
{
    begin_program();
    uint16_t operand[3];
    for (int o = 0; o < 3; o++)
        operand[o] = operand_of(t, o);
    uint16_t result =
        ir_append(&builder->ir, (struct ir_instruction){.op = (uint8_t)t->op,
                                                        .type = ir_op_information[t->op].result,
                                                        .operand = {operand[0], operand[1], operand[2]},
                                                        .k = t->k});
    append(IR_store, TYPE_non, result, 0, 0);
    const char *wrong = ir_verify(&builder->ir);
    TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
}

/* Optimises the program of a trial without some rules, and compares its results with those before, also of
 * machine code. Returns how often the rule applied. */
static uint32_t try_without(const struct trial *t, uint32_t without)
{
    struct error error = {{0}};
    uint64_t seed = test_seed() | 1;
    make_program(t);
    program_fill(&given, &seed);
    expected = got = given;
    program_interpret(&builder->ir, &expected, 8);
    unsigned saved = mxcsr_enter();
    builder->pass.lanes = 8;
    builder->pass.rules = (struct peepholes){.without = without};
    pass_run_all(&builder->ir, &builder->pass, pass_select(PROFILE_THESIS, 0, 0), NULL, NULL);
    mxcsr_leave(saved);
    program_interpret(&builder->ir, &got, 8);
    TEST_ASSERT_EQUAL_MESSAGE(-1, program_difference(&expected, &got), peephole_name(t->rule));
    got = given;
    if (cpu_has_avx2_fma()) {
        int failed = program_compile_and_run(builder, arena, 8, ALLOCATABLE, &got, &error);
        TEST_ASSERT_EQUAL_MESSAGE(0, failed, error.text);
        TEST_ASSERT_EQUAL_MESSAGE(-1, program_difference(&expected, &got), peephole_name(t->rule));
    }
    return builder->pass.rules.fired[t->rule];
}

static void rules_of_reduce_apply_and_change_no_bit(void)
{
    uint32_t tried = 0;
    for (size_t i = 0; i < sizeof trials / sizeof *trials; i++) {
        TEST_ASSERT_GREATER_THAN_MESSAGE(0, try_without(&trials[i], 0), peephole_name(trials[i].rule));
        TEST_ASSERT_EQUAL(0, try_without(&trials[i], 1u << trials[i].rule));
        tried |= 1u << trials[i].rule;
    }
    for (unsigned r = 0; peephole_name(r); r++)
        TEST_ASSERT_TRUE_MESSAGE(!peephole_reduces(r) || tried >> r & 1, peephole_name(r));
}

/* Where a bit of y is in neither part, or y has bits that shifts drop. */
static void parts_that_lack_a_bit_are_not_rejoined(void)
{
    static const struct trial others[] = {{PEEPHOLE_rejoin, IR_or_i, {SPARSE, SHIFTED}, 0},
                                          {PEEPHOLE_rejoin, IR_or_i, {SPLIT, COMPLEMENT}, 0},
                                          {PEEPHOLE_rejoin, IR_ushr_i, {LIFTED}, 15},
                                          {PEEPHOLE_rejoin, IR_ushr_i, {CUT}, 16}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        TEST_ASSERT_EQUAL(0, try_without(&others[i], 0));
}

/* Where a half may be above 255, or a number is another. */
static void other_products_are_not_those_with_white(void)
{
    static const struct trial others[] = {{PEEPHOLE_white, IR_high_x, {BEYOND, BITS(0x01010101)}, 0},
                                          {PEEPHOLE_white, IR_high_x, {DARK, BITS(0x01010101)}, 0},
                                          {PEEPHOLE_white, IR_high_x, {LOW, BITS(0x01010101)}, 0},
                                          {PEEPHOLE_white, IR_high_x, {BRIGHT, BITS(0x01010100)}, 0}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        TEST_ASSERT_EQUAL(0, try_without(&others[i], 0));
}

static uint32_t times_white(uint32_t color)
{
    uint32_t product = ir_evaluate(IR_mul_x, color, 0x00ff00ff, 0, 0);
    return ir_evaluate(IR_high_x, ir_evaluate(IR_add_x, product, 0x00800080, 0, 0), 0x01010101, 0, 0);
}

static void every_channel_times_white_is_itself(void)
{
    for (uint32_t low = 0; low < 256; low++)
        for (uint32_t high = 0; high < 256; high++)
            TEST_ASSERT_EQUAL_HEX32(high << 16 | low, times_white(high << 16 | low));
    TEST_ASSERT_NOT_EQUAL(0x01010000, times_white(0x01010000));
    TEST_ASSERT_NOT_EQUAL(0x00000101, times_white(0x00000101));
}

/* A fused operation rounds once: with a product that is rounded, or that is infinite, it has other bits. */
static void a_product_that_is_not_exact_is_not_fused(void)
{
    static const struct trial others[] = {{PEEPHOLE_fuse, IR_add_f, {THIRD, WORD}, 0},
                                          {PEEPHOLE_fuse, IR_add_f, {WORD, SCALED}, 0}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        TEST_ASSERT_EQUAL(0, try_without(&others[i], 0));
}

/* --- All rules on routines ------------------------------------------------------------------------------ */

static uint32_t fired[PEEPHOLES];
static const struct engine *measured;

static void count_rules(void *context, enum unit unit, const union key *key)
{
    struct build_rule rules[PEEPHOLES];
    struct error error = {{0}};
    uint32_t instructions = 0;
    (void)context;
    TEST_ASSERT_EQUAL_MESSAGE(0, specialize_measure_rules(measured, unit, key, rules, &instructions, &error),
                              error.text);
    TEST_ASSERT_GREATER_THAN(10, instructions);
    for (unsigned r = 0; r < PEEPHOLES; r++)
        fired[r] += rules[r].fired;
}

/* A comparison of an integer with zero, which few routines have. */
static void build_test_of_zero(void)
{
    static const struct trial trial = {PEEPHOLE_test, IR_eq_i, {INTEGER, BITS(0)}, 0};
    const struct register_file file = {.wide = true};
    struct error error = {{0}};
    make_program(&trial);
    allocate_registers(&builder->ir, &builder->allocation, &file);
    TEST_ASSERT_NOT_EQUAL_MESSAGE(0, program_emit(builder, 16, &error), error.text);
    fired[PEEPHOLE_test] += builder->emitter.rules.fired[PEEPHOLE_test];
}

/* Three words of a level, with registers for all of them, which random keys seldom have. */
static void build_words_of_level(void)
{
    const struct register_file file = allocate_register_file(ALLOCATABLE, 8);
    struct error error = {{0}};
    ir_start(&builder->ir);
    uint16_t index = append(IR_shl_i, TYPE_itg, append(IR_load, TYPE_itg, 0, 0, 0), 0, 3), word[3];
    for (int n = 0; n < 3; n++)
        word[n] =
            ir_append(&builder->ir, (struct ir_instruction){.op = IR_gather,
                                                            .type = TYPE_itg,
                                                            .base = BASE_JOB,
                                                            .field = offsetof(struct job, texture[1].levels),
                                                            .scale = 4,
                                                            .operand = {index},
                                                            .k = 4 * n});
    for (int n = 0; n < 3; n++)
        append(IR_store, TYPE_non, word[n], 0, 32 * n);
    allocate_registers(&builder->ir, &builder->allocation, &file);
    TEST_ASSERT_NOT_EQUAL_MESSAGE(0, program_emit(builder, 8, &error), error.text);
    fired[PEEPHOLE_level] += builder->emitter.rules.fired[PEEPHOLE_level];
}

/* Code of 16 lanes is built, and not executed. */
static void rules_of_selection_apply(void)
{
    static const struct engine *const engines[] = {&engine_specialize_8, &engine_specialize_16};
    memset(fired, 0, sizeof fired);
    for (int e = 0; e < 2; e++) {
        measured = engines[e];
        visit_random_keys(test_share_of(120, 2), test_seed(), count_rules, NULL);
    }
    build_test_of_zero();
    build_words_of_level();
    for (unsigned r = 0; r < PEEPHOLES; r++)
        TEST_ASSERT_TRUE_MESSAGE(peephole_reduces(r) || fired[r] > 0, peephole_name(r));
}

static void a_rule_that_is_left_out_does_not_apply(void)
{
    char name[ENGINE_NAME_CAPACITY];
    for (unsigned r = 0; r < PEEPHOLES; r += test_stride()) {
        snprintf(name, sizeof name, "specialize-8:without=%s", peephole_name(r));
        measured = engine_find(name);
        memset(fired, 0, sizeof fired);
        visit_random_keys(6, test_seed(), count_rules, NULL);
        TEST_ASSERT_EQUAL_MESSAGE(0, fired[r], name);
    }
}

static void without_each_rule_routines_equal_the_emulator(void)
{
    enum { ROUNDS = 40 };
    static const char *const engines[] = {"specialize-8", "specialize-1", "specialize-16"};
    char name[ENGINE_NAME_CAPACITY];
    struct differential *differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
    for (unsigned n = 0; n < 3 * PEEPHOLES; n += test_stride()) {
        snprintf(name, sizeof name, "%s:without=%s", engines[n % 3], peephole_name(n / 3));
        const struct engine *engine = engine_find(name);
        if (engine_unavailable(engine))
            continue;
        for (int unit = 0; unit < UNIT_COUNT; unit++) {
            const char *difference = differential_rounds(differential, &engine_emulate, engine, unit, NULL,
                                                         test_seed() + n, (int)test_share_of(ROUNDS, 13));
            TEST_ASSERT_NULL_MESSAGE(difference, difference);
        }
    }
    differential_destroy(differential);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(rules_of_reduce_apply_and_change_no_bit);
    RUN_TEST(a_product_that_is_not_exact_is_not_fused);
    RUN_TEST(parts_that_lack_a_bit_are_not_rejoined);
    RUN_TEST(other_products_are_not_those_with_white);
    RUN_TEST(every_channel_times_white_is_itself);
    RUN_TEST(rules_of_selection_apply);
    RUN_TEST(a_rule_that_is_left_out_does_not_apply);
    RUN_TEST(without_each_rule_routines_equal_the_emulator);
    return UNITY_END();
}
