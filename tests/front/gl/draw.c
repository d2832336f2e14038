/* Programs, attributes, draws, textures and tests of fragments of OpenGL ES. */
#include "tests/support/front/gl/screen.h"

#include <string.h>
#include <unity.h>

static struct screen screen;

static const char flat_vertex[] =
    "attribute vec3 position; void main() { gl_Position = vec4(position, 1.0); }";
static const char flat_fragment[] =
    "precision mediump float; uniform vec4 color; void main() { gl_FragColor = color; }";
static const char texture_vertex[] =
    "attribute vec3 position; varying vec2 at;"
    "void main() { at = position.xy * 0.5 + 0.5; gl_Position = vec4(position, 1.0); }";
static const char texture_fragment[] = "precision mediump float; varying vec2 at; uniform sampler2D image;"
                                       "void main() { gl_FragColor = texture2D(image, at); }";

void setUp(void)
{
    screen_begin(&screen);
}

void tearDown(void)
{
    screen_end(&screen);
}

#define gl screen.context

static void use_color(GLuint program, float red, float green, float blue, float alpha)
{
    gl_Uniform4f(gl, gl_GetUniformLocation(gl, program, "color"), red, green, blue, alpha);
}

static void test_row_0_is_at_the_bottom(void)
{
    GLuint program = screen_program(&screen, flat_vertex, flat_fragment);
    use_color(program, 1, 0.5F, 0, 1);
    screen_rectangle(&screen, -1, -1, 0, -0.5F, 0);
    TEST_ASSERT_EQUAL_HEX32(0xff8000ff, screen_pixel(&screen, 0, 0));
    TEST_ASSERT_EQUAL_HEX32(0xff8000ff, screen_pixel(&screen, 7, 1));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 8, 1));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 0, 2));
    gl_DeleteProgram(gl, program);
    GLint deleted = 0;
    gl_GetProgramiv(gl, program, GL_DELETE_STATUS, &deleted);
    TEST_ASSERT_TRUE(deleted);
    gl_UseProgram(gl, 0);
    TEST_ASSERT_FALSE(gl_IsProgram(gl, program));
}

static void test_faces_are_culled_by_their_winding(void)
{
    GLuint program = screen_program(&screen, flat_vertex, flat_fragment);
    use_color(program, 0, 1, 0, 1);
    gl_Enable(gl, GL_CULL_FACE);
    gl_CullFace(gl, GL_FRONT);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 3, 3));
    gl_FrontFace(gl, GL_CW);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 3, 3));
}

static void test_the_front_of_a_fragment_is_that_of_its_winding(void)
{
    static const char fragment[] =
        "precision mediump float; void main() { gl_FragColor = vec4(gl_FrontFacing, 0.0, 0.0, 1.0); }";
    static const char vertex[] = "attribute vec3 position;"
                                 "void main() { gl_PointSize = 2.0; gl_Position = vec4(position, 1.0); }";
    screen_program(&screen, vertex, fragment);
    screen_rectangle(&screen, -1, -1, 0, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 3, 3));
    gl_FrontFace(gl, GL_CW);
    screen_rectangle(&screen, -1, -1, 0, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, screen_pixel(&screen, 3, 3));
    screen_rectangle(&screen, 1, -1, 0, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 12, 3));
    gl_VertexAttribPointer(gl, 0, 3, GL_FLOAT, GL_FALSE, 0, (const float[3]){-0.5F, 0, 0});
    gl_EnableVertexAttribArray(gl, 0);
    gl_DrawArrays(gl, GL_POINTS, 0, 1);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 4, 4));
    gl_FrontFace(gl, GL_CCW);
    screen_rectangle(&screen, 1, -1, 0, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, screen_pixel(&screen, 12, 3));
}

static void test_coordinates_of_points_begin_at_the_top(void)
{
    static const char fragment[] =
        "precision mediump float; void main() { gl_FragColor = vec4(gl_PointCoord, 0.0, 1.0); }";
    static const char vertex[] = "attribute vec3 position;"
                                 "void main() { gl_PointSize = 4.0; gl_Position = vec4(position, 1.0); }";
    screen_program(&screen, vertex, fragment);
    gl_VertexAttribPointer(gl, 0, 3, GL_FLOAT, GL_FALSE, 0, (const float[3]){0, 0, 0});
    gl_EnableVertexAttribArray(gl, 0);
    gl_DrawArrays(gl, GL_POINTS, 0, 1);
    TEST_ASSERT_EQUAL_HEX32(0x20df00ff, screen_pixel(&screen, 6, 2));
    TEST_ASSERT_EQUAL_HEX32(0xdf2000ff, screen_pixel(&screen, 9, 5));
}

