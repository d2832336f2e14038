/* The attributes of surfaces, and their end. */
#include "calls.h"
#include "surface.h"
#include "thread.h"

EGLBoolean egl_DestroySurface(EGLDisplay dpy, EGLSurface handle)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    struct egl_surface *surface = egl_object_find(display, EGL_KIND_SURFACE, handle);
    if (surface)
        egl_object_destroy(&surface->object);
    else
        egl_fail(EGL_BAD_SURFACE);
    egl_display_leave(display);
    return surface != NULL;
}

/* The buffer is the last frame's, because a surface has one image. The age is defined for the surface that
 * the thread draws to. */
static EGLBoolean query_age(struct egl_surface *surface, EGLint *value)
{
    if (egl_thread_current()->draw != surface)
        return egl_fail(EGL_BAD_SURFACE);
    *value = surface->shown ? 1 : 0;
    surface->aged = true;
    return EGL_TRUE;
}

/* Attributes of pbuffers: other surfaces leave the value as it is. */
static void query_pbuffer(const struct egl_surface *surface, EGLint name, EGLint *value)
{
    if (surface->kind != EGL_PBUFFER_BIT)
        return;
    *value = name == EGL_LARGEST_PBUFFER  ? surface->largest
             : name == EGL_TEXTURE_FORMAT ? surface->texture_format
             : name == EGL_TEXTURE_TARGET ? surface->texture_target
             : name == EGL_MIPMAP_TEXTURE ? surface->mipmap
                                          : surface->level;
}

static EGLBoolean query(struct egl_surface *surface, EGLint name, EGLint *value)
{
    switch (name) {
    case EGL_WIDTH: *value = surface->width; break;
    case EGL_HEIGHT: *value = surface->height; break;
    case EGL_CONFIG_ID: *value = surface->config->value[EGL_INDEX_CONFIG_ID]; break;
    case EGL_SWAP_BEHAVIOR: *value = surface->behavior; break;
    case EGL_MULTISAMPLE_RESOLVE: *value = surface->resolve; break;
    case EGL_RENDER_BUFFER: *value = surface->gl.single ? EGL_SINGLE_BUFFER : EGL_BACK_BUFFER; break;
    case EGL_GL_COLORSPACE: *value = EGL_GL_COLORSPACE_LINEAR; break;
    case EGL_VG_COLORSPACE: *value = EGL_VG_COLORSPACE_sRGB; break;
    case EGL_VG_ALPHA_FORMAT: *value = EGL_VG_ALPHA_FORMAT_NONPRE; break;
    case EGL_PIXEL_ASPECT_RATIO: *value = EGL_DISPLAY_SCALING; break;
    case EGL_HORIZONTAL_RESOLUTION:
    case EGL_VERTICAL_RESOLUTION: *value = EGL_UNKNOWN; break;
    case EGL_BUFFER_AGE_EXT: return query_age(surface, value);
    case EGL_LARGEST_PBUFFER:
    case EGL_TEXTURE_FORMAT:
    case EGL_TEXTURE_TARGET:
    case EGL_MIPMAP_TEXTURE:
    case EGL_MIPMAP_LEVEL: query_pbuffer(surface, name, value); break;
    default: return egl_fail(EGL_BAD_ATTRIBUTE);
    }
    return EGL_TRUE;
}

EGLBoolean egl_QuerySurface(EGLDisplay dpy, EGLSurface handle, EGLint name, EGLint *value)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    struct egl_surface *surface = egl_object_find(display, EGL_KIND_SURFACE, handle);
    EGLBoolean result;
    if (!surface)
        result = egl_fail(EGL_BAD_SURFACE);
    else
        result = value ? query(surface, name, value) : (EGLBoolean)egl_fail(EGL_BAD_PARAMETER);
    egl_display_leave(display);
    return result;
}

static EGLint set_behavior(struct egl_surface *surface, EGLint value)
{
    const EGLint types = surface->config->value[EGL_INDEX_SURFACE_TYPE];
    if (value != EGL_BUFFER_PRESERVED && value != EGL_BUFFER_DESTROYED)
        return EGL_BAD_PARAMETER;
    if (value == EGL_BUFFER_PRESERVED && !(types & EGL_SWAP_BEHAVIOR_PRESERVED_BIT))
        return EGL_BAD_MATCH;
    surface->behavior = value;
    return EGL_SUCCESS;
}

/* No config has EGL_MULTISAMPLE_RESOLVE_BOX_BIT. */
static EGLint set_resolve(struct egl_surface *surface, EGLint value)
{
    const EGLint types = surface->config->value[EGL_INDEX_SURFACE_TYPE];
    if (value != EGL_MULTISAMPLE_RESOLVE_DEFAULT && value != EGL_MULTISAMPLE_RESOLVE_BOX)
        return EGL_BAD_PARAMETER;
    if (value == EGL_MULTISAMPLE_RESOLVE_BOX && !(types & EGL_MULTISAMPLE_RESOLVE_BOX_BIT))
        return EGL_BAD_MATCH;
    surface->resolve = value;
    return EGL_SUCCESS;
}

static EGLint set(struct egl_surface *surface, EGLint name, EGLint value)
{
    switch (name) {
    case EGL_SWAP_BEHAVIOR: return set_behavior(surface, value);
    case EGL_MULTISAMPLE_RESOLVE: return set_resolve(surface, value);
    case EGL_MIPMAP_LEVEL: surface->level = value; return EGL_SUCCESS;
    default: return EGL_BAD_ATTRIBUTE;
    }
}

EGLBoolean egl_SurfaceAttrib(EGLDisplay dpy, EGLSurface handle, EGLint name, EGLint value)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    struct egl_surface *surface = egl_object_find(display, EGL_KIND_SURFACE, handle);
    EGLint error = surface ? set(surface, name, value) : EGL_BAD_SURFACE;
    egl_display_leave(display);
    return error == EGL_SUCCESS ? EGL_TRUE : (EGLBoolean)egl_fail(error);
}
