/* A display without a window system, and what the tests of EGL share. */
#ifndef TEST_EGL_DISPLAY_H
#define TEST_EGL_DISPLAY_H

#include "front/egl/calls.h"
#include <stdlib.h>
#include <unity.h>

static EGLDisplay dpy;

static inline void begin_display(void)
{
    setenv("TRIPTYCH_ENGINE", "emulate", 1);
    setenv("TRIPTYCH_THREADS", "1", 1);
    dpy = egl_GetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL);
    TEST_ASSERT_NOT_NULL(dpy);
    TEST_ASSERT_TRUE(egl_Initialize(dpy, NULL, NULL));
}

static inline void end_display(void)
{
    egl_ReleaseThread();
    egl_Terminate(dpy);
}

/* The call fails with the error, which is then cleared. */
#define FAILS(error, call)                                                                                   \
    do {                                                                                                     \
        TEST_ASSERT_FALSE(call);                                                                             \
        TEST_ASSERT_EQUAL_HEX(error, egl_GetError());                                                        \
        TEST_ASSERT_EQUAL_HEX(EGL_SUCCESS, egl_GetError());                                                  \
    } while (0)

/* The first config for OpenGL ES 2 and pbuffers that the attributes select, which can be null. */
static inline EGLConfig config_with(EGLint name, EGLint value)
{
    const EGLint list[] = {
        EGL_RENDERABLE_TYPE, EGL_OPENGL_ES2_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, name, value, EGL_NONE};
    EGLConfig config = NULL;
    EGLint count = 0;
    TEST_ASSERT_TRUE(egl_ChooseConfig(dpy, list, &config, 1, &count));
    TEST_ASSERT_EQUAL_INT(1, count);
    return config;
}

static inline EGLint attribute(EGLConfig config, EGLint name)
{
    EGLint value = -1;
    TEST_ASSERT_TRUE(egl_GetConfigAttrib(dpy, config, name, &value));
    return value;
}

static inline EGLContext context_of(EGLConfig config, EGLContext share)
{
    const EGLint list[] = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
    EGLContext context = egl_CreateContext(dpy, config, share, list);
    TEST_ASSERT_NOT_NULL(context);
    return context;
}

static inline EGLSurface pbuffer_of(EGLConfig config, EGLint width, EGLint height)
{
    const EGLint list[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    EGLSurface surface = egl_CreatePbufferSurface(dpy, config, list);
    TEST_ASSERT_NOT_NULL(surface);
    return surface;
}

#endif
