/* Images that objects of several contexts have in common: OES_EGL_image, and colours of pbuffers. */
#include "front/gl/image.h"
#include "tests/support/front/gl/screen.h"

#include <unity.h>

static struct screen screen;
static struct gl_context *other; /* of another share group */

void setUp(void)
{
    screen_begin(&screen);
    const struct gl_context_options options = {.device = screen.device, .interface = GL_ES2};
    other = gl_context_create(NULL, &options);
    TEST_ASSERT_NOT_NULL(other);
}

void tearDown(void)
{
    gl_context_destroy(other);
    screen_end(&screen);
}

#define gl screen.context

static const uint32_t red = 0xff0000ff, green = 0x00ff00ff, blue = 0x0000ffff;

/* A command of another context makes all state of this one late. */
static struct gl_context *enter(struct gl_context *context)
{
    gl_context_enter(context);
    gl_context_leave(context);
    return context;
}

static GLuint make_texture(struct gl_context *context, GLenum target)
{
    GLuint texture;
    gl_GenTextures(context, 1, &texture);
    gl_BindTexture(context, target, texture);
    gl_TexParameteri(context, target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    return texture;
}

static void fill(uint32_t *texels, unsigned count, uint32_t color)
{
    for (unsigned i = 0; i < count; i++)
        texels[i] = __builtin_bswap32(color);
}

static void define(struct gl_context *context, GLenum target, GLint level, GLsizei width, GLsizei height,
                   uint32_t color)
{
    uint32_t texels[32 * 16];
    fill(texels, (unsigned)(width * height), color);
    gl_TexImage2D(context, target, level, GL_RGBA, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
}

static void write(struct gl_context *context, GLenum target, GLsizei width, GLsizei height, uint32_t color)
{
    uint32_t texels[32 * 16];
    fill(texels, (unsigned)(width * height), color);
    gl_TexSubImage2D(context, target, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, texels);
}

static GLuint make_framebuffer(struct gl_context *context, GLenum target, GLuint texture)
{
    GLuint framebuffer;
    gl_GenFramebuffers(context, 1, &framebuffer);
    gl_BindFramebuffer(context, GL_FRAMEBUFFER, framebuffer);
    gl_FramebufferTexture2D(context, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, target, texture, 0);
    return framebuffer;
}

static uint32_t pixel(struct gl_context *context)
{
    uint32_t word = 0;
    gl_ReadPixels(enter(context), 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &word);
    return __builtin_bswap32(word);
}

static void clear(struct gl_context *context, uint32_t color)
{
    gl_ClearColor(enter(context), (float)(color >> 24) / 255, (float)(color >> 16 & 255) / 255,
                  (float)(color >> 8 & 255) / 255, (float)(color & 255) / 255);
    gl_Clear(context, GL_COLOR_BUFFER_BIT);
}

/* The handle of an image is the address of a place of its own. */
static char handles[4];
static unsigned made;

static struct gl_image *image_of(GLenum target, GLuint name, GLint level)
{
    enum gl_image_result result;
    made = (made + 1) % sizeof handles;
    struct gl_image *image = gl_image_of_object(gl, target, name, level, &handles[made], &result);
    TEST_ASSERT_EQUAL_INT(GL_IMAGE_MADE, result);
    TEST_ASSERT_NOT_NULL(image);
    return image;
}

static enum gl_image_result refused(GLenum target, GLuint name, GLint level)
{
    enum gl_image_result result;
    TEST_ASSERT_NULL(gl_image_of_object(gl, target, name, level, handles, &result));
    return result;
}

#define OTHER(code) TEST_ASSERT_EQUAL_HEX32(code, gl_GetError(enter(other)))

/* A texture of the other context gets the last image and is the target of its draws. */
static GLuint take(void)
{
    GLuint texture = make_texture(enter(other), GL_TEXTURE_2D);
    gl_EGLImageTargetTexture2DOES(other, GL_TEXTURE_2D, &handles[made]);
    OTHER(GL_NO_ERROR);
    make_framebuffer(other, GL_TEXTURE_2D, texture);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_COMPLETE, gl_CheckFramebufferStatus(other, GL_FRAMEBUFFER));
    return texture;
}

#define SAMPLER(type, expression)                                                                            \
    "precision mediump float; uniform " type " image; varying vec2 at;"                                      \
    "void main() { gl_FragColor = " expression "; }"
static const char vertex[] = "attribute vec4 position; varying vec2 at;"
                             "void main() { gl_Position = position; at = position.xy * 0.5 + 0.5; }";
static const char plane[] = SAMPLER("sampler2D", "texture2D(image, at)");
static const char cube[] = SAMPLER("samplerCube", "textureCube(image, vec3(1.0, 0.2, 0.3))");

/* Draws the whole screen with the bound texture. */
static uint32_t sample(void)
{
    enter(gl);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, 0);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    return screen_pixel(&screen, 4, 4);
}

