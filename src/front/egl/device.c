#include "device.h"

#include "calls.h"
#include "display.h"
#include "thread.h"

static const char processor;

bool egl_device_is(const void *handle)
{
    return handle == &processor;
}

EGLBoolean egl_QueryDevicesEXT(EGLint size, EGLDeviceEXT *devices, EGLint *count)
{
    egl_succeed();
    if (!count || (devices && size <= 0))
        return egl_fail(EGL_BAD_PARAMETER);
    if (devices)
        devices[0] = (EGLDeviceEXT)&processor;
    *count = 1;
    return EGL_TRUE;
}

const char *egl_QueryDeviceStringEXT(EGLDeviceEXT device, EGLint name)
{
    egl_succeed();
    if (!egl_device_is(device))
        return egl_fail(EGL_BAD_DEVICE_EXT), NULL;
    return name == EGL_EXTENSIONS ? "EGL_MESA_device_software" : (egl_fail(EGL_BAD_PARAMETER), NULL);
}

EGLBoolean egl_QueryDeviceAttribEXT(EGLDeviceEXT device, EGLint name, EGLAttrib *value)
{
    egl_succeed();
    (void)name, (void)value;
    return egl_fail(egl_device_is(device) ? EGL_BAD_ATTRIBUTE : EGL_BAD_DEVICE_EXT);
}

EGLBoolean egl_QueryDisplayAttribEXT(EGLDisplay dpy, EGLint name, EGLAttrib *value)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    egl_display_leave(display);
    if (name != EGL_DEVICE_EXT)
        return egl_fail(EGL_BAD_ATTRIBUTE);
    if (!value)
        return egl_fail(EGL_BAD_PARAMETER);
    *value = (EGLAttrib)&processor;
    return EGL_TRUE;
}