static void test_depth_and_blending_follow_their_functions(void)
{
    GLuint program = screen_program(&screen, flat_vertex, flat_fragment);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl_Enable(gl, GL_DEPTH_TEST);
    use_color(program, 0, 0, 1, 1);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    use_color(program, 1, 0, 0, 1);
    screen_rectangle(&screen, -1, -1, 1, 1, 0.5F);
    TEST_ASSERT_EQUAL_HEX32(0x0000ffff, screen_pixel(&screen, 3, 3));
    gl_Enable(gl, GL_BLEND);
    gl_BlendFunc(gl, GL_ONE, GL_ONE);
    screen_rectangle(&screen, -1, -1, 1, 1, -0.5F);
    TEST_ASSERT_EQUAL_HEX32(0xff00ffff, screen_pixel(&screen, 3, 3));
}

static void test_colors_are_multiplied_by_the_constant_alpha(void)
{
    GLuint program = screen_program(&screen, flat_vertex, flat_fragment);
    gl_ClearColor(gl, 0, 0, 0, 1);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_Enable(gl, GL_BLEND);
    gl_BlendColor(gl, 0, 0, 1, 0.6F);
    gl_BlendFuncSeparate(gl, GL_CONSTANT_ALPHA, GL_ZERO, GL_ZERO, GL_ONE_MINUS_CONSTANT_COLOR);
    use_color(program, 1, 0, 1, 1);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x99009966, screen_pixel(&screen, 3, 3));
}

/* Section 3.4.2. The line is at the centres of row 3. */
static void test_wide_lines_have_their_pixels_across(void)
{
    static const GLfloat ends[2][3] = {{-1, -0.125F, 0}, {0, -0.125F, 0}};
    GLuint program = screen_program(&screen, flat_vertex, flat_fragment);
    GLfloat range[2];
    use_color(program, 1, 1, 1, 1);
    gl_GetFloatv(gl, GL_ALIASED_LINE_WIDTH_RANGE, range);
    TEST_ASSERT_EQUAL_FLOAT(1, range[0]);
    TEST_ASSERT_EQUAL_FLOAT(64, range[1]);
    gl_LineWidth(gl, 3);
    gl_VertexAttribPointer(gl, 0, 3, GL_FLOAT, GL_FALSE, 0, ends);
    gl_EnableVertexAttribArray(gl, 0);
    gl_DrawArrays(gl, GL_LINES, 0, 2);
    for (int y = 0; y < 8; y++)
        TEST_ASSERT_EQUAL_HEX32(y >= 2 && y <= 4 ? 0xffffffff : 0, screen_pixel(&screen, 4, y));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 8, 3));
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_Viewport(gl, 0, 3, 16, 8);
    gl_LineWidth(gl, 9);
    gl_DrawArrays(gl, GL_LINES, 0, 2);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 4, 3));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 4, 2));
    gl_Viewport(gl, 0, 0, 16, 8);
    gl_LineWidth(gl, 1e9F);
    gl_DrawArrays(gl, GL_LINES, 0, 2);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 4, 0));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 4, 7));
    gl_LineWidth(gl, -1);
    EXPECT(GL_INVALID_VALUE);
}

static void test_stencil_counts_and_excludes(void)
{
    GLuint program = screen_program(&screen, flat_vertex, flat_fragment);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    gl_Enable(gl, GL_STENCIL_TEST);
    gl_StencilOp(gl, GL_KEEP, GL_KEEP, GL_INCR);
    use_color(program, 1, 1, 1, 1);
    screen_rectangle(&screen, -1, -1, 0, 1, 0);
    gl_StencilFunc(gl, GL_EQUAL, 1, 0xff);
    use_color(program, 0, 1, 0, 1);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 2, 2));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 12, 2));
}

