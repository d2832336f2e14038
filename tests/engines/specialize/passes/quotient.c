/* Divisions of whole numbers by constants: which become a product and a sum, and that each quotient has
 * the bits * of the division, for all numbers of 16 bits, for random ones, and for those that are hardest
 * to round. */
#include "base/bits.h"
#include "tests/support/routine/routines.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <math.h>
#include <stdio.h>

enum { DIVISORS = 65536, DRAWN = 40, HARD = 50 };

static struct builder *builder;
static struct ir *ir;
static uint64_t seed;

void setUp(void)
{
    struct error error = {{0}};
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
    ir = &builder->ir;
    ir_start(ir);
    seed = test_seed() | 1;
}

void tearDown(void)
{
    specialize_give(builder);
}

/* --- Programs ------------------------------------------------------------------------------------------- */

static uint16_t append(enum ir_op op, enum ir_type type, uint16_t a, uint16_t b, int32_t k)
{
    return ir_append(ir, (struct ir_instruction){
                             .op = (uint8_t)op, .type = type, .base = BASE_INPUT, .operand = {a, b}, .k = k});
}

static uint16_t literal(float number)
{
    return append(IR_literal, TYPE_flt, 0, 0, (int32_t)bits_of_float(number));
}

static uint16_t whole(int32_t k)
{
    return append(IR_float_f, TYPE_flt, append(IR_load, TYPE_itg, 0, 0, k), 0, 0);
}

static void store(uint16_t value, int32_t k)
{
    ir_append(ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {value}, .k = k});
}

static void divide(uint16_t x, uint16_t divisor)
{
    store(append(IR_div_f, TYPE_flt, x, divisor, 0), 0);
}

static unsigned run_pass(void)
{
    TEST_ASSERT_NULL(ir_verify(ir));
    unsigned changes = pass_quotient(ir, &builder->pass);
    TEST_ASSERT_NULL(ir_verify(ir));
    return changes;
}

static unsigned count(enum ir_op op)
{
    unsigned found = 0;
    for (uint32_t number = 1; number < ir->count; number++)
        found += ir->instruction[number].op == op;
    return found;
}

/* --- Quotients ------------------------------------------------------------------------------------------ */

/* The numbers with which the pass replaces a division by d. */
struct quotient {
    float d, high, low;
};

static float literal_of(const struct ir_instruction *i, int o)
{
    const struct ir_instruction *operand = &ir->instruction[i->operand[o]];
    TEST_ASSERT_EQUAL_INT(IR_literal, operand->op);
    return bits_to_float((uint32_t)operand->k);
}

static struct quotient quotient_of(float d)
{
    struct quotient q = {d, 0, 0};
    ir_start(ir);
    divide(whole(0), literal(d));
    TEST_ASSERT_EQUAL_UINT(1, run_pass());
    const struct ir_instruction *i = &ir->instruction[ir->instruction[ir->count - 1].operand[0]];
    if (i->op == IR_mad_f) {
        q.high = literal_of(i, 1);
        i = &ir->instruction[i->operand[2]];
        q.low = literal_of(i, 1);
    } else {
        q.high = literal_of(i, 1);
    }
    TEST_ASSERT_EQUAL_INT(IR_mul_f, i->op);
    return q;
}

static void expect_quotient(const struct quotient *q, float x)
{
    const float product = x * q->low, expected = x / q->d,
                got = q->low == 0 ? x * q->high : fmaf(x, q->high, product);
    char text[96];
    if (bits_of_float(expected) == bits_of_float(got))
        return;
    snprintf(text, sizeof text, "%.9g / %.9g: expected %.9g, got %.9g", x, q->d, expected, got);
    TEST_FAIL_MESSAGE(text);
}

/* Numbers of channels, of parts of them, and of vertices. */
static void numbers_of_sixteen_bits_have_the_same_quotients(void)
{
    static const float divisors[] = {2, 3, 7, 15, 31, 63, 127, 255, 256, 511, 1023, 32767, 65535, 65536};
    for (size_t i = 0; i < sizeof divisors / sizeof *divisors; i++) {
        const struct quotient q = quotient_of(divisors[i]);
        for (int x = -65536; x <= 65536; x++)
            expect_quotient(&q, (float)x);
    }
}

