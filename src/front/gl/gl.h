/* OpenGL ES 2.0: what all files of the front end share.
 *
 * A command NAME is gl_NAME(struct gl_context *, ...), with Khronos' types. It runs while its device is
 * locked (device.h). Sources: "OpenGL ES Common Profile Specification", version 2.0.25; extensions are
 * those of the Khronos registry. Sections are named in comments as 3.7.1.
 *
 * Row 0 of every image is y = 0 of OpenGL. Only a presentation turns pictures. */
#ifndef FRONT_GL_GL_H
#define FRONT_GL_GL_H

#include "front/gl/types.h"
#include "triptych.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct gl_context;

enum {
    GL_ATTRIBUTES = 16,
    GL_UNITS = TRIPTYCH_SAMPLERS,       /* texture units: any sampler of either shader can use any of them */
    GL_SIDE = TRIPTYCH_TEXTURE_MAXIMUM, /* the largest side of textures, renderbuffers and viewports */
    GL_LEVELS = 14,                     /* of a texture of this side */
    GL_DRAWS = TRIPTYCH_TARGETS,        /* colours that a draw writes */
    GL_POINT_MOST = 1024,               /* the largest point, in pixels */
    GL_LINE_MOST = 64,                  /* the widest line */
    GL_ANISOTROPY = 16
};

/* Records an error, unless an earlier one was not fetched yet, and reports it as a message of KHR_debug. The
 * text contains what was found and what was expected. */
void gl_error(struct gl_context *, GLenum code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Records the error of a refused call of the renderer: GL_OUT_OF_MEMORY, since commands check their
 * arguments. Returns true if the call succeeded. */
bool gl_renderer_did(struct gl_context *, enum triptych_result);

static inline float gl_clamp(float x)
{
    return x > 0 ? x < 1 ? x : 1 : 0;
}

/* The nearest integer; of NaN, 0. */
static inline GLint gl_round(float x)
{
    return x != x                ? 0
           : x >= 2147483648.0F  ? INT32_MAX
           : x <= -2147483648.0F ? INT32_MIN
                                 : (GLint)(x < 0 ? (double)x - 0.5 : (double)x + 0.5);
}

#endif
