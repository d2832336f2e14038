/* eglMakeCurrent and what follows from it. */
#include "current.h"

#include "calls.h"
#include "front/gl/dispatch/dispatch.h"
#include "surface.h"

/* Held before the lock of a display by all functions that lock a second display: the one of the context that
 * was current. */
static pthread_mutex_t change = PTHREAD_MUTEX_INITIALIZER;

static void hold_surface(struct egl_surface *surface, struct egl_thread *thread)
{
    if (!surface)
        return;
    surface->object.uses++;
    surface->thread = thread;
}

static void drop_surface(struct egl_surface *surface)
{
    if (!surface)
        return;
    if (surface->object.uses == 1)
        surface->thread = NULL;
    egl_object_release(&surface->object);
}

/* Pixmaps get the pixels that were drawn. A pixmap that no longer exists gets none. */
static void finish_pixmap(struct egl_surface *surface)
{
    if (!surface || surface->kind != EGL_PIXMAP_BIT || !surface->picture.pixels)
        return;
    egl_surface_show(surface, &(struct triptych_rectangle){0, 0, surface->gl.width, surface->gl.height});
}

static void release(struct egl_thread *thread)
{
    struct egl_context *context = thread->context;
    if (!context)
        return;
    struct egl_display *display = context->object.display;
    pthread_mutex_lock(&display->lock);
    gl_context_flush(context->gl);
    finish_pixmap(thread->draw);
    gl_context_bind(context->gl, NULL, NULL);
    context->thread = NULL;
    drop_surface(thread->draw);
    drop_surface(thread->read);
    egl_object_release(&context->object);
    thread->context = NULL;
    thread->draw = thread->read = NULL;
    pthread_mutex_unlock(&display->lock);
}

void egl_current_release(struct egl_thread *thread)
{
    pthread_mutex_lock(&change);
    release(thread);
    pthread_mutex_unlock(&change);
    if (thread == egl_thread_current())
        gl_dispatch_set(NULL, 0);
}

static const unsigned matched[] = {EGL_INDEX_RED_SIZE,   EGL_INDEX_GREEN_SIZE,       EGL_INDEX_BLUE_SIZE,
                                   EGL_INDEX_ALPHA_SIZE, EGL_INDEX_DEPTH_SIZE,       EGL_INDEX_STENCIL_SIZE,
                                   EGL_INDEX_SAMPLES,    EGL_INDEX_COLOR_BUFFER_TYPE};

static bool are_compatible(const struct egl_config *a, const struct egl_config *b)
{
    for (unsigned i = 0; i < sizeof matched / sizeof *matched; i++)
        if (a->value[matched[i]] != b->value[matched[i]])
            return false;
    return true;
}

static EGLint check_surface(const struct egl_context *context, const struct egl_surface *surface,
                            const struct egl_thread *thread)
{
    if (surface->thread && surface->thread != thread)
        return EGL_BAD_ACCESS;
    if (context->config && !are_compatible(context->config, surface->config))
        return EGL_BAD_MATCH;
    return EGL_SUCCESS;
}

struct request {
    struct egl_context *context;
    struct egl_surface *draw, *read;
};

/* A window that no longer exists is an error; one with another size changes its surface, unless the surface
 * is current already. */
static EGLint check_window(struct egl_surface *surface)
{
    if (!surface || surface->kind != EGL_WINDOW_BIT || surface->thread)
        return EGL_SUCCESS;
    return egl_surface_follow(surface) ? EGL_SUCCESS : EGL_BAD_NATIVE_WINDOW;
}

static EGLint find(struct egl_display *display, struct request *request, EGLSurface draw, EGLSurface read,
                   EGLContext context)
{
    request->context = egl_object_find(display, EGL_KIND_CONTEXT, context);
    request->draw = egl_object_find(display, EGL_KIND_SURFACE, draw);
    request->read = egl_object_find(display, EGL_KIND_SURFACE, read);
    if (context != EGL_NO_CONTEXT && !request->context)
        return EGL_BAD_CONTEXT;
    if ((draw != EGL_NO_SURFACE && !request->draw) || (read != EGL_NO_SURFACE && !request->read))
        return EGL_BAD_SURFACE;
    return !context == !draw && !draw == !read                 ? EGL_SUCCESS
           : context && draw == EGL_NO_SURFACE && draw == read ? EGL_SUCCESS
                                                               : EGL_BAD_MATCH;
}

static EGLint check(const struct request *request, const struct egl_thread *thread)
{
    EGLint error = EGL_SUCCESS;
    if (request->context && request->context->thread && request->context->thread != thread)
        return EGL_BAD_ACCESS;
    if (request->draw)
        error = check_surface(request->context, request->draw, thread);
    if (request->read && error == EGL_SUCCESS)
        error = check_surface(request->context, request->read, thread);
    if (error == EGL_SUCCESS)
        error = check_window(request->draw);
    return error == EGL_SUCCESS ? check_window(request->read) : error;
}

