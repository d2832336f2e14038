/* EGL and GLES2 of a folder, or the system's: which of them is decided when the process runs, so nothing
 * is linked. */
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

/* Loads the libraries of `folder`, ANGLE's, or with null the system's, and makes a context with a surface
 * of that side and RGBA8 + depth 24 current. Returns a reason, or null. */
const char *gles_start(const char *folder, int side);

#endif
