/* The tables of sRGB, computed again from the standard's formula. */
#include "base/srgb.h"

#include <math.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static long double linear(long double encoded)
{
    return encoded <= 0.04045L ? encoded / 12.92L : powl((encoded + 0.055L) / 1.055L, 2.4L);
}

/* binary64 is precise enough except next to a tie, where either neighbour is within that precision. */
static void decoded_values_are_the_nearest(void)
{
    for (int code = 0; code < 256; code++) {
        long double exact = linear(code / 255.0L);
        float value = srgb_tables.decoded[code];
        long double off = fabsl((long double)value - exact), tolerance = exact * 1e-17L;
        TEST_ASSERT_TRUE(off <= fabsl((long double)nextafterf(value, -1) - exact) + tolerance);
        TEST_ASSERT_TRUE(off <= fabsl((long double)nextafterf(value, 2) - exact) + tolerance);
    }
    TEST_ASSERT_EQUAL_FLOAT(0, srgb_tables.decoded[0]);
    TEST_ASSERT_EQUAL_FLOAT(1, srgb_tables.decoded[255]);
}

/* Compared as encoded values, numbers from `least` on are nearer to the code than to the previous one. */
static void least_values_begin_their_codes(void)
{
    for (int code = 1; code < 256; code++) {
        long double middle = linear((code - 0.5L) / 255);
        float least = srgb_tables.least[code];
        TEST_ASSERT_TRUE((long double)least >= middle);
        TEST_ASSERT_TRUE((long double)nextafterf(least, -1) < middle);
    }
    TEST_ASSERT_EQUAL_FLOAT(0, srgb_tables.least[0]);
    TEST_ASSERT_TRUE(isinf(srgb_tables.least[256]));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(decoded_values_are_the_nearest);
    RUN_TEST(least_values_begin_their_codes);
    return UNITY_END();
}
