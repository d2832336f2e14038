/* Textures that are not bytes (src/spec/texture/sample_float.h), on every engine: every format through the
 * whole pipeline, filters in binary32, sRGB, and depth comparisons. Targets have bytes, so the correct value
 * of a channel is the nearest multiple of 1/255. */
#include "render/texture/format.h"
#include "tests/support/picture/canvas.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static triptych_texture *make_texture(enum triptych_texture_type type, unsigned format, unsigned width,
                                      unsigned height, unsigned depth, unsigned levels)
{
    const struct triptych_texture_description description = {
        type, (enum triptych_surface_format)format, width, height, depth, levels};
    triptych_texture *texture;
    OK(triptych_texture_define(device, &description, &texture));
    OK(triptych_set_texture(device, 0, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
    return texture;
}

/* Draws as draw_square() does, with three coordinates that go from `low` to `high`. */
static void draw_third(const float low[3], const float high[3])
{
    struct {
        float position[2], texcoord[3];
    } vertex[4];
    triptych_buffer *buffer;
    for (int i = 0; i < 4; i++) {
        vertex[i].position[0] = i % 2 ? 1 : -1;
        vertex[i].position[1] = i / 2 ? -1 : 1;
        vertex[i].texcoord[0] = i % 2 ? high[0] : low[0];
        vertex[i].texcoord[1] = i / 2 ? high[1] : low[1];
        vertex[i].texcoord[2] = i % 2 ? high[2] : low[2];
    }
    OK(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    const struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT2, buffer, 0, sizeof vertex[0]};
    const struct triptych_element texcoord = {TRIPTYCH_FORMAT_FLOAT3, buffer, sizeof vertex[0].position,
                                              sizeof vertex[0]};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_element(device, TRIPTYCH_TEXCOORD, &texcoord));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
}

static void set_filters(const char *min, const char *mag, const char *mip)
{
    set_sampler(0, TRIPTYCH_SAMPLER_MINFILTER, min);
    set_sampler(0, TRIPTYCH_SAMPLER_MAGFILTER, mag);
    set_sampler(0, TRIPTYCH_SAMPLER_MIPFILTER, mip);
}

/* Returns the byte that stores a value; NaN is 0. */
static unsigned stored(double value)
{
    return value > 0 ? value < 1 ? (unsigned)lrintf((float)value * 255.0f) : 255 : 0;
}

static void expect_near(int x, int y, const double expected[4], double margin, const char *what)
{
    for (int c = 0; c < 4; c++) {
        char message[160];
        double value = fmin(fmax(expected[c], 0), 1) * 255, got = channel(image[y * SIZE + x], c);
        if (fabs(got - value) <= 0.5 + margin)
            continue;
        snprintf(message, sizeof message, "%s: pixel (%d, %d), channel %d: expected %f, got %f", what, x, y,
                 c, value, got);
        TEST_FAIL_MESSAGE(message);
    }
}

/* --- Formats ------------------------------------------------------------------------------------------- */

static uint8_t data[SIZE * SIZE * 16];
static uint32_t words[SIZE * SIZE];
static float numbers[SIZE * SIZE][4];

/* Draws random bytes of the format, one texel a pixel, and compares with the decoded texels. */
static void check_format(const struct format *format)
{
    size_t row = format_blocks(format, SIZE) * format->bytes;
    int bytes = format->storage == STORAGE_RGBA8;
    for (size_t i = 0; i < sizeof data; i++)
        data[i] = (uint8_t)random_word();
    triptych_texture *texture = make_texture(TRIPTYCH_TEXTURE_2D, format->number, SIZE, SIZE, 1, 1);
    OK(triptych_texture_update(device, texture, 0, 0, NULL, data, row, 0));
    format_decode(format, data, row, SIZE, SIZE, bytes ? (void *)words : (void *)numbers, SIZE);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int i = 0; i < SIZE * SIZE; i += pixel_stride()) {
        uint32_t expected = words[i];
        if (!bytes)
            expected = stored((double)numbers[i][0]) | stored((double)numbers[i][1]) << 8 |
                       stored((double)numbers[i][2]) << 16 | stored((double)numbers[i][3]) << 24;
        expect_pixel(i % SIZE, i / SIZE, expected, format->name);
    }
}

