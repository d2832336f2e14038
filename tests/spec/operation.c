/* The emulator's binding of every row of def/op.def: each lane, and each half of a pair, equals the row's
 * expression for the same lane of the operands. Further tests check the exact conversions and extremes that
 * the expressions need. */
#include "base/bits.h"
#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "emu/emulate/bind.h"
#include "ir/ir.h"
#include "tests/support/shader/edges.h"
#include <unity.h>

#include <math.h>
#include <stdio.h>

static unsigned saved;
static struct env env; /* of the emulator, on this processor or on a lesser one */

void setUp(void)
{
    saved = mxcsr_enter();
}

void tearDown(void)
{
    mxcsr_leave(saved);
}

/* Stores the words of operand `position` for four lanes in round `round`. The rounds contain all pairs of
 * edge values. */
static void take_words(uint32_t words[4], unsigned round, int position, int is_mask)
{
    for (unsigned lane = 0; lane < 4; lane++) {
        unsigned n = 4 * round + lane;
        unsigned digit = position == 0 ? n : position == 1 ? n / edge_count : n / 3 + 7;
        words[lane] = edges[digit % edge_count];
        if (is_mask)
            words[lane] = words[lane] & 1 ? 0xffffffff : 0;
    }
}

/* Returns 1 if the words are equal, or if both are NaN: the bits of a NaN are not defined. */
static int same(uint32_t a, uint32_t b, int is_float)
{
    return a == b || (is_float && isnan(bits_to_float(a)) && isnan(bits_to_float(b)));
}

static void check_lanes(const char *name, enum ir_op row, const uint32_t in[3][4], const void *result,
                        int is_float, int k)
{
    char message[128];
    uint32_t out[4];
    memcpy(out, result, sizeof out);
    for (int lane = 0; lane < 4; lane++) {
        uint32_t expected = ir_evaluate(row, in[0][lane], in[1][lane], in[2][lane], k);
        if (same(out[lane], expected, is_float))
            continue;
        snprintf(message, sizeof message, "%s(%08x, %08x, %08x) in lane %d: expected %08x, got %08x", name,
                 in[0][lane], in[1][lane], in[2][lane], lane, expected, out[lane]);
        TEST_FAIL_MESSAGE(message);
    }
}

#define IS_FLOAT_flt 1
#define IS_FLOAT_itg 0
#define IS_FLOAT_fix 0
#define IS_FLOAT_msk 0
#define MAKE_flt(n, i)                                                                                       \
    flt n;                                                                                                   \
    take_words(in[i], round, i, 0);                                                                          \
    memcpy(&n, in[i], 16);
#define MAKE_itg(n, i)                                                                                       \
    itg n;                                                                                                   \
    take_words(in[i], round, i, 0);                                                                          \
    memcpy(&n, in[i], 16);
#define MAKE_fix(n, i)                                                                                       \
    fix n;                                                                                                   \
    take_words(in[i], round, i, 0);                                                                          \
    memcpy(&n, in[i], 16);
#define MAKE_msk(n, i)                                                                                       \
    msk n;                                                                                                   \
    take_words(in[i], round, i, 1);                                                                          \
    memcpy(&n, in[i], 16);
#define MAKE_non(n, i)
#define PASS_flt(n) , n
#define PASS_itg(n) , n
#define PASS_fix(n) , n
#define PASS_msk(n) , n
#define PASS_non(n)

