/* Parameters of lights, materials, fog, points and texture environments: chapters 2.12, 3.3, 3.7.12, 3.8. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/fixed.h"
#include "front/gl/state.h"

#include <float.h>
#include <string.h>

#define BASE_LIGHT       struct gl_fixed_light
#define BASE_MATERIAL    struct gl_fixed_material
#define BASE_FOG         struct gl_fixed
#define BASE_LIGHT_MODEL struct gl_fixed
#define BASE_POINT       struct gl_fixed
#define BASE_SPRITE      struct gl_fixed_environment
#define BASE_ENVIRONMENT struct gl_fixed_environment
#define LEAST            (-FLT_MAX)
#define MOST             FLT_MAX

static const struct parameter {
    enum gl_group group;
    GLenum name;
    size_t offset;
    unsigned count;
    bool enumeration;
    float least, most;
} parameters[] = {
#define GL_PARAMETER(group, name, field, count, enumeration, least, most)                                    \
    {GL_GROUP_##group, GL_##name, offsetof(BASE_##group, field), count, enumeration, least, most},
#include "front/gl/fixed/parameter.def"
};

unsigned gl_parameter_count(GLenum name, unsigned groups, bool *enumeration)
{
    *enumeration = name != GL_TEXTURE_MAX_ANISOTROPY_EXT && name != GL_AMBIENT_AND_DIFFUSE;
    for (unsigned i = 0; i < sizeof parameters / sizeof *parameters; i++)
        if (parameters[i].name == name && parameters[i].group & groups) {
            *enumeration = parameters[i].enumeration;
            return parameters[i].count;
        }
    return name == GL_AMBIENT_AND_DIFFUSE && groups & GL_GROUP_MATERIAL ? 4 : 0;
}

/* `single`: the command has one number. */
static const struct parameter *find(struct gl_context *context, enum gl_group group, GLenum name, bool single)
{
    for (unsigned i = 0; i < sizeof parameters / sizeof *parameters; i++)
        if (parameters[i].group == group && parameters[i].name == name &&
            (!single || parameters[i].count == 1))
            return &parameters[i];
    gl_error(context, GL_INVALID_ENUM, "found %s, expected a parameter of the command",
             gl_constant_name(name));
    return NULL;
}

/* --- Checks --- */

static bool is_source(GLenum value)
{
    return value == GL_TEXTURE || value == GL_CONSTANT || value == GL_PRIMARY_COLOR || value == GL_PREVIOUS ||
           value - GL_TEXTURE0 < GL_FIXED_UNITS;
}

static bool is_function(GLenum value, bool alpha)
{
    return value == GL_REPLACE || value == GL_MODULATE || value == GL_ADD || value == GL_ADD_SIGNED ||
           value == GL_INTERPOLATE || value == GL_SUBTRACT ||
           (!alpha && (value == GL_DOT3_RGB || value == GL_DOT3_RGBA));
}

static bool is_enumeration(GLenum name, GLenum value)
{
    switch (name) {
    case GL_FOG_MODE: return value == GL_EXP || value == GL_EXP2 || value == GL_LINEAR;
    case GL_TEXTURE_ENV_MODE:
        return value == GL_MODULATE || value == GL_REPLACE || value == GL_DECAL || value == GL_BLEND ||
               value == GL_ADD || value == GL_COMBINE;
    case GL_COMBINE_RGB: return is_function(value, false);
    case GL_COMBINE_ALPHA: return is_function(value, true);
    case GL_SRC0_RGB:
    case GL_SRC1_RGB:
    case GL_SRC2_RGB:
    case GL_SRC0_ALPHA:
    case GL_SRC1_ALPHA:
    case GL_SRC2_ALPHA: return is_source(value);
    case GL_OPERAND0_RGB:
    case GL_OPERAND1_RGB:
    case GL_OPERAND2_RGB:
        if (value == GL_SRC_COLOR || value == GL_ONE_MINUS_SRC_COLOR)
            return true;
        /* fall through */
    case GL_OPERAND0_ALPHA:
    case GL_OPERAND1_ALPHA:
    case GL_OPERAND2_ALPHA: return value == GL_SRC_ALPHA || value == GL_ONE_MINUS_SRC_ALPHA;
    default: return true; /* a switch */
    }
}

static bool is_number(const struct parameter *parameter, GLfloat value)
{
    if (!(value >= parameter->least && value <= parameter->most))
        return false;
    if (parameter->name == GL_SPOT_CUTOFF)
        return value <= 90 || value == 180;
    bool scale = parameter->name == GL_RGB_SCALE || parameter->name == GL_ALPHA_SCALE;
    return !scale || value == 1 || value == 2 || value == 4;
}