static bool is_current(const struct request *request, const struct egl_thread *thread)
{
    return request->context == thread->context && request->draw == thread->draw &&
           request->read == thread->read;
}

/* The new objects are held before the old ones are dropped, because they can be the same. */
static EGLint bind(const struct request *request, struct egl_thread *thread)
{
    struct gl_surface *draw = request->draw ? &request->draw->gl : NULL;
    struct gl_surface *read = request->read ? &request->read->gl : NULL;
    request->context->object.uses++;
    hold_surface(request->draw, thread);
    hold_surface(request->read, thread);
    release(thread);
    const bool bound = gl_context_bind(request->context->gl, draw, read);
    if (bound) {
        request->context->thread = thread;
        *thread = (struct egl_thread){thread->error, request->context, request->draw, request->read};
        gl_dispatch_set(request->context->gl, request->context->interface);
        return EGL_SUCCESS;
    }
    drop_surface(request->draw);
    drop_surface(request->read);
    egl_object_release(&request->context->object);
    gl_dispatch_set(NULL, 0);
    return EGL_BAD_ALLOC;
}

static EGLint make_current(struct egl_display *display, EGLSurface draw, EGLSurface read, EGLContext context)
{
    struct egl_thread *thread = egl_thread_current();
    struct request request;
    EGLint error = find(display, &request, draw, read, context);
    if (error == EGL_SUCCESS)
        error = check(&request, thread);
    if (error != EGL_SUCCESS || is_current(&request, thread))
        return error;
    return bind(&request, thread);
}

/* Without a context the display need not be initialized. */
static EGLBoolean make_none(EGLDisplay dpy)
{
    egl_succeed();
    if (!egl_display_find(dpy))
        return egl_fail(EGL_BAD_DISPLAY);
    egl_current_release(egl_thread_current());
    return EGL_TRUE;
}

EGLBoolean egl_MakeCurrent(EGLDisplay dpy, EGLSurface draw, EGLSurface read, EGLContext context)
{
    if (draw == EGL_NO_SURFACE && read == EGL_NO_SURFACE && context == EGL_NO_CONTEXT)
        return make_none(dpy);
    pthread_mutex_lock(&change);
    struct egl_display *display = egl_display_enter(dpy);
    EGLint error = EGL_SUCCESS;
    if (display) {
        error = make_current(display, draw, read, context);
        egl_display_leave(display);
    }
    pthread_mutex_unlock(&change);
    if (error != EGL_SUCCESS)
        egl_fail(error);
    return display && error == EGL_SUCCESS;
}

EGLBoolean egl_ReleaseThread(void)
{
    egl_current_release(egl_thread_current());
    egl_succeed();
    return EGL_TRUE;
}

EGLContext egl_GetCurrentContext(void)
{
    egl_succeed();
    return egl_thread_current()->context;
}

EGLDisplay egl_GetCurrentDisplay(void)
{
    const struct egl_context *context = egl_thread_current()->context;
    egl_succeed();
    return context ? context->object.display : EGL_NO_DISPLAY;
}

EGLSurface egl_GetCurrentSurface(EGLint which)
{
    const struct egl_thread *thread = egl_thread_current();
    egl_succeed();
    if (which == EGL_DRAW)
        return thread->draw;
    return which == EGL_READ ? thread->read : (egl_fail(EGL_BAD_PARAMETER), EGL_NO_SURFACE);
}

/* Waits for the context's commands, and gives a pixmap its pixels. */
EGLBoolean egl_WaitClient(void)
{
    struct egl_thread *thread = egl_thread_current();
    egl_succeed();
    if (!thread->context)
        return EGL_TRUE;
    struct egl_display *display = thread->context->object.display;
    pthread_mutex_lock(&display->lock);
    gl_context_finish(thread->context->gl);
    finish_pixmap(thread->draw);
    pthread_mutex_unlock(&display->lock);
    return EGL_TRUE;
}

/* Requests to the server are complete when their functions return. A pixmap is read again. */
EGLBoolean egl_WaitNative(EGLint engine)
{
    struct egl_thread *thread = egl_thread_current();
    egl_succeed();
    if (engine != EGL_CORE_NATIVE_ENGINE)
        return egl_fail(EGL_BAD_PARAMETER);
    if (!thread->draw || thread->draw->kind != EGL_PIXMAP_BIT || !thread->draw->picture.pixels)
        return EGL_TRUE;
    struct egl_display *display = thread->context->object.display;
    pthread_mutex_lock(&display->lock);
    const bool good = egl_surface_load(thread->draw);
    pthread_mutex_unlock(&display->lock);
    return good ? EGL_TRUE : (EGLBoolean)egl_fail(EGL_BAD_CURRENT_SURFACE);
}
