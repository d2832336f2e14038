/* Directives and macros, by what the source after them means. */
#include "tests/front/glsl/source.h"

#include <stdio.h>

void setUp(void)
{
}

void tearDown(void)
{
}

/* Each source defines VALUE, which must be the number after it. */
static void check_value(const char *directives, int expected)
{
    char source[1024], *log;
    snprintf(source, sizeof source, "%s\nconst int value = VALUE;\nvoid main() {}\n", directives);
    struct glsl_unit *unit = compile(GLSL_VERTEX, source, &log);
    TEST_ASSERT_NOT_NULL_MESSAGE(unit, log);
    TEST_ASSERT_EQUAL_INT_MESSAGE(expected, unit->global->value->i, directives);
    glsl_unit_free(unit);
    free(log);
}

static void macros_are_expanded(void)
{
    check_value("#define VALUE 3", 3);
    check_value("#define A 3\n#define VALUE A", 3);
    check_value("#define VALUE(x) wrong\n#undef VALUE\n#define VALUE 4", 4);
    check_value("#define TWICE(x) ((x) + (x))\n#define VALUE TWICE(TWICE(3))", 12);
    check_value("#define FIRST(a, b) a\n#define VALUE FIRST((2), (3, 4))", 2);
    check_value("#define f(x) x\n#define VALUE f /* between */ (7)", 7);
    check_value("#define EMPTY\n#define VALUE EMPTY 5 EMPTY", 5);
    check_value("#define ADD(a,b) a+b\n#define VALUE ADD(,6)", 6);
    check_value("#define ARGUMENT(x) x\n#define N 8\n#define VALUE ARGUMENT(N)", 8);
}

static void a_macro_is_not_expanded_in_itself(void)
{
    static const struct row rows[] = {
        {"#define a a\nvoid main() { int a = 1; a++; }", NULL},
        {"#define a b\n#define b a\nvoid main() { int a = 1; a++; }", NULL},
        {"int f(int x) { return x; }\n#define f(x) f(x + 1)\nvoid main() { int i = f(2); }", NULL},
    };
    CHECK_ROWS(GLSL_VERTEX, rows);
}

static void predefined_macros_have_values(void)
{
    check_value("#define VALUE __VERSION__", 100);
    check_value("#define VALUE GL_ES", 1);
    check_value("#line 40\n#define VALUE __LINE__", 42);
    check_value("#define VALUE __FILE__", 1);
    check_value("#line 7 9\n#define VALUE __FILE__", 9);
}

static void conditions_choose(void)
{
    check_value("#if 1\n#define VALUE 1\n#else\n#define VALUE 2\n#endif", 1);
    check_value("#if 0\n#define VALUE 1\n#elif 1\n#define VALUE 2\n#elif 1\n#define VALUE 3\n#endif", 2);
    check_value("#ifdef NONE\n#if 1\n#error\n#endif\n#else\n#define VALUE 2\n#endif", 2);
    check_value("#ifndef NONE\n#define VALUE 1\n#endif", 1);
    check_value("#if defined GL_ES && defined(GL_ES) && !defined(NONE)\n#define VALUE 1\n#endif", 1);
    check_value("#define IS defined(GL_ES)\n#if IS\n#define VALUE 1\n#endif", 1);
    check_value("#if 0 && NONE\n#else\n#define VALUE 1\n#endif", 1);
    check_value("#if 1 || NONE || 1 / 0\n#define VALUE 1\n#endif", 1);
}

static void conditions_compute(void)
{
    static const struct {
        const char *expression;
        bool holds;
    } rows[] = {
        {"2 + 3 * 4 == 14", true},
        {"(2 + 3) * 4 == 20", true},
        {"1 << 3 == 8", true},
        {"-8 >> 1 == -4", true},
        {"7 % 4 == 3", true},
        {"~0 == -1", true},
        {"!3", false},
        {"0x1F == 31", true},
        {"010 == 8", true},
        {"5 & 4", true},
        {"5 ^ 5", false},
        {"4 | 0", true},
        {"2 < 1", false},
        {"2 >= 2", true},
        {"- - 1", true},
        {"1 - 1 - 1 == -1", true},
        {"1 != 1", false},
        {"0 || 0 && 1", false},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++) {
        char source[256];
        snprintf(source, sizeof source, "#if %s\n#define VALUE 1\n#else\n#define VALUE 0\n#endif",
                 rows[i].expression);
        check_value(source, rows[i].holds);
    }
}

