/* Extensions of OpenGL ES: clip control, several colours, markers, robustness, sized formats, coverage. */
#include "tests/support/front/gl/screen.h"

#include <string.h>
#include <unity.h>

static struct screen screen;

static const char vertex[] = "attribute vec3 position; uniform float size;"
                             "void main() { gl_PointSize = size; gl_Position = vec4(position, 1.0); }";
static const char flat_fragment[] =
    "precision mediump float; uniform vec4 color; void main() { gl_FragColor = color; }";

void setUp(void)
{
    screen_begin(&screen);
}

void tearDown(void)
{
    screen_end(&screen);
}

#define gl screen.context

static void clear(void)
{
    gl_ClearColor(gl, 0, 0, 0, 0);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

static GLint integer(GLenum name)
{
    GLint value = -1;
    gl_GetIntegerv(gl, name, &value);
    EXPECT(GL_NO_ERROR);
    return value;
}

static void use_white(void)
{
    GLuint program = screen_program(&screen, vertex, flat_fragment);
    gl_Uniform4f(gl, gl_GetUniformLocation(gl, program, "color"), 1, 1, 1, 1);
}

/* --- EXT_clip_control --- */

static void test_the_clip_origin_turns_pictures_over_and_not_faces(void)
{
    use_white();
    TEST_ASSERT_EQUAL_HEX32(GL_LOWER_LEFT_EXT, integer(GL_CLIP_ORIGIN_EXT));
    for (int upper = 0; upper < 2; upper++) {
        gl_ClipControlEXT(gl, upper ? GL_UPPER_LEFT_EXT : GL_LOWER_LEFT_EXT, GL_NEGATIVE_ONE_TO_ONE_EXT);
        clear();
        gl_Enable(gl, GL_CULL_FACE);
        screen_rectangle(&screen, -1, -1, 1, 0, 0);
        TEST_ASSERT_EQUAL_HEX32(upper ? 0 : 0xffffffff, screen_pixel(&screen, 0, 0));
        TEST_ASSERT_EQUAL_HEX32(upper ? 0xffffffff : 0, screen_pixel(&screen, 0, 7));
        clear();
        gl_CullFace(gl, GL_FRONT);
        screen_rectangle(&screen, -1, -1, 1, 1, 0);
        TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 3, 3));
        gl_CullFace(gl, GL_BACK);
        gl_Disable(gl, GL_CULL_FACE);
    }
    TEST_ASSERT_EQUAL_HEX32(GL_UPPER_LEFT_EXT, integer(GL_CLIP_ORIGIN_EXT));
}

static void test_the_clip_origin_changes_neither_facing_nor_coordinates_of_points(void)
{
    GLuint program =
        screen_program(&screen, vertex,
                       "precision mediump float; void main() {"
                       "gl_FragColor = vec4(gl_FrontFacing, gl_PointCoord.y > 0.5, 0.0, 1.0); }");
    static const GLfloat middle[3] = {0, 0, 0};
    gl_Uniform1f(gl, gl_GetUniformLocation(gl, program, "size"), 4);
    for (int upper = 0; upper < 2; upper++) {
        gl_ClipControlEXT(gl, upper ? GL_UPPER_LEFT_EXT : GL_LOWER_LEFT_EXT, GL_NEGATIVE_ONE_TO_ONE_EXT);
        clear();
        screen_rectangle(&screen, -1, -1, 1, 1, 0);
        TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 3, 3) & 0xff00ffff);
        gl_VertexAttribPointer(gl, 0, 3, GL_FLOAT, GL_FALSE, 0, middle);
        gl_DrawArrays(gl, GL_POINTS, 0, 1);
        TEST_ASSERT_EQUAL_HEX32(0xffff00ff, screen_pixel(&screen, 7, 3));
        TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 7, 4));
    }
}

