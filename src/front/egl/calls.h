/* The functions of EGL: those that implement them, and how a program finds them. */
#ifndef EGL_CALLS_H
#define EGL_CALLS_H

#include "types.h"

#define EGL_CALL(kind, result, name, maker, parameters, arguments, failure) result egl_##maker parameters;
#include "call.def"
#undef EGL_CALL

typedef void egl_function(void);

/* Returns a function of EGL or a command of OpenGL ES by its name; null if there is none. */
egl_function *egl_function_find(const char *name);
/* Returns the function that finds the vendor of a display and calls it, for an extension. */
egl_function *egl_dispatch_find(const char *name);

#endif
