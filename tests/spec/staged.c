/* Staged control: if, switch, for, while, do, goto and recursion of the host decide what is recorded, and
 * leave nothing else in the recording. */
#include "ir/bind.h"
#include "spec/math/vector.h"
#include "spec/pixel/compare.h"
#include "spec/pixel/stage.h"
#include <unity.h>

#include <stdlib.h>

static struct ir ir;
static struct env env, *const e = &env;

void setUp(void)
{
    ir_start(&ir);
    env = (struct env){.ir = &ir};
}

void tearDown(void)
{
    TEST_ASSERT_NULL(ir_verify(&ir));
}

/* The operations of the table that have been recorded: no literals, memory or control. */
static unsigned emissions(void)
{
    unsigned count = 0;
    for (uint32_t n = 1; n < ir.count; n++)
        count += (ir_properties(&ir.instruction[n]) & IR_COMPUTES) != 0;
    return count;
}

static unsigned emissions_of(enum ir_op op)
{
    unsigned count = 0;
    for (uint32_t n = 1; n < ir.count; n++)
        count += ir.instruction[n].op == op;
    return count;
}

/* The recording from an instruction on, a line for each. */
static void expect_recording(uint32_t from, const char *expected)
{
    char text[4000] = "";
    FILE *out = fmemopen(text, sizeof text, "w");
    TEST_ASSERT_NOT_NULL(out);
    for (uint32_t n = from; n < ir.count; n++) {
        fprintf(out, "%%%u ", n);
        ir_print_instruction(&ir, n, out);
        fputc('\n', out);
    }
    fclose(out);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static flt x_of(int number)
{
    return load_f(E, BASE_INPUT, 64 * number);
}

/* --- One operation for each branch ---------------------------------------------------------------------- */

static flt add_or_subtract(bool adds, flt x, flt y)
{
    return adds ? add_f(E, x, y) : sub_f(E, x, y);
}

static void test_a_conditional_expression_records_one_operation(void)
{
    for (int adds = 0; adds < 2; adds++) {
        ir_start(&ir);
        flt x = x_of(0), y = x_of(1);
        add_or_subtract(adds, x, y);
        TEST_ASSERT_EQUAL(1, emissions());
        TEST_ASSERT_EQUAL(adds, emissions_of(IR_add_f));
        TEST_ASSERT_EQUAL(!adds, emissions_of(IR_sub_f));
        TEST_ASSERT_EQUAL(4, ir.count); /* with the empty instruction 0 and two loads */
    }
}

/* Every branch of the specification's comparison. */
static void test_each_comparison_records_one_comparison(void)
{
    static const uint8_t operations[COMPARE_COUNT] = {
        [COMPARE_LESS] = 2,    [COMPARE_EQUAL] = 2,     [COMPARE_LESS_EQUAL] = 2,
        [COMPARE_GREATER] = 2, [COMPARE_NOT_EQUAL] = 2, [COMPARE_GREATER_EQUAL] = 2};
    for (int function = 0; function < COMPARE_COUNT; function++) {
        ir_start(&ir);
        itg a = load_i(E, BASE_INPUT, 0), b = load_i(E, BASE_INPUT, 64);
        keep_compared(E, function, a, b, lit_m(E, -1));
        TEST_ASSERT_EQUAL(operations[function], emissions());
        TEST_ASSERT_EQUAL(operations[function] / 2, emissions_of(IR_gt_i) + emissions_of(IR_eq_i));
        TEST_ASSERT_EQUAL(0, emissions_of(IR_when) + emissions_of(IR_select_i));
    }
}

static unsigned emissions_of_stage(int operation)
{
    ir_start(&ir);
    itg word = load_i(E, BASE_INPUT, 0);
    fix a = fix_of(E, word), b = fix_of(E, word), c = fix_of(E, word);
    stage_combine(E, operation, a, b, c);
    return emissions();
}

static unsigned emissions_of_function(fix (*function)(struct env *, fix, fix))
{
    ir_start(&ir);
    itg word = load_i(E, BASE_INPUT, 0);
    fix a = fix_of(E, word), b = fix_of(E, word);
    function(E, a, b);
    return emissions();
}

/* Each branch of stage_combine records what its parts do by themselves, and none of another branch. */
static void test_each_stage_records_its_own_operations(void)
{
    unsigned add = emissions_of_function(add_saturated), sub = emissions_of_function(subtract_saturated);
    unsigned mul = emissions_of_function(modulate), signed_sum = emissions_of_function(add_signed);
    TEST_ASSERT_EQUAL(1 + sub, signed_sum);
    TEST_ASSERT_EQUAL(add, emissions_of_stage(STAGE_ADD));
    TEST_ASSERT_EQUAL(sub, emissions_of_stage(STAGE_SUBTRACT));
    TEST_ASSERT_EQUAL(signed_sum + 1, emissions_of_stage(STAGE_ADD_SIGNED));
    TEST_ASSERT_EQUAL(signed_sum + add, emissions_of_stage(STAGE_ADD_SIGNED_2X));
    TEST_ASSERT_EQUAL(mul + add, emissions_of_stage(STAGE_MULTIPLY_ADD));
    TEST_ASSERT_EQUAL(mul, emissions_of_stage(STAGE_MODULATE));
    TEST_ASSERT_EQUAL(mul + add, emissions_of_stage(STAGE_MODULATE_2X));
    TEST_ASSERT_EQUAL(mul + 2 * add, emissions_of_stage(STAGE_MODULATE_4X));
}

/* The same line by calls of the builder, as a compiler's library would need it. */
static uint16_t one_minus_by_calls(uint16_t x)
{
    struct ir_instruction one = {.op = IR_literal, .type = TYPE_flt};
    one.k = (int32_t)bits_of_float(1.0f);
    uint16_t literal = ir_append(&ir, one);
    struct ir_instruction difference = {.op = IR_sub_f, .type = TYPE_flt};
    difference.operand[0] = literal;
    difference.operand[1] = x;
    return ir_append(&ir, difference);
}

static flt one_minus(flt x)
{
    return sub_f(E, lit_f(E, 1.0f), x);
}

static void test_a_line_of_the_language_is_several_calls_of_the_builder(void)
{
    static const char expected[] = "%2 flt  literal   1\n"
                                   "%3 flt  sub_f     %2 %1\n";
    one_minus(x_of(0));
    expect_recording(2, expected);
    ir_start(&ir);
    one_minus_by_calls(x_of(0).id);
    expect_recording(2, expected);
}

/* --- Loops and jumps of the host ------------------------------------------------------------------------ */

/* x to the power of n, by squares. */
static flt power(flt x, unsigned n)
{
    flt r = x;
    bool any = false;
    while (n) {
        if (n & 1)
            r = any ? mul_f(E, r, x) : x;
        any |= n & 1;
        n >>= 1;
        if (n)
            x = mul_f(E, x, x);
    }
    return r;
}

static void test_while_of_the_host(void)
{
    power(x_of(0), 13); /* x * x^4 * x^8 */
    expect_recording(2, "%2 flt  mul_f     %1 %1\n"
                        "%3 flt  mul_f     %2 %2\n"
                        "%4 flt  mul_f     %1 %3\n"
                        "%5 flt  mul_f     %3 %3\n"
                        "%6 flt  mul_f     %4 %5\n");
}

/* A polynomial by Horner's rule; it ends at the first coefficient that is 0. */
static flt polynomial(flt x, const float *coefficient)
{
    flt r = lit_f(E, *coefficient);
next:
    if (!*++coefficient)
        goto done;
    r = mad_f(E, r, x, lit_f(E, *coefficient));
    goto next;
done:
    return r;
}

static void test_goto_of_the_host(void)
{
    polynomial(x_of(0), (const float[]){3, 5, 7, 0, 9});
    expect_recording(2, "%2 flt  literal   3\n"
                        "%3 flt  literal   5\n"
                        "%4 flt  mad_f     %2 %1 %3\n"
                        "%5 flt  literal   7\n"
                        "%6 flt  mad_f     %4 %1 %5\n");
}

/* The sum of n values, added in pairs. */
static flt sum_of(int from, int n)
{
    if (n == 1)
        return x_of(from);
    flt low = sum_of(from, n / 2);
    flt high = sum_of(from + n / 2, n - n / 2);
    return add_f(E, low, high);
}

static void test_recursion_of_the_host(void)
{
    sum_of(0, 3);
    expect_recording(1, "%1 flt  load      INPUT+0\n"
                        "%2 flt  load      INPUT+64\n"
                        "%3 flt  load      INPUT+128\n"
                        "%4 flt  add_f     %2 %3\n"
                        "%5 flt  add_f     %1 %4\n");
}

/* A program of letters. */
static flt calculate(flt x, const char *text)
{
    do
        switch (*text) {
        case 'n': x = neg_f(E, x); break;
        case 's': x = mul_f(E, x, x); /* fall through */
        case 'r': x = sqrt_f(E, x); break;
        default: continue;
        }
    while (*++text);
    return x;
}

static void test_switch_and_do_of_the_host(void)
{
    calculate(x_of(0), "ns-r");
    expect_recording(2, "%2 flt  neg_f     %1\n"
                        "%3 flt  mul_f     %2 %2\n"
                        "%4 flt  sqrt_f    %3\n"
                        "%5 flt  sqrt_f    %4\n");
}

/* --- Templates: a product of matrices of any size ------------------------------------------------------- */

enum { SIZE = 4 };

struct matrix {
    flt m[SIZE][SIZE];
};

static struct matrix matrix_of(int first, int size)
{
    struct matrix r = {0};
    for (int i = 0; i < size * size; i++)
        r.m[i / size][i % size] = x_of(first + i);
    return r;
}

/* The generic product. Its loops run when it is recorded. */
static struct matrix multiply(const struct matrix *a, const struct matrix *b, int size)
{
    struct matrix r = {0};
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++)
            for (int k = 0; k < size; k++) {
                flt product = mul_f(E, a->m[i][k], b->m[k][j]);
                r.m[i][j] = k ? add_f(E, r.m[i][j], product) : product;
            }
    return r;
}

