/* The state of EGL in each thread: the error, and what is current. */
#ifndef EGL_THREAD_H
#define EGL_THREAD_H

#include "types.h"

struct egl_context;
struct egl_surface;

struct egl_thread {
    EGLint error;
    struct egl_context *context;
    struct egl_surface *draw, *read; /* null: none */
};

/* The thread's state. It is released when the thread ends. */
struct egl_thread *egl_thread_current(void);

/* Sets the error of the thread, and returns 0 for the result of the function that fails. */
int egl_fail(EGLint error);
/* Clears it. */
void egl_succeed(void);

#endif