static void test_elements_read_buffers_of_any_type(void)
{
    static const GLbyte corners[] = {-128, -128, 127, -128, 127, 127, -128, 127};
    static const GLubyte indices[] = {9, 0, 1, 2, 0, 2, 3};
    GLuint buffers[2];
    GLuint program = screen_program(&screen, flat_vertex, flat_fragment);
    use_color(program, 0, 1, 1, 1);
    gl_GenBuffers(gl, 2, buffers);
    gl_BindBuffer(gl, GL_ARRAY_BUFFER, buffers[0]);
    gl_BufferData(gl, GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
    gl_VertexAttribPointer(gl, 0, 2, GL_BYTE, GL_TRUE, 0, NULL);
    gl_EnableVertexAttribArray(gl, 0);
    gl_BindBuffer(gl, GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    gl_BufferData(gl, GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices, GL_STATIC_DRAW);
    gl_DrawElements(gl, GL_TRIANGLES, 6, GL_UNSIGNED_BYTE, (const void *)1);
    TEST_ASSERT_EQUAL_HEX32(0x00ffffff, screen_pixel(&screen, 0, 0));
    TEST_ASSERT_EQUAL_HEX32(0x00ffffff, screen_pixel(&screen, 15, 7));
    gl_DrawElements(gl, GL_TRIANGLES, 600, GL_UNSIGNED_INT, (const void *)1);
    gl_DrawElements(gl, GL_TRIANGLES, 6, GL_FLOAT, NULL);
    EXPECT(GL_INVALID_ENUM);
    gl_DeleteBuffers(gl, 2, buffers);
}

static void test_attributes_without_an_array_have_a_current_value(void)
{
    static const char vertex[] = "attribute vec3 position; attribute vec4 tint; varying vec4 shade;"
                                 "void main() { shade = tint; gl_Position = vec4(position, 1.0); }";
    static const char fragment[] =
        "precision mediump float; varying vec4 shade; void main() { gl_FragColor = shade; }";
    GLuint program = screen_program(&screen, vertex, fragment);
    GLint tint = gl_GetAttribLocation(gl, program, "tint");
    TEST_ASSERT_TRUE(tint > 0);
    gl_VertexAttrib3f(gl, (GLuint)tint, 1, 0, 1);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    gl_VertexAttrib4f(gl, (GLuint)tint, 0, 1, 0, 1);
    screen_rectangle(&screen, 0, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0xff00ffff, screen_pixel(&screen, 1, 1));
    TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 12, 1));
}

static void test_textures_are_sampled_if_they_are_complete(void)
{
    static const uint8_t texels[2][2][4] = {{{255, 0, 0, 255}, {0, 255, 0, 255}},
                                            {{0, 0, 255, 255}, {255, 255, 255, 255}}};
    GLuint texture;
    GLuint program = screen_program(&screen, texture_vertex, texture_fragment);
    gl_Uniform1i(gl, gl_GetUniformLocation(gl, program, "image"), 3);
    gl_ActiveTexture(gl, GL_TEXTURE3);
    gl_GenTextures(gl, 1, &texture);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, screen_pixel(&screen, 1, 1));
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 1, 1));
    TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 14, 1));
    TEST_ASSERT_EQUAL_HEX32(0x0000ffff, screen_pixel(&screen, 1, 6));
    gl_GenerateMipmap(gl, GL_TEXTURE_2D);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    gl_TexSubImage2D(gl, GL_TEXTURE_2D, 0, 1, 0, 1, 1, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4,
                     &(uint16_t){0x0f0f});
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 1, 1));
    gl_DeleteTextures(gl, 1, &texture);
}

static void test_a_framebuffer_texture_is_drawn_to_and_sampled(void)
{
    GLuint texture, framebuffer;
    GLuint flat = screen_program(&screen, flat_vertex, flat_fragment);
    gl_GenTextures(gl, 1, &texture);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGB, 4, 4, 0, GL_RGB, GL_UNSIGNED_SHORT_5_6_5, NULL);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_GenFramebuffers(gl, 1, &framebuffer);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
    gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    gl_Viewport(gl, 0, 0, 4, 4);
    use_color(flat, 1, 1, 0, 1);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    screen_rectangle(&screen, -1, -1, 0, 0, 0);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, 0);
    gl_Viewport(gl, 0, 0, SCREEN_WIDTH, SCREEN_HEIGHT);
    screen_program(&screen, texture_vertex, texture_fragment);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0xffff00ff, screen_pixel(&screen, 1, 1));
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, screen_pixel(&screen, 12, 1));
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, screen_pixel(&screen, 1, 6));
    gl_DeleteFramebuffers(gl, 1, &framebuffer);
    gl_DeleteTextures(gl, 1, &texture);
}

