/* Depth and stencil of a framebuffer object that are those of two images. */
#include "tests/support/front/gl/screen.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { WIDTH = 11, HEIGHT = 66, IMAGES = 7, STEPS = 100, SEEDS = 4 };

static struct screen screen;
static GLuint framebuffer, color;
static GLint color_place;

static const char vertex[] = "attribute vec3 position; varying vec2 at; void main() {"
                             "at = position.xy * 0.5 + 0.5; gl_Position = vec4(position, 1.0); }";
static const char fragment[] =
    "precision mediump float; uniform vec4 color; void main() { gl_FragColor = color; }";
static const char depth_fragment[] = "precision highp float; varying vec2 at; uniform sampler2D image;"
                                     "void main() { gl_FragColor = texture2D(image, at); }";

#define gl screen.context

static GLuint make_renderbuffer(GLenum format, GLsizei width, GLsizei height)
{
    GLuint buffer;
    gl_GenRenderbuffers(gl, 1, &buffer);
    gl_BindRenderbuffer(gl, GL_RENDERBUFFER, buffer);
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, format, width, height);
    return buffer;
}

static void set_parameters(void)
{
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void setUp(void)
{
    screen_begin(&screen);
    GLuint program = screen_program(&screen, vertex, fragment);
    color_place = gl_GetUniformLocation(gl, program, "color");
    gl_GenFramebuffers(gl, 1, &framebuffer);
    gl_BindFramebuffer(gl, GL_FRAMEBUFFER, framebuffer);
    color = make_renderbuffer(GL_RGBA8_OES, WIDTH, HEIGHT);
    gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
    gl_Viewport(gl, 0, 0, WIDTH, HEIGHT);
}

void tearDown(void)
{
    screen_end(&screen);
}

/* --- Images with one depth and one stencil --- */

struct image {
    GLenum format; /* of a renderbuffer; of a texture, GL_DEPTH_COMPONENT or GL_DEPTH_STENCIL_OES */
    GLuint name;
    unsigned depth, stencil; /* depth in sixteenths */
};

static bool is_texture(const struct image *image)
{
    return image->format == GL_DEPTH_COMPONENT || image->format == GL_DEPTH_STENCIL_OES;
}

static bool has_depth(const struct image *image)
{
    return image->format != GL_STENCIL_INDEX8;
}

static bool has_stencil(const struct image *image)
{
    return image->format == GL_STENCIL_INDEX8 || image->format == GL_DEPTH24_STENCIL8_OES ||
           image->format == GL_DEPTH_STENCIL_OES;
}

static void upload(struct image *image, unsigned depth, unsigned stencil)
{
    static uint32_t words[WIDTH * HEIGHT];
    bool both = image->format == GL_DEPTH_STENCIL_OES;
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++)
        words[i] = depth << 28 | (both ? stencil : 0);
    gl_BindTexture(gl, GL_TEXTURE_2D, image->name);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, (GLint)image->format, WIDTH, HEIGHT, 0, image->format,
                  both ? GL_UNSIGNED_INT_24_8_OES : GL_UNSIGNED_INT, words);
    image->depth = depth;
    image->stencil = stencil;
}

static void attach(GLenum attachment, const struct image *image)
{
    if (!image)
        gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, 0);
    else if (is_texture(image))
        gl_FramebufferTexture2D(gl, GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, image->name, 0);
    else
        gl_FramebufferRenderbuffer(gl, GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, image->name);
}

static void use(const struct image *depth, const struct image *stencil)
{
    attach(GL_DEPTH_ATTACHMENT, depth);
    attach(GL_STENCIL_ATTACHMENT, stencil);
    TEST_ASSERT_EQUAL_HEX32(GL_FRAMEBUFFER_COMPLETE, gl_CheckFramebufferStatus(gl, GL_FRAMEBUFFER));
}

