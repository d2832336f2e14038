/* Invalid streams. Each is reported with one line: the position, what was found, and what was expected.
 * Nothing else happens. Line 1 of the text is the header, so the first line of a case is line 2. */
#include "command/stream/stream.h"

#include <stdio.h>
#include <stdlib.h>
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

struct bad {
    const char *text;  /* after the header */
    const char *place; /* LINE:COLUMN */
    const char *part;  /* of the reason */
};

/* The whole text is bad from the first line on, or not text at all. */
static const struct bad whole[] = {
    {"", "1:1", "found the end of the file, expected the first line: triptych 1"},
    {"triptych", "1:9", "expected version 1"},
    {"triptych 2\n", "1:10", "found '2', expected version 1"},
    {"\ntriptych 1\n", "1:1", "found the end of the line, expected the first line"},
    {"triptych 1 x\n", "1:12", "found 'x', expected the end of the line"},
    {"\x89PNG\r\n\x1a\n", "1:1", "found byte 0x89, expected UTF-8"},
    {"triptych 1\n# \xc3\x28\n", "2:3", "found byte 0xc3, expected UTF-8"},
    {"triptych 1\n# \xed\xa0\x80\n", "2:3", "found byte 0xed, expected UTF-8"},
    {"triptych 1\n\tframe\x07\n", "2:7", "found control character 0x07"},
    {"triptych 1\nframe\rframe\n", "2:6", "found control character 0x0d"},
    {"triptych 1\n", "2:1", "expected at least one call"},
    {"triptych 1\nsequence s\nend\nplay s\n", "5:1", "expected at least one call that is executed"},
};

static const struct bad lines[] = {
#define BAD(text, place, part) {text, place, part},
#include "errors.def"
#undef BAD
};

static void expect_bad(const char *text, size_t bytes, const struct bad *bad)
{
    struct stream *stream = (struct stream *)&error;
    char place[64];
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(-1, stream_parse("dir/a.tri", text, bytes, &stream, &error), text);
    TEST_ASSERT_NULL(stream);
    int length = snprintf(place, sizeof place, "dir/a.tri:%s: ", bad->place);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(place, error.text, (size_t)length, error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, bad->part), error.text);
    TEST_ASSERT_NULL_MESSAGE(strchr(error.text, '\n'), error.text);
}

static void a_text_that_is_not_a_stream_is_refused_at_its_position(void)
{
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        expect_bad(whole[i].text, strlen(whole[i].text), &whole[i]);
}

static void every_bad_line_is_refused_at_its_place(void)
{
    static char text[1024];
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        int length = snprintf(text, sizeof text, "triptych 1\n%s", lines[i].text);
        expect_bad(text, (size_t)length, &lines[i]);
    }
}

static void a_zero_byte_is_refused(void)
{
    static const struct bad bad = {"", "2:6", "found control character 0x00"};
    expect_bad("triptych 1\nframe\0\n", 18, &bad);
}

static void long_words_are_shown_cut_and_long_paths_from_their_end(void)
{
    static char path[3000], text[2000];
    struct stream *stream;
    memset(path, 'p', sizeof path - 1);
    strcpy(text, "triptych 1\n");
    memset(text + strlen(text), 'w', 1500);
    TEST_ASSERT_EQUAL_INT(-1, stream_parse(path, text, strlen(text), &stream, &error));
    TEST_ASSERT_EQUAL_STRING_LEN("...ppp", error.text, 6);
    TEST_ASSERT_NOT_NULL(strstr(error.text, "p:2:1: found 'wwww"));
    TEST_ASSERT_NOT_NULL(strstr(error.text, "w...', expected a call"));
}

/* --- Limits --------------------------------------------------------------------------------------------- */

/* Repeats `part` in a text that the caller frees. */
static char *repeat(const char *before, const char *part, size_t count, const char *after)
{
    size_t length = strlen(part);
    char *text = malloc(strlen(before) + length * count + strlen(after) + 1), *at = stpcpy(text, before);
    for (size_t i = 0; i < count; i++)
        at = stpcpy(at, part);
    strcpy(at, after);
    return text;
}

static void expect_limit(char *text, const struct bad *bad)
{
    expect_bad(text, strlen(text), bad);
    free(text);
}

static void limits_hold(void)
{
    expect_limit(repeat("triptych 1\n", " ", LIMIT_LINE_BYTES + 1, "frame\n"),
                 &(struct bad){"", "2:65537", "found a longer line, expected at most 65536 bytes"});
    expect_limit(repeat("triptych 1\ntexture ", "n", LIMIT_NAME_BYTES + 1, " 1 1 { ffffffff }\n"),
                 &(struct bad){"", "2:9", "expected a name"});
    expect_limit(repeat("triptych 1\ntexture n file \"", "p", LIMIT_PATH_BYTES + 1, "\"\n"),
                 &(struct bad){"", "2:16", "found a path of 1025 bytes, expected 1 to 1024"});
    expect_limit(repeat("triptych 1\ntransform world", " identity", LIMIT_OPERATIONS + 1, "\n"),
                 &(struct bad){"", "2:305", "expected at most 32 operations"});
    expect_limit(repeat("triptych 1\n", "texture a 1 1 { 00000000 }\n", 2, ""),
                 &(struct bad){"", "3:9", "not in use"});
    expect_limit(repeat("triptych 1\ntarget 1 1\n", "frame\n", LIMIT_FRAMES + 1, ""),
                 &(struct bad){"", "65539:1", "found one more frame, expected at most 65536"});
}

static void a_line_of_the_limit_is_read(void)
{
    struct stream *stream;
    char *text = repeat("triptych 1\nstate lighting false\n#", " ", LIMIT_LINE_BYTES - 1, "\n");
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("a", text, strlen(text), &stream, &error), error.text);
    stream_free(stream);
    free(text);
}

/* Returns a text of sequences. Each one plays the previous one `plays` times. */
static char *nest(int sequences, int plays)
{
    char *text = malloc(1 << 20), *at = stpcpy(text, "triptych 1\nsequence s0\nstate lighting false\nend\n");
    for (int s = 1; s < sequences; s++) {
        at += sprintf(at, "sequence s%d\n", s);
        for (int i = 0; i < plays; i++)
            at += sprintf(at, "play s%d\n", s - 1);
        at = stpcpy(at, "end\n");
    }
    sprintf(at, "play s%d\n", sequences - 1);
    return text;
}

static void sequences_cannot_explode(void)
{
    struct stream *stream;
    char *deepest = nest(LIMIT_DEPTH, 2);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("a", deepest, strlen(deepest), &stream, &error),
                                  error.text);
    TEST_ASSERT_EQUAL_UINT(128, stream->executed_count);
    stream_free(stream);
    free(deepest);
    expect_limit(nest(LIMIT_DEPTH + 1, 1),
                 &(struct bad){"", "27:6", "found sequences 9 deep, expected at most 8"});
    expect_limit(nest(LIMIT_DEPTH, 100),
                 &(struct bad){"", "314:1", "found more calls with sequences played"});
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_text_that_is_not_a_stream_is_refused_at_its_position);
    RUN_TEST(every_bad_line_is_refused_at_its_place);
    RUN_TEST(a_zero_byte_is_refused);
    RUN_TEST(long_words_are_shown_cut_and_long_paths_from_their_end);
    RUN_TEST(limits_hold);
    RUN_TEST(a_line_of_the_limit_is_read);
    RUN_TEST(sequences_cannot_explode);
    return UNITY_END();
}