static GLuint make_depth(GLenum format, GLenum type, const void *texels)
{
    GLuint texture;
    gl_GenTextures(gl, 1, &texture);
    gl_BindTexture(gl, GL_TEXTURE_2D, texture);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, (GLint)format, 2, 2, 0, format, type, texels);
    EXPECT(GL_NO_ERROR);
    return texture;
}

/* The depth of two texels, as luminance. */
static void expect_depth(uint32_t left, uint32_t right)
{
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(left * 0x01010100u | 0xff, screen_pixel(&screen, 1, 1));
    TEST_ASSERT_EQUAL_HEX32(right * 0x01010100u | 0xff, screen_pixel(&screen, 14, 1));
}

static void test_textures_of_depth_are_luminance(void)
{
    static const uint16_t shorts[2][2] = {{0, 0xffff}, {0x8000, 1}};
    static const uint32_t integers[2][2] = {{0x80000000, 0xffffffff}, {0, 0}},
                          packed[2][2] = {{0xffffff00, 0x400000ff}, {0, 0}};
    screen_program(&screen, texture_vertex, texture_fragment);
    GLuint textures[] = {make_depth(GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, shorts),
                         make_depth(GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, integers),
                         make_depth(GL_DEPTH_STENCIL_OES, GL_UNSIGNED_INT_24_8_OES, packed)};
    expect_depth(0xff, 0x40);
    gl_BindTexture(gl, GL_TEXTURE_2D, textures[1]);
    expect_depth(0x80, 0xff);
    gl_BindTexture(gl, GL_TEXTURE_2D, textures[0]);
    expect_depth(0, 0xff);
    gl_TexSubImage2D(gl, GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, &integers[0][0]);
    expect_depth(0x80, 0xff);
    gl_DeleteTextures(gl, 3, textures);
}

static void test_textures_of_depth_are_drawn_to_and_sampled(void)
{
    GLuint framebuffer, flat = screen_program(&screen, flat_vertex, flat_fragment);
    GLuint texture = make_depth(GL_DEPTH_STENCIL_OES, GL_UNSIGNED_INT_24_8_OES, NULL);
    gl_GenFramebuffers(gl, 1, &framebuffer);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
    gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    TEST_ASSERT_EQUAL_HEX(GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT,
                          gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER));
    gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
    gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
    gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, GL_STENCIL_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
    TEST_ASSERT_EQUAL_HEX(GL_FRAMEBUFFER_COMPLETE, gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER));
    gl_Viewport(gl, 0, 0, 2, 2);
    gl_Clear(gl, GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    gl_Enable(gl, GL_DEPTH_TEST);
    use_color(flat, 1, 1, 0, 1);
    screen_rectangle(&screen, -1, -1, 0, 1, 0);
    gl_Disable(gl, GL_DEPTH_TEST);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, 0);
    gl_Viewport(gl, 0, 0, SCREEN_WIDTH, SCREEN_HEIGHT);
    screen_program(&screen, texture_vertex, texture_fragment);
    expect_depth(0x80, 0xff);
    gl_DeleteFramebuffers(gl, 1, &framebuffer);
    gl_DeleteTextures(gl, 1, &texture);
}

static void test_textures_of_depth_are_of_two_dimensions_without_copies_and_mipmaps(void)
{
    GLuint texture = make_depth(GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, NULL), cube;
    gl_GenerateMipmap(gl, GL_TEXTURE_2D);
    EXPECT(GL_INVALID_OPERATION);
    gl_CopyTexImage2D(gl, GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT, 0, 0, 2, 2, 0);
    EXPECT(GL_INVALID_ENUM);
    gl_CopyTexSubImage2D(gl, GL_TEXTURE_2D, 0, 0, 0, 0, 0, 2, 2);
    EXPECT(GL_INVALID_OPERATION);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT, 2, 2, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_BYTE,
                  NULL);
    EXPECT(GL_INVALID_OPERATION);
    gl_GenTextures(gl, 1, &cube);
    gl_BindTexture(gl, GL_TEXTURE_CUBE_MAP, cube);
    gl_TexImage2D(gl, GL_TEXTURE_CUBE_MAP_POSITIVE_X, 0, GL_DEPTH_COMPONENT, 2, 2, 0, GL_DEPTH_COMPONENT,
                  GL_UNSIGNED_SHORT, NULL);
    EXPECT(GL_INVALID_OPERATION);
    gl_DeleteTextures(gl, 2, (GLuint[]){texture, cube});
}

