/* Rows are reversed, also those those longer than the parts that are exchanged. */
#include "image/rows.h"

#include <stdint.h>
#include <unity.h>

enum { LONGEST = 1300, MOST = 5, GUARD = 0xee };

static uint8_t rows[MOST * LONGEST + 1];

void setUp(void)
{
}

void tearDown(void)
{
}

static uint8_t byte_of(unsigned row, size_t i)
{
    return (uint8_t)(row * 37 + i * 11 + i / 256);
}

static void check(size_t bytes, unsigned count)
{
    for (unsigned row = 0; row < count; row++)
        for (size_t i = 0; i < bytes; i++)
            rows[row * bytes + i] = byte_of(row, i);
    rows[count * bytes] = GUARD;
    rows_reverse(rows, bytes, count);
    for (unsigned row = 0; row < count; row++)
        for (size_t i = 0; i < bytes; i++)
            TEST_ASSERT_EQUAL_HEX8(byte_of(count - 1 - row, i), rows[row * bytes + i]);
    TEST_ASSERT_EQUAL_HEX8(GUARD, rows[count * bytes]);
}

static void test_the_last_row_is_the_first(void)
{
    static const size_t lengths[] = {1, 4, 511, 512, 513, LONGEST};
    for (unsigned count = 0; count <= MOST; count++)
        for (unsigned i = 0; i < sizeof lengths / sizeof *lengths; i++)
            check(lengths[i], count);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_last_row_is_the_first);
    return UNITY_END();
}
