/* The limits of 16-bit arithmetic in filters and addresses (docs/architecture.md), at their edges: the
 * results of the specification equal those of wider integers for the largest operands, and would not for
 * larger ones. */
#include "machine/mxcsr.h"
#include "emu/emulate/bind.h"
#include "triptych.h"

#include <unity.h>

#include "spec/texture/sample.h"

enum { LARGEST = TRIPTYCH_TEXTURE_MAXIMUM };

static unsigned saved;
static struct env e;

void setUp(void)
{
    saved = mxcsr_enter();
}

void tearDown(void)
{
    mxcsr_leave(saved);
}

/* --- Filters: differences of channels, and weights in 1/256, in signed 16 bits -------------------------- */

static unsigned blended(unsigned a, unsigned b, unsigned weight)
{
    fix fine = fine_weight(&e, lit_x(&e, (uint16_t)weight));
    return lerp_256(&e, lit_x(&e, (uint16_t)a), lit_x(&e, (uint16_t)b), fine).half[0];
}

static void a_blend_of_at_most_fifteen_bits_is_exact_at_each_weight(void)
{
    static const unsigned channels[] = {0, 1, 127, 128, 254, 255, 32766, 32767};
    for (unsigned weight = 0; weight < 256; weight++)
        for (unsigned i = 0; i < 8; i++)
            for (unsigned j = 0; j < 8; j++) {
                unsigned a = channels[i], b = channels[j];
                TEST_ASSERT_EQUAL_UINT((a * (256 - weight) + b * weight + 128) / 256, blended(a, b, weight));
            }
}

/* The weight times 128 is 32768 for 256, which is negative, as a difference of 32768 is. */
static void a_weight_of_256_and_a_difference_of_sixteen_bits_would_overflow(void)
{
    TEST_ASSERT_TRUE(blended(0, 255, 256) != 255);
    TEST_ASSERT_TRUE(blended(0, 32768, 128) != 16384);
}

static void a_product_of_bytes_is_rounded_correctly(void)
{
    for (unsigned a = 0; a < 256; a++)
        for (unsigned b = 0; b < 256; b++) {
            fix product = mul_x(&e, lit_x(&e, (uint16_t)a), lit_x(&e, (uint16_t)b));
            TEST_ASSERT_EQUAL_UINT((2 * a * b + 255) / 510, divide_255(&e, product).half[0]);
        }
}

/* The sum of the taps of the widest anisotropic filter. */
static void sixteen_taps_have_room(void)
{
    TEST_ASSERT_TRUE(ANISOTROPY_MAXIMUM * 255 <= UINT16_MAX);
}

/* --- Addresses: rows and pitches in the signed halves of dot_i (pmaddwd) -------------------------------- */

static int32_t row_of(int32_t y, int32_t pitch, bool tiled)
{
    const struct sampler_key k = {.tiled = tiled};
    const struct sampler s = {.k = &k, .axes = 2};
    return row_start(&e, &s, lit_i(&e, y), lit_i(&e, pitch)).lane[0];
}

static void the_last_row_of_the_largest_texture_is_addressed(void)
{
    for (int32_t y = LARGEST - 9; y < LARGEST; y++) {
        TEST_ASSERT_EQUAL_INT32(y * (LARGEST + 1), row_of(y, LARGEST + 1, false));
        TEST_ASSERT_EQUAL_INT32(y / 4 * 4 * LARGEST + y % 4 * 4, row_of(y, LARGEST, true));
    }
}

/* 16 bits have room for textures of up to 32766 texels; the first pitch beyond it is negative. */
static void the_largest_pitch_is_that_of_15_bits(void)
{
    TEST_ASSERT_TRUE(LARGEST + 1 <= INT16_MAX);
    TEST_ASSERT_EQUAL_INT32(3 * INT16_MAX, row_of(3, INT16_MAX, false));
    TEST_ASSERT_EQUAL_INT32(-3 * (INT16_MAX + 1), row_of(3, INT16_MAX + 1, false));
}

/* --- Positions: 24.8 fixed point ------------------------------------------------------------------------ */

static int32_t index_of(float coordinate, int32_t size)
{
    struct level level = {.each = true};
    struct tap tap = {.linear = false};
    struct axis axis;
    level.size[0] = lit_i(&e, size);
    level.last[0] = lit_i(&e, size - 1);
    level.size_256[0] = lit_f(&e, (float)(size * 256));
    address_axis(&e, &level, &tap, ADDRESS_WRAP_POWER, 0, lit_f(&e, coordinate), &axis);
    return axis.index[0].lane[0];
}

/* A position is below 2^31: the largest texture repeats up to 1023 times in either direction, and beyond it
 * all positions are texel 0. */
static void positions_have_24_bits_before_the_point(void)
{
    TEST_ASSERT_EQUAL_INT32(LARGEST / 2, index_of(1023.5f, LARGEST));
    TEST_ASSERT_EQUAL_INT32(LARGEST / 2, index_of(-1023.5f, LARGEST));
    TEST_ASSERT_EQUAL_INT32(0, index_of(1024.5f, LARGEST));
    TEST_ASSERT_EQUAL_INT32(128, index_of(32767.5f, 256));
    TEST_ASSERT_EQUAL_INT32(0, index_of(32768.5f, 256));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_blend_of_at_most_fifteen_bits_is_exact_at_each_weight);
    RUN_TEST(a_weight_of_256_and_a_difference_of_sixteen_bits_would_overflow);
    RUN_TEST(a_product_of_bytes_is_rounded_correctly);
    RUN_TEST(sixteen_taps_have_room);
    RUN_TEST(the_last_row_of_the_largest_texture_is_addressed);
    RUN_TEST(the_largest_pitch_is_that_of_15_bits);
    RUN_TEST(positions_have_24_bits_before_the_point);
    return UNITY_END();
}
