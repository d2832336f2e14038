/* Contexts, clears, reads and errors of OpenGL ES. */
#include "tests/support/front/gl/screen.h"

#include <string.h>
#include <unity.h>

static struct screen screen;

void setUp(void)
{
    screen_begin(&screen);
}

void tearDown(void)
{
    screen_end(&screen);
}

#define gl screen.context

static void test_the_first_error_sticks_until_it_is_fetched(void)
{
    gl_Enable(gl, GL_RGBA);
    gl_Viewport(gl, 0, 0, -1, 1);
    EXPECT(GL_INVALID_ENUM);
    EXPECT(GL_NO_ERROR);
}

static void test_a_clear_obeys_masks_and_the_scissor_and_not_the_viewport(void)
{
    gl_Viewport(gl, 0, 0, 1, 1);
    gl_ClearColor(gl, 1, 0.5F, 0, 1);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    TEST_ASSERT_EQUAL_HEX32(0xff8000ff, screen_pixel(&screen, 15, 7));
    gl_ColorMask(gl, GL_FALSE, GL_TRUE, GL_TRUE, GL_FALSE);
    gl_Enable(gl, GL_SCISSOR_TEST);
    gl_Scissor(gl, -4, 2, 8, 100);
    gl_ClearColor(gl, 0, 1, 1, 0);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 3, 2));
    TEST_ASSERT_EQUAL_HEX32(0xff8000ff, screen_pixel(&screen, 4, 2));
    TEST_ASSERT_EQUAL_HEX32(0xff8000ff, screen_pixel(&screen, 3, 1));
}

static void test_a_read_leaves_pixels_outside_of_the_framebuffer(void)
{
    uint8_t pixels[3][4][4];
    memset(pixels, 0x55, sizeof pixels);
    gl_ClearColor(gl, 0, 0, 1, 1);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_ReadPixels(gl, -2, -1, 4, 3, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    TEST_ASSERT_EQUAL_HEX8(0x55, pixels[0][3][2]);
    TEST_ASSERT_EQUAL_HEX8(0x55, pixels[1][1][2]);
    TEST_ASSERT_EQUAL_HEX8(0xff, pixels[1][2][2]);
    TEST_ASSERT_EQUAL_HEX8(0, pixels[2][3][0]);
    gl_ReadPixels(gl, 0x7fffffff, 0, 4, 3, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    EXPECT(GL_NO_ERROR);
    gl_ReadPixels(gl, 0, 0, 1, 1, GL_RGB, GL_UNSIGNED_BYTE, pixels);
    EXPECT(GL_INVALID_OPERATION);
    gl_ReadPixels(gl, 0, 0, -1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    EXPECT(GL_INVALID_VALUE);
}

static void test_without_surfaces_the_framebuffer_is_undefined(void)
{
    gl_context_bind(gl, NULL, NULL);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_UNDEFINED_OES, gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER));
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    EXPECT(GL_INVALID_FRAMEBUFFER_OPERATION);
}

static void test_getters_convert_between_types(void)
{
    GLint integers[4];
    GLfloat numbers[4];
    GLboolean booleans[4];
    gl_ClearColor(gl, 1, 0, 0.5F, 2);
    gl_GetIntegerv(gl, GL_COLOR_CLEAR_VALUE, integers);
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, integers[0]);
    TEST_ASSERT_EQUAL_INT32(0, integers[1]);
    gl_GetFloatv(gl, GL_COLOR_CLEAR_VALUE, numbers);
    TEST_ASSERT_EQUAL_FLOAT(1, numbers[3]);
    gl_GetBooleanv(gl, GL_COLOR_CLEAR_VALUE, booleans);
    TEST_ASSERT_EQUAL(GL_FALSE, booleans[1]);
    TEST_ASSERT_EQUAL(GL_TRUE, booleans[2]);
    gl_GetIntegerv(gl, GL_VIEWPORT, integers);
    TEST_ASSERT_EQUAL_INT32(SCREEN_WIDTH, integers[2]);
    TEST_ASSERT_EQUAL_INT32(SCREEN_HEIGHT, integers[3]);
    gl_LineWidth(gl, 2.6F);
    gl_GetIntegerv(gl, GL_LINE_WIDTH, integers);
    TEST_ASSERT_EQUAL_INT32(3, integers[0]);
    gl_GetIntegerv(gl, GL_DEPTH_BITS, integers);
    TEST_ASSERT_EQUAL_INT32(24, integers[0]);
    gl_GetFloatv(gl, GL_STENCIL_WRITEMASK, numbers);
    TEST_ASSERT_EQUAL_FLOAT(4294967295.0F, numbers[0]);
    gl_GetIntegerv(gl, GL_RGBA, integers);
    EXPECT(GL_INVALID_ENUM);
}

static void test_renderbuffers_are_drawn_to_and_checked(void)
{
    GLuint framebuffer, buffers[2];
    GLint value;
    gl_GenFramebuffers(gl, 1, &framebuffer);
    gl_GenRenderbuffers(gl, 2, buffers);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT,
                            gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER));
    gl_BindRenderbuffer(gl, GL_RENDERBUFFER, buffers[0]);
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, GL_RGB565, 4, 4);
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_COMPLETE, gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER));
    gl_ClearColor(gl, 1, 0, 0, 0);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 3, 3));
    uint16_t word;
    gl_ReadPixels(gl, 0, 0, 1, 1, GL_RGB, GL_UNSIGNED_SHORT_5_6_5, &word);
    TEST_ASSERT_EQUAL_HEX16(0xf800, word);
    gl_BindRenderbuffer(gl, GL_RENDERBUFFER, buffers[1]);
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, GL_DEPTH_COMPONENT16, 8, 4);
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_INCOMPLETE_DIMENSIONS,
                            gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER));
    gl_GetFramebufferAttachmentParameteriv(gl, GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
                                           GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &value);
    TEST_ASSERT_EQUAL_INT32((GLint)buffers[1], value);
    gl_DeleteRenderbuffers(gl, 2, buffers);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT,
                            gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER));
    gl_DeleteFramebuffers(gl, 1, &framebuffer);
    gl_GetIntegerv(gl, GL_FRAMEBUFFER_BINDING, &value);
    TEST_ASSERT_EQUAL_INT32(0, value);
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, GL_RGB565, 8193, 4);
    EXPECT(GL_INVALID_VALUE);
}

