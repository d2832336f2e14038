#include "display.h"

#include "attributes.h"
#include "calls.h"
#include "device.h"
#include "surface.h"
#include "thread.h"

#include <stdlib.h>

/* Displays are never freed: a program may use their handles until it ends. */
static struct egl_display *displays;
static pthread_mutex_t displays_lock = PTHREAD_MUTEX_INITIALIZER;

struct egl_display *egl_display_find(EGLDisplay dpy)
{
    pthread_mutex_lock(&displays_lock);
    struct egl_display *display = displays;
    while (display && display != dpy)
        display = display->next;
    pthread_mutex_unlock(&displays_lock);
    return display;
}

struct egl_display *egl_display_enter(EGLDisplay dpy)
{
    struct egl_display *display = egl_display_find(dpy);
    egl_succeed();
    if (!display)
        return egl_fail(EGL_BAD_DISPLAY), NULL;
    pthread_mutex_lock(&display->lock);
    if (display->initialized)
        return display;
    pthread_mutex_unlock(&display->lock);
    return egl_fail(EGL_NOT_INITIALIZED), NULL;
}

void egl_display_leave(struct egl_display *display)
{
    pthread_mutex_unlock(&display->lock);
}

/* --- Objects --- */

void *egl_object_make(struct egl_display *display, enum egl_kind kind, size_t bytes,
                      void (*free)(struct egl_object *))
{
    struct egl_object *object = calloc(1, bytes);
    if (!object)
        return egl_fail(EGL_BAD_ALLOC), NULL;
    *object = (struct egl_object){display->objects, display, kind, false, 0, free};
    display->objects = object;
    return object;
}

void *egl_object_find(struct egl_display *display, enum egl_kind kind, const void *handle)
{
    struct egl_object *object = display->objects;
    while (object && (object != handle || object->kind != kind))
        object = object->next;
    return object;
}

static void free_unused(struct egl_object *object)
{
    if (!object->destroyed || object->uses)
        return;
    object->free(object);
    free(object);
}

void egl_object_destroy(struct egl_object *object)
{
    struct egl_object **link = &object->display->objects;
    while (*link != object)
        link = &(*link)->next;
    *link = object->next;
    object->destroyed = true;
    free_unused(object);
}

void egl_object_release(struct egl_object *object)
{
    object->uses--;
    free_unused(object);
}

/* --- eglGetPlatformDisplay --- */

struct request {
    EGLenum platform;
    void *native;
    bool is_xcb;
    EGLint screen;
};

static bool init_lock(struct egl_display *display)
{
    pthread_mutexattr_t attributes;
    pthread_condattr_t clock;
    if (pthread_mutexattr_init(&attributes))
        return false;
    pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_RECURSIVE);
    bool good = !pthread_mutex_init(&display->lock, &attributes) && !pthread_condattr_init(&clock);
    pthread_mutexattr_destroy(&attributes);
    if (!good)
        return false;
    pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
    good = !pthread_cond_init(&display->changed, &clock);
    pthread_condattr_destroy(&clock);
    return good;
}

static struct egl_display *make(const struct request *request)
{
    struct egl_display *display = calloc(1, sizeof *display);
    if (!display || !init_lock(display)) {
        free(display);
        return egl_fail(EGL_BAD_ALLOC), NULL;
    }
    display->platform = request->platform;
    display->native = request->native;
    display->is_xcb = request->is_xcb;
    display->screen = request->screen;
    display->next = displays;
    return displays = display;
}

/* The same arguments return the same display. */
static struct egl_display *find_or_make(const struct request *request)
{
    pthread_mutex_lock(&displays_lock);
    struct egl_display *display = displays;
    while (display && (display->platform != request->platform || display->native != request->native ||
                       display->is_xcb != request->is_xcb || display->screen != request->screen))
        display = display->next;
    if (!display)
        display = make(request);
    pthread_mutex_unlock(&displays_lock);
    return display;
}

/* The platform of eglGetDisplay: that of the environment. */
static EGLenum default_platform(const void *native)
{
    const char *name = getenv("DISPLAY");
    return native || (name && *name) ? EGL_PLATFORM_X11_KHR : EGL_PLATFORM_SURFACELESS_MESA;
}

static EGLint read_platform(struct request *request)
{
    switch (request->platform) {
    case EGL_NONE: request->platform = default_platform(request->native); break;
    case EGL_PLATFORM_XCB_EXT:
        request->platform = EGL_PLATFORM_X11_KHR;
        request->is_xcb = true;
        break;
    case EGL_PLATFORM_X11_KHR:
    case EGL_PLATFORM_SURFACELESS_MESA: break;
    case EGL_PLATFORM_DEVICE_EXT: return egl_device_is(request->native) ? EGL_SUCCESS : EGL_BAD_PARAMETER;
    default: return EGL_BAD_PARAMETER;
    }
    return request->platform == EGL_PLATFORM_SURFACELESS_MESA && request->native ? EGL_BAD_PARAMETER
                                                                                 : EGL_SUCCESS;
}