/* Clears what is given, of the images that are used. */
static void set(struct image *depth, struct image *stencil, unsigned depth_value, unsigned stencil_value)
{
    gl_ClearDepthf(gl, (GLfloat)depth_value / 16);
    gl_ClearStencil(gl, (GLint)stencil_value);
    gl_Clear(gl, (depth ? GL_DEPTH_BUFFER_BIT : 0u) | (stencil ? GL_STENCIL_BUFFER_BIT : 0u));
    if (depth)
        depth->depth = depth_value;
    if (stencil)
        stencil->stencil = stencil_value;
}

static void make(struct image *image)
{
    image->depth = 8;
    image->stencil = 0;
    if (!is_texture(image)) {
        image->name = make_renderbuffer(image->format, WIDTH, HEIGHT);
        use(has_depth(image) ? image : NULL, has_stencil(image) ? image : NULL);
        set(has_depth(image) ? image : NULL, has_stencil(image) ? image : NULL, 8, 0);
        return;
    }
    gl_GenTextures(gl, 1, &image->name);
    gl_BindTexture(gl, GL_TEXTURE_2D, image->name);
    set_parameters();
    upload(image, 8, 0);
}

static void drop(struct image *image)
{
    if (is_texture(image))
        gl_DeleteTextures(gl, 1, &image->name);
    else
        gl_DeleteRenderbuffers(gl, 1, &image->name);
}

/* Draws where the stencil is `stencil` and the depth is greater than that of the rectangle. */
static bool draws(unsigned stencil, float depth)
{
    static uint32_t pixels[WIDTH * HEIGHT];
    gl_ClearColor(gl, 0, 0, 0, 0);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_StencilFunc(gl, GL_EQUAL, (GLint)stencil, 0xff);
    gl_Uniform4f(gl, color_place, 1, 1, 1, 1);
    screen_rectangle(&screen, -1, -1, 1, 1, depth * 2 - 1);
    gl_ReadPixels(gl, 0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    for (unsigned i = 1; i < WIDTH * HEIGHT; i++)
        TEST_ASSERT_EQUAL_HEX32(pixels[0], pixels[i]);
    return pixels[0] != 0;
}

/* The images have their values. */
static void expect(const struct image *depth, const struct image *stencil)
{
    float at = depth ? (float)depth->depth / 16 : 0.5F;
    unsigned value = stencil ? stencil->stencil : 0;
    use(depth, stencil);
    gl_Enable(gl, GL_DEPTH_TEST);
    gl_Enable(gl, GL_STENCIL_TEST);
    gl_DepthMask(gl, GL_FALSE);
    TEST_ASSERT_TRUE(draws(value, at - 0.03F));
    TEST_ASSERT_EQUAL(!depth, draws(value, at + 0.03F));
    TEST_ASSERT_EQUAL(!stencil, draws(value ^ 1, at - 0.03F));
    gl_DepthMask(gl, GL_TRUE);
    gl_Disable(gl, GL_DEPTH_TEST);
    gl_Disable(gl, GL_STENCIL_TEST);
}

static void test_depth_and_stencil_can_be_those_of_two_images(void)
{
    struct image depth = {.format = GL_DEPTH_COMPONENT16}, other_depth = {.format = GL_DEPTH_COMPONENT24_OES},
                 stencil = {.format = GL_STENCIL_INDEX8}, other = {.format = GL_STENCIL_INDEX8};
    make(&depth), make(&other_depth), make(&stencil), make(&other);
    use(&depth, &stencil);
    set(&depth, &stencil, 3, 77);
    expect(&depth, &other);
    use(&other_depth, &other);
    set(&other_depth, &other, 9, 200);
    expect(&depth, &stencil);
    expect(&other_depth, &stencil);
    expect(&depth, &other);
    expect(NULL, &stencil);
    expect(&other_depth, NULL);
}

static void test_a_packed_image_can_give_only_its_depth_or_only_its_stencil(void)
{
    struct image packed = {.format = GL_DEPTH24_STENCIL8_OES}, other = {.format = GL_DEPTH24_STENCIL8_OES},
                 stencil = {.format = GL_STENCIL_INDEX8};
    make(&packed), make(&other), make(&stencil);
    use(&packed, &other);
    set(&packed, &other, 5, 40);
    use(&other, &packed);
    set(&other, &packed, 11, 140);
    use(&packed, &stencil);
    set(NULL, &stencil, 0, 3);
    expect(&other, &other);
    expect(&packed, &packed);
    expect(&other, &stencil);
    expect(&packed, &other);
}

static void test_drawing_changes_the_depth_and_the_stencil_of_its_pair(void)
{
    struct image depth = {.format = GL_DEPTH_COMPONENT16}, stencil = {.format = GL_STENCIL_INDEX8},
                 other = {.format = GL_STENCIL_INDEX8};
    make(&depth), make(&stencil), make(&other);
    use(&depth, &stencil);
    gl_Enable(gl, GL_DEPTH_TEST);
    gl_Enable(gl, GL_STENCIL_TEST);
    gl_StencilOp(gl, GL_KEEP, GL_KEEP, GL_INCR);
    gl_StencilFunc(gl, GL_ALWAYS, 0, 0xff);
    screen_rectangle(&screen, -1, -1, 1, 1, -0.75F);
    use(&depth, &other);
    gl_StencilOp(gl, GL_KEEP, GL_INVERT, GL_KEEP);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    gl_StencilOp(gl, GL_KEEP, GL_KEEP, GL_KEEP);
    depth.depth = 2;
    stencil.stencil = 1;
    other.stencil = 255;
    expect(&depth, &stencil);
    expect(&depth, &other);
}

static void test_what_remains_of_a_pair_keeps_its_values(void)
{
    struct image depth = {.format = GL_DEPTH_COMPONENT16}, stencil = {.format = GL_STENCIL_INDEX8},
                 other = {.format = GL_DEPTH24_STENCIL8_OES};
    make(&depth), make(&stencil), make(&other);
    use(&depth, &stencil);
    set(&depth, &stencil, 4, 9);
    drop(&depth);
    expect(NULL, &stencil);
    expect(&other, &stencil);
    gl_BindRenderbuffer(gl, GL_RENDERBUFFER, other.name);
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, other.format, 2, 2);
    expect(NULL, &stencil);
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, other.format, WIDTH, HEIGHT);
    use(&other, &stencil);
    set(&other, NULL, 2, 0);
    drop(&stencil);
    expect(&other, NULL);
    gl_RenderbufferStorage(gl, GL_RENDERBUFFER, GL_DEPTH_COMPONENT16, -1, 1);
    EXPECT(GL_INVALID_VALUE);
}

