/* Draws of OpenGL ES 1.1, with pixels that are worked out by hand: colours, matrices, tests, primitives,
 * arrays, getters. */
#include "tests/front/gl/fixed_screen.h"

#include <string.h>
#include <unity.h>

void setUp(void)
{
    screen_begin_1(&screen);
}

void tearDown(void)
{
    screen_end(&screen);
}

static void test_the_current_color_is_drawn_and_clamped(void)
{
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, drawn());
    gl_Color4f(gl, 2, 0.2F, -1, 0.4F);
    TEST_ASSERT_EQUAL_HEX32(0xff330066, drawn());
    gl_Color4ub(gl, 1, 2, 3, 4);
    TEST_ASSERT_EQUAL_HEX32(0x01020304, drawn());
    gl_Color4x(gl, 0x10000, 0, 0x8000, 0x10000);
    TEST_ASSERT_EQUAL_HEX32(0xff0080ff, drawn());
}

static void test_matrices_are_multiplied_in_their_order_and_kept_on_stacks(void)
{
    GLfloat matrix[16];
    GLint depth;
    gl_PushMatrix(gl);
    gl_Translatef(gl, 0.5F, 0, 0);
    gl_Scalef(gl, 0.25F, 1, 1);
    gl_Rotatef(gl, 90, 0, 0, 2);
    gl_GetFloatv(gl, GL_MODELVIEW_MATRIX, matrix);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, matrix[12]);
    TEST_ASSERT_EQUAL_FLOAT(0, matrix[0]);
    TEST_ASSERT_EQUAL_FLOAT(1, matrix[1]);
    TEST_ASSERT_EQUAL_FLOAT(-0.25F, matrix[4]);
    gl_GetIntegerv(gl, GL_MODELVIEW_STACK_DEPTH, &depth);
    TEST_ASSERT_EQUAL_INT32(2, depth);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    rectangle(-1, -1, 1, 1, 0); /* x from 0.25 to 0.75: pixels 10 to 13 */
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 9, 3));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 10, 3));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 13, 3));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 14, 3));
    gl_PopMatrix(gl);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, drawn());
    gl_PopMatrix(gl);
    EXPECT(GL_STACK_UNDERFLOW);
    for (int i = 0; i < 31; i++)
        gl_PushMatrix(gl);
    EXPECT(GL_NO_ERROR);
    gl_PushMatrix(gl);
    EXPECT(GL_STACK_OVERFLOW);
    gl_MatrixMode(gl, GL_RGBA);
    EXPECT(GL_INVALID_ENUM);
}

static void test_projections_have_the_matrices_of_their_volumes(void)
{
    GLfloat matrix[16];
    gl_MatrixMode(gl, GL_PROJECTION);
    gl_Frustumf(gl, -1, 3, -1, 1, 1, 3);
    gl_GetFloatv(gl, GL_PROJECTION_MATRIX, matrix);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, matrix[0]);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, matrix[8]);
    TEST_ASSERT_EQUAL_FLOAT(-2, matrix[10]);
    TEST_ASSERT_EQUAL_FLOAT(-1, matrix[11]);
    TEST_ASSERT_EQUAL_FLOAT(-3, matrix[14]);
    gl_LoadIdentity(gl);
    gl_Orthox(gl, 0, 16 << 16, 0, 8 << 16, -(1 << 16), 1 << 16);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    rectangle(3, 2, 5, 4, 0);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 3, 2));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 4, 3));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 5, 3));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 4, 4));
    gl_Orthof(gl, 1, 1, 0, 1, 0, 1);
    EXPECT(GL_INVALID_VALUE);
    gl_Frustumf(gl, 0, 1, 0, 1, -1, 1);
    EXPECT(GL_INVALID_VALUE);
}

