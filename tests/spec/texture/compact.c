/* Compact texels (src/spec/texture/compact.h), on every engine: a texture of one or two bytes a texel draws
 * the picture of the texture of words that has the same colours, with every filter and kind of texture. The
 * words are computed here; the filters of words have their own tests (tests/spec/texture/sample.c). */
#include "tests/support/picture/canvas.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 16, BYTES = 2 * 6 * SIDE * SIDE * SIDE };

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static const struct format_case {
    const char *name;
    enum triptych_surface_format number;
    unsigned bytes;
} formats[] = {{"A8", TRIPTYCH_SURFACE_A8, 1},
               {"L8", TRIPTYCH_SURFACE_L8, 1},
               {"R8", TRIPTYCH_SURFACE_R8, 1},
               {"A8L8", TRIPTYCH_SURFACE_A8L8, 2},
               {"R8G8", TRIPTYCH_SURFACE_R8G8, 2}};

/* Red, green, blue and alpha of a texel of bytes a and b. */
static void color_of(const struct format_case *format, uint8_t a, uint8_t b, uint8_t color[4])
{
    const uint8_t colors[][4] = {{0, 0, 0, a}, {a, a, a, 255}, {a, 0, 0, 255}, {a, a, a, b}, {a, b, 0, 255}};
    memcpy(color, colors[format - formats], 4);
}

/* Settings of the sampler. */
static const struct setting {
    const char *what;
    enum triptych_texture_type type;
    const char *filter, *mip, *address;
    bool srgb;
    float scale; /* texels a pixel, times SIDE */
} settings[] = {
    {"point, wrap", TRIPTYCH_TEXTURE_2D, "point", "none", "wrap", false, 1.5f},
    {"linear, wrap", TRIPTYCH_TEXTURE_2D, "linear", "none", "wrap", false, 1.5f},
    {"linear, clamp", TRIPTYCH_TEXTURE_2D, "linear", "none", "clamp", false, 1.5f},
    {"linear, mirror", TRIPTYCH_TEXTURE_2D, "linear", "none", "mirror", false, 2.25f},
    {"linear, border", TRIPTYCH_TEXTURE_2D, "linear", "none", "border", false, 1.5f},
    {"trilinear", TRIPTYCH_TEXTURE_2D, "linear", "linear", "wrap", false, 9.5f},
    {"anisotropic", TRIPTYCH_TEXTURE_2D, "anisotropic", "linear", "wrap", false, 7.5f},
    {"sRGB", TRIPTYCH_TEXTURE_2D, "linear", "none", "wrap", true, 1.5f},
    {"cube", TRIPTYCH_TEXTURE_CUBE, "linear", "point", "clamp", false, 1.5f},
    {"volume", TRIPTYCH_TEXTURE_VOLUME, "linear", "none", "wrap", false, 1.5f},
};

static uint8_t bytes[BYTES], words[4 * BYTES];

/* Defines a texture whose levels have the given texels, of `size` bytes each. */
static triptych_texture *define(const struct setting *setting, enum triptych_surface_format format,
                                const uint8_t *data, size_t size)
{
    unsigned depth = setting->type == TRIPTYCH_TEXTURE_VOLUME ? SIDE : 1;
    const struct triptych_texture_description description = {setting->type, format, SIDE, SIDE, depth, 0};
    triptych_texture *texture;
    OK(triptych_texture_define(device, &description, &texture));
    for (unsigned face = 0; face < (setting->type == TRIPTYCH_TEXTURE_CUBE ? 6 : 1); face++)
        for (unsigned level = 0; SIDE >> level; level++) {
            size_t side = SIDE >> level, slices = depth > 1 ? side : 1;
            OK(triptych_texture_update(device, texture, face, level, NULL, data, size * side,
                                       size * side * side));
            data += size * side * side * slices;
        }
    return texture;
}

static void draw(const struct setting *setting, triptych_texture *texture)
{
    const float scale = setting->scale, low = -0.6f * scale, high = scale;
    struct {
        float position[2], texcoord[3];
    } vertex[4];
    triptych_buffer *buffer;
    for (int i = 0; i < 4; i++) {
        vertex[i].position[0] = i % 2 ? 1 : -1;
        vertex[i].position[1] = i / 2 ? -1 : 1;
        vertex[i].texcoord[0] = i % 2 ? high : low;
        vertex[i].texcoord[1] = i / 2 ? 0.3f * high : low;
        vertex[i].texcoord[2] = i % 2 ? 0.9f : -0.4f;
    }
    OK(triptych_set_texture(device, 0, texture));
    OK(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    const struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT2, buffer, 0, sizeof vertex[0]};
    const struct triptych_element texcoord = {TRIPTYCH_FORMAT_FLOAT3, buffer, sizeof vertex[0].position,
                                              sizeof vertex[0]};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_element(device, TRIPTYCH_TEXCOORD, &texcoord));
    clear_to(0x12345678);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    OK(triptych_read_color(device, image, sizeof image));
    OK(triptych_set_texture(device, 0, NULL));
    OK(triptych_texture_destroy(device, texture));
    OK(triptych_buffer_destroy(device, buffer));
}

