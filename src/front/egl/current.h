/* Contexts, and what is current. */
#ifndef EGL_CURRENT_H
#define EGL_CURRENT_H

#include "display.h"
#include "front/gl/context.h"
#include "thread.h"

struct egl_context {
    struct egl_object object;
    struct gl_context *gl;
    struct gl_device *device;        /* held */
    const struct egl_config *config; /* null: none */
    enum gl_interface interface;
    EGLint version;            /* of the client interface, as it was requested */
    EGLint reset;              /* EGL_NO_RESET_NOTIFICATION or EGL_LOSE_CONTEXT_ON_RESET */
    struct egl_thread *thread; /* where it is current; null: nowhere */
};

/* Unbinds what is current in a thread. */
void egl_current_release(struct egl_thread *);

#endif