static void test_the_alpha_test_and_planes_discard(void)
{
    const GLfloat left[4] = {-1, 0, 0, 0.25F};
    GLfixed plane[4];
    gl_Color4f(gl, 1, 1, 1, 0.4F);
    gl_Enable(gl, GL_ALPHA_TEST);
    gl_AlphaFunc(gl, GL_GREATER, 0.4F);
    TEST_ASSERT_EQUAL_HEX32(0, drawn());
    gl_AlphaFuncx(gl, GL_GEQUAL, 0x6666);
    TEST_ASSERT_EQUAL_HEX32(0xffffff66, drawn());
    gl_Translatef(gl, 0.25F, 0, 0);
    gl_ClipPlanef(gl, GL_CLIP_PLANE1, left); /* x up to 0.5 of eye space */
    gl_LoadIdentity(gl);
    gl_Enable(gl, GL_CLIP_PLANE1);
    gl_GetClipPlanex(gl, GL_CLIP_PLANE1, plane);
    TEST_ASSERT_EQUAL_INT32(0x8000, plane[3]);
    TEST_ASSERT_EQUAL_HEX32(0xffffff66, drawn());
    TEST_ASSERT_EQUAL_HEX32(0xffffff66, screen_pixel(&screen, 11, 3));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 12, 3));
    gl_AlphaFunc(gl, GL_RGBA, 0);
    EXPECT(GL_INVALID_ENUM);
    gl_ClipPlanef(gl, GL_CLIP_PLANE0 + 6, left);
    EXPECT(GL_INVALID_ENUM);
}

static void draw_point(void)
{
    static const GLfloat center[3] = {0, 0, 0};
    gl_EnableClientState(gl, GL_VERTEX_ARRAY);
    gl_VertexPointer(gl, 3, GL_FLOAT, 0, center);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_DrawArrays(gl, GL_POINTS, 0, 1);
}

static void test_points_have_sizes_and_sprites(void)
{
    static const uint8_t halves[] = {255, 0, 0, 255, 0, 255, 0, 255};
    static const GLfloat size = 2;
    gl_PointSize(gl, 4);
    draw_point();
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 5, 4));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 6, 4));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 9, 2));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 10, 4));
    gl_PointParameterf(gl, GL_POINT_SIZE_MAX, 2);
    draw_point();
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 6, 4));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 7, 4));
    gl_PointParameterx(gl, GL_POINT_SIZE_MAX, 64 << 16);
    gl_EnableClientState(gl, GL_POINT_SIZE_ARRAY_OES);
    gl_PointSizePointerOES(gl, GL_FLOAT, 0, &size);
    draw_point();
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 6, 4));
    gl_DisableClientState(gl, GL_POINT_SIZE_ARRAY_OES);
    make_texture(GL_TEXTURE0, GL_RGBA, halves);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 2, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, halves);
    gl_Enable(gl, GL_POINT_SPRITE_OES);
    gl_TexEnvi(gl, GL_POINT_SPRITE_OES, GL_COORD_REPLACE_OES, 1);
    draw_point();
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, screen_pixel(&screen, 7, 4));
    TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, screen_pixel(&screen, 8, 4));
    gl_PointSize(gl, 0);
    EXPECT(GL_INVALID_VALUE);
}

static void test_arrays_have_types_and_sizes(void)
{
    static const uint8_t colors[4][4] = {
        {0, 51, 255, 255}, {0, 51, 255, 255}, {0, 51, 255, 255}, {0, 51, 255, 255}};
    static const GLfixed corners[][2] = {{-65536, -65536}, {65536, -65536}, {-65536, 65536}, {65536, 65536}};
    static const GLubyte indices[] = {0, 1, 2, 3};
    void *pointer;
    GLint value;
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_DrawArrays(gl, GL_TRIANGLES, 0, 3); /* without vertices */
    gl_EnableClientState(gl, GL_COLOR_ARRAY);
    gl_ColorPointer(gl, 4, GL_UNSIGNED_BYTE, 0, colors);
    gl_EnableClientState(gl, GL_VERTEX_ARRAY);
    gl_VertexPointer(gl, 2, GL_FIXED, 0, corners);
    gl_DrawElements(gl, GL_TRIANGLE_STRIP, 4, GL_UNSIGNED_BYTE, indices);
    TEST_ASSERT_EQUAL_HEX32(0x0033ffff, screen_pixel(&screen, 5, 3));
    gl_GetIntegerv(gl, GL_VERTEX_ARRAY_TYPE, &value);
    TEST_ASSERT_EQUAL_HEX32(GL_FIXED, value);
    gl_GetPointerv(gl, GL_COLOR_ARRAY_POINTER, &pointer);
    TEST_ASSERT_EQUAL_PTR(colors, pointer);
    gl_ColorPointer(gl, 3, GL_UNSIGNED_BYTE, 0, colors);
    EXPECT(GL_INVALID_VALUE);
    gl_VertexPointer(gl, 2, GL_UNSIGNED_BYTE, 0, corners);
    EXPECT(GL_INVALID_ENUM);
    gl_EnableClientState(gl, GL_RGBA);
    EXPECT(GL_INVALID_ENUM);
}

