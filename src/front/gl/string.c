/* glGetString, hints, and what only reports. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/state.h"

/* Each is complete by its specification. */
static const char extensions[] =
#define GL_EXTENSION(name) "GL_" #name " "
#include "front/gl/extension.def"
#undef GL_EXTENSION
    ;

const GLubyte *gl_GetString(struct gl_context *context, GLenum name)
{
    const char *text = NULL;
    switch (name) {
    case GL_VENDOR: text = "Triptych"; break;
    case GL_RENDERER: text = triptych_get_engine(context->renderer); break;
    case GL_VERSION: text = "OpenGL ES 2.0 Triptych " TRIPTYCH_VERSION; break;
    case GL_SHADING_LANGUAGE_VERSION: text = "OpenGL ES GLSL ES 1.00 Triptych " TRIPTYCH_VERSION; break;
    case GL_EXTENSIONS: text = extensions; break;
    default: gl_error(context, GL_INVALID_ENUM, "found %s, expected a string", gl_constant_name(name));
    }
    return (const GLubyte *)text;
}

void gl_Hint(struct gl_context *context, GLenum target, GLenum mode)
{
    GLenum *place = target == GL_GENERATE_MIPMAP_HINT                  ? context->values.mipmap_hint
                    : target == GL_FRAGMENT_SHADER_DERIVATIVE_HINT_OES ? context->values.derivative_hint
                                                                       : NULL;
    if (!place || (mode != GL_FASTEST && mode != GL_NICEST && mode != GL_DONT_CARE))
        gl_error(context, GL_INVALID_ENUM, "found the hint %s for %s", gl_constant_name(mode),
                 gl_constant_name(target));
    else
        *place = mode;
}

static bool is_alignment(GLint value)
{
    return value == 1 || value == 2 || value == 4 || value == 8;
}

void gl_PixelStorei(struct gl_context *context, GLenum name, GLint value)
{
    GLint *place = name == GL_UNPACK_ALIGNMENT ? context->values.unpack_alignment
                   : name == GL_PACK_ALIGNMENT ? context->values.pack_alignment
                                               : NULL;
    if (!place)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected an alignment", gl_constant_name(name));
    else if (!is_alignment(value))
        gl_error(context, GL_INVALID_VALUE, "found %d, expected an alignment of 1, 2, 4 or 8", value);
    else
        *place = value;
}

void gl_Finish(struct gl_context *context)
{
    gl_renderer_did(context, triptych_finish(context->renderer));
}

void gl_Flush(struct gl_context *context)
{
    gl_renderer_did(context, triptych_flush(context->renderer));
}
