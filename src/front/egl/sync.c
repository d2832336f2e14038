/* Syncs: fences, which the renderer signals, and reusable ones, which the program signals. */
#include "attributes.h"
#include "calls.h"
#include "current.h"

#include <time.h>

enum { SECOND_NS = 1000000000, POLL_NS = 100000 };

struct egl_sync {
    struct egl_object object;
    EGLenum type;
    struct gl_device *device; /* held */
    triptych_query *query;    /* of a fence */
    bool signaled;
};

static void free_sync(struct egl_object *object)
{
    struct egl_sync *sync = (struct egl_sync *)object;
    if (!sync->device)
        return;
    gl_device_enter(sync->device, NULL);
    triptych_query_destroy(sync->device->renderer, sync->query);
    gl_device_leave(sync->device);
    gl_device_drop(sync->device);
}

static bool begin_fence(struct egl_sync *sync)
{
    triptych_device *renderer = sync->device->renderer;
    gl_device_enter(sync->device, NULL);
    const bool good = !triptych_query_create(renderer, TRIPTYCH_QUERY_EVENT, &sync->query) &&
                      !triptych_query_end(renderer, sync->query);
    gl_device_leave(sync->device);
    return good;
}

/* A type that does not exist gives `unknown`: EGL 1.5 and EGL_KHR_fence_sync differ in it. */
static EGLint check(const struct egl_display *display, EGLenum type, const EGLAttrib *list, EGLint unknown)
{
    const struct egl_context *context = egl_thread_current()->context;
    if (type != EGL_SYNC_FENCE && type != EGL_SYNC_REUSABLE_KHR)
        return unknown;
    if (list && *list != EGL_NONE)
        return EGL_BAD_ATTRIBUTE;
    if (type == EGL_SYNC_REUSABLE_KHR)
        return EGL_SUCCESS;
    return context && context->object.display == display ? EGL_SUCCESS : EGL_BAD_MATCH;
}

static EGLSync make(struct egl_display *display, EGLenum type, const EGLAttrib *list, EGLint unknown)
{
    EGLint error = check(display, type, list, unknown);
    if (error != EGL_SUCCESS)
        return egl_fail(error), EGL_NO_SYNC;
    struct egl_sync *sync = egl_object_make(display, EGL_KIND_SYNC, sizeof *sync, free_sync);
    if (!sync)
        return EGL_NO_SYNC;
    sync->type = type;
    sync->device = gl_device_hold(display->device);
    if (type == EGL_SYNC_REUSABLE_KHR || begin_fence(sync))
        return sync;
    egl_object_destroy(&sync->object);
    return egl_fail(EGL_BAD_ALLOC), EGL_NO_SYNC;
}

static EGLSync create(EGLDisplay dpy, EGLenum type, const EGLAttrib *list, EGLint unknown)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_NO_SYNC;
    EGLSync sync = make(display, type, list, unknown);
    egl_display_leave(display);
    return sync;
}

EGLSync egl_CreateSync(EGLDisplay dpy, EGLenum type, const EGLAttrib *list)
{
    return create(dpy, type, list, EGL_BAD_PARAMETER);
}

EGLSyncKHR egl_CreateSyncKHR(EGLDisplay dpy, EGLenum type, const EGLint *words)
{
    struct egl_list list;
    return create(dpy, type, egl_list_widen(&list, words), EGL_BAD_ATTRIBUTE);
}

static void set_signaled(struct egl_sync *sync, bool signaled)
{
    sync->signaled = signaled;
    pthread_cond_broadcast(&sync->object.display->changed);
}

/* Waits for the sync end. */
EGLBoolean egl_DestroySync(EGLDisplay dpy, EGLSync handle)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    struct egl_sync *sync = egl_object_find(display, EGL_KIND_SYNC, handle);
    if (sync) {
        if (sync->type == EGL_SYNC_REUSABLE_KHR)
            set_signaled(sync, true);
        egl_object_destroy(&sync->object);
    } else {
        egl_fail(EGL_BAD_PARAMETER);
    }
    egl_display_leave(display);
    return sync != NULL;
}

/* Without waiting: a fence's pending draws begin to be rendered. */
static bool is_signaled(struct egl_sync *sync)
{
    int ready = 0;
    uint64_t result;
    if (sync->signaled || sync->type == EGL_SYNC_REUSABLE_KHR)
        return sync->signaled;
    gl_device_enter(sync->device, NULL);
    sync->signaled = triptych_query_poll(sync->device->renderer, sync->query, &ready, &result) || ready;
    gl_device_leave(sync->device);
    return sync->signaled;
}

static void finish_fence(struct egl_sync *sync)
{
    uint64_t result;
    gl_device_enter(sync->device, NULL);
    triptych_query_result(sync->device->renderer, sync->query, &result);
    gl_device_leave(sync->device);
    sync->signaled = true;
}

static struct timespec after(EGLTime ns)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    const uint64_t sum = (uint64_t)time.tv_nsec + ns % SECOND_NS;
    const uint64_t seconds = ns / SECOND_NS + sum / SECOND_NS;
    const uint64_t most = (uint64_t)1 << 40;
    time.tv_sec += (time_t)(seconds < most ? seconds : most);
    time.tv_nsec = (long)(sum % SECOND_NS);
    return time;
}

