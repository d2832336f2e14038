#include "tests/support/picture/quad.h"

#include "machine/mxcsr.h"
#include "render/derive/derive_part.h"
#include "render/device/device.h"
#include "emu/emulate/bind.h"
#include "shader/program/program.h"
/* The header defines the three routines too, which are not used here. */
#pragma GCC diagnostic ignored "-Wunused-function"
#include "spec/spec.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

/* The values that a draw derives. */
struct derived {
    struct vertex_key vertex;
    struct pixel_key pixel;
    struct job job;
};

static const struct program *make_program(const char *text)
{
    static char message[4096];
    struct error error = {{0}};
    struct shader *shader;
    const struct program *program = NULL;
    if (!shader_assemble("quad", text, strlen(text), &shader, &error) &&
        !shader_validate(shader, NULL, &error))
        program = program_acquire(shader, &error);
    shader_free(shader);
    snprintf(message, sizeof message, "%s\n%s", error.text, text);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, message);
    return program;
}

static struct state state; /* the device's, with the program */

static void derive(const struct program *program, const struct quad *quad, struct derived *d)
{
    int pixel = program->model->stage == STAGE_PIXEL;
    memset(d, 0, sizeof *d);
    for (int i = 0; i < PIXEL_SAMPLERS; i++)
        if (program->interface.sampled >> i & 1 && pixel)
            derive_pixel_sampler(&state, i, &d->pixel);
        else if (program->interface.sampled >> i & 1)
            derive_vertex_sampler(&state, i, &d->vertex);
    memcpy(d->pixel.projected, quad->projected, sizeof d->pixel.projected);
    for (int i = 0; i < 4 && pixel; i++)
        d->pixel.shader[i] = (uint8_t)(program->number >> 8 * i);
    derive_job(&state, &d->vertex, &d->pixel, &d->job);
}

static void give_inputs(struct machine *m, const struct quad *quad)
{
    for (int r = 0; r < OUTPUT_COUNT; r++)
        for (int c = 0; c < 4; c++)
            memcpy(&m->input[r][c], quad->v[r % QUAD_REGISTERS][c], sizeof m->input[r][c]);
    for (int r = 0; r < QUAD_REGISTERS; r++)
        memcpy(m->coordinate[r], m->input[r], sizeof m->coordinate[r]);
}

static unsigned result_cell(const struct program *program)
{
    if (program->model->stage == STAGE_VERTEX)
        return CELL_OUTPUT + 4;
    return shader_major(program->model) == 1 ? CELL_TEMPORARY : CELL_OUTPUT;
}

void quad_shade(const triptych_device *device, const char *text, const struct quad *quad,
                struct quad_result *result)
{
    static struct env environment;
    static struct machine m;
    static struct derived derived;
    static const int32_t integer[16][4];
    static const uint8_t booleans[2];
    struct env *e = &environment;
    const struct program *program = make_program(text);
    uint8_t *constants = malloc(program_constant_bytes(program));
    TEST_ASSERT_NOT_NULL(constants);
    program_write_constants(program, quad->constant, integer, constants);
    state = device->state;
    state.program[program->model->stage] = program;
    derive(program, quad, &derived);
    unsigned saved = mxcsr_enter();
    e->program = program;
    e->base[BASE_CONSTANT] = constants;
    e->base[BASE_JOB] = (const uint8_t *)&derived.job;
    machine_begin(E, &m, booleans, 0);
    m.pixel = program->model->stage == STAGE_PIXEL ? &derived.pixel : NULL;
    m.vertex = program->model->stage == STAGE_VERTEX ? &derived.vertex : NULL;
    give_inputs(&m, quad);
    machine_run(E, &m);
    mxcsr_leave(saved);
    memcpy(result->color, &m.cell[result_cell(program)], sizeof result->color);
    memcpy(result->depth, &m.cell[CELL_DEPTH], sizeof result->depth);
    memcpy(result->killed, &m.killed, sizeof result->killed);
    free(constants);
    program_release(program);
}

void quad_set_lanes(struct quad *quad, int r, int c, float value)
{
    for (int lane = 0; lane < QUAD_LANES; lane++)
        quad->v[r][c][lane] = value;
}

void quad_set(struct quad *quad, int r, float x, float y, float z, float w)
{
    const float v[4] = {x, y, z, w};
    for (int c = 0; c < 4; c++)
        quad_set_lanes(quad, r, c, v[c]);
}

void quad_expect(const struct quad_result *result, int lane, const float expected[4], const char *what)
{
    for (int c = 0; c < 4; c++) {
        char message[600];
        float got = result->color[c][lane];
        if (got == expected[c] || (isnan(got) && isnan(expected[c])))
            continue;
        snprintf(message, sizeof message, "%s: lane %d, component %c: expected %.9g, got %.9g", what, lane,
                 "xyzw"[c], (double)expected[c], (double)got);
        TEST_FAIL_MESSAGE(message);
    }
}

void quad_expect_all(const struct quad_result *result, const float expected[4], const char *what)
{
    for (int lane = 0; lane < QUAD_LANES; lane++)
        quad_expect(result, lane, expected, what);
}