static void test_the_depth_mode_decides_what_is_clipped_and_how_depth_is_stretched(void)
{
    use_white();
    gl_Enable(gl, GL_DEPTH_TEST);
    gl_ClearDepthf(gl, 0.6F);
    for (int zero = 0; zero < 2; zero++) {
        gl_ClipControlEXT(gl, GL_LOWER_LEFT_EXT, zero ? GL_ZERO_TO_ONE_EXT : GL_NEGATIVE_ONE_TO_ONE_EXT);
        clear();
        screen_rectangle(&screen, -1, -1, 1, 1, -0.5F);
        TEST_ASSERT_EQUAL_HEX32(zero ? 0 : 0xffffffff, screen_pixel(&screen, 3, 3));
        clear();
        screen_rectangle(&screen, -1, -1, 1, 1, 0.5F);
        TEST_ASSERT_EQUAL_HEX32(zero ? 0xffffffff : 0, screen_pixel(&screen, 3, 3));
    }
    TEST_ASSERT_EQUAL_HEX32(GL_ZERO_TO_ONE_EXT, integer(GL_CLIP_DEPTH_MODE_EXT));
}

static void test_clip_control_refuses_other_values(void)
{
    gl_ClipControlEXT(gl, GL_LOWER_LEFT_EXT, GL_UPPER_LEFT_EXT);
    EXPECT(GL_INVALID_ENUM);
    gl_ClipControlEXT(gl, GL_ZERO_TO_ONE_EXT, GL_ZERO_TO_ONE_EXT);
    EXPECT(GL_INVALID_ENUM);
    TEST_ASSERT_EQUAL_HEX32(GL_NEGATIVE_ONE_TO_ONE_EXT, integer(GL_CLIP_DEPTH_MODE_EXT));
}

/* --- NV_draw_buffers, NV_fbo_color_attachments --- */

static void attach_colors(GLuint buffers[4])
{
    GLuint framebuffer;
    gl_GenFramebuffers(gl, 1, &framebuffer);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
    gl_GenRenderbuffers(gl, 4, buffers);
    for (GLenum i = 0; i < 4; i++) {
        gl_BindRenderbuffer(gl, GL_RENDERBUFFER, buffers[i]);
        gl_RenderbufferStorage(gl, GL_RENDERBUFFER, i % 2 ? GL_RGB565 : GL_RGBA8_OES, 8, 8);
        gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, GL_RENDERBUFFER, buffers[i]);
    }
}

/* The colour of an attachment, read through colour 0. */
static uint32_t color_of(GLuint buffer)
{
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    return screen_pixel(&screen, 2, 2);
}

static void test_a_fragment_has_as_many_colours_as_attachments(void)
{
    static const GLenum draws[4] = {GL_COLOR_ATTACHMENT0, GL_NONE, GL_COLOR_ATTACHMENT2_EXT,
                                    GL_COLOR_ATTACHMENT3_EXT};
    GLuint buffers[4];
    TEST_ASSERT_EQUAL_INT(4, integer(GL_MAX_COLOR_ATTACHMENTS_NV));
    TEST_ASSERT_EQUAL_INT(4, integer(GL_MAX_DRAW_BUFFERS_NV));
    attach_colors(buffers);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_COMPLETE, gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER));
    gl_DrawBuffersNV(gl, 4, draws);
    TEST_ASSERT_EQUAL_HEX32(GL_COLOR_ATTACHMENT3_EXT, integer(GL_DRAW_BUFFER3_NV));
    clear();
    screen_program(&screen, vertex,
                   "#extension GL_NV_draw_buffers : enable\nprecision mediump float; void main() {"
                   "for (int i = 0; i < 4; i++) gl_FragData[i] = vec4(i == 0, i == 1, i == 2, 1.0); }");
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    for (GLenum i = 1; i < 4; i++)
        gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, GL_RENDERBUFFER, 0);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, color_of(buffers[0]));
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, color_of(buffers[1]));
    TEST_ASSERT_EQUAL_HEX32(0x0000ffff, color_of(buffers[2]));
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, color_of(buffers[3]));
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + 4, GL_RENDERBUFFER, buffers[0]);
    EXPECT(GL_INVALID_ENUM);
    gl_DrawBuffersNV(gl, 5, draws);
    EXPECT(GL_INVALID_VALUE);
}

/* --- KHR_blend_equation_advanced --- */

#define ADVANCED(qualifiers)                                                                                 \
    "#extension GL_KHR_blend_equation_advanced : require\nlayout(" qualifiers ") out;"                       \
    "precision mediump float; uniform vec4 color; void main() { gl_FragColor = color; }"