static void test_a_texture_of_depth_is_sampled_while_it_has_another_stencil(void)
{
    struct image depth = {.format = GL_DEPTH_COMPONENT}, stencil = {.format = GL_STENCIL_INDEX8};
    make(&depth), make(&stencil);
    use(&depth, &stencil);
    set(&depth, &stencil, 4, 9);
    expect(&depth, &stencil);
    use(NULL, NULL);
    GLuint before = screen_program(&screen, vertex, depth_fragment);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0x404040ff, screen_pixel(&screen, 5, 5));
    GLuint program = screen_program(&screen, vertex, fragment);
    TEST_ASSERT_NOT_EQUAL(before, program);
    expect(&depth, &stencil);
    gl_BindTexture(gl, GL_TEXTURE_2D, depth.name);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    expect(NULL, &stencil);
}

static void test_texels_with_stencil_are_its_values(void)
{
    struct image packed = {.format = GL_DEPTH_STENCIL_OES}, stencil = {.format = GL_STENCIL_INDEX8};
    uint32_t part[2] = {0x70000011, 0x70000011}, whole[2] = {0xc000005a, 0xc000005a};
    make(&packed), make(&stencil);
    upload(&packed, 5, 0xa5);
    expect(&packed, &packed);
    use(&packed, &stencil);
    set(NULL, &stencil, 0, 6);
    upload(&packed, 12, 0x5a);
    expect(&packed, &stencil);
    gl_BindTexture(gl, GL_TEXTURE_2D, packed.name);
    gl_TexSubImage2D(gl, GL_TEXTURE_2D, 0, 8, 9, 2, 1, GL_DEPTH_STENCIL_OES, GL_UNSIGNED_INT_24_8_OES, part);
    use(&packed, &packed);
    gl_Clear(gl, GL_COLOR_BUFFER_BIT);
    gl_Enable(gl, GL_STENCIL_TEST);
    gl_StencilFunc(gl, GL_EQUAL, 0x11, 0xff);
    screen_rectangle(&screen, -1, -1, 1, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, screen_pixel(&screen, 9, 9));
    TEST_ASSERT_EQUAL_HEX32(0, screen_pixel(&screen, 10, 9));
    gl_TexSubImage2D(gl, GL_TEXTURE_2D, 0, 8, 9, 2, 1, GL_DEPTH_STENCIL_OES, GL_UNSIGNED_INT_24_8_OES, whole);
    /* Images of more levels make the texture of the renderer again. */
    gl_TexImage2D(gl, GL_TEXTURE_2D, 1, GL_DEPTH_STENCIL_OES, WIDTH / 2, HEIGHT / 2, 0, GL_DEPTH_STENCIL_OES,
                  GL_UNSIGNED_INT_24_8_OES, NULL);
    expect(&packed, &packed);
    expect(&packed, &stencil);
}