static bool check(struct gl_context *context, const struct parameter *parameter, const GLfloat *values)
{
    bool small = values[0] >= 0 && values[0] < 65536;
    if (parameter->enumeration && !is_enumeration(parameter->name, small ? (GLenum)values[0] : 0))
        gl_error(context, GL_INVALID_ENUM, "found the value %g of %s", (double)values[0],
                 gl_constant_name(parameter->name));
    else if (parameter->count == 1 && !parameter->enumeration && !is_number(parameter, values[0]))
        gl_error(context, GL_INVALID_VALUE, "found the value %g of %s", (double)values[0],
                 gl_constant_name(parameter->name));
    else
        return true;
    return false;
}

/* --- Places --- */

static GLfloat *place_of(void *base, const struct parameter *parameter)
{
    return (GLfloat *)((char *)base + parameter->offset);
}

static void set(struct gl_context *context, enum gl_group group, void *base, GLenum name,
                const GLfloat *values, bool single)
{
    const struct parameter *parameter = find(context, group, name, single);
    if (!parameter || !check(context, parameter, values))
        return;
    GLfloat *place = place_of(base, parameter);
    bool clamped = name == GL_FOG_COLOR || name == GL_TEXTURE_ENV_COLOR;
    bool toggle = name == GL_LIGHT_MODEL_TWO_SIDE || name == GL_COORD_REPLACE_OES;
    for (unsigned i = 0; i < parameter->count; i++)
        place[i] = toggle ? values[i] != 0 : clamped ? gl_clamp(values[i]) : values[i];
    context->late |= GL_LATE_FIXED;
}

static void get(struct gl_context *context, enum gl_group group, void *base, GLenum name, GLfloat *out)
{
    const struct parameter *parameter = find(context, group, name, false);
    if (parameter)
        memcpy(out, place_of(base, parameter), parameter->count * sizeof *out);
}

/* --- Lights --- */

static struct gl_fixed_light *light_of(struct gl_context *context, GLenum light)
{
    if (light - GL_LIGHT0 < GL_FIXED_LIGHTS)
        return &context->fixed->light[light - GL_LIGHT0];
    gl_error(context, GL_INVALID_ENUM, "found %s, expected a light", gl_constant_name(light));
    return NULL;
}

/* Positions and directions are of the space of vertices. */
static void set_light(struct gl_context *context, GLenum name, GLenum parameter, const GLfloat *values,
                      bool single)
{
    struct gl_fixed_light *light = light_of(context, name);
    GLfloat moved[4];
    if (!light)
        return;
    if (parameter == GL_POSITION && !single) {
        gl_matrix_apply(gl_fixed_modelview(context->fixed), values, moved);
        values = moved;
    } else if (parameter == GL_SPOT_DIRECTION && !single) {
        const GLfloat direction[4] = {values[0], values[1], values[2], 0};
        gl_matrix_apply(gl_fixed_modelview(context->fixed), direction, moved);
        values = moved;
    }
    set(context, GL_GROUP_LIGHT, light, parameter, values, single);
}

void gl_Lightf(struct gl_context *context, GLenum light, GLenum name, GLfloat value)
{
    set_light(context, light, name, &value, true);
}

void gl_Lightfv(struct gl_context *context, GLenum light, GLenum name, const GLfloat *values)
{
    set_light(context, light, name, values, false);
}

void gl_GetLightfv(struct gl_context *context, GLenum name, GLenum parameter, GLfloat *out)
{
    struct gl_fixed_light *light = light_of(context, name);
    if (light)
        get(context, GL_GROUP_LIGHT, light, parameter, out);
}

void gl_LightModelf(struct gl_context *context, GLenum name, GLfloat value)
{
    set(context, GL_GROUP_LIGHT_MODEL, context->fixed, name, &value, true);
}

void gl_LightModelfv(struct gl_context *context, GLenum name, const GLfloat *values)
{
    set(context, GL_GROUP_LIGHT_MODEL, context->fixed, name, values, false);
}

/* --- Materials: those of both faces are the same --- */

static void set_material(struct gl_context *context, GLenum face, GLenum name, const GLfloat *values,
                         bool single)
{
    struct gl_fixed_material *material = &context->fixed->material;
    if (face != GL_FRONT_AND_BACK)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_FRONT_AND_BACK", gl_constant_name(face));
    else if (name != GL_AMBIENT_AND_DIFFUSE || single)
        set(context, GL_GROUP_MATERIAL, material, name, values, single);
    else {
        set(context, GL_GROUP_MATERIAL, material, GL_AMBIENT, values, false);
        set(context, GL_GROUP_MATERIAL, material, GL_DIFFUSE, values, false);
    }
}

