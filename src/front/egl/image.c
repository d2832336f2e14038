/* Images: texels of an object of OpenGL ES that other contexts and objects have too (front/gl/image.h). */
#include "attributes.h"
#include "calls.h"
#include "current.h"
#include "front/gl/image.h"

struct egl_image {
    struct egl_object object;
    struct gl_device *device; /* held */
    struct gl_image *image;
};

static void free_image(struct egl_object *object)
{
    struct egl_image *image = (struct egl_image *)object;
    gl_image_drop(image->image);
    gl_device_drop(image->device);
}

/* The target of OpenGL ES; 0 for one of EGL that does not exist. */
static GLenum target_of(EGLenum target)
{
    if (target == EGL_GL_TEXTURE_2D)
        return GL_TEXTURE_2D;
    if (target == EGL_GL_RENDERBUFFER)
        return GL_RENDERBUFFER;
    return target >= EGL_GL_TEXTURE_CUBE_MAP_POSITIVE_X && target <= EGL_GL_TEXTURE_CUBE_MAP_NEGATIVE_Z
               ? GL_TEXTURE_CUBE_MAP_POSITIVE_X + (target - EGL_GL_TEXTURE_CUBE_MAP_POSITIVE_X)
               : 0;
}

/* Texels are always preserved. */
static EGLint read_attributes(GLenum target, const EGLAttrib *list, GLint *level)
{
    *level = 0;
    for (; list && *list != EGL_NONE; list += 2)
        if (list[0] == EGL_GL_TEXTURE_LEVEL && target != GL_RENDERBUFFER)
            *level = (GLint)list[1];
        else if (list[0] != EGL_IMAGE_PRESERVED || (list[1] != EGL_TRUE && list[1] != EGL_FALSE))
            return EGL_BAD_PARAMETER;
    return EGL_SUCCESS;
}

static EGLint error_of(enum gl_image_result result)
{
    switch (result) {
    case GL_IMAGE_MADE: return EGL_SUCCESS;
    case GL_IMAGE_NO_LEVEL: return EGL_BAD_MATCH;
    case GL_IMAGE_IN_USE: return EGL_BAD_ACCESS;
    case GL_IMAGE_NO_MEMORY: return EGL_BAD_ALLOC;
    default: return EGL_BAD_PARAMETER;
    }
}

static EGLImage make(struct egl_display *display, struct egl_context *context, GLenum target, GLuint name,
                     GLint level)
{
    struct egl_image *image = egl_object_make(display, EGL_KIND_IMAGE, sizeof *image, free_image);
    enum gl_image_result result;
    if (!image)
        return EGL_NO_IMAGE;
    image->device = gl_device_hold(display->device);
    image->image = gl_image_of_object(context->gl, target, name, level, image, &result);
    if (image->image)
        return image;
    egl_object_destroy(&image->object);
    return egl_fail(error_of(result)), EGL_NO_IMAGE;
}

static EGLImage create(struct egl_display *display, EGLContext handle, EGLenum egl_target,
                       EGLClientBuffer buffer, const EGLAttrib *list)
{
    struct egl_context *context = egl_object_find(display, EGL_KIND_CONTEXT, handle);
    const GLenum target = target_of(egl_target);
    GLint level = 0;
    EGLint error = read_attributes(target, list, &level);
    if (handle != EGL_NO_CONTEXT && !context)
        error = EGL_BAD_CONTEXT;
    else if (!target)
        error = EGL_BAD_PARAMETER;
    else if (!context)
        error = EGL_BAD_CONTEXT;
    else if ((uintptr_t)buffer > UINT32_MAX || !buffer)
        error = EGL_BAD_PARAMETER;
    if (error != EGL_SUCCESS)
        return egl_fail(error), EGL_NO_IMAGE;
    return make(display, context, target, (GLuint)(uintptr_t)buffer, level);
}

EGLImage egl_CreateImage(EGLDisplay dpy, EGLContext context, EGLenum target, EGLClientBuffer buffer,
                         const EGLAttrib *list)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_NO_IMAGE;
    EGLImage image = create(display, context, target, buffer, list);
    egl_display_leave(display);
    return image;
}

EGLImageKHR egl_CreateImageKHR(EGLDisplay dpy, EGLContext context, EGLenum target, EGLClientBuffer buffer,
                               const EGLint *words)
{
    struct egl_list list;
    return egl_CreateImage(dpy, context, target, buffer, egl_list_widen(&list, words));
}

/* Objects that have the image keep it. */
EGLBoolean egl_DestroyImage(EGLDisplay dpy, EGLImage handle)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    struct egl_image *image = egl_object_find(display, EGL_KIND_IMAGE, handle);
    if (image)
        egl_object_destroy(&image->object);
    else
        egl_fail(EGL_BAD_PARAMETER);
    egl_display_leave(display);
    return image != NULL;
}
