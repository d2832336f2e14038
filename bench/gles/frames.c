/* A library for LD_PRELOAD: a picture or the times of a program's frames, for programs of EGL as they are.
 * The renderer can be any: the library is in front of eglSwapBuffers.
 *
 *   FRAMES_PICTURE=FILE  writes the last frame as a PPM
 *   FRAMES_COUNT=N       the frames until the program is ended; 60 by default
 *
 * At the end it prints a line end, and as the programs for Windows do (bench/d3d9/programs/frames.h):
 *
 *   @frames N start MS first MS longest MS total MS
 *
 * start: from the start of the process to the end of the first frame; first: the second frame; longest and
 * total: of all after the first one. The clocks of the program show the frame's number: it is drawn 1/60 s
 * after the last one. So a frame is the same on every renderer. The renderers, whose libraries also read
 * clocks, get the same time.
 *
 * Programs find eglSwapBuffers through the linker, dlsym or eglGetProcAddress: all three lead here. */
#define _GNU_SOURCE
#include <EGL/egl.h>
#include <GLES2/gl2.h>
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { NANOSECONDS = 1000000000, ORIGIN_SECONDS = 1000000000 };

static long frames;
static double begun, previous, start, first, longest, total; /* milliseconds */

/* --- Functions of the libraries after this one --- */

static void *next_dlsym(void *handle, const char *name)
{
    static void *(*real)(void *, const char *);
    if (!real)
        real = dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.2.5");
    return real(handle, name);
}

static void *egl_function(const char *name)
{
    void *library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
    void *found = library ? next_dlsym(library, name) : NULL;
    if (found)
        return found;
    fprintf(stderr, "frames: %s: not found in libEGL.so.1\n", name);
    _exit(2);
}

static __eglMustCastToProperFunctionPointerType next_function(const char *name)
{
    static __eglMustCastToProperFunctionPointerType (*real)(const char *);
    if (!real)
        real = egl_function("eglGetProcAddress");
    return real(name);
}

/* --- Time --- */

static int64_t real_time(clockid_t clock)
{
    static int (*real)(clockid_t, struct timespec *);
    struct timespec now;
    if (!real)
        real = next_dlsym(RTLD_NEXT, "clock_gettime");
    real(clock, &now);
    return (int64_t)now.tv_sec * NANOSECONDS + now.tv_nsec;
}

static double milliseconds(void)
{
    return (double)real_time(CLOCK_MONOTONIC) / 1e6;
}

/* The time of the frame. Its origin is a constant: some programs draw by the absolute time. */
static int64_t frame_time(void)
{
    return (int64_t)ORIGIN_SECONDS * NANOSECONDS + frames * (NANOSECONDS / 60);
}

int clock_gettime(clockid_t clock, struct timespec *out)
{
    int64_t now = clock == CLOCK_MONOTONIC || clock == CLOCK_MONOTONIC_RAW || clock == CLOCK_REALTIME
                      ? frame_time()
                      : real_time(clock);
    *out = (struct timespec){now / NANOSECONDS, now % NANOSECONDS};
    return 0;
}

int gettimeofday(struct timeval *restrict out, void *restrict zone)
{
    (void)zone;
    int64_t now = frame_time();
    *out = (struct timeval){now / NANOSECONDS, now % NANOSECONDS / 1000};
    return 0;
}

__attribute__((constructor)) static void begin(void)
{
    begun = milliseconds();
}

/* --- The picture and the times --- */

static void write_picture(const char *path, const uint8_t *pixels, int width, int height)
{
    FILE *file = fopen(path, "wb");
    if (!file) {
        fprintf(stderr, "frames: %s: cannot be written\n", path);
        _exit(2);
    }
    fprintf(file, "P6\n%d %d\n255\n", width, height);
    for (int y = height - 1; y >= 0; y--) /* GL's first row is the bottom one */
        for (int x = 0; x < width; x++)
            fwrite(pixels + ((size_t)y * (size_t)width + (size_t)x) * 4, 1, 3, file);
    fclose(file);
}

static void take_picture(EGLDisplay display, EGLSurface surface, const char *path)
{
    EGLBoolean (*query)(EGLDisplay, EGLSurface, EGLint, EGLint *) = egl_function("eglQuerySurface");
    void (*bind)(GLenum, GLuint) = (void (*)(GLenum, GLuint))next_function("glBindFramebuffer");
    void (*read)(GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, void *) =
        (void (*)(GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, void *))next_function("glReadPixels");
    EGLint width = 0, height = 0;
    query(display, surface, EGL_WIDTH, &width);
    query(display, surface, EGL_HEIGHT, &height);
    uint8_t *pixels = calloc((size_t)width * (size_t)height + 1, 4);
    if (!pixels)
        _exit(2);
    bind(GL_FRAMEBUFFER, 0);
    read(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    write_picture(path, pixels, width, height);
    free(pixels);
}

static void measure(double now)
{
    double duration = now - previous;
    if (frames == 1)
        start = now - begun;
    if (frames == 2)
        first = duration;
    if (frames >= 2) {
        total += duration;
        longest = duration > longest ? duration : longest;
    }
    previous = now;
}

/* Ends the display, so that the renderer completes a recording, and the process, whatever its threads do. */
static void end(EGLDisplay display)
{
    EGLBoolean (*make)(EGLDisplay, EGLSurface, EGLSurface, EGLContext) = egl_function("eglMakeCurrent");
    EGLBoolean (*terminate)(EGLDisplay) = egl_function("eglTerminate");
    printf("\n@frames %ld start %.3f first %.3f longest %.3f total %.3f\n", frames, start, first, longest,
           total);
    fflush(stdout);
    make(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    terminate(display);
    _exit(0);
}

EGLBoolean eglSwapBuffers(EGLDisplay display, EGLSurface surface)
{
    static EGLBoolean (*real)(EGLDisplay, EGLSurface);
    const char *count = getenv("FRAMES_COUNT"), *path = getenv("FRAMES_PICTURE");
    long last = count ? atol(count) : 60;
    if (!real)
        real = egl_function("eglSwapBuffers");
    if (path && frames + 1 >= last)
        take_picture(display, surface, path);
    EGLBoolean done = real(display, surface);
    frames++;
    measure(milliseconds());
    if (frames >= last)
        end(display);
    return done;
}

/* --- The two other ways to a function --- */

__eglMustCastToProperFunctionPointerType eglGetProcAddress(const char *name)
{
    return strcmp(name, "eglSwapBuffers") ? next_function(name)
                                          : (__eglMustCastToProperFunctionPointerType)eglSwapBuffers;
}

void *dlsym(void *handle, const char *name)
{
    if (!strcmp(name, "eglSwapBuffers"))
        return (void *)eglSwapBuffers;
    if (!strcmp(name, "eglGetProcAddress"))
        return (void *)eglGetProcAddress;
    return next_dlsym(handle, name);
}
