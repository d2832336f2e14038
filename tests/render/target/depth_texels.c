/* Texels of depth: depths of whole rows are those of single words, for every word of every format of
 * integers. */
#include "machine/mxcsr.h"
#include "render/target/depth.h"

#include <string.h>
#include <unity.h>

enum { ROW = 4096 };

static unsigned saved;
static uint32_t words[ROW];
static float texels[4 * ROW];

void setUp(void)
{
    saved = mxcsr_enter();
}

void tearDown(void)
{
    mxcsr_leave(saved);
}

/* The first of the row's texels that is not the depth of its word; ROW if none is. */
static uint32_t wrong_texel(enum triptych_depth_format format, bool opaque, uint32_t count)
{
    depth_texels(format, words, count, opaque, texels);
    for (uint32_t i = 0; i < count; i++) {
        float depth = depth_decode(format, words[i]), alpha = opaque ? 1 : depth;
        const float expected[4] = {depth, depth, depth, alpha};
        if (memcmp(expected, texels + 4 * i, sizeof expected))
            return i;
    }
    return ROW;
}

static void check_integers(enum triptych_depth_format format, uint32_t step)
{
    uint32_t last = (uint32_t)depth_maximum(format), count = 0;
    for (uint32_t n = 0; n <= last; n += step) {
        words[count++] = n << 8 | (n & stencil_mask(format));
        if (count < ROW && n + step <= last)
            continue;
        uint32_t wrong = wrong_texel(format, n & 1, count);
        if (wrong < ROW)
            TEST_FAIL_MESSAGE("a texel is not the depth of its word");
        count = 0;
    }
}

static void test_integers_have_the_depth_of_their_word(void)
{
    check_integers(TRIPTYCH_DEPTH_D24S8, 1);
    check_integers(TRIPTYCH_DEPTH_D24X8, 3);
    check_integers(TRIPTYCH_DEPTH_D16, 1);
    check_integers(TRIPTYCH_DEPTH_D15S1, 1);
}

/* Rows whose length is not a multiple of four, as with a surface of odd width. */
static void test_short_rows_are_converted_to_their_end(void)
{
    for (uint32_t count = 1; count < 12; count++) {
        for (uint32_t i = 0; i < count; i++)
            words[i] = (0xffffffu - i * 1234567u) << 8 | 0xa5;
        memset(texels, 0xee, sizeof texels);
        TEST_ASSERT_EQUAL_UINT32(ROW, wrong_texel(TRIPTYCH_DEPTH_D24S8, count & 1, count));
        const uint32_t untouched = 0xeeeeeeee;
        TEST_ASSERT_EQUAL_MEMORY(&untouched, texels + 4 * count, sizeof untouched);
    }
}

static void test_other_formats_have_the_depth_of_their_word(void)
{
    static const enum triptych_depth_format formats[] = {TRIPTYCH_DEPTH_D32F_LOCKABLE, TRIPTYCH_DEPTH_D24FS8,
                                                         TRIPTYCH_DEPTH_D32};
    for (unsigned f = 0; f < sizeof formats / sizeof *formats; f++) {
        for (uint32_t i = 0; i < ROW; i++)
            words[i] = depth_encode(formats[f], (float)i / ROW);
        TEST_ASSERT_EQUAL_UINT32(ROW, wrong_texel(formats[f], f & 1, ROW));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_integers_have_the_depth_of_their_word);
    RUN_TEST(test_short_rows_are_converted_to_their_end);
    RUN_TEST(test_other_formats_have_the_depth_of_their_word);
    return UNITY_END();
}