static void draw_advanced(const char *fragment, GLenum equation)
{
    GLuint program = screen_program(&screen, vertex, fragment);
    gl_ClearColor(gl, 0.8F, 0.4F, 0.2F, 1);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_Enable(gl, GL_BLEND);
    gl_BlendEquation(gl, equation);
    EXPECT(GL_NO_ERROR);
    gl_Uniform4f(gl, gl_GetUniformLocation(gl, program, "color"), 0.2F, 0.6F, 1, 1);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
}

static void test_advanced_equations_blend_colours_that_the_shader_allows(void)
{
    draw_advanced(ADVANCED("blend_support_multiply"), GL_MULTIPLY_KHR);
    TEST_ASSERT_EQUAL_HEX32(0x293d33ff, screen_pixel(&screen, 3, 3));
    TEST_ASSERT_EQUAL_HEX32(GL_MULTIPLY_KHR, integer(GL_BLEND_EQUATION));
    TEST_ASSERT_EQUAL_HEX32(GL_MULTIPLY_KHR, integer(GL_BLEND_EQUATION_ALPHA));
    draw_advanced(ADVANCED("blend_support_darken, blend_support_difference"), GL_DIFFERENCE_KHR);
    TEST_ASSERT_EQUAL_HEX32(0x9933ccff, screen_pixel(&screen, 3, 3));
    draw_advanced(ADVANCED("blend_support_all_equations"), GL_HSL_LUMINOSITY_KHR);
    TEST_ASSERT_EQUAL_HEX32(0xff, screen_pixel(&screen, 3, 3) & 0xff);
    EXPECT(GL_NO_ERROR);
}

static void test_a_draw_needs_a_shader_that_allows_its_equation(void)
{
    draw_advanced(ADVANCED("blend_support_screen"), GL_MULTIPLY_KHR);
    EXPECT(GL_INVALID_OPERATION);
    TEST_ASSERT_EQUAL_HEX32(0xcc6633ff, screen_pixel(&screen, 3, 3));
    gl_Disable(gl, GL_BLEND);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    EXPECT(GL_NO_ERROR);
    draw_advanced(flat_fragment, GL_OVERLAY_KHR);
    EXPECT(GL_INVALID_OPERATION);
}

static void test_advanced_equations_need_a_single_colour(void)
{
    static const GLenum draws[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT0 + 1};
    GLuint buffers[4];
    attach_colors(buffers);
    gl_DrawBuffersNV(gl, 2, draws);
    draw_advanced(ADVANCED("blend_support_screen"), GL_SCREEN_KHR);
    EXPECT(GL_INVALID_OPERATION);
    gl_DrawBuffersNV(gl, 1, draws);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    EXPECT(GL_NO_ERROR);
}

static void test_advanced_equations_are_for_colour_and_alpha_together(void)
{
    gl_BlendEquationSeparate(gl, GL_MULTIPLY_KHR, GL_MULTIPLY_KHR);
    EXPECT(GL_INVALID_ENUM);
    TEST_ASSERT_EQUAL_HEX32(GL_FUNC_ADD, integer(GL_BLEND_EQUATION));
    TEST_ASSERT_TRUE(gl_IsEnabled(gl, GL_BLEND_ADVANCED_COHERENT_KHR));
    gl_Disable(gl, GL_BLEND_ADVANCED_COHERENT_KHR);
    TEST_ASSERT_FALSE(gl_IsEnabled(gl, GL_BLEND_ADVANCED_COHERENT_KHR));
    gl_BlendBarrierKHR(gl);
    EXPECT(GL_NO_ERROR);
}

static GLint compiles(const char *source)
{
    GLint compiled = 0;
    GLuint shader = gl_CreateShader(gl, GL_FRAGMENT_SHADER);
    gl_ShaderSource(gl, shader, 1, &source, NULL);
    gl_CompileShader(gl, shader);
    gl_GetShaderiv(gl, shader, GL_COMPILE_STATUS, &compiled);
    gl_DeleteShader(gl, shader);
    return compiled;
}

static void test_layouts_are_a_part_of_the_extension(void)
{
    TEST_ASSERT_TRUE(compiles(ADVANCED("blend_support_hsl_hue, blend_support_hsl_hue")));
    TEST_ASSERT_FALSE(compiles(ADVANCED("blend_support_hue")));
    TEST_ASSERT_FALSE(compiles("layout(blend_support_screen) out; void main() { }"));
    TEST_ASSERT_TRUE(compiles("void main() { lowp float layout = 0.5; gl_FragColor = vec4(layout); }"));
}

