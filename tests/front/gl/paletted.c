/* Paletted images of OpenGL ES 1.1, drawn on a target of 16 x 8 pixels. */
#include "tests/support/front/gl/screen.h"

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

/* A pixel of a rectangle over the whole target. */
static uint32_t drawn(void)
{
    static const GLfloat corners[] = {-1, -1, 1, -1, -1, 1, 1, 1};
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_EnableClientState(gl, GL_VERTEX_ARRAY);
    gl_VertexPointer(gl, 2, GL_FLOAT, 0, corners);
    gl_DrawArrays(gl, GL_TRIANGLE_STRIP, 0, 4);
    return screen_pixel(&screen, 5, 3);
}

/* Row 3 of a palette is the colour; an image of 3 x 1 has it in the middle, the next level everywhere. */
static uint32_t paletted(GLenum format, const uint8_t *texel, unsigned bytes, bool wide)
{
    uint8_t data[256 * 4 + 4] = {0}, *indices = data + bytes * (wide ? 256U : 16U);
    for (unsigned i = 0; i < bytes; i++)
        data[3 * bytes + i] = texel[i];
    indices[0] = wide ? 0 : 0x03, indices[1] = wide ? 3 : 0x00;
    indices[wide ? 3 : 2] = wide ? 3 : 0x30; /* level 1 */
    gl_CompressedTexImage2D(gl, GL_TEXTURE_2D, -1, format, 3, 1, 0,
                            (GLsizei)(indices - data) + (wide ? 4 : 3), data);
    EXPECT(GL_NO_ERROR);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    drawn();
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 2, 3) & 0xffffff00);
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 14, 3) & 0xffffff00);
    return screen_pixel(&screen, 8, 3);
}

static void begin_paletted(void)
{
    static const GLfloat coordinates[] = {0, 0, 1, 0, 0, 1, 1, 1};
    GLuint name;
    gl_GenTextures(gl, 1, &name);
    gl_BindTexture(gl, GL_TEXTURE_2D, name);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_TexEnvi(gl, GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    gl_EnableClientState(gl, GL_TEXTURE_COORD_ARRAY);
    gl_TexCoordPointer(gl, 2, GL_FLOAT, 0, coordinates);
    gl_Enable(gl, GL_TEXTURE_2D);
}

/* A word of 16 bits is in the order of the machine: 0x1234 for all. */
static void test_paletted_images_are_unpacked(void)
{
    static const uint8_t bytes[] = {0x12, 0x34, 0x56, 0x78}, word[] = {0x34, 0x12};
    static const struct {
        unsigned bytes;
        uint32_t color;
    } rows[] = {
        {3, 0x123456ff},
        {4, 0x12345678},
        {2, 0x1045a5ff} /* 2, 17, 20 */,
        {2, 0x11223344},
        {2, 0x1042d600} /* 2, 8, 26, 0 */,
    };
    begin_paletted();
    for (unsigned i = 0; i < GL_PALETTE8_RGB5_A1_OES - GL_PALETTE4_RGB8_OES + 1; i++)
        TEST_ASSERT_EQUAL_HEX32(rows[i % 5].color,
                                paletted(GL_PALETTE4_RGB8_OES + i, rows[i % 5].bytes == 2 ? word : bytes,
                                         rows[i % 5].bytes, i >= 5));
}

static void test_levels_of_paletted_images_are_negative(void)
{
    static const uint8_t red[] = {255, 0, 0, 255};
    uint8_t data[16 * 4 + 8 + 2 + 1] = {0}; /* 4 x 4, 2 x 2, 1 x 1 */
    GLint formats[16], count;
    begin_paletted();
    for (unsigned i = 0; i < 4; i++)
        data[15 * 4 + i] = red[i];
    data[16 * 4 + 8 + 2] = 0xf0;
    gl_CompressedTexImage2D(gl, GL_TEXTURE_2D, -2, GL_PALETTE4_RGBA8_OES, 4, 4, 0, sizeof data, data);
    EXPECT(GL_NO_ERROR);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    gl_MatrixMode(gl, GL_TEXTURE);
    gl_Scalef(gl, 64, 64, 1); /* 256 texels for 16 x 8 pixels: the last level */
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, drawn());
    gl_CompressedTexImage2D(gl, GL_TEXTURE_2D, -2, GL_PALETTE4_RGBA8_OES, 4, 4, 0, sizeof data - 1, data);
    EXPECT(GL_INVALID_VALUE);
    gl_CompressedTexImage2D(gl, GL_TEXTURE_2D, 1, GL_PALETTE4_RGBA8_OES, 4, 4, 0, sizeof data, data);
    EXPECT(GL_INVALID_VALUE);
    gl_CompressedTexImage2D(gl, GL_TEXTURE_2D, -3, GL_PALETTE4_RGBA8_OES, 4, 4, 0, sizeof data, data);
    EXPECT(GL_INVALID_VALUE);
    gl_CompressedTexSubImage2D(gl, GL_TEXTURE_2D, 0, 0, 0, 4, 4, GL_PALETTE4_RGBA8_OES, sizeof data, data);
    EXPECT(GL_INVALID_OPERATION);
    gl_GetIntegerv(gl, GL_NUM_COMPRESSED_TEXTURE_FORMATS, &count);
    TEST_ASSERT_EQUAL_INT32(13, count);
    gl_GetIntegerv(gl, GL_COMPRESSED_TEXTURE_FORMATS, formats);
    TEST_ASSERT_EQUAL_HEX32(GL_PALETTE8_RGB5_A1_OES, formats[12]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_paletted_images_are_unpacked);
    RUN_TEST(test_levels_of_paletted_images_are_negative);
    return UNITY_END();
}
