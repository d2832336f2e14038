/* Errors: glGetError. */
#include "front/gl/commands.h"
#include "front/gl/debug.h"
#include "front/gl/state.h"

#include <stdarg.h>
#include <stdio.h>

void gl_error(struct gl_context *context, GLenum code, const char *format, ...)
{
    char text[GL_DEBUG_TEXT];
    va_list arguments;
    if (context->error == GL_NO_ERROR)
        context->error = code;
    if (!gl_debug_wants(context, GL_DEBUG_TYPE_ERROR_KHR))
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    gl_debug_message(context, GL_DEBUG_TYPE_ERROR_KHR, code, GL_DEBUG_SEVERITY_HIGH_KHR, text);
}

bool gl_renderer_did(struct gl_context *context, enum triptych_result result)
{
    if (result != TRIPTYCH_OK)
        gl_error(context, GL_OUT_OF_MEMORY, "the renderer: %s", triptych_error(context->renderer));
    return result == TRIPTYCH_OK;
}

GLenum gl_GetError(struct gl_context *context)
{
    GLenum error = context->error;
    context->error = GL_NO_ERROR;
    return error;
}
