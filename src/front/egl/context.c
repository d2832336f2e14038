/* The creation and the end of contexts. */
#include "calls.h"
#include "current.h"
#include "surface.h"

struct request {
    EGLint major, minor, flags, profile;
    EGLint reset; /* EGL_NO_RESET_NOTIFICATION or EGL_LOSE_CONTEXT_ON_RESET */
    bool robust, debug;
};

static bool is_boolean(EGLint value)
{
    return value == EGL_TRUE || value == EGL_FALSE;
}

static EGLint read_boolean(bool *to, EGLint value)
{
    *to = value == EGL_TRUE;
    return is_boolean(value) ? EGL_SUCCESS : EGL_BAD_ATTRIBUTE;
}

/* OpenGL ES has the flags of debugging and of robust access; no profile. */
static EGLint read_flags(struct request *request, EGLint flags)
{
    request->debug |= (flags & EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR) != 0;
    request->robust |= (flags & EGL_CONTEXT_OPENGL_ROBUST_ACCESS_BIT_KHR) != 0;
    return flags & ~(EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR | EGL_CONTEXT_OPENGL_ROBUST_ACCESS_BIT_KHR)
               ? EGL_BAD_ATTRIBUTE
               : EGL_SUCCESS;
}

static EGLint read_pair(struct request *request, EGLint name, EGLint value)
{
    switch (name) {
    case EGL_CONTEXT_MAJOR_VERSION: request->major = value; return EGL_SUCCESS;
    case EGL_CONTEXT_MINOR_VERSION: request->minor = value; return EGL_SUCCESS;
    case EGL_CONTEXT_FLAGS_KHR: return read_flags(request, value);
    case EGL_CONTEXT_OPENGL_DEBUG: return read_boolean(&request->debug, value);
    case EGL_CONTEXT_OPENGL_ROBUST_ACCESS:
    case EGL_CONTEXT_OPENGL_ROBUST_ACCESS_EXT: return read_boolean(&request->robust, value);
    case EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY:
    case EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT:
        request->reset = value;
        return value == EGL_NO_RESET_NOTIFICATION || value == EGL_LOSE_CONTEXT_ON_RESET ? EGL_SUCCESS
                                                                                        : EGL_BAD_ATTRIBUTE;
    default: return EGL_BAD_ATTRIBUTE;
    }
}

/* A context of version 1.0 may be one of 1.1, which has all of it. */
static EGLint check_version(const struct request *request)
{
    if (request->major == 1)
        return request->minor == 0 || request->minor == 1 ? EGL_SUCCESS : EGL_BAD_MATCH;
    return request->major == 2 && request->minor == 0 ? EGL_SUCCESS : EGL_BAD_MATCH;
}

static EGLint read_request(struct request *request, const EGLint *list)
{
    for (; list && *list != EGL_NONE; list += 2) {
        EGLint error = read_pair(request, list[0], list[1]);
        if (error != EGL_SUCCESS)
            return error;
    }
    return check_version(request);
}

static EGLint check_config(const struct egl_display *display, EGLConfig handle, EGLint major)
{
    const struct egl_config *config = egl_config_find(display, handle);
    const EGLint bit = major == 1 ? EGL_OPENGL_ES_BIT : EGL_OPENGL_ES2_BIT;
    if (!config && handle != EGL_NO_CONFIG_KHR)
        return EGL_BAD_CONFIG;
    return display->config[0].value[EGL_INDEX_RENDERABLE_TYPE] & bit ? EGL_SUCCESS : EGL_BAD_MATCH;
}

/* Contexts of one group have the same reset notification. */
static EGLint check_share(const struct egl_context *share, const struct request *request)
{
    return !share || share->reset == request->reset ? EGL_SUCCESS : EGL_BAD_MATCH;
}

static void free_context(struct egl_object *object)
{
    struct egl_context *context = (struct egl_context *)object;
    gl_context_destroy(context->gl);
    gl_device_drop(context->device);
}

