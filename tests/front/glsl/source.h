/* Shaders of the tests: compiled, and compared with what is expected. */
#ifndef TESTS_FRONT_GLSL_SOURCE_H
#define TESTS_FRONT_GLSL_SOURCE_H

#include "front/glsl/node.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

/* A source and the first line of its log; null: it has no error and no warning. */
struct row {
    const char *source, *line;
};

/* Compiles "precision mediump float;" and the source, which begins in line 1. */
static inline struct glsl_unit *compile(enum glsl_stage stage, const char *source, char **log)
{
    static const char head[] =
        "#extension GL_OES_standard_derivatives : enable\nprecision mediump float;\n#line 0\n";
    const char *strings[2] = {stage == GLSL_FRAGMENT ? head : "", source};
    return glsl_compile(stage, strings, NULL, 2, NULL, log);
}

static inline void check_row(enum glsl_stage stage, const struct row *row)
{
    char *log;
    struct glsl_unit *unit = compile(stage, row->source, &log);
    TEST_ASSERT_NOT_NULL(log);
    log[strcspn(log, "\n")] = 0;
    TEST_ASSERT_EQUAL_STRING_MESSAGE(row->line ? row->line : "", log, row->source);
    TEST_ASSERT_EQUAL_MESSAGE(strncmp(log, "ERROR", 5) != 0, unit != NULL, row->source);
    glsl_unit_free(unit);
    free(log);
}

#define CHECK_ROWS(stage, rows)                                                                              \
    for (unsigned i = 0; i < sizeof(rows) / sizeof *(rows); i++)                                             \
    check_row((stage), &(rows)[i])

#endif
