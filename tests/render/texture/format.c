/* Formats: texels of every supported format, computed by hand from Direct3D 9's documentation, decoded and
 * encoded. */
#include "render/texture/format.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static const struct format *named(const char *name)
{
    const struct format *format = format_named(name, strlen(name));
    TEST_ASSERT_NOT_NULL_MESSAGE(format, name);
    return format;
}

/* --- Packed texels --- */

/* A texel's bytes in memory, and its decoded word with alpha in the high byte and red in the low byte. */
static const struct byte_case {
    const char *format;
    uint8_t data[4];
    uint32_t texel;
} byte_cases[] = {
    {"R8G8B8", {0x30, 0x20, 0x10}, 0xff302010},
    {"A8R8G8B8", {0x30, 0x20, 0x10, 0x40}, 0x40302010},
    {"X8R8G8B8", {0x30, 0x20, 0x10, 0x40}, 0xff302010},
    {"A8B8G8R8", {0x10, 0x20, 0x30, 0x40}, 0x40302010},
    {"X8B8G8R8", {0x10, 0x20, 0x30, 0x40}, 0xff302010},
    {"R5G6B5", {0x00, 0xf8}, 0xff0000ff},
    {"R5G6B5", {0xe0, 0x07}, 0xff00ff00},
    {"R5G6B5", {0x1f, 0x00}, 0xffff0000},
    {"R5G6B5", {0x61, 0x18}, 0xff080c19}, /* 3 / 31 * 255 = 24.7, 3 / 63 * 255 = 12.1, 1 / 31 * 255 = 8.2 */
    {"X1R5G5B5", {0x00, 0x7c}, 0xff0000ff},
    {"X1R5G5B5", {0xe0, 0x83}, 0xff00ff00},
    {"A1R5G5B5", {0x1f, 0x80}, 0xffff0000},
    {"A1R5G5B5", {0x10, 0x7c}, 0x008400ff},
    {"A4R4G4B4", {0x23, 0x41}, 0x44332211},
    {"X4R4G4B4", {0x23, 0x41}, 0xff332211},
    {"R3G3B2", {0xe0}, 0xff0000ff},
    {"R3G3B2", {0x26}, 0xffaa2424}, /* 1 / 7 * 255 = 36.4, 1 / 7, 2 / 3 */
    {"A8R3G3B2", {0x03, 0x80}, 0x80ff0000},
    {"A8", {0x77}, 0x77000000},
    {"L8", {0x77}, 0xff777777},
    {"A8L8", {0x77, 0x12}, 0x12777777},
    {"A4L4", {0x5a}, 0x55aaaaaa},
    {"R8", {0x77}, 0xff000077},
    {"R8G8", {0x77, 0x12}, 0xff001277},
};

static void test_texels_of_8_bits_a_channel_or_less(void)
{
    for (unsigned i = 0; i < sizeof byte_cases / sizeof *byte_cases; i++) {
        const struct byte_case *c = &byte_cases[i];
        const struct format *format = named(c->format);
        uint32_t texel;
        TEST_ASSERT_EQUAL_INT_MESSAGE(STORAGE_RGBA8, format->storage, c->format);
        format_decode(format, c->data, 0, 1, 1, &texel, 1);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(c->texel, texel, c->format);
    }
}

