/* The error bounds that spec/transcendental.h states, over whole ranges, against double precision. */
#include "base/mxcsr.h"
#include "emu/bind.h"

#include <math.h>
#include <unity.h>

#include "spec/transcendental.h"

static unsigned saved;

void setUp(void)
{
    saved = mxcsr_enter();
}

void tearDown(void)
{
    mxcsr_leave(saved);
}

static float evaluate(flt function(struct env *, flt), float x)
{
    static struct env e;
    return function(&e, lit_f(&e, x)).lane[EMULATE_WIDTH - 1];
}

static double relative_error(float got, double expected)
{
    return fabs((double)got - expected) / expected;
}

static void a_power_of_two_is_within_its_bound(void)
{
    double worst = 0;
    for (double x = -125.9; x < 127.99; x += 0.000713)
        worst = fmax(worst, relative_error(evaluate(exponential2, (float)x), exp2((double)(float)x)));
    for (double x = -1; x < 1; x += 0.0000173)
        worst = fmax(worst, relative_error(evaluate(exponential2, (float)x), exp2((double)(float)x)));
    TEST_ASSERT_TRUE_MESSAGE(worst < 1.2e-7, "relative error of exponential2");
}

static void whole_powers_are_exact(void)
{
    for (int n = -126; n < 128; n++)
        TEST_ASSERT_EQUAL_FLOAT(ldexpf(1, n), evaluate(exponential2, (float)n));
}

static void beyond_the_range_powers_are_zero_and_infinite(void)
{
    TEST_ASSERT_TRUE(evaluate(exponential2, -126.001f) == 0);
    TEST_ASSERT_TRUE(evaluate(exponential2, -1e30f) == 0);
    TEST_ASSERT_TRUE(evaluate(exponential2, -INFINITY) == 0);
    TEST_ASSERT_TRUE(evaluate(exponential2, NAN) == 0);
    TEST_ASSERT_TRUE(isinf(evaluate(exponential2, 128)));
    TEST_ASSERT_TRUE(isinf(evaluate(exponential2, INFINITY)));
}

static void a_logarithm_is_within_its_bounds(void)
{
    double worst_absolute = 0, worst_relative = 0;
    for (double y = -125.99; y < 127.99; y += 0.000237) {
        float x = (float)exp2(y);
        double expected = log2((double)x), error = fabs((double)evaluate(logarithm2, x) - expected);
        if (fabs(expected) < 1)
            worst_absolute = fmax(worst_absolute, error);
        else
            worst_relative = fmax(worst_relative, error / fabs(expected));
    }
    TEST_ASSERT_TRUE_MESSAGE(worst_absolute < 1.5e-7, "absolute error of logarithm2");
    TEST_ASSERT_TRUE_MESSAGE(worst_relative < 1.2e-7, "relative error of logarithm2");
}

static void logarithms_of_powers_are_exact(void)
{
    for (int n = -126; n < 128; n++)
        TEST_ASSERT_EQUAL_FLOAT((float)n, evaluate(logarithm2, ldexpf(1, n)));
    TEST_ASSERT_TRUE(evaluate(logarithm2, 0) <= -126);
    TEST_ASSERT_EQUAL_FLOAT(3, evaluate(logarithm2, -8));
}

static void powers_are_within_their_bound(void)
{
    static struct env e;
    for (int i = 1; i <= 1000; i++)
        for (int j = 0; j <= 400; j++) {
            float x = (float)i / 1000, y = (float)(j * j) / 300;
            double exact = pow((double)x, (double)y), exponent = fabs((double)y * log2((double)x));
            if (exponent > 124)
                continue;
            float got = power(&e, lit_f(&e, x), lit_f(&e, y)).lane[0];
            TEST_ASSERT_TRUE(relative_error(got, exact) <= 2e-7 + 1.5e-7 * (double)y + 2e-7 * exponent);
        }
    TEST_ASSERT_EQUAL_FLOAT(1, power(&e, lit_f(&e, 1), lit_f(&e, 1000)).lane[0]);
    TEST_ASSERT_EQUAL_FLOAT(1, power(&e, lit_f(&e, 0.3f), lit_f(&e, 0)).lane[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_power_of_two_is_within_its_bound);
    RUN_TEST(whole_powers_are_exact);
    RUN_TEST(beyond_the_range_powers_are_zero_and_infinite);
    RUN_TEST(a_logarithm_is_within_its_bounds);
    RUN_TEST(logarithms_of_powers_are_exact);
    RUN_TEST(powers_are_within_their_bound);
    return UNITY_END();
}
