/* Rectangles and textures of OpenGL ES 1.1. The target has 16 x 8 pixels; a rectangle is in clip space if no
 * matrix is set. */
#ifndef TESTS_FRONT_GL_FIXED_SCREEN_H
#define TESTS_FRONT_GL_FIXED_SCREEN_H

#include "tests/support/front/gl/screen.h"

static struct screen screen;

#define gl screen.context

static inline void rectangle(GLfloat left, GLfloat bottom, GLfloat right, GLfloat top, GLfloat z)
{
    const GLfloat corners[][3] = {{left, bottom, z}, {right, bottom, z}, {left, top, z}, {right, top, z}};
    gl_EnableClientState(gl, GL_VERTEX_ARRAY);
    gl_VertexPointer(gl, 3, GL_FLOAT, 0, corners);
    gl_DrawArrays(gl, GL_TRIANGLE_STRIP, 0, 4);
}

/* The pixel of a rectangle over the whole target. */
static inline uint32_t drawn(void)
{
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    rectangle(-1, -1, 1, 1, 0);
    return screen_pixel(&screen, 5, 3);
}

static inline void make_texture(GLenum unit, GLenum format, const uint8_t *texel)
{
    GLuint name;
    gl_ActiveTexture(gl, unit);
    gl_GenTextures(gl, 1, &name);
    gl_BindTexture(gl, GL_TEXTURE_2D, name);
    gl_TexParameterx(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, (GLint)format, 1, 1, 0, format, GL_UNSIGNED_BYTE, texel);
    gl_Enable(gl, GL_TEXTURE_2D);
}

#endif
