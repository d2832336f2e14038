/* Draws of OpenGL ES 1.1, with pixels that are worked out by hand. The target has 16 x 8 pixels; a
 * rectangle is in clip space if no matrix is set. */
#include "tests/support/front/gl/screen.h"

#include <string.h>
#include <unity.h>

static struct screen screen;

void setUp(void)
{
    screen_begin_1(&screen);
}

void tearDown(void)
{
    screen_end(&screen);
}

#define gl screen.context

static void rectangle(GLfloat left, GLfloat bottom, GLfloat right, GLfloat top, GLfloat z)
{
    const GLfloat corners[][3] = {{left, bottom, z}, {right, bottom, z}, {left, top, z}, {right, top, z}};
    gl_EnableClientState(gl, GL_VERTEX_ARRAY);
    gl_VertexPointer(gl, 3, GL_FLOAT, 0, corners);
    gl_DrawArrays(gl, GL_TRIANGLE_STRIP, 0, 4);
}

/* The pixel of a rectangle over the whole target. */
static uint32_t drawn(void)
{
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    rectangle(-1, -1, 1, 1, 0);
    return screen_pixel(&screen, 5, 3);
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

static void set_light(GLenum name, GLfloat x, GLfloat y, GLfloat z, GLfloat w)
{
    const GLfloat values[4] = {x, y, z, w};
    gl_Lightfv(gl, GL_LIGHT0, name, values);
}

static void set_material(GLenum name, GLfloat x, GLfloat y, GLfloat z, GLfloat w)
{
    const GLfloat values[4] = {x, y, z, w};
    gl_Materialfv(gl, GL_FRONT_AND_BACK, name, values);
}

static void begin_lighting(void)
{
    const GLfloat none[4] = {0, 0, 0, 1};
    gl_Enable(gl, GL_LIGHTING);
    gl_Enable(gl, GL_LIGHT0);
    gl_LightModelfv(gl, GL_LIGHT_MODEL_AMBIENT, none);
}

static void test_light_is_the_sum_of_its_parts(void)
{
    begin_lighting();
    set_material(GL_DIFFUSE, 0.4F, 0.2F, 1, 0.6F);
    TEST_ASSERT_EQUAL_HEX32(0x6633ff99, drawn()); /* from (0, 0, 1) along the normal */
    set_light(GL_POSITION, 0, 0.8F, 0.6F, 0);
    TEST_ASSERT_EQUAL_HEX32(0x3d1f9999, drawn()); /* 0.6 of it */
    set_material(GL_EMISSION, 0.2F, 0, 0, 1);
    set_light(GL_AMBIENT, 0, 1, 0, 1);
    set_material(GL_AMBIENT, 1, 0.4F, 1, 1);
    TEST_ASSERT_EQUAL_HEX32(0x70859999, drawn());
    set_light(GL_POSITION, 0, 0, -1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x33660099, drawn());
}

static void test_specular_light_has_the_power_of_the_half_vector(void)
{
    begin_lighting();
    set_material(GL_DIFFUSE, 0, 0, 0, 1);
    set_material(GL_SPECULAR, 1, 0.5F, 0, 1);
    gl_Materialf(gl, GL_FRONT_AND_BACK, GL_SHININESS, 2);
    TEST_ASSERT_EQUAL_HEX32(0xff8000ff, drawn());
    /* (0, 0.96, 0.28): the half vector is (0, 0.6, 0.8), whose z squared is 0.64. */
    set_light(GL_POSITION, 0, 0.96F, 0.28F, 0);
    TEST_ASSERT_EQUAL_HEX32(0xa35200ff, drawn());
    gl_Materialf(gl, GL_FRONT_AND_BACK, GL_SHININESS, 129);
    EXPECT(GL_INVALID_VALUE);
    gl_Materialf(gl, GL_FRONT, GL_SHININESS, 1);
    EXPECT(GL_INVALID_ENUM);
}

static void test_lights_with_a_place_fade_and_have_a_spot(void)
{
    begin_lighting();
    set_material(GL_DIFFUSE, 1, 1, 1, 1);
    set_light(GL_POSITION, 0, 0, 4, 1);
    gl_Lightf(gl, GL_LIGHT0, GL_CONSTANT_ATTENUATION, 0);
    gl_Lightf(gl, GL_LIGHT0, GL_QUADRATIC_ATTENUATION, 1.0F / 16);
    /* The centre of a small rectangle is 4 away. */
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    rectangle(-0.01F, -0.01F, 0.2F, 0.2F, 0);
    TEST_ASSERT_UINT_WITHIN(2, 0xfe, screen_pixel(&screen, 8, 4) >> 24);
    gl_Lightf(gl, GL_LIGHT0, GL_SPOT_CUTOFF, 30);
    rectangle(-0.01F, -0.01F, 0.2F, 0.2F, 0);
    TEST_ASSERT_UINT_WITHIN(2, 0xfe, screen_pixel(&screen, 8, 4) >> 24);
    set_light(GL_SPOT_DIRECTION, 0.8F, 0, -0.6F, 0);
    rectangle(-0.01F, -0.01F, 0.2F, 0.2F, 0);
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, screen_pixel(&screen, 8, 4));
    gl_Lightf(gl, GL_LIGHT0, GL_SPOT_CUTOFF, 60);
    gl_Lightf(gl, GL_LIGHT0, GL_SPOT_EXPONENT, 1);
    rectangle(-0.01F, -0.01F, 0.1F, 0.2F, 0);
    TEST_ASSERT_UINT_WITHIN(6, 0x99, screen_pixel(&screen, 8, 4) >> 24); /* the cosine 0.6 */
    gl_Lightf(gl, GL_LIGHT0, GL_SPOT_CUTOFF, 91);
    EXPECT(GL_INVALID_VALUE);
    gl_Lightf(gl, GL_LIGHT0 + 8, GL_SPOT_CUTOFF, 1);
    EXPECT(GL_INVALID_ENUM);
}

