#include "front/gl/state.h"

#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/fixed.h"

void gl_state_reset(struct gl_context *context)
{
    static const struct gl_values initial = {
#define GL_VALUE(name, field, type, count, late, ...) .field = {__VA_ARGS__},
#define GL_CAPABILITY(name, field, late, initial)     .field = {initial},
#define GL_LIMIT(name, type, count, ...)
#define GL_COMPUTED(name, type, function)
#include "front/gl/state.def"
#undef GL_VALUE
#undef GL_CAPABILITY
#undef GL_LIMIT
#undef GL_COMPUTED
#define GL_CAPABILITY(name, field, late, initial) .field = {initial},
#include "front/gl/fixed.def"
    };
    context->values = initial;
    context->back_buffer = GL_BACK;
    for (unsigned i = 0; i < GL_ATTRIBUTES; i++)
        context->current[i][3] = 1;
    context->current_changed = true;
    context->late = GL_LATE_ALL;
}

/* --- Switches --- */

struct capability {
    GLenum name;
    GLboolean *value;
    unsigned late;
};

static struct capability find_fixed(struct gl_context *context, GLenum name)
{
    struct gl_values *values = &context->values;
    switch (name) {
#define GL_CAPABILITY(name, field, late, initial)                                                            \
    case GL_##name:                                                                                          \
        return (struct capability){GL_##name, values->field, GL_LATE_##late};
#include "front/gl/fixed.def"
    default: return (struct capability){name, gl_fixed_switch(context, name), GL_LATE_FIXED};
    }
}

static struct capability find_capability(struct gl_context *context, GLenum name)
{
    struct gl_values *values = &context->values;
    switch (name) {
#define GL_VALUE(name, field, type, count, late, ...)
#define GL_CAPABILITY(name, field, late, initial)                                                            \
    case GL_##name:                                                                                          \
        return (struct capability){GL_##name, values->field, GL_LATE_##late};
#define GL_LIMIT(name, type, count, ...)
#define GL_COMPUTED(name, type, function)
#include "front/gl/state.def"
#undef GL_VALUE
#undef GL_CAPABILITY
#undef GL_LIMIT
#undef GL_COMPUTED
    default: break;
    }
    struct capability found = context->fixed ? find_fixed(context, name) : (struct capability){0};
    if (!found.value)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a capability", gl_constant_name(name));
    return found;
}

static void set_capability(struct gl_context *context, GLenum name, GLboolean value)
{
    struct capability found = find_capability(context, name);
    if (!found.value || *found.value == value)
        return;
    *found.value = value;
    context->late |= found.late;
}

void gl_Enable(struct gl_context *context, GLenum cap)
{
    set_capability(context, cap, GL_TRUE);
}

void gl_Disable(struct gl_context *context, GLenum cap)
{
    set_capability(context, cap, GL_FALSE);
}

GLboolean gl_IsEnabled(struct gl_context *context, GLenum cap)
{
    struct capability found = find_capability(context, cap);
    return found.value ? *found.value : GL_FALSE;
}