static struct egl_context *make(struct egl_display *display, EGLConfig config, struct egl_context *share,
                                const struct request *request)
{
    struct egl_context *context = egl_object_make(display, EGL_KIND_CONTEXT, sizeof *context, free_context);
    if (!context)
        return NULL;
    const struct gl_context_options options = {
        .device = display->device,
        .interface = request->major == 1 ? GL_ES1 : GL_ES2,
        .debug = request->debug,
        .robust = request->robust,
        .loses_on_reset = request->reset == EGL_LOSE_CONTEXT_ON_RESET,
    };
    context->device = gl_device_hold(display->device);
    context->config = config;
    context->interface = options.interface;
    context->version = request->major;
    context->reset = request->reset;
    context->gl = gl_context_create(share ? gl_context_share(share->gl) : NULL, &options);
    if (context->gl)
        return context;
    egl_object_destroy(&context->object);
    return egl_fail(EGL_BAD_ALLOC), NULL;
}

static EGLContext create(struct egl_display *display, EGLConfig config, EGLContext handle, const EGLint *list)
{
    struct request request = {.major = 1, .reset = EGL_NO_RESET_NOTIFICATION};
    struct egl_context *share = egl_object_find(display, EGL_KIND_CONTEXT, handle);
    EGLint error = read_request(&request, list);
    if (error == EGL_SUCCESS)
        error = check_config(display, config, request.major);
    if (error == EGL_SUCCESS && handle != EGL_NO_CONTEXT && !share)
        error = EGL_BAD_CONTEXT;
    if (error == EGL_SUCCESS)
        error = check_share(share, &request);
    if (error != EGL_SUCCESS)
        return egl_fail(error), EGL_NO_CONTEXT;
    return make(display, config, share, &request);
}

EGLContext egl_CreateContext(EGLDisplay dpy, EGLConfig config, EGLContext share, const EGLint *list)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_NO_CONTEXT;
    EGLContext context = create(display, config, share, list);
    egl_display_leave(display);
    return context;
}

EGLBoolean egl_DestroyContext(EGLDisplay dpy, EGLContext handle)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    struct egl_context *context = egl_object_find(display, EGL_KIND_CONTEXT, handle);
    if (context)
        egl_object_destroy(&context->object);
    else
        egl_fail(EGL_BAD_CONTEXT);
    egl_display_leave(display);
    return context != NULL;
}

/* The buffer that a context draws to exists only while it is current with a surface. */
static EGLint render_buffer(const struct egl_context *context)
{
    const struct egl_thread *thread = context->thread;
    const struct egl_surface *draw = thread ? thread->draw : NULL;
    return !draw ? EGL_NONE : draw->gl.single ? EGL_SINGLE_BUFFER : EGL_BACK_BUFFER;
}

static EGLBoolean query(const struct egl_context *context, EGLint name, EGLint *value)
{
    if (!context)
        return egl_fail(EGL_BAD_CONTEXT);
    if (!value)
        return egl_fail(EGL_BAD_PARAMETER);
    switch (name) {
    case EGL_CONFIG_ID: *value = context->config ? context->config->value[EGL_INDEX_CONFIG_ID] : 0; break;
    case EGL_CONTEXT_CLIENT_TYPE: *value = EGL_OPENGL_ES_API; break;
    case EGL_CONTEXT_CLIENT_VERSION: *value = context->version; break;
    case EGL_RENDER_BUFFER: *value = render_buffer(context); break;
    default: return egl_fail(EGL_BAD_ATTRIBUTE);
    }
    return EGL_TRUE;
}

EGLBoolean egl_QueryContext(EGLDisplay dpy, EGLContext handle, EGLint name, EGLint *value)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    EGLBoolean result = query(egl_object_find(display, EGL_KIND_CONTEXT, handle), name, value);
    egl_display_leave(display);
    return result;
}
