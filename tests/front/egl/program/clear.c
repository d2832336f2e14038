/* A program of EGL and OpenGL ES, which tests/gles.sh links with the libraries of libglvnd: it clears a
 * pbuffer, or with the argument "window" a window of X11, and prints what it reads. With "killed" it
 * draws more frames and does not reach its end. */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES2/gl2.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 40, HEIGHT = 30, FRAMES = 12000 };

static Display *x;

static EGLDisplay find_display(int window)
{
    if (!window)
        return eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    x = XOpenDisplay(NULL);
    return eglGetPlatformDisplay(EGL_PLATFORM_X11_KHR, x, NULL);
}

static Window make_window(void)
{
    Window window = XCreateSimpleWindow(x, DefaultRootWindow(x), 0, 0, WIDTH, HEIGHT, 0, 0, 0);
    XSelectInput(x, window, ExposureMask);
    XMapWindow(x, window);
    for (XEvent event = {0}; event.type != Expose;)
        XNextEvent(x, &event);
    return window;
}

static EGLConfig choose(EGLDisplay display, int window)
{
    const EGLint list[] = {EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_ES2_BIT,
                           EGL_SURFACE_TYPE,
                           window ? EGL_WINDOW_BIT : EGL_PBUFFER_BIT,
                           EGL_RED_SIZE,
                           8,
                           EGL_NONE};
    EGLConfig config = NULL;
    EGLint count = 0;
    eglChooseConfig(display, list, &config, 1, &count);
    return config;
}

static void print_window(Window window)
{
    XImage *image = XGetImage(x, window, 0, 0, WIDTH, HEIGHT, AllPlanes, ZPixmap);
    printf("top %06lx bottom %06lx\n", XGetPixel(image, 5, 2) & 0xffffff,
           XGetPixel(image, 5, HEIGHT - 3) & 0xffffff);
    XDestroyImage(image);
}

static void grow(Window window)
{
    XResizeWindow(x, window, 2 * WIDTH, 2 * HEIGHT);
    XSync(x, 0);
}

static void draw(void)
{
    glDisable(GL_SCISSOR_TEST);
    glClearColor(1, 0.5f, 0.25f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, WIDTH, 10);
    glClearColor(0, 0, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

static void print_pixels(GLint height)
{
    unsigned char high[4] = {0}, low[4] = {0};
    glReadPixels(5, height - 3, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, high);
    glReadPixels(5, height - HEIGHT + 2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, low);
    printf("pixels %02x%02x%02x %02x%02x%02x\n", high[0], high[1], high[2], low[0], low[1], low[2]);
}

/* The region of a frame, before its age is known and after. */
static void print_regions(EGLDisplay display, EGLSurface surface)
{
    PFNEGLSETDAMAGEREGIONKHRPROC limit =
        (PFNEGLSETDAMAGEREGIONKHRPROC)eglGetProcAddress("eglSetDamageRegionKHR");
    EGLint age = -1, region[] = {0, 0, 8, 8};
    const unsigned before = limit(display, surface, region, 1), error = (unsigned)eglGetError();
    eglQuerySurface(display, surface, EGL_BUFFER_AGE_KHR, &age);
    const unsigned after = limit(display, surface, region, 1), twice = limit(display, surface, region, 1);
    printf("regions %u %x age %d %u %u %x\n", before, error, age, after, twice, (unsigned)eglGetError());
}

static void print_sync(EGLDisplay display)
{
    PFNEGLCREATESYNCKHRPROC create = (PFNEGLCREATESYNCKHRPROC)eglGetProcAddress("eglCreateSyncKHR");
    PFNEGLCLIENTWAITSYNCKHRPROC wait = (PFNEGLCLIENTWAITSYNCKHRPROC)eglGetProcAddress("eglClientWaitSyncKHR");
    EGLSyncKHR sync = create(display, EGL_SYNC_FENCE_KHR, NULL);
    printf("sync %x\n", (unsigned)wait(display, sync, 0, EGL_FOREVER_KHR));
}

/* Frames that fill a chunk of a recording, which is written when it is full. */
static void die_after_frames(EGLDisplay display, EGLSurface surface)
{
    for (int frame = 0; frame < FRAMES; frame++) {
        draw();
        eglSwapBuffers(display, surface);
    }
    raise(SIGKILL);
}

int main(int count, char **argument)
{
    const int window = count > 1 && !strcmp(argument[1], "window");
    const EGLint size[] = {EGL_WIDTH, WIDTH, EGL_HEIGHT, HEIGHT, EGL_NONE},
                 two[] = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
    EGLDisplay display = find_display(window);
    if (!eglInitialize(display, NULL, NULL))
        return 1;
    printf("vendor %s\n", eglQueryString(display, EGL_VENDOR));
    EGLConfig config = choose(display, window);
    Window shown = window ? make_window() : 0;
    EGLSurface surface = window ? eglCreateWindowSurface(display, config, shown, NULL)
                                : eglCreatePbufferSurface(display, config, size);
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, two);
    if (!eglMakeCurrent(display, surface, surface, context))
        return 1;
    printf("version %.13s\n", (const char *)glGetString(GL_VERSION));
    draw();
    print_pixels(HEIGHT);
    print_sync(display);
    eglSwapBuffers(display, surface);
    if (window) {
        EGLint width = 0, height = 0;
        print_window(shown);
        print_regions(display, surface);
        eglSurfaceAttrib(display, surface, EGL_SWAP_BEHAVIOR, EGL_BUFFER_PRESERVED);
        grow(shown);
        eglSwapBuffers(display, surface);
        eglQuerySurface(display, surface, EGL_WIDTH, &width);
        eglQuerySurface(display, surface, EGL_HEIGHT, &height);
        printf("grown %dx%d\n", width, height);
        print_pixels(height);
    }
    printf("error %x\n", (unsigned)eglGetError());
    if (count > 1 && !strcmp(argument[1], "killed"))
        die_after_frames(display, surface);
    eglTerminate(display);
    return 0;
}