static void test_flat_triangles_have_one_colour(void)
{
    static const uint8_t colors[3][4] = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}};
    static const GLfloat corners[3][2] = {{-1, -1}, {3, -1}, {-1, 3}};
    gl_EnableClientState(gl, GL_COLOR_ARRAY);
    gl_ColorPointer(gl, 4, GL_UNSIGNED_BYTE, 0, colors);
    gl_EnableClientState(gl, GL_VERTEX_ARRAY);
    gl_VertexPointer(gl, 2, GL_FLOAT, 0, corners);
    gl_ShadeModel(gl, GL_FLAT);
    gl_DrawArrays(gl, GL_TRIANGLES, 0, 3);
    TEST_ASSERT_EQUAL_HEX32(0x0000ffff, screen_pixel(&screen, 1, 1));
    TEST_ASSERT_EQUAL_HEX32(0x0000ffff, screen_pixel(&screen, 14, 1));
    gl_ShadeModel(gl, GL_SMOOTH);
    gl_DrawArrays(gl, GL_TRIANGLES, 0, 3);
    TEST_ASSERT_UINT_WITHIN(60, 0xe0, screen_pixel(&screen, 0, 0) >> 24);
}

/* A line between two rows covers half of both; the alpha test follows. */
static void test_smooth_lines_cover_parts_of_pixels(void)
{
    static const GLfloat ends[2][2] = {{-1, 0}, {1, 0}};
    GLfloat range[2];
    gl_EnableClientState(gl, GL_VERTEX_ARRAY);
    gl_VertexPointer(gl, 2, GL_FLOAT, 0, ends);
    gl_Enable(gl, GL_LINE_SMOOTH);
    gl_DrawArrays(gl, GL_LINES, 0, 2);
    TEST_ASSERT_EQUAL_HEX32(0xffffff80, screen_pixel(&screen, 5, 3));
    TEST_ASSERT_EQUAL_HEX32(0xffffff80, screen_pixel(&screen, 5, 4));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 5, 2));
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_LineWidth(gl, 2.5F);
    gl_Enable(gl, GL_ALPHA_TEST);
    gl_AlphaFunc(gl, GL_GREATER, 0.5F);
    gl_DrawArrays(gl, GL_LINES, 0, 2);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 5, 4));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 5, 5)); /* a quarter */
    gl_Disable(gl, GL_LINE_SMOOTH);
    gl_DrawArrays(gl, GL_LINES, 0, 2);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 5, 2) | screen_pixel(&screen, 5, 5));
    gl_GetFloatv(gl, GL_SMOOTH_LINE_WIDTH_RANGE, range);
    TEST_ASSERT_TRUE(range[0] == 1 && range[1] > 2.5F);
}

static void test_smooth_points_are_circles_and_sprites_are_squares(void)
{
    static const GLfloat centre[2] = {0, 0};
    gl_EnableClientState(gl, GL_VERTEX_ARRAY);
    gl_VertexPointer(gl, 2, GL_FLOAT, 0, centre);
    gl_PointSize(gl, 4);
    gl_Enable(gl, GL_POINT_SMOOTH);
    gl_DrawArrays(gl, GL_POINTS, 0, 1);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 8, 4));
    TEST_ASSERT_UINT_WITHIN(2, 80, screen_pixel(&screen, 9, 5) & 0xff); /* 0.3151 of the square is inside */
    gl_Enable(gl, GL_POINT_SPRITE_OES);
    gl_DrawArrays(gl, GL_POINTS, 0, 1);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 9, 5));
}