/* --- EXT_debug_marker --- */

struct received {
    unsigned count;
    GLenum type;
    char text[64];
};

static void GL_APIENTRY receive(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                const GLchar *text, const void *user)
{
    struct received *received = (struct received *)user;
    TEST_ASSERT_EQUAL_HEX32(GL_DEBUG_SOURCE_APPLICATION_KHR, source);
    TEST_ASSERT_EQUAL_HEX32(GL_DEBUG_SEVERITY_NOTIFICATION_KHR, severity);
    TEST_ASSERT_EQUAL_UINT(0, id);
    TEST_ASSERT_EQUAL_INT(length, strlen(text));
    received->count++;
    received->type = type;
    strncpy(received->text, text, sizeof received->text - 1);
}

static void test_markers_are_messages_and_never_errors(void)
{
    struct received received = {0};
    char longer[3000];
    memset(longer, 'x', sizeof longer);
    gl_Enable(gl, GL_DEBUG_OUTPUT_KHR);
    gl_DebugMessageCallbackKHR(gl, receive, &received);
    gl_InsertEventMarkerEXT(gl, 3, "eventful");
    TEST_ASSERT_EQUAL_HEX32(GL_DEBUG_TYPE_MARKER_KHR, received.type);
    TEST_ASSERT_EQUAL_STRING("eve", received.text);
    gl_PushGroupMarkerEXT(gl, 0, "group");
    gl_PushGroupMarkerEXT(gl, 0, NULL);
    gl_PushGroupMarkerEXT(gl, sizeof longer, longer);
    gl_PopGroupMarkerEXT(gl);
    gl_PopGroupMarkerEXT(gl);
    gl_PopGroupMarkerEXT(gl);
    TEST_ASSERT_EQUAL_HEX32(GL_DEBUG_TYPE_POP_GROUP_KHR, received.type);
    TEST_ASSERT_EQUAL_STRING("group", received.text);
    TEST_ASSERT_EQUAL_UINT(7, received.count);
    gl_PopGroupMarkerEXT(gl);
    gl_InsertEventMarkerEXT(gl, -1, "ignored");
    TEST_ASSERT_EQUAL_UINT(7, received.count);
    for (int i = 0; i < 100; i++)
        gl_PushGroupMarkerEXT(gl, 0, "many");
    for (int i = 0; i < 99; i++)
        gl_PopGroupMarkerEXT(gl);
    EXPECT(GL_NO_ERROR);
    TEST_ASSERT_EQUAL_INT(1, integer(GL_DEBUG_GROUP_STACK_DEPTH_KHR));
}

/* --- EXT_robustness --- */