static const struct number_case {
    const char *format;
    uint8_t data[16];
    float texel[4];
} number_cases[] = {
    {"A2B10G10R10", {0xff, 0x03, 0x00, 0x40}, {1, 0, 0, 1.0f / 3}},
    {"A2B10G10R10", {0x00, 0x04, 0xf0, 0xff}, {0, 1.0f / 1023, 1, 1}},
    {"A2R10G10B10", {0xff, 0x03, 0x00, 0x80}, {0, 0, 1, 2.0f / 3}},
    {"A2R10G10B10", {0x00, 0x00, 0xf0, 0x3f}, {1, 0, 0, 0}},
    {"G16R16", {0xff, 0xff, 0x01, 0x00}, {1, 1.0f / 65535, 1, 1}},
    {"A16B16G16R16",
     {0x01, 0x00, 0xff, 0xff, 0x00, 0x80, 0x00, 0x00},
     {1.0f / 65535, 1, 32768.0f / 65535, 0}},
    {"L16", {0x00, 0x80}, {32768.0f / 65535, 32768.0f / 65535, 32768.0f / 65535, 1}},
    {"V8U8", {0x7f, 0x80}, {1, -1, 1, 1}},
    {"V8U8", {0x81, 0x40}, {-1, 64.0f / 127, 1, 1}},
    {"L6V5U5", {0x0f, 0xfe}, {1, -1, 1, 1}}, /* u 15, v 16, l 63 */
    {"L6V5U5", {0xff, 0x07}, {-1.0f / 16, -1.0f / 16, 1.0f / 63, 1}},
    {"L6V5U5", {0x11, 0x81}, {-15.0f / 16, 8.0f / 15, 32.0f / 63, 1}},
    {"X8L8V8U8", {0x00, 0x7f, 0x80, 0x55}, {0, 1, 128.0f / 255, 1}},
    {"Q8W8V8U8", {0x01, 0x7f, 0xff, 0x80}, {1.0f / 127, 1, -1.0f / 127, -1}},
    {"V16U16", {0xff, 0x7f, 0x00, 0x80}, {1, -1, 1, 1}},
    {"Q16W16V16U16", {0x01, 0, 0xff, 0xff, 0xff, 0x7f, 0x00, 0x80}, {1.0f / 32767, -1.0f / 32767, 1, -1}},
    {"A2W10V10U10", {0xff, 0x01, 0x08, 0xe0}, {1, -1, -1, 1}},
    {"R16F", {0x00, 0x3c}, {1, 1, 1, 1}},
    {"R16F", {0x01, 0x80}, {-0x1p-24f, 1, 1, 1}},
    {"G16R16F", {0x00, 0xc0, 0x00, 0x38}, {-2, 0.5f, 1, 1}},
    {"A16B16G16R16F", {0x00, 0x3c, 0x00, 0x40, 0x00, 0x44, 0x00, 0x48}, {1, 2, 4, 8}},
    {"R32F", {0x00, 0x00, 0x20, 0x41}, {10, 1, 1, 1}},
    {"G32R32F", {0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x80, 0xbf}, {1, -1, 1, 1}},
    {"A32B32G32R32F", {0, 0, 0x80, 0x3f, 0, 0, 0, 0x40, 0, 0, 0x40, 0x40, 0, 0, 0x80, 0x40}, {1, 2, 3, 4}},
    {"CxV8U8", {0x00, 0x00}, {0, 0, 1, 1}},
    {"CxV8U8", {0x7f, 0x00}, {1, 0, 0, 1}},
    {"CxV8U8", {0x7f, 0x7f}, {1, 1, 0, 1}}, /* no unit vector has these */
    {"D16", {0x00, 0x80}, {32768.0f / 65535, 32768.0f / 65535, 32768.0f / 65535, 32768.0f / 65535}},
    {"DF16", {0xff, 0xff}, {1, 1, 1, 1}},
    {"D24X8", {0x55, 0xff, 0xff, 0xff}, {1, 1, 1, 1}},
    {"D24S8", {0xff, 0x01, 0x00, 0x00}, {1.0f / 16777215, 1.0f / 16777215, 1.0f / 16777215, 1.0f / 16777215}},
    {"INTZ",
     {0xff, 0x00, 0x00, 0x80},
     {8388608.0f / 16777215, 8388608.0f / 16777215, 8388608.0f / 16777215, 8388608.0f / 16777215}},
    {"L24S8",
     {0x55, 0x00, 0x00, 0x80},
     {8388608.0f / 16777215, 8388608.0f / 16777215, 8388608.0f / 16777215, 1}},
    {"DF24", {0xff, 0x00, 0x00, 0x00}, {0, 0, 0, 0}},
};

static void test_texels_of_more_than_8_bits_or_of_signs(void)
{
    for (unsigned i = 0; i < sizeof number_cases / sizeof *number_cases; i++) {
        const struct number_case *c = &number_cases[i];
        const struct format *format = named(c->format);
        float texel[4];
        TEST_ASSERT_EQUAL_INT_MESSAGE(STORAGE_FLOAT4, format->storage, c->format);
        format_decode(format, c->data, 0, 1, 1, texel, 1);
        for (int k = 0; k < 4; k++) {
            char what[64];
            snprintf(what, sizeof what, "%s, case %u, channel %d", c->format, i, k);
            TEST_ASSERT_TRUE_MESSAGE(c->texel[k] == texel[k], what);
        }
    }
}

static int is_tested(const char *name)
{
    for (unsigned i = 0; i < sizeof byte_cases / sizeof *byte_cases; i++)
        if (!strcmp(byte_cases[i].format, name))
            return 1;
    for (unsigned i = 0; i < sizeof number_cases / sizeof *number_cases; i++)
        if (!strcmp(number_cases[i].format, name))
            return 1;
    return 0;
}