static void test_textures_of_two_contexts_have_the_same_texels(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D);
    screen_program(&screen, vertex, plane);
    define(gl, GL_TEXTURE_2D, 0, 4, 2, red);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 0);
    take();
    TEST_ASSERT_EQUAL_HEX32(red, sample());
    TEST_ASSERT_EQUAL_HEX32(red, pixel(other));
    write(enter(gl), GL_TEXTURE_2D, 4, 2, green);
    TEST_ASSERT_EQUAL_HEX32(green, pixel(other));
    clear(other, blue);
    TEST_ASSERT_EQUAL_HEX32(blue, sample());
    gl_image_drop(image);
}

static void test_an_image_has_texels_that_were_drawn_before(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D);
    define(gl, GL_TEXTURE_2D, 0, 4, 2, red);
    make_framebuffer(gl, GL_TEXTURE_2D, texture);
    clear(gl, green);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 0);
    take();
    TEST_ASSERT_EQUAL_HEX32(green, pixel(other));
    clear(gl, blue);
    TEST_ASSERT_EQUAL_HEX32(blue, pixel(other));
    gl_image_drop(image);
}

/* The second draw follows without another command of textures or framebuffers. */
static void test_a_level_of_a_mipmap_follows_its_image(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D);
    screen_program(&screen, vertex, plane);
    define(gl, GL_TEXTURE_2D, 0, 32, 16, red);
    gl_GenerateMipmap(gl, GL_TEXTURE_2D);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 1);
    take();
    TEST_ASSERT_EQUAL_HEX32(red, sample());
    clear(other, green);
    TEST_ASSERT_EQUAL_HEX32(green, sample());
    clear(other, blue);
    TEST_ASSERT_EQUAL_HEX32(blue, sample());
    gl_image_drop(image);
}

static void test_a_draw_to_an_image_reaches_a_mipmap_of_the_same_context(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D), sibling;
    screen_program(&screen, vertex, plane);
    define(gl, GL_TEXTURE_2D, 0, 32, 16, red);
    gl_GenerateMipmap(gl, GL_TEXTURE_2D);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 1);
    sibling = make_texture(enter(gl), GL_TEXTURE_2D);
    gl_EGLImageTargetTexture2DOES(gl, GL_TEXTURE_2D, &handles[made]);
    GLuint framebuffer = make_framebuffer(gl, GL_TEXTURE_2D, sibling);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    static const uint32_t colors[] = {0x00ff00ff, 0x0000ffff, 0xffff00ff};
    for (unsigned i = 0; i < 3; i++) {
        gl_BindFramebuffer(enter(gl), GL_FRAMEBUFFER, framebuffer);
        clear(gl, colors[i]);
        TEST_ASSERT_EQUAL_HEX32(colors[i], sample());
    }
    gl_image_drop(image);
}