static void random_numbers_have_the_same_quotients(void)
{
    for (unsigned d = 2; d <= DIVISORS; d += test_stride_of(7)) {
        const struct quotient q = quotient_of((float)d);
        for (unsigned i = 0; i < DRAWN; i++)
            expect_quotient(&q, (float)((int32_t)program_random(&seed) >> program_random(&seed) % 31));
    }
}

/* Numbers whose quotients are as close as possible to the middle between two numbers: those next to the
 * product of d and a number of 25 bits whose last bit is 1. */
static void quotients_next_to_a_middle_are_the_same(void)
{
    for (unsigned d = 3; d <= DIVISORS; d += test_stride_of(7)) {
        const struct quotient q = quotient_of((float)d);
        for (unsigned i = 0; i < HARD; i++) {
            const double middle = 0x1000001 + 2 * (program_random(&seed) % 0x800000), product = middle * d;
            const float x = (float)ldexp(product, 30 - ilogb(product));
            for (int step = -1; step <= 1; step++)
                expect_quotient(&q, x + (float)step * 0x1p7f);
        }
    }
}

/* --- Programs that change, and others ------------------------------------------------------------------ */

static void divisions_by_one_constant_share_its_literals(void)
{
    const uint16_t d = literal(255);
    for (int32_t k = 0; k < 4; k++)
        store(append(IR_div_f, TYPE_flt, whole(k * 4), d, 0), k * VERTEX_SLOT_BYTES);
    TEST_ASSERT_EQUAL_UINT(4, run_pass());
    TEST_ASSERT_EQUAL_UINT(0, count(IR_div_f));
    TEST_ASSERT_EQUAL_UINT(4, count(IR_mul_f));
    TEST_ASSERT_EQUAL_UINT(4, count(IR_mad_f));
    TEST_ASSERT_EQUAL_UINT(2, count(IR_literal));
}

static void a_divisor_that_is_used_otherwise_stays(void)
{
    const uint16_t d = literal(255), x = whole(0);
    divide(x, d);
    store(append(IR_add_f, TYPE_flt, x, d, 0), VERTEX_SLOT_BYTES);
    TEST_ASSERT_EQUAL_UINT(1, run_pass());
    TEST_ASSERT_EQUAL_UINT(3, count(IR_literal));
}

static void expect_division(uint16_t x, uint16_t divisor, const char *what)
{
    divide(x, divisor);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, run_pass(), what);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, count(IR_div_f), what);
    ir_start(ir);
}

static void other_divisions_stay(void)
{
    static const float others[] = {0, 1, 0.5f, 2.5f, -3, -255, 65537, 0x1p24f, INFINITY, NAN};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        expect_division(whole(0), literal(others[i]), "another divisor");
    expect_division(append(IR_load, TYPE_flt, 0, 0, 0), literal(255), "any number divided");
    const uint16_t x = whole(0);
    expect_division(x, append(IR_load, TYPE_flt, 0, 0, 4), "a divisor that varies");
    expect_division(literal(255), whole(0), "a constant divided");
}

static void a_program_without_room_stays(void)
{
    const uint16_t x = whole(0), d = literal(255);
    divide(x, d);
    while (ir->count + 2 < IR_CAPACITY)
        store(x, VERTEX_SLOT_BYTES);
    TEST_ASSERT_EQUAL_UINT(0, run_pass());
    ir->count--;
    TEST_ASSERT_EQUAL_UINT(1, run_pass());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(numbers_of_sixteen_bits_have_the_same_quotients);
    RUN_TEST(random_numbers_have_the_same_quotients);
    RUN_TEST(quotients_next_to_a_middle_are_the_same);
    RUN_TEST(divisions_by_one_constant_share_its_literals);
    RUN_TEST(a_divisor_that_is_used_otherwise_stays);
    RUN_TEST(other_divisions_stay);
    RUN_TEST(a_program_without_room_stays);
    return UNITY_END();
}
