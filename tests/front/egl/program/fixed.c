/* A program of EGL and OpenGL ES 1.1, which tests/gles.sh links with the libraries of libglvnd. It draws
 * a lit square, a paletted texture and an inverted rectangle into a pbuffer, and prints what it reads. */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES/gl.h>
#include <stdio.h>

enum { WIDTH = 40, HEIGHT = 30 };

static EGLDisplay begin(void)
{
    static const EGLint config_list[] = {EGL_RENDERABLE_TYPE,
                                         EGL_OPENGL_ES_BIT,
                                         EGL_SURFACE_TYPE,
                                         EGL_PBUFFER_BIT,
                                         EGL_RED_SIZE,
                                         8,
                                         EGL_NONE},
                        surface_list[] = {EGL_WIDTH, WIDTH, EGL_HEIGHT, HEIGHT, EGL_NONE},
                        context_list[] = {EGL_CONTEXT_CLIENT_VERSION, 1, EGL_NONE};
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    EGLConfig config;
    EGLint count;
    if (!eglInitialize(display, NULL, NULL) || !eglChooseConfig(display, config_list, &config, 1, &count) ||
        !count)
        return EGL_NO_DISPLAY;
    EGLSurface surface = eglCreatePbufferSurface(display, config, surface_list);
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_list);
    return eglMakeCurrent(display, surface, surface, context) ? display : EGL_NO_DISPLAY;
}

static void rectangle(GLfloat left, GLfloat right)
{
    const GLfloat corners[] = {left, -1, right, -1, left, 1, right, 1};
    glVertexPointer(2, GL_FLOAT, 0, corners);
    glEnableClientState(GL_VERTEX_ARRAY);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

/* A light from the right of a square that faces the viewer, by 60 degrees: half of its colour. */
static void draw_lit(void)
{
    static const GLfloat place[] = {0.8660254F, 0, 0.5F, 0}, color[] = {1, 0.5F, 0, 1},
                         black[] = {0, 0, 0, 1};
    glLightfv(GL_LIGHT0, GL_POSITION, place);
    glMaterialfv(GL_FRONT_AND_BACK, GL_DIFFUSE, color);
    glMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT, black);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    rectangle(-1, 0);
    glDisable(GL_LIGHTING);
}

static void draw_textured(void)
{
    static const unsigned char image[16 * 3 + 1] = {[3 * 5] = 0x11, 0x22, 0x33, [48] = 0x50};
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glCompressedTexImage2D(GL_TEXTURE_2D, 0, GL_PALETTE4_RGB8_OES, 1, 1, 0, sizeof image, image);
    glEnable(GL_TEXTURE_2D);
    rectangle(0, 1);
    glDisable(GL_TEXTURE_2D);
}

static void invert(void)
{
    glEnable(GL_COLOR_LOGIC_OP);
    glLogicOp(GL_INVERT);
    rectangle(0.5F, 1);
    glDisable(GL_COLOR_LOGIC_OP);
}

static void print_pixel(int x)
{
    unsigned char pixel[4];
    glReadPixels(x, HEIGHT / 2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    printf(" %02x%02x%02x", pixel[0], pixel[1], pixel[2]);
}

int main(void)
{
    EGLDisplay display = begin();
    if (!display)
        return printf("no context: error %x\n", (unsigned)eglGetError()), 1;
    printf("version %s\npixels", (const char *)glGetString(GL_VERSION));
    draw_lit();
    draw_textured();
    invert();
    print_pixel(5);
    print_pixel(25);
    print_pixel(35);
    printf("\nerror %x\n", (unsigned)glGetError());
    eglTerminate(display);
    return 0;
}
