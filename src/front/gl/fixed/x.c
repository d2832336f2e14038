/* Commands of fixed-point numbers: each calls that of floats. */
#include "front/gl/commands.h"
#include "front/gl/fixed.h"

#include <math.h>

static GLfloat number_of(GLfixed x)
{
    return (GLfloat)x / 65536;
}

static void numbers_of(GLfloat *to, const GLfixed *from, unsigned count, bool enumeration)
{
    for (unsigned i = 0; i < count; i++)
        to[i] = enumeration ? (GLfloat)from[i] : number_of(from[i]);
}

/* Numbers that a query with an error has left are NaN. */
static void fixed_of(GLfixed *to, const GLfloat *from, unsigned count, bool enumeration)
{
    for (unsigned i = 0; i < count && !isnan(from[i]); i++)
        to[i] = gl_round(enumeration ? from[i] : from[i] * 65536);
}

/* An unknown name has one number; the command reports it. */
static unsigned count_of(GLenum name, unsigned groups, bool *enumeration)
{
    unsigned count = gl_parameter_count(name, groups, enumeration);
    return count ? count : 1;
}

#define X(x)           number_of(x)
#define OPEN(...)      __VA_ARGS__
#define CONTEXT(...)   (struct gl_context * context __VA_OPT__(, ) __VA_ARGS__)
#define ARGUMENTS(...) (context __VA_OPT__(, ) __VA_ARGS__)
#define PLUS(...)      __VA_OPT__(__VA_ARGS__, )

#define GL_X(name, float_name, parameters, arguments)                                                        \
    void gl_##name CONTEXT parameters                                                                        \
    {                                                                                                        \
        gl_##float_name ARGUMENTS arguments;                                                                 \
    }
#define GL_X_ARRAY(name, float_name, count, parameters, arguments)                                           \
    void gl_##name CONTEXT parameters                                                                        \
    {                                                                                                        \
        GLfloat numbers[count];                                                                              \
        numbers_of(numbers, from, count, false);                                                             \
        gl_##float_name(context, PLUS arguments numbers);                                                    \
    }
#define GL_X_SET(float_name, groups, parameters, arguments)                                                  \
    void gl_##float_name##x(struct gl_context *context, OPEN parameters, GLfixed value)                      \
    {                                                                                                        \
        bool enumeration = false;                                                                            \
        count_of(name, groups, &enumeration);                                                                \
        gl_##float_name##f(context, PLUS arguments enumeration ? (GLfloat)value : number_of(value));         \
    }                                                                                                        \
    void gl_##float_name##xv(struct gl_context *context, OPEN parameters, const GLfixed *values)             \
    {                                                                                                        \
        GLfloat numbers[4];                                                                                  \
        bool enumeration = false;                                                                            \
        unsigned count = count_of(name, groups, &enumeration);                                               \
        numbers_of(numbers, values, count, enumeration);                                                     \
        gl_##float_name##fv(context, PLUS arguments numbers);                                                \
    }
#define GL_X_GET(fixed_name, float_name, groups, parameters, arguments)                                      \
    void gl_##fixed_name(struct gl_context *context, OPEN parameters, GLfixed *out)                          \
    {                                                                                                        \
        GLfloat numbers[4] = {NAN, NAN, NAN, NAN};                                                           \
        bool enumeration = false;                                                                            \
        unsigned count = count_of(name, groups, &enumeration);                                               \
        gl_##float_name(context, PLUS arguments numbers);                                                    \
        fixed_of(out, numbers, count, enumeration);                                                          \
    }
#include "front/gl/fixed/x.def"

void gl_GetClipPlanex(struct gl_context *context, GLenum plane, GLfixed *out)
{
    GLfloat numbers[4] = {NAN, NAN, NAN, NAN};
    gl_GetClipPlanef(context, plane, numbers);
    fixed_of(out, numbers, 4, false);
}