static void check_formats(void)
{
    set_filters("point", "point", "none");
    for (unsigned i = 0; format_at(i); i++)
        if (format_at(i)->roles & ROLE_TEXTURE && !(format_at(i)->roles & ROLE_COMPARE))
            check_format(format_at(i));
}

static void test_every_format_is_drawn_as_its_decoded_texels(void)
{
    on_every_engine(check_formats);
}

/* --- Filters ------------------------------------------------------------------------------------------- */

enum { SIDE = 16 };

static double texel_number(int x, int y, int c)
{
    return (double)numbers[(y & (SIDE - 1)) * SIDE + (x & (SIDE - 1))][c];
}

static void check_linear(void)
{
    triptych_texture *texture =
        make_texture(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A32B32G32R32F, SIDE, SIDE, 1, 1);
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 4; c++)
            numbers[i][c] = (float)random_between(-0.5, 1.5);
    OK(triptych_texture_update(device, texture, 0, 0, NULL, numbers, sizeof numbers[0] * SIDE, 0));
    set_filters("linear", "linear", "none");
    draw_square(0, 0xffffffff, NULL, -0.25f, 0, 0.5f, 1.5f);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int x = p % SIZE, y = p / SIZE;
        double u = ((x + 0.5) * 0.75 / SIZE - 0.25) * SIDE - 0.5, v = (y + 0.5) * 1.5 / SIZE * SIDE - 0.5;
        int i = (int)floor(u), j = (int)floor(v);
        double expected[4];
        for (int c = 0; c < 4; c++) {
            double above = texel_number(i, j, c) * (1 - u + i) + texel_number(i + 1, j, c) * (u - i);
            double below = texel_number(i, j + 1, c) * (1 - u + i) + texel_number(i + 1, j + 1, c) * (u - i);
            expected[c] = above * (1 - v + j) + below * (v - j);
        }
        expect_near(x, y, expected, 1e-3, "binary32, linear");
    }
}

static void test_numbers_are_blended_without_steps(void)
{
    on_every_engine(check_linear);
}

/* Texels of infinity and NaN do not affect pixels in which their weight is 0. */
static void check_weights_of_nothing(void)
{
    static const float row[4][4] = {
        {0.5f, 0.5f, 0.5f, 0.5f}, {0.25f, 0.25f, 0.25f, 0.25f}, {INFINITY, NAN, -INFINITY, 1}, {1, 1, 1, 1}};
    triptych_texture *texture = make_texture(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A32B32G32R32F, 4, 1, 1, 1);
    OK(triptych_texture_update(device, texture, 0, 0, NULL, row, sizeof row, 0));
    set_filters("linear", "linear", "none");
    float centre = 1.5f / 4; /* of the second texel, all over the target */
    draw_square(0, 0xffffffff, NULL, centre, 0.5f, centre, 0.5f);
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(3, 3, 0x40404040, "beside infinity");
}

static void test_a_texel_of_weight_0_has_no_effect(void)
{
    on_every_engine(check_weights_of_nothing);
}

static uint8_t narrow[6][SIDE * SIDE * SIDE * 4];
static uint16_t wide[6][SIDE * SIDE * SIDE * 4];

/* The same random texels of 8 and of 16 bits, in all levels of all faces. */
static void fill_both(triptych_texture *of_8, triptych_texture *of_16, unsigned faces, unsigned depth)
{
    for (unsigned face = 0; face < faces; face++)
        for (unsigned level = 0; level < 5; level++) {
            unsigned side = SIDE >> level, slices = depth >> level ? depth >> level : 1;
            for (size_t i = 0; i < 4u * side * side * slices; i++) {
                narrow[face][i] = (uint8_t)random_word();
                wide[face][i] = (uint16_t)(narrow[face][i] * 257);
            }
            OK(triptych_texture_update(device, of_8, face, level, NULL, narrow[face], 4 * side,
                                       4 * side * side));
            OK(triptych_texture_update(device, of_16, face, level, NULL, wide[face], 8 * side,
                                       8 * side * side));
        }
}

