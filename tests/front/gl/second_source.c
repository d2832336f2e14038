/* EXT_blend_func_extended: a second colour of fragment shaders as a factor of blending; and gl_FragColor as
 * the colour of several targets. */
#include "tests/support/front/gl/screen.h"

#include <unity.h>

static struct screen screen;

#define gl            screen.context
#define EXTENDED      "#extension GL_EXT_blend_func_extended : require\n"
#define DRAW_BUFFERS  "#extension GL_EXT_draw_buffers : require\n"
#define MAIN(body)    "precision mediump float; void main() { " body " }"
#define SECOND(first) MAIN(first "gl_SecondaryFragColorEXT = vec4(1.0, 0.0, 0.2, 1.0);")
#define FIRST         "gl_FragColor = vec4(0.2, 0.4, 0.0, 0.0);"

static const char vertex[] = "attribute vec3 position; void main() { gl_Position = vec4(position, 1.0); }";

void setUp(void)
{
    screen_begin(&screen);
}

void tearDown(void)
{
    screen_end(&screen);
}

static GLint integer(GLenum name)
{
    GLint value = -1;
    gl_GetIntegerv(gl, name, &value);
    EXPECT(GL_NO_ERROR);
    return value;
}

/* The pixel after a draw over 0xcc6633ff. */
static uint32_t blended(const char *fragment, GLenum source, GLenum target)
{
    screen_program(&screen, vertex, fragment);
    gl_Disable(gl, GL_BLEND);
    gl_ClearColor(gl, 0.8F, 0.4F, 0.2F, 1);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_Enable(gl, GL_BLEND);
    gl_BlendFunc(gl, source, target);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    return screen_pixel(&screen, 3, 3);
}

static void test_a_second_colour_is_a_factor_of_blending(void)
{
    const char *fragment = EXTENDED SECOND(FIRST);
    TEST_ASSERT_EQUAL_INT(1, integer(GL_MAX_DUAL_SOURCE_DRAW_BUFFERS_EXT));
    TEST_ASSERT_EQUAL_HEX32(0x33cc2900, blended(fragment, GL_ONE, GL_ONE_MINUS_SRC1_COLOR_EXT));
    TEST_ASSERT_EQUAL_HEX32(0xcc000aff, blended(fragment, GL_ZERO, GL_SRC1_COLOR_EXT));
    TEST_ASSERT_EQUAL_HEX32(0x33660000, blended(fragment, GL_SRC1_ALPHA, GL_ZERO));
    TEST_ASSERT_EQUAL_HEX32(0xcc6633ff, blended(fragment, GL_ONE_MINUS_SRC1_ALPHA_EXT, GL_ONE));
    TEST_ASSERT_EQUAL_HEX32(GL_ONE_MINUS_SRC1_ALPHA_EXT, integer(GL_BLEND_SRC_RGB));
    TEST_ASSERT_EQUAL_HEX32(0x33660000, blended(fragment, GL_ONE, GL_ZERO));
    EXPECT(GL_NO_ERROR);
}

static void test_data_has_a_second_element(void)
{
    const char *fragment = EXTENDED MAIN("gl_FragData[0] = vec4(0.2, 0.4, 0.0, 0.0);"
                                         "gl_SecondaryFragDataEXT[gl_MaxDualSourceDrawBuffersEXT - 1] ="
                                         "vec4(1.0, 0.0, 0.2, 1.0);");
    TEST_ASSERT_EQUAL_HEX32(0x33cc2900, blended(fragment, GL_ONE, GL_ONE_MINUS_SRC1_COLOR_EXT));
    EXPECT(GL_NO_ERROR);
}

static void test_the_second_colour_can_depend_on_the_face(void)
{
    const char *fragment = EXTENDED MAIN("gl_FragColor = vec4(0.0);"
                                         "gl_SecondaryFragColorEXT = vec4(gl_FrontFacing ? 1.0 : 0.0);");
    TEST_ASSERT_EQUAL_HEX32(0xcc6633ff, blended(fragment, GL_ONE, GL_SRC1_COLOR_EXT));
    gl_FrontFace(gl, GL_CW);
    TEST_ASSERT_EQUAL_HEX32(0, blended(fragment, GL_ONE, GL_SRC1_COLOR_EXT));
}

static void test_target_factors_include_the_saturated_alpha(void)
{
    const char *fragment = MAIN("gl_FragColor = vec4(0.2, 0.0, 0.0, 0.4);");
    gl_ClearColor(gl, 0, 0, 0, 1);
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, blended(fragment, GL_ZERO, GL_SRC_ALPHA_SATURATE));
    TEST_ASSERT_EQUAL_HEX32(GL_SRC_ALPHA_SATURATE, integer(GL_BLEND_DST_RGB));
}

/* --- Several targets --- */

