/* Lights, materials and fog of OpenGL ES 1.1, with pixels that are worked out by hand. */
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_light_is_the_sum_of_its_parts);
    RUN_TEST(test_specular_light_has_the_power_of_the_half_vector);
    RUN_TEST(test_lights_with_a_place_fade_and_have_a_spot);
    RUN_TEST(test_both_sides_have_a_colour_of_their_own);
    RUN_TEST(test_colours_are_materials_and_normals_are_normalized);
    RUN_TEST(test_fog_follows_the_distance_of_the_eye);
    return UNITY_END();
}
