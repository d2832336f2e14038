/* The error bounds in spec/math/approximate.h, checked over whole ranges with double precision, and what the
 * state `precision` changes. */
#include "machine/mxcsr.h"
#include "emu/emulate/bind.h"
#include "tests/support/picture/derivation.h"

#include <math.h>
#include <unity.h>

#include "spec/math/approximate.h"

enum { LEVELS = PRECISION_COUNT };

static unsigned saved;

void setUp(void)
{
    derivation_begin();
    saved = mxcsr_enter();
}

void tearDown(void)
{
    mxcsr_leave(saved);
}

typedef flt leveled(struct env *, int precision, flt);

static double evaluate(leveled *function, int precision, float x)
{
    static struct env e;
    return (double)function(&e, precision, lit_f(&e, x)).lane[EMULATE_WIDTH - 1];
}

static double inverse_root(double x)
{
    return 1 / sqrt(x);
}

static double inverse(double x)
{
    return 1 / x;
}

/* The greatest error for arguments from 2^-125 to 2^125, or with `linear` from -125 to 125. */
static double worst_error(leveled *function, double (*expected)(double), int precision, bool linear,
                          bool absolute)
{
    double worst = 0;
    for (double y = -125; y < 125; y += 0.000731) {
        float x = linear ? (float)y : (float)exp2(y);
        double right = expected((double)x), error = fabs(evaluate(function, precision, x) - right);
        worst = fmax(worst, absolute ? error : error / fabs(right));
    }
    return worst;
}

/* Each level is within its bound, and needs most of it: a level is not better than it claims by chance. */
static void expect_bounds(leveled *function, double (*expected)(double), bool linear, bool absolute,
                          const double bound[LEVELS])
{
    for (int precision = 0; precision < LEVELS; precision++) {
        double worst = worst_error(function, expected, precision, linear, absolute);
        TEST_ASSERT_TRUE_MESSAGE(worst <= bound[precision], "greater than its bound");
        TEST_ASSERT_TRUE_MESSAGE(!precision || worst >= bound[precision] * 0.8, "the bound is too large");
    }
}

static void a_reciprocal_is_within_its_bounds(void)
{
    expect_bounds(reciprocal_of, inverse, false, false, (const double[]){6e-8, 1.4e-4, 2.6e-3});
}

static void a_reciprocal_root_is_within_its_bounds(void)
{
    expect_bounds(reciprocal_root_of, inverse_root, false, false, (const double[]){1.2e-7, 1.1e-4, 1.8e-3});
}

static void a_power_is_within_its_bounds(void)
{
    expect_bounds(exponential2_of, exp2, true, false, (const double[]){1.2e-7, 1.1e-4, 2.7e-3});
}

static void a_logarithm_is_within_its_bounds(void)
{
    expect_bounds(logarithm2_of, log2, false, true, (const double[]){1.6e-5, 1.2e-4, 9e-4});
}

static void a_negative_number_has_the_negative_reciprocal(void)
{
    for (int precision = 0; precision < LEVELS; precision++)
        for (float x = 0.001f; x < 1000; x *= 1.37f)
            TEST_ASSERT_TRUE(evaluate(reciprocal_of, precision, -x) ==
                             -evaluate(reciprocal_of, precision, x));
}

static void whole_powers_are_exact_at_every_precision(void)
{
    for (int precision = 0; precision < LEVELS; precision++)
        for (int n = -126; n < 128; n++)
            TEST_ASSERT_TRUE(evaluate(exponential2_of, precision, (float)n) == ldexp(1, n));
}

/* --- The state ------------------------------------------------------------------------------------------ */

static void the_key_has_the_precision_of_what_w_interpolates(void)
{
    SET(precision, "partial");
    derive();
    TEST_ASSERT_EQUAL_INT(PRECISION_PARTIAL, key[UNIT_PIXEL].pixel.precision);
    SET(precision, "approximate");
    derive();
    TEST_ASSERT_EQUAL_INT(PRECISION_APPROXIMATE, key[UNIT_PIXEL].pixel.precision);
}

static void approximate_precision(void)
{
    SET(precision, "approximate");
}

static void a_draw_without_such_functions_has_the_same_key_at_every_precision(void)
{
    SET(shademode, "flat");
    expect_same_keys(approximate_precision);
    TEST_ASSERT_EQUAL_INT(PRECISION_EXACT, key[UNIT_PIXEL].pixel.precision);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_reciprocal_is_within_its_bounds);
    RUN_TEST(a_reciprocal_root_is_within_its_bounds);
    RUN_TEST(a_power_is_within_its_bounds);
    RUN_TEST(a_logarithm_is_within_its_bounds);
    RUN_TEST(a_negative_number_has_the_negative_reciprocal);
    RUN_TEST(whole_powers_are_exact_at_every_precision);
    RUN_TEST(the_key_has_the_precision_of_what_w_interpolates);
    RUN_TEST(a_draw_without_such_functions_has_the_same_key_at_every_precision);
    return UNITY_END();
}
