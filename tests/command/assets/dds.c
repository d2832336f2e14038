/* DDS files: the descriptions in their headers, and reasons for damaged ones. The headers are built here word
 * by word after Microsoft's guide. */
#include "command/assets/dds.h"

#include "command/stream/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>
#include <unistd.h>

static struct error error;
static uint8_t file[1 << 16];
static size_t bytes;

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

static void put(int at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        file[at + i] = (uint8_t)(value >> 8 * i);
}

/* The texels are 0, 1, 2 ... */
static void make(uint32_t width, uint32_t height, size_t texel_bytes)
{
    memset(file, 0, sizeof file);
    memcpy(file, "DDS ", 4);
    put(4, 124);
    put(8, 0x1007);
    put(12, height);
    put(16, width);
    put(76, 32);
    put(108, 0x1000);
    for (size_t i = 0; i < texel_bytes; i++)
        file[128 + i] = (uint8_t)i;
    bytes = 128 + texel_bytes;
}

static void set_fourcc(const char *code)
{
    put(80, 4);
    memcpy(file + 84, code, 4);
}

static void set_masks(uint32_t flags, uint32_t bits, uint32_t red, uint32_t green, uint32_t blue,
                      uint32_t alpha)
{
    put(80, flags);
    put(88, bits);
    put(92, red);
    put(96, green);
    put(100, blue);
    put(104, alpha);
}

static void set_levels(uint32_t levels)
{
    put(8, 0x21007);
    put(28, levels);
}

static void expect(enum triptych_texture_type type, unsigned format, unsigned width, unsigned height,
                   unsigned depth, unsigned levels)
{
    struct triptych_texture_description texture;
    size_t offset = 0;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, dds_read("t.dds", file, bytes, &texture, &offset, &error), error.text);
    const unsigned expected[] = {type, format, width, height, depth, levels};
    const unsigned found[] = {texture.type,   texture.format, texture.width,
                              texture.height, texture.depth,  texture.levels};
    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected, found, 6);
    TEST_ASSERT_EQUAL_UINT64(128, offset);
}

static void refuse(const char *part)
{
    struct triptych_texture_description texture;
    size_t offset;
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, dds_read("t.dds", file, bytes, &texture, &offset, &error));
    TEST_ASSERT_EQUAL_STRING_LEN("t.dds: ", error.text, 7);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, part), error.text);
}

static void compressed_textures_of_all_types(void)
{
    make(10, 6, 6 * 8);
    set_fourcc("DXT1");
    expect(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_DXT1, 10, 6, 1, 1);
    make(8, 8, (4 + 1 + 1 + 1) * 16);
    set_fourcc("DXT5");
    set_levels(4);
    expect(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_DXT5, 8, 8, 1, 4);
    make(4, 4, 6 * 16);
    set_fourcc("DXT3");
    put(112, 0xfe00);
    expect(TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_DXT3, 4, 4, 1, 1);
    make(4, 4, (5 + 2 + 1) * 8);
    set_fourcc("ATI1");
    set_levels(3);
    put(24, 5);
    put(112, 0x200000);
    expect(TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_ATI1, 4, 4, 5, 3);
}

static void formats_by_masks(void)
{
    static const struct {
        uint32_t flags, bits, mask[4];
        unsigned format;
    } cases[] = {
        {0x41, 32, {0xff0000, 0xff00, 0xff, 0xff000000}, TRIPTYCH_SURFACE_A8R8G8B8},
        {0x40, 32, {0xff0000, 0xff00, 0xff, 0}, TRIPTYCH_SURFACE_X8R8G8B8},
        {0x41, 32, {0xff, 0xff00, 0xff0000, 0xff000000}, TRIPTYCH_SURFACE_A8B8G8R8},
        {0x40, 24, {0xff0000, 0xff00, 0xff, 0}, TRIPTYCH_SURFACE_R8G8B8},
        {0x40, 16, {0xf800, 0x7e0, 0x1f, 0}, TRIPTYCH_SURFACE_R5G6B5},
        {0x41, 16, {0x7c00, 0x3e0, 0x1f, 0x8000}, TRIPTYCH_SURFACE_A1R5G5B5},
        {0x41, 16, {0xf00, 0xf0, 0xf, 0xf000}, TRIPTYCH_SURFACE_A4R4G4B4},
        {0x41, 32, {0x3ff00000, 0xffc00, 0x3ff, 0xc0000000}, TRIPTYCH_SURFACE_A2R10G10B10},
        {0x40, 32, {0xffff, 0xffff0000, 0, 0}, TRIPTYCH_SURFACE_G16R16},
        {0x20000, 8, {0xff, 0, 0, 0}, TRIPTYCH_SURFACE_L8},
        {0x20001, 16, {0xff, 0, 0, 0xff00}, TRIPTYCH_SURFACE_A8L8},
        {0x20000, 16, {0xffff, 0, 0, 0}, TRIPTYCH_SURFACE_L16},
        {0x2, 8, {0, 0, 0, 0xff}, TRIPTYCH_SURFACE_A8},
        {0x80000, 16, {0xff, 0xff00, 0, 0}, TRIPTYCH_SURFACE_V8U8},
        {0x80000, 32, {0xffff, 0xffff0000, 0, 0}, TRIPTYCH_SURFACE_V16U16},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const uint32_t *mask = cases[i].mask;
        make(2, 2, cases[i].bits / 2);
        set_masks(cases[i].flags, cases[i].bits, mask[0], mask[1], mask[2], mask[3]);
        expect(TRIPTYCH_TEXTURE_2D, cases[i].format, 2, 2, 1, 1);
    }
}

