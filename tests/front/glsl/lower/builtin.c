/* The functions of the language against references in double precision. Each pixel has a pair of inputs,
 * chosen by gl_FragCoord from an array of uniforms. */
#include "tests/front/glsl/lower/machine.h"

#include <math.h>
#include <stdio.h>

void setUp(void)
{
    open_machine();
}

void tearDown(void)
{
    close_machine();
}

static double smooth(double low, double high, double x)
{
    double t = fmin(fmax((x - low) / (high - low), 0), 1);
    return t * t * (3 - 2 * t);
}

#define BUILTIN(id, expression, reference, relative, absolute, lower, upper)                                 \
    static double of_##id(double x, double y)                                                                \
    {                                                                                                        \
        (void)y;                                                                                             \
        return reference;                                                                                    \
    }
#include "tests/front/glsl/lower/builtin.def"
#undef BUILTIN

static const struct row {
    const char *expression;
    double (*reference)(double x, double y);
    double relative, absolute, lower, upper;
} rows[] = {
#define BUILTIN(id, expression, reference, relative, absolute, lower, upper)                                 \
    {expression, of_##id, relative, absolute, lower, upper},
#include "tests/front/glsl/lower/builtin.def"
#undef BUILTIN
};

enum { ROWS = sizeof rows / sizeof *rows, BYTES = 1024, INPUTS = WIDTH * 4 };

/* A sequence that is the same in each run. */
static double between(double lower, double upper)
{
    static uint32_t seed = 1;
    seed = seed * 1664525u + 1013904223u;
    return lower + (upper - lower) * (seed >> 8) / 16777216.0;
}

static void make_inputs(const struct row *row, struct value *value)
{
    value->count = INPUTS;
    for (unsigned i = 0; i < INPUTS; i++)
        value->x[i] = (float)between(row->lower, row->upper);
}

static void check_component(const struct row *row, float a, float b, float found)
{
    char message[256];
    double expected = row->reference((double)a, (double)b);
    double limit = fmax(row->relative * fabs(expected), row->absolute);
    snprintf(message, sizeof message, "%s of %.9g and %.9g: %.9g, expected %.9g within %.3g", row->expression,
             (double)a, (double)b, (double)found, expected, limit);
    TEST_ASSERT_TRUE_MESSAGE(fabs((double)found - expected) <= limit, message);
}

static void run_row(const struct row *row)
{
    enum { ROUNDS = 4 };
    static const char vertex[] = "attribute vec4 position; void main() { gl_Position = position; }";
    char fragment[BYTES], *log;
    struct value values[3] = {{"p", 0, {0}}, {"q", 0, {0}}, {NULL, 0, {0}}};
    snprintf(
        fragment, BYTES,
        "precision highp float; uniform vec4 p[8], q[8];\nvoid main() { int i = int(gl_FragCoord.x); vec4 a "
        "= p[i], b = q[i]; gl_FragColor = %s; }",
        row->expression);
    struct glsl_program *program = link_sources(vertex, fragment, &log);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, log);
    for (unsigned round = 0; round < ROUNDS; round++) {
        float result[WIDTH][4];
        make_inputs(row, &values[0]);
        make_inputs(row, &values[1]);
        draw_program(program, values, result, row->expression);
        for (unsigned i = 0; i < INPUTS; i++)
            check_component(row, values[0].x[i], values[1].x[i], result[i / 4][i % 4]);
    }
    glsl_program_free(program);
    free(log);
}

static void functions_equal_their_references(void)
{
    for (unsigned i = 0; i < ROWS; i++)
        run_row(&rows[i]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(functions_equal_their_references);
    return UNITY_END();
}
