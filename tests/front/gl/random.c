/* Random commands of OpenGL ES, valid and invalid ones: none crashes, and each error is one of OpenGL's.
 * Sizes and enumerations are of a few values that are on both sides of limits. Memory of the program has
 * only zeros, so indices in it are valid.
 *
 * A failure names its case: `TRIPTYCH_CASE=SEED` executes only that one. */
#include "base/random.h"
#include "tests/support/front/gl/screen.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { CASES = 60, CALLS = 300, MEMORY = 1 << 16 };

static struct screen screen;
static struct random source;
static uint8_t zeros[MEMORY], out[MEMORY];

void setUp(void)
{
}

void tearDown(void)
{
}

#define gl screen.context

static uint32_t next(uint32_t count)
{
    return random_below(&source, count);
}

#define PICK(...)                                                                                            \
    ((const GLenum[]){__VA_ARGS__})[next(sizeof((const GLenum[]){__VA_ARGS__}) / sizeof(GLenum))]

static GLint size(void)
{
    static const GLint sizes[] = {0, 1, 2, 3, 4, 4, 8, 8, 16, 16, -1, 8193, 1 << 30, INT32_MAX};
    return sizes[next(sizeof sizes / sizeof *sizes)];
}

static GLint place(void)
{
    static const GLint places[] = {0, 0, 0, 1, 2, 5, -1, -8, 8192, INT32_MAX, INT32_MIN};
    return places[next(sizeof places / sizeof *places)];
}

static GLfloat number(void)
{
    static const GLfloat numbers[] = {0, 1, 0.5F, -1, 2, 1e30F, -1e30F, 1e-30F};
    return numbers[next(sizeof numbers / sizeof *numbers)];
}

static GLuint name(void)
{
    return next(6);
}

static const void *data(void)
{
    return next(4) ? zeros : NULL;
}

static GLenum image_target(void)
{
    return PICK(GL_TEXTURE_2D, GL_TEXTURE_2D, GL_TEXTURE_CUBE_MAP_POSITIVE_X, GL_TEXTURE_CUBE_MAP_NEGATIVE_Z,
                GL_RGBA);
}

static GLenum format(void)
{
    return PICK(GL_RGBA, GL_RGBA, GL_RGB, GL_ALPHA, GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_BGRA_EXT,
                GL_DEPTH_COMPONENT, GL_DEPTH_STENCIL_OES, GL_FLOAT);
}

static GLenum type(void)
{
    return PICK(GL_UNSIGNED_BYTE, GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT_5_6_5, GL_UNSIGNED_SHORT_4_4_4_4,
                GL_FLOAT, GL_HALF_FLOAT_OES, GL_UNSIGNED_INT, GL_UNSIGNED_INT_24_8_OES, GL_RGBA);
}

static void call_texture(void)
{
    GLenum f = format(), target = PICK(GL_TEXTURE_2D, GL_TEXTURE_CUBE_MAP, GL_RGBA);
    switch (next(9)) {
    case 0: gl_BindTexture(gl, target, name()); break;
    case 1: gl_ActiveTexture(gl, GL_TEXTURE0 + next(3) * 15); break;
    case 2:
        gl_TexImage2D(gl, image_target(), next(4), next(4) ? f : PICK(GL_RGBA8_OES, GL_DEPTH_COMPONENT16),
                      size(), size(), 0, f, type(), data());
        break;
    case 3:
        gl_TexSubImage2D(gl, image_target(), next(2), place(), place(), size(), size(), f, type(), zeros);
        break;
    case 4: gl_CopyTexImage2D(gl, image_target(), next(2), f, place(), place(), size(), size(), 0); break;
    case 5:
        gl_CopyTexSubImage2D(gl, image_target(), 0, place(), place(), place(), place(), size(), size());
        break;
    case 6: gl_GenerateMipmap(gl, target); break;
    case 7:
        gl_TexParameteri(gl, target, PICK(GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER, GL_TEXTURE_WRAP_S),
                         (GLint)PICK(GL_NEAREST, GL_LINEAR, GL_LINEAR_MIPMAP_LINEAR, GL_REPEAT, 0));
        break;
    default:
        gl_CompressedTexImage2D(gl, image_target(), 0,
                                PICK(GL_ETC1_RGB8_OES, GL_COMPRESSED_RGB_S3TC_DXT1_EXT), 8, 8, 0, 32, data());
    }
}

