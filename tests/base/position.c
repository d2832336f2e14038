/* Errors at positions of a text: the prefix, long paths, and quotes that are cut between characters. */
#include "base/position.h"

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

static int fail(const char *path, const char *reason, ...)
{
    va_list arguments;
    va_start(arguments, reason);
    int result = position_fail(&error, (struct position){path, 3, 14}, reason, arguments);
    va_end(arguments);
    return result;
}

static int expected(const char *found, const char *what, ...)
{
    va_list arguments;
    va_start(arguments, what);
    int result = position_expected(&error, (struct position){"a.tri", 1, 2}, found, what, arguments);
    va_end(arguments);
    return result;
}

static void a_reason_begins_with_its_position(void)
{
    TEST_ASSERT_EQUAL_INT(-1, fail("a.tri", "%d is too large", 7));
    TEST_ASSERT_EQUAL_STRING("a.tri:3:14: 7 is too large", error.text);
}

static void found_and_expected_are_one_reason(void)
{
    TEST_ASSERT_EQUAL_INT(-1, expected("'x'", "a number from %d to %d", 1, 5));
    TEST_ASSERT_EQUAL_STRING("a.tri:1:2: found 'x', expected a number from 1 to 5", error.text);
}

static void a_long_path_is_shown_by_its_end(void)
{
    char path[512];
    memset(path, 'p', sizeof path - 1);
    strcpy(path + sizeof path - 6, ".tri!");
    fail(path, "reason");
    TEST_ASSERT_EQUAL_STRING_LEN("...ppp", error.text, 6);
    TEST_ASSERT_EQUAL_STRING(".tri!:3:14: reason", error.text + 3 + 200 - 5);
}

static void a_long_reason_is_cut_at_the_capacity(void)
{
    char text[2 * ERROR_CAPACITY];
    memset(text, 'r', sizeof text - 1);
    text[sizeof text - 1] = 0;
    expected(text, "a number");
    TEST_ASSERT_EQUAL_UINT64(ERROR_CAPACITY - 1, strlen(error.text));
}

static void quotes_are_cut_between_characters(void)
{
    char quoted[POSITION_QUOTED];
    TEST_ASSERT_EQUAL_STRING("'word'", position_quote("word and more", 4, 40, quoted));
    TEST_ASSERT_EQUAL_STRING("'abc...'", position_quote("abcdef", 6, 3, quoted));
    TEST_ASSERT_EQUAL_STRING("'ab...'", position_quote("ab\xc3\xa9"
                                                       "cd",
                                                       6, 3, quoted));
    TEST_ASSERT_EQUAL_STRING("'ab\xc3\xa9...'", position_quote("ab\xc3\xa9"
                                                               "cd",
                                                               6, 4, quoted));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_reason_begins_with_its_position);
    RUN_TEST(found_and_expected_are_one_reason);
    RUN_TEST(a_long_path_is_shown_by_its_end);
    RUN_TEST(a_long_reason_is_cut_at_the_capacity);
    RUN_TEST(quotes_are_cut_between_characters);
    return UNITY_END();
}
