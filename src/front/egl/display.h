/* Displays, and what belongs to them: configs, contexts, surfaces, syncs, images.
 *
 * A handle of EGL is the address of its object. Functions check handles against the list of the display, so a
 * handle that does not exist is an error and is not read. Each function of a display holds its lock. */
#ifndef EGL_DISPLAY_H
#define EGL_DISPLAY_H

#include "config.h"
#include "front/gl/device.h"
#include "types.h"
#include "x11/x11.h"

#include <pthread.h>
#include <stdbool.h>

enum egl_kind { EGL_KIND_CONTEXT, EGL_KIND_SURFACE, EGL_KIND_SYNC, EGL_KIND_IMAGE };

/* The head of a context, a surface, a sync or an image. */
struct egl_object {
    struct egl_object *next; /* of the display, while the program has not destroyed the object */
    struct egl_display *display;
    enum egl_kind kind;
    bool destroyed;
    unsigned uses; /* being current, and waiting: the object is freed without uses */
    void (*free)(struct egl_object *);
};

struct egl_display {
    struct egl_display *next;
    EGLenum platform;     /* EGL_PLATFORM_X11_KHR, EGL_PLATFORM_DEVICE_EXT or EGL_PLATFORM_SURFACELESS_MESA */
    void *native;         /* what identifies it with the platform */
    bool is_xcb;          /* a connection of xcb */
    EGLint screen;        /* negative: the default one */
    pthread_mutex_t lock; /* recursive */
    pthread_cond_t changed; /* a reusable sync */
    bool initialized;
    struct gl_device *device; /* while it is initialized */
    struct egl_x11 x11;       /* of X11, while it is initialized */
    struct egl_object *objects;
    unsigned configs;
    struct egl_config config[EGL_CONFIGS];
};

/* Locks an initialized display and clears the thread's error. Null, after an error, if there is none. */
struct egl_display *egl_display_enter(EGLDisplay dpy);
void egl_display_leave(struct egl_display *);
/* Finds a display, which need not be initialized; null, without an error, if there is none. */
struct egl_display *egl_display_find(EGLDisplay dpy);

/* Adds an object of `bytes` bytes, initially 0. Null, after an error, without memory. */
void *egl_object_make(struct egl_display *, enum egl_kind, size_t bytes, void (*free)(struct egl_object *));
/* Finds an object that the program has not destroyed. Null, without an error, if there is none. */
void *egl_object_find(struct egl_display *, enum egl_kind, const void *handle);
/* Removes the object from its display. It is freed when nothing uses it. */
void egl_object_destroy(struct egl_object *);
/* Ends a use. */
void egl_object_release(struct egl_object *);

#endif
