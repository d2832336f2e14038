/* The bound on the executed instructions of a program. They are counted with calls and with the numbers of
 * passes of loops. Programs beyond PROGRAM_EXECUTED are refused, so that code that walks through a program
 * always ends. */
#include "shader/program/program.h"

#include <stdio.h>
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

static const struct program *acquire(const char *text)
{
    struct shader *shader;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_assemble("t", text, strlen(text), &shader, &error), error.text);
    const struct program *program = program_acquire(shader, &error);
    shader_free(shader);
    return program;
}

/* Returns a program in which each of four subroutines calls the next one `calls` times. `before` and `after`
 * are the lines before and after the main program's call. */
static const struct program *acquire_tree(unsigned calls, const char *before, const char *after)
{
    static char text[1 << 16];
    char *at = text;
    at += sprintf(at,
                  "vs_3_0\ndefi i0, 0, 0, 0, 0\ndefi i1, 2, 0, 0, 0\ndcl_position v0\ndcl_position o0\n"
                  "mov o0, v0\n%scall l0\n%sret\n",
                  before, after);
    for (unsigned level = 0; level < 4; level++) {
        at += sprintf(at, "label l%u\n", level);
        for (unsigned i = 0; i < calls; i++)
            at += level < 3 ? sprintf(at, "call l%u\n", level + 1) : sprintf(at, "mov o0, v0\n");
        at += sprintf(at, "ret\n");
    }
    return acquire(text);
}

static void expect_refused(const struct program *program)
{
    TEST_ASSERT_NULL(program);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "more than 1048576 instructions"), error.text);
}

static void expect_accepted(const struct program *program)
{
    TEST_ASSERT_NOT_NULL_MESSAGE(program, error.text);
    program_release(program);
}

/* The nesting is far deeper than any model allows. The first `if` that is too deep is refused, so memory does
 * not grow with the others. */
static void ten_thousand_nested_ifs_are_refused(void)
{
    enum { DEPTH = 10000 };
    static char text[DEPTH * 32];
    char *at = text + sprintf(text, "ps_3_0\ndcl_texcoord v0\n");
    for (int i = 0; i < DEPTH; i++)
        at += sprintf(at, "if_gt v0.x, v0.y\n");
    at += sprintf(at, "mov oC0, v0\n");
    for (int i = 0; i < DEPTH; i++)
        at += sprintf(at, "endif\n");
    TEST_ASSERT_NULL(acquire(text));
    TEST_ASSERT_EQUAL_STRING("t:27:1: found computed conditions 25 deep, expected at most 24 in ps_3_0",
                             error.text);
}

static void calls_of_calls_are_counted(void)
{
    expect_accepted(acquire_tree(31, "", ""));
    expect_refused(acquire_tree(100, "", ""));
}

static void loops_multiply(void)
{
    expect_accepted(acquire_tree(28, "", ""));
    expect_refused(acquire_tree(28, "rep i1\n", "endrep\n"));
}

/* Engines that record walk through the body of such a loop too. */
static void a_loop_that_never_runs_is_counted_once(void)
{
    expect_accepted(acquire_tree(28, "rep i0\n", "endrep\n"));
    expect_refused(acquire_tree(100, "rep i0\n", "endrep\n"));
}

static void numbers_of_a_draw_are_counted(void)
{
    int32_t integers[3][4] = {{255, 0, 0}, {255, 0, 0}, {16, 0, 0}};
    const struct program *program =
        acquire("vs_3_0\ndcl_position v0\ndcl_position o0\nmov o0, v0\nrep i0\nrep i1\nrep i2\nmov o0, v0\n"
                "endrep\nendrep\nendrep\n");
    TEST_ASSERT_NOT_NULL_MESSAGE(program, error.text);
    expect_refused(program_check_integers(program, (const int32_t(*)[4])integers, &error) ? NULL : program);
    integers[2][0] = 0;
    TEST_ASSERT_EQUAL_INT(0, program_check_integers(program, (const int32_t(*)[4])integers, &error));
    integers[1][0] = 256;
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, program_check_integers(program, (const int32_t(*)[4])integers, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "integer constant i1: found 256"), error.text);
    program_release(program);
}

static void the_same_shader_is_one_program(void)
{
    const struct program *a = acquire("ps_1_1\nmov r0, v0\n"), *b = acquire("ps_1_1 ; again\nmov r0, v0\n"),
                         *c = acquire("ps_1_2\nmov r0, v0\n");
    uint32_t number = a->number;
    TEST_ASSERT_EQUAL_PTR(a, b);
    TEST_ASSERT_TRUE(a != c && c->number != number);
    program_release(a);
    TEST_ASSERT_EQUAL_PTR(b, program_find(number));
    program_release(b);
    TEST_ASSERT_NULL(program_find(number));
    const struct program *d = acquire("ps_1_1\nmov r0, v0\n");
    TEST_ASSERT_TRUE(d->number > number);
    program_release(c);
    program_release(d);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(ten_thousand_nested_ifs_are_refused);
    RUN_TEST(calls_of_calls_are_counted);
    RUN_TEST(loops_multiply);
    RUN_TEST(a_loop_that_never_runs_is_counted_once);
    RUN_TEST(numbers_of_a_draw_are_counted);
    RUN_TEST(the_same_shader_is_one_program);
    return UNITY_END();
}
