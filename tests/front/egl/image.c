/* EGL images, and pbuffers as textures: their errors and how long they live. */
#include "display.h"

#include "front/gl/types.h"
#include <stdbool.h>

static EGLConfig config;
static EGLContext context;
static EGLSurface surface;

void setUp(void)
{
    begin_display();
    config = config_with(EGL_BIND_TO_TEXTURE_RGBA, EGL_TRUE);
    context = context_of(config, EGL_NO_CONTEXT);
    surface = pbuffer_of(config, 4, 4);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, surface, surface, context));
}

void tearDown(void)
{
    end_display();
}

#define GL(type, name) ((type)egl_function_find(name))

static GLuint make_texture(GLsizei side, uint32_t color)
{
    uint32_t texels[16];
    GLuint texture;
    for (unsigned i = 0; i < 16; i++)
        texels[i] = color;
    GL(PFNGLGENTEXTURESPROC, "glGenTextures")(1, &texture);
    GL(PFNGLBINDTEXTUREPROC, "glBindTexture")(GL_TEXTURE_2D, texture);
    if (side)
        GL(PFNGLTEXIMAGE2DPROC, "glTexImage2D")
    (GL_TEXTURE_2D, 0, GL_RGBA, side, side, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    return texture;
}

/* The pixel of a texture; 0 if it has no image. */
static uint32_t texel_of(GLuint texture)
{
    uint32_t word = 0;
    GLuint framebuffer;
    GL(PFNGLGENFRAMEBUFFERSPROC, "glGenFramebuffers")(1, &framebuffer);
    GL(PFNGLBINDFRAMEBUFFERPROC, "glBindFramebuffer")(GL_FRAMEBUFFER, framebuffer);
    GL(PFNGLFRAMEBUFFERTEXTURE2DPROC, "glFramebufferTexture2D")
    (GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    GL(PFNGLREADPIXELSPROC, "glReadPixels")(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &word);
    GL(PFNGLDELETEFRAMEBUFFERSPROC, "glDeleteFramebuffers")(1, &framebuffer);
    return word;
}

static GLuint take(EGLImage image)
{
    GLuint texture = make_texture(0, 0);
    GL(PFNGLEGLIMAGETARGETTEXTURE2DOESPROC, "glEGLImageTargetTexture2DOES")(GL_TEXTURE_2D, image);
    return texture;
}

static EGLClientBuffer buffer_of(GLuint name)
{
    return (EGLClientBuffer)(uintptr_t)name;
}

static EGLImage image_of(GLuint texture)
{
    EGLImage image = egl_CreateImage(dpy, context, EGL_GL_TEXTURE_2D, buffer_of(texture), NULL);
    TEST_ASSERT_NOT_NULL(image);
    return image;
}

static const uint32_t red = 0xff0000ff, green = 0xff00ff00;

static void another_context_gets_the_texels_of_an_image(void)
{
    EGLImage image = image_of(make_texture(4, red));
    EGLContext other = context_of(config, EGL_NO_CONTEXT);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, surface, surface, other));
    TEST_ASSERT_EQUAL_HEX32(red, texel_of(take(image)));
    TEST_ASSERT_TRUE(egl_DestroyImage(dpy, image));
}

static void texels_outlive_the_image_and_the_context_of_their_source(void)
{
    EGLContext other = context_of(config, EGL_NO_CONTEXT);
    EGLImage image = image_of(make_texture(4, red));
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, surface, surface, other));
    TEST_ASSERT_TRUE(egl_DestroyContext(dpy, context));
    GLuint texture = take(image);
    TEST_ASSERT_TRUE(egl_DestroyImage(dpy, image));
    TEST_ASSERT_EQUAL_HEX32(red, texel_of(texture));
    FAILS(EGL_BAD_PARAMETER, egl_DestroyImage(dpy, image));
}

