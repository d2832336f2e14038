/* Uniforms: chapter 2.10.4. Their values are in the constants of the stages that use them. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/program/program.h"
#include "front/gl/state.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Locations --- */

static unsigned elements_of(const struct glsl_uniform *uniform)
{
    return uniform->type.array ? (unsigned)uniform->type.array : 1;
}

static void count_constants(struct gl_program *program, const struct glsl_uniform *uniform)
{
    for (unsigned s = 0; s < GLSL_STAGES && !glsl_is_sampler(uniform->type); s++) {
        unsigned end =
            (unsigned)(uniform->stage[s].first + uniform->stage[s].elements * uniform->type.columns);
        if (uniform->stage[s].first >= 0 && end > program->constants[s].used)
            program->constants[s].used = end;
    }
}

bool gl_uniforms_begin(struct gl_program *program)
{
    const struct glsl_program *linked = program->program;
    unsigned count = 0;
    for (unsigned i = 0; i < linked->uniforms; i++)
        count += linked->uniform[i].builtin ? 0 : elements_of(linked->uniform + i);
    memset(program->constants, 0, sizeof program->constants);
    memset(program->unit, 0, sizeof program->unit);
    program->location = calloc(count + 1, sizeof *program->location);
    if (!program->location)
        return false;
    for (unsigned i = 0; i < linked->uniforms; i++) {
        count_constants(program, linked->uniform + i);
        for (unsigned e = 0; !linked->uniform[i].builtin && e < elements_of(linked->uniform + i); e++)
            program->location[program->locations++] = (struct gl_location){(uint16_t)i, (uint16_t)e};
    }
    return true;
}

/* Reads the "[12]" at the end of a name. Returns the bytes before it; 0 if the name is wrong. */
static size_t split_name(const char *name, unsigned *element)
{
    size_t bytes = strlen(name);
    const char *bracket = strrchr(name, '[');
    *element = 0;
    if (!bracket || !bytes || name[bytes - 1] != ']')
        return bytes;
    size_t digits = (size_t)(name + bytes - 1 - (bracket + 1));
    if (!digits || digits > 5 || strspn(bracket + 1, "0123456789") != digits)
        return 0;
    *element = (unsigned)strtoul(bracket + 1, NULL, 10);
    return (size_t)(bracket - name);
}

static bool has_name(const struct glsl_uniform *uniform, const char *name, unsigned *element)
{
    *element = 0;
    if (!strcmp(uniform->name, name))
        return true;
    size_t bytes = split_name(name, element);
    return bytes && uniform->type.array && *element < elements_of(uniform) &&
           strlen(uniform->name) == bytes && !memcmp(uniform->name, name, bytes);
}

GLint gl_GetUniformLocation(struct gl_context *context, GLuint name, const GLchar *uniform)
{
    const struct gl_program *program = gl_program_find(context, name);
    unsigned element;
    if (program && !program->linked)
        gl_error(context, GL_INVALID_OPERATION, "found program %u, expected one that is linked", name);
    for (unsigned i = 0; program && program->linked && i < program->locations; i++) {
        const struct gl_location *location = program->location + i;
        if (!location->element && has_name(program->program->uniform + location->uniform, uniform, &element))
            return (GLint)(i + element);
    }
    return -1;
}

void gl_GetActiveUniform(struct gl_context *context, GLuint name, GLuint index, GLsizei room, GLsizei *length,
                         GLint *size, GLenum *type, GLchar *out)
{
    char text[1100];
    const struct gl_program *program = gl_program_find(context, name);
    if (!program)
        return;
    if (room < 0 || !program->program || index >= program->program->uniforms) {
        gl_error(context, GL_INVALID_VALUE, "found uniform %u and a size of %d", index, room);
        return;
    }
    const struct glsl_uniform *uniform = program->program->uniform + index;
    snprintf(text, sizeof text, "%s%s", uniform->name, uniform->type.array ? "[0]" : "");
    gl_code_copy_text(text, room, length, out);
    *size = (GLint)elements_of(uniform);
    *type = gl_code_type(uniform->type);
}

/* --- Writing --- */

static void note_change(struct gl_constants *constants, unsigned first, unsigned last)
{
    bool fresh = !constants->last;
    constants->first = fresh || first < constants->first ? first : constants->first;
    constants->last = last > constants->last ? last : constants->last;
}

/* Writes an element, column after column. */
static void write_element(struct gl_program *program, const struct glsl_uniform *uniform, unsigned element,
                          const float *values)
{
    unsigned columns = uniform->type.columns, rows = uniform->type.rows;
    for (unsigned s = 0; s < GLSL_STAGES; s++) {
        if (uniform->stage[s].first < 0 || element >= uniform->stage[s].elements)
            continue;
        unsigned first = (unsigned)uniform->stage[s].first + element * columns;
        for (unsigned k = 0; k < columns; k++)
            memcpy(program->constants[s].value[first + k] + uniform->stage[s].component, values + k * rows,
                   rows * sizeof *values);
        note_change(&program->constants[s], first, first + columns);
    }
}

