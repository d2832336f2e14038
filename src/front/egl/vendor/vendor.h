/* The interface of libglvnd, which loads the library and passes the calls of a program on. */
#ifndef EGL_VENDOR_H
#define EGL_VENDOR_H

#include "front/egl/calls.h"

/* Return the function with a number, of the vendor of a display or a device; null, after an error, if it has
 * none. */
egl_function *egl_vendor_function(EGLDisplay dpy, int number);
egl_function *egl_vendor_device_function(EGLDeviceEXT device, int number);
/* Remembers the number of an extension's function. */
void egl_dispatch_number(const char *name, int number);

#endif