static void compare_both(triptych_texture *of_8, triptych_texture *of_16)
{
    static uint32_t first[SIZE * SIZE];
    static const float low[3] = {-0.5f, -1, 0.25f}, high[3] = {2, 3, 1.75f};
    OK(triptych_set_texture(device, 0, of_8));
    draw_third(low, high);
    OK(triptych_read_color(device, first, sizeof first));
    OK(triptych_set_texture(device, 0, of_16));
    draw_third(low, high);
    OK(triptych_read_color(device, image, sizeof image));
    for (int i = 0; i < SIZE * SIZE; i += pixel_stride())
        for (int c = 0; c < 4; c++)
            TEST_ASSERT_INT_WITHIN(3, channel(first[i], c), channel(image[i], c));
}

static void check_types(void)
{
    static const char *const filters[][3] = {{"point", "point", "point"},
                                             {"linear", "point", "linear"},
                                             {"point", "linear", "none"},
                                             {"anisotropic", "linear", "linear"}};
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_MAXANISOTROPY, 4));
    for (int type = 0; type < TRIPTYCH_TEXTURE_TYPE_COUNT; type++) {
        unsigned faces = type == TRIPTYCH_TEXTURE_CUBE ? 6 : 1,
                 depth = type == TRIPTYCH_TEXTURE_VOLUME ? SIDE : 1;
        triptych_texture *of_8 = make_texture(type, TRIPTYCH_SURFACE_A8B8G8R8, SIDE, SIDE, depth, 5);
        triptych_texture *of_16 = make_texture(type, TRIPTYCH_SURFACE_A16B16G16R16, SIDE, SIDE, depth, 5);
        fill_both(of_8, of_16, faces, depth);
        for (unsigned i = 0; i < 5 * 4; i += test_stride_of(3)) {
            static const char *const words_of[] = {"wrap", "mirror", "clamp", "border", "mirroronce"};
            const char *const *filter = filters[i % 4];
            unsigned address = i / 4;
            set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSU, words_of[address]);
            set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSV, words_of[(address + 2) % 5]);
            set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSW, words_of[(address + 3) % 5]);
            OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_BORDERCOLOR, 0x80c01020));
            set_filters(filter[0], filter[1], filter[2]);
            compare_both(of_8, of_16);
        }
    }
}

static void test_numbers_and_bytes_are_sampled_equally(void)
{
    on_every_engine(check_types);
}

/* --- sRGB ---------------------------------------------------------------------------------------------- */