void gl_uniforms_set(struct gl_program *program, const char *name, unsigned element, const GLfloat *values)
{
    for (unsigned i = 0; i < program->program->uniforms; i++)
        if (!strcmp(program->program->uniform[i].name, name))
            write_element(program, program->program->uniform + i, element, values);
}

void gl_uniforms_set_range(struct gl_program *program, const GLfloat range[2])
{
    static const char *const names[] = {"gl_DepthRange.near", "gl_DepthRange.far", "gl_DepthRange.diff"};
    const float values[] = {range[0], range[1], range[1] - range[0]};
    for (unsigned i = 0; i < program->program->uniforms; i++)
        for (unsigned k = 0; k < 3 && program->program->uniform[i].builtin; k++)
            if (!strcmp(program->program->uniform[i].name, names[k]))
                write_element(program, program->program->uniform + i, 0, values + k);
}

/* Values of a glUniform command. */
struct values {
    GLsizei count;
    unsigned rows, columns;
    const GLint *integers;
    const GLfloat *floats; /* one of both */
};

static bool check_type(struct gl_context *context, const struct glsl_uniform *uniform,
                       const struct values *values)
{
    const struct glsl_type *type = &uniform->type;
    bool fits = type->base == GLSL_FLOAT  ? values->floats != NULL
                : type->base == GLSL_BOOL ? true
                                          : values->integers != NULL;
    if (!fits || type->rows != values->rows || type->columns != values->columns)
        gl_error(context, GL_INVALID_OPERATION, "found %u x %u %s for the uniform %s of type %s",
                 values->columns, values->rows, values->floats ? "floats" : "integers", uniform->name,
                 gl_constant_name(gl_code_type(*type)));
    else if (values->count > 1 && !type->array)
        gl_error(context, GL_INVALID_OPERATION, "found %d values for %s, which is not an array",
                 values->count, uniform->name);
    else
        return true;
    return false;
}

static bool check_units(struct gl_context *context, const struct values *values)
{
    for (GLsizei i = 0; i < values->count; i++)
        if (values->integers[i] < 0 || values->integers[i] >= GL_UNITS) {
            gl_error(context, GL_INVALID_VALUE, "found texture unit %d, expected 0 to %d",
                     values->integers[i], GL_UNITS - 1);
            return false;
        }
    return true;
}

static void set_unit(struct gl_program *program, const struct glsl_uniform *uniform, unsigned element,
                     GLint unit)
{
    for (unsigned s = 0; s < GLSL_STAGES; s++)
        if (uniform->stage[s].first >= 0 && element < uniform->stage[s].elements)
            program->unit[s][(unsigned)uniform->stage[s].first + element] = (uint8_t)unit;
}

static void set_element(struct gl_program *program, const struct glsl_uniform *uniform, unsigned element,
                        const struct values *values, unsigned i)
{
    unsigned scalars = values->rows * values->columns;
    float numbers[16];
    for (unsigned k = 0; k < scalars; k++) {
        float number =
            values->floats ? values->floats[i * scalars + k] : (float)values->integers[i * scalars + k];
        numbers[k] = uniform->type.base == GLSL_BOOL ? (float)(number != 0) : number;
    }
    write_element(program, uniform, element, numbers);
}

static void set_values(struct gl_context *context, GLint location, const struct values *values)
{
    struct gl_program *program = context->program;
    if (!program) {
        gl_error(context, GL_INVALID_OPERATION, "found no program, expected a current one");
        return;
    }
    if (values->count < 0) {
        gl_error(context, GL_INVALID_VALUE, "found %d values, expected 0 or more", values->count);
        return;
    }
    if (location == -1)
        return;
    if (location < 0 || (unsigned)location >= program->locations) {
        gl_error(context, GL_INVALID_OPERATION, "found location %d, expected one of the program", location);
        return;
    }
    struct gl_location at = program->location[location];
    const struct glsl_uniform *uniform = program->program->uniform + at.uniform;
    bool sampler = glsl_is_sampler(uniform->type);
    if (!check_type(context, uniform, values) || (sampler && !check_units(context, values)))
        return;
    unsigned left = elements_of(uniform) - at.element;
    for (unsigned i = 0; i < left && i < (unsigned)values->count; i++)
        if (sampler)
            set_unit(program, uniform, at.element + i, values->integers[i]);
        else
            set_element(program, uniform, at.element + i, values, i);
    context->late |= sampler ? GL_LATE_TEXTURES : GL_LATE_PROGRAM;
}

#define SET(name, type, member, components, parameters, ...)                                                 \
    void gl_Uniform##name parameters                                                                         \
    {                                                                                                        \
        const type value[] = {__VA_ARGS__};                                                                  \
        set_values(context, location, &(struct values){1, components, 1, .member = value});                  \
    }
#define SET_ARRAY(name, type, member, components)                                                            \
    void gl_Uniform##name(struct gl_context *context, GLint location, GLsizei count, const type *value)      \
    {                                                                                                        \
        set_values(context, location, &(struct values){count, components, 1, .member = value});              \
    }