static void test_no_format_of_textures_is_left_out_above(void)
{
    for (unsigned i = 0; format_at(i); i++)
        if (format_at(i)->roles & ROLE_TEXTURE && format_at(i)->side == 1) {
            TEST_ASSERT_TRUE_MESSAGE(is_tested(format_at(i)->name), format_at(i)->name);
        }
}

/* --- Tables --- */

static void test_names_and_numbers_find_their_row_and_no_two_are_the_same(void)
{
    for (unsigned i = 0; format_at(i); i++) {
        TEST_ASSERT_EQUAL_PTR(format_at(i), format_find(format_at(i)->number));
        TEST_ASSERT_EQUAL_PTR(format_at(i), named(format_at(i)->name));
    }
    TEST_ASSERT_NULL(format_find(0));
    TEST_ASSERT_NULL(format_named("A8R8G8B", 7));
    TEST_ASSERT_EQUAL_UINT(21, named("A8R8G8B8")->number);
    TEST_ASSERT_EQUAL_UINT('D' | 'X' << 8 | 'T' << 16 | '1' << 24, named("DXT1")->number);
    TEST_ASSERT_EQUAL_UINT('I' | 'N' << 8 | 'T' << 16 | 'Z' << 24, named("INTZ")->number);
}

/* Channels lie within the block and do not overlap, except that one place may be read as several channels. */
static void test_channels_are_within_the_block_and_do_not_overlap(void)
{
    for (unsigned i = 0; format_at(i); i++) {
        const struct format *format = format_at(i);
        for (int c = 0; c < 4; c++) {
            const struct channel *a = &format->channel[c];
            TEST_ASSERT_LESS_OR_EQUAL_MESSAGE(8 * format->bytes, a->shift + a->bits, format->name);
            for (int d = 0; d < c; d++) {
                const struct channel *b = &format->channel[d];
                int same = a->shift == b->shift && a->bits == b->bits && a->type == b->type;
                int apart = a->shift >= b->shift + b->bits || b->shift >= a->shift + a->bits;
                TEST_ASSERT_TRUE_MESSAGE(same || apart || !a->bits || !b->bits, format->name);
            }
        }
    }
}

/* --- Encoding --- */

static uint64_t seed = 1;

static uint32_t random_word(void)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (uint32_t)(seed * 0x2545f4914f6cdd1dull >> 32);
}

/* Decoded random blocks are values of the format, so encoding and decoding them again does not change
 * them. */
static void test_encoding_decoded_texels_gives_the_same_texels(void)
{
    for (unsigned i = 0; format_at(i); i++) {
        const struct format *format = format_at(i);
        if (!(format->roles & (ROLE_TEXTURE | ROLE_TARGET)) || format->coding != CODING_PACKED)
            continue;
        for (int n = 0; n < 2000; n++) {
            uint32_t block[4], again[4];
            uint32_t first[4] = {0}, second[4] = {0};
            for (int k = 0; k < 4; k++)
                block[k] = random_word();
            format_decode(format, block, 0, 1, 1, first, 1);
            int finite = 1;
            for (int k = 0; format->storage == STORAGE_FLOAT4 && k < 4; k++)
                finite &= (first[k] & 0x7f800000) != 0x7f800000;
            if (!finite)
                continue;
            format_encode(format, first, 1, 1, 1, again, 0);
            format_decode(format, again, 0, 1, 1, second, 1);
            TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(first, second, 4, format->name);
        }
    }
}

static void encode_floats(const char *name, float r, float g, float b, float a, void *data)
{
    const float texel[4] = {r, g, b, a};
    format_encode(named(name), texel, 1, 1, 1, data, 0);
}