static void test_both_sides_have_a_colour_of_their_own(void)
{
    begin_lighting();
    set_material(GL_DIFFUSE, 1, 0, 0, 1);
    set_light(GL_POSITION, 0, 0, -1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, drawn());
    gl_LightModelf(gl, GL_LIGHT_MODEL_TWO_SIDE, 1);
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, drawn());
    gl_FrontFace(gl, GL_CW); /* the rectangle is counter-clockwise */
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, drawn());
    gl_LightModelx(gl, GL_LIGHT_MODEL_TWO_SIDE, 0);
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, drawn());
}

static void test_colours_are_materials_and_normals_are_normalized(void)
{
    begin_lighting();
    gl_Enable(gl, GL_COLOR_MATERIAL);
    gl_Color4f(gl, 0.2F, 1, 0, 1);
    gl_Normal3f(gl, 0, 0, 0.5F);
    TEST_ASSERT_EQUAL_HEX32(0x1a8000ff, drawn());
    gl_Enable(gl, GL_NORMALIZE);
    TEST_ASSERT_EQUAL_HEX32(0x33ff00ff, drawn());
    gl_Disable(gl, GL_NORMALIZE);
    gl_Normal3x(gl, 0, 0, 0x10000);
    gl_Scalef(gl, 1, 1, 4); /* the normal becomes a quarter */
    TEST_ASSERT_EQUAL_HEX32(0x0d4000ff, drawn());
    gl_Enable(gl, GL_RESCALE_NORMAL);
    TEST_ASSERT_EQUAL_HEX32(0x33ff00ff, drawn());
}

static void test_fog_follows_the_distance_of_the_eye(void)
{
    const GLfloat blue[4] = {0, 0, 1, 1};
    gl_Enable(gl, GL_FOG);
    gl_Fogfv(gl, GL_FOG_COLOR, blue);
    gl_Fogx(gl, GL_FOG_MODE, GL_LINEAR);
    gl_Fogf(gl, GL_FOG_START, -0.5F);
    gl_Fogf(gl, GL_FOG_END, 0.75F);
    gl_Color4f(gl, 1, 0, 0, 1);
    rectangle(-1, -1, 1, 1, -0.25F); /* 0.5 / 1.25 of the colour */
    TEST_ASSERT_EQUAL_HEX32(0x660099ff, screen_pixel(&screen, 5, 3));
    gl_Fogf(gl, GL_FOG_MODE, GL_EXP);
    gl_Fogf(gl, GL_FOG_DENSITY, 4 * 0.69314718F);
    rectangle(-1, -1, 1, 1, -0.25F); /* a half */
    TEST_ASSERT_UINT_WITHIN(1, 0x80, screen_pixel(&screen, 5, 3) >> 24);
    gl_Fogf(gl, GL_FOG_MODE, GL_EXP2);
    rectangle(-1, -1, 1, 1, -0.5F); /* exp(-4 ln2 ln2 ...): e^-(1.3863^2) = 0.1463 */
    TEST_ASSERT_UINT_WITHIN(1, 37, screen_pixel(&screen, 5, 3) >> 24);
    gl_Fogf(gl, GL_FOG_DENSITY, -1);
    EXPECT(GL_INVALID_VALUE);
    gl_Fogf(gl, GL_FOG_MODE, GL_RGBA);
    EXPECT(GL_INVALID_ENUM);
    gl_Fogf(gl, GL_FOG_COLOR, 1);
    EXPECT(GL_INVALID_ENUM);
}

