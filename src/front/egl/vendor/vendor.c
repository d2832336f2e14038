#include "vendor.h"

#include <glvnd/libeglabi.h>
#include <stddef.h>

static const __EGLapiExports *exports;

static egl_function *function_of(__EGLvendorInfo *vendor, int number, EGLint error)
{
    if (!vendor) {
        exports->setEGLError(error);
        return NULL;
    }
    exports->setLastVendor(vendor);
    return (egl_function *)exports->fetchDispatchEntry(vendor, number);
}

egl_function *egl_vendor_function(EGLDisplay dpy, int number)
{
    exports->threadInit();
    return function_of(exports->getVendorFromDisplay(dpy), number, EGL_BAD_DISPLAY);
}

egl_function *egl_vendor_device_function(EGLDeviceEXT device, int number)
{
    exports->threadInit();
    return function_of(exports->getVendorFromDevice(device), number, EGL_BAD_DEVICE_EXT);
}

static EGLBoolean supports(EGLenum api)
{
    return api == EGL_OPENGL_ES_API;
}

static const char *vendor_string(int name)
{
    return name == __EGL_VENDOR_STRING_PLATFORM_EXTENSIONS
               ? "EGL_EXT_platform_device EGL_EXT_platform_x11 EGL_EXT_platform_xcb EGL_KHR_platform_x11 "
                 "EGL_MESA_platform_surfaceless"
               : NULL;
}

static void *find(const char *name)
{
    return (void *)egl_function_find(name);
}

static void *find_dispatch(const char *name)
{
    return (void *)egl_dispatch_find(name);
}

/* The only name that the library exports. */
__attribute__((visibility("default"))) EGLBoolean __egl_Main(uint32_t version, const __EGLapiExports *from,
                                                             __EGLvendorInfo *vendor, __EGLapiImports *to)
{
    (void)vendor;
    if (EGL_VENDOR_ABI_GET_MAJOR_VERSION(version) != EGL_VENDOR_ABI_MAJOR_VERSION)
        return EGL_FALSE;
    exports = from;
    to->getPlatformDisplay = egl_GetPlatformDisplay;
    to->getSupportsAPI = supports;
    to->getVendorString = vendor_string;
    to->getProcAddress = find;
    to->getDispatchAddress = find_dispatch;
    to->setDispatchIndex = egl_dispatch_number;
    return EGL_TRUE;
}
