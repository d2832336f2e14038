/* The lesser and the greater: both orders, the ends of the ranges, and the rule for NaN and zeros. */
#include "base/minmax.h"

#include <math.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_order_of_the_arguments_does_not_matter(void)
{
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, min_i32(INT32_MIN, INT32_MAX));
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, min_i32(INT32_MAX, INT32_MIN));
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, max_i32(INT32_MIN, INT32_MAX));
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, max_i32(INT32_MAX, INT32_MIN));
    TEST_ASSERT_EQUAL_UINT32(1, min_u32(1, UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(1, min_u32(UINT32_MAX, 1));
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, max_u32(1, UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, max_u32(UINT32_MAX, 1));
    TEST_ASSERT_TRUE(min_size(1, SIZE_MAX) == 1 && min_size(SIZE_MAX, 1) == 1);
    TEST_ASSERT_TRUE(max_size(1, SIZE_MAX) == SIZE_MAX && max_size(SIZE_MAX, 1) == SIZE_MAX);
    TEST_ASSERT_EQUAL_FLOAT(-1, min_f32(-1, 2));
    TEST_ASSERT_EQUAL_FLOAT(-1, min_f32(2, -1));
    TEST_ASSERT_EQUAL_FLOAT(2, max_f32(-1, 2));
    TEST_ASSERT_EQUAL_FLOAT(2, max_f32(2, -1));
}

static void test_the_result_is_the_second_float_if_one_is_nan_or_both_are_zero(void)
{
    TEST_ASSERT_EQUAL_FLOAT(1, min_f32(NAN, 1));
    TEST_ASSERT_EQUAL_FLOAT(1, max_f32(NAN, 1));
    TEST_ASSERT_TRUE(isnan(min_f32(1, NAN)) && isnan(max_f32(1, NAN)));
    TEST_ASSERT_TRUE(signbit(min_f32(0.0f, -0.0f)) && !signbit(min_f32(-0.0f, 0.0f)));
    TEST_ASSERT_TRUE(signbit(max_f32(0.0f, -0.0f)) && !signbit(max_f32(-0.0f, 0.0f)));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_order_of_the_arguments_does_not_matter);
    RUN_TEST(test_the_result_is_the_second_float_if_one_is_nan_or_both_are_zero);
    return UNITY_END();
}
