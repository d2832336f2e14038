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

static void make_vertex_key(struct vertex_key *key)
{
    memset(key->varying, 1, sizeof key->varying);
    key->varying[VARYING_blending] = 0;
    for (unsigned c = 0; c < 4; c++)
        key->link[4 * PORT_DIFFUSE + c] = (uint8_t)(LINK_OUTPUT + 4 + c);
    for (unsigned i = 0; i < 2; i++)
        key->input[i] = ATTRIBUTE_FORMAT_FLOAT4;
}

static void make_pixel_key(struct pixel_key *key)
{
    memset(key->varying, INTERPOLATION_SMOOTH, sizeof key->varying);
    key->varying[VARYING_blending] = INTERPOLATION_NONE;
    key->depth_function = COMPARE_ALWAYS;
    key->float_color = 1;
    key->write_mask[0] = 15;
}

union key sample_key(enum unit unit, const char *name)
{
    union key key;
    memset(&key, 0, sizeof key);
    key_set_program(unit == UNIT_VERTEX ? key.vertex.shader : key.pixel.shader, sample_named(name)->number);
    if (unit == UNIT_VERTEX)
        make_vertex_key(&key.vertex);
    else
        make_pixel_key(&key.pixel);
    return key;
}