static EGLint read_attributes(struct request *request, const EGLAttrib *list)
{
    for (; list && *list != EGL_NONE; list += 2) {
        const bool is_screen =
            request->is_xcb ? list[0] == EGL_PLATFORM_XCB_SCREEN_EXT : list[0] == EGL_PLATFORM_X11_SCREEN_KHR;
        if (!is_screen || request->platform != EGL_PLATFORM_X11_KHR)
            return EGL_BAD_ATTRIBUTE;
        request->screen = (EGLint)list[1];
    }
    return EGL_SUCCESS;
}

EGLDisplay egl_GetPlatformDisplay(EGLenum platform, void *native, const EGLAttrib *list)
{
    struct request request = {platform, native, false, -1};
    egl_succeed();
    EGLint error = read_platform(&request);
    if (error == EGL_SUCCESS)
        error = read_attributes(&request, list);
    if (error != EGL_SUCCESS)
        return egl_fail(error), EGL_NO_DISPLAY;
    return find_or_make(&request);
}

EGLDisplay egl_GetPlatformDisplayEXT(EGLenum platform, void *native, const EGLint *words)
{
    struct egl_list list;
    return egl_GetPlatformDisplay(platform, native, egl_list_widen(&list, words));
}

EGLDisplay egl_GetDisplay(EGLNativeDisplayType native)
{
    return egl_GetPlatformDisplay(EGL_NONE, native, NULL);
}

/* --- Beginning and end --- */

static bool initialize(struct egl_display *display)
{
    if (display->platform == EGL_PLATFORM_X11_KHR &&
        !egl_x11_open(&display->x11, display->native, display->is_xcb, display->screen))
        return false;
    display->device = gl_device_create();
    if (!display->device) {
        egl_x11_close(&display->x11);
        return false;
    }
    egl_config_make(display);
    return display->initialized = true;
}

EGLBoolean egl_Initialize(EGLDisplay dpy, EGLint *major, EGLint *minor)
{
    struct egl_display *display = egl_display_find(dpy);
    egl_succeed();
    if (!display)
        return egl_fail(EGL_BAD_DISPLAY);
    pthread_mutex_lock(&display->lock);
    const bool good = display->initialized || initialize(display);
    pthread_mutex_unlock(&display->lock);
    if (!good)
        return egl_fail(EGL_NOT_INITIALIZED);
    if (major)
        *major = 1;
    if (minor)
        *minor = 5;
    return EGL_TRUE;
}

/* The connection of the program may end after the display. Current objects stay until they are released. */
static void destroy_objects(struct egl_display *display)
{
    while (display->objects) {
        struct egl_object *object = display->objects;
        if (object->kind == EGL_KIND_SURFACE)
            egl_x11_end(&display->x11, &((struct egl_surface *)object)->picture);
        egl_object_destroy(object);
    }
}

EGLBoolean egl_Terminate(EGLDisplay dpy)
{
    struct egl_display *display = egl_display_find(dpy);
    egl_succeed();
    if (!display)
        return egl_fail(EGL_BAD_DISPLAY);
    pthread_mutex_lock(&display->lock);
    if (display->initialized) {
        destroy_objects(display);
        egl_x11_close(&display->x11);
        gl_device_drop(display->device);
        display->device = NULL;
        display->initialized = false;
    }
    pthread_mutex_unlock(&display->lock);
    return EGL_TRUE;
}

/* --- eglQueryString --- */

static const char client_extensions[] =
    "EGL_EXT_client_extensions EGL_EXT_device_base EGL_EXT_device_enumeration EGL_EXT_device_query "
    "EGL_EXT_platform_base EGL_EXT_platform_device EGL_EXT_platform_x11 EGL_EXT_platform_xcb "
    "EGL_KHR_client_get_all_proc_addresses EGL_KHR_platform_x11 EGL_MESA_platform_surfaceless";

static const char extensions[] =
    "EGL_EXT_buffer_age EGL_EXT_create_context_robustness EGL_EXT_swap_buffers_with_damage "
    "EGL_KHR_config_attribs EGL_KHR_create_context EGL_KHR_fence_sync EGL_KHR_get_all_proc_addresses "
    "EGL_KHR_gl_renderbuffer_image EGL_KHR_gl_texture_2D_image EGL_KHR_gl_texture_cubemap_image "
    "EGL_KHR_image_base "
    "EGL_KHR_no_config_context EGL_KHR_partial_update EGL_KHR_reusable_sync EGL_KHR_surfaceless_context "
    "EGL_KHR_swap_buffers_with_damage EGL_KHR_wait_sync";

const char *egl_QueryString(EGLDisplay dpy, EGLint name)
{
    egl_succeed();
    if (dpy == EGL_NO_DISPLAY && name == EGL_EXTENSIONS)
        return client_extensions;
    if (dpy == EGL_NO_DISPLAY && name == EGL_VERSION)
        return "1.5";
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return NULL;
    egl_display_leave(display);
    switch (name) {
    case EGL_CLIENT_APIS: return "OpenGL_ES";
    case EGL_EXTENSIONS: return extensions;
    case EGL_VENDOR: return "Triptych";
    case EGL_VERSION: return "1.5 Triptych " TRIPTYCH_VERSION;
    default: return egl_fail(EGL_BAD_PARAMETER), NULL;
    }
}