static void test_getters_return_what_was_set(void)
{
    GLfixed fixed[16];
    GLfloat numbers[16];
    GLint integers[16];
    GLboolean on;
    gl_GetFixedv(gl, GL_MODELVIEW_MATRIX, fixed);
    TEST_ASSERT_EQUAL_INT32(0x10000, fixed[5]);
    gl_GetIntegerv(gl, GL_CURRENT_COLOR, integers);
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, integers[0]);
    gl_GetIntegerv(gl, GL_MAX_LIGHTS, integers);
    TEST_ASSERT_EQUAL_INT32(8, integers[0]);
    gl_GetLightfv(gl, GL_LIGHT0, GL_DIFFUSE, numbers);
    TEST_ASSERT_EQUAL_FLOAT(1, numbers[2]);
    gl_GetLightxv(gl, GL_LIGHT1, GL_DIFFUSE, fixed);
    TEST_ASSERT_EQUAL_INT32(0, fixed[2]);
    gl_GetMaterialxv(gl, GL_FRONT, GL_AMBIENT, fixed);
    TEST_ASSERT_EQUAL_INT32(13107, fixed[0]);
    gl_GetTexEnviv(gl, GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, integers);
    TEST_ASSERT_EQUAL_HEX32(GL_MODULATE, integers[0]);
    gl_GetTexEnvxv(gl, GL_TEXTURE_ENV, GL_COMBINE_RGB, fixed);
    TEST_ASSERT_EQUAL_HEX32(GL_MODULATE, fixed[0]);
    gl_Hint(gl, GL_FOG_HINT, GL_NICEST);
    gl_GetIntegerv(gl, GL_FOG_HINT, integers);
    TEST_ASSERT_EQUAL_HEX32(GL_NICEST, integers[0]);
    gl_GetBooleanv(gl, GL_TEXTURE_2D, &on);
    TEST_ASSERT_EQUAL(GL_FALSE, on);
    gl_Enable(gl, GL_CLIP_PLANE5);
    TEST_ASSERT_EQUAL(GL_TRUE, gl_IsEnabled(gl, GL_CLIP_PLANE5));
    fixed[0] = 7;
    gl_GetLightxv(gl, GL_LIGHT0, GL_RGBA, fixed);
    EXPECT(GL_INVALID_ENUM);
    TEST_ASSERT_EQUAL_INT32(7, fixed[0]);
    TEST_ASSERT_EQUAL_STRING_LEN("OpenGL ES-CM 1.1", gl_GetString(gl, GL_VERSION), 16);
    TEST_ASSERT_NULL(strstr((const char *)gl_GetString(gl, GL_EXTENSIONS), "GL_OES_standard_derivatives"));
}

/* The stored colour is 0x0f0f0f0f, the new one 0x33333333. Bit 0 of the number is the result of 1 and 1, bit
 * 1 of a new 1 and a stored 0, bit 2 of a new 0 and a stored 1, bit 3 of 0 and 0. */
static void test_logic_operations_replace_blending(void)
{
    GLint mode;
    gl_Enable(gl, GL_BLEND);
    gl_BlendFunc(gl, GL_ZERO, GL_ZERO);
    gl_Color4ub(gl, 0x33, 0x33, 0x33, 0x33);
    gl_ClearColor(gl, 15 / 255.0F, 15 / 255.0F, 15 / 255.0F, 15 / 255.0F);
    for (uint32_t i = 0; i < 16; i++) {
        uint32_t byte = 0x0f0f0f0f;
        gl_LogicOp(gl, GL_CLEAR + i);
        gl_Enable(gl, GL_COLOR_LOGIC_OP);
        for (unsigned bit = 0; bit < 8; bit++) {
            unsigned place = 3 - (2 * (0x33 >> bit & 1) + (0x0f >> bit & 1));
            byte = (byte & ~(0x01010101U << bit)) | (i >> place & 1) * 0x01010101U << bit;
        }
        TEST_ASSERT_EQUAL_HEX32(byte, drawn());
        gl_Disable(gl, GL_COLOR_LOGIC_OP);
        TEST_ASSERT_EQUAL_HEX32(0, drawn());
    }
    gl_GetIntegerv(gl, GL_LOGIC_OP_MODE, &mode);
    TEST_ASSERT_EQUAL_HEX32(GL_SET, mode);
    gl_LogicOp(gl, GL_SET + 1);
    EXPECT(GL_INVALID_ENUM);
    TEST_ASSERT_EQUAL(GL_FALSE, gl_IsEnabled(gl, GL_COLOR_LOGIC_OP));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_current_color_is_drawn_and_clamped);
    RUN_TEST(test_matrices_are_multiplied_in_their_order_and_kept_on_stacks);
    RUN_TEST(test_projections_have_the_matrices_of_their_volumes);
    RUN_TEST(test_the_alpha_test_and_planes_discard);
    RUN_TEST(test_points_have_sizes_and_sprites);
    RUN_TEST(test_arrays_have_types_and_sizes);
    RUN_TEST(test_flat_triangles_have_one_colour);
    RUN_TEST(test_smooth_lines_cover_parts_of_pixels);
    RUN_TEST(test_smooth_points_are_circles_and_sprites_are_squares);
    RUN_TEST(test_getters_return_what_was_set);
    RUN_TEST(test_logic_operations_replace_blending);
    return UNITY_END();
}