static void test_a_mipmap_follows_texels_and_renderbuffers_of_its_image(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D), buffer;
    screen_program(&screen, vertex, plane);
    define(gl, GL_TEXTURE_2D, 0, 32, 16, red);
    gl_GenerateMipmap(gl, GL_TEXTURE_2D);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 1);
    TEST_ASSERT_EQUAL_HEX32(red, sample());
    GLuint sibling = make_texture(enter(gl), GL_TEXTURE_2D);
    gl_EGLImageTargetTexture2DOES(gl, GL_TEXTURE_2D, &handles[made]);
    write(gl, GL_TEXTURE_2D, 16, 8, green);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    TEST_ASSERT_EQUAL_HEX32(green, sample());
    GLuint framebuffer = make_framebuffer(gl, GL_TEXTURE_2D, sibling);
    gl_GenRenderbuffers(gl, 1, &buffer);
    gl_BindRenderbuffer(gl, GL_RENDERBUFFER, buffer);
    gl_EGLImageTargetRenderbufferStorageOES(gl, GL_RENDERBUFFER, &handles[made]);
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    clear(gl, blue);
    TEST_ASSERT_EQUAL_HEX32(blue, sample());
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
    TEST_ASSERT_EQUAL_HEX32(blue, pixel(gl));
    gl_image_drop(image);
}

/* The context that samples the texture enters no command between. */
static void test_a_texture_in_use_becomes_an_image(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D), sibling, framebuffer;
    screen_program(&screen, vertex, plane);
    sibling = make_texture(gl, GL_TEXTURE_2D);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    define(gl, GL_TEXTURE_2D, 0, 4, 2, red);
    TEST_ASSERT_EQUAL_HEX32(red, sample());
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 0);
    write(enter(gl), GL_TEXTURE_2D, 4, 2, green);
    TEST_ASSERT_EQUAL_HEX32(green, sample());
    gl_ActiveTexture(gl, GL_TEXTURE1);
    gl_BindTexture(gl, GL_TEXTURE_2D, sibling);
    gl_EGLImageTargetTexture2DOES(gl, GL_TEXTURE_2D, &handles[made]);
    framebuffer = make_framebuffer(gl, GL_TEXTURE_2D, sibling);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
    clear(gl, blue);
    TEST_ASSERT_EQUAL_HEX32(blue, sample());
    gl_ActiveTexture(gl, GL_TEXTURE0);
    gl_image_drop(image);
}

static void test_a_face_of_a_cube_follows_its_image(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_CUBE_MAP);
    screen_program(&screen, vertex, cube);
    for (unsigned face = 0; face < 6; face++)
        define(gl, GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, 4, 4, red);
    struct gl_image *image = image_of(GL_TEXTURE_CUBE_MAP_POSITIVE_X, texture, 0);
    take();
    TEST_ASSERT_EQUAL_HEX32(red, sample());
    clear(other, green);
    TEST_ASSERT_EQUAL_HEX32(green, sample());
    gl_image_drop(image);
    image = image_of(GL_TEXTURE_CUBE_MAP_NEGATIVE_Z, texture, 0);
    take();
    TEST_ASSERT_EQUAL_HEX32(red, pixel(other));
    gl_image_drop(image);
}

static void test_new_texels_of_an_object_leave_the_image_to_others(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D);
    screen_program(&screen, vertex, plane);
    define(gl, GL_TEXTURE_2D, 0, 4, 2, red);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 0);
    take();
    define(enter(gl), GL_TEXTURE_2D, 0, 4, 2, green);
    TEST_ASSERT_EQUAL_HEX32(green, sample());
    TEST_ASSERT_EQUAL_HEX32(red, pixel(other));
    gl_image_drop(image);
}

/* A copy of the same size and format too. */
static void test_a_copy_from_the_framebuffer_leaves_the_image_to_others(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D);
    screen_program(&screen, vertex, plane);
    define(gl, GL_TEXTURE_2D, 0, 4, 2, red);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 0);
    take();
    clear(gl, blue);
    gl_CopyTexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 0, 0, 4, 2, 0);
    TEST_ASSERT_EQUAL_HEX32(blue, sample());
    TEST_ASSERT_EQUAL_HEX32(red, pixel(other));
    gl_image_drop(image);
}

static void test_an_image_exists_as_long_as_anything_has_it(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D);
    define(gl, GL_TEXTURE_2D, 0, 4, 2, red);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 0);
    GLuint taken = take();
    gl_DeleteTextures(enter(gl), 1, &texture);
    gl_image_drop(image);
    TEST_ASSERT_EQUAL_HEX32(red, pixel(other));
    gl_EGLImageTargetTexture2DOES(other, GL_TEXTURE_2D, &handles[made]);
    OTHER(GL_INVALID_VALUE);
    gl_DeleteTextures(enter(other), 1, &taken);
}

