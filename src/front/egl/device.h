/* The one device of EGL_EXT_device_base: the processor. */
#ifndef EGL_DEVICE_H
#define EGL_DEVICE_H

#include "types.h"

#include <stdbool.h>

bool egl_device_is(const void *handle);

#endif
