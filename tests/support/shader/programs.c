#include "tests/support/shader/programs.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

static const struct {
    const char *name, *text;
} samples[] = {
#define PROGRAM(name, text) {#name, text},
#include "tests/support/shader/programs.def"
#undef PROGRAM
};

enum { SAMPLES = sizeof samples / sizeof *samples };

static const struct program *made[SAMPLES];

static const struct program *make(unsigned i)
{
    struct error error = {{0}};
    struct shader *shader;
    char message[512];
    const struct program *program = NULL;
    if (!shader_assemble(samples[i].name, samples[i].text, strlen(samples[i].text), &shader, &error))
        program = program_acquire(shader, &error);
    shader_free(shader);
    snprintf(message, sizeof message, "%s", error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, message);
    return program;
}

const struct program *sample_program(unsigned i)
{
    if (i >= SAMPLES)
        return NULL;
    if (!made[i])
        made[i] = make(i);
    return made[i];
}

const struct program *sample_named(const char *name)
{
    for (unsigned i = 0; i < SAMPLES; i++)
        if (!strcmp(samples[i].name, name))
            return sample_program(i);
    TEST_FAIL_MESSAGE(name);
    return NULL;
}