static void test_renderbuffers_of_colours_can_be_textures(void)
{
    static const GLenum formats[] = {GL_RGBA4,     GL_RGB5_A1,  GL_RGB565,
                                     GL_RGBA8_OES, GL_RGB8_OES, GL_BGRA8_EXT};
    for (unsigned i = 0; i < sizeof formats / sizeof *formats; i++) {
        GLuint framebuffer, buffer;
        gl_GenFramebuffers(gl, 1, &framebuffer);
        gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
        gl_GenRenderbuffers(gl, 1, &buffer);
        gl_BindRenderbuffer(gl, GL_RENDERBUFFER, buffer);
        gl_RenderbufferStorage(gl, GL_RENDERBUFFER, formats[i], 8, 4);
        gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
        clear(gl, green);
        struct gl_image *image = image_of(GL_RENDERBUFFER, buffer, 0);
        GLuint texture = take();
        TEST_ASSERT_EQUAL_HEX32(green, pixel(other));
        clear(gl, blue);
        TEST_ASSERT_EQUAL_HEX32(blue, pixel(other));
        clear(other, red);
        TEST_ASSERT_EQUAL_HEX32(red, pixel(gl));
        gl_DeleteTextures(enter(other), 1, &texture);
        gl_image_drop(image);
        EXPECT(GL_NO_ERROR);
    }
}

/* A cleared stencil decides about draws of the context that has the image too. */
static void test_renderbuffers_of_depth_and_stencil_have_an_image(void)
{
    GLuint buffers[2], framebuffer;
    gl_GenFramebuffers(gl, 1, &framebuffer);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
    gl_GenRenderbuffers(gl, 2, buffers);
    gl_BindRenderbuffer(gl, GL_RENDERBUFFER, buffers[0]);
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, GL_STENCIL_INDEX8, 8, 4);
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_STENCIL_ATTACHMENT, GL_RENDERBUFFER, buffers[0]);
    struct gl_image *image = image_of(GL_RENDERBUFFER, buffers[0], 0);
    GLuint depth, texture = make_texture(enter(gl), GL_TEXTURE_2D);
    gl_GenRenderbuffers(gl, 1, &depth);
    gl_BindRenderbuffer(gl, GL_RENDERBUFFER, depth);
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, GL_DEPTH_COMPONENT16, 8, 4);
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    define(gl, GL_TEXTURE_2D, 0, 8, 4, red);
    gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);

    gl_GenFramebuffers(enter(other), 1, &framebuffer);
    gl_BindFramebuffer(other, GL_FRAMEBUFFER, framebuffer);
    gl_GenRenderbuffers(other, 1, &buffers[1]);
    gl_BindRenderbuffer(other, GL_RENDERBUFFER, buffers[1]);
    gl_EGLImageTargetRenderbufferStorageOES(other, GL_RENDERBUFFER, &handles[made]);
    GLint bits = 0;
    gl_GetRenderbufferParameteriv(other, GL_RENDERBUFFER, GL_RENDERBUFFER_STENCIL_SIZE, &bits);
    TEST_ASSERT_EQUAL_INT(8, bits);
    gl_FramebufferRenderbuffer(other, GL_FRAMEBUFFER, GL_STENCIL_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
    gl_EGLImageTargetTexture2DOES(other, GL_TEXTURE_2D, &handles[made]);
    OTHER(GL_INVALID_OPERATION);
    gl_ClearStencil(other, 5);
    gl_Clear(other, GL_STENCIL_BUFFER_BIT);
    OTHER(GL_NO_ERROR);

    screen_program(&screen, vertex, "void main() { gl_FragColor = vec4(0.0, 1.0, 0.0, 1.0); }");
    gl_Enable(enter(gl), GL_STENCIL_TEST);
    gl_StencilFunc(gl, GL_NOTEQUAL, 5, 255);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(red, pixel(gl));
    gl_StencilFunc(gl, GL_EQUAL, 5, 255);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(green, pixel(gl));
    gl_DeleteRenderbuffers(gl, 1, buffers);
    gl_image_drop(image);
    gl_Clear(enter(other), GL_STENCIL_BUFFER_BIT);
    OTHER(GL_NO_ERROR);
    gl_DeleteRenderbuffers(other, 1, &buffers[1]);
    gl_Clear(enter(gl), GL_DEPTH_BUFFER_BIT);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(green, pixel(gl));
}