static void use(const struct setting *setting)
{
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
    set_sampler(0, TRIPTYCH_SAMPLER_MINFILTER, setting->filter);
    set_sampler(0, TRIPTYCH_SAMPLER_MAGFILTER, setting->filter);
    set_sampler(0, TRIPTYCH_SAMPLER_MIPFILTER, setting->mip);
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_MAXANISOTROPY, 4));
    set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSU, setting->address);
    set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSV, setting->address);
    set_sampler(0, TRIPTYCH_SAMPLER_SRGBTEXTURE, setting->srgb ? "true" : "false");
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_BORDERCOLOR, 0x40c080f0));
}

static void compare(const struct format_case *format, const struct setting *setting)
{
    uint32_t expected[SIZE * SIZE];
    char what[64];
    for (unsigned i = 0; i < BYTES; i++)
        bytes[i] = (uint8_t)random_word();
    for (unsigned i = 0; i < BYTES / 2; i++)
        color_of(format, bytes[i * format->bytes], bytes[i * format->bytes + format->bytes - 1],
                 words + 4 * (size_t)i);
    use(setting);
    draw(setting, define(setting, TRIPTYCH_SURFACE_A8B8G8R8, words, 4));
    memcpy(expected, image, sizeof expected);
    draw(setting, define(setting, format->number, bytes, format->bytes));
    snprintf(what, sizeof what, "%s, %s", format->name, setting->what);
    for (int i = 0; i < SIZE * SIZE; i++)
        expect_pixel(i % SIZE, i / SIZE, expected[i], what);
}

/* Each setting with two of the formats, and each format with some of the settings. */
static void check_settings(void)
{
    enum { FORMATS = sizeof formats / sizeof *formats, SETTINGS = sizeof settings / sizeof *settings };
    for (unsigned i = 0; i < SETTINGS; i++)
        for (unsigned k = 0; k < 2; k++)
            compare(&formats[(2 * i + i / FORMATS + k) % FORMATS], &settings[i]);
}

static void test_bytes_are_filtered_like_the_words_of_their_colors(void)
{
    on_every_engine(check_settings);
}

/* The device's texels are words: the colours of the bytes. */
static void test_texels_are_read_as_their_colors_and_written_as_their_bytes(void)
{
    char reason[256] = "";
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(NULL, &device, reason, sizeof reason));
    for (unsigned f = 0; f < sizeof formats / sizeof *formats; f++) {
        const struct triptych_texture_description description = {
            TRIPTYCH_TEXTURE_2D, formats[f].number, 5, 3, 1, 1};
        uint8_t given[30], back[30], color[4];
        uint32_t texels[15];
        triptych_texture *texture;
        for (unsigned i = 0; i < sizeof given; i++)
            given[i] = (uint8_t)random_word();
        OK(triptych_texture_define(device, &description, &texture));
        OK(triptych_texture_update(device, texture, 0, 0, NULL, given, 5 * formats[f].bytes, 0));
        TEST_ASSERT_EQUAL_UINT64(sizeof texels, triptych_texture_texel_bytes(texture));
        OK(triptych_texture_read_texels(device, texture, texels, sizeof texels));
        for (unsigned i = 0; i < 15; i++) {
            const uint8_t *texel_bytes = given + i * formats[f].bytes;
            color_of(&formats[f], texel_bytes[0], texel_bytes[formats[f].bytes - 1], color);
            TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(color, &texels[i], 4, formats[f].name);
            texels[i] ^= 0x01010101;
        }
        OK(triptych_texture_write_texels(device, texture, texels, sizeof texels));
        OK(triptych_texture_read(device, texture, 0, 0, NULL, back, 5 * formats[f].bytes, 0));
        for (unsigned i = 0; i < 15 * formats[f].bytes; i++)
            TEST_ASSERT_EQUAL_HEX8(given[i] ^ 1, back[i]);
        OK(triptych_texture_destroy(device, texture));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bytes_are_filtered_like_the_words_of_their_colors);
    RUN_TEST(test_texels_are_read_as_their_colors_and_written_as_their_bytes);
    return UNITY_END();
}
