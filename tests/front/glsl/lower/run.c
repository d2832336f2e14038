/* The meaning of statements and expressions: sources run on the machine, in both stages, and their results
 * are compared with those computed by hand. */
#include "tests/front/glsl/lower/machine.h"

#include <stdio.h>

void setUp(void)
{
    open_machine();
}

void tearDown(void)
{
    close_machine();
}

#define UNIFORMS "uniform vec4 u[4]; uniform int one, two; uniform bool yes, no; uniform mat3 m;\n"

static const struct value values[] = {
    {"u", 16, {1, 2, 3, 4, 5, 6, 7, 8, -1, -2, -3, -4, 0.5f, 0.25f, 0, 1}},
    {"one", 1, {1}},
    {"two", 1, {2}},
    {"yes", 1, {1}},
    {"no", 1, {0}},
    {"m", 9, {1, 2, 3, 4, 5, 6, 7, 8, 10}},
    {NULL, 0, {0}},
};

static const struct row {
    const char *name, *before, *body;
    float expected[4];
} rows[] = {
#define RUN(name, before, body, x, y, z, w) {name, before, body, {x, y, z, w}},
#include "tests/front/glsl/lower/run.def"
#undef RUN
};

enum { ROWS = sizeof rows / sizeof *rows, BYTES = 4096 };

static void expect_row(const struct row *row, float result[WIDTH][4])
{
    for (unsigned i = 0; i < WIDTH; i++)
        for (unsigned c = 0; c < 4; c++)
            TEST_ASSERT_FLOAT_WITHIN_MESSAGE(
                1e-6f + 1e-6f * (row->expected[c] < 0 ? -row->expected[c] : row->expected[c]),
                row->expected[c], result[i][c], row->name);
}

static void fragment_shaders_compute_their_bodies(void)
{
    static const char vertex[] = "attribute vec4 position; void main() { gl_Position = position; }";
    char fragment[BYTES];
    float result[WIDTH][4];
    for (unsigned i = 0; i < ROWS; i++) {
        snprintf(fragment, BYTES,
                 "precision highp float; precision highp int;\n" UNIFORMS
                 "%s\nvoid main() { vec4 r; %s\ngl_FragColor = r; }",
                 rows[i].before, rows[i].body);
        draw_sources(vertex, fragment, values, result, rows[i].name);
        expect_row(&rows[i], result);
    }
}

static void vertex_shaders_compute_their_bodies(void)
{
    static const char fragment[] =
        "precision highp float; varying vec4 result; void main() { gl_FragColor = result; }";
    char vertex[BYTES];
    float result[WIDTH][4];
    for (unsigned i = 0; i < ROWS; i++) {
        snprintf(vertex, BYTES,
                 "attribute vec4 position; varying vec4 result;\n" UNIFORMS
                 "%s\nvoid main() { vec4 r; %s\nresult = r; gl_Position = position; }",
                 rows[i].before, rows[i].body);
        draw_sources(vertex, fragment, values, result, rows[i].name);
        expect_row(&rows[i], result);
    }
}

/* A text of the corpus has both stages. */
static void read_corpus(const char *name, char text[2][4 * BYTES])
{
    char path[256];
    snprintf(path, sizeof path, "tests/front/glsl/corpus/%s.txt", name);
    FILE *file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    text[0][fread(text[0], 1, 4 * BYTES - 1, file)] = 0;
    fclose(file);
    char *second = strstr(text[0], "ps_gl\n");
    TEST_ASSERT_NOT_NULL_MESSAGE(second, path);
    strcpy(text[1], second);
    *second = 0;
}

static void texts_of_the_corpus_are_valid(void)
{
    static const char *const names[] = {"phong", "skin", "flow", "array", "extension", "builtin"};
    static char text[2][4 * BYTES];
    for (unsigned i = 0; i < sizeof names / sizeof *names; i++) {
        read_corpus(names[i], text);
        for (unsigned s = 0; s < 2; s++) {
            triptych_shader *shader;
            if (triptych_shader_assemble(machine, names[i], text[s], strlen(text[s]), &shader))
                TEST_FAIL_MESSAGE(triptych_error(machine));
            MACHINE(triptych_shader_destroy(machine, shader));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(fragment_shaders_compute_their_bodies);
    RUN_TEST(vertex_shaders_compute_their_bodies);
    RUN_TEST(texts_of_the_corpus_are_valid);
    return UNITY_END();
}