static void test_an_offset_of_one_unit_is_resolved_at_every_depth(void)
{
    GLuint program = screen_program(&screen, flat_vertex, flat_fragment);
    gl_Enable(gl, GL_DEPTH_TEST);
    gl_Enable(gl, GL_POLYGON_OFFSET_FILL);
    for (float z = -0.96875F; z < 0.96875F; z += 0.03125F) {
        gl_Clear(gl, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        gl_PolygonOffset(gl, 0, 1);
        use_color(program, 1, 0, 0, 1);
        screen_rectangle(&screen, -1, -1, 1, 1, z);
        gl_PolygonOffset(gl, 0, 0);
        use_color(program, 0, 1, 0, 1);
        screen_rectangle(&screen, -1, -1, 0, 1, z);
        gl_PolygonOffset(gl, 0, -1);
        screen_rectangle(&screen, -1, -1, 0, 1, z);
        TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 1, 1));
        TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 12, 1));
        use_color(program, 0, 0, 1, 1);
        gl_PolygonOffset(gl, 0, 0);
        screen_rectangle(&screen, -1, -1, 0, 1, z);
        TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 1, 1));
    }
}

static void test_points_are_cut_at_the_sides_of_the_viewport(void)
{
    static const char vertex[] = "attribute vec3 position;"
                                 "void main() { gl_PointSize = 4.0; gl_Position = vec4(position, 1.0); }";
    static const float centers[2][3] = {{1.25F, 0, 0}, {1.75F, 0, 0}};
    GLuint program = screen_program(&screen, vertex, flat_fragment);
    use_color(program, 1, 1, 1, 1);
    gl_Viewport(gl, 0, 0, 8, 8);
    gl_VertexAttribPointer(gl, 0, 3, GL_FLOAT, GL_FALSE, 0, centers);
    gl_EnableVertexAttribArray(gl, 0);
    gl_DrawArrays(gl, GL_POINTS, 0, 2);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 7, 3));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 8, 3));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 11, 3));
}

/* A part of an image in memory: EXT_unpack_subimage. */
static void test_rows_and_texels_of_an_image_are_skipped(void)
{
    static const uint32_t image[3][4] = {
        {1, 2, 3, 4}, {5, 6, 0xff0000ff, 0xff00ff00}, {9, 10, 0xffff0000, 0xffffffff}};
    GLint length = 0;
    screen_program(&screen, texture_vertex, texture_fragment);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_PixelStorei(gl, GL_UNPACK_ROW_LENGTH_EXT, 4);
    gl_PixelStorei(gl, GL_UNPACK_SKIP_ROWS_EXT, 1);
    gl_PixelStorei(gl, GL_UNPACK_SKIP_PIXELS_EXT, 2);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, image);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 2, 1));
    TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 13, 1));
    TEST_ASSERT_EQUAL_HEX32(0x0000ffff, screen_pixel(&screen, 2, 6));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 13, 6));
    gl_PixelStorei(gl, GL_UNPACK_SKIP_PIXELS_EXT, -1);
    EXPECT(GL_INVALID_VALUE);
    gl_GetIntegerv(gl, GL_UNPACK_ROW_LENGTH_EXT, &length);
    TEST_ASSERT_EQUAL_INT(4, length);
}