static void call_framebuffer(void)
{
    GLenum point =
        PICK(GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT0 + 1, GL_DEPTH_ATTACHMENT, GL_STENCIL_ATTACHMENT, 0);
    switch (next(9)) {
    case 0: gl_BindFramebuffer(gl, GL_FRAMEBUFFER, name()); break;
    case 1: gl_BindRenderbuffer(gl, GL_RENDERBUFFER, name()); break;
    case 2:
        gl_RenderbufferStorage(
            gl, GL_RENDERBUFFER,
            PICK(GL_RGBA4, GL_RGB565, GL_DEPTH_COMPONENT16, GL_STENCIL_INDEX8, GL_DEPTH24_STENCIL8_OES),
            size(), size());
        break;
    case 3: gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, point, GL_RENDERBUFFER, name()); break;
    case 4: gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, point, image_target(), name(), 0); break;
    case 5: gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER); break;
    case 6:
        gl_ReadPixels(gl, place(), place(), (GLint)next(16), (GLint)next(16), format(), type(), out);
        break;
    case 7:
        gl_ReadnPixelsEXT(gl, place(), place(), size(), size(), format(), type(), (GLsizei)next(sizeof out),
                          out);
        break;
    default: gl_DrawBuffersEXT(gl, (GLsizei)next(6), (const GLenum[5]){GL_COLOR_ATTACHMENT0}); break;
    }
}

static void call_delete(void)
{
    GLuint names[2] = {name(), name()};
    switch (next(5)) {
    case 0: gl_DeleteTextures(gl, 2, names); break;
    case 1: gl_DeleteBuffers(gl, 2, names); break;
    case 2: gl_DeleteFramebuffers(gl, 2, names); break;
    case 3: gl_DeleteRenderbuffers(gl, 2, names); break;
    default: gl_GenTextures(gl, (GLsizei)next(3), names);
    }
}

static void call_buffer(void)
{
    GLenum target = PICK(GL_ARRAY_BUFFER, GL_ELEMENT_ARRAY_BUFFER, GL_RGBA);
    switch (next(6)) {
    case 0: gl_BindBuffer(gl, target, name()); break;
    case 1: gl_BufferData(gl, target, (GLsizeiptr)next(1000), data(), GL_STATIC_DRAW); break;
    case 2: gl_BufferSubData(gl, target, place(), (GLsizeiptr)next(64), zeros); break;
    case 3: gl_MapBufferOES(gl, target, GL_WRITE_ONLY_OES); break;
    case 4: gl_UnmapBufferOES(gl, target); break;
    default: gl_BindVertexArrayOES(gl, next(2));
    }
}

static void call_value(void)
{
    GLenum capability =
        PICK(GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_RGBA);
    switch (next(11)) {
    case 0: gl_Enable(gl, capability); break;
    case 1: gl_Disable(gl, capability); break;
    case 2: gl_Viewport(gl, place(), place(), size(), size()); break;
    case 3: gl_Scissor(gl, place(), place(), size(), size()); break;
    case 4: gl_DepthRangef(gl, number(), number()); break;
    case 5: gl_PolygonOffset(gl, number(), number()); break;
    case 6: gl_StencilFunc(gl, PICK(GL_NEVER, GL_EQUAL, GL_RGBA), place(), 255); break;
    case 7: gl_ClearColor(gl, number(), number(), number(), number()); break;
    case 8:
        gl_ClipControlEXT(gl, PICK(GL_LOWER_LEFT_EXT, GL_UPPER_LEFT_EXT),
                          PICK(GL_NEGATIVE_ONE_TO_ONE_EXT, GL_ZERO_TO_ONE_EXT, 0));
        break;
    case 9:
        next(2) ? gl_PushGroupMarkerEXT(gl, (GLsizei)next(9) - 1, "group") : gl_PopGroupMarkerEXT(gl);
        break;
    default: gl_Clear(gl, next(2) ? GL_COLOR_BUFFER_BIT : 1u << next(16));
    }
}