#define SET_MATRIX(side)                                                                                     \
    void gl_UniformMatrix##side##fv(struct gl_context *context, GLint location, GLsizei count,               \
                                    GLboolean transpose, const GLfloat *value)                               \
    {                                                                                                        \
        if (transpose)                                                                                       \
            gl_error(context, GL_INVALID_VALUE, "found a transposition, expected GL_FALSE");                 \
        else                                                                                                 \
            set_values(context, location, &(struct values){count, side, side, .floats = value});             \
    }
#define AT struct gl_context *context, GLint location

SET(1f, GLfloat, floats, 1, (AT, GLfloat x), x)
SET(2f, GLfloat, floats, 2, (AT, GLfloat x, GLfloat y), x, y)
SET(3f, GLfloat, floats, 3, (AT, GLfloat x, GLfloat y, GLfloat z), x, y, z)
SET(4f, GLfloat, floats, 4, (AT, GLfloat x, GLfloat y, GLfloat z, GLfloat w), x, y, z, w)
SET(1i, GLint, integers, 1, (AT, GLint x), x)
SET(2i, GLint, integers, 2, (AT, GLint x, GLint y), x, y)
SET(3i, GLint, integers, 3, (AT, GLint x, GLint y, GLint z), x, y, z)
SET(4i, GLint, integers, 4, (AT, GLint x, GLint y, GLint z, GLint w), x, y, z, w)
SET_ARRAY(1fv, GLfloat, floats, 1)
SET_ARRAY(2fv, GLfloat, floats, 2)
SET_ARRAY(3fv, GLfloat, floats, 3)
SET_ARRAY(4fv, GLfloat, floats, 4)
SET_ARRAY(1iv, GLint, integers, 1)
SET_ARRAY(2iv, GLint, integers, 2)
SET_ARRAY(3iv, GLint, integers, 3)
SET_ARRAY(4iv, GLint, integers, 4)
SET_MATRIX(2)
SET_MATRIX(3)
SET_MATRIX(4)

/* --- Reading --- */

/* Returns the number of values; 0 with an error. */
static unsigned read_values(struct gl_context *context, GLuint name, GLint location, float values[16])
{
    const struct gl_program *program = gl_program_find(context, name);
    if (!program)
        return 0;
    if (!program->linked || location < 0 || (unsigned)location >= program->locations) {
        gl_error(context, GL_INVALID_OPERATION, "found location %d, expected one of a linked program",
                 location);
        return 0;
    }
    struct gl_location at = program->location[location];
    const struct glsl_uniform *uniform = program->program->uniform + at.uniform;
    unsigned columns = uniform->type.columns, rows = uniform->type.rows, s = 0;
    memset(values, 0, 16 * sizeof *values);
    while (s < GLSL_STAGES && (uniform->stage[s].first < 0 || at.element >= uniform->stage[s].elements))
        s++;
    if (s < GLSL_STAGES && glsl_is_sampler(uniform->type))
        values[0] = program->unit[s][(unsigned)uniform->stage[s].first + at.element];
    for (unsigned k = 0; s < GLSL_STAGES && k < columns && !glsl_is_sampler(uniform->type); k++)
        memcpy(values + k * rows,
               program->constants[s].value[(unsigned)uniform->stage[s].first + at.element * columns + k] +
                   uniform->stage[s].component,
               rows * sizeof *values);
    return rows * columns;
}

/* The same; 0, with an error, if `bytes` bytes have no room for them. */
static unsigned read_some(struct gl_context *context, GLuint name, GLint location, GLsizei bytes,
                          float values[16])
{
    unsigned count = read_values(context, name, location, values);
    if (bytes >= 0 && (size_t)bytes >= count * sizeof *values)
        return count;
    gl_error(context, GL_INVALID_OPERATION, "found memory of %d bytes, expected %zu", bytes,
             count * sizeof *values);
    return 0;
}

/* EXT_robustness */
void gl_GetnUniformfvEXT(struct gl_context *context, GLuint name, GLint location, GLsizei bytes, GLfloat *out)
{
    float values[16];
    unsigned count = read_some(context, name, location, bytes, values);
    memcpy(out, values, count * sizeof *out);
}

void gl_GetnUniformivEXT(struct gl_context *context, GLuint name, GLint location, GLsizei bytes, GLint *out)
{
    float values[16];
    unsigned count = read_some(context, name, location, bytes, values);
    for (unsigned i = 0; i < count; i++)
        out[i] = gl_round(values[i]);
}

void gl_GetUniformfv(struct gl_context *context, GLuint name, GLint location, GLfloat *out)
{
    gl_GetnUniformfvEXT(context, name, location, INT32_MAX, out);
}

void gl_GetUniformiv(struct gl_context *context, GLuint name, GLint location, GLint *out)
{
    gl_GetnUniformivEXT(context, name, location, INT32_MAX, out);
}
