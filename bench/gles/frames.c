/* A library for LD_PRELOAD: a picture or the times of a program's frames, for programs of EGL as they are.
 * The renderer can be any: the library is in front of eglSwapBuffers.
 *
 *   FRAMES_PICTURE=FILE  writes the last frame as a PPM
 *   FRAMES_COUNT=N       the frames until the program is ended; 60 by default
 *   FRAMES_FINISH=1      glFinish ends a frame, for programs that draw off-screen
 *   FRAMES_SOURCES=DIR   writes the sources of each linked program: N.vert and N.frag
 *   FRAMES_CLOCK=system  the clocks show the time, for programs that wait for it
 *
 * At the end it prints a line end, and as the programs for Windows do (bench/d3d9/programs/frames.h):
 *
 *   @frames N start MS first MS longest MS total MS cpu MS
 *
 * start: from the start of the process to the end of the first frame; first: the second frame; longest and
 * total: of all after the first one. cpu: the processor time of all threads in the same frames. The clocks
 * of the program show the frame's number: it is drawn 1/60 s after the last one. So a frame is the same on
 * every renderer. The renderers, whose libraries also read clocks, get the same time.
 *
 * Programs find eglSwapBuffers through the linker, dlsym or eglGetProcAddress: all three lead here. So do
 * swaps with damage. */
#define _GNU_SOURCE
#include <EGL/egl.h>
#include <GLES2/gl2.h>
#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { NANOSECONDS = 1000000000, ORIGIN_SECONDS = 1000000000 };

static long frames;
static double begun, previous, start, first, longest, total, spent, cpu; /* milliseconds */

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

static double milliseconds(clockid_t clock)
{
    return (double)real_time(clock) / 1e6;
}

static int is_system_clock(void)
{
    static int system_clock = -1;
    const char *clock = system_clock < 0 ? getenv("FRAMES_CLOCK") : NULL;
    if (system_clock < 0)
        system_clock = clock && !strcmp(clock, "system");
    return system_clock;
}

/* The time of the frame. Its origin is a constant: some programs draw by the absolute time. */
static int64_t frame_time(void)
{
    return (int64_t)ORIGIN_SECONDS * NANOSECONDS + frames * (NANOSECONDS / 60);
}

int clock_gettime(clockid_t clock, struct timespec *out)
{
    bool shown = clock == CLOCK_MONOTONIC || clock == CLOCK_MONOTONIC_RAW || clock == CLOCK_REALTIME;
    int64_t now = shown && !is_system_clock() ? frame_time() : real_time(clock);
    *out = (struct timespec){now / NANOSECONDS, now % NANOSECONDS};
    return 0;
}

int gettimeofday(struct timeval *restrict out, void *restrict zone)
{
    (void)zone;
    int64_t now = is_system_clock() ? real_time(CLOCK_REALTIME) : frame_time();
    *out = (struct timeval){now / NANOSECONDS, now % NANOSECONDS / 1000};
    return 0;
}

