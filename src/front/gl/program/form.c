/* The forms of a fragment shader: which colours its results are. All but the first are made when a draw needs
 * them. */
#include "front/gl/program/program.h"
#include "front/gl/constant.h"
#include "front/gl/state.h"

#include <stdlib.h>
#include <string.h>

static const char first_color[] = "oC0";
enum { NAME = sizeof first_color - 1 };

/* The place of oC0 if it is the result of the line's instruction, the first operand; else null. */
static const char *find_result(const char *line)
{
    line += strspn(line, " ");
    line += strcspn(line, " \n");
    line += *line == ' ';
    return !strncmp(line, first_color, NAME) ? line : NULL;
}

/* The text in which each instruction that writes oC0 also writes the colours of the other targets. Null
 * without memory. */
static char *broadcast(const char *text)
{
    char *all = malloc(GL_DRAWS * strlen(text) + 1), *to = all;
    for (size_t length; all && *text; text += length) {
        length = strcspn(text, "\n") + 1;
        const char *result = find_result(text);
        for (unsigned i = 0; i < (result ? GL_DRAWS : 1u); i++, to += length) {
            memcpy(to, text, length);
            if (result)
                to[result - text + NAME - 1] = (char)('0' + i);
        }
    }
    if (all)
        *to = 0;
    return all;
}

static triptych_shader *make(struct gl_context *context, const struct glsl_program *linked, enum gl_form form,
                             bool turned)
{
    const char *plain = turned ? linked->turned : linked->text[GLSL_FRAGMENT];
    char *own = form == GL_FORM_BROADCAST ? broadcast(plain) : NULL;
    const char *text = form == GL_FORM_SECOND ? linked->second[turned] : own;
    triptych_shader *shader = NULL;
    if (!text || triptych_shader_assemble(context->renderer, "fragment", text, strlen(text), &shader))
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a form of a fragment shader");
    free(own);
    return shader;
}

triptych_shader *gl_program_pixel(struct gl_context *context, struct gl_program *program, enum gl_form form,
                                  bool turned)
{
    turned = turned && program->turned;
    triptych_shader **other = &program->other[form][turned];
    if (form != GL_FORM_TARGETS && !*other)
        *other = make(context, program->program, form, turned);
    if (form != GL_FORM_TARGETS && *other)
        return *other;
    return turned ? program->turned : program->stage[GLSL_FRAGMENT];
}
