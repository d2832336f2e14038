/* Pixels of framebuffers in memory. */
#ifndef FRONT_GL_TEXTURE_READ_H
#define FRONT_GL_TEXTURE_READ_H

#include "front/gl/texture/framebuffer.h"

/* A rectangle of a framebuffer, which may lie outside of it in part or as a whole. */
struct gl_area {
    GLint x, y;
    GLsizei width, height;
};

/* Reads the pixels of the area that exist, in a format of the renderer with `bytes` bytes a pixel. `out` is
 * that of the area's first pixel; the others are not written. Returns false if the renderer refuses. */
bool gl_read_area(struct gl_context *, const struct gl_target *, const struct gl_area *,
                  enum triptych_surface_format, unsigned bytes, void *out, size_t pitch);
/* The format and type that glReadPixels accepts besides GL_RGBA and GL_UNSIGNED_BYTE. */
void gl_read_preferred(const struct gl_target *, GLenum *format, GLenum *type);

#endif
