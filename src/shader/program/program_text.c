/* The text of programs, for listings. Equal shaders with different texts are one program, so the text is
 * read anew: the written one of a shader, or the canonical one, printed from the tokens. Reading gives the
 * line of each instruction. */
#include "shader/program/program.h"

#include <stdlib.h>
#include <string.h>

static int print_tokens(const struct program *program, char **text, size_t *bytes, struct error *error)
{
    struct shader *shader;
    if (shader_read(program->name, program->tokens, program->token_count * sizeof *program->tokens, &shader,
                    error))
        return -1;
    int result = shader_print(shader, text, bytes, error);
    shader_free(shader);
    return result;
}

static int find_steps(struct program_text *text, const char *name, size_t bytes, struct error *error)
{
    struct shader *shader;
    if (shader_assemble(name, text->text, bytes, &shader, error))
        return -1;
    text->line_of_step = calloc(shader->count + 1, sizeof *text->line_of_step);
    for (uint32_t i = 0; text->line_of_step && i < shader->count; i++)
        if (program_has_step(&shader->instructions[i]))
            text->line_of_step[text->steps++] = shader->instructions[i].place;
    shader_free(shader);
    return text->line_of_step ? 0 : error_set(error, "out of memory for the lines of a shader");
}

/* The last line may have no end. */
static int split_lines(struct program_text *text, struct error *error)
{
    uint32_t count = 1;
    for (const char *at = text->text; (at = strchr(at, '\n')); at++)
        count++;
    text->line = calloc(count, sizeof *text->line);
    if (!text->line)
        return error_set(error, "out of memory for the lines of a shader");
    for (char *at = text->text; *at;) {
        size_t length = strcspn(at, "\r\n");
        text->line[text->lines++] = at;
        char *end = at + length;
        at = end + (*end == '\r') + (end[*end == '\r'] == '\n');
        *end = 0;
    }
    return 0;
}

int program_text_read(const struct program *program, char *written, size_t bytes, struct program_text *text,
                      struct error *error)
{
    *text = (struct program_text){.text = written};
    int result = find_steps(text, program->name, bytes, error);
    if (!result && text->steps != program->steps)
        result = error_set(error, "the text of shader %s is of another program", program->name);
    if (!result)
        result = split_lines(text, error);
    if (result)
        program_text_free(text);
    return result;
}

int program_text_open(const struct program *program, struct program_text *text, struct error *error)
{
    char *printed = NULL;
    size_t bytes;
    *text = (struct program_text){0};
    return print_tokens(program, &printed, &bytes, error)
               ? -1
               : program_text_read(program, printed, bytes, text, error);
}

void program_text_free(struct program_text *text)
{
    free(text->text);
    free(text->line);
    free(text->line_of_step);
    *text = (struct program_text){0};
}
