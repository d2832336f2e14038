/* Images that framebuffer objects can have. */
#include "tests/support/front/gl/screen.h"

#include <unity.h>

static struct screen screen;

void setUp(void)
{
    GLuint framebuffer;
    screen_begin(&screen);
    gl_GenFramebuffers(screen.context, 1, &framebuffer);
    gl_BindFramebuffer(screen.context, GL_FRAMEBUFFER, framebuffer);
}

void tearDown(void)
{
    screen_end(&screen);
}

#define gl screen.context

static GLenum status(void)
{
    return gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER);
}

static void attach_renderbuffer(GLenum attachment, GLenum internal_format)
{
    GLuint buffer;
    gl_GenRenderbuffers(gl, 1, &buffer);
    gl_BindRenderbuffer(gl, GL_RENDERBUFFER, buffer);
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, internal_format, 8, 4);
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
}

static void attach_texture(GLenum internal_format, GLenum format, GLenum type)
{
    GLuint texture;
    gl_GenTextures(gl, 1, &texture);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, (GLint)internal_format, 8, 4, 0, format, type, NULL);
    gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
}

/* EXT_texture_format_BGRA8888 */
static void test_renderbuffers_can_be_bgra(void)
{
    static const GLenum formats[] = {GL_BGRA_EXT, GL_BGRA8_EXT};
    for (unsigned i = 0; i < 2; i++) {
        GLint format = 0, alpha = 0;
        uint8_t pixel[4] = {0};
        attach_renderbuffer(GL_COLOR_ATTACHMENT0, formats[i]);
        EXPECT(GL_NO_ERROR);
        TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_COMPLETE, status());
        gl_GetRenderbufferParameteriv(gl, GL_RENDERBUFFER, GL_RENDERBUFFER_INTERNAL_FORMAT, &format);
        gl_GetRenderbufferParameteriv(gl, GL_RENDERBUFFER, GL_RENDERBUFFER_ALPHA_SIZE, &alpha);
        TEST_ASSERT_EQUAL_HEX32(formats[i], format);
        TEST_ASSERT_EQUAL_INT(8, alpha);
        gl_ClearColor(gl, 1, 0.2F, 0, 0.4F);
        gl_Clear(gl, GL_COLOR_BUFFER_BIT);
        gl_ReadPixels(gl, 7, 3, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(((const uint8_t[]){255, 51, 0, 102}), pixel, 4);
    }
}

/* EXT_texture_rg: other colours are 0 and alpha is 1, in framebuffers and in textures. */
static void test_one_and_two_channels_can_be_drawn_and_sampled(void)
{
    static const struct {
        GLenum size, format;
        uint8_t pixel[4];
    } cases[] = {{GL_R8_EXT, GL_RED_EXT, {255, 0, 0, 255}}, {GL_RG8_EXT, GL_RG_EXT, {255, 51, 0, 255}}};
    for (unsigned i = 0; i < 4; i++) {
        uint8_t pixel[4] = {0};
        GLuint copy;
        if (i % 2)
            attach_renderbuffer(GL_COLOR_ATTACHMENT0, cases[i / 2].size);
        else
            attach_texture(cases[i / 2].format, cases[i / 2].format, GL_UNSIGNED_BYTE);
        EXPECT(GL_NO_ERROR);
        TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_COMPLETE, status());
        gl_ClearColor(gl, 1, 0.2F, 0.6F, 0.4F);
        gl_Clear(gl, GL_COLOR_BUFFER_BIT);
        gl_ReadPixels(gl, 7, 3, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(cases[i / 2].pixel, pixel, 4);
        gl_GenTextures(gl, 1, &copy);
        gl_BindTexture(gl, GL_TEXTURE_2D, copy);
        gl_CopyTexImage2D(gl, GL_TEXTURE_2D, 0, GL_RED_EXT, 0, 0, 4, 4, 0);
        EXPECT(GL_NO_ERROR);
        gl_CopyTexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 0, 0, 4, 4, 0);
        EXPECT(GL_INVALID_OPERATION);
    }
}

static void test_textures_can_be_bgra_with_and_without_a_size(void)
{
    static const GLenum formats[] = {GL_BGRA_EXT, GL_BGRA8_EXT};
    for (unsigned i = 0; i < 2; i++) {
        attach_texture(formats[i], GL_BGRA_EXT, GL_UNSIGNED_BYTE);
        EXPECT(GL_NO_ERROR);
        TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_COMPLETE, status());
    }
    attach_texture(GL_BGRA8_EXT, GL_RGBA, GL_UNSIGNED_BYTE);
    EXPECT(GL_INVALID_OPERATION);
    attach_texture(GL_BGRA8_EXT, GL_BGRA_EXT, GL_UNSIGNED_SHORT_4_4_4_4_REV_EXT);
    EXPECT(GL_INVALID_OPERATION);
}

/* OES_texture_float and OES_texture_half_float make them textures, not targets. */
static void test_textures_of_floats_cannot_be_attached(void)
{
    static const GLenum types[] = {GL_FLOAT, GL_HALF_FLOAT_OES};
    for (unsigned i = 0; i < 2; i++) {
        attach_texture(GL_RGBA, GL_RGBA, types[i]);
        EXPECT(GL_NO_ERROR);
        TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT, status());
        gl_Clear(gl, GL_COLOR_BUFFER_BIT);
        EXPECT(GL_INVALID_FRAMEBUFFER_OPERATION);
    }
    attach_texture(GL_RGBA, GL_RGBA, GL_UNSIGNED_BYTE);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_COMPLETE, status());
}

static void test_images_of_one_framebuffer_have_one_size(void)
{
    attach_texture(GL_RGB, GL_RGB, GL_UNSIGNED_SHORT_5_6_5);
    attach_renderbuffer(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT16);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_COMPLETE, status());
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, GL_DEPTH_COMPONENT16, 8, 5);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_INCOMPLETE_DIMENSIONS, status());
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, GL_RGBA4, 8, 4);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT, status());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_renderbuffers_can_be_bgra);
    RUN_TEST(test_one_and_two_channels_can_be_drawn_and_sampled);
    RUN_TEST(test_textures_can_be_bgra_with_and_without_a_size);
    RUN_TEST(test_textures_of_floats_cannot_be_attached);
    RUN_TEST(test_images_of_one_framebuffer_have_one_size);
    return UNITY_END();
}
