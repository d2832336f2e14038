/* The error bounds of the scalar functions of shaders (docs/shader-semantics.md) over the whole range of
 * binary32, compared with double precision, and the results at its edges. */
#include "base/bits.h"
#include "machine/mxcsr.h"
#include "emu/emulate/bind.h"

#include <math.h>
#include <unity.h>

/* The header defines the three routines too, which are not used here. */
#pragma GCC diagnostic ignored "-Wunused-function"
#include "spec/spec.h"

static struct env e;
static unsigned saved;

void setUp(void)
{
    saved = mxcsr_enter();
}

void tearDown(void)
{
    mxcsr_leave(saved);
}

/* A step of a vertex shader, whose functions are exact. */
static struct machine machine;
static const struct step step = {.machine = &machine};

/* The argument is volatile, because compilers do not flush denormals when they fold constants. */
static float evaluate(flt function(struct env *, const struct step *, flt), float x)
{
    volatile float unknown = x;
    return function(&e, &step, lit_f(&e, unknown)).lane[EMULATE_WIDTH - 1];
}

static float raised(float x, float y)
{
    return power_of(&e, &step, lit_f(&e, x), lit_f(&e, y)).lane[EMULATE_WIDTH - 1];
}

static double relative_error(float got, double expected)
{
    return fabs((double)got - expected) / fabs(expected);
}

/* About 100,000 numbers from the smallest normal number to the largest. */
#define EACH_NUMBER(bits) for (uint32_t bits = 0x00800000; bits < 0x7f800000; bits += 21013)

static void exponentials_have_23_bits(void)
{
    double worst = 0;
    for (double x = -126; x < 128; x += 0.00211)
        worst = fmax(worst, relative_error(evaluate(exponential, (float)x), exp2((double)(float)x)));
    TEST_ASSERT_TRUE(worst < 1.2e-7);
}

static void logarithms_have_22_bits(void)
{
    double worst = 0;
    EACH_NUMBER(bits)
    worst = fmax(worst,
                 relative_error(evaluate(logarithm, bits_to_float(bits)), log2((double)bits_to_float(bits))));
    for (uint32_t bits = 0x3f700000; bits < 0x3f900000; bits += 17)
        if (bits != 0x3f800000)
            worst = fmax(worst, relative_error(evaluate(logarithm, bits_to_float(bits)),
                                               log2((double)bits_to_float(bits))));
    TEST_ASSERT_TRUE(worst < 2.1e-7);
}

/* This holds if the result is neither zero nor infinite. */
static void powers_have_15_bits(void)
{
    double worst = 0;
    uint32_t seed = 1;
    EACH_NUMBER(bits)
    {
        float x = bits_to_float(bits);
        double log = log2((double)x);
        seed = seed * 1664525 + 1013904223;
        float y = (float)(((double)seed / 2147483648.0 - 1) * 126 / log);
        if (log == 0 || fabs((double)y * log) > 126)
            continue;
        worst = fmax(worst, relative_error(raised(x, y), exp2((double)y * log)));
    }
    TEST_ASSERT_TRUE(worst < 1.0 / (1 << 15));
}

static void reciprocals_are_correctly_rounded(void)
{
    EACH_NUMBER(bits)
    {
        float x = bits_to_float(bits), expected = (float)(1 / (double)x);
        TEST_ASSERT_EQUAL_HEX32(bits_of_float(lane_flush(expected)), bits_of_float(evaluate(reciprocal, x)));
    }
    TEST_ASSERT_TRUE(evaluate(reciprocal, 1) == 1);
    TEST_ASSERT_TRUE(evaluate(reciprocal, 0) == FLT_MAX && evaluate(reciprocal, -0.0f) == FLT_MAX);
    TEST_ASSERT_TRUE(evaluate(reciprocal, 1e-40f) == FLT_MAX && evaluate(reciprocal, INFINITY) == 0);
}

static void reciprocal_roots_have_23_bits(void)
{
    double worst = 0;
    EACH_NUMBER(bits)
    worst = fmax(worst, relative_error(evaluate(reciprocal_root, bits_to_float(bits)),
                                       1 / sqrt((double)bits_to_float(bits))));
    TEST_ASSERT_TRUE(worst < 9e-8);
    TEST_ASSERT_TRUE(evaluate(reciprocal_root, 1) == 1 && evaluate(reciprocal_root, 0) == FLT_MAX);
}

static void powers_of_and_to_edges(void)
{
    TEST_ASSERT_TRUE(raised(0, 0) == 1 && raised(NAN, 0) == 1 && raised(INFINITY, -0.0f) == 1);
    TEST_ASSERT_TRUE(raised(0, 2) == 0 && isinf(raised(0, -2)));
    TEST_ASSERT_TRUE(raised(-2, 3) == 8 && raised(2, -1) == 0.5f);
    TEST_ASSERT_TRUE(isinf(raised(INFINITY, 0.5f)) && raised(INFINITY, -0.5f) == 0);
    TEST_ASSERT_TRUE(isnan(raised(NAN, 1)) && isnan(raised(2, NAN)) && isnan(raised(1, INFINITY)));
    TEST_ASSERT_TRUE(raised(2, 200) == INFINITY && raised(2, -200) == 0 && raised(0.5f, INFINITY) == 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(exponentials_have_23_bits);
    RUN_TEST(logarithms_have_22_bits);
    RUN_TEST(powers_have_15_bits);
    RUN_TEST(reciprocals_are_correctly_rounded);
    RUN_TEST(reciprocal_roots_have_23_bits);
    RUN_TEST(powers_of_and_to_edges);
    return UNITY_END();
}