static void test_reads_stay_within_their_sizes(void)
{
    uint8_t pixels[2 * 12 + 1];
    GLfloat values[5] = {7, 7, 7, 7, 7};
    GLint integers[4] = {7, 7, 7, 7};
    GLuint program = screen_program(&screen, vertex, flat_fragment);
    GLint place = gl_GetUniformLocation(gl, program, "color");
    memset(pixels, 0x55, sizeof pixels);
    gl_ClearColor(gl, 1, 1, 1, 1);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_PixelStorei(gl, GL_PACK_ALIGNMENT, 8);
    gl_ReadnPixelsEXT(gl, 0, 0, 3, 2, GL_RGBA, GL_UNSIGNED_BYTE, 27, pixels);
    EXPECT(GL_INVALID_OPERATION);
    TEST_ASSERT_EQUAL_HEX8(0x55, pixels[0]);
    gl_ReadnPixelsEXT(gl, 0, 0, 3, 1, GL_RGBA, GL_UNSIGNED_BYTE, 12, pixels);
    EXPECT(GL_NO_ERROR);
    TEST_ASSERT_EQUAL_HEX8(0xff, pixels[11]);
    TEST_ASSERT_EQUAL_HEX8(0x55, pixels[12]);
    gl_ReadnPixelsEXT(gl, 0, 0, INT32_MAX, INT32_MAX, GL_RGBA, GL_UNSIGNED_BYTE, INT32_MAX, pixels);
    EXPECT(GL_INVALID_OPERATION);
    gl_ReadnPixelsEXT(gl, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, -1, pixels);
    EXPECT(GL_INVALID_VALUE);
    gl_ReadnPixelsEXT(gl, 0, 0, 0, 1, GL_RGBA, GL_UNSIGNED_BYTE, -1, pixels);
    EXPECT(GL_INVALID_VALUE);
    gl_ReadnPixelsEXT(gl, 0, 0, -1, 1, GL_RGBA, GL_UNSIGNED_BYTE, 12, pixels);
    EXPECT(GL_INVALID_VALUE);
    gl_ReadnPixelsEXT(gl, 0, 0, 0, 1, GL_RGBA, GL_UNSIGNED_BYTE, 0, pixels);
    EXPECT(GL_NO_ERROR);
    gl_Uniform4f(gl, place, 1, 2, 3, 4);
    gl_GetnUniformfvEXT(gl, program, place, 15, values);
    EXPECT(GL_INVALID_OPERATION);
    TEST_ASSERT_EQUAL_FLOAT(7, values[0]);
    gl_GetnUniformfvEXT(gl, program, place, 16, values);
    gl_GetnUniformivEXT(gl, program, place, 16, integers);
    EXPECT(GL_NO_ERROR);
    TEST_ASSERT_EQUAL_FLOAT(4, values[3]);
    TEST_ASSERT_EQUAL_FLOAT(7, values[4]);
    TEST_ASSERT_EQUAL_INT(4, integers[3]);
    gl_GetnUniformivEXT(gl, program, place, -1, integers);
    EXPECT(GL_INVALID_OPERATION);
}

static void test_a_context_reports_its_robustness(void)
{
    TEST_ASSERT_EQUAL_HEX32(GL_NO_ERROR, gl_GetGraphicsResetStatusEXT(gl));
    TEST_ASSERT_EQUAL_INT(0, integer(GL_CONTEXT_ROBUST_ACCESS_EXT));
    TEST_ASSERT_EQUAL_HEX32(GL_NO_RESET_NOTIFICATION_EXT, integer(GL_RESET_NOTIFICATION_STRATEGY_EXT));
}

/* --- OES_required_internalformat --- */

static void define(GLenum internal_format, GLenum format, GLenum type)
{
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, (GLint)internal_format, 4, 4, 0, format, type, NULL);
}

static void test_internal_formats_can_have_a_size(void)
{
    GLuint texture;
    gl_GenTextures(gl, 1, &texture);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    define(GL_RGBA8_OES, GL_RGBA, GL_UNSIGNED_BYTE);
    define(GL_RGB5_A1, GL_RGBA, GL_UNSIGNED_BYTE);
    define(GL_RGB565, GL_RGB, GL_UNSIGNED_SHORT_5_6_5);
    define(GL_LUMINANCE4_ALPHA4_OES, GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE);
    define(GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
    define(GL_DEPTH24_STENCIL8_OES, GL_DEPTH_STENCIL_OES, GL_UNSIGNED_INT_24_8_OES);
    define(GL_RGB10_A2_EXT, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV_EXT);
    gl_CopyTexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGB565, 0, 0, 4, 4, 0);
    gl_CopyTexImage2D(gl, GL_TEXTURE_2D, 0, GL_LUMINANCE8_OES, 0, 0, 4, 4, 0);
    EXPECT(GL_NO_ERROR);
    define(GL_RGBA8_OES, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4);
    EXPECT(GL_INVALID_OPERATION);
    define(GL_RGBA8_OES, GL_RGB, GL_UNSIGNED_BYTE);
    EXPECT(GL_INVALID_OPERATION);
    define(GL_DEPTH_COMPONENT24_OES, GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT);
    EXPECT(GL_INVALID_OPERATION);
    define(GL_STENCIL_INDEX8, GL_RGBA, GL_UNSIGNED_BYTE);
    EXPECT(GL_INVALID_VALUE);
    gl_CopyTexImage2D(gl, GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT16, 0, 0, 4, 4, 0);
    EXPECT(GL_INVALID_ENUM);
}

