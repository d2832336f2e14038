#include "gles_library.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

struct gles gl;

static char reason[512];

static void *load(const char *folder, const char *name)
{
    char path[1024];
    snprintf(path, sizeof path, "%s%s%s", folder ? folder : "", folder ? "/" : "", name);
    void *library = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    if (!library)
        snprintf(reason, sizeof reason, "%.500s", dlerror());
    return library;
}

/* The position of a function's address in `gl`. */
static const struct entry {
    const char *name;
    size_t at;
    bool is_egl;
} entries[] = {
#define EGL_FUNCTION(name) {"egl" #name, offsetof(struct gles, egl##name), true},
#define GL_FUNCTION(name)  {"gl" #name, offsetof(struct gles, name), false},
#include "gles_function.def"
#undef EGL_FUNCTION
#undef GL_FUNCTION
};

/* Returns true if the libraries have all functions; else `reason` names a missing one. */
static bool find_all(void *egl, void *gles)
{
    bool found_all = true;
    for (size_t i = 0; i < sizeof entries / sizeof *entries; i++) {
        const struct entry *entry = &entries[i];
        void *found = dlsym(entry->is_egl ? egl : gles, entry->name);
        if (!found)
            snprintf(reason, sizeof reason, "the library has no %s", entry->name);
        memcpy((char *)&gl + entry->at, &found, sizeof found);
        found_all = found_all && found;
    }
    return found_all;
}

/* Returns ANGLE's display for its Vulkan back end on SwiftShader, without a window system. */
static EGLDisplay angle_display(void)
{
    enum {
        PLATFORM_ANGLE = 0x3202,
        TYPE = 0x3203,
        DEVICE_TYPE = 0x3209,
        TYPE_VULKAN = 0x3450,
        DEVICE_SWIFTSHADER = 0x3487,
        NATIVE_PLATFORM = 0x348f,
        VULKAN_HEADLESS = 0x34a5
    };
    static const EGLint attributes[] = {
        TYPE, TYPE_VULKAN, DEVICE_TYPE, DEVICE_SWIFTSHADER, NATIVE_PLATFORM, VULKAN_HEADLESS, EGL_NONE};
    PFNEGLGETPLATFORMDISPLAYEXTPROC get =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)gl.eglGetProcAddress("eglGetPlatformDisplayEXT");
    return get ? get(PLATFORM_ANGLE, NULL, attributes) : EGL_NO_DISPLAY;
}

static const char *failed(const char *what)
{
    snprintf(reason, sizeof reason, "%s failed, EGL error 0x%x", what, (unsigned)gl.eglGetError());
    return reason;
}

static const char *make_current(EGLDisplay display, int side)
{
    static const EGLint wanted[] = {EGL_SURFACE_TYPE,
                                    EGL_PBUFFER_BIT,
                                    EGL_RENDERABLE_TYPE,
                                    EGL_OPENGL_ES2_BIT,
                                    EGL_RED_SIZE,
                                    8,
                                    EGL_GREEN_SIZE,
                                    8,
                                    EGL_BLUE_SIZE,
                                    8,
                                    EGL_ALPHA_SIZE,
                                    8,
                                    EGL_DEPTH_SIZE,
                                    24,
                                    EGL_NONE};
    static const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
    const EGLint size[] = {EGL_WIDTH, side, EGL_HEIGHT, side, EGL_NONE};
    EGLConfig config;
    EGLint count;
    if (!gl.eglInitialize(display, NULL, NULL))
        return failed("eglInitialize");
    if (!gl.eglChooseConfig(display, wanted, &config, 1, &count) || !count)
        return failed("eglChooseConfig");
    gl.eglBindAPI(EGL_OPENGL_ES_API);
    EGLContext context = gl.eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    if (context == EGL_NO_CONTEXT)
        return failed("eglCreateContext");
    EGLSurface surface = gl.eglCreatePbufferSurface(display, config, size);
    if (surface == EGL_NO_SURFACE)
        return failed("eglCreatePbufferSurface");
    return gl.eglMakeCurrent(display, surface, surface, context) ? NULL : failed("eglMakeCurrent");
}

const char *gles_start(const char *folder, int side)
{
    void *egl = load(folder, folder ? "libEGL.so" : "libEGL.so.1");
    void *gles = egl ? load(folder, folder ? "libGLESv2.so" : "libGLESv2.so.2") : NULL;
    if (!gles || !find_all(egl, gles))
        return reason;
    EGLDisplay display = folder ? angle_display() : gl.eglGetDisplay(EGL_DEFAULT_DISPLAY);
    return display == EGL_NO_DISPLAY ? failed("eglGetDisplay") : make_current(display, side);
}
