/* The text of the shaders of tests/front/glsl/corpus, which use the whole language: NAME.vert and NAME.frag
 * give NAME.txt, the texts of both stages. With UPDATE=1 in the environment the expected texts are
 * written. */
#include "front/glsl/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { BYTES = 1 << 16 };

void setUp(void)
{
}

void tearDown(void)
{
}

static void path_of(char path[256], const char *name, const char *ending)
{
    snprintf(path, 256, "tests/front/glsl/corpus/%s.%s", name, ending);
}

static void read_text(const char *name, const char *ending, char text[BYTES])
{
    char path[256];
    path_of(path, name, ending);
    FILE *file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    text[fread(text, 1, BYTES - 1, file)] = 0;
    fclose(file);
}

static void write_text(const char *name, const char *text)
{
    char path[256];
    path_of(path, name, "txt");
    FILE *file = fopen(path, "w");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    fputs(text, file);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, fclose(file), path);
}

static struct glsl_unit *compile_file(enum glsl_stage stage, const char *name, const char *ending)
{
    static char source[BYTES];
    const char *strings = source;
    char *log;
    read_text(name, ending, source);
    struct glsl_unit *unit = glsl_compile(stage, &strings, NULL, 1, NULL, &log);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", log, name);
    free(log);
    return unit;
}

static void check_text(const char *name)
{
    static char found[2 * BYTES], expected[BYTES];
    struct glsl_unit *vertex = compile_file(GLSL_VERTEX, name, "vert");
    struct glsl_unit *fragment = compile_file(GLSL_FRAGMENT, name, "frag");
    char *log;
    struct glsl_program *program = glsl_link(vertex, fragment, NULL, 0, &log);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, log);
    snprintf(found, sizeof found, "%s%s", program->text[GLSL_VERTEX], program->text[GLSL_FRAGMENT]);
    if (getenv("UPDATE"))
        write_text(name, found);
    read_text(name, "txt", expected);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, found, name);
    glsl_program_free(program);
    glsl_unit_free(vertex);
    glsl_unit_free(fragment);
    free(log);
}

static void texts_are_as_expected(void)
{
    static const char *const names[] = {"phong", "skin", "flow", "array", "extension", "builtin"};
    for (unsigned i = 0; i < sizeof names / sizeof *names; i++)
        check_text(names[i]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(texts_are_as_expected);
    return UNITY_END();
}