static void an_image_can_be_left_to_the_end_of_the_display(void)
{
    take(image_of(make_texture(4, red)));
    TEST_ASSERT_TRUE(egl_Terminate(dpy));
    TEST_ASSERT_TRUE(egl_Initialize(dpy, NULL, NULL));
}

static void wrong_arguments_of_images_are_errors(void)
{
    static const EGLAttrib level[] = {EGL_GL_TEXTURE_LEVEL, 3, EGL_NONE}, width[] = {EGL_WIDTH, 1, EGL_NONE},
                           kept[] = {EGL_IMAGE_PRESERVED, 7, EGL_NONE};
    EGLClientBuffer texture = buffer_of(make_texture(4, red));
    FAILS(EGL_BAD_DISPLAY, egl_CreateImage(&surface, context, EGL_GL_TEXTURE_2D, texture, NULL));
    FAILS(EGL_BAD_CONTEXT, egl_CreateImage(dpy, surface, EGL_GL_TEXTURE_2D, texture, NULL));
    FAILS(EGL_BAD_CONTEXT, egl_CreateImage(dpy, EGL_NO_CONTEXT, EGL_GL_TEXTURE_2D, texture, NULL));
    FAILS(EGL_BAD_PARAMETER, egl_CreateImage(dpy, context, EGL_GL_TEXTURE_3D, texture, NULL));
    FAILS(EGL_BAD_PARAMETER, egl_CreateImage(dpy, EGL_NO_CONTEXT, EGL_NONE, texture, NULL));
    FAILS(EGL_BAD_PARAMETER, egl_CreateImage(dpy, context, EGL_GL_TEXTURE_2D, NULL, NULL));
    FAILS(EGL_BAD_PARAMETER, egl_CreateImage(dpy, context, EGL_GL_TEXTURE_2D, buffer_of(9), NULL));
    FAILS(EGL_BAD_PARAMETER, egl_CreateImage(dpy, context, EGL_GL_RENDERBUFFER, texture, NULL));
    FAILS(EGL_BAD_PARAMETER, egl_CreateImage(dpy, context, EGL_GL_TEXTURE_2D, texture, width));
    FAILS(EGL_BAD_PARAMETER, egl_CreateImage(dpy, context, EGL_GL_TEXTURE_2D, texture, kept));
    FAILS(EGL_BAD_MATCH, egl_CreateImage(dpy, context, EGL_GL_TEXTURE_2D, texture, level));
    EGLImage image = egl_CreateImageKHR(dpy, context, EGL_GL_TEXTURE_2D, texture,
                                        (const EGLint[]){EGL_IMAGE_PRESERVED, EGL_TRUE, EGL_NONE});
    TEST_ASSERT_NOT_NULL(image);
    FAILS(EGL_BAD_ACCESS, egl_CreateImage(dpy, context, EGL_GL_TEXTURE_2D, texture, NULL));
    TEST_ASSERT_TRUE(egl_DestroyImage(dpy, image));
}

/* --- Pbuffers --- */

static EGLSurface textured(EGLConfig of, EGLint format)
{
    const EGLint list[] = {
        EGL_WIDTH,      4,       EGL_HEIGHT, 4, EGL_TEXTURE_FORMAT, format, EGL_TEXTURE_TARGET,
        EGL_TEXTURE_2D, EGL_NONE};
    return egl_CreatePbufferSurface(dpy, of, list);
}

/* A pbuffer of the color. */
static EGLSurface filled(float r, float g, float b)
{
    EGLSurface made = textured(config, EGL_TEXTURE_RGBA);
    TEST_ASSERT_NOT_NULL(made);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, made, made, context));
    GL(PFNGLBINDFRAMEBUFFERPROC, "glBindFramebuffer")(GL_FRAMEBUFFER, 0);
    GL(PFNGLCLEARCOLORPROC, "glClearColor")(r, g, b, 1);
    GL(PFNGLCLEARPROC, "glClear")(GL_COLOR_BUFFER_BIT);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, surface, surface, context));
    return made;
}

