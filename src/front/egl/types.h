/* EGL's types and constants from Khronos' headers, without prototypes. */
#ifndef EGL_TYPES_H
#define EGL_TYPES_H

#define EGL_EGL_PROTOTYPES 0
#include <EGL/egl.h>
#include <EGL/eglext.h>

#endif
