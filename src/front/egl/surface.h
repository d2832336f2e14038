/* Surfaces: windows, pixmaps and pbuffers. */
#ifndef EGL_SURFACE_H
#define EGL_SURFACE_H

#include "display.h"
#include "front/gl/context.h"

struct egl_thread;

struct egl_surface {
    struct egl_object object;
    struct gl_surface gl;
    const struct egl_config *config;
    EGLint kind;               /* EGL_WINDOW_BIT, EGL_PIXMAP_BIT or EGL_PBUFFER_BIT */
    struct egl_thread *thread; /* where it is current; null: nowhere */
    uint32_t drawable;         /* of X11 */
    struct egl_x11_picture picture;
    EGLint width, height; /* as the program gets them; images have at least one pixel */
    EGLint behavior, resolve, level;
    EGLint texture_format, texture_target, mipmap, largest;
    struct gl_image *texture; /* of a pbuffer with a texture's format: its colour; null: none */
    bool shown;               /* its contents are those of the last frame */
    bool aged;                /* the program has read the age of the buffer of this frame */
    bool has_limit;           /* and has limited the frame to a region */
};

/* Gives a window's surface the window's size. Returns false if the window does not exist. */
bool egl_surface_follow(struct egl_surface *);
/* The same with a size that the server has answered. */
bool egl_surface_fit(struct egl_surface *, const struct egl_x11_size *);
/* Shows a part of a surface in its window or pixmap, in the coordinates of GL. */
bool egl_surface_show(struct egl_surface *, const struct triptych_rectangle *part);
/* The same for the whole surface and another drawable of its size. */
bool egl_surface_copy(struct egl_surface *, struct egl_x11_picture *);
/* Reads the pixels of a pixmap into its surface. */
bool egl_surface_load(struct egl_surface *);

#endif