static void test_encoding_rounds_to_nearest_and_limits(void)
{
    uint8_t data[16];
    uint32_t word = 0x80ff7f00;
    format_encode(named("R5G6B5"), &word, 1, 1, 1, data, 0);
    TEST_ASSERT_EQUAL_HEX8(0x1f | (31 & 7) << 5, data[0]); /* 0x7f / 255 * 63 = 31.4 */
    TEST_ASSERT_EQUAL_HEX8(31 >> 3, data[1]);
    format_encode(named("A1R5G5B5"), &word, 1, 1, 1, data, 0);
    TEST_ASSERT_EQUAL_HEX8(0x80, data[1] & 0x80); /* 128 / 255 is nearer to 1 */
    format_encode(named("X8R8G8B8"), &word, 1, 1, 1, data, 0);
    TEST_ASSERT_EQUAL_HEX8(0, data[3]);
    encode_floats("G16R16", 2, -1, 0, 0, data);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0xff, 0xff, 0, 0}), data, 4);
    encode_floats("G16R16", NAN, 0.5f, 0, 0, data); /* 32767.5: even is 32768 */
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0, 0, 0x00, 0x80}), data, 4);
    encode_floats("V16U16", -2, 1, 0, 0, data);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x01, 0x80, 0xff, 0x7f}), data, 4);
    encode_floats("A2W10V10U10", -1, 0, 1, 1, data);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x01, 0x02, 0xf0, 0xdf}), data, 4);
    encode_floats("L6V5U5", -2, -0.9f, 1, 0, data); /* -14.4 of 16 steps */
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x50, 0xfe}), data, 2);
    encode_floats("R16F", 65536, 0, 0, 0, data);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x00, 0x7c}), data, 2);
}

static void test_rows_keep_their_pitch_and_stride(void)
{
    const struct format *format = named("L8");
    const uint8_t data[] = {1, 2, 99, 3, 4, 99};
    uint32_t texels[6] = {7, 7, 7, 7, 7, 7};
    format_decode(format, data, 3, 2, 2, texels, 3);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(((uint32_t[]){0xff010101, 0xff020202, 7, 0xff030303, 0xff040404, 7}),
                                  texels, 6);
    uint8_t back[6] = {9, 9, 9, 9, 9, 9};
    format_encode(format, texels, 3, 2, 2, back, 3);
    TEST_ASSERT_EQUAL_UINT8_ARRAY(((uint8_t[]){1, 2, 9, 3, 4, 9}), back, 6);
}

/* --- Blocks --- */

/* Codes 0, 1, 2, 3 in the first row, reversed in the second, 0 and 3 below. */
#define CODES 0xe4, 0x1b, 0x00, 0xff

static void decode(const char *name, const uint8_t *block, uint32_t texels[16])
{
    format_decode(named(name), block, 0, 4, 4, texels, 4);
}

static void test_dxt1_of_four_colors(void)
{
    /* c0 = (31, 63, 31), c1 = (0, 0, 0): white, black and the two thirds */
    const uint8_t block[8] = {0xff, 0xff, 0x00, 0x00, CODES};
    uint32_t t[16];
    decode("DXT1", block, t);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(((uint32_t[]){0xffffffff, 0xff000000, 0xffaaaaaa, 0xff555555, 0xff555555,
                                                0xffaaaaaa, 0xff000000, 0xffffffff}),
                                  t, 8);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, t[8]);
    TEST_ASSERT_EQUAL_HEX32(0xff555555, t[15]);
}

static void test_dxt1_rounds_thirds_to_nearest(void)
{
    /* c0 = (1, 2, 3) is (8, 8, 25), c1 = (0, 1, 0) is (0, 4, 0): (16 + 1) / 3 = 5, (20 + 1) / 3 = 7, 51 / 3 =
     * 17 */
    const uint8_t block[8] = {0x43, 0x08, 0x20, 0x00, CODES};
    uint32_t t[16];
    decode("DXT1", block, t);
    TEST_ASSERT_EQUAL_HEX32(0xff190808, t[0]);
    TEST_ASSERT_EQUAL_HEX32(0xff000400, t[1]);
    TEST_ASSERT_EQUAL_HEX32(0xff110705, t[2]);
    TEST_ASSERT_EQUAL_HEX32(0xff080503, t[3]);
}

static void test_dxt1_of_three_colors_has_transparent_black(void)
{
    const uint8_t block[8] = {0x00, 0x00, 0xff, 0xff, CODES};
    const uint8_t equal[8] = {0xff, 0xff, 0xff, 0xff, CODES};
    uint32_t t[16];
    decode("DXT1", block, t);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(((uint32_t[]){0xff000000, 0xffffffff, 0xff7f7f7f, 0}), t, 4);
    decode("DXT1", equal, t);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(((uint32_t[]){0xffffffff, 0xffffffff, 0xffffffff, 0}), t, 4);
}

static void test_dxt3_has_four_bits_of_alpha_and_always_four_colors(void)
{
    const uint8_t block[16] = {0x10, 0x32, 0x54, 0x76, 0x98, 0xba, 0xdc, 0xfe, 0x00, 0x00, 0xff, 0xff, CODES};
    uint32_t t[16];
    for (int premultiplied = 0; premultiplied < 2; premultiplied++) {
        decode(premultiplied ? "DXT2" : "DXT3", block, t);
        for (uint32_t i = 0; i < 16; i++)
            TEST_ASSERT_EQUAL_HEX32(i * 17, t[i] >> 24);
        TEST_ASSERT_EQUAL_HEX32(0x22555555, t[2]);
        TEST_ASSERT_EQUAL_HEX32(0x33aaaaaa, t[3]);
    }
}

