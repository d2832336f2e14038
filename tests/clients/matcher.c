/* The matchers against a table of examples, and against the definition of random expressions. */
#include "bench/clients/matcher/matcher.h"
#include "bench/clients/matcher/regex.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINES = 96, CASES = 250 };

static const char *const engines[] = {"emulate",        "batch",        "specialize-1",
                                      "specialize-4",   "specialize-8", "specialize-16",
                                      "specialize-8x2", "specialize",   "specialize-thesis"};
enum { ENGINES = sizeof engines / sizeof engines[0] };

static uint8_t text[LINES * (REGEX_TEXT + 1) + 4];
static int32_t line[LINES];
static uint32_t lines, expected[LINES], found[LINES];
static size_t text_bytes;
static struct automaton automaton;

void setUp(void)
{
    lines = 0;
    text_bytes = 0;
}

void tearDown(void)
{
}

static void add_line(const uint8_t *bytes, size_t count)
{
    line[lines++] = (int32_t)text_bytes;
    memcpy(text + text_bytes, bytes, count);
    text_bytes += count;
    memcpy(text + text_bytes++, "\n", 2);
}

static void make(const char *expression)
{
    struct error error = {{0}};
    TEST_ASSERT_EQUAL_MESSAGE(0, automaton_make(&automaton, expression, &error), error.text);
}

static void compare_plain(const char *expression)
{
    struct error error = {{0}};
    struct dfa *dfa = dfa_create(&automaton, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(dfa, error.text);
    for (uint32_t n = 0; n < lines; n++)
        if (dfa_matches(dfa, text + line[n]) != expected[n])
            TEST_FAIL_MESSAGE(expression);
    dfa_free(dfa);
}

static void compare_engine(const char *expression, const char *engine)
{
    struct error error = {{0}};
    char message[REGEX_EXPRESSION + 100];
    struct kernel *kernel = kernel_create(&matcher_kernel, &automaton, MATCHER_STRIDE, engine, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(kernel, error.text);
    memset(found, 0xee, sizeof found);
    matcher_kernel_lines(kernel, &automaton, text, line, lines, found);
    for (uint32_t n = 0; n < lines; n++) {
        snprintf(message, sizeof message, "%s: %s in \"%.*s\"", engine, expression,
                 (int)strcspn((const char *)text + line[n], "\n"), (const char *)text + line[n]);
        TEST_ASSERT_EQUAL_MESSAGE(expected[n], found[n], message);
    }
    kernel_free(kernel);
}

static void compare(const char *expression, int first, int count)
{
    make(expression);
    compare_plain(expression);
    for (int way = 0; way < 2; way++) {
        automaton.tabled = way;
        for (int i = first; i < first + count; i++)
            if (!kernel_unavailable(engines[i % ENGINES]))
                compare_engine(expression, engines[i % ENGINES]);
    }
}

static void test_examples(void)
{
    static const struct {
        const char *expression, *text;
        bool matches;
    } example[] = {
        {"abc", "xxabcxx", true},
        {"abc", "ab", false},
        {"^abc", "xabc", false},
        {"abc$", "abcx", false},
        {"^$", "", true},
        {"^$", "a", false},
        {"a*", "", true},
        {"a+b", "aaab", true},
        {"colou?r", "the color", true},
        {"(ab|cd)+e", "abcdabe", true},
        {"^(ab|cd)+$", "abc", false},
        {"[^a-y]", "zebra", true},
        {"[^a-z]", "zebra", false},
        {"\\d{3}-\\d{4}", "call 555-0123 now", true},
        {"\\d{3}-\\d{4}", "call 55-0123", false},
        {"x{2,3}y", "xy", false},
        {"x{2,3}y", "xxxxy", true},
        {"^x{2,3}y", "xxxxy", false},
        {"x{0}y", "y", true},
        {"a.c",
         "a\xff"
         "c",
         true},
        {"\\x41\\.", "A.", true},
        {"[]a]b", "]b", true},
        {"[a-]b", "-b", true},
        {"(|a)b$", "b", true},
        {"^(a|b|)$", "", true},
        {"[\\d_]+$", "12_3", true},
        {"\\w+@\\w+\\.\\w+", "to: a_b@c.org", true},
        {"a{64}", "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa", false},
        {"^a{20,40}b{3}$", "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaabbb", true},
    };
    for (size_t i = 0; i < sizeof example / sizeof example[0]; i++) {
        setUp();
        add_line((const uint8_t *)example[i].text, strlen(example[i].text));
        expected[0] = example[i].matches;
        compare(example[i].expression, 0, ENGINES);
    }
}

/* Every expression is compared on two engines, in turn. */
static void test_random_expressions_match_by_definition(void)
{
    static struct regex_expression x;
    uint64_t seed = 5;
    for (int n = 0; n < (int)test_share_of(CASES, 6); n++) {
        regex_make(&x, &seed);
        setUp();
        while (lines < LINES - KERNEL_ELEMENTS + (unsigned)n % KERNEL_ELEMENTS) {
            uint8_t bytes[REGEX_TEXT];
            size_t count = regex_line(bytes, &seed);
            expected[lines] = regex_matches(&x, bytes, count);
            add_line(bytes, count);
        }
        compare(x.text, 2 * n, 2);
    }
}

static void test_wrong_expressions_are_refused_with_their_place(void)
{
    static const char *const wrong[][2] = {
        {"*a", "found \"*\""},       {"a**", "after a repetition"},
        {"(a", "expected )"},        {"a)", "expected the end"},
        {"[a", "expected ]"},        {"[z-a]", "end is before its begin"},
        {"a{", "expected a number"}, {"a{3,2}", "expected }"},
        {"a{65}", "at most 64"},     {"\\q", "the escape \"\\q\""},
        {"\\x4", "two hexadecimal"}, {"^a|b", "need parentheses"},
        {"a^b", "found \"^\""},      {"(ab{60}){3}", "more than 127 positions"},
        {"a\\", "the escape"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct error error = {{0}};
        TEST_ASSERT_EQUAL_MESSAGE(-1, automaton_make(&automaton, wrong[i][0], &error), wrong[i][0]);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, wrong[i][1]), error.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "of the expression"), error.text);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_examples);
    RUN_TEST(test_random_expressions_match_by_definition);
    RUN_TEST(test_wrong_expressions_are_refused_with_their_place);
    return UNITY_END();
}