static void test_textures_are_attached_and_copied(void)
{
    static const uint8_t red[4][4] = {{255, 0, 0, 255}, {255, 0, 0, 255}, {255, 0, 0, 255}, {255, 0, 0, 255}};
    GLuint textures[2], framebuffer;
    gl_GenTextures(gl, 2, textures);
    gl_BindTexture(gl, GL_TEXTURE_2D, textures[0]);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, red);
    gl_GenFramebuffers(gl, 1, &framebuffer);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
    gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[0], 0);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 1, 1));
    gl_Enable(gl, GL_SCISSOR_TEST);
    gl_Scissor(gl, 0, 1, 1, 1);
    gl_ClearColor(gl, 0, 1, 0, 1);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_BindTexture(gl, GL_TEXTURE_2D, textures[1]);
    gl_CopyTexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGB, -1, 1, 4, 1, 0);
    gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[1], 0);
    TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 1, 0));
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 2, 0));
    gl_CopyTexSubImage2D(gl, GL_TEXTURE_2D, 0, 3, 0, 1, 0, 1, 1);
    TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 3, 0));
    gl_CopyTexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 0, 0, 1, 1, 0);
    EXPECT(GL_INVALID_OPERATION);
    gl_TexSubImage2D(gl, GL_TEXTURE_2D, 0, 1, 0, 4, 1, GL_RGB, GL_UNSIGNED_BYTE, red);
    EXPECT(GL_INVALID_VALUE);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGB, 1 << 30, 1 << 30, 0, GL_RGB, GL_UNSIGNED_BYTE, NULL);
    EXPECT(GL_INVALID_VALUE);
    gl_DeleteFramebuffers(gl, 1, &framebuffer);
    gl_DeleteTextures(gl, 2, textures);
}

static void test_messages_follow_rules_and_groups(void)
{
    char text[64];
    GLenum type;
    GLint depth;
    gl_Enable(gl, GL_DEBUG_OUTPUT_KHR);
    gl_Enable(gl, GL_RGBA);
    EXPECT(GL_INVALID_ENUM);
    TEST_ASSERT_EQUAL(1, gl_GetDebugMessageLogKHR(gl, 1, sizeof text, NULL, &type, NULL, NULL, NULL, text));
    TEST_ASSERT_EQUAL_HEX32(GL_DEBUG_TYPE_ERROR_KHR, type);
    TEST_ASSERT_EQUAL_STRING("found GL_RGBA, expected a capability", text);
    gl_PushDebugGroupKHR(gl, GL_DEBUG_SOURCE_APPLICATION_KHR, 1, -1, "group");
    gl_DebugMessageControlKHR(gl, GL_DONT_CARE, GL_DEBUG_TYPE_ERROR_KHR, GL_DONT_CARE, 0, NULL, GL_FALSE);
    gl_Enable(gl, GL_RGBA);
    EXPECT(GL_INVALID_ENUM);
    gl_GetIntegerv(gl, GL_DEBUG_GROUP_STACK_DEPTH_KHR, &depth);
    TEST_ASSERT_EQUAL_INT32(2, depth);
    gl_GetIntegerv(gl, GL_DEBUG_LOGGED_MESSAGES_KHR, &depth);
    TEST_ASSERT_EQUAL_INT32(1, depth);
    gl_PopDebugGroupKHR(gl);
    gl_PopDebugGroupKHR(gl);
    EXPECT(GL_STACK_UNDERFLOW_KHR);
}

static void test_objects_have_labels(void)
{
    char text[8] = "";
    GLsizei length = 0;
    GLuint texture;
    gl_GenTextures(gl, 1, &texture);
    gl_ObjectLabelKHR(gl, GL_TEXTURE, texture, -1, "wall");
    EXPECT(GL_INVALID_VALUE);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    gl_ObjectLabelKHR(gl, GL_TEXTURE, texture, -1, "wall");
    gl_GetObjectLabelKHR(gl, GL_TEXTURE, texture, 3, &length, text);
    TEST_ASSERT_EQUAL_STRING("wa", text);
    gl_GetObjectLabelKHR(gl, GL_TEXTURE, texture, 0, &length, NULL);
    TEST_ASSERT_EQUAL_INT32(4, length);
    gl_ObjectLabelKHR(gl, GL_RGBA, texture, -1, "wall");
    EXPECT(GL_INVALID_ENUM);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_first_error_sticks_until_it_is_fetched);
    RUN_TEST(test_a_clear_obeys_masks_and_the_scissor_and_not_the_viewport);
    RUN_TEST(test_a_read_leaves_pixels_outside_of_the_framebuffer);
    RUN_TEST(test_without_surfaces_the_framebuffer_is_undefined);
    RUN_TEST(test_getters_convert_between_types);
    RUN_TEST(test_renderbuffers_are_drawn_to_and_checked);
    RUN_TEST(test_textures_are_attached_and_copied);
    RUN_TEST(test_messages_follow_rules_and_groups);
    RUN_TEST(test_objects_have_labels);
    return UNITY_END();
}