static void attach(GLuint buffers[2])
{
    static const GLenum draws[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT0 + 1};
    GLuint framebuffer;
    gl_GenFramebuffers(gl, 1, &framebuffer);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
    gl_GenRenderbuffers(gl, 2, buffers);
    for (GLenum i = 0; i < 2; i++) {
        gl_BindRenderbuffer(gl, GL_RENDERBUFFER, buffers[i]);
        gl_RenderbufferStorage(gl, GL_RENDERBUFFER, GL_RGBA8_OES, 8, 8);
        gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, GL_RENDERBUFFER, buffers[i]);
    }
    gl_DrawBuffersEXT(gl, 2, draws);
    EXPECT(GL_NO_ERROR);
}

/* The colour of the second attachment, read through the first. */
static uint32_t second_pixel(const GLuint buffers[2])
{
    const GLenum first = GL_COLOR_ATTACHMENT0, second = GL_COLOR_ATTACHMENT0 + 1;
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, second, GL_RENDERBUFFER, 0);
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, first, GL_RENDERBUFFER, buffers[1]);
    uint32_t pixel = screen_pixel(&screen, 3, 3);
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, first, GL_RENDERBUFFER, buffers[0]);
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, second, GL_RENDERBUFFER, buffers[1]);
    return pixel;
}

static void test_several_colours_have_no_second_source(void)
{
    static const GLenum one[1] = {GL_COLOR_ATTACHMENT0};
    GLuint buffers[2];
    attach(buffers);
    TEST_ASSERT_EQUAL_HEX32(0xcc6633ff, blended(EXTENDED SECOND(FIRST), GL_ONE, GL_SRC1_COLOR_EXT));
    EXPECT(GL_INVALID_OPERATION);
    gl_Disable(gl, GL_BLEND);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    EXPECT(GL_NO_ERROR);
    gl_DrawBuffersEXT(gl, 1, one);
    TEST_ASSERT_EQUAL_HEX32(0x33cc2900, blended(EXTENDED SECOND(FIRST), GL_ONE, GL_ONE_MINUS_SRC1_COLOR_EXT));
    EXPECT(GL_NO_ERROR);
}

/* The second element of data and the second colour have one register, but are not used by one draw. */
static void test_a_shader_can_have_a_second_source_and_a_second_target(void)
{
    static const GLenum one[1] = {GL_COLOR_ATTACHMENT0};
    const char *fragment = EXTENDED DRAW_BUFFERS MAIN(
        "gl_FragData[0] = vec4(0.2, 0.4, 0.0, 0.0); gl_FragData[1] = vec4(0.0, 0.0, 1.0, 0.0);"
        "gl_SecondaryFragDataEXT[0] = vec4(1.0, 0.0, 0.2, 1.0);");
    GLuint buffers[2];
    attach(buffers);
    TEST_ASSERT_EQUAL_HEX32(0x33660000, blended(fragment, GL_ONE, GL_ZERO));
    TEST_ASSERT_EQUAL_HEX32(0x0000ff00, second_pixel(buffers));
    gl_DrawBuffersEXT(gl, 1, one);
    TEST_ASSERT_EQUAL_HEX32(0x33cc2900, blended(fragment, GL_ONE, GL_ONE_MINUS_SRC1_COLOR_EXT));
    EXPECT(GL_NO_ERROR);
}

static void test_gl_fragcolor_is_the_colour_of_all_targets(void)
{
    static const GLenum second[2] = {GL_NONE, GL_COLOR_ATTACHMENT0 + 1};
    const char *fragment = MAIN("gl_FragColor = vec4(0.2); if (gl_FragCoord.x > 1.0) gl_FragColor.y = 0.4;");
    GLuint buffers[2];
    attach(buffers);
    TEST_ASSERT_EQUAL_HEX32(0x33663333, blended(fragment, GL_ONE, GL_ZERO));
    TEST_ASSERT_EQUAL_HEX32(0x33663333, second_pixel(buffers));
    gl_DrawBuffersEXT(gl, 2, second);
    TEST_ASSERT_EQUAL_HEX32(0x33663333, blended(MAIN("gl_FragColor = vec4(1.0);"), GL_ONE, GL_ZERO));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, second_pixel(buffers));
    blended(MAIN("gl_FragData[0] = vec4(0.2);"), GL_ONE, GL_ZERO);
    TEST_ASSERT_EQUAL_HEX32(0xcc6633ff, second_pixel(buffers)); /* cleared */
    EXPECT(GL_NO_ERROR);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_second_colour_is_a_factor_of_blending);
    RUN_TEST(test_data_has_a_second_element);
    RUN_TEST(test_the_second_colour_can_depend_on_the_face);
    RUN_TEST(test_target_factors_include_the_saturated_alpha);
    RUN_TEST(test_several_colours_have_no_second_source);
    RUN_TEST(test_a_shader_can_have_a_second_source_and_a_second_target);
    RUN_TEST(test_gl_fragcolor_is_the_colour_of_all_targets);
    return UNITY_END();
}
