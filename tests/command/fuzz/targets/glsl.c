/* Sources of the OpenGL ES Shading Language. The first byte chooses the stage, and how the source is
 * divided into strings. */
#include "front/glsl/program.h"
#include "tests/command/fuzz/targets/target.h"

#include <string.h>

enum { STRINGS = 3 };

/* Each line of the log begins with its kind and a place. */
static void expect_log(const char *log)
{
    for (const char *line = log; *line; line += strcspn(line, "\n") + 1) {
        bool error = !strncmp(line, "ERROR: ", 7), warning = !strncmp(line, "WARNING: ", 9);
        expect(error || warning, "%.80s", line);
        expect(strchr(line, '\n'), "%.80s has no end", line);
    }
}

/* Links the unit with one of the other stage. A program has the text of both stages. */
static void link_with_other(enum glsl_stage stage, const struct glsl_unit *unit)
{
    static const char *const others[] = {
        "attribute vec4 p; varying vec4 v; uniform vec4 u; void main() { gl_Position = p * u; v = p; }",
        "precision mediump float; varying vec4 v; void main() { gl_FragColor = v; }"};
    char *log;
    struct glsl_unit *other = glsl_compile(stage == GLSL_VERTEX ? GLSL_FRAGMENT : GLSL_VERTEX,
                                           &others[stage == GLSL_VERTEX], NULL, 1, NULL, &log);
    free(log);
    struct glsl_program *program =
        stage == GLSL_VERTEX ? glsl_link(unit, other, NULL, 0, &log) : glsl_link(other, unit, NULL, 0, &log);
    expect(log, "no log");
    expect(program ? !*log : !strncmp(log, "ERROR: ", 7), "%s", log);
    expect(!program || (!strncmp(program->text[0], "vs_gl\n", 6) && !strncmp(program->text[1], "ps_gl\n", 6)),
           "no text");
    glsl_program_free(program);
    glsl_unit_free(other);
    free(log);
}

static void run(const uint8_t *data, size_t bytes)
{
    struct choices choices = {data, data + bytes};
    unsigned choice = choose(&choices, 2 * STRINGS);
    size_t rest = (size_t)(choices.end - choices.at);
    const char *strings[STRINGS], *at = (const char *)choices.at;
    int lengths[STRINGS];
    unsigned count = 1 + choice / 2;
    for (unsigned i = 0; i < count; i++) {
        strings[i] = at + rest * i / count;
        lengths[i] = (int)(rest * (i + 1) / count - rest * i / count);
    }
    char *log;
    struct glsl_unit *unit =
        glsl_compile(choice % 2 ? GLSL_FRAGMENT : GLSL_VERTEX, strings, lengths, count, NULL, &log);
    expect(log, "no log");
    expect_log(log);
    expect(unit || strstr(log, "ERROR: "), "%s", log);
    if (unit)
        link_with_other(choice % 2 ? GLSL_FRAGMENT : GLSL_VERTEX, unit);
    glsl_unit_free(unit);
    free(log);
}

const struct fuzz_target fuzz_glsl = {"glsl", run};
