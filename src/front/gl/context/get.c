/* glGet...: chapter 6.1. */
#include "front/gl/draw/buffer.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/debug.h"
#include "front/gl/fixed.h"
#include "front/gl/texture/read.h"
#include "front/gl/state.h"
#include "front/gl/texture/paletted.h"
#include "front/gl/texture/texture.h"
#include "front/gl/draw/vertex_array.h"

#include <string.h>

/* --- Values that are computed --- */

static unsigned name_of(const void *object)
{
    return object ? ((const struct gl_object *)object)->name : 0;
}

#define NAME(function, object)                                                                               \
    static unsigned get_##function(struct gl_context *context, int32_t *out)                                 \
    {                                                                                                        \
        *out = (int32_t)name_of(object);                                                                     \
        return 1;                                                                                            \
    }
NAME(current_program, context->program)
NAME(array_buffer, context->array_buffer)
NAME(element_buffer, context->vertex_array->elements)
NAME(vertex_array, context->vertex_array)
NAME(framebuffer, context->framebuffer)
NAME(renderbuffer, context->renderbuffer)
NAME(texture_2d, context->texture[gl_state_unit(context)][GL_DIMENSION_2D])
NAME(texture_cube, context->texture[gl_state_unit(context)][GL_DIMENSION_CUBE])

/* Paletted formats are those of version 1.1. */
static unsigned get_compressed_formats(struct gl_context *context, int32_t *out)
{
    static const GLenum blocks[] = {GL_ETC1_RGB8_OES, GL_COMPRESSED_RGB_S3TC_DXT1_EXT,
                                    GL_COMPRESSED_RGBA_S3TC_DXT1_EXT};
    unsigned count = 0;
    while (count < sizeof blocks / sizeof *blocks)
        out[count] = (int32_t)blocks[count], count++;
    for (unsigned i = 0; i < GL_PALETTED_FORMATS && context->fixed; i++)
        out[count++] = (int32_t)(GL_PALETTE4_RGB8_OES + i);
    return count;
}

static unsigned get_clip_planes(struct gl_context *context, int32_t *out)
{
    *out = context->fixed ? GL_FIXED_PLANES : 0;
    return 1;
}

static unsigned get_compressed_count(struct gl_context *context, int32_t *out)
{
    int32_t formats[16];
    *out = (int32_t)get_compressed_formats(context, formats);
    return 1;
}

/* Of an incomplete framebuffer, the images so far. */
#define TARGET(function, value)                                                                              \
    static unsigned get_##function(struct gl_context *context, int32_t *out)                                 \
    {                                                                                                        \
        struct gl_target target;                                                                             \
        gl_framebuffer_target(context, false, &target);                                                      \
        *out = (int32_t)(value);                                                                             \
        return 1;                                                                                            \
    }
TARGET(red_bits, target.red)
TARGET(green_bits, target.green)
TARGET(blue_bits, target.blue)
TARGET(alpha_bits, target.alpha)
TARGET(depth_bits, target.depth_bits)
TARGET(stencil_bits, target.stencil_bits)
TARGET(samples, target.samples > 1 ? target.samples : 0)
TARGET(sample_buffers, target.samples > 1)

#define DRAW_BUFFER(i)                                                                                       \
    static unsigned get_draw_buffer##i(struct gl_context *context, int32_t *out)                             \
    {                                                                                                        \
        const struct gl_framebuffer *framebuffer = context->framebuffer;                                     \
        *out = (int32_t)(framebuffer ? framebuffer->draw[i] : (i) ? GL_NONE : context->back_buffer);         \
        return 1;                                                                                            \
    }
DRAW_BUFFER(0)
DRAW_BUFFER(1)
DRAW_BUFFER(2)
DRAW_BUFFER(3)

static unsigned get_preferred(struct gl_context *context, int32_t *out, bool type)
{
    struct gl_target target;
    GLenum values[2];
    if (!gl_framebuffer_check(context, true, &target))
        return 0;
    gl_read_preferred(&target, &values[0], &values[1]);
    *out = (int32_t)values[type];
    return 1;
}

static unsigned get_read_format(struct gl_context *context, int32_t *out)
{
    return get_preferred(context, out, false);
}

static unsigned get_read_type(struct gl_context *context, int32_t *out)
{
    return get_preferred(context, out, true);
}

static unsigned get_robust(struct gl_context *context, int32_t *out)
{
    *out = context->options.robust;
    return 1;
}

static unsigned get_reset_strategy(struct gl_context *context, int32_t *out)
{
    *out = context->options.loses_on_reset ? GL_LOSE_CONTEXT_ON_RESET_EXT : GL_NO_RESET_NOTIFICATION_EXT;
    return 1;
}

#define DEBUG(function)                                                                                      \
    static unsigned get_##function(struct gl_context *context, int32_t *out)                                 \
    {                                                                                                        \
        *out = gl_debug_##function(context);                                                                 \
        return 1;                                                                                            \
    }
DEBUG(logged)
DEBUG(next_length)
DEBUG(depth)

/* --- Values --- */

enum type { BOOLEAN, ENUM, INTEGER, MASK, FLOAT, UNIT };
enum { MOST = 16 };

/* A value with its type: numbers for FLOAT and UNIT, otherwise integers. */
struct value {
    enum type type;
    unsigned count;
    int32_t integer[MOST];
    float number[MOST];
};

