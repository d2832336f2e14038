/* Floats and their bits: known pairs, and conversions of bit patterns at a stride to floats and back, NaN
 * included. */
#include "base/bits.h"

#include <math.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_known_numbers_have_their_bits(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x3f800000, bits_of_float(1));
    TEST_ASSERT_EQUAL_HEX32(0x80000000, bits_of_float(-0.0f));
    TEST_ASSERT_EQUAL_HEX32(0x7f800000, bits_of_float(INFINITY));
    TEST_ASSERT_EQUAL_FLOAT(-2.5f, bits_to_float(0xc0200000));
    TEST_ASSERT_TRUE(isnan(bits_to_float(0x7fc00001)));
}

static void test_bits_come_back(void)
{
    for (uint64_t bits = 0; bits <= UINT32_MAX; bits += 65521)
        TEST_ASSERT_EQUAL_HEX32((uint32_t)bits, bits_of_float(bits_to_float((uint32_t)bits)));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_known_numbers_have_their_bits);
    RUN_TEST(test_bits_come_back);
    return UNITY_END();
}