static void wrong_directives_are_reported(void)
{
    static const struct row rows[] = {
        {"#define\nvoid main() {}", "ERROR: 1:1:2: expected a name after #define"},
        {"#define __LINE__ 1\nvoid main() {}",
         "ERROR: 1:1:9: found '__LINE__', which is predefined, expected another name"},
        {"#define GL_X 1\nvoid main() {}",
         "ERROR: 1:1:9: found 'GL_X', expected a name that does not begin with GL_"},
        {"#define A 1\n#define A 2\nvoid main() {}",
         "ERROR: 1:2:9: found another definition of 'A', expected the same or #undef before"},
        {"#define F(a, a) a\nvoid main() {}", "ERROR: 1:1:14: found the parameter 'a' twice"},
        {"#define F(a) a\nvoid main() { F(1, 2); }",
         "ERROR: 1:2:15: found 2 arguments of the macro 'F', expected 1"},
        {"#if NONE\n#endif\nvoid main() {}", "ERROR: 1:1:5: found 'NONE', expected a number or a macro"},
        {"#if 1 / 0\n#endif\nvoid main() {}",
         "ERROR: 1:1:2: found the end of the line, expected a divisor that is not 0"},
        {"#if 1\nvoid main() {}", "ERROR: 1:1:2: found no #endif for this #if"},
        {"#else\nvoid main() {}", "ERROR: 1:1:2: found #else without #if"},
        {"#if 0\n#else\n#else\n#endif\nvoid main() {}", "ERROR: 1:3:2: found #else twice"},
        {"#wrong\nvoid main() {}", "ERROR: 1:1:1: found #wrong, expected a directive"},
        {"#error  no luck\nvoid main() {}", "ERROR: 1:1:2: #error no luck"},
        {"void main() {}\n#version 100",
         "ERROR: 1:2:2: found #version after other tokens, expected it at the beginning"},
        {"#extension GL_NONE : require\nvoid main() {}",
         "ERROR: 1:1:12: the extension GL_NONE is not supported"},
        {"#extension GL_NONE : enable\nvoid main() {}",
         "WARNING: 1:1:12: the extension GL_NONE is not supported"},
        {"void main() {} /* no end", "ERROR: 1:1:16: found a comment without an end, expected */"},
        {"void main() { $ }", "ERROR: 1:1:15: found '$', expected ';'"},
    };
    CHECK_ROWS(GLSL_VERTEX, rows);
}

static void growing_macros_end(void)
{
    char source[4096] = "#define A0 1 + 1\n", line[128];
    for (int i = 1; i < 40; i++) {
        snprintf(line, sizeof line, "#define A%d A%d + A%d\n", i, i - 1, i - 1);
        strcat(source, line);
    }
    strcat(source, "const int x = A39;\nvoid main() {}\n");
    char *log;
    struct glsl_unit *unit = compile(GLSL_VERTEX, source, &log);
    TEST_ASSERT_NULL(unit);
    TEST_ASSERT_NOT_NULL(strstr(log, "expand to more than"));
    free(log);
}

static void strings_are_joined(void)
{
    const char *strings[] = {"void ma", "in() { gl_Pos", "ition = vec4(0);\n}", "\nint x = ;"};
    const int lengths[] = {-1, 13, -1, 8};
    char *log;
    struct glsl_unit *unit = glsl_compile(GLSL_VERTEX, strings, lengths, 4, NULL, &log);
    TEST_ASSERT_NULL(unit);
    TEST_ASSERT_EQUAL_STRING("ERROR: 3:2:7: found the end of the source", strtok(log, ",\n"));
    free(log);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(macros_are_expanded);
    RUN_TEST(a_macro_is_not_expanded_in_itself);
    RUN_TEST(predefined_macros_have_values);
    RUN_TEST(conditions_choose);
    RUN_TEST(conditions_compute);
    RUN_TEST(wrong_directives_are_reported);
    RUN_TEST(growing_macros_end);
    RUN_TEST(strings_are_joined);
    return UNITY_END();
}