static bool is_past(const struct timespec *end)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec > end->tv_sec || (now.tv_sec == end->tv_sec && now.tv_nsec >= end->tv_nsec);
}

/* The lock of the display is free during each pause. */
static bool wait_until(struct egl_sync *sync, const struct timespec *end)
{
    struct egl_display *display = sync->object.display;
    while (!is_signaled(sync)) {
        if (is_past(end))
            return false;
        const struct timespec pause = after(POLL_NS);
        pthread_cond_timedwait(&display->changed, &display->lock,
                               sync->type == EGL_SYNC_FENCE ? &pause : end);
    }
    return true;
}

static bool wait_forever(struct egl_sync *sync)
{
    if (sync->type == EGL_SYNC_FENCE)
        finish_fence(sync);
    while (!sync->signaled)
        pthread_cond_wait(&sync->object.display->changed, &sync->object.display->lock);
    return true;
}

static EGLint wait_for(struct egl_sync *sync, EGLTime timeout)
{
    bool good;
    sync->object.uses++;
    if (!timeout) {
        good = is_signaled(sync);
    } else if (timeout == EGL_FOREVER) {
        good = wait_forever(sync);
    } else {
        const struct timespec end = after(timeout);
        good = wait_until(sync, &end);
    }
    egl_object_release(&sync->object);
    return good ? EGL_CONDITION_SATISFIED : EGL_TIMEOUT_EXPIRED;
}

EGLint egl_ClientWaitSync(EGLDisplay dpy, EGLSync handle, EGLint flags, EGLTime timeout)
{
    struct egl_display *display = egl_display_enter(dpy);
    (void)flags; /* a wait always flushes */
    if (!display)
        return EGL_FALSE;
    struct egl_sync *sync = egl_object_find(display, EGL_KIND_SYNC, handle);
    EGLint result = sync ? wait_for(sync, timeout) : egl_fail(EGL_BAD_PARAMETER);
    egl_display_leave(display);
    return result;
}

/* The contexts of a display render in the order of their commands, so there is nothing to wait for. */
EGLBoolean egl_WaitSync(EGLDisplay dpy, EGLSync handle, EGLint flags)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    const struct egl_sync *sync = egl_object_find(display, EGL_KIND_SYNC, handle);
    EGLint error = !sync || flags                   ? EGL_BAD_PARAMETER
                   : !egl_thread_current()->context ? EGL_BAD_MATCH
                   : sync->type != EGL_SYNC_FENCE   ? EGL_BAD_MATCH
                                                    : EGL_SUCCESS;
    egl_display_leave(display);
    return error == EGL_SUCCESS ? EGL_TRUE : (EGLBoolean)egl_fail(error);
}

EGLint egl_WaitSyncKHR(EGLDisplay dpy, EGLSyncKHR handle, EGLint flags)
{
    return (EGLint)egl_WaitSync(dpy, handle, flags);
}

static EGLint get(struct egl_sync *sync, EGLint name, EGLAttrib *value)
{
    if (!sync)
        return EGL_BAD_PARAMETER;
    switch (name) {
    case EGL_SYNC_TYPE: *value = sync->type; return EGL_SUCCESS;
    case EGL_SYNC_STATUS: *value = is_signaled(sync) ? EGL_SIGNALED : EGL_UNSIGNALED; return EGL_SUCCESS;
    case EGL_SYNC_CONDITION:
        *value = EGL_SYNC_PRIOR_COMMANDS_COMPLETE;
        return sync->type == EGL_SYNC_FENCE ? EGL_SUCCESS : EGL_BAD_ATTRIBUTE;
    default: return EGL_BAD_ATTRIBUTE;
    }
}

EGLBoolean egl_GetSyncAttrib(EGLDisplay dpy, EGLSync handle, EGLint name, EGLAttrib *value)
{
    struct egl_display *display = egl_display_enter(dpy);
    EGLAttrib got = 0;
    if (!display)
        return EGL_FALSE;
    EGLint error =
        value ? get(egl_object_find(display, EGL_KIND_SYNC, handle), name, &got) : EGL_BAD_PARAMETER;
    egl_display_leave(display);
    if (error != EGL_SUCCESS)
        return egl_fail(error);
    *value = got;
    return EGL_TRUE;
}

EGLBoolean egl_GetSyncAttribKHR(EGLDisplay dpy, EGLSyncKHR handle, EGLint name, EGLint *value)
{
    EGLAttrib got = 0;
    EGLBoolean good = egl_GetSyncAttrib(dpy, handle, name, value ? &got : NULL);
    if (good)
        *value = (EGLint)got;
    return good;
}

EGLBoolean egl_SignalSyncKHR(EGLDisplay dpy, EGLSyncKHR handle, EGLenum mode)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    struct egl_sync *sync = egl_object_find(display, EGL_KIND_SYNC, handle);
    EGLint error = !sync                                            ? EGL_BAD_PARAMETER
                   : sync->type != EGL_SYNC_REUSABLE_KHR            ? EGL_BAD_MATCH
                   : mode != EGL_SIGNALED && mode != EGL_UNSIGNALED ? EGL_BAD_PARAMETER
                                                                    : EGL_SUCCESS;
    if (error == EGL_SUCCESS)
        set_signaled(sync, mode == EGL_SIGNALED);
    egl_display_leave(display);
    return error == EGL_SUCCESS ? EGL_TRUE : (EGLBoolean)egl_fail(error);
}