static void a_texture_gets_the_colour_of_a_pbuffer_until_it_is_released(void)
{
    EGLSurface pbuffer = filled(0, 1, 0);
    GLuint texture = make_texture(4, red);
    TEST_ASSERT_TRUE(egl_BindTexImage(dpy, pbuffer, EGL_BACK_BUFFER));
    TEST_ASSERT_EQUAL_HEX32(green, texel_of(texture));
    FAILS(EGL_BAD_ACCESS, egl_BindTexImage(dpy, pbuffer, EGL_BACK_BUFFER));
    FAILS(EGL_BAD_ACCESS, egl_CreateImage(dpy, context, EGL_GL_TEXTURE_2D, buffer_of(texture), NULL));
    TEST_ASSERT_TRUE(egl_ReleaseTexImage(dpy, pbuffer, EGL_BACK_BUFFER));
    TEST_ASSERT_EQUAL_HEX32(0, texel_of(texture));
    TEST_ASSERT_TRUE(egl_ReleaseTexImage(dpy, pbuffer, EGL_BACK_BUFFER));
    TEST_ASSERT_TRUE(egl_BindTexImage(dpy, pbuffer, EGL_BACK_BUFFER));
    TEST_ASSERT_EQUAL_HEX32(green, texel_of(texture));
}

static void a_texture_leaves_a_pbuffer_with_new_texels_another_pbuffer_or_its_end(void)
{
    EGLSurface one = filled(0, 1, 0), two = filled(1, 0, 0);
    GLuint texture = make_texture(0, 0);
    TEST_ASSERT_TRUE(egl_BindTexImage(dpy, one, EGL_BACK_BUFFER));
    TEST_ASSERT_TRUE(egl_BindTexImage(dpy, two, EGL_BACK_BUFFER));
    TEST_ASSERT_EQUAL_HEX32(red, texel_of(texture));
    GLuint other = make_texture(0, 0);
    TEST_ASSERT_TRUE(egl_BindTexImage(dpy, one, EGL_BACK_BUFFER));
    TEST_ASSERT_EQUAL_HEX32(green, texel_of(other));
    GL(PFNGLTEXIMAGE2DPROC, "glTexImage2D")
    (GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, &red);
    TEST_ASSERT_EQUAL_HEX32(red, texel_of(other));
    TEST_ASSERT_TRUE(egl_BindTexImage(dpy, one, EGL_BACK_BUFFER));
    GL(PFNGLDELETETEXTURESPROC, "glDeleteTextures")(1, &other);
    make_texture(0, 0);
    TEST_ASSERT_TRUE(egl_BindTexImage(dpy, one, EGL_BACK_BUFFER));
}

static void a_texture_keeps_the_colour_of_a_destroyed_pbuffer(void)
{
    EGLSurface pbuffer = filled(0, 1, 0);
    GLuint texture = make_texture(0, 0);
    TEST_ASSERT_TRUE(egl_BindTexImage(dpy, pbuffer, EGL_BACK_BUFFER));
    TEST_ASSERT_TRUE(egl_DestroySurface(dpy, pbuffer));
    TEST_ASSERT_EQUAL_HEX32(green, texel_of(texture));
    FAILS(EGL_BAD_SURFACE, egl_ReleaseTexImage(dpy, pbuffer, EGL_BACK_BUFFER));
}

static void a_bind_without_a_context_does_nothing(void)
{
    EGLSurface pbuffer = filled(0, 1, 0);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT));
    TEST_ASSERT_TRUE(egl_BindTexImage(dpy, pbuffer, EGL_BACK_BUFFER));
    TEST_ASSERT_TRUE(egl_BindTexImage(dpy, pbuffer, EGL_BACK_BUFFER));
    FAILS(EGL_BAD_PARAMETER, egl_BindTexImage(dpy, pbuffer, EGL_FRONT_BUFFER_AUTO_REFRESH_ANDROID));
    FAILS(EGL_BAD_MATCH, egl_BindTexImage(dpy, surface, EGL_BACK_BUFFER));
    FAILS(EGL_BAD_MATCH, egl_ReleaseTexImage(dpy, surface, EGL_BACK_BUFFER));
}

