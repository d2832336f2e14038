#include "thread.h"

#include "current.h"

#include <pthread.h>

static _Thread_local struct egl_thread state;
static pthread_key_t ends;

/* The state of a thread that ends exists until its last destructor returns. */
static void end(void *thread)
{
    egl_current_release(thread);
}

static void make_key(void)
{
    pthread_key_create(&ends, end);
}

struct egl_thread *egl_thread_current(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    if (!state.error) {
        pthread_once(&once, make_key);
        pthread_setspecific(ends, &state);
        state.error = EGL_SUCCESS;
    }
    return &state;
}

int egl_fail(EGLint error)
{
    egl_thread_current()->error = error;
    return 0;
}

void egl_succeed(void)
{
    egl_thread_current()->error = EGL_SUCCESS;
}

EGLint egl_GetError(void)
{
    EGLint error = egl_thread_current()->error;
    egl_succeed();
    return error;
}

/* --- The client interface: only OpenGL ES --- */

EGLBoolean egl_BindAPI(EGLenum api)
{
    egl_succeed();
    return api == EGL_OPENGL_ES_API ? EGL_TRUE : (EGLBoolean)egl_fail(EGL_BAD_PARAMETER);
}

EGLenum egl_QueryAPI(void)
{
    egl_succeed();
    return EGL_OPENGL_ES_API;
}
