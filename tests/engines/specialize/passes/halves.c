/* Bounds of the halves of packed values: no value of random programs exceeds them; and which bounds are found
 * for the forms of the specification. */
#include "engines/specialize/passes/range.h"

#include "ir/ir.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stdio.h>

enum { PROGRAMS = 4000, LENGTH = 60, WORDS = 4, RECENT = 6, DEEP = 200, UNKNOWN = 0xffff };

static struct ir ir;
static uint64_t seed;

/* The bits of each value. */
static uint32_t word[DEEP + 2 * LENGTH];

void setUp(void)
{
    seed = test_seed() | 1;
    ir_start(&ir);
}

void tearDown(void)
{
}

static uint32_t below(uint32_t limit)
{
    return program_random(&seed) % limit;
}

/* Appends an instruction, and computes its bits. */
static uint16_t append(struct ir_instruction i)
{
    uint16_t value = ir_append(&ir, i);
    word[value] = i.op == IR_literal
                      ? (uint32_t)i.k
                      : ir_evaluate(i.op, word[i.operand[0]], word[i.operand[1]], word[i.operand[2]], i.k);
    return value;
}

static uint16_t literal(uint32_t bits)
{
    return append((struct ir_instruction){.op = IR_literal, .type = TYPE_itg, .k = (int32_t)bits});
}

/* A value that nothing is known of, with these bits. */
static uint16_t load(uint32_t bits)
{
    uint16_t value =
        ir_append(&ir, (struct ir_instruction){.op = IR_load, .type = TYPE_itg, .base = BASE_INPUT});
    word[value] = bits;
    return value;
}

static uint16_t make(enum ir_op op, uint16_t a, uint16_t b, int32_t k)
{
    return append((struct ir_instruction){
        .op = (uint8_t)op, .type = ir_op_information[op].result, .operand = {a, b}, .k = k});
}

static uint16_t pick(void)
{
    uint32_t last = ir.count - 1, back = below(2) ? below(RECENT) : below(last);
    return (uint16_t)(back < last ? last - back : 1);
}

static uint16_t scaled_difference(uint16_t p, uint16_t q, uint16_t weight)
{
    uint16_t difference = make(IR_sub_x, q, p, 0);
    return below(2) ? make(IR_scale_x, difference, weight, 0) : make(IR_scale_x, weight, difference, 0);
}

static uint16_t interpolate(uint16_t p, uint16_t q, uint16_t weight)
{
    uint16_t change = scaled_difference(p, q, weight);
    return below(2) ? make(IR_add_x, p, change, 0) : make(IR_add_x, change, p, 0);
}

static void make_any(void)
{
    static const uint8_t operations[] = {IR_add_x,   IR_sub_x, IR_mul_x,  IR_min_x, IR_high_x,
                                         IR_scale_x, IR_shl_x, IR_ushr_x, IR_and_i, IR_or_i,
                                         IR_xor_i,   IR_shl_i, IR_ushr_i, IR_shr_i, IR_sub_i};
    enum ir_op op = (enum ir_op)operations[below(sizeof operations)];
    bool words = op == IR_shl_i || op == IR_ushr_i || op == IR_shr_i;
    uint32_t kind = below(8), bits = program_random(&seed);
    if (kind == 0)
        literal(below(2) ? bits : bits & 0x00ff00ff);
    else if (kind == 1)
        interpolate(pick(), pick(), pick());
    else if (kind == 2)
        append((struct ir_instruction){
            .op = IR_select_i, .type = TYPE_itg, .operand = {literal(below(2) ? ~0u : 0), pick(), pick()}});
    else
        make(op, pick(), pick(),
             ir_op_information[op].properties & IR_SHIFTS ? (int32_t)below(words ? 32 : 16) : 0);
}

static void expect_within(uint32_t value, unsigned *bounded)
{
    char text[96];
    const struct halves most = range_halves(&ir, value);
    snprintf(text, sizeof text, "instruction %u, %s: %08x, but its halves are at most %x and %x",
             (unsigned)value, ir_op_information[ir.instruction[value].op].name, (unsigned)word[value],
             (unsigned)most.high, (unsigned)most.low);
    TEST_ASSERT_TRUE_MESSAGE((word[value] & UNKNOWN) <= most.low && word[value] >> 16 <= most.high, text);
    *bounded += ir.instruction[value].op != IR_literal && (most.low < UNKNOWN || most.high < UNKNOWN);
}

