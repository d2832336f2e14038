/* A text with repeats and expressions is the same stream as the text with everything written out. */
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

static char *canonical(const char *lines)
{
    static char text[8192];
    struct stream *stream;
    char *written;
    size_t bytes;
    int length = snprintf(text, sizeof text, "triptych 1\n%s", lines);
    TEST_ASSERT_LESS_THAN_INT(sizeof text, length);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("t.tri", text, (size_t)length, &stream, &error),
                                  error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_write(stream, "t.tri", &written, &bytes, &error), error.text);
    stream_free(stream);
    return written;
}

static void expect_same(const char *lines, const char *written_out)
{
    char *a = canonical(lines), *b = canonical(written_out);
    TEST_ASSERT_EQUAL_STRING(b, a);
    free(a);
    free(b);
}

static void a_repeat_is_its_calls_written_out(void)
{
    expect_same("target 8 8\nrepeat 3 i\n  clear depth (i / 4)\n  frame\nend\n",
                "target 8 8\nclear depth 0\nframe\nclear depth 0.25\nframe\nclear depth 0.5\nframe\n");
    expect_same("repeat 2 # twice\n\n  # nothing else\nframe\nend # of it", "frame\nframe\n");
    expect_same("repeat 1\nframe\nend\n", "frame\n");
}

static void repeats_in_repeats_count_by_themselves(void)
{
    expect_same("target 64 64\n"
                "repeat 2 y\n"
                "  repeat 3 x\n"
                "    viewport (8 * x) (8 * y) (count) 8 0 1\n"
                "  end\n"
                "  scissor 0 0 (count) 8\n"
                "end\n",
                "target 64 64\n"
                "viewport 0 0 3 8 0 1\nviewport 8 0 3 8 0 1\nviewport 16 0 3 8 0 1\nscissor 0 0 2 8\n"
                "viewport 0 8 3 8 0 1\nviewport 8 8 3 8 0 1\nviewport 16 8 3 8 0 1\nscissor 0 0 2 8\n");
}

static void a_sequence_can_repeat(void)
{
    expect_same(
        "sequence s\nrepeat 2 i\nclipplane 0 (i) 0 0 1\nend\nlet a = 5\nclipplane 1 (a) 0 0 1\nend\nplay s\n",
        "sequence s\nclipplane 0 0 0 0 1\nclipplane 0 1 0 0 1\nclipplane 1 5 0 0 1\nend\nplay s\n");
}

static void a_repeat_plays_sequences(void)
{
    expect_same("sequence s\nframe\nend\nrepeat 2\nplay s\nend\n",
                "sequence s\nframe\nend\nplay s\nplay s\n");
}

static void the_frame_is_the_number_of_frames_that_ended(void)
{
    expect_same(
        "sequence two\nframe\nframe\nend\n"
        "clipplane 0 (frame) 0 0 1\nplay two\nclipplane 0 (frame) 0 0 1\nframe\nclipplane 0 (frame) 0 0 1\n",
        "sequence two\nframe\nframe\nend\n"
        "clipplane 0 0 0 0 1\nplay two\nclipplane 0 2 0 0 1\nframe\nclipplane 0 3 0 0 1\n");
}

static void a_variable_from_outside_keeps_its_value_and_one_from_inside_is_dropped(void)
{
    expect_same("let x = 1\nrepeat 3\nlet x = 2 * x\nlet inner = x\nend\nlet inner = 7\nclipplane 0 (x) "
                "(inner) 0 1\n",
                "clipplane 0 8 7 0 1\n");
}

static void every_kind_of_value_can_be_an_expression(void)
{
    expect_same(
        "let n = 2\n"
        "target (4 * n) 8\n"
        "texture t (n) 1 { (color(1, 0, 0, 1)) ff00ff00 }\n"
        "vertices v position:float3 diffuse:color {\n(n - 3) 0 0 (0xff000001)\n(n) (n) 0 ff000002\n}\n"
        "indices i 16 { 0 (n - 1) 0 }\n"
        "buffer b u32 { (n) 3 }\n"
        "buffer f float { (1 / n) }\n"
        "state ambient (color(1, 1, 1, 0))\n"
        "state zfunc (n)\n"
        "state fogdensity (1 / n)\n"
        "stage (n - 1) colorop disable\n"
        "bind texture (n) t\n"
        "transform world (n) translate (n) 0 0\n"
        "vertexconstant (n) (n / 4) 0 0 0\n"
        "light (n) on\n",
        "target 8 8\n"
        "texture t 2 1 { ffff0000 ff00ff00 }\n"
        "vertices v position:float3 diffuse:color {\n-1 0 0 ff000001\n2 2 0 ff000002\n}\n"
        "indices i 16 { 0 1 0 }\n"
        "buffer b u32 { 2 3 }\n"
        "buffer f float { 0.5 }\n"
        "state ambient 0x00ffffff\n"
        "state zfunc 2\n"
        "state fogdensity 0.5\n"
        "stage 1 colorop disable\n"
        "bind texture 2 t\n"
        "transform world 2 translate 2 0 0\n"
        "vertexconstant 2 0.5 0 0 0\n"
        "light 2 on\n");
}

/* Transforms take binary64, all others round to binary32. */
static void a_value_is_rounded_as_its_decimal_number_is(void)
{
    expect_same("clipplane 0 (1 / 10) 0 0 (1 - 2 / 3)\ntransform world rotate (360 / 16) 0 0 1\n",
                "clipplane 0 0.1 0 0 0.33333333333333337\ntransform world rotate 22.5 0 0 1\n");
}

static void what_repeats_read_again_is_bounded(void)
{
    enum { COMMENT = 60000 };
    static char text[COMMENT + 128];
    struct stream *stream;
    int length = snprintf(text, sizeof text, "triptych 1\nframe\nrepeat 1048576\n\n#%*s\nend\n", COMMENT, "");
    TEST_ASSERT_EQUAL_INT(-1, stream_parse("t", text, (size_t)length, &stream, &error));
    TEST_ASSERT_EQUAL_STRING("t:3:8: found repeats of more than 67108864 bytes, expected fewer repetitions",
                             error.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_repeat_is_its_calls_written_out);
    RUN_TEST(repeats_in_repeats_count_by_themselves);
    RUN_TEST(a_sequence_can_repeat);
    RUN_TEST(a_repeat_plays_sequences);
    RUN_TEST(the_frame_is_the_number_of_frames_that_ended);
    RUN_TEST(a_variable_from_outside_keeps_its_value_and_one_from_inside_is_dropped);
    RUN_TEST(every_kind_of_value_can_be_an_expression);
    RUN_TEST(a_value_is_rounded_as_its_decimal_number_is);
    RUN_TEST(what_repeats_read_again_is_bounded);
    return UNITY_END();
}
