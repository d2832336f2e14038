#include "command/support/option.h"

#include <unity.h>

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const struct command self = {"test", "FILE [FILE]", "test", NULL};
static bool flag;
static const char *text;
static unsigned number;
static double seconds;
static const struct option options[] = {
    {"flag", NULL, "a flag", OPTION_FLAG, &flag, 0, 0},
    {"text", "TEXT", "a text", OPTION_TEXT, &text, 0, 0},
    {"number", "N", "a number", OPTION_NUMBER, &number, 2, 4000000000u},
    {"seconds", "S", "a time", OPTION_SECONDS, &seconds, 0, 10},
};
static struct operands operands;

static enum options_result read_words(int count, char **words)
{
    operands = (struct operands){.least = 1, .most = 2};
    return options_read(&self, options, 4, NULL, count, words, &operands);
}

#define READ(...) read_words(sizeof(char *[]){__VA_ARGS__} / sizeof(char *), (char *[]){__VA_ARGS__})

void setUp(void)
{
    flag = false;
    text = NULL;
    number = 0;
    seconds = 0;
}

void tearDown(void)
{
}

static void test_options_and_operands_mix(void)
{
    char *words[] = {"--flag", "a", "--number", "3", "--seconds=0.5", "b", "--text=x=y"};
    TEST_ASSERT_EQUAL(OPTIONS_GO, read_words(7, words));
    TEST_ASSERT_TRUE(flag);
    TEST_ASSERT_EQUAL_UINT(3, number);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, seconds);
    TEST_ASSERT_EQUAL_STRING("x=y", text);
    TEST_ASSERT_EQUAL_INT(2, operands.count);
    TEST_ASSERT_EQUAL_STRING("a", operands.value[0]);
    TEST_ASSERT_EQUAL_STRING("b", operands.value[1]);
}

static void test_arguments_after_two_dashes_are_operands(void)
{
    char *words[] = {"--", "--flag", "-"};
    TEST_ASSERT_EQUAL(OPTIONS_GO, read_words(3, words));
    TEST_ASSERT_FALSE(flag);
    TEST_ASSERT_EQUAL_INT(2, operands.count);
    TEST_ASSERT_EQUAL_STRING("--flag", operands.value[0]);
}

static void test_invalid_command_lines_are_refused(void)
{
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--flat"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--fla"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "-f"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--flag=1"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--text"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--text="));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--number", "1"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--number", "4000000001"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--number", "18446744073709551619"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--number", "-3"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--number", "3x"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--number="));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--seconds", "11"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--seconds", "1.2.3"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "--seconds", "nan"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("--flag"));
    TEST_ASSERT_EQUAL(OPTIONS_BAD, READ("a", "b", "c"));
}

static void test_lists_are_cut_at_commas(void)
{
    char piece[4];
    const char *list = option_next_item("ab,,toolong,c", piece, sizeof piece);
    TEST_ASSERT_EQUAL_STRING("ab", piece);
    list = option_next_item(list, piece, sizeof piece);
    TEST_ASSERT_EQUAL_STRING("", piece);
    list = option_next_item(list, piece, sizeof piece);
    TEST_ASSERT_EQUAL_STRING("", piece);
    list = option_next_item(list, piece, sizeof piece);
    TEST_ASSERT_EQUAL_STRING("c", piece);
    TEST_ASSERT_NULL(option_next_item(list, piece, sizeof piece));
    TEST_ASSERT_NULL(option_next_item(NULL, piece, sizeof piece));
}

static void test_a_path_has_a_stem(void)
{
    char stem[32];
    tool_path_stem("a.b/c/horse.stream", stem, sizeof stem);
    TEST_ASSERT_EQUAL_STRING("horse", stem);
    tool_path_stem("a.b/horse", stem, sizeof stem);
    TEST_ASSERT_EQUAL_STRING("horse", stem);
    tool_path_stem(".x", stem, sizeof stem);
    TEST_ASSERT_EQUAL_STRING(".x", stem);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_options_and_operands_mix);
    RUN_TEST(test_arguments_after_two_dashes_are_operands);
    RUN_TEST(test_invalid_command_lines_are_refused);
    RUN_TEST(test_lists_are_cut_at_commas);
    RUN_TEST(test_a_path_has_a_stem);
    return UNITY_END();
}
