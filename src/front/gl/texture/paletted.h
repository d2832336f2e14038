/* Paletted images: OES_compressed_paletted_texture. They are texels of an ordinary format once loaded. */
#ifndef FRONT_GL_TEXTURE_PALETTED_H
#define FRONT_GL_TEXTURE_PALETTED_H

#include "front/gl/gl.h"

enum { GL_PALETTED_FORMATS = 10 };

/* Returns true if the format is one of the ten. */
bool gl_paletted_has(GLenum format);
/* glCompressedTexImage2D of such a format: defines the levels from 0 to -level. */
void gl_paletted_image(struct gl_context *, GLenum target, GLint level, GLenum format, GLsizei width,
                       GLsizei height, GLint border, GLsizei bytes, const void *data);

#endif
