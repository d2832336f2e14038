#include "command/support/option.h"
#include "base/file.h"

#include <unity.h>

#include <stdio.h>
#include <string.h>
#include <unistd.h>

struct settings {
    bool flag;
    const char *text, *list, *file, *other, *input, *word;
    unsigned number, index;
    double seconds;
};

static const char *word_at(unsigned index)
{
    static const char *const words[] = {"vertex", "setup", "pixel", NULL};
    return words[index];
}

static const struct option options[] = {
    {"flag", NULL, "a flag", OPTION_IS_FLAG(struct settings, flag)},
    {"text", "TEXT", "a text", OPTION_IS_TEXT(struct settings, text)},
    {"list", "LIST", "a list", OPTION_IS_LIST(struct settings, list), .words = word_at},
    {"file", "FILE", "a file", OPTION_IS_FILE(struct settings, file)},
    {"other", "FILE", "another file", OPTION_IS_FILE(struct settings, other)},
    {"input", "FILE", "a file to read", OPTION_IS_INPUT(struct settings, input)},
    {"word", "UNIT", "a word", OPTION_IS_WORD(struct settings, word), .words = word_at},
    {"index", "UNIT", "the index of a word", OPTION_IS_INDEX(struct settings, index), .words = word_at},
    {"number", "N", "a number", OPTION_IS_NUMBER(struct settings, number), .least = 2, .most = 4000000000u},
    {"seconds", "S", "a time", OPTION_IS_SECONDS(struct settings, seconds), .most = 10},
    {0},
};
static const struct operand some[] = {
    {"FIRST", "a file", .kind = OPERAND_INPUT},
    {"REST", "more files", .kind = OPERAND_INPUT, .optional = true, .repeated = true},
    {0},
};
static const struct operand unit[] = {
    {"UNIT", "a word", .kind = OPERAND_WORD, .words = word_at},
    {"FILE", "a file", .kind = OPERAND_OUTPUT, .optional = true},
    {0},
};
static const struct command self = {.name = "test", .summary = "test", .options = options, .operands = some};
static const struct command of_unit = {.name = "test", .summary = "test", .operands = unit};
static struct settings settings;
static struct operands operands;

static enum options_result read_words(int count, char **words)
{
    return options_read(&self, count, words, &settings, &operands);
}

#define READ(...) read_words(sizeof(char *[]){__VA_ARGS__} / sizeof(char *), (char *[]){__VA_ARGS__})

/* Reads with standard error in a file, whose text is `printed` afterwards. */
static char printed[1024];

static enum options_result read_printing(const struct command *command, int count, char **words)
{
    FILE *file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
    int before = dup(STDERR_FILENO);
    dup2(fileno(file), STDERR_FILENO);
    enum options_result result = options_read(command, count, words, &settings, &operands);
    dup2(before, STDERR_FILENO);
    close(before);
    rewind(file);
    printed[fread(printed, 1, sizeof printed - 1, file)] = 0;
    fclose(file);
    return result;
}

static void refuses(const char *expected, const struct command *command, int count, char **words)
{
    TEST_ASSERT_EQUAL(OPTIONS_BAD, read_printing(command, count, words));
    TEST_ASSERT_EQUAL_STRING(expected, printed);
}

#define REFUSES(expected, command, ...)                                                                      \
    refuses(expected, command, sizeof(char *[]){__VA_ARGS__} / sizeof(char *), (char *[]){__VA_ARGS__})

void setUp(void)
{
    settings = (struct settings){0};
}

void tearDown(void)
{
    tool_print_to_output();
}

static void test_options_and_operands_mix(void)
{
    TEST_ASSERT_EQUAL(OPTIONS_GO, READ("--flag", "a", "--number", "3", "--seconds=0.5", "b", "--text=x=y"));
    TEST_ASSERT_TRUE(settings.flag);
    TEST_ASSERT_EQUAL_UINT(3, settings.number);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, settings.seconds);
    TEST_ASSERT_EQUAL_STRING("x=y", settings.text);
    TEST_ASSERT_EQUAL_INT(2, operands.count);
    TEST_ASSERT_EQUAL_STRING("a", operands.value[0]);
    TEST_ASSERT_EQUAL_STRING("b", operands.value[1]);
}

static void test_words_are_stored_as_texts_and_as_indices(void)
{
    TEST_ASSERT_EQUAL(OPTIONS_GO, READ("--word", "setup", "--index=pixel", "--list", "pixel,x", "a"));
    TEST_ASSERT_EQUAL_STRING("setup", settings.word);
    TEST_ASSERT_EQUAL_UINT(2, settings.index);
    TEST_ASSERT_EQUAL_STRING("pixel,x", settings.list);
    char *words[] = {"pixel"};
    TEST_ASSERT_EQUAL(OPTIONS_GO, options_read(&of_unit, 1, words, &settings, &operands));
    TEST_ASSERT_EQUAL_UINT(2, operands.word);
}