static void take_field(struct value *value, enum type type, unsigned count, const void *field)
{
    value->type = type;
    value->count = count;
    if (type == FLOAT || type == UNIT)
        memcpy(value->number, field, count * sizeof *value->number);
    else if (type != BOOLEAN)
        memcpy(value->integer, field, count * sizeof *value->integer);
    for (unsigned i = 0; i < count && type == BOOLEAN; i++)
        value->integer[i] = ((const GLboolean *)field)[i] != 0;
}

static void take_limit(struct value *value, enum type type, unsigned count, const double *limit)
{
    value->type = type;
    value->count = count;
    for (unsigned i = 0; i < count; i++) {
        value->number[i] = (float)limit[i];
        value->integer[i] = (int32_t)limit[i];
    }
}

/* Values of version 1.1, which are numbers in memory. */
static void take_fixed(struct value *value, enum type type, unsigned count, const GLfloat *field)
{
    value->type = type;
    value->count = count;
    for (unsigned i = 0; i < count; i++) {
        value->number[i] = field[i];
        value->integer[i] = type == FLOAT || type == UNIT ? 0 : (int32_t)field[i];
    }
}

static bool find_fixed(struct gl_context *context, GLenum name, struct value *value)
{
    const struct gl_fixed *fixed = context->fixed;
    GLfloat numbers[MOST];
    bool number, unit;
    switch (name) {
#define GL_NUMBER(name, field, type, count, ...)                                                             \
    case GL_##name:                                                                                          \
        take_fixed(value, type, count, fixed->field);                                                        \
        return true;
#define GL_CAPABILITY(name, field, late, initial)                                                            \
    case GL_##name:                                                                                          \
        take_field(value, BOOLEAN, 1, context->values.field);                                                \
        return true;
#define GL_LIMIT(name, type, count, ...)                                                                     \
    case GL_##name:                                                                                          \
        take_limit(value, type, count, (const double[]){__VA_ARGS__});                                       \
        return true;
#include "front/gl/fixed.def"
    default: break;
    }
    unsigned count = gl_fixed_get(context, name, numbers, &number, &unit);
    take_fixed(value, unit ? UNIT : number ? FLOAT : INTEGER, count, numbers);
    return count;
}

static bool find_value(struct gl_context *context, GLenum name, struct value *value)
{
    struct gl_values *values = &context->values;
    *value = (struct value){.type = INTEGER};
    switch (name) {
#define GL_VALUE(name, field, type, count, late, ...)                                                        \
    case GL_##name:                                                                                          \
        take_field(value, type, count, values->field);                                                       \
        return true;
#define GL_CAPABILITY(name, field, late, initial)                                                            \
    case GL_##name:                                                                                          \
        take_field(value, BOOLEAN, 1, values->field);                                                        \
        return true;
#define GL_LIMIT(name, type, count, ...)                                                                     \
    case GL_##name:                                                                                          \
        take_limit(value, type, count, (const double[]){__VA_ARGS__});                                       \
        return true;
#define GL_COMPUTED(name, type, function)                                                                    \
    case GL_##name:                                                                                          \
        value->count = get_##function(context, value->integer);                                              \
        return true;
#include "front/gl/state.def"
#undef GL_VALUE
#undef GL_CAPABILITY
#undef GL_LIMIT
#undef GL_COMPUTED
    default: break;
    }
    if (context->fixed && find_fixed(context, name, value))
        return true;
    gl_error(context, GL_INVALID_ENUM, "found %s, expected a value of glGet", gl_constant_name(name));
    return false;
}

static bool is_number(const struct value *value)
{
    return value->type == FLOAT || value->type == UNIT;
}

/* The range from -1 to 1 becomes that of integers. */
static GLint stretch(float number)
{
    double wide = (4294967295.0 * (double)number - 1) / 2;
    return wide >= INT32_MAX ? INT32_MAX : wide <= INT32_MIN ? INT32_MIN : (GLint)wide;
}

void gl_GetIntegerv(struct gl_context *context, GLenum name, GLint *out)
{
    struct value value;
    if (!find_value(context, name, &value))
        return;
    for (unsigned i = 0; i < value.count; i++)
        out[i] = value.type == UNIT    ? stretch(value.number[i])
                 : value.type == FLOAT ? gl_round(value.number[i])
                                       : value.integer[i];
}

void gl_GetFloatv(struct gl_context *context, GLenum name, GLfloat *out)
{
    struct value value;
    if (!find_value(context, name, &value))
        return;
    for (unsigned i = 0; i < value.count; i++)
        out[i] = is_number(&value)    ? value.number[i]
                 : value.type == MASK ? (GLfloat)(GLuint)value.integer[i]
                                      : (GLfloat)value.integer[i];
}

void gl_GetBooleanv(struct gl_context *context, GLenum name, GLboolean *out)
{
    struct value value;
    if (!find_value(context, name, &value))
        return;
    for (unsigned i = 0; i < value.count; i++)
        out[i] = is_number(&value) ? value.number[i] != 0 : value.integer[i] != 0;
}

void gl_GetFixedv(struct gl_context *context, GLenum name, GLfixed *out)
{
    struct value value;
    if (!find_value(context, name, &value))
        return;
    for (unsigned i = 0; i < value.count; i++)
        out[i] = gl_round((is_number(&value) ? value.number[i] : (GLfloat)value.integer[i]) * 65536);
}