static void make_texture(GLenum unit, GLenum format, const uint8_t *texel)
{
    GLuint name;
    gl_ActiveTexture(gl, unit);
    gl_GenTextures(gl, 1, &name);
    gl_BindTexture(gl, GL_TEXTURE_2D, name);
    gl_TexParameterx(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, (GLint)format, 1, 1, 0, format, GL_UNSIGNED_BYTE, texel);
    gl_Enable(gl, GL_TEXTURE_2D);
}

/* Colour (1, 0.8, 0.6, 0.4), texel (0.2, 0.4, 0.6, 0.8), constant (0, 1, 0, 1). */
static uint32_t with_mode(GLenum mode)
{
    gl_TexEnvi(gl, GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, (GLint)mode);
    return drawn();
}

static void begin_environment(GLenum format)
{
    static const uint8_t rgba[] = {51, 102, 153, 204};
    const GLfloat constant[4] = {0, 1, 0, 1};
    make_texture(GL_TEXTURE0, format, format == GL_ALPHA ? rgba + 3 : rgba);
    gl_TexEnvfv(gl, GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, constant);
    gl_Color4f(gl, 1, 0.8F, 0.6F, 0.4F);
}

static void test_modes_of_textures_with_colours_and_alpha(void)
{
    begin_environment(GL_RGBA);
    TEST_ASSERT_EQUAL_HEX32(0x336699cc, with_mode(GL_REPLACE));
    TEST_ASSERT_EQUAL_HEX32(0x33525c52, with_mode(GL_MODULATE)); /* 0.2, 0.32, 0.36, 0.32 */
    TEST_ASSERT_EQUAL_HEX32(0x5c7a9966, with_mode(GL_DECAL));    /* 0.36, 0.48, 0.6, 0.4 */
    TEST_ASSERT_EQUAL_HEX32(0xcce03d52, with_mode(GL_BLEND));    /* 0.8, 0.88, 0.24, 0.32 */
    TEST_ASSERT_EQUAL_HEX32(0xffffff52, with_mode(GL_ADD));
}

static void test_modes_of_textures_without_alpha_or_colours(void)
{
    begin_environment(GL_RGB);
    TEST_ASSERT_EQUAL_HEX32(0x33669966, with_mode(GL_REPLACE));
    TEST_ASSERT_EQUAL_HEX32(0x33669966, with_mode(GL_DECAL));
    TEST_ASSERT_EQUAL_HEX32(0x33525c66, with_mode(GL_MODULATE));
    begin_environment(GL_ALPHA);
    TEST_ASSERT_EQUAL_HEX32(0xffcc99cc, with_mode(GL_REPLACE));
    TEST_ASSERT_EQUAL_HEX32(0xffcc9952, with_mode(GL_MODULATE));
    TEST_ASSERT_EQUAL_HEX32(0xffcc9952, with_mode(GL_ADD));
}

static uint32_t combined(GLenum function, GLenum alpha)
{
    gl_TexEnvi(gl, GL_TEXTURE_ENV, GL_COMBINE_RGB, (GLint)function);
    gl_TexEnvi(gl, GL_TEXTURE_ENV, GL_COMBINE_ALPHA, (GLint)alpha);
    return with_mode(GL_COMBINE);
}

