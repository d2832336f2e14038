/* Expressions: values to the last bit, the order of operations, variables. The file errors.def has those that
 * are refused. */
#include "command/stream/expression.h"
#include "command/stream/lex.h"
#include "command/stream/sine.h"

#include <math.h>
#include <string.h>
#include <unity.h>

static struct error error;
static struct expression_scope scope;
static struct lexer lexer;

void setUp(void)
{
    error_clear(&error);
    expression_start(&scope);
    lexer = (struct lexer){.path = "t", .scope = &scope, .error = &error};
}

void tearDown(void)
{
}

static struct token token_of(const char *text)
{
    return (struct token){TOKEN_EXPRESSION, text, strlen(text), 1, 1};
}

static double value_of(const char *text)
{
    struct token token = token_of(text);
    double value = NAN;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, expression_value(&lexer, &token, &value), error.text);
    return value;
}

static void expect_value(const char *text, double expected)
{
    double value = value_of(text);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &value, sizeof value, text);
}

static void products_come_before_sums_and_equals_from_the_left(void)
{
    expect_value("1 + 2 * 3", 7);
    expect_value("(1 + 2) * 3", 9);
    expect_value("10 - 4 - 3", 3);
    expect_value("24 / 4 / 2", 3);
    expect_value("7 % 4 * 2", 6);
    expect_value("-2 * -3", 6);
    expect_value(" - ( 1+2 ) ", -3);
    expect_value("2 - -1", 3);
}

static void numbers_have_the_forms_of_streams(void)
{
    expect_value("0.1", 0.1);
    expect_value(".5", 0.5);
    expect_value("1e-3", 1e-3);
    expect_value("0xff202020", 4280295456.0);
    expect_value("0x1.8p+1", 3);
    expect_value("1.5e2+1", 151);
}

static void every_operation_is_rounded_once(void)
{
    expect_value("0.1 + 0.2", 0x1.3333333333334p-2);
    expect_value("1 / 3", 0x1.5555555555555p-2);
    expect_value("sqrt(2)", 0x1.6a09e667f3bcdp+0);
    expect_value("3 * 0.1 - 0.3", 0x1p-54);
}

static void a_remainder_has_the_sign_of_the_divisor(void)
{
    expect_value("7 % 3", 1);
    expect_value("-1 % 3", 2);
    expect_value("1 % -3", -2);
    expect_value("-7 % -3", -1);
    expect_value("6 % 3", 0);
    expect_value("5.5 % 2", 1.5);
}

static void functions_compute_what_they_are_named_after(void)
{
    expect_value("abs(-2.5)", 2.5);
    expect_value("floor(-2.5)", -3);
    expect_value("ceil(-2.5)", -2);
    expect_value("round(2.5) + round(-2.5) + round(3.4)", 3);
    expect_value("min(2, -3)", -3);
    expect_value("max(2, -3)", 2);
    expect_value("color(1, 0.5, 0, 2)", 0xffff8000);
    expect_value("color(-1, 0, 1, 0)", 0x000000ff);
    expect_value("min(max(1, 2), sqrt(9))", 2);
}

/* Every build and every processor gives these bits. */
static void sine_and_cosine_have_these_bits(void)
{
    static const struct {
        double x, sine, cosine;
    } rows[] = {
        {0, 0, 1},
        {0.5, 0x1.eaee8744b05fp-2, 0x1.c1528065b7d5p-1},
        {1, 0x1.aed548f090ceep-1, 0x1.14a280fb5068cp-1},
        {2, 0x1.d18f6ead1b446p-1, -0x1.aa22657537205p-2},
        {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53, -1},
        {4, -0x1.837b9dddc1eaep-1, -0x1.4eaa606db24c1p-1},
        {100, -0x1.03425b78c4db8p-1, 0x1.b981dbf665fep-1},
        {-0.3, -0x1.2e9cd95baba33p-2, 0x1.e921dd42f09bap-1},
        {1000000, -0x1.6664b2568d867p-2, 0x1.df9df9906d32cp-1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        TEST_ASSERT_TRUE(sine_of(rows[i].x) == rows[i].sine);
        TEST_ASSERT_TRUE(sine_of_complement(rows[i].x) == rows[i].cosine);
    }
}

static void expect_near(double expected, double value)
{
    double unit = nextafter(fabs(expected), 2) - fabs(expected);
    TEST_ASSERT_DOUBLE_WITHIN(4 * unit, expected, value);
}

/* The C library's error is less than one unit in the last place. */
static void sine_and_cosine_agree_with_the_library_to_four_units(void)
{
    for (double x = -SINE_MOST; x < SINE_MOST; x += 173.2176) {
        expect_near(sin(x), sine_of(x));
        expect_near(cos(x), sine_of_complement(x));
    }
    for (double x = -7; x < 7; x += 0.001953) {
        expect_near(sin(x), sine_of(x));
        expect_near(cos(x), sine_of_complement(x));
    }
    TEST_ASSERT_TRUE(isnan(sine_of(SINE_MOST + 1.0)) && isnan(sine_of(INFINITY)) && isnan(sine_of(NAN)));
}

static void a_variable_has_its_last_value(void)
{
    struct token a = token_of("a"), long_name = token_of("a_1");
    TEST_ASSERT_EQUAL_INT(0, expression_set(&lexer, &a, 1, 3));
    TEST_ASSERT_EQUAL_INT(0, expression_set(&lexer, &long_name, 3, 5));
    TEST_ASSERT_EQUAL_INT(0, expression_set(&lexer, &a, 1, 4));
    TEST_ASSERT_EQUAL_UINT(2, scope.variable_count);
    expect_value("a*a_1", 20);
    scope.builtin[EXPRESSION_frame] = 7;
    expect_value("2 * frame + floor(pi)", 17);
}

static void more_variables_than_the_limit_are_refused(void)
{
    static char names[LIMIT_VARIABLES + 1][4];
    for (int i = 0; i <= LIMIT_VARIABLES; i++) {
        struct token token = token_of(names[i]);
        names[i][0] = 'v';
        names[i][1] = (char)('0' + i / 10);
        names[i][2] = (char)('0' + i % 10);
        TEST_ASSERT_EQUAL_INT(i < LIMIT_VARIABLES ? 0 : -1, expression_add(&lexer, &token, 3, i));
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "expected at most 64 variables"), error.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(products_come_before_sums_and_equals_from_the_left);
    RUN_TEST(numbers_have_the_forms_of_streams);
    RUN_TEST(every_operation_is_rounded_once);
    RUN_TEST(a_remainder_has_the_sign_of_the_divisor);
    RUN_TEST(functions_compute_what_they_are_named_after);
    RUN_TEST(sine_and_cosine_have_these_bits);
    RUN_TEST(sine_and_cosine_agree_with_the_library_to_four_units);
    RUN_TEST(a_variable_has_its_last_value);
    RUN_TEST(more_variables_than_the_limit_are_refused);
    return UNITY_END();
}