void gl_Materialf(struct gl_context *context, GLenum face, GLenum name, GLfloat value)
{
    set_material(context, face, name, &value, true);
}

void gl_Materialfv(struct gl_context *context, GLenum face, GLenum name, const GLfloat *values)
{
    set_material(context, face, name, values, false);
}

void gl_GetMaterialfv(struct gl_context *context, GLenum face, GLenum name, GLfloat *out)
{
    if (face == GL_FRONT || face == GL_BACK)
        get(context, GL_GROUP_MATERIAL, &context->fixed->material, name, out);
    else
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_FRONT or GL_BACK", gl_constant_name(face));
}

/* --- Fog and points --- */

void gl_Fogf(struct gl_context *context, GLenum name, GLfloat value)
{
    set(context, GL_GROUP_FOG, context->fixed, name, &value, true);
}

void gl_Fogfv(struct gl_context *context, GLenum name, const GLfloat *values)
{
    set(context, GL_GROUP_FOG, context->fixed, name, values, false);
}

void gl_PointParameterf(struct gl_context *context, GLenum name, GLfloat value)
{
    set(context, GL_GROUP_POINT, context->fixed, name, &value, true);
}

void gl_PointParameterfv(struct gl_context *context, GLenum name, const GLfloat *values)
{
    set(context, GL_GROUP_POINT, context->fixed, name, values, false);
}

void gl_PointSize(struct gl_context *context, GLfloat size)
{
    if (!(size > 0)) {
        gl_error(context, GL_INVALID_VALUE, "found a size of %g, expected more than 0", (double)size);
        return;
    }
    context->fixed->point_size[0] = size;
    context->late |= GL_LATE_FIXED;
}

/* --- Texture environments --- */

static bool find_environment(struct gl_context *context, GLenum target, enum gl_group *group)
{
    *group = target == GL_POINT_SPRITE_OES ? GL_GROUP_SPRITE : GL_GROUP_ENVIRONMENT;
    if (target != GL_TEXTURE_ENV && target != GL_POINT_SPRITE_OES)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_TEXTURE_ENV or GL_POINT_SPRITE_OES",
                 gl_constant_name(target));
    return target == GL_TEXTURE_ENV || target == GL_POINT_SPRITE_OES;
}

static struct gl_fixed_environment *environment(struct gl_context *context)
{
    return &context->fixed->environment[gl_state_unit(context)];
}

void gl_TexEnvf(struct gl_context *context, GLenum target, GLenum name, GLfloat value)
{
    enum gl_group group;
    if (find_environment(context, target, &group))
        set(context, group, environment(context), name, &value, true);
}

void gl_TexEnvfv(struct gl_context *context, GLenum target, GLenum name, const GLfloat *values)
{
    enum gl_group group;
    if (find_environment(context, target, &group))
        set(context, group, environment(context), name, values, false);
}

void gl_TexEnvi(struct gl_context *context, GLenum target, GLenum name, GLint value)
{
    gl_TexEnvf(context, target, name, (GLfloat)value);
}

/* Integers of a colour are parts of their range. */
void gl_TexEnviv(struct gl_context *context, GLenum target, GLenum name, const GLint *values)
{
    GLfloat numbers[4];
    bool color = name == GL_TEXTURE_ENV_COLOR;
    for (unsigned i = 0; i < (color ? 4u : 1u); i++)
        numbers[i] = color ? (GLfloat)((2.0 * values[i] + 1) / 4294967295.0) : (GLfloat)values[i];
    gl_TexEnvfv(context, target, name, numbers);
}

void gl_GetTexEnvfv(struct gl_context *context, GLenum target, GLenum name, GLfloat *out)
{
    enum gl_group group;
    if (find_environment(context, target, &group))
        get(context, group, environment(context), name, out);
}

void gl_GetTexEnviv(struct gl_context *context, GLenum target, GLenum name, GLint *out)
{
    GLfloat numbers[4] = {-1};
    bool color = name == GL_TEXTURE_ENV_COLOR;
    gl_GetTexEnvfv(context, target, name, numbers);
    for (unsigned i = 0; numbers[0] >= 0 && i < (color ? 4u : 1u); i++)
        out[i] = color ? gl_round(numbers[i] * 2147483647.0F) : (GLint)numbers[i];
}