__attribute__((constructor)) static void begin(void)
{
    begun = milliseconds(CLOCK_MONOTONIC);
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

/* The picture of the surface, or of the framebuffer object that a program draws to off-screen. */
static void take_picture(EGLDisplay display, EGLSurface surface, bool window, const char *path)
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
    if (window)
        bind(GL_FRAMEBUFFER, 0);
    read(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    write_picture(path, pixels, width, height);
    free(pixels);
}

static void measure(double now)
{
    double duration = now - previous, processor = milliseconds(CLOCK_PROCESS_CPUTIME_ID);
    if (frames == 1) {
        start = now - begun;
        spent = processor;
    }
    cpu = processor - spent;
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
    printf("\n@frames %ld start %.3f first %.3f longest %.3f total %.3f cpu %.3f\n", frames, start, first,
           longest, total, cpu);
    fflush(stdout);
    make(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    terminate(display);
    _exit(0);
}

static long last_frame(void)
{
    const char *count = getenv("FRAMES_COUNT");
    return count ? atol(count) : 60;
}

static bool is_off_screen(void)
{
    return getenv("FRAMES_FINISH") != NULL;
}

/* Does nothing. A profiler finds the ends of frames by this function (bench/gles/profile.py). */
__attribute__((noinline)) void frames_ended(void)
{
    __asm__ volatile("");
}

static void before_end_of_frame(EGLDisplay display, EGLSurface surface)
{
    const char *path = getenv("FRAMES_PICTURE");
    if (path && frames + 1 >= last_frame())
        take_picture(display, surface, !is_off_screen(), path);
}

static void after_end_of_frame(EGLDisplay display)
{
    frames++;
    frames_ended();
    measure(milliseconds(CLOCK_MONOTONIC));
    if (frames >= last_frame())
        end(display);
}

EGLBoolean eglSwapBuffers(EGLDisplay display, EGLSurface surface)
{
    static EGLBoolean (*real)(EGLDisplay, EGLSurface);
    if (!real)
        real = egl_function("eglSwapBuffers");
    if (is_off_screen())
        return real(display, surface);
    before_end_of_frame(display, surface);
    EGLBoolean done = real(display, surface);
    after_end_of_frame(display);
    return done;
}

/* Of EGL_KHR_swap_buffers_with_damage, and the same of EXT. */
static EGLBoolean swap_with_damage(EGLDisplay display, EGLSurface surface, const EGLint *rects, EGLint count)
{
    typedef EGLBoolean function(EGLDisplay, EGLSurface, const EGLint *, EGLint);
    static function *real;
    if (!real)
        real = (function *)next_function("eglSwapBuffersWithDamageKHR");
    before_end_of_frame(display, surface);
    EGLBoolean done = real(display, surface, rects, count);
    after_end_of_frame(display);
    return done;
}

void glFinish(void)
{
    static void (*real)(void);
    EGLDisplay (*display)(void) = egl_function("eglGetCurrentDisplay");
    EGLSurface (*surface)(EGLint) = egl_function("eglGetCurrentSurface");
    if (!real)
        real = (void (*)(void))next_function("glFinish");
    if (is_off_screen())
        before_end_of_frame(display(), surface(EGL_DRAW));
    real();
    if (is_off_screen())
        after_end_of_frame(display());
}

/* --- Sources of programs --- */

static void write_source(const char *folder, unsigned number, GLuint shader)
{
    void (*get)(GLuint, GLenum, GLint *) = (void (*)(GLuint, GLenum, GLint *))next_function("glGetShaderiv");
    void (*source)(GLuint, GLsizei, GLsizei *, GLchar *) =
        (void (*)(GLuint, GLsizei, GLsizei *, GLchar *))next_function("glGetShaderSource");
    GLint type, bytes;
    char path[4096];
    get(shader, GL_SHADER_TYPE, &type);
    get(shader, GL_SHADER_SOURCE_LENGTH, &bytes);
    snprintf(path, sizeof path, "%s/%u.%s", folder, number, type == GL_VERTEX_SHADER ? "vert" : "frag");
    char *text = calloc((size_t)bytes + 1, 1);
    FILE *file = text ? fopen(path, "w") : NULL;
    if (!file) {
        fprintf(stderr, "frames: %s: cannot be written\n", path);
        _exit(2);
    }
    source(shader, bytes, NULL, text);
    fputs(text, file);
    fclose(file);
    free(text);
}

void glLinkProgram(GLuint program)
{
    static void (*real)(GLuint);
    static unsigned linked;
    const char *folder = getenv("FRAMES_SOURCES");
    void (*attached)(GLuint, GLsizei, GLsizei *, GLuint *) =
        (void (*)(GLuint, GLsizei, GLsizei *, GLuint *))next_function("glGetAttachedShaders");
    GLuint shaders[2];
    GLsizei count = 0;
    if (!real)
        real = (void (*)(GLuint))next_function("glLinkProgram");
    if (folder)
        attached(program, 2, &count, shaders);
    for (GLsizei i = 0; i < count; i++)
        write_source(folder, linked, shaders[i]);
    linked += count != 0;
    real(program);
}

/* --- The two other ways to a function --- */

/* Our function of the name, or null. */
static __eglMustCastToProperFunctionPointerType own_function(const char *name)
{
    typedef __eglMustCastToProperFunctionPointerType function;
    if (!strcmp(name, "eglSwapBuffersWithDamageKHR") || !strcmp(name, "eglSwapBuffersWithDamageEXT"))
        return next_function(name) ? (function)swap_with_damage : NULL;
    return !strcmp(name, "eglSwapBuffers")  ? (function)eglSwapBuffers
           : !strcmp(name, "glFinish")      ? (function)glFinish
           : !strcmp(name, "glLinkProgram") ? (function)glLinkProgram
                                            : NULL;
}

__eglMustCastToProperFunctionPointerType eglGetProcAddress(const char *name)
{
    __eglMustCastToProperFunctionPointerType own = own_function(name);
    return own ? own : next_function(name);
}

void *dlsym(void *handle, const char *name)
{
    if (!strcmp(name, "eglGetProcAddress"))
        return (void *)eglGetProcAddress;
    __eglMustCastToProperFunctionPointerType own = own_function(name);
    return own ? (void *)own : next_dlsym(handle, name);
}
