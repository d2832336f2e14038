/* Pbuffers as textures: eglBindTexImage. */
#include "calls.h"
#include "current.h"
#include "front/gl/image.h"
#include "surface.h"

/* Finds a surface whose colour textures can get. */
static EGLint find(struct egl_display *display, EGLSurface handle, EGLint buffer, struct egl_surface **found)
{
    *found = egl_object_find(display, EGL_KIND_SURFACE, handle);
    if (!*found || (*found)->kind != EGL_PBUFFER_BIT)
        return EGL_BAD_SURFACE;
    if (buffer != EGL_BACK_BUFFER)
        return EGL_BAD_PARAMETER;
    return (*found)->texture ? EGL_SUCCESS : EGL_BAD_MATCH;
}

/* Without a current context there is no texture. */
static EGLint bind(struct egl_surface *surface)
{
    const struct egl_context *context = egl_thread_current()->context;
    if (gl_image_is_bound(surface->texture))
        return EGL_BAD_ACCESS;
    if (context && context->object.display == surface->object.display)
        gl_image_bind(context->gl, surface->texture);
    return EGL_SUCCESS;
}

static EGLint unbind(struct egl_surface *surface)
{
    gl_image_unbind(surface->texture);
    return EGL_SUCCESS;
}

static EGLBoolean change(EGLDisplay dpy, EGLSurface handle, EGLint buffer,
                         EGLint (*make)(struct egl_surface *))
{
    struct egl_surface *surface;
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    EGLint error = find(display, handle, buffer, &surface);
    if (error == EGL_SUCCESS)
        error = make(surface);
    egl_display_leave(display);
    return error == EGL_SUCCESS ? EGL_TRUE : (EGLBoolean)egl_fail(error);
}

EGLBoolean egl_BindTexImage(EGLDisplay dpy, EGLSurface surface, EGLint buffer)
{
    return change(dpy, surface, buffer, bind);
}

EGLBoolean egl_ReleaseTexImage(EGLDisplay dpy, EGLSurface surface, EGLint buffer)
{
    return change(dpy, surface, buffer, unbind);
}
