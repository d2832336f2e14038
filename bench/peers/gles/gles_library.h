/* EGL and GLES2 from a folder or from the system. The process loads them at run time, so they are not
 * linked. */
#ifndef BENCH_PEERS_GLES_LIBRARY_H
#define BENCH_PEERS_GLES_LIBRARY_H

#define EGL_EGLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES2/gl2.h>

struct gles {
#define EGL_FUNCTION(name) __typeof__(egl##name) *egl##name;
#define GL_FUNCTION(name)  __typeof__(gl##name) *name;
#include "gles_function.def"
#undef EGL_FUNCTION
#undef GL_FUNCTION
};

extern struct gles gl;

/* Loads ANGLE's libraries from `folder`, or the system's if it is null. Makes a context current, with a
 * surface of side x side pixels, RGBA8 and 24 bits of depth. Returns null, or a reason. */
const char *gles_start(const char *folder, int side);

#endif