static double linear(double code)
{
    double s = code / 255;
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

/* 256 codes as a row: unblended, and blended with black. */
static void check_srgb(void)
{
    static uint32_t codes[2][256];
    for (uint32_t i = 0; i < 256; i++)
        codes[0][i] = i * 0x01010101u;
    triptych_texture *texture = make_texture(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 256, 2, 1, 1);
    OK(triptych_texture_update(device, texture, 0, 0, NULL, codes, sizeof codes[0], 0));
    set_sampler(0, TRIPTYCH_SAMPLER_SRGBTEXTURE, "true");
    for (int half = 0; half < 2; half++) {
        set_filters(half ? "linear" : "point", half ? "linear" : "point", "none");
        for (int part = 0; part < 4; part++) {
            float low = (float)part / 4, v = half ? 0.5f : 0.25f;
            draw_square(0, 0xffffffff, NULL, low, v, low + 0.25f, v);
            OK(triptych_read_color(device, image, sizeof image));
            for (int x = 0; x < SIZE; x++) {
                double color = linear(64 * part + x) / (1 + half),
                       alpha = (64 * part + x) / 255.0 / (1 + half);
                const double expected[4] = {color, color, color, alpha};
                expect_near(x, 5, expected, 1e-3, half ? "sRGB blended" : "sRGB");
            }
        }
    }
    /* Formats of more than bytes have no sRGB. */
    texture = make_texture(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_R32F, 1, 1, 1, 1);
    OK(triptych_texture_update(device, texture, 0, 0, NULL, &(float){0.5f}, 4, 0));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(0, 0, 0xffffff80, "R32F with srgbtexture");
}

static void test_srgb_is_decoded_before_it_is_blended(void)
{
    on_every_engine(check_srgb);
}

/* --- Depth --------------------------------------------------------------------------------------------- */

/* Four texels of depth; the third coordinate runs from -0.5 to 1.5 across the target. */
static const double depths[4] = {0, 0.25, 0.625, 1};

static void fill_depths(triptych_texture *texture, unsigned format)
{
    uint32_t of_24[4];
    uint16_t of_16[4];
    for (int i = 0; i < 4; i++) {
        of_24[i] = (uint32_t)lrint(depths[i] * 16777215) << 8 | 0x5a;
        of_16[i] = (uint16_t)lrint(depths[i] * 65535);
    }
    int narrow_format = format == TRIPTYCH_SURFACE_D16;
    OK(triptych_texture_update(device, texture, 0, 0, NULL, narrow_format ? (void *)of_16 : (void *)of_24,
                               narrow_format ? 2 : 4, 0));
}

static void check_depth(unsigned format, int smooth)
{
    triptych_texture *texture = make_texture(TRIPTYCH_TEXTURE_2D, format, 1, 4, 1, 1);
    fill_depths(texture, format);
    set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSV, "clamp");
    set_filters(smooth ? "linear" : "point", smooth ? "linear" : "point", "none");
    draw_third((const float[]){0, 0, -0.5f}, (const float[]){1, 1, 1.5f});
    OK(triptych_read_color(device, image, sizeof image));
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double reference = fmin(fmax((x + 0.5) / SIZE * 2 - 0.5, 0), 1),
                   v = (y + 0.5) / 16 - (smooth ? 0.5 : 0);
            int j = (int)floor(v), first = j < 0 ? 0 : j, second = j + 1 > 3 ? 3 : j + 1;
            double weight = smooth ? v - j : 0;
            double lit = (reference <= depths[first]) * (1 - weight) + (reference <= depths[second]) * weight;
            const double expected[4] = {lit, lit, lit, lit};
            expect_near(x, y, expected, 1e-3, smooth ? "depth compared, linear" : "depth compared");
        }
}

static void check_depths(void)
{
    static const unsigned formats[] = {TRIPTYCH_SURFACE_D16, TRIPTYCH_SURFACE_D24X8, TRIPTYCH_SURFACE_D24S8};
    for (int i = 0; i < 3; i++)
        for (int smooth = 0; smooth < 2; smooth++)
            check_depth(formats[i], smooth);
    /* INTZ is read as it is. */
    triptych_texture *texture = make_texture(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_INTZ, 1, 4, 1, 1);
    fill_depths(texture, TRIPTYCH_SURFACE_INTZ);
    set_filters("point", "point", "none");
    draw_third((const float[]){0, 0, 1}, (const float[]){1, 1, 1});
    OK(triptych_read_color(device, image, sizeof image));
    for (int i = 0; i < 4; i++)
        expect_pixel(7, 16 * i + 8, stored(depths[i]) * 0x01010101u, "INTZ");
}

static void test_depth_is_compared_before_it_is_blended(void)
{
    on_every_engine(check_depths);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_format_is_drawn_as_its_decoded_texels);
    RUN_TEST(test_numbers_are_blended_without_steps);
    RUN_TEST(test_a_texel_of_weight_0_has_no_effect);
    RUN_TEST(test_numbers_and_bytes_are_sampled_equally);
    RUN_TEST(test_srgb_is_decoded_before_it_is_blended);
    RUN_TEST(test_depth_is_compared_before_it_is_blended);
    return UNITY_END();
}