static void no_value_exceeds_its_bounds(void)
{
    unsigned bounded = 0, values = 0;
    for (int program = 0; program < (int)test_share_of(PROGRAMS, 10); program++) {
        ir_start(&ir);
        for (int i = 0; i < WORDS; i++)
            make(IR_and_i, load(program_random(&seed)), literal(i % 2 ? 0x00ff00ff : 0x7fff7fff), 0);
        while (ir.count < LENGTH)
            make_any();
        for (uint32_t value = 1; value < ir.count; value++)
            expect_within(value, &bounded);
        values += ir.count;
    }
    TEST_ASSERT_GREATER_THAN(values / 8, bounded);
}

static void expect(uint32_t low, uint32_t high, uint16_t value)
{
    const struct halves most = range_halves(&ir, value);
    TEST_ASSERT_EQUAL_HEX(low, most.low);
    TEST_ASSERT_EQUAL_HEX(high, most.high);
}

/* As in spec/math/color.h. */
static void channels_of_a_word_are_bytes(void)
{
    uint16_t texel = load(~0u);
    expect(UNKNOWN, UNKNOWN, texel);
    expect(255, 255, make(IR_and_i, texel, literal(0x00ff00ff), 0));
    expect(255, 255, make(IR_ushr_x, texel, 0, 8));
    uint16_t byte = make(IR_ushr_i, texel, 0, 24), high = make(IR_shl_i, byte, 0, 16);
    expect(255, 0, byte);
    expect(0, 255, high);
    uint16_t both = make(IR_or_i, byte, high, 0);
    expect(255, 255, both);
    expect(0x7f80, 0x7f80, make(IR_shl_x, both, 0, 7));
    expect(UNKNOWN, UNKNOWN, make(IR_shl_x, both, 0, 9));
    uint16_t product = make(IR_mul_x, both, both, 0);
    expect(255 * 255, 255 * 255, product);
    uint16_t rounded = make(IR_add_x, product, literal(0x00800080), 0);
    expect(255, 255, make(IR_high_x, rounded, literal(0x01010101), 0));
    expect(UNKNOWN, UNKNOWN, make(IR_add_x, product, product, 0));
    expect(255, 255, make(IR_min_x, make(IR_add_x, product, product, 0), both, 0));
}

static void interpolated_texels_are_between_their_two(void)
{
    uint16_t p = make(IR_and_i, load(~0u), literal(0x00ff00ff), 0);
    uint16_t q = make(IR_ushr_x, load(~0u), 0, 8);
    uint16_t weight = make(IR_and_i, load(~0u), literal(0x7fff7fff), 0);
    uint16_t wide = make(IR_and_i, load(~0u), literal(0x7fff8fff), 0);
    for (int form = 0; form < 8; form++) {
        expect(255, 255, interpolate(p, q, weight));
        expect(UNKNOWN, UNKNOWN, interpolate(p, q, wide));
        expect(UNKNOWN, UNKNOWN, make(IR_add_x, q, scaled_difference(p, q, weight), 0));
        expect(UNKNOWN, UNKNOWN, interpolate(p, make(IR_shl_x, q, 0, 8), weight));
    }
    uint16_t upper = interpolate(p, q, weight), lower = interpolate(q, p, weight);
    expect(255, 255, interpolate(upper, lower, weight));
}

/* After enough values, the bounds of others are unknown. */
static void a_search_ends(void)
{
    uint16_t value = make(IR_and_i, load(~0u), literal(0x00ff00ff), 0);
    for (int depth = 0; depth < DEEP; depth++)
        value = make(IR_ushr_x, value, 0, 0);
    expect(UNKNOWN, UNKNOWN, value);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(no_value_exceeds_its_bounds);
    RUN_TEST(channels_of_a_word_are_bytes);
    RUN_TEST(interpolated_texels_are_between_their_two);
    RUN_TEST(a_search_ends);
    return UNITY_END();
}
