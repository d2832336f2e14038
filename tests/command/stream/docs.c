/* docs/streams.md is correct: its example is a valid stream, and its limits and words are those of the
 * tables. */
#include "base/file.h"
#include "command/stream/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

static struct error error;
static char *page;

void setUp(void)
{
    size_t bytes;
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_read("docs/streams.md", 1 << 20, &page, &bytes, &error),
                                  error.text);
}

void tearDown(void)
{
    free(page);
}

static void the_example_is_a_stream_of_two_frames(void)
{
    struct stream *stream;
    const char *start = strstr(page, "```\ntriptych 1\n");
    TEST_ASSERT_NOT_NULL(start);
    const char *end = strstr(start + 4, "```");
    TEST_ASSERT_NOT_NULL(end);
    int result =
        stream_parse("bench/streams/example.tri", start + 4, (size_t)(end - start - 4), &stream, &error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, result, error.text);
    TEST_ASSERT_EQUAL_UINT(2, stream->frame_count);
    stream_free(stream);
}

static void the_animation_with_repeats_has_24_frames_of_two_teapots(void)
{
    struct stream *stream;
    unsigned draws = 0;
    const char *section = strstr(page, "### Variables and expressions");
    TEST_ASSERT_NOT_NULL(section);
    const char *start = strstr(section, "```\ntriptych 1\n");
    TEST_ASSERT_NOT_NULL(start);
    const char *end = strstr(start + 4, "```");
    TEST_ASSERT_NOT_NULL(end);
    int result =
        stream_parse("bench/streams/example.tri", start + 4, (size_t)(end - start - 4), &stream, &error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, result, error.text);
    TEST_ASSERT_EQUAL_UINT(24, stream->frame_count);
    for (uint32_t i = 0; i < stream->call_count; i++)
        draws += stream->calls[i].type == CALL_DRAW_MESH;
    TEST_ASSERT_EQUAL_UINT(48, draws);
    stream_free(stream);
}

static void every_name_of_expressions_is_described(void)
{
    static const char *const names[] = {
#define BUILTIN(name, where, meaning)              "`" #name "`",
#define FUNCTION(name, arguments, result, meaning) "`" #name "(",
#include "command/stream/expression.def"
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(page, names[i]), names[i]);
}

static void the_limits_are_those_of_the_table(void)
{
    static const struct {
        const char *what;
        unsigned value;
    } rows[] = {
#define LIMIT(name, value, what) {what, value},
#include "command/stream/limit.def"
#undef LIMIT
    };
    const char *at = strstr(page, "## Limits");
    size_t count = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char row[128];
        snprintf(row, sizeof row, "\n| %s | %u |\n", rows[i].what, rows[i].value);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(at, row), row);
    }
    for (const char *row = strstr(at, "\n| "); row && row < strstr(at, "## Canonical");
         row = strstr(row + 1, "\n| "))
        count++;
    TEST_ASSERT_EQUAL_UINT64(sizeof rows / sizeof *rows + 2, count); /* and the heading's two */
}

static void every_word_is_mentioned(void)
{
    static const char *const words[] = {
#define WORD(list, word, value) #word,
#include "capture/word.def"
#undef WORD
#define ELEMENT(word, usage, index) #word,
#include "capture/element.def"
#undef ELEMENT
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(page, words[i]), words[i]);
    for (unsigned p = 0; p < TRIPTYCH_PRIMITIVE_COUNT; p++)
        TEST_ASSERT_NOT_NULL(strstr(page, word_text(WORDS_PRIMITIVE, p)));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_example_is_a_stream_of_two_frames);
    RUN_TEST(the_animation_with_repeats_has_24_frames_of_two_teapots);
    RUN_TEST(every_name_of_expressions_is_described);
    RUN_TEST(the_limits_are_those_of_the_table);
    RUN_TEST(every_word_is_mentioned);
    return UNITY_END();
}
