/* The convention of base/error.h: the first reason is kept, and truncated at the capacity. */
#include "base/error.h"

#include <string.h>
#include <unity.h>

static struct error error;

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

static void set_formats_and_returns_minus_one(void)
{
    TEST_ASSERT_EQUAL_INT(-1, error_set(&error, "line %d: expected %s", 7, "a number"));
    TEST_ASSERT_EQUAL_STRING("line 7: expected a number", error.text);
}

static void first_reason_wins(void)
{
    error_set(&error, "cause");
    TEST_ASSERT_EQUAL_INT(-1, error_set(&error, "consequence"));
    TEST_ASSERT_EQUAL_STRING("cause", error.text);
}

static void clear_makes_room_for_a_new_reason(void)
{
    error_set(&error, "old");
    error_clear(&error);
    TEST_ASSERT_EQUAL_STRING("", error.text);
    error_set(&error, "new");
    TEST_ASSERT_EQUAL_STRING("new", error.text);
}

static void a_long_reason_is_cut_at_the_capacity(void)
{
    char reason[2 * ERROR_CAPACITY];
    memset(reason, 'x', sizeof reason - 1);
    reason[sizeof reason - 1] = 0;
    error_set(&error, "%s", reason);
    TEST_ASSERT_EQUAL_UINT64(ERROR_CAPACITY - 1, strlen(error.text));
    TEST_ASSERT_EQUAL_MEMORY(reason, error.text, ERROR_CAPACITY - 1);
}

static void a_null_error_is_ignored(void)
{
    TEST_ASSERT_EQUAL_INT(-1, error_set(NULL, "without a buffer for %s", "this"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(set_formats_and_returns_minus_one);
    RUN_TEST(first_reason_wins);
    RUN_TEST(clear_makes_room_for_a_new_reason);
    RUN_TEST(a_long_reason_is_cut_at_the_capacity);
    RUN_TEST(a_null_error_is_ignored);
    return UNITY_END();
}
