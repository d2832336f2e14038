/* Hash tables of both widths find all entered items, also if their hashes collide. Growth keeps every
 * number. */
#include "base/hash.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

enum { ITEMS = 5000 };

static uint32_t item[ITEMS + 1];

struct wanted {
    uint32_t value;
};

static bool is_wanted(const void *context, uint32_t number)
{
    return item[number] == ((const struct wanted *)context)->value;
}

/* Few values, so that most items collide. */
static uint32_t hash_value(uint32_t value)
{
    return value % 7 * 0x9e3779b1u >> 20;
}

static uint32_t find(struct hash_table table, uint32_t value)
{
    const struct wanted wanted = {value};
    return hash_find(table, hash_value(value), is_wanted, &wanted);
}

static void check_width(struct hash_table table, uint32_t count)
{
    for (uint32_t number = 1; number <= count; number++) {
        item[number] = number * 3;
        uint32_t slot = find(table, item[number]);
        TEST_ASSERT_EQUAL_UINT32(0, hash_get(table, slot));
        hash_set(table, slot, number);
    }
    for (uint32_t number = 1; number <= count; number++)
        TEST_ASSERT_EQUAL_UINT32(number, hash_get(table, find(table, item[number])));
    TEST_ASSERT_EQUAL_UINT32(0, hash_get(table, find(table, 1)));
}

static void test_narrow_and_wide_tables_find_their_items(void)
{
    static uint16_t narrow[256];
    static uint32_t wide[256];
    check_width((struct hash_table){narrow, 255, false}, 255);
    check_width((struct hash_table){wide, 255, true}, 255);
}

static void test_slots_are_at_least_twice_the_items(void)
{
    TEST_ASSERT_EQUAL_UINT32(64, hash_slots(0, 64));
    TEST_ASSERT_EQUAL_UINT32(64, hash_slots(32, 64));
    TEST_ASSERT_EQUAL_UINT32(128, hash_slots(33, 64));
    TEST_ASSERT_EQUAL_UINT32(131072, hash_slots(65536, 16));
}

static uint32_t hash_item(const void *context, uint32_t number)
{
    (void)context;
    return item[number] * 0x9e3779b1u >> 8;
}

static void test_a_growing_table_keeps_every_number(void)
{
    struct hash_table table = {0};
    for (uint32_t number = 1; number <= ITEMS; number++) {
        const struct wanted wanted = {item[number] = number * number};
        TEST_ASSERT_EQUAL_INT(0, hash_reserve(&table, number - 1, hash_item, NULL));
        TEST_ASSERT_TRUE(2 * number <= table.mask + 1);
        uint32_t slot = hash_find(table, hash_item(NULL, number), is_wanted, &wanted);
        TEST_ASSERT_EQUAL_UINT32(0, hash_get(table, slot));
        hash_set(table, slot, number);
    }
    for (uint32_t number = 1; number <= ITEMS; number++) {
        const struct wanted wanted = {item[number]};
        TEST_ASSERT_EQUAL_UINT32(
            number, hash_get(table, hash_find(table, hash_item(NULL, number), is_wanted, &wanted)));
    }
    free(table.slot);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_narrow_and_wide_tables_find_their_items);
    RUN_TEST(test_slots_are_at_least_twice_the_items);
    RUN_TEST(test_a_growing_table_keeps_every_number);
    return UNITY_END();
}