static void test_a_copy_with_ten_bits_has_no_alpha(void)
{
    GLuint texture;
    gl_ClearColor(gl, 0, 1, 0, 0);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    screen_program(&screen, vertex,
                   "precision mediump float; uniform sampler2D image;"
                   "void main() { gl_FragColor = texture2D(image, vec2(0.1)); }");
    gl_GenTextures(gl, 1, &texture);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_CopyTexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGB10_EXT, 0, 0, 4, 4, 0);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 3, 3));
}

static void test_levels_with_two_internal_formats_do_not_form_a_set(void)
{
    static const uint32_t texels[16] = {0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff};
    GLuint texture;
    screen_program(&screen, vertex,
                   "precision mediump float; uniform sampler2D image;"
                   "void main() { gl_FragColor = texture2D(image, vec2(0.1)); }");
    gl_GenTextures(gl, 1, &texture);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    for (int same = 0; same < 2; same++) {
        gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA8_OES, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
        gl_TexImage2D(gl, GL_TEXTURE_2D, 1, same ? GL_RGBA8_OES : GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                      texels);
        screen_rectangle(&screen, -1, -1, 1, 1, 0);
        TEST_ASSERT_EQUAL_HEX32(same ? 0xffffffff : 0x000000ff, screen_pixel(&screen, 3, 3));
    }
}

/* --- Samples --- */

/* With four samples, alpha of one half leaves two. */
static void test_alpha_and_a_value_can_decide_on_samples(void)
{
    const struct triptych_image_description description = {
        .format = TRIPTYCH_SURFACE_A8B8G8R8, .width = SCREEN_WIDTH, .height = SCREEN_HEIGHT, .samples = 4};
    struct gl_surface surface = screen.surface;
    TEST_ASSERT_EQUAL(TRIPTYCH_OK,
                      triptych_image_create(screen.device->renderer, &description, &surface.color.image));
    surface.depth.image = NULL;
    surface.depth_bits = surface.stencil_bits = 0;
    surface.samples = 4;
    TEST_ASSERT_TRUE(gl_context_bind(gl, &surface, &surface));
    GLuint program = screen_program(&screen, vertex, flat_fragment);
    gl_Uniform4f(gl, gl_GetUniformLocation(gl, program, "color"), 1, 1, 1, 0.5F);
    for (int i = 0; i < 3; i++) {
        clear();
        (i == 1 ? gl_Enable : gl_Disable)(gl, GL_SAMPLE_ALPHA_TO_COVERAGE);
        (i == 2 ? gl_Enable : gl_Disable)(gl, GL_SAMPLE_COVERAGE);
        gl_SampleCoverage(gl, 0.25F, GL_TRUE);
        screen_rectangle(&screen, -1, -1, 1, 1, 0);
        static const uint8_t reds[3] = {255, 128, 191};
        TEST_ASSERT_EQUAL_HEX8(reds[i], screen_pixel(&screen, 3, 3) >> 24);
    }
    TEST_ASSERT_TRUE(gl_context_bind(gl, &screen.surface, &screen.surface));
    triptych_image_destroy(screen.device->renderer, surface.color.image);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_clip_origin_turns_pictures_over_and_not_faces);
    RUN_TEST(test_the_clip_origin_changes_neither_facing_nor_coordinates_of_points);
    RUN_TEST(test_the_depth_mode_decides_what_is_clipped_and_how_depth_is_stretched);
    RUN_TEST(test_clip_control_refuses_other_values);
    RUN_TEST(test_a_fragment_has_as_many_colours_as_attachments);
    RUN_TEST(test_advanced_equations_blend_colours_that_the_shader_allows);
    RUN_TEST(test_a_draw_needs_a_shader_that_allows_its_equation);
    RUN_TEST(test_advanced_equations_need_a_single_colour);
    RUN_TEST(test_advanced_equations_are_for_colour_and_alpha_together);
    RUN_TEST(test_layouts_are_a_part_of_the_extension);
    RUN_TEST(test_markers_are_messages_and_never_errors);
    RUN_TEST(test_reads_stay_within_their_sizes);
    RUN_TEST(test_a_context_reports_its_robustness);
    RUN_TEST(test_internal_formats_can_have_a_size);
    RUN_TEST(test_a_copy_with_ten_bits_has_no_alpha);
    RUN_TEST(test_levels_with_two_internal_formats_do_not_form_a_set);
    RUN_TEST(test_alpha_and_a_value_can_decide_on_samples);
    return UNITY_END();
}
