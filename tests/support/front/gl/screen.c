#include "tests/support/front/gl/screen.h"

#include <stdlib.h>
#include <unity.h>

static triptych_image *make_image(struct screen *screen, enum triptych_surface_format format,
                                  enum triptych_depth_format depth)
{
    struct triptych_image_description description = {.format = format,
                                                     .depth_format = depth,
                                                     .width = SCREEN_WIDTH,
                                                     .height = SCREEN_HEIGHT,
                                                     .samples = 1};
    triptych_image *image;
    TEST_ASSERT_EQUAL(TRIPTYCH_OK, triptych_image_create(screen->device->renderer, &description, &image));
    return image;
}

static void begin(struct screen *screen, enum gl_interface interface)
{
    setenv("TRIPTYCH_ENGINE", "emulate", 0);
    setenv("TRIPTYCH_THREADS", "1", 0);
    *screen = (struct screen){.device = gl_device_create()};
    TEST_ASSERT_NOT_NULL(screen->device);
    screen->color = make_image(screen, TRIPTYCH_SURFACE_A8B8G8R8, TRIPTYCH_DEPTH_NONE);
    screen->depth = make_image(screen, 0, TRIPTYCH_DEPTH_D24S8);
    screen->surface = (struct gl_surface){.device = screen->device,
                                          .color.image = screen->color,
                                          .depth.image = screen->depth,
                                          .width = SCREEN_WIDTH,
                                          .height = SCREEN_HEIGHT,
                                          .samples = 1,
                                          .format = TRIPTYCH_SURFACE_A8B8G8R8,
                                          .depth_format = TRIPTYCH_DEPTH_D24S8,
                                          .red = 8,
                                          .green = 8,
                                          .blue = 8,
                                          .alpha = 8,
                                          .depth_bits = 24,
                                          .stencil_bits = 8};
    struct gl_context_options options = {.device = screen->device, .interface = interface};
    screen->context = gl_context_create(NULL, &options);
    TEST_ASSERT_NOT_NULL(screen->context);
    TEST_ASSERT_TRUE(gl_context_bind(screen->context, &screen->surface, &screen->surface));
    gl_context_enter(screen->context);
}

void screen_begin(struct screen *screen)
{
    begin(screen, GL_ES2);
}

void screen_begin_1(struct screen *screen)
{
    begin(screen, GL_ES1);
}

void screen_end(struct screen *screen)
{
    screen_expect(screen, GL_NO_ERROR, __LINE__);
    gl_context_leave(screen->context);
    gl_context_bind(screen->context, NULL, NULL);
    gl_context_destroy(screen->context);
    triptych_image_destroy(screen->device->renderer, screen->color);
    triptych_image_destroy(screen->device->renderer, screen->depth);
    gl_device_drop(screen->device);
}

uint32_t screen_pixel(struct screen *screen, int x, int y)
{
    uint8_t bytes[4];
    gl_ReadPixels(screen->context, x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, bytes);
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

void screen_expect(struct screen *screen, GLenum code, int line)
{
    UNITY_TEST_ASSERT_EQUAL_HEX32(code, gl_GetError(screen->context), line, "the error");
}

static GLuint compile(struct screen *screen, GLenum type, const char *source)
{
    struct gl_context *context = screen->context;
    char log[1024] = "";
    GLint compiled = 0;
    GLuint shader = gl_CreateShader(context, type);
    gl_ShaderSource(context, shader, 1, &source, NULL);
    gl_CompileShader(context, shader);
    gl_GetShaderiv(context, shader, GL_COMPILE_STATUS, &compiled);
    gl_GetShaderInfoLog(context, shader, sizeof log, NULL, log);
    TEST_ASSERT_TRUE_MESSAGE(compiled, log);
    return shader;
}

GLuint screen_program(struct screen *screen, const char *vertex, const char *fragment)
{
    struct gl_context *context = screen->context;
    char log[1024] = "";
    GLint linked = 0;
    GLuint program = gl_CreateProgram(context), shaders[2] = {compile(screen, GL_VERTEX_SHADER, vertex),
                                                              compile(screen, GL_FRAGMENT_SHADER, fragment)};
    for (int i = 0; i < 2; i++) {
        gl_AttachShader(context, program, shaders[i]);
        gl_DeleteShader(context, shaders[i]);
    }
    gl_BindAttribLocation(context, program, 0, "position");
    gl_LinkProgram(context, program);
    gl_GetProgramiv(context, program, GL_LINK_STATUS, &linked);
    gl_GetProgramInfoLog(context, program, sizeof log, NULL, log);
    TEST_ASSERT_TRUE_MESSAGE(linked, log);
    gl_UseProgram(context, program);
    return program;
}

void screen_rectangle(struct screen *screen, float left, float bottom, float right, float top, float z)
{
    const GLfloat corners[][3] = {{left, bottom, z}, {right, bottom, z}, {left, top, z}, {right, top, z}};
    gl_BindBuffer(screen->context, GL_ARRAY_BUFFER, 0);
    gl_VertexAttribPointer(screen->context, 0, 3, GL_FLOAT, GL_FALSE, 0, corners);
    gl_EnableVertexAttribArray(screen->context, 0);
    gl_DrawArrays(screen->context, GL_TRIANGLE_STRIP, 0, 4);
}
