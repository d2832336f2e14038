/* glGetString, hints, and what only reports. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/fixed.h"
#include "front/gl/state.h"

/* Each is complete by its specification. */
#define IN_GL_ES1(name)
#define IN_GL_ES2(name)                "GL_" #name " "
#define IN_BOTH(name)                  "GL_" #name " "
#define GL_EXTENSION(interfaces, name) IN_##interfaces(name)
static const char extensions[] =
#include "front/gl/extension.def"
    ;
#undef IN_GL_ES1
#undef IN_GL_ES2
#define IN_GL_ES1(name) "GL_" #name " "
#define IN_GL_ES2(name)
static const char extensions_1[] =
#include "front/gl/extension.def"
    ;

const GLubyte *gl_GetString(struct gl_context *context, GLenum name)
{
    const char *text = NULL;
    bool first = context->fixed;
    switch (name) {
    case GL_VENDOR: text = "Triptych"; break;
    case GL_RENDERER: text = triptych_get_engine(context->renderer); break;
    case GL_VERSION: text = first ? "OpenGL ES-CM 1.1" : "OpenGL ES 2.0 Triptych " TRIPTYCH_VERSION; break;
    case GL_SHADING_LANGUAGE_VERSION:
        text = first ? NULL : "OpenGL ES GLSL ES 1.00 Triptych " TRIPTYCH_VERSION;
        break;
    case GL_EXTENSIONS: text = first ? extensions_1 : extensions; break;
    default: break;
    }
    if (!text)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a string", gl_constant_name(name));
    return (const GLubyte *)text;
}

void gl_Hint(struct gl_context *context, GLenum target, GLenum mode)
{
    GLenum *place = target == GL_GENERATE_MIPMAP_HINT                  ? context->values.mipmap_hint
                    : target == GL_FRAGMENT_SHADER_DERIVATIVE_HINT_OES ? context->values.derivative_hint
                                                                       : NULL;
    GLfloat *number = context->fixed ? gl_fixed_hint(context, target) : NULL;
    if ((!place && !number) || (mode != GL_FASTEST && mode != GL_NICEST && mode != GL_DONT_CARE))
        gl_error(context, GL_INVALID_ENUM, "found the hint %s for %s", gl_constant_name(mode),
                 gl_constant_name(target));
    else if (number)
        *number = (GLfloat)mode;
    else
        *place = mode;
}

static bool is_alignment(GLint value)
{
    return value == 1 || value == 2 || value == 4 || value == 8;
}

/* The value of a name; null if there is none. Numbers of rows and texels are those of EXT_unpack_subimage. */
static GLint *pixel_value(struct gl_context *context, GLenum name, bool *alignment)
{
    struct gl_values *values = &context->values;
    *alignment = name == GL_UNPACK_ALIGNMENT || name == GL_PACK_ALIGNMENT;
    if (!*alignment && context->fixed)
        return NULL;
    switch (name) {
    case GL_UNPACK_ALIGNMENT: return values->unpack_alignment;
    case GL_PACK_ALIGNMENT: return values->pack_alignment;
    case GL_UNPACK_ROW_LENGTH_EXT: return values->unpack_row_length;
    case GL_UNPACK_SKIP_ROWS_EXT: return values->unpack_skip_rows;
    case GL_UNPACK_SKIP_PIXELS_EXT: return values->unpack_skip_pixels;
    default: return NULL;
    }
}

void gl_PixelStorei(struct gl_context *context, GLenum name, GLint value)
{
    bool alignment;
    GLint *place = pixel_value(context, name, &alignment);
    if (!place)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a value of glPixelStorei",
                 gl_constant_name(name));
    else if (alignment && !is_alignment(value))
        gl_error(context, GL_INVALID_VALUE, "found %d, expected an alignment of 1, 2, 4 or 8", value);
    else if (value < 0)
        gl_error(context, GL_INVALID_VALUE, "found %d, expected 0 or more", value);
    else
        *place = value;
}

/* EXT_robustness: the renderer is never reset. */
GLenum gl_GetGraphicsResetStatusEXT(struct gl_context *context)
{
    (void)context;
    return GL_NO_ERROR;
}

void gl_Finish(struct gl_context *context)
{
    gl_renderer_did(context, triptych_finish(context->renderer));
}

void gl_Flush(struct gl_context *context)
{
    gl_renderer_did(context, triptych_flush(context->renderer));
}