static void test_combinations_have_sources_operands_and_scales(void)
{
    begin_environment(GL_RGBA);
    TEST_ASSERT_EQUAL_HEX32(0x336699cc, combined(GL_REPLACE, GL_REPLACE));
    TEST_ASSERT_EQUAL_HEX32(0xb3b3b3b3, combined(GL_ADD_SIGNED, GL_ADD_SIGNED)); /* 0.7 */
    TEST_ASSERT_EQUAL_HEX32(0x00000066, combined(GL_SUBTRACT, GL_SUBTRACT));
    TEST_ASSERT_EQUAL_HEX32(0x336699cc,
                            combined(GL_INTERPOLATE, GL_INTERPOLATE)); /* the constant's alpha is 1 */
    gl_TexEnvx(gl, GL_TEXTURE_ENV, GL_SRC2_RGB, GL_PRIMARY_COLOR);
    TEST_ASSERT_EQUAL_HEX32(0xada399cc,
                            combined(GL_INTERPOLATE, GL_REPLACE)); /* 0.4 of the texel: 0.68, 0.64, 0.6 */
    gl_TexEnvi(gl, GL_TEXTURE_ENV, GL_OPERAND0_RGB, GL_ONE_MINUS_SRC_COLOR);
    gl_TexEnvi(gl, GL_TEXTURE_ENV, GL_OPERAND0_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl_TexEnvx(gl, GL_TEXTURE_ENV, GL_ALPHA_SCALE, 2 << 16);
    TEST_ASSERT_EQUAL_HEX32(0xcc996666, combined(GL_REPLACE, GL_REPLACE));
    gl_TexEnvi(gl, GL_TEXTURE_ENV, GL_OPERAND0_RGB, GL_SRC_COLOR);
    TEST_ASSERT_EQUAL_HEX32(0x00000066, combined(GL_DOT3_RGB, GL_REPLACE)); /* 4(-0.15 - 0.03 + 0.01) < 0 */
    gl_TexEnvi(gl, GL_TEXTURE_ENV, GL_SRC1_RGB, GL_TEXTURE);
    TEST_ASSERT_EQUAL_HEX32(0x70707070, combined(GL_DOT3_RGBA, GL_REPLACE)); /* 4(0.09 + 0.01 + 0.01) */
    gl_TexEnvf(gl, GL_TEXTURE_ENV, GL_RGB_SCALE, 3);
    EXPECT(GL_INVALID_VALUE);
    gl_TexEnvi(gl, GL_TEXTURE_ENV, GL_COMBINE_ALPHA, GL_DOT3_RGB);
    EXPECT(GL_INVALID_ENUM);
}

static void test_units_follow_each_other_and_read_other_textures(void)
{
    static const uint8_t green[] = {0, 128, 0, 255};
    begin_environment(GL_RGBA);
    TEST_ASSERT_EQUAL_HEX32(0x336699cc, with_mode(GL_REPLACE));
    make_texture(GL_TEXTURE1, GL_RGBA, green);
    TEST_ASSERT_EQUAL_HEX32(0x003300cc, with_mode(GL_MODULATE)); /* 0.4 of 128 is 51 */
    gl_TexEnvi(gl, GL_TEXTURE_ENV, GL_SRC0_RGB, GL_TEXTURE0);
    TEST_ASSERT_EQUAL_HEX32(0x336699ff, combined(GL_REPLACE, GL_REPLACE));
    gl_ActiveTexture(gl, GL_TEXTURE0 + 4);
    EXPECT(GL_INVALID_ENUM);
}

static void test_coordinates_pass_through_the_matrix_of_their_unit(void)
{
    static const uint8_t halves[] = {255, 0, 0, 255, 0, 255, 0, 255};
    static const GLbyte coordinates[] = {0, 0, 0, 0, 0, 0, 0, 0};
    make_texture(GL_TEXTURE0, GL_RGBA, halves);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 2, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, halves);
    gl_TexCoordPointer(gl, 2, GL_BYTE, 0, coordinates);
    gl_EnableClientState(gl, GL_TEXTURE_COORD_ARRAY);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, drawn());
    gl_MatrixMode(gl, GL_TEXTURE);
    gl_Translatex(gl, 0xc000, 0, 0);
    TEST_ASSERT_EQUAL_HEX32(0x00ff00ff, drawn());
    gl_DisableClientState(gl, GL_TEXTURE_COORD_ARRAY);
    gl_MultiTexCoord4f(gl, GL_TEXTURE0, 0.5F, 0, 0, 1);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, drawn());
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

static void test_mipmaps_are_generated(void)
{
    static const uint8_t texels[4][4] = {
        {255, 0, 0, 255}, {255, 0, 0, 255}, {0, 0, 255, 255}, {0, 0, 255, 255}};
    GLuint name;
    gl_GenTextures(gl, 1, &name);
    gl_BindTexture(gl, GL_TEXTURE_2D, name);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_GENERATE_MIPMAP, GL_TRUE);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    gl_Enable(gl, GL_TEXTURE_2D); /* complete only with all levels */
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, drawn());
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
    RUN_TEST(test_light_is_the_sum_of_its_parts);
    RUN_TEST(test_specular_light_has_the_power_of_the_half_vector);
    RUN_TEST(test_lights_with_a_place_fade_and_have_a_spot);
    RUN_TEST(test_both_sides_have_a_colour_of_their_own);
    RUN_TEST(test_colours_are_materials_and_normals_are_normalized);
    RUN_TEST(test_fog_follows_the_distance_of_the_eye);
    RUN_TEST(test_modes_of_textures_with_colours_and_alpha);
    RUN_TEST(test_modes_of_textures_without_alpha_or_colours);
    RUN_TEST(test_combinations_have_sources_operands_and_scales);
    RUN_TEST(test_units_follow_each_other_and_read_other_textures);
    RUN_TEST(test_coordinates_pass_through_the_matrix_of_their_unit);
    RUN_TEST(test_the_alpha_test_and_planes_discard);
    RUN_TEST(test_points_have_sizes_and_sprites);
    RUN_TEST(test_arrays_have_types_and_sizes);
    RUN_TEST(test_flat_triangles_have_one_colour);
    RUN_TEST(test_smooth_lines_cover_parts_of_pixels);
    RUN_TEST(test_smooth_points_are_circles_and_sprites_are_squares);
    RUN_TEST(test_getters_return_what_was_set);
    RUN_TEST(test_mipmaps_are_generated);
    RUN_TEST(test_logic_operations_replace_blending);
    return UNITY_END();
}
