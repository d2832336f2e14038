/* Rows of texels: every bit pattern of every channel goes to the storage and back, bytes and numbers are
 * rounded to nearest, and nothing beyond a row is written. */
#include "render/texture/convert.h"

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
    return format_named(name, strlen(name));
}

static bool is_uncompressed(const struct format *format)
{
    return format->side == 1 && format->roles;
}

/* Sets a channel's bits in a block of zeros. */
static void put(const struct channel *channel, uint32_t value, uint8_t *block)
{
    for (int i = 0; i < channel->bits; i++)
        if (value >> i & 1)
            block[(channel->shift + i) / 8] |= (uint8_t)(1 << (channel->shift + i) % 8);
}

/* --- There and back --- */

/* A signed channel of 8 bits or more has two patterns for -1, and the first one is encoded. */
static uint32_t canonical(const struct channel *channel, uint32_t value)
{
    uint32_t lowest = 1u << (channel->bits - 1);
    return channel->type == CHANNEL_SIGNED && channel->bits >= 8 && value == lowest ? lowest + 1 : value;
}

static void expect_same(const struct format *format, const uint8_t *block, const uint8_t *expected)
{
    uint8_t texel[16], again[16] = {0};
    format_decode_row(format, block, 1, texel);
    format_encode_row(format, (enum storage)format->storage, texel, 1, again);
    if (memcmp(expected, again, format->bytes)) {
        char what[64];
        snprintf(what, sizeof what, "%s", format->name);
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(expected, again, format->bytes, what);
    }
}

static void go_there_and_back(const struct format *format, unsigned c, uint32_t value)
{
    uint8_t block[16] = {0}, expected[16] = {0};
    put(&format->channel[c], value, block);
    put(&format->channel[c], canonical(&format->channel[c], value), expected);
    expect_same(format, block, expected);
}

/* Of 24 bits, every 37th. */
static void test_every_pattern_of_every_channel_comes_back(void)
{
    for (unsigned i = 0; format_at(i); i++) {
        const struct format *format = format_at(i);
        for (unsigned c = 0; is_uncompressed(format) && c < 4; c++) {
            if (!format_channel_is_stored(format, c) || format->channel[c].bits == 32)
                continue;
            uint32_t step = format->channel[c].bits > 16 ? 37 : 1;
            for (uint32_t value = 0; value < 1u << format->channel[c].bits; value += step)
                go_there_and_back(format, c, value);
        }
    }
}

static void test_every_texel_of_16_bits_comes_back(void)
{
    for (unsigned i = 0; format_at(i); i++) {
        const struct format *format = format_at(i);
        for (uint32_t bits = 0; is_uncompressed(format) && format->bytes == 2 && bits < 65536; bits++) {
            uint8_t block[16] = {(uint8_t)bits, (uint8_t)(bits >> 8)}, expected[16] = {0};
            for (unsigned c = 0; c < 4; c++) {
                const struct channel *channel = &format->channel[c];
                uint32_t value = bits >> channel->shift & ((1u << channel->bits) - 1);
                if (format_channel_is_stored(format, c))
                    put(channel, canonical(channel, value), expected);
            }
            expect_same(format, block, expected);
        }
    }
}

static void test_binary32_comes_back_with_nan_and_denormals(void)
{
    static const char *const names[] = {"R32F", "G32R32F", "A32B32G32R32F"};
    static const uint32_t words[] = {0,          0x80000000, 1,          0x807fffff, 0x3f800000,
                                     0x7f800000, 0xff800000, 0x7f800001, 0xffc12345, 0x7fffffff};
    for (unsigned n = 0; n < 3; n++)
        for (unsigned c = 0; c < 1u << n; c++)
            for (unsigned i = 0; i < sizeof words / sizeof *words; i++)
                go_there_and_back(named(names[n]), c, words[i]);
}

/* --- Rounding --- */

static void test_a_channel_of_n_bits_is_rounded_to_8_bits(void)
{
    for (unsigned i = 0; format_at(i); i++) {
        const struct format *format = format_at(i);
        for (unsigned c = 0; is_uncompressed(format) && format->storage == STORAGE_RGBA8 && c < 4; c++) {
            uint32_t most = (1u << format->channel[c].bits) - 1;
            for (uint32_t value = 0; format->channel[c].bits && value <= most; value++) {
                uint8_t block[16] = {0}, texel[4];
                put(&format->channel[c], value, block);
                format_decode_row(format, block, 1, texel);
                TEST_ASSERT_EQUAL_UINT_MESSAGE((uint32_t)floor(value * 255.0 / most + 0.5), texel[c],
                                               format->name);
            }
        }
    }
}

/* The channel's bits of a block. */
static uint32_t get(const struct channel *channel, const uint8_t *block)
{
    uint32_t value = 0;
    for (int i = 0; i < channel->bits; i++)
        value |= (uint32_t)(block[(channel->shift + i) / 8] >> (channel->shift + i) % 8 & 1) << i;
    return value;
}