static void formats_by_number(void)
{
    make(2, 1, 16);
    set_fourcc((const char[]){113, 0, 0, 0});
    expect(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A16B16G16R16F, 2, 1, 1, 1);
}

static void damaged_files_are_refused(void)
{
    make(4, 4, 8);
    set_fourcc("DXT1");
    bytes = 127;
    refuse("no DDS file");
    bytes = 3;
    refuse("no DDS file");
    make(4, 4, 7);
    set_fourcc("DXT1");
    refuse("7 bytes of texels, expected 8");
    make(4, 4, 9);
    set_fourcc("DXT1");
    refuse("9 bytes of texels, expected 8");
    make(4, 4, 8);
    set_fourcc("DX10");
    refuse("FourCC 0x30315844");
    set_fourcc("UYVY");
    refuse("format UYVY is not supported for textures");
    set_masks(0x41, 32, 0xff, 0xff00, 0xff, 0xff000000);
    refuse("expected one of Direct3D 9's");
    make(4, 0, 8);
    set_fourcc("DXT1");
    refuse("4 x 0 texels: expected 1 to 8192 a side");
    make(4, 4, 8);
    set_fourcc("DXT1");
    set_levels(4);
    refuse("4 levels: expected at most 3");
    set_levels(1);
    put(112, 0x600);
    refuse("a DDS cube without some of its faces");
    put(112, 0x200000);
    refuse("depth 0: expected 1 to 2048");
    put(4, 123);
    refuse("DDS header of 123 and 32 bytes");
    file[0] = 'd';
    refuse("no DDS file");
}

/* Headers of random bytes are refused or read correctly, and never read out of bounds. */
static void random_headers_do_no_harm(void)
{
    uint64_t seed = 1;
    for (int n = 0; n < 20000; n++) {
        struct triptych_texture_description texture;
        size_t offset;
        make(4, 4, 6 * 16);
        set_fourcc("DXT5");
        for (int i = 0; i < 4; i++) {
            seed ^= seed >> 12;
            seed ^= seed << 25;
            seed ^= seed >> 27;
            uint64_t random = seed * 0x2545f4914f6cdd1d;
            file[random % 128] = (uint8_t)(random >> 32);
        }
        error_clear(&error);
        int result = dds_read("t.dds", file, bytes, &texture, &offset, &error);
        TEST_ASSERT_TRUE(result ? error.text[0] : texture.width && texture.height && texture.depth);
    }
}

static void a_stream_names_a_dds_file_like_a_png(void)
{
    char path[] = "/tmp/triptych-dds.XXXXXX", text[128];
    struct stream *stream;
    int descriptor = mkstemp(path);
    TEST_ASSERT_TRUE(descriptor >= 0);
    make(8, 4, 2 * 8);
    set_fourcc("DXT1");
    TEST_ASSERT_EQUAL_INT64(bytes, write(descriptor, file, bytes));
    close(descriptor);
    snprintf(text, sizeof text, "triptych 1\ntexture t file \"%s\"\ntarget 1 1\n", path);
    int result = stream_parse("a.tri", text, strlen(text), &stream, &error);
    unlink(path);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, result, error.text);
    TEST_ASSERT_EQUAL_UINT(TRIPTYCH_SURFACE_DXT1, stream->resources[0].texture.format);
    TEST_ASSERT_EQUAL_UINT64(16, stream->resources[0].texel_bytes);
    TEST_ASSERT_EQUAL_UINT8_ARRAY(file + 128, stream->resources[0].texels, 16);
    stream_free(stream);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(compressed_textures_of_all_types);
    RUN_TEST(formats_by_masks);
    RUN_TEST(formats_by_number);
    RUN_TEST(damaged_files_are_refused);
    RUN_TEST(random_headers_do_no_harm);
    RUN_TEST(a_stream_names_a_dds_file_like_a_png);
    return UNITY_END();
}
