/* The limits of the validator: it counts instruction slots, nesting and the registers that a shader uses. For
 * bytecode, its reasons name the token. */
#include "tests/shader/check/reason.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

/* The line `count` times after the head. */
static char *repeated(const char *head, const char *line, unsigned count, const char *tail)
{
    size_t length = strlen(line);
    char *text = malloc(strlen(head) + count * length + strlen(tail) + 1), *at = text;
    at = stpcpy(at, head);
    for (unsigned i = 0; i < count; i++)
        at = stpcpy(at, line);
    strcpy(at, tail);
    return text;
}

static void expect_repeated(const char *head, const char *line, unsigned count, const char *tail,
                            const char *reason)
{
    char *text = repeated(head, line, count, tail);
    const char *found = reason_of(text);
    free(text);
    if (*reason)
        TEST_ASSERT_EQUAL_STRING_LEN(reason, found, strlen(reason));
    else
        TEST_ASSERT_EQUAL_STRING("", found);
}

static void slots_are_counted_to_the_last_one(void)
{
    static const struct {
        const char *head, *line, *tail;
        unsigned most;
        const char *reason;
    } rows[] = {
        {"vs_1_1\n", "mov r0, c0\n", "mov oPos, c0\n", 127,
         "t:130:1: found 129 instruction slots, expected at most 128 in vs_1_1"},
        {"vs_2_0\n", "mov r0, c0\n", "mov oPos, c0\n", 255,
         "t:258:1: found 257 instruction slots, expected at most 256"},
        {"vs_3_0\ndcl_position o0\n", "nop\n", "mov o0, c0\n", 32767,
         "t:32771:1: found 32769 instruction slots"},
        {"ps_1_1\n", "mov r1, c0\n", "mov r0, c0\n", 7,
         "t:10:1: found 9 arithmetic instruction slots, expected at most 8"},
        {"ps_1_4\nmov r0, c0\nphase\n", "mov r1, c0\n", "mov r0, c0\n", 7,
         "t:12:1: found 9 arithmetic instruction slots in one phase"},
        {"ps_2_0\n", "mov r0, c0\n", "mov oC0, c0\n", 63,
         "t:66:1: found 65 arithmetic instruction slots, expected at most 64"},
        {"ps_2_0\ndcl t0\ndcl_2d s0\nmov oC0, c0\n", "texld r0, t0, s0\n", "", 32,
         "t:37:1: found 33 texture instruction slots, expected at most 32"},
        {"ps_2_x\n", "mov r0, c0\n", "mov oC0, c0\n", 511,
         "t:514:1: found 513 instruction slots, expected at most 512"},
        {"vs_2_0\nmov oPos, c0\n", "if b0\nendif\n", "", 16,
         "t:35:1: found 17 instructions of static flow control, expected at most 16"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        expect_repeated(rows[i].head, rows[i].line, rows[i].most, rows[i].tail, "");
        expect_repeated(rows[i].head, rows[i].line, rows[i].most + 1, rows[i].tail, rows[i].reason);
    }
    expect_repeated("vs_3_sw\ndcl_position o0\nmov o0, c0\n", "nop\n", 60000, "", "");
}

static void nesting_is_counted_and_never_overflows(void)
{
    expect_repeated("vs_3_0\ndcl_position o0\nmov o0, c0\n", "if b0\n", 10000, "",
                    "t:28:1: found conditions 25 deep, expected at most 24");
    expect_repeated("vs_3_0\ndcl_position o0\nmov o0, c0\n", "if_gt c0.x, c0.y\n", 10000, "",
                    "t:28:1: found computed conditions 25 deep, expected at most 24");
    expect_repeated("vs_3_0\ndcl_position o0\nmov o0, c0\nrep i0\n", "if_gt c0.x, c0.y\n", 24,
                    "break_gt c0.x, c0.y\n",
                    "t:29:1: found computed conditions 25 deep, expected at most 24");
    expect_repeated("vs_3_0\ndcl_position o0\nmov o0, c0\n", "rep i0\n", 10000, "",
                    "t:8:1: found loops 5 deep, expected at most 4");
    expect_repeated("vs_3_sw\ndcl_position o0\nmov o0, c0\n", "loop aL, i0\n", 10000, "",
                    "t:8:1: found loops 5 deep");
    expect_repeated("ps_3_0\nmov oC0, c0\n", "endif\n", 10000, "",
                    "t:3:1: found endif, expected if before it");
    expect_repeated("ps_3_0\nmov oC0, c0\nret\n", "label l0\nret\n", 10000, "",
                    "t:6:7: found another label l0");
}

static void counts_are_those_of_the_shader(void)
{
    static const char text[] =
        "ps_3_0\ndcl_texcoord v0\ndcl_cube s0\ndcl_2d s1\ntexld r0, v0, s0\ntexldb r1, v0, s1\n"
        "nrm r2, r0\nif b0\nmov r2, r1\nelse\nendif\nsetp_gt p0, r0, r1\n(p0) mov r2, r0\nmov oC0, r2\n";
    struct shader_counts counts;
    struct shader *shader;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_assemble("t", text, sizeof text - 1, &shader, &error),
                                  error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_validate(shader, &counts, &error), error.text);
    /* texld of a cube 4, texldb 6, nrm 3, if 3, mov 1, else 1, endif 1, setp 1, predicated mov 2, mov 1 */
    TEST_ASSERT_EQUAL_UINT(23, counts.slots);
    TEST_ASSERT_EQUAL_UINT(2, counts.flow);
    shader_free(shader);
}

static void reasons_in_bytecode_name_the_token(void)
{
    static const char text[] = "vs_2_0\ndcl_position v0\nmov oPos, v0\nmad r0, v0, v0, r1\n";
    struct shader *shader, *code;
    uint32_t *tokens;
    size_t count;
    TEST_ASSERT_EQUAL_INT(0, shader_assemble("t", text, sizeof text - 1, &shader, &error));
    TEST_ASSERT_EQUAL_INT(0, shader_encode(shader, &tokens, &count, &error));
    TEST_ASSERT_EQUAL_INT(0, shader_read("c", tokens, 4 * count, &code, &error));
    TEST_ASSERT_EQUAL_INT(-1, shader_validate(code, NULL, &error));
    /* version 0, dcl 1 to 3, mov 4 to 6, mad 7, its sources 9, 10, 11 */
    TEST_ASSERT_EQUAL_STRING("c: token 11: found r1.x, expected something to write it before it is read",
                             error.text);
    shader_free(shader);
    shader_free(code);
    free(tokens);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(slots_are_counted_to_the_last_one);
    RUN_TEST(nesting_is_counted_and_never_overflows);
    RUN_TEST(counts_are_those_of_the_shader);
    RUN_TEST(reasons_in_bytecode_name_the_token);
    return UNITY_END();
}
