/* The processor time that a program of OpenGL ES 2 takes from its source to machine code:
 *
 *   compile FOLDER N    the programs 0 to N - 1: FOLDER/I.vert and FOLDER/I.frag (FRAMES_SOURCES of frames.c)
 *
 * Renderers generate code when it is needed, so the time includes the first draw. It is that of two calls of
 * glCompileShader, of glLinkProgram, and of a first draw with glFinish, less that of a second draw. Sources
 * are compiled once: renderers have a cache. The draw is one small triangle with constant attributes.
 *
 * Prints a line for each program: "I compile MS link MS first MS second MS". A program that does not compile
 * ends this one with 2. */
#define EGL_EGLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES2/gl2.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SIDE = 16 };

static double milliseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec / 1e6;
}

static _Noreturn void fail(const char *what, const char *why)
{
    fprintf(stderr, "compile: %s: %s\n", what, why);
    exit(2);
}

/* --- A context without a window --- */

static void make_context(void)
{
    static const EGLint attributes[] = {EGL_SURFACE_TYPE,
                                        EGL_PBUFFER_BIT,
                                        EGL_RENDERABLE_TYPE,
                                        EGL_OPENGL_ES2_BIT,
                                        EGL_RED_SIZE,
                                        8,
                                        EGL_DEPTH_SIZE,
                                        24,
                                        EGL_NONE};
    static const EGLint size[] = {EGL_WIDTH, SIDE, EGL_HEIGHT, SIDE, EGL_NONE};
    static const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    EGLConfig config = NULL;
    EGLint count = 0;
    if (!eglInitialize(display, NULL, NULL) || !eglChooseConfig(display, attributes, &config, 1, &count) ||
        !count)
        fail("EGL", "found no config of OpenGL ES 2 without a window");
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    EGLSurface surface = eglCreatePbufferSurface(display, config, size);
    if (!eglMakeCurrent(display, surface, surface, context))
        fail("EGL", "found no context of OpenGL ES 2");
}

/* All units have a texture of one texel, of both types. */
static void make_textures(void)
{
    static const uint8_t texel[4] = {128, 128, 255, 255};
    GLuint textures[2];
    for (GLenum unit = 0; unit < 8; unit++) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glGenTextures(2, textures);
        glBindTexture(GL_TEXTURE_2D, textures[0]);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, texel);
        glBindTexture(GL_TEXTURE_CUBE_MAP, textures[1]);
        for (GLenum face = 0; face < 6; face++)
            glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA, 1, 1, 0, GL_RGBA,
                         GL_UNSIGNED_BYTE, texel);
    }
}

/* --- A program --- */

static char *read_source(const char *folder, unsigned number, const char *ending)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%u.%s", folder, number, ending);
    FILE *file = fopen(path, "r");
    char *text = calloc(1, 1 << 20);
    if (!file || !text || !fread(text, 1, (1 << 20) - 1, file))
        fail(path, "cannot be read");
    fclose(file);
    return text;
}

static GLuint compile(GLenum type, const char *source)
{
    GLuint shader = glCreateShader(type);
    GLint done;
    glShaderSource(shader, 1, &source, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (!done)
        fail(source, "does not compile");
    return shader;
}

static GLuint link(GLuint vertex, GLuint fragment)
{
    GLuint program = glCreateProgram();
    GLint done;
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &done);
    if (!done)
        fail("a program", "does not link");
    return program;
}

/* Attribute 0 is the triangle, whatever the program makes of it. */
static double draw(void)
{
    static const float triangle[3][4] = {{-1, -1, 0, 1}, {1, -1, 0, 1}, {0, 1, 0, 1}};
    double begin = milliseconds();
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, triangle);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glFinish();
    return milliseconds() - begin;
}

static void measure(const char *folder, unsigned number)
{
    char *vertex = read_source(folder, number, "vert"), *fragment = read_source(folder, number, "frag");
    double begin = milliseconds();
    GLuint shaders[] = {compile(GL_VERTEX_SHADER, vertex), compile(GL_FRAGMENT_SHADER, fragment)};
    double compiled = milliseconds();
    GLuint program = link(shaders[0], shaders[1]);
    double linked = milliseconds();
    glUseProgram(program);
    double first = draw(), second = draw();
    printf("%u compile %.4f link %.4f first %.4f second %.4f\n", number, compiled - begin, linked - compiled,
           first, second);
    free(vertex);
    free(fragment);
}

int main(int count, char **arguments)
{
    if (count != 3) {
        fprintf(stderr, "usage: compile FOLDER N\n");
        return 2;
    }
    make_context();
    make_textures();
    glViewport(0, 0, SIDE, SIDE);
    for (unsigned i = 0; i < (unsigned)atoi(arguments[2]); i++)
        measure(arguments[1], i);
    return 0;
}
