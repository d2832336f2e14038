/* The renderer's device of a display, and its lock.
 *
 * All contexts and surfaces of a display have one device, so that a surface can be bound to contexts of
 * different share groups. The renderer's calls come from one thread at a time: the caller enters before and
 * leaves after. A thread can enter again while it is inside. */
#ifndef GL_DEVICE_H
#define GL_DEVICE_H

#include "front/common/statistics.h"
#include "triptych.h"

#include <pthread.h>
#include <stdbool.h>

struct gl_image;

struct gl_device {
    triptych_device *renderer;
    pthread_mutex_t lock; /* recursive */
    const void *last;     /* the context that set the renderer's state last; null: it is the renderer's own */
    struct front_statistics statistics;
    struct gl_image *images; /* those that OES_EGL_image finds (image.h) */
    unsigned image_changes;  /* how often an image was changed that textures have copies of */
    unsigned holders;        /* contexts, surfaces, displays */
    struct gl_device *next;
};

/* Creates a device with one holder. The engine and the threads are those of the environment: TRIPTYCH_ENGINE,
 * TRIPTYCH_THREADS. Reports the reason on standard error and returns null if it fails. At the end of the
 * process, devices that exist end their recordings and write their statistics. */
struct gl_device *gl_device_create(void);
/* Adds a holder; removes one, and destroys the device after the last. */
struct gl_device *gl_device_hold(struct gl_device *);
void gl_device_drop(struct gl_device *);

/* Locks the device for a context. Returns true if the renderer has the state of another context, so that the
 * context sets all of its own. Null: for a caller that changes no state. */
bool gl_device_enter(struct gl_device *, const void *context);
void gl_device_leave(struct gl_device *);
/* Makes every context set its state again, after a change of the renderer's state by a window system or by
 * the destruction of the context. */
void gl_device_forget(struct gl_device *);

#endif
