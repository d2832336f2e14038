/* binary16: every value survives the conversion to binary32 and back, and numbers between them round
 * correctly. */
#include "base/half.h"

#include <math.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

/* The value by the definition of the format. */
static double defined(unsigned half)
{
    int exponent = half >> 10 & 31;
    double fraction = half & 0x3ff, sign = half & 0x8000 ? -1 : 1;
    return sign * (exponent ? ldexp(1 + fraction / 1024, exponent - 15) : ldexp(fraction / 1024, -14));
}

static void test_every_finite_half_is_the_value_its_bits_define(void)
{
    for (unsigned half = 0; half < 0x10000; half++)
        if ((half & 0x7c00) != 0x7c00)
            TEST_ASSERT_EQUAL_DOUBLE(defined(half), half_to_float((uint16_t)half));
    TEST_ASSERT_TRUE(isinf(half_to_float(0x7c00)) && half_to_float(0x7c00) > 0);
    TEST_ASSERT_TRUE(isinf(half_to_float(0xfc00)) && half_to_float(0xfc00) < 0);
    TEST_ASSERT_TRUE(isnan(half_to_float(0x7c01)) && isnan(half_to_float(0xffff)));
    TEST_ASSERT_TRUE(signbit(half_to_float(0x8000)));
}

static void test_every_half_comes_back(void)
{
    for (unsigned half = 0; half < 0x10000; half++)
        if ((half & 0x7c00) != 0x7c00 || !(half & 0x3ff))
            TEST_ASSERT_EQUAL_HEX16(half, float_to_half(half_to_float((uint16_t)half)));
    TEST_ASSERT_EQUAL_HEX16(0x7e00, float_to_half(NAN) & 0x7fff);
}

/* Between neighbours, the middle rounds to the even one, other numbers to the nearer one. */
static void test_numbers_between_halves_round_to_nearest_even(void)
{
    for (unsigned half = 0; half < 0x7bff; half++) {
        double low = defined(half), high = defined(half + 1);
        float middle = (float)((low + high) / 2);
        TEST_ASSERT_EQUAL_HEX16(half + (half & 1), float_to_half(middle));
        TEST_ASSERT_EQUAL_HEX16(half, float_to_half(nextafterf(middle, 0)));
        TEST_ASSERT_EQUAL_HEX16(half + 1, float_to_half(nextafterf(middle, INFINITY)));
        TEST_ASSERT_EQUAL_HEX16(0x8000 | (half + (half & 1)), float_to_half(-middle));
    }
    TEST_ASSERT_EQUAL_HEX16(0x7bff, float_to_half(65519.996f));
    TEST_ASSERT_EQUAL_HEX16(0x7c00, float_to_half(65520));
    TEST_ASSERT_EQUAL_HEX16(0xfc00, float_to_half(-1e30f));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_finite_half_is_the_value_its_bits_define);
    RUN_TEST(test_every_half_comes_back);
    RUN_TEST(test_numbers_between_halves_round_to_nearest_even);
    return UNITY_END();
}