/* One checking function a row. */
#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    static void check_##name(unsigned round)                                                                 \
    {                                                                                                        \
        uint32_t in[3][4] = {{0}};                                                                           \
        MAKE_##ta(a, 0) MAKE_##tb(b, 1) MAKE_##tc(c, 2) result r =                                           \
            (name)(&env PASS_##ta(a) PASS_##tb(b) PASS_##tc(c));                                             \
        check_lanes(#name, IR_##name, in, &r, IS_FLOAT_##result, 0);                                         \
    }
#define OPK(name, result, ta, tb, tc, properties, expression)                                                \
    static void check_##name(unsigned round)                                                                 \
    {                                                                                                        \
        uint32_t in[3][4] = {{0}};                                                                           \
        MAKE_##ta(a, 0) int k = (int)(round % (sizeof(result) == sizeof(fix) && #name[5] == 'x' ? 16 : 32)); \
        result r = (name)(&env, a, k);                                                                       \
        check_lanes(#name, IR_##name, in, &r, IS_FLOAT_##result, k);                                         \
    }
#define CAST(name, ...)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST

static void check_every_operation(void)
{
    for (unsigned round = 0; round < edge_count * edge_count / 4 + 1; round++) {
#define OP(name, ...)  check_##name(round);
#define OPK(name, ...) check_##name(round);
#define CAST(name, ...)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
    }
}

static void test_every_operation_of_the_emulator_equals_its_expression(void)
{
    env.fuses = false;
    check_every_operation();
}

static void test_every_operation_equals_its_expression_where_the_processor_fuses(void)
{
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    env.fuses = true;
    check_every_operation();
}

static void test_permutations_of_quads_fit_their_names(void)
{
    const flt value = {{10, 11, 12, 13}};
    static const struct {
        int lanes;
        float expected[4];
    } cases[] = {{QUAD_LEFT, {10, 10, 12, 12}},
                 {QUAD_RIGHT, {11, 11, 13, 13}},
                 {QUAD_UPPER, {10, 11, 10, 11}},
                 {QUAD_LOWER, {12, 13, 12, 13}}};
    for (int i = 0; i < 4; i++) {
        flt r = permute_f(NULL, value, cases[i].lanes);
        for (int lane = 0; lane < 4; lane++)
            TEST_ASSERT_TRUE(r.lane[lane] == cases[i].expected[lane]);
    }
}

static void test_round_is_nearest_even_and_saturates_to_the_indefinite_integer(void)
{
    TEST_ASSERT_EQUAL_INT32(0, lane_round(0.5f));
    TEST_ASSERT_EQUAL_INT32(2, lane_round(1.5f));
    TEST_ASSERT_EQUAL_INT32(2, lane_round(2.5f));
    TEST_ASSERT_EQUAL_INT32(-2, lane_round(-1.5f));
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, lane_round(0x1p31f));
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, lane_round(NAN));
    TEST_ASSERT_EQUAL_INT32(-1, lane_truncate(-1.9f));
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, lane_truncate(-INFINITY));
}

static void test_minimum_and_maximum_give_the_second_operand_on_nan_and_on_equal_zeros(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x40000000, bits_of_float(lane_min(NAN, 2.0f)));
    TEST_ASSERT_TRUE(isnan(lane_min(2.0f, NAN)));
    TEST_ASSERT_EQUAL_HEX32(0x80000000, bits_of_float(lane_max(0.0f, -0.0f)));
    TEST_ASSERT_EQUAL_HEX32(0x00000000, bits_of_float(lane_max(-0.0f, 0.0f)));
}

static void test_floor_of_a_denormal_is_zero(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x80000000, bits_of_float(lane_floor(-0x1p-140f)));
    TEST_ASSERT_EQUAL_FLOAT(-2.0f, lane_floor(-1.25f));
    TEST_ASSERT_EQUAL_FLOAT(1.0f, lane_floor(1.75f));
}

static void test_fused_multiply_add_rounds_once(void)
{
    float a = 1 + 0x1p-12f;
    TEST_ASSERT_EQUAL_HEX32(bits_of_float(0x1p-24f), ir_evaluate(IR_mad_f, bits_of_float(a), bits_of_float(a),
                                                                 bits_of_float(-(1 + 0x1p-11f)), 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_operation_of_the_emulator_equals_its_expression);
    RUN_TEST(test_every_operation_equals_its_expression_where_the_processor_fuses);
    RUN_TEST(test_permutations_of_quads_fit_their_names);
    RUN_TEST(test_round_is_nearest_even_and_saturates_to_the_indefinite_integer);
    RUN_TEST(test_minimum_and_maximum_give_the_second_operand_on_nan_and_on_equal_zeros);
    RUN_TEST(test_floor_of_a_denormal_is_zero);
    RUN_TEST(test_fused_multiply_add_rounds_once);
    return UNITY_END();
}