/* Alpha codes 0 to 7 twice: each three bytes hold eight codes. */
#define ALPHAS 0x88, 0xc6, 0xfa, 0x88, 0xc6, 0xfa

static void expect_alphas(const uint8_t expected[8], const uint32_t t[16])
{
    for (int i = 0; i < 16; i++)
        TEST_ASSERT_EQUAL_UINT(expected[i % 8], t[i] >> 24);
}

static void test_dxt5_interpolates_alpha_in_eight_or_six_steps(void)
{
    const uint8_t eight[16] = {255, 0, ALPHAS, 0x00, 0x00, 0xff, 0xff, CODES};
    const uint8_t six[16] = {10, 201, ALPHAS, 0x00, 0x00, 0xff, 0xff, CODES};
    uint32_t t[16];
    decode("DXT5", eight, t);
    /* (6 * 255 + 3) / 7 = 219, 182.6 -> 182, 146.1 -> 146, 109.7 -> 109, 73.3 -> 73, 36.9 -> 36 */
    expect_alphas((const uint8_t[]){255, 0, 219, 182, 146, 109, 73, 36}, t);
    TEST_ASSERT_EQUAL_HEX32(0x00555555, t[2] & 0xffffff);
    decode("DXT4", six, t);
    /* (4 * 10 + 201 + 2) / 5 = 48.6, (30 + 402 + 2) / 5 = 86.8, 125, 163.2 */
    expect_alphas((const uint8_t[]){10, 201, 48, 86, 125, 163, 0, 255}, t);
}

static void test_3dc_is_one_or_two_alpha_blocks(void)
{
    const uint8_t block[16] = {255, 0, ALPHAS, 10, 201, ALPHAS};
    uint32_t t[16];
    decode("ATI1", block, t);
    TEST_ASSERT_EQUAL_HEX32(0xffdbdbdb, t[2]);
    decode("ATI2", block, t); /* green from the first block, red from the second */
    TEST_ASSERT_EQUAL_HEX32(0xffffff00 | 10, t[0]);
    TEST_ASSERT_EQUAL_HEX32(0xff000000 | 0xff0000 | 219 << 8 | 48, t[2]);
}

static void test_blocks_at_the_edge_are_cut(void)
{
    uint8_t blocks[4 * 8] = {0};
    for (int i = 0; i < 4; i++)
        blocks[8 * i] = (uint8_t)(i + 1); /* blue 1 to 4 */
    uint32_t t[5 * 8], blue[5] = {0, 8, 16, 25, 33};
    memset(t, 0x77, sizeof t);
    format_decode(named("DXT1"), blocks, 16, 5, 5, t, 8);
    for (int y = 0; y < 5; y++)
        for (int x = 0; x < 8; x++)
            TEST_ASSERT_EQUAL_HEX32(x < 5 ? 0xff000000 | blue[1 + x / 4 + 2 * (y / 4)] << 16 : 0x77777777,
                                    t[8 * y + x]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_texels_of_8_bits_a_channel_or_less);
    RUN_TEST(test_texels_of_more_than_8_bits_or_of_signs);
    RUN_TEST(test_no_format_of_textures_is_left_out_above);
    RUN_TEST(test_names_and_numbers_find_their_row_and_no_two_are_the_same);
    RUN_TEST(test_channels_are_within_the_block_and_do_not_overlap);
    RUN_TEST(test_encoding_decoded_texels_gives_the_same_texels);
    RUN_TEST(test_encoding_rounds_to_nearest_and_limits);
    RUN_TEST(test_rows_keep_their_pitch_and_stride);
    RUN_TEST(test_dxt1_of_four_colors);
    RUN_TEST(test_dxt1_rounds_thirds_to_nearest);
    RUN_TEST(test_dxt1_of_three_colors_has_transparent_black);
    RUN_TEST(test_dxt3_has_four_bits_of_alpha_and_always_four_colors);
    RUN_TEST(test_dxt5_interpolates_alpha_in_eight_or_six_steps);
    RUN_TEST(test_3dc_is_one_or_two_alpha_blocks);
    RUN_TEST(test_blocks_at_the_edge_are_cut);
    return UNITY_END();
}