static void test_a_renderbuffer_gets_the_image_of_a_texture_and_new_storage_leaves_it(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D), buffer, framebuffer;
    screen_program(&screen, vertex, plane);
    define(gl, GL_TEXTURE_2D, 0, 4, 2, red);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 0);
    gl_GenFramebuffers(enter(other), 1, &framebuffer);
    gl_BindFramebuffer(other, GL_FRAMEBUFFER, framebuffer);
    gl_EGLImageTargetRenderbufferStorageOES(other, GL_RENDERBUFFER, &handles[made]);
    OTHER(GL_INVALID_OPERATION);
    gl_GenRenderbuffers(enter(other), 1, &buffer);
    gl_BindRenderbuffer(other, GL_RENDERBUFFER, buffer);
    gl_EGLImageTargetRenderbufferStorageOES(other, GL_RENDERBUFFER, &handles[made]);
    gl_FramebufferRenderbuffer(other, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    TEST_ASSERT_EQUAL_HEX32(red, pixel(other));
    clear(other, green);
    TEST_ASSERT_EQUAL_HEX32(green, sample());
    gl_RenderbufferStorage(enter(other), GL_RENDERBUFFER, GL_RGBA8_OES, 4, 2);
    clear(other, blue);
    TEST_ASSERT_EQUAL_HEX32(green, sample());
    gl_image_drop(image);
    OTHER(GL_NO_ERROR);
}

static void test_objects_without_an_image_are_refused(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D), buffer;
    gl_GenRenderbuffers(gl, 1, &buffer);
    gl_BindRenderbuffer(gl, GL_RENDERBUFFER, buffer);
    TEST_ASSERT_EQUAL_INT(GL_IMAGE_NO_OBJECT, refused(GL_TEXTURE_2D, 77, 0));
    TEST_ASSERT_EQUAL_INT(GL_IMAGE_NO_OBJECT, refused(GL_TEXTURE_2D, texture, 0));
    TEST_ASSERT_EQUAL_INT(GL_IMAGE_NO_OBJECT, refused(GL_RENDERBUFFER, buffer, 0));
    define(gl, GL_TEXTURE_2D, 0, 8, 8, red);
    TEST_ASSERT_EQUAL_INT(GL_IMAGE_NO_OBJECT, refused(GL_TEXTURE_CUBE_MAP_POSITIVE_X, texture, 0));
    TEST_ASSERT_EQUAL_INT(GL_IMAGE_NO_LEVEL, refused(GL_TEXTURE_2D, texture, 1));
    TEST_ASSERT_EQUAL_INT(GL_IMAGE_NO_LEVEL, refused(GL_TEXTURE_2D, texture, -1));
    define(gl, GL_TEXTURE_2D, 1, 4, 4, red);
    TEST_ASSERT_EQUAL_INT(GL_IMAGE_NO_OBJECT, refused(GL_TEXTURE_2D, texture, 0));
    TEST_ASSERT_EQUAL_INT(GL_IMAGE_NO_OBJECT, refused(GL_TEXTURE_2D, texture, 1));
}

static void test_an_object_has_one_image_at_a_time(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D);
    define(gl, GL_TEXTURE_2D, 0, 4, 2, red);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 0);
    TEST_ASSERT_EQUAL_INT(GL_IMAGE_IN_USE, refused(GL_TEXTURE_2D, texture, 0));
    gl_image_drop(image);
    gl_image_drop(image_of(GL_TEXTURE_2D, texture, 0));
}

