/* Sources on the machine: compiled, linked, assembled and drawn by the engine `emulate`, whose shader part is
 * the specification. The target has WIDTH pixels of binary32. */
#ifndef TESTS_FRONT_GLSL_LOWER_MACHINE_H
#define TESTS_FRONT_GLSL_LOWER_MACHINE_H

#include "front/glsl/program.h"
#include "triptych.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { WIDTH = 8 };

/* A value of a uniform: scalars, by elements and columns. */
struct value {
    const char *name;
    unsigned count;
    float x[32];
};

static triptych_device *machine;

#define MACHINE(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(machine))

static inline void open_machine(void)
{
    static const float corners[4][4] = {{-1, 1, 0, 1}, {1, 1, 0, 1}, {-1, -1, 0, 1}, {1, -1, 0, 1}};
    struct triptych_options options = {.engine = "emulate", .threads = 1};
    struct triptych_target_description target = {
        .width = WIDTH, .height = 1, .color_format = {TRIPTYCH_SURFACE_A32B32G32R32F}};
    triptych_buffer *buffer;
    char reason[256] = "";
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK,
                                  triptych_device_create(&options, &machine, reason, sizeof reason), reason);
    MACHINE(triptych_set_target_description(machine, &target));
    MACHINE(triptych_set_state(machine, TRIPTYCH_STATE_CULLMODE, 1));
    MACHINE(triptych_set_state(machine, TRIPTYCH_STATE_ZENABLE, 0));
    MACHINE(triptych_buffer_create(machine, corners, sizeof corners, &buffer));
    struct triptych_element element = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof *corners};
    MACHINE(triptych_set_element(machine, TRIPTYCH_TEXCOORD, &element));
}

static inline void close_machine(void)
{
    triptych_device_destroy(machine);
    machine = NULL;
}

static inline struct glsl_unit *compile_source(enum glsl_stage stage, const char *source)
{
    char *log;
    struct glsl_unit *unit = glsl_compile(stage, &source, NULL, 1, NULL, &log);
    TEST_ASSERT_NOT_NULL_MESSAGE(unit, log);
    free(log);
    return unit;
}

static inline struct glsl_program *link_sources(const char *vertex, const char *fragment, char **log)
{
    static const struct glsl_binding binding = {"position", 0};
    struct glsl_unit *v = compile_source(GLSL_VERTEX, vertex), *f = compile_source(GLSL_FRAGMENT, fragment);
    struct glsl_program *program = glsl_link(v, f, &binding, 1, log);
    glsl_unit_free(v);
    glsl_unit_free(f);
    return program;
}

static inline void set_uniform(const struct glsl_uniform *uniform, const struct value *value,
                               float constant[GLSL_STAGES][256][4])
{
    unsigned rows = uniform->type.rows;
    for (unsigned s = 0; s < GLSL_STAGES; s++)
        for (unsigned i = 0; uniform->stage[s].first >= 0 && i < value->count; i++)
            if (i / rows < uniform->stage[s].elements * (unsigned)uniform->type.columns)
                constant[s][(unsigned)uniform->stage[s].first + i / rows]
                        [uniform->stage[s].component + i % rows] = value->x[i];
}

static inline void set_uniforms(const struct glsl_program *program, const struct value *values)
{
    static float constant[GLSL_STAGES][256][4];
    memset(constant, 0, sizeof constant);
    for (unsigned i = 0; i < program->uniforms; i++)
        for (const struct value *v = values; v && v->name; v++)
            if (!strcmp(v->name, program->uniform[i].name))
                set_uniform(&program->uniform[i], v, constant);
    MACHINE(triptych_set_shader_floats(machine, TRIPTYCH_SHADER_VERTEX, 0, constant[0][0], 256));
    MACHINE(triptych_set_shader_floats(machine, TRIPTYCH_SHADER_PIXEL, 0, constant[1][0], 224));
}

/* Draws all pixels of the target by a program; `message` names it in failures. */
static inline void draw_program(const struct glsl_program *program, const struct value *values,
                                float result[WIDTH][4], const char *message)
{
    static const float nothing[4];
    triptych_shader *shader[GLSL_STAGES];
    for (unsigned s = 0; s < GLSL_STAGES; s++)
        if (triptych_shader_assemble(machine, message, program->text[s], strlen(program->text[s]),
                                     &shader[s]))
            TEST_FAIL_MESSAGE(triptych_error(machine));
    MACHINE(triptych_set_vertex_shader(machine, shader[0]));
    MACHINE(triptych_set_pixel_shader(machine, shader[1]));
    set_uniforms(program, values);
    MACHINE(triptych_clear(machine, nothing, 1));
    MACHINE(triptych_draw(machine, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    MACHINE(triptych_read_target_numbers(machine, 0, result[0], sizeof(float[WIDTH][4])));
    for (unsigned s = 0; s < GLSL_STAGES; s++)
        MACHINE(triptych_shader_destroy(machine, shader[s]));
}

/* Draws sources. Uniforms are found by their names in `values`, which ends with a name of null. */
static inline void draw_sources(const char *vertex, const char *fragment, const struct value *values,
                                float result[WIDTH][4], const char *message)
{
    char *log;
    struct glsl_program *program = link_sources(vertex, fragment, &log);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, log);
    draw_program(program, values, result, message);
    glsl_program_free(program);
    free(log);
}

#endif