static void every_config_of_textures_has_such_pbuffers(void)
{
    EGLConfig configs[64];
    EGLint count, textures = 0;
    TEST_ASSERT_TRUE(egl_GetConfigs(dpy, configs, 64, &count));
    for (EGLint i = 0; i < count; i++) {
        const bool rgb = attribute(configs[i], EGL_BIND_TO_TEXTURE_RGB);
        const bool rgba = attribute(configs[i], EGL_BIND_TO_TEXTURE_RGBA);
        EGLSurface with = textured(configs[i], EGL_TEXTURE_RGBA),
                   without = textured(configs[i], EGL_TEXTURE_RGB);
        TEST_ASSERT_EQUAL(rgba, with != EGL_NO_SURFACE);
        TEST_ASSERT_EQUAL(rgb, without != EGL_NO_SURFACE);
        textures += rgb || rgba;
        if (rgb || rgba) {
            make_texture(0, 0);
            TEST_ASSERT_TRUE(egl_BindTexImage(dpy, rgb ? without : with, EGL_BACK_BUFFER));
        }
    }
    TEST_ASSERT_EQUAL_INT(30, textures);
}

/* Those of ten bits are read without a loss. */
static void pixels_of_every_config_are_read_in_its_own_format(void)
{
    EGLConfig configs[64];
    EGLint count, deep = 0;
    TEST_ASSERT_TRUE(egl_GetConfigs(dpy, configs, 64, &count));
    for (EGLint i = 0; i < count; i++) {
        GLint format = 0, type = 0;
        uint32_t pixel = 0;
        EGLSurface made = pbuffer_of(configs[i], 2, 2);
        TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, made, made, context_of(configs[i], EGL_NO_CONTEXT)));
        GL(PFNGLCLEARCOLORPROC, "glClearColor")(1, 513.0F / 1023, 0, 1.0F / 3);
        GL(PFNGLCLEARPROC, "glClear")(GL_COLOR_BUFFER_BIT);
        GL(PFNGLGETINTEGERVPROC, "glGetIntegerv")(GL_IMPLEMENTATION_COLOR_READ_FORMAT, &format);
        GL(PFNGLGETINTEGERVPROC, "glGetIntegerv")(GL_IMPLEMENTATION_COLOR_READ_TYPE, &type);
        GL(PFNGLREADPIXELSPROC, "glReadPixels")(0, 0, 1, 1, (GLenum)format, (GLenum)type, &pixel);
        TEST_ASSERT_EQUAL_HEX32(GL_NO_ERROR, GL(PFNGLGETERRORPROC, "glGetError")());
        TEST_ASSERT_NOT_EQUAL(0, pixel);
        if (attribute(configs[i], EGL_RED_SIZE) != 10)
            continue;
        TEST_ASSERT_EQUAL_HEX32(1023u | 513u << 10 | 1u << 30, pixel);
        deep++;
    }
    TEST_ASSERT_EQUAL_INT(10, deep);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(another_context_gets_the_texels_of_an_image);
    RUN_TEST(texels_outlive_the_image_and_the_context_of_their_source);
    RUN_TEST(an_image_can_be_left_to_the_end_of_the_display);
    RUN_TEST(wrong_arguments_of_images_are_errors);
    RUN_TEST(a_texture_gets_the_colour_of_a_pbuffer_until_it_is_released);
    RUN_TEST(a_texture_leaves_a_pbuffer_with_new_texels_another_pbuffer_or_its_end);
    RUN_TEST(a_texture_keeps_the_colour_of_a_destroyed_pbuffer);
    RUN_TEST(a_bind_without_a_context_does_nothing);
    RUN_TEST(every_config_of_textures_has_such_pbuffers);
    RUN_TEST(pixels_of_every_config_are_read_in_its_own_format);
    return UNITY_END();
}