/* --- Random sequences --- */

static unsigned next(unsigned count)
{
    return (unsigned)rand() % count;
}

static struct image *pick(struct image *images, bool (*fits)(const struct image *))
{
    for (;;) {
        struct image *image = images + next(IMAGES);
        if (fits(image))
            return next(5) ? image : NULL;
    }
}

static void step(struct image *images)
{
    struct image *depth = pick(images, has_depth), *stencil = pick(images, has_stencil), *other;
    switch (next(8)) {
    case 0:
    case 1:
    case 2:
        use(depth, stencil);
        set(next(2) ? depth : NULL, next(2) ? stencil : NULL, 1 + next(15), next(256));
        break;
    case 3:
        other = images + next(IMAGES);
        drop(other);
        make(other);
        break;
    case 4:
        other = images + next(IMAGES);
        if (is_texture(other))
            upload(other, 1 + next(15), other->format == GL_DEPTH_STENCIL_OES ? next(256) : 0);
        break;
    default: expect(depth, stencil);
    }
}

static void test_random_pairs_keep_the_values_of_all_images(void)
{
    for (unsigned seed = 0; seed < SEEDS; seed++) {
        struct image images[IMAGES] = {
            {.format = GL_DEPTH_COMPONENT16},    {.format = GL_STENCIL_INDEX8},
            {.format = GL_DEPTH24_STENCIL8_OES}, {.format = GL_STENCIL_INDEX8},
            {.format = GL_DEPTH_STENCIL_OES},    {.format = GL_DEPTH_COMPONENT},
            {.format = GL_DEPTH_STENCIL_OES},
        };
        srand(seed);
        for (unsigned i = 0; i < IMAGES; i++)
            make(images + i);
        for (unsigned i = 0; i < STEPS; i++)
            step(images);
        for (unsigned i = 0; i < IMAGES; i++)
            drop(images + i);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_depth_and_stencil_can_be_those_of_two_images);
    RUN_TEST(test_a_packed_image_can_give_only_its_depth_or_only_its_stencil);
    RUN_TEST(test_drawing_changes_the_depth_and_the_stencil_of_its_pair);
    RUN_TEST(test_what_remains_of_a_pair_keeps_its_values);
    RUN_TEST(test_a_texture_of_depth_is_sampled_while_it_has_another_stencil);
    RUN_TEST(test_texels_with_stencil_are_its_values);
    RUN_TEST(test_random_pairs_keep_the_values_of_all_images);
    return UNITY_END();
}