static void test_bytes_become_the_nearest_value_of_every_format(void)
{
    for (unsigned i = 0; format_at(i); i++) {
        const struct format *format = format_at(i);
        for (uint32_t byte = 0; is_uncompressed(format) && byte < 256; byte++) {
            uint32_t word = byte * 0x01010101u;
            uint8_t block[16] = {0};
            format_encode_row(format, STORAGE_RGBA8, &word, 1, block);
            for (unsigned c = 0; c < 4; c++) {
                const struct channel *channel = &format->channel[c];
                double most = (double)((1ull << channel->bits) - 1);
                if (channel->type != CHANNEL_UNSIGNED || !format_channel_is_stored(format, c))
                    continue;
                double error = get(channel, block) / most - byte / 255.0;
                TEST_ASSERT_TRUE_MESSAGE(fabs(error) <= 0.5 / most + 1e-12, format->name);
            }
        }
    }
}

static void test_bytes_become_numbers_in_formats_of_numbers(void)
{
    const uint32_t word = 0x80ff3300;
    float numbers[4];
    uint8_t half[2];
    format_encode_row(named("A32B32G32R32F"), STORAGE_RGBA8, &word, 1, numbers);
    for (int c = 0; c < 4; c++)
        TEST_ASSERT_TRUE((float)(word >> 8 * c & 255) / 255.0f == numbers[c]);
    format_encode_row(named("R16F"), STORAGE_RGBA8, &(uint32_t){0xff}, 1, half);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x00, 0x3c}), half, 2);
}

/* 0.3 * 31 = 9.3. By way of 8 bits it would be 76.5, 77, 9.36; -1 and NaN are 0 and 2 is the largest. */
static void test_numbers_become_the_nearest_value_of_a_format_of_bytes(void)
{
    const float numbers[3][4] = {{0.3f, 0.5f, 1, 0}, {-1, 2, NAN, 0}, {0.0485f, 0.99f, 0.5161f, 1}};
    uint16_t words[3];
    format_encode_row(named("R5G6B5"), STORAGE_FLOAT4, numbers, 3, words);
    TEST_ASSERT_EQUAL_HEX16(9 << 11 | 32 << 5 | 31, words[0]);
    TEST_ASSERT_EQUAL_HEX16(63 << 5, words[1]);
    TEST_ASSERT_EQUAL_HEX16(2 << 11 | 62 << 5 | 16, words[2]);
}

/* --- Rows --- */

enum { MOST = 70, GUARD = 0x5a };

/* A row of `count` texels equals its texels one by one, and nothing beyond it is written. */
static void expect_row(const struct format *format, uint32_t count)
{
    uint8_t data[16 * MOST], texels[16 * (MOST + 4)], back[16 * (MOST + 4)], one[16];
    size_t size = format_row_bytes(format);
    for (unsigned i = 0; i < sizeof data; i++)
        data[i] = (uint8_t)(i * 151 + 7);
    memset(texels, GUARD, sizeof texels);
    memset(back, GUARD, sizeof back);
    format_decode_row(format, data, count, texels);
    format_encode_row(format, (enum storage)format->storage, texels, count, back);
    for (uint32_t i = 0; i < count; i++) {
        format_decode_row(format, data + i * format->bytes, 1, one);
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(one, texels + i * size, size, format->name);
        format_encode_row(format, (enum storage)format->storage, texels + i * size, 1, one);
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(one, back + i * format->bytes, format->bytes, format->name);
    }
    TEST_ASSERT_EACH_EQUAL_HEX8_MESSAGE(GUARD, texels + count * size, 4, format->name);
    TEST_ASSERT_EACH_EQUAL_HEX8_MESSAGE(GUARD, back + count * format->bytes, 4, format->name);
}

static void test_rows_of_any_length_equal_their_texels(void)
{
    for (unsigned i = 0; format_at(i); i++)
        for (uint32_t count = 1; is_uncompressed(format_at(i)) && count <= MOST; count += count < 10 ? 1 : 15)
            expect_row(format_at(i), count);
}

static void test_bytes_of_long_rows_become_numbers_in_every_part(void)
{
    uint32_t words[MOST * 2];
    uint16_t out[MOST * 2];
    for (uint32_t i = 0; i < MOST * 2; i++)
        words[i] = i;
    format_encode_row(named("L16"), STORAGE_RGBA8, words, MOST * 2, out);
    for (uint32_t i = 0; i < MOST * 2; i++)
        TEST_ASSERT_EQUAL_UINT(i * 257, out[i]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_pattern_of_every_channel_comes_back);
    RUN_TEST(test_every_texel_of_16_bits_comes_back);
    RUN_TEST(test_binary32_comes_back_with_nan_and_denormals);
    RUN_TEST(test_a_channel_of_n_bits_is_rounded_to_8_bits);
    RUN_TEST(test_bytes_become_the_nearest_value_of_every_format);
    RUN_TEST(test_bytes_become_numbers_in_formats_of_numbers);
    RUN_TEST(test_numbers_become_the_nearest_value_of_a_format_of_bytes);
    RUN_TEST(test_rows_of_any_length_equal_their_texels);
    RUN_TEST(test_bytes_of_long_rows_become_numbers_in_every_part);
    return UNITY_END();
}