static void test_a_dash_is_a_standard_stream(void)
{
    FILE *output = stdout;
    TEST_ASSERT_EQUAL(OPTIONS_GO, READ("-", "b", "--other", "name"));
    TEST_ASSERT_EQUAL_STRING(file_standard_input, operands.value[0]);
    TEST_ASSERT_EQUAL_PTR(output, stdout);
    TEST_ASSERT_EQUAL(OPTIONS_GO, READ("a", "--file", "-"));
    bool is_error = stdout == stderr;
    tool_print_to_output();
    TEST_ASSERT_EQUAL_STRING(file_standard_output, settings.file);
    TEST_ASSERT_TRUE(is_error);
    TEST_ASSERT_EQUAL_PTR(output, stdout);
}

static void test_a_standard_stream_has_one_use(void)
{
    FILE *output = stdout;
    enum options_result result = READ("a", "--file", "-", "--other=-");
    tool_print_to_output();
    TEST_ASSERT_EQUAL_PTR(output, stdout);
    TEST_ASSERT_EQUAL(OPTIONS_BAD, result);
    REFUSES("triptych test: FIRST is \"-\", expected a file: standard input has another use\n", &self, "-",
            "--input", "-");
}

static void test_a_misspelled_word_is_answered_with_the_nearest(void)
{
    REFUSES("triptych test: --word is \"pixle\", expected one of: vertex, setup, pixel; did you mean "
            "\"pixel\"?\n",
            &self, "--word", "pixle");
    REFUSES("triptych test: --index is empty, expected UNIT\n", &self, "--index=", "a");
    REFUSES(
        "triptych test: UNIT is \"vert\", expected one of: vertex, setup, pixel; did you mean \"vertex\"?\n",
        &of_unit, "vert");
    TEST_ASSERT_EQUAL(OPTIONS_BAD, read_printing(&self, 2, (char *[]){"--nmber=3", "a"}));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(printed, "; did you mean --number?\n"), printed);
}

static void test_a_default_follows_the_last_semicolon(void)
{
    static const struct option two[] = {{.meaning = "which frame; from 0; 0"}, {.meaning = "a file"}};
    char text[OPTIONS_MEANING];
    TEST_ASSERT_EQUAL_STRING("which frame; from 0 (default: 0)", options_meaning(two, text));
    TEST_ASSERT_EQUAL_STRING("a file", options_meaning(two + 1, text));
}

static void test_help_is_requested_by_two_names(void)
{
    TEST_ASSERT_EQUAL(OPTIONS_HELP, READ("--help"));
    TEST_ASSERT_EQUAL(OPTIONS_HELP, READ("a", "-h", "--no-such"));
}

static void test_the_number_of_operands_is_checked(void)
{
    char usage[OPTIONS_USAGE];
    TEST_ASSERT_EQUAL_STRING("FIRST [REST...]", options_usage(&self, usage));
    TEST_ASSERT_EQUAL_STRING("UNIT [FILE]", options_usage(&of_unit, usage));
    refuses("triptych test: expected UNIT [FILE], got 0 of them\n", &of_unit, 0, NULL);
    REFUSES("triptych test: unexpected \"b\", expected only UNIT [FILE]\n", &of_unit, "pixel", "a", "b");
    TEST_ASSERT_EQUAL(OPTIONS_GO, READ("a", "b", "c", "d"));
    TEST_ASSERT_EQUAL_INT(4, operands.count);
}

static void test_arguments_after_two_dashes_are_operands(void)
{
    TEST_ASSERT_EQUAL(OPTIONS_GO, READ("--", "--flag", "b"));
    TEST_ASSERT_FALSE(settings.flag);
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
    RUN_TEST(test_words_are_stored_as_texts_and_as_indices);
    RUN_TEST(test_a_dash_is_a_standard_stream);
    RUN_TEST(test_a_standard_stream_has_one_use);
    RUN_TEST(test_a_misspelled_word_is_answered_with_the_nearest);
    RUN_TEST(test_a_default_follows_the_last_semicolon);
    RUN_TEST(test_help_is_requested_by_two_names);
    RUN_TEST(test_the_number_of_operands_is_checked);
    RUN_TEST(test_arguments_after_two_dashes_are_operands);
    RUN_TEST(test_invalid_command_lines_are_refused);
    RUN_TEST(test_lists_are_cut_at_commas);
    RUN_TEST(test_a_path_has_a_stem);
    return UNITY_END();
}
