/* The end of frames. */
#include "calls.h"
#include "current.h"
#include "surface.h"

/* Ends the frame in a recording and in statistics. */
static void end_frame(struct gl_device *device)
{
    gl_device_enter(device, NULL);
    triptych_end_frame(device->renderer);
    front_statistics_frame(&device->statistics, device->renderer);
    gl_device_leave(device);
}

static unsigned clamp(EGLint value, unsigned most)
{
    return value < 0 ? 0 : (unsigned)value > most ? most : (unsigned)value;
}

/* The smallest rectangle with all of the damage, inside the surface. */
static struct triptych_rectangle bounds(const struct gl_surface *surface, const EGLint *rects, EGLint count)
{
    unsigned left = surface->width, bottom = surface->height, right = 0, top = 0;
    for (EGLint i = 0; i < count; i++, rects += 4) {
        const unsigned x = clamp(rects[0], surface->width), y = clamp(rects[1], surface->height);
        const unsigned x1 = clamp(rects[0] + rects[2], surface->width);
        const unsigned y1 = clamp(rects[1] + rects[3], surface->height);
        left = x < left ? x : left;
        bottom = y < bottom ? y : bottom;
        right = x1 > right ? x1 : right;
        top = y1 > top ? y1 : top;
    }
    if (!count)
        return (struct triptych_rectangle){0, 0, surface->width, surface->height};
    if (right <= left || top <= bottom)
        return (struct triptych_rectangle){0};
    return (struct triptych_rectangle){left, bottom, right - left, top - bottom};
}

static void finish(struct gl_device *device)
{
    gl_device_enter(device, NULL);
    triptych_finish(device->renderer);
    gl_device_leave(device);
}

/* The window's size is requested before the frame is drawn. Its answer follows the end of the last frame's
 * put, so the thread waits for neither while there is something to draw. */
static EGLint present(struct egl_surface *surface, const EGLint *rects, EGLint count)
{
    const struct triptych_rectangle part = bounds(&surface->gl, rects, count);
    struct egl_x11_size size;
    end_frame(surface->gl.device);
    finish(surface->gl.device);
    if (!egl_x11_receive_size(&surface->object.display->x11, &surface->picture, &size) ||
        !egl_surface_show(surface, &part))
        return EGL_BAD_NATIVE_WINDOW;
    surface->shown = true;
    surface->aged = surface->has_limit = false;
    return egl_surface_fit(surface, &size) ? EGL_SUCCESS : EGL_BAD_NATIVE_WINDOW;
}

/* Only windows have two buffers. The surface must be the one that the thread draws to. */
static EGLint swap(struct egl_display *display, EGLSurface handle, const EGLint *rects, EGLint count)
{
    struct egl_thread *thread = egl_thread_current();
    struct egl_surface *surface = egl_object_find(display, EGL_KIND_SURFACE, handle);
    if (!surface || surface != thread->draw)
        return EGL_BAD_SURFACE;
    if (count < 0 || (count && !rects))
        return EGL_BAD_PARAMETER;
    if (surface->kind == EGL_WINDOW_BIT)
        egl_x11_request_size(&display->x11, &surface->picture);
    gl_context_show(thread->context->gl);
    gl_context_flush(thread->context->gl);
    if (surface->kind == EGL_WINDOW_BIT)
        return present(surface, rects, count);
    if (surface->kind == EGL_PBUFFER_BIT)
        end_frame(surface->gl.device);
    return EGL_SUCCESS;
}

EGLBoolean egl_SwapBuffersWithDamage(EGLDisplay dpy, EGLSurface surface, const EGLint *rects, EGLint count)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    EGLint error = swap(display, surface, rects, count);
    egl_display_leave(display);
    return error == EGL_SUCCESS ? EGL_TRUE : (EGLBoolean)egl_fail(error);
}

EGLBoolean egl_SwapBuffers(EGLDisplay dpy, EGLSurface surface)
{
    return egl_SwapBuffersWithDamage(dpy, surface, NULL, 0);
}

/* Draws outside of the region are undefined, and what was there stays, because a surface has one image. */
static EGLint limit(struct egl_surface *surface, const EGLint *rects, EGLint count)
{
    if (!surface)
        return EGL_BAD_SURFACE;
    if (surface != egl_thread_current()->draw || surface->kind != EGL_WINDOW_BIT ||
        surface->behavior != EGL_BUFFER_DESTROYED)
        return EGL_BAD_MATCH;
    if (count < 0 || (count && !rects))
        return EGL_BAD_PARAMETER;
    if (!surface->aged || surface->has_limit)
        return EGL_BAD_ACCESS;
    surface->has_limit = true;
    return EGL_SUCCESS;
}

EGLBoolean egl_SetDamageRegionKHR(EGLDisplay dpy, EGLSurface surface, EGLint *rects, EGLint count)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    EGLint error = limit(egl_object_find(display, EGL_KIND_SURFACE, surface), rects, count);
    egl_display_leave(display);
    return error == EGL_SUCCESS ? EGL_TRUE : (EGLBoolean)egl_fail(error);
}

/* A swap never waits for the screen, so the interval has no effect. */
EGLBoolean egl_SwapInterval(EGLDisplay dpy, EGLint interval)
{
    struct egl_display *display = egl_display_enter(dpy);
    const struct egl_thread *thread = egl_thread_current();
    (void)interval;
    if (!display)
        return EGL_FALSE;
    egl_display_leave(display);
    if (!thread->context)
        return egl_fail(EGL_BAD_CONTEXT);
    return thread->draw ? EGL_TRUE : (EGLBoolean)egl_fail(EGL_BAD_SURFACE);
}

static EGLint copy(struct egl_display *display, struct egl_surface *surface, uint32_t pixmap)
{
    struct egl_x11_picture picture;
    if (!surface)
        return EGL_BAD_SURFACE;
    if (display->platform != EGL_PLATFORM_X11_KHR || !egl_x11_begin(&display->x11, &picture, pixmap))
        return EGL_BAD_NATIVE_PIXMAP;
    const bool fits = (EGLint)picture.size.width == surface->width &&
                      (EGLint)picture.size.height == surface->height &&
                      (picture.size.depth >= 24) == (surface->config->value[EGL_INDEX_RED_SIZE] == 8);
    EGLint error = !fits ? EGL_BAD_MATCH : EGL_SUCCESS;
    if (fits && !egl_surface_copy(surface, &picture))
        error = EGL_BAD_NATIVE_PIXMAP;
    egl_x11_end(&display->x11, &picture);
    return error;
}

EGLBoolean egl_CopyBuffers(EGLDisplay dpy, EGLSurface handle, EGLNativePixmapType pixmap)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    EGLint error = copy(display, egl_object_find(display, EGL_KIND_SURFACE, handle), (uint32_t)pixmap);
    egl_display_leave(display);
    return error == EGL_SUCCESS ? EGL_TRUE : (EGLBoolean)egl_fail(error);
}
