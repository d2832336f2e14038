/* A context of OpenGL ES without EGL, with a default framebuffer in an image, on the emulator. */
#ifndef TESTS_SUPPORT_FRONT_GL_SCREEN_H
#define TESTS_SUPPORT_FRONT_GL_SCREEN_H

#include "front/gl/commands.h"

enum { SCREEN_WIDTH = 16, SCREEN_HEIGHT = 8 };

struct screen {
    struct gl_device *device;
    struct gl_context *context;
    struct gl_surface surface; /* RGBA8, depth of 24 bits and stencil of 8 */
    triptych_image *color, *depth;
};

/* Make a device, a surface and a bound context. Fail the test if they cannot. */
void screen_begin(struct screen *);
/* The same with a context of version 1.1. */
void screen_begin_1(struct screen *);
void screen_end(struct screen *);
/* The pixel as 0xRRGGBBAA. */
uint32_t screen_pixel(struct screen *, int x, int y);
/* The test fails unless the error is `code`. */
void screen_expect(struct screen *, GLenum code, int line);
#define EXPECT(code) screen_expect(&screen, code, __LINE__)
/* Compiles and links a program, and makes it current. Attribute 0 is "position". Fails the test with the
 * log if it cannot. */
GLuint screen_program(struct screen *, const char *vertex, const char *fragment);
/* Draws a rectangle in clip space with attribute 0, two triangles. */
void screen_rectangle(struct screen *, float left, float bottom, float right, float top, float z);

#endif
