/* The error bounds in spec/math/transcendental.h, checked over whole ranges with double precision. */
#include "base/bits.h"
#include "machine/mxcsr.h"
#include "emu/emulate/bind.h"

#include "tests/support/system/seed.h"

#include <math.h>
#include <unity.h>

#include "spec/math/transcendental.h"

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
    for (double x = -125.9; x < 127.99; x += 0.000713 * test_stride_of(10))
        worst = fmax(worst, relative_error(evaluate(exponential2, (float)x), exp2((double)(float)x)));
    for (double x = -1; x < 1; x += 0.0000173 * test_stride_of(10))
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
    for (double y = -125.99; y < 127.99; y += 0.000237 * test_stride_of(10)) {
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
    for (unsigned i = 1; i <= 1000; i += test_stride_of(11))
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

struct circle {
    float sine, cosine;
};

static struct circle circle(float x)
{
    static struct env e;
    flt sine, cosine, alone;
    sine_cosine(&e, lit_f(&e, x), &sine, &cosine);
    sine_cosine(&e, lit_f(&e, x), &alone, NULL);
    TEST_ASSERT_EQUAL_MEMORY(&sine, &alone, sizeof sine);
    sine_cosine(&e, lit_f(&e, x), NULL, &alone);
    TEST_ASSERT_EQUAL_MEMORY(&cosine, &alone, sizeof cosine);
    return (struct circle){sine.lane[0], cosine.lane[0]};
}

/* The larger error of the two. */
static double circle_error(struct circle got, double x)
{
    return fmax(fabs(got.sine - sin(x)), fabs(got.cosine - cos(x)));
}

static void sine_and_cosine_are_within_their_bounds(void)
{
    double worst = 0;
    for (double x = -3.141592654; x <= 3.141592654; x += 0.0000211 * test_stride_of(10))
        worst = fmax(worst, circle_error(circle((float)x), (double)(float)x));
    TEST_ASSERT_TRUE_MESSAGE(worst < 3e-7, "error of sine_cosine within a turn");
    for (double x = 3; x < 1e6; x *= 1 + 0.000171 * test_stride_of(10)) {
        double at = (double)(float)x;
        TEST_ASSERT_TRUE(circle_error(circle((float)at), at) < 1.2e-7 + 1.1e-7 * at);
        TEST_ASSERT_TRUE(circle_error(circle((float)-at), -at) < 1.2e-7 + 1.1e-7 * at);
    }
}

static void sines_of_small_angles_are_accurate_relatively(void)
{
    double worst = 0;
    for (double x = 0.5; x > 1e-30; x *= 1 - 0.00069 * test_stride_of(10))
        worst = fmax(worst, relative_error(circle((float)x).sine, sin((double)(float)x)));
    TEST_ASSERT_TRUE_MESSAGE(worst < 1.8e-7, "relative error of sine_cosine");
}

static void sine_and_cosine_never_leave_the_unit(void)
{
    for (uint64_t bits = 0; bits < 0x7f800000; bits += 2777 * test_stride_of(10)) {
        struct circle up = circle(bits_to_float((uint32_t)bits));
        struct circle down = circle(bits_to_float((uint32_t)bits | 0x80000000u));
        TEST_ASSERT_TRUE(fabsf(up.sine) <= 1 && fabsf(up.cosine) <= 1);
        TEST_ASSERT_TRUE(fabsf(down.sine) <= 1 && fabsf(down.cosine) <= 1);
    }
}

static void sine_and_cosine_at_the_edges(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x00000000, bits_of_float(circle(0.0f).sine));
    TEST_ASSERT_EQUAL_HEX32(0x80000000, bits_of_float(circle(-0.0f).sine));
    TEST_ASSERT_TRUE(circle(0).cosine == 1 && circle(-0.0f).cosine == 1);
    TEST_ASSERT_TRUE(circle(0x1.921fb6p+0f).sine == 1 && circle(0x1.921fb6p+1f).cosine == -1);
    TEST_ASSERT_TRUE(circle(0x1p26f).sine == 0 && fabsf(circle(FLT_MAX).cosine) == 1);
    TEST_ASSERT_TRUE(isnan(circle(INFINITY).sine) && isnan(circle(-INFINITY).cosine));
    TEST_ASSERT_TRUE(isnan(circle(NAN).sine) && isnan(circle(NAN).cosine));
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
    RUN_TEST(sine_and_cosine_are_within_their_bounds);
    RUN_TEST(sines_of_small_angles_are_accurate_relatively);
    RUN_TEST(sine_and_cosine_never_leave_the_unit);
    RUN_TEST(sine_and_cosine_at_the_edges);
    return UNITY_END();
}