/* The product of two rows and columns, written out. */
static flt inner(flt a0, flt b0, flt a1, flt b1)
{
    flt first = mul_f(E, a0, b0);
    flt second = mul_f(E, a1, b1);
    return add_f(E, first, second);
}

static struct matrix multiply_two(const struct matrix *a, const struct matrix *b)
{
    struct matrix r = {0};
    r.m[0][0] = inner(a->m[0][0], b->m[0][0], a->m[0][1], b->m[1][0]);
    r.m[0][1] = inner(a->m[0][0], b->m[0][1], a->m[0][1], b->m[1][1]);
    r.m[1][0] = inner(a->m[1][0], b->m[0][0], a->m[1][1], b->m[1][0]);
    r.m[1][1] = inner(a->m[1][0], b->m[0][1], a->m[1][1], b->m[1][1]);
    return r;
}

static void test_a_recorded_generic_product_is_the_product_written_out(void)
{
    static struct ir generic;
    struct matrix a = matrix_of(0, 2), b = matrix_of(4, 2);
    multiply(&a, &b, 2);
    generic = ir;
    ir_start(&ir);
    a = matrix_of(0, 2);
    b = matrix_of(4, 2);
    multiply_two(&a, &b);
    TEST_ASSERT_EQUAL(generic.count, ir.count);
    for (uint32_t n = 1; n < ir.count; n++) {
        const struct ir_instruction *x = generic.instruction + n, *y = ir.instruction + n;
        TEST_ASSERT_EQUAL(x->op, y->op);
        TEST_ASSERT_EQUAL_MEMORY(x->operand, y->operand, sizeof x->operand);
    }
    TEST_ASSERT_EQUAL(8, emissions_of(IR_mul_f));
    TEST_ASSERT_EQUAL(4, emissions_of(IR_add_f));
}

static void test_each_size_is_a_recording_of_its_own(void)
{
    for (int size = 1; size <= SIZE; size++) {
        ir_start(&ir);
        struct matrix a = matrix_of(0, size), b = matrix_of(size * size, size);
        multiply(&a, &b, size);
        TEST_ASSERT_EQUAL(size * size * (2 * size - 1), emissions());
        TEST_ASSERT_EQUAL(0, emissions_of(IR_loop) + emissions_of(IR_when));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_conditional_expression_records_one_operation);
    RUN_TEST(test_each_comparison_records_one_comparison);
    RUN_TEST(test_each_stage_records_its_own_operations);
    RUN_TEST(test_a_line_of_the_language_is_several_calls_of_the_builder);
    RUN_TEST(test_while_of_the_host);
    RUN_TEST(test_goto_of_the_host);
    RUN_TEST(test_recursion_of_the_host);
    RUN_TEST(test_switch_and_do_of_the_host);
    RUN_TEST(test_a_recorded_generic_product_is_the_product_written_out);
    RUN_TEST(test_each_size_is_a_recording_of_its_own);
    return UNITY_END();
}
