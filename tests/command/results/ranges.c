/* Sets as ranges, compared with an array of flags. */
#include "command/results/ranges.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { NUMBERS = 64 };

static struct ranges set;

void setUp(void)
{
}

void tearDown(void)
{
    ranges_free(&set);
}

static void expect_text(const char *expected, const struct ranges *ranges)
{
    char *text = ranges_text(ranges);
    TEST_ASSERT_EQUAL_STRING(expected, text);
    free(text);
}

static void ranges_that_touch_become_one(void)
{
    expect_text("", &set);
    ranges_add(&set, 5, 9);
    ranges_add(&set, 20, 20);
    ranges_add(&set, 0, 2);
    expect_text("0-2,5-9,20", &set);
    ranges_add(&set, 3, 3);
    expect_text("0-3,5-9,20", &set);
    ranges_add(&set, 4, 4);
    expect_text("0-9,20", &set);
    ranges_add(&set, 10, 40);
    expect_text("0-40", &set);
    TEST_ASSERT_EQUAL_UINT64(41, ranges_size(&set));
}

static void the_last_number_of_64_bits_is_kept(void)
{
    ranges_add(&set, UINT64_MAX, UINT64_MAX);
    ranges_add(&set, UINT64_MAX - 1, UINT64_MAX);
    TEST_ASSERT_EQUAL_UINT64(1, set.count);
    TEST_ASSERT_TRUE(ranges_has(&set, UINT64_MAX));
}

static void compare_all(const bool flags[NUMBERS], const struct ranges *ranges)
{
    uint64_t size = 0;
    for (uint64_t n = 0; n < NUMBERS; n++) {
        TEST_ASSERT_EQUAL_INT(flags[n], ranges_has(ranges, n));
        if (flags[n])
            TEST_ASSERT_EQUAL_UINT64(n, ranges_at(ranges, size++));
    }
    TEST_ASSERT_EQUAL_UINT64(size, ranges_size(ranges));
}

static void fill(bool flags[NUMBERS], struct ranges *ranges)
{
    for (int i = rand() % 12; i >= 0; i--) {
        int first = rand() % NUMBERS, last = first + rand() % 9;
        last = last < NUMBERS ? last : NUMBERS - 1;
        ranges_add(ranges, (uint64_t)first, (uint64_t)last);
        memset(flags + first, true, (size_t)(last - first + 1));
    }
}

static void random_sets_have_the_numbers_that_were_added(void)
{
    srand(1);
    for (int round = 0; round < 2000; round++) {
        bool flags[NUMBERS] = {0};
        ranges_clear(&set);
        fill(flags, &set);
        compare_all(flags, &set);
    }
}

static void common_and_missing_numbers_are_those_of_the_flags(void)
{
    srand(2);
    for (int round = 0; round < 2000; round++) {
        bool a[NUMBERS] = {0}, b[NUMBERS] = {0}, both[NUMBERS], without[NUMBERS] = {0};
        struct ranges other = {0}, common = {0}, missing = {0};
        ranges_clear(&set);
        fill(a, &set);
        fill(b, &other);
        int first = rand() % NUMBERS, last = first + rand() % (NUMBERS - first);
        for (int n = 0; n < NUMBERS; n++) {
            both[n] = a[n] && b[n];
            without[n] = !a[n] && n >= first && n <= last;
        }
        ranges_common(&set, &other, &common);
        ranges_missing(&set, (uint64_t)first, (uint64_t)last, &missing);
        compare_all(both, &common);
        compare_all(without, &missing);
        ranges_free(&other);
        ranges_free(&common);
        ranges_free(&missing);
    }
}

static void texts_are_read_as_they_are_written(void)
{
    static const char *const texts[] = {"", "0", "7", "0-1", "0-49,60,62-70", "123456789012345678"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        ranges_clear(&set);
        TEST_ASSERT_TRUE_MESSAGE(ranges_read(texts[i], &set), texts[i]);
        expect_text(texts[i], &set);
    }
}

static void other_texts_are_refused(void)
{
    static const char *const texts[] = {
        "a",   "1,",    ",1",    "1-", "-1",  "2-1",  "1-1",   "2,1",
        "1,2", "1-3,2", "1-2,3", "01", "1 2", "1,,2", "1-2-3", "1234567890123456789",
        "0x1", "1;2"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        ranges_clear(&set);
        TEST_ASSERT_FALSE_MESSAGE(ranges_read(texts[i], &set), texts[i]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(ranges_that_touch_become_one);
    RUN_TEST(the_last_number_of_64_bits_is_kept);
    RUN_TEST(random_sets_have_the_numbers_that_were_added);
    RUN_TEST(common_and_missing_numbers_are_those_of_the_flags);
    RUN_TEST(texts_are_read_as_they_are_written);
    RUN_TEST(other_texts_are_refused);
    return UNITY_END();
}