/* Each face of 2x2 texels is black on the left and white on the right. */
static void make_striped_cube(GLenum wrap)
{
    static const uint8_t texels[2][2] = {{0, 255}, {0, 255}};
    gl_PixelStorei(gl, GL_UNPACK_ALIGNMENT, 1);
    for (GLenum face = 0; face < 6; face++)
        gl_TexImage2D(gl, GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_LUMINANCE, 2, 2, 0, GL_LUMINANCE,
                      GL_UNSIGNED_BYTE, texels);
    gl_TexParameteri(gl, GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_TexParameteri(gl, GL_TEXTURE_CUBE_MAP, GL_TEXTURE_WRAP_S, (GLint)wrap);
}

static void test_faces_of_cubes_are_wrapped(void)
{
    static const char fragment[] = "precision mediump float; uniform samplerCube image; void main()"
                                   "{ gl_FragColor = textureCube(image, vec3(0.999, 0.0, 1.0)); }";
    GLuint texture;
    screen_program(&screen, flat_vertex, fragment);
    gl_GenTextures(gl, 1, &texture);
    gl_BindTexture(gl, GL_TEXTURE_CUBE_MAP, texture);
    make_striped_cube(GL_CLAMP_TO_EDGE);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 3, 3));
    make_striped_cube(GL_REPEAT);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_UINT8_WITHIN(2, 0x80, screen_pixel(&screen, 3, 3) >> 24);
    gl_DeleteTextures(gl, 1, &texture);
}

static void test_uniforms_check_types_and_return_values(void)
{
    static const char fragment[] =
        "precision mediump float; uniform vec4 color; uniform float scale[3]; uniform bool on;"
        "void main() { gl_FragColor = color * scale[1] * float(on) + scale[2]; }";
    GLuint program = screen_program(&screen, flat_vertex, fragment);
    const GLfloat scales[] = {2, 3};
    GLfloat number = 0;
    GLint color = gl_GetUniformLocation(gl, program, "color"), on = gl_GetUniformLocation(gl, program, "on");
    GLint second = gl_GetUniformLocation(gl, program, "scale[1]");
    TEST_ASSERT_EQUAL_INT(gl_GetUniformLocation(gl, program, "scale") + 1, second);
    TEST_ASSERT_EQUAL_INT(-1, gl_GetUniformLocation(gl, program, "scale[3]"));
    gl_Uniform1fv(gl, second, 2, scales);
    gl_GetUniformfv(gl, program, gl_GetUniformLocation(gl, program, "scale[2]"), &number);
    TEST_ASSERT_EQUAL_FLOAT(3, number);
    gl_Uniform1i(gl, on, 7);
    gl_GetUniformfv(gl, program, on, &number);
    TEST_ASSERT_EQUAL_FLOAT(1, number);
    gl_Uniform1f(gl, -1, 1);
    EXPECT(GL_NO_ERROR);
    gl_Uniform4i(gl, color, 1, 1, 1, 1);
    EXPECT(GL_INVALID_OPERATION);
    gl_Uniform3f(gl, color, 1, 1, 1);
    EXPECT(GL_INVALID_OPERATION);
    gl_Uniform4fv(gl, color, 2, (const GLfloat[8]){0});
    EXPECT(GL_INVALID_OPERATION);
    gl_Uniform4fv(gl, color, -1, (const GLfloat[8]){0});
    EXPECT(GL_INVALID_VALUE);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_row_0_is_at_the_bottom);
    RUN_TEST(test_faces_are_culled_by_their_winding);
    RUN_TEST(test_the_front_of_a_fragment_is_that_of_its_winding);
    RUN_TEST(test_coordinates_of_points_begin_at_the_top);
    RUN_TEST(test_depth_and_blending_follow_their_functions);
    RUN_TEST(test_colors_are_multiplied_by_the_constant_alpha);
    RUN_TEST(test_wide_lines_have_their_pixels_across);
    RUN_TEST(test_stencil_counts_and_excludes);
    RUN_TEST(test_elements_read_buffers_of_any_type);
    RUN_TEST(test_attributes_without_an_array_have_a_current_value);
    RUN_TEST(test_textures_are_sampled_if_they_are_complete);
    RUN_TEST(test_a_framebuffer_texture_is_drawn_to_and_sampled);
    RUN_TEST(test_textures_of_depth_are_luminance);
    RUN_TEST(test_textures_of_depth_are_drawn_to_and_sampled);
    RUN_TEST(test_textures_of_depth_are_of_two_dimensions_without_copies_and_mipmaps);
    RUN_TEST(test_an_offset_of_one_unit_is_resolved_at_every_depth);
    RUN_TEST(test_points_are_cut_at_the_sides_of_the_viewport);
    RUN_TEST(test_rows_and_texels_of_an_image_are_skipped);
    RUN_TEST(test_faces_of_cubes_are_wrapped);
    RUN_TEST(test_uniforms_check_types_and_return_values);
    return UNITY_END();
}