/* --- Draws --- */

static GLuint compile(GLenum type, const char *source)
{
    GLuint shader = gl_CreateShader(gl, type);
    gl_ShaderSource(gl, shader, 1, &source, NULL);
    gl_CompileShader(gl, shader);
    return shader;
}

static void make_program(void)
{
    static const char vertex[] =
        "attribute vec4 a; attribute vec2 b; varying vec2 at; uniform mat4 m[2];"
        "void main() { at = b; gl_PointSize = a.x * 90.0; gl_Position = m[1] * (a + vec4(b, 0.0, 1.0)); }";
    static const char fragment[] =
        "precision mediump float; varying vec2 at; uniform sampler2D s; uniform vec4 c;"
        "void main() { gl_FragColor = texture2D(s, at) + c; }";
    GLuint program = gl_CreateProgram(gl);
    gl_AttachShader(gl, program, compile(GL_VERTEX_SHADER, vertex));
    gl_AttachShader(gl, program, compile(GL_FRAGMENT_SHADER, fragment));
    gl_LinkProgram(gl, program);
    gl_UseProgram(gl, program);
    gl_GetError(gl);
}

static void call_draw(void)
{
    const GLfloat matrix[2 * 16] = {number(), 0, 0,        number(), 0, number(), 0, 0,
                                    0,        0, number(), 0,        0, 0,        0, number()};
    GLenum mode = PICK(GL_POINTS, GL_LINE_LOOP, GL_LINES, GL_TRIANGLES, GL_TRIANGLE_FAN, GL_RGBA);
    GLenum index = PICK(GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_UNSIGNED_INT, GL_FLOAT);
    switch (next(8)) {
    case 0: gl_EnableVertexAttribArray(gl, next(17)); break;
    case 1: gl_DisableVertexAttribArray(gl, next(2)); break;
    case 2:
        gl_VertexAttribPointer(gl, next(3), (GLint)next(6),
                               PICK(GL_FLOAT, GL_BYTE, GL_UNSIGNED_SHORT, GL_FIXED, 0), GL_FALSE,
                               (GLsizei)next(40) - 1, zeros);
        break;
    case 3: gl_VertexAttrib4f(gl, next(3), number(), number(), number(), number()); break;
    case 4: gl_UniformMatrix4fv(gl, (GLint)next(5) - 1, (GLsizei)next(3), GL_FALSE, matrix); break;
    case 5: gl_Uniform1i(gl, (GLint)next(5), (GLint)next(22)); break;
    case 6: gl_DrawArrays(gl, mode, (GLint)next(7) - 1, (GLsizei)next(20) - 1); break;
    default: gl_DrawElements(gl, mode, (GLsizei)next(20) - 1, index, next(2) ? zeros : NULL);
    }
}

static void get_everything(void)
{
    GLint values[16];
    for (GLenum i = 0; i < 0x10000; i += next(64) + 1)
        gl_GetIntegerv(gl, i, values);
    gl_GetError(gl);
}

static void run(uint64_t seed)
{
    static void (*const calls[])(void) = {call_texture, call_framebuffer, call_buffer, call_value,
                                          call_delete,  call_draw,        call_draw};
    screen_begin(&screen);
    make_program();
    source = random_start(seed, 0);
    for (int i = 0; i < CALLS; i++) {
        calls[next(sizeof calls / sizeof *calls)]();
        GLenum error = gl_GetError(gl);
        TEST_ASSERT_TRUE(error == GL_NO_ERROR ||
                         (error >= GL_INVALID_ENUM && error <= GL_INVALID_FRAMEBUFFER_OPERATION));
    }
    get_everything();
    screen_end(&screen);
}

static void test_random_commands_give_errors_of_opengl(void)
{
    const char *chosen = getenv("TRIPTYCH_CASE");
    for (uint64_t seed = 0; seed < CASES; seed++)
        if (!chosen || strtoull(chosen, NULL, 10) == seed)
            run(seed);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_random_commands_give_errors_of_opengl);
    return UNITY_END();
}
