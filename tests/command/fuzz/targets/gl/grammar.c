/* Tokens of the OpenGL ES Shading Language: each byte of an input is a word (word.def), so that most inputs
 * reach the parser and the checks after it. The first byte chooses the stage. White space and the division
 * into strings must not change what a source means. */
#include "front/glsl/program.h"
#include "tests/command/fuzz/targets/target.h"

#include <string.h>

static const char *const words[] = {
#define GLSL_KEYWORD(word, token) word,
#include "front/glsl/compile/keyword.def"
#undef GLSL_KEYWORD
#define WORD(word) word,
#include "tests/command/fuzz/targets/gl/word.def"
#undef WORD
};

enum { WORDS = sizeof words / sizeof *words, MOST = 1024, STRINGS = 3, WORD_BYTES = 32 };
_Static_assert(WORDS <= 256, "a byte has the number of a word");

/* A source in two layouts. */
struct layout {
    const char *string[STRINGS];
    int length[STRINGS];
    unsigned count;
};

static const char head[] = "#extension GL_OES_standard_derivatives : enable\nprecision mediump float;\n";

/* Returns the text of the words, with a separator after each. The caller frees it. */
static char *join(const struct choices *choices, const char *separator, size_t *middle)
{
    size_t count = (size_t)(choices->end - choices->at), used = 0;
    count = count < MOST ? count : MOST;
    char *text = malloc(count * WORD_BYTES + 1);
    expect(text, "memory");
    *middle = 0;
    for (size_t i = 0; i < count; i++) {
        used += (size_t)sprintf(text + used, "%s%s", words[choices->at[i] % WORDS], separator);
        if (i == count / 2)
            *middle = used;
    }
    text[used] = 0;
    return text;
}

/* The end of each line of a log, after the place. */
static void expect_same_log(const char *a, const char *b)
{
    while (*a && *b) {
        const char *text_a = strstr(a, ": ") + 2, *text_b = strstr(b, ": ") + 2;
        text_a = strstr(text_a, ": ");
        text_b = strstr(text_b, ": ");
        size_t length = strcspn(text_a, "\n");
        expect(length == strcspn(text_b, "\n") && !memcmp(text_a, text_b, length), "%.200s\n%.200s", a, b);
        a = text_a + length + 1;
        b = text_b + length + 1;
    }
    expect(*a == *b, "%.200s\n%.200s", a, b);
}

static char *text_of(enum glsl_stage stage, const struct glsl_unit *unit)
{
    static const char *const others[] = {
        "attribute vec4 p; void main() { gl_Position = p; gl_PointSize = 1.0; }",
        "void main() { gl_FragColor = vec4(1); }"};
    char *log, *text = NULL;
    struct glsl_unit *other = glsl_compile(stage == GLSL_VERTEX ? GLSL_FRAGMENT : GLSL_VERTEX,
                                           &others[stage == GLSL_VERTEX], NULL, 1, NULL, &log);
    free(log);
    struct glsl_program *program =
        stage == GLSL_VERTEX ? glsl_link(unit, other, NULL, 0, &log) : glsl_link(other, unit, NULL, 0, &log);
    expect(log && (program || !strncmp(log, "ERROR: ", 7)), "%s", log ? log : "no log");
    text = strdup(program ? program->text[stage] : log);
    free(log);
    glsl_program_free(program);
    glsl_unit_free(other);
    return text;
}

static void expect_equal(enum glsl_stage stage, const struct layout *one, const struct layout *two)
{
    char *log[2], *text[2] = {NULL, NULL};
    struct glsl_unit *unit[2];
    unit[0] = glsl_compile(stage, one->string, one->length, one->count, NULL, &log[0]);
    unit[1] = glsl_compile(stage, two->string, two->length, two->count, NULL, &log[1]);
    expect(log[0] && log[1] && !unit[0] == !unit[1], "%s\n%s", log[0], log[1]);
    expect(unit[0] || !strncmp(log[0], "ERROR: ", 7) || strstr(log[0], "\nERROR: "), "%s", log[0]);
    expect_same_log(log[0], log[1]);
    for (int i = 0; i < 2 && unit[0]; i++)
        text[i] = text_of(stage, unit[i]);
    expect(!unit[0] || !strcmp(text[0], text[1]), "%s\n%s", text[0], text[1]);
    for (int i = 0; i < 2; i++) {
        glsl_unit_free(unit[i]);
        free(log[i]);
        free(text[i]);
    }
}

static void run(const uint8_t *data, size_t bytes)
{
    struct choices choices = {data, data + bytes};
    enum glsl_stage stage = choose(&choices, 2) ? GLSL_FRAGMENT : GLSL_VERTEX;
    size_t middle, unused;
    char *plain = join(&choices, " ", &unused), *spread = join(&choices, " /**/\n\t", &middle);
    const struct layout one = {{head, plain}, {-1, -1}, 2};
    const struct layout two = {{head, spread, spread + middle}, {-1, (int)middle, -1}, 3};
    expect_equal(stage, &one, &two);
    free(plain);
    free(spread);
}

const struct fuzz_target fuzz_grammar = {"grammar", run};
