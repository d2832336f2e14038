/* Textures of OpenGL ES 1.1 and their environments, with pixels that are worked out by hand. */
#include "tests/front/gl/fixed_screen.h"

#include <unity.h>

void setUp(void)
{
    screen_begin_1(&screen);
}

void tearDown(void)
{
    screen_end(&screen);
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_modes_of_textures_with_colours_and_alpha);
    RUN_TEST(test_modes_of_textures_without_alpha_or_colours);
    RUN_TEST(test_combinations_have_sources_operands_and_scales);
    RUN_TEST(test_units_follow_each_other_and_read_other_textures);
    RUN_TEST(test_coordinates_pass_through_the_matrix_of_their_unit);
    RUN_TEST(test_mipmaps_are_generated);
    return UNITY_END();
}
