/* Writing sRGB: the encoding over its whole range, and pictures that are blended in linear colour, on every
 * engine. */
#include "base/bits.h"
#include "machine/mxcsr.h"
#include "base/srgb.h"
#include "emu/emulate/bind.h"
#include "spec/math/color.h"
#include "spec/math/srgb.h"
#include "tests/support/picture/canvas.h"

#include <stdio.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

/* Returns the code of a value: the number of codes, after 0, that begin at the value or before it. */
static unsigned encoded(float value)
{
    unsigned code = 0;
    while (code < 255 && srgb_tables.least[code + 1] <= value)
        code++;
    return code;
}

static void expect_code(struct env *e, float value, int code)
{
    flt lanes = lit_f(e, value);
    itg got = srgb_encode(e, lanes);
    if (got.lane[0] == code)
        return;
    char message[80];
    snprintf(message, sizeof message, "%a: expected %d, got %d", (double)value, code, got.lane[0]);
    TEST_FAIL_MESSAGE(message);
}

/* Tests values near the start of every code, and values with all exponents, from 0 to 1. */
static void test_encoding_is_correctly_rounded(void)
{
    struct job job = {.srgb = &srgb_tables};
    static struct env e;
    unsigned saved = mxcsr_enter();
    e.base[BASE_JOB] = (const uint8_t *)&job;
    for (int code = 1; code < 256; code++) {
        expect_code(&e, srgb_tables.least[code], code);
        expect_code(&e, bits_to_float(bits_of_float(srgb_tables.least[code]) - 1), code - 1);
    }
    int code = 0;
    for (uint32_t bits = 0; bits <= 0x3f800000; bits += 997) {
        float value = bits_to_float(bits);
        while (code < 255 && srgb_tables.least[code + 1] <= value)
            code++;
        expect_code(&e, value, code);
    }
    expect_code(&e, 1, 255);
    mxcsr_leave(saved);
}

static void check_encoded_channels(void)
{
    bind_random_texture(SIZE, SIZE);
    set(TRIPTYCH_STATE_SRGBWRITEENABLE, "true");
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++) {
        uint32_t expected = texel[p] & 0xff000000;
        for (int c = 0; c < 3; c++)
            expected |= encoded((float)channel(texel[p], c) / 255.0f) << 8 * c;
        expect_pixel(p % SIZE, p / SIZE, expected, "encoded");
    }
}

static void test_red_green_and_blue_are_encoded_and_alpha_is_not(void)
{
    on_every_engine(check_encoded_channels);
}

/* The target contains random codes. Blending uses the colours that they encode. */
static void check_blending(void)
{
    static uint32_t under[SIZE * SIZE];
    bind_random_texture(SIZE, SIZE);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, under, sizeof under));
    bind_random_texture(SIZE, SIZE);
    set(TRIPTYCH_STATE_SRGBWRITEENABLE, "true");
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "srcalpha");
    set(TRIPTYCH_STATE_DESTBLEND, "invsrcalpha");
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++) {
        uint32_t expected = 0;
        float alpha = (float)(texel[p] >> 24) / 255.0f, inverse = 1 - alpha;
        for (int c = 0; c < 4; c++) {
            float s = (float)channel(texel[p], c) / 255.0f, stored = (float)channel(under[p], c) / 255.0f;
            float d = c < 3 ? srgb_tables.decoded[channel(under[p], c)] : stored;
            float sum = s * alpha + d * inverse;
            expected |= (c < 3 ? encoded(sum) : (uint32_t)lane_round(sum * 255.0f)) << 8 * c;
        }
        expect_pixel(p % SIZE, p / SIZE, expected, "blended");
    }
}

static void test_blending_is_linear(void)
{
    on_every_engine(check_blending);
}

/* Channels that are not written keep their bytes. */
static void check_masks(void)
{
    bind_random_texture(SIZE, SIZE);
    set(TRIPTYCH_STATE_SRGBWRITEENABLE, "true");
    for (uint32_t mask = 0; mask < 16; mask++) {
        uint32_t background = random_word();
        OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, mask));
        clear_to(background);
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
        OK(triptych_read_color(device, image, sizeof image));
        for (int p = 0; p < SIZE * SIZE; p++) {
            uint32_t expected = background;
            for (int c = 0; c < 4; c++)
                if (mask >> c & 1) {
                    unsigned byte = channel(texel[p], c);
                    uint32_t written = c < 3 ? encoded((float)byte / 255.0f) : byte;
                    expected = (expected & ~(255u << 8 * c)) | written << 8 * c;
                }
            expect_pixel(p % SIZE, p / SIZE, expected, "masked");
        }
    }
}

static void test_masks_hold_for_encoded_channels(void)
{
    on_every_engine(check_masks);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_encoding_is_correctly_rounded);
    RUN_TEST(test_red_green_and_blue_are_encoded_and_alpha_is_not);
    RUN_TEST(test_blending_is_linear);
    RUN_TEST(test_masks_hold_for_encoded_channels);
    return UNITY_END();
}