static void test_wrong_targets_of_images_are_errors(void)
{
    GLuint texture = make_texture(gl, GL_TEXTURE_2D);
    define(gl, GL_TEXTURE_2D, 0, 4, 2, red);
    struct gl_image *image = image_of(GL_TEXTURE_2D, texture, 0);
    gl_EGLImageTargetTexture2DOES(gl, GL_TEXTURE_CUBE_MAP, &handles[made]);
    EXPECT(GL_INVALID_ENUM);
    gl_EGLImageTargetRenderbufferStorageOES(gl, GL_TEXTURE_2D, &handles[made]);
    EXPECT(GL_INVALID_ENUM);
    gl_EGLImageTargetTexture2DOES(gl, GL_TEXTURE_2D, NULL);
    EXPECT(GL_INVALID_VALUE);
    gl_EGLImageTargetTexture2DOES(gl, GL_TEXTURE_2D, &screen);
    EXPECT(GL_INVALID_VALUE);
    gl_image_drop(image);
}

/* EXT_robustness, EXT_texture_type_2_10_10_10_REV */
static void test_reads_into_too_little_memory_are_errors(void)
{
    uint32_t word = 7;
    gl_ReadnPixelsEXT(gl, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, 3, &word);
    EXPECT(GL_INVALID_OPERATION);
    TEST_ASSERT_EQUAL_INT(7, word);
    gl_ReadnPixelsEXT(gl, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, 4, &word);
    EXPECT(GL_NO_ERROR);
    float color[4] = {0};
    GLuint program = screen_program(
        &screen, vertex, "precision mediump float; uniform vec4 c; void main() { gl_FragColor = c; }");
    GLint location = gl_GetUniformLocation(gl, program, "c");
    gl_Uniform4f(gl, location, 1, 2, 3, 4);
    gl_GetnUniformfvEXT(gl, program, location, 15, color);
    EXPECT(GL_INVALID_OPERATION);
    gl_GetnUniformfvEXT(gl, program, location, 16, color);
    TEST_ASSERT_EQUAL_FLOAT(4, color[3]);
    TEST_ASSERT_EQUAL_HEX32(GL_NO_ERROR, gl_GetGraphicsResetStatusEXT(gl));
}

static void test_texels_of_ten_bits_are_textures(void)
{
    static const uint32_t texel = 1023u << 10 | 1u << 30;
    make_texture(gl, GL_TEXTURE_2D);
    screen_program(&screen, vertex, plane);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV_EXT,
                  &texel);
    TEST_ASSERT_EQUAL_HEX32(0x00ff0055, sample());
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGB, 1, 1, 0, GL_RGB, GL_UNSIGNED_INT_2_10_10_10_REV_EXT, &texel);
    TEST_ASSERT_EQUAL_HEX32(green, sample());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_textures_of_two_contexts_have_the_same_texels);
    RUN_TEST(test_an_image_has_texels_that_were_drawn_before);
    RUN_TEST(test_a_level_of_a_mipmap_follows_its_image);
    RUN_TEST(test_a_draw_to_an_image_reaches_a_mipmap_of_the_same_context);
    RUN_TEST(test_a_mipmap_follows_texels_and_renderbuffers_of_its_image);
    RUN_TEST(test_a_texture_in_use_becomes_an_image);
    RUN_TEST(test_a_face_of_a_cube_follows_its_image);
    RUN_TEST(test_new_texels_of_an_object_leave_the_image_to_others);
    RUN_TEST(test_a_copy_from_the_framebuffer_leaves_the_image_to_others);
    RUN_TEST(test_an_image_exists_as_long_as_anything_has_it);
    RUN_TEST(test_renderbuffers_of_colours_can_be_textures);
    RUN_TEST(test_renderbuffers_of_depth_and_stencil_have_an_image);
    RUN_TEST(test_a_renderbuffer_gets_the_image_of_a_texture_and_new_storage_leaves_it);
    RUN_TEST(test_objects_without_an_image_are_refused);
    RUN_TEST(test_an_object_has_one_image_at_a_time);
    RUN_TEST(test_wrong_targets_of_images_are_errors);
    RUN_TEST(test_reads_into_too_little_memory_are_errors);
    RUN_TEST(test_texels_of_ten_bits_are_textures);
    return UNITY_END();
}
