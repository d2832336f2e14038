#include "tests/command/fuzz/targets/sound.h"

#include "shader/program/program.h"
#include "tests/command/fuzz/targets/target.h"
#include "triptych.h"

#include <string.h>

/* Fails unless the shader, after a conversion to text or tokens and back, has the same tokens. */
static void expect_same(struct shader *again, const uint32_t *tokens, size_t count)
{
    struct error error = {{0}};
    uint32_t *tokens_again;
    size_t count_again;
    expect(!shader_encode(again, &tokens_again, &count_again, &error), "%s", error.text);
    expect(count == count_again && !memcmp(tokens, tokens_again, count * sizeof *tokens),
           "%zu and %zu tokens", count, count_again);
    free(tokens_again);
    shader_free(again);
}

/* Fails unless the shader's text, assembled and printed again, is the same text. */
static void expect_text(const struct shader *shader, const uint32_t *tokens, size_t count)
{
    struct error error = {{0}};
    struct shader *again;
    char *text, *text_again;
    size_t bytes, bytes_again;
    expect(!shader_print(shader, &text, &bytes, &error), "%s", error.text);
    expect(!shader_assemble("again", text, bytes, &again, &error), "%s\n%s", error.text, text);
    expect(!shader_print(again, &text_again, &bytes_again, &error), "%s", error.text);
    expect(bytes == bytes_again && !memcmp(text, text_again, bytes), "%s\n%s", text, text_again);
    expect_same(again, tokens, count);
    free(text);
    free(text_again);
}

/* Fills the inputs of a program at a draw: constants, and integers in and out of their range. */
static void expect_program(const struct program *program)
{
    static const int32_t integers[TRIPTYCH_SHADER_INTEGERS][4] = {
        {1, 2, 3}, {255, 255, -128}, {255, 0, 1}, {-1}};
    static const float floats[TRIPTYCH_SHADER_FLOATS][4];
    struct error error = {{0}};
    void *constants = malloc(program_constant_bytes(program) + 1);
    expect(program == program_find(program->number), "program %u", program->number);
    if (program_check_integers(program, integers, &error))
        expect(error.text[0] && !strchr(error.text, '\n'), "%s", error.text);
    if (constants)
        program_write_constants(program, floats, integers, constants);
    free(constants);
    program_release(program);
}

static void expect_opinion(const struct shader *shader)
{
    struct shader_counts counts;
    struct error error = {{0}}, again = {{0}};
    int bad = shader_validate(shader, &counts, &error);
    expect(bad == shader_validate(shader, NULL, &again) && !strcmp(error.text, again.text), "%s, %s",
           error.text, again.text);
    if (bad) {
        expect_refusal(&error, shader->path);
        return;
    }
    expect(!error.text[0], "%s", error.text);
    const struct program *program = program_acquire(shader, &error);
    if (program)
        expect_program(program);
    else
        expect(error.text[0] && !strchr(error.text, '\n'), "%s", error.text);
}

void expect_sound(const struct shader *shader)
{
    struct error error = {{0}};
    struct shader *again;
    uint32_t *tokens;
    size_t count;
    expect_opinion(shader);
    expect(!shader_encode(shader, &tokens, &count, &error), "%s", error.text);
    expect(!shader_read("again", tokens, count * sizeof *tokens, &again, &error), "%s", error.text);
    expect_same(again, tokens, count);
    expect_text(shader, tokens, count);
    free(tokens);
}
