/* Formats of colour targets, several targets together, and dithering, on every engine. The expected
 * colours are computed from the formats' bits. */
#include "base/half.h"
#include "tests/support/picture/canvas.h"

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

enum { NONE, ZERO = -1, HALF = -16, SINGLE = -32 };

/* Bits of red, green, blue and alpha, or one of the above. */
struct kind {
    enum triptych_surface_format format;
    int bits[4];
};

/* The channel of colours that a channel of the target has: luminance is red. */
static int source(const struct kind *kind, int c)
{
    int light = kind->format == TRIPTYCH_SURFACE_L8 || kind->format == TRIPTYCH_SURFACE_A8L8;
    return light && c < 3 ? 0 : c;
}

static const struct kind kinds[] = {
    {TRIPTYCH_SURFACE_A8R8G8B8, {8, 8, 8, 8}},
    {TRIPTYCH_SURFACE_X8R8G8B8, {8, 8, 8, NONE}},
    {TRIPTYCH_SURFACE_A8B8G8R8, {8, 8, 8, 8}},
    {TRIPTYCH_SURFACE_X8B8G8R8, {8, 8, 8, NONE}},
    {TRIPTYCH_SURFACE_R5G6B5, {5, 6, 5, NONE}},
    {TRIPTYCH_SURFACE_X1R5G5B5, {5, 5, 5, NONE}},
    {TRIPTYCH_SURFACE_A1R5G5B5, {5, 5, 5, 1}},
    {TRIPTYCH_SURFACE_A4R4G4B4, {4, 4, 4, 4}},
    {TRIPTYCH_SURFACE_X4R4G4B4, {4, 4, 4, NONE}},
    {TRIPTYCH_SURFACE_A2R10G10B10, {10, 10, 10, 2}},
    {TRIPTYCH_SURFACE_A2B10G10R10, {10, 10, 10, 2}},
    {TRIPTYCH_SURFACE_G16R16, {16, 16, NONE, NONE}},
    {TRIPTYCH_SURFACE_A16B16G16R16, {16, 16, 16, 16}},
    {TRIPTYCH_SURFACE_R16F, {HALF, NONE, NONE, NONE}},
    {TRIPTYCH_SURFACE_G16R16F, {HALF, HALF, NONE, NONE}},
    {TRIPTYCH_SURFACE_A16B16G16R16F, {HALF, HALF, HALF, HALF}},
    {TRIPTYCH_SURFACE_R32F, {SINGLE, NONE, NONE, NONE}},
    {TRIPTYCH_SURFACE_G32R32F, {SINGLE, SINGLE, NONE, NONE}},
    {TRIPTYCH_SURFACE_A32B32G32R32F, {SINGLE, SINGLE, SINGLE, SINGLE}},
    {TRIPTYCH_SURFACE_A8, {ZERO, ZERO, ZERO, 8}},
    {TRIPTYCH_SURFACE_R8, {8, ZERO, ZERO, NONE}},
    {TRIPTYCH_SURFACE_R8G8, {8, 8, ZERO, NONE}},
    {TRIPTYCH_SURFACE_L8, {8, 8, 8, NONE}},
    {TRIPTYCH_SURFACE_A8L8, {8, 8, 8, 8}},
    {TRIPTYCH_SURFACE_NULL, {NONE, NONE, NONE, NONE}},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static float numbers[SIZE * SIZE][4];

static void open_targets(const struct kind *const kind[4])
{
    struct triptych_target_description description = {.width = SIZE, .height = SIZE};
    for (int t = 0; t < 4 && kind[t]; t++)
        description.color_format[t] = kind[t]->format;
    OK(triptych_set_target_description(device, &description));
}

static void open_target(const struct kind *kind)
{
    open_targets((const struct kind *const[4]){kind, NULL, NULL, NULL});
}

static float saturated(float value)
{
    return value > 0 ? value < 1 ? value : 1 : 0;
}

/* Returns the byte of a channel of less than 8 bits: the nearest byte to its value. */
static float kept(int bits, float value)
{
    if (bits == NONE)
        return 1;
    if (bits == ZERO)
        return 0;
    if (bits == SINGLE)
        return value;
    if (bits == HALF)
        return half_to_float(float_to_half(value));
    float levels = (float)((1 << bits) - 1), level = rintf(saturated(value) * levels);
    return bits < 8 ? rintf(level * 255 / levels) / 255 : level / levels;
}

static void expect_number(unsigned t, int p, int c, float expected, const char *what)
{
    char message[160];
    float got = numbers[p][c];
    if (got == expected)
        return;
    snprintf(message, sizeof message, "%s: target %u, pixel %d, channel %d: expected %a, got %a", what, t, p,
             c, (double)expected, (double)got);
    TEST_FAIL_MESSAGE(message);
}

static void expect_pixels(unsigned t, const struct kind *kind, uint32_t mask, const float background[4],
                          const char *what)
{
    OK(triptych_read_target_numbers(device, t, numbers[0], sizeof numbers));
    for (int p = 0; p < SIZE * SIZE; p++)
        for (int c = 0; c < 4; c++) {
            int from = source(kind, c);
            float value = mask >> from & 1 ? (float)channel(texel[p], from) / 255.0f : background[from];
            expect_number(t, p, c, kept(kind->bits[c], value), what);
        }
}

/* Compares the same values as bytes. */
static void expect_bytes(const char *what)
{
    OK(triptych_read_target(device, 0, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++) {
        uint32_t word = 0;
        for (int c = 0; c < 4; c++)
            word |= (uint32_t)rintf(saturated(numbers[p][c]) * 255) << 8 * c;
        expect_pixel(p % SIZE, p / SIZE, word, what);
    }
}

static void check_formats(void)
{
    static const float black[4];
    for (int i = 0; i < KINDS; i++) {
        char what[32];
        snprintf(what, sizeof what, "kind %d", i);
        open_target(&kinds[i]);
        bind_random_texture(SIZE, SIZE);
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
        expect_pixels(0, &kinds[i], 15, black, what);
        expect_bytes(what);
    }
}

static void test_formats_keep_their_bits(void)
{
    on_every_engine(check_formats);
}

static void check_clears(void)
{
    for (int i = 0; i < KINDS; i++) {
        float color[4];
        for (int c = 0; c < 4; c++)
            color[c] = (float)random_between(-0.5, 1.5);
        open_target(&kinds[i]);
        OK(triptych_clear(device, color, 1));
        OK(triptych_set_scissor(device, 5, 7, 30, 20));
        set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
        OK(triptych_clear(device, (const float[4]){0, 0, 0, 0}, 1));
        set(TRIPTYCH_STATE_SCISSORTESTENABLE, "false");
        OK(triptych_read_target_numbers(device, 0, numbers[0], sizeof numbers));
        for (int p = 0; p < SIZE * SIZE; p++) {
            int x = p % SIZE, y = p / SIZE, inside = x >= 5 && x < 35 && y >= 7 && y < 27;
            for (int c = 0; c < 4; c++)
                expect_number(0, p, c, kept(kinds[i].bits[c], inside ? 0 : color[source(&kinds[i], c)]),
                              "clear");
        }
    }
}

static void test_clears_are_converted_to_the_format(void)
{
    on_every_engine(check_clears);
}

/* Without alpha in the target the factor is 1, so the target gets the colour itself. */
static void check_missing_alpha(void)
{
    static const float black[4];
    set(TRIPTYCH_STATE_SRCBLEND, "destalpha");
    set(TRIPTYCH_STATE_DESTBLEND, "invdestalpha");
    for (int i = 0; i < KINDS; i++) {
        if (kinds[i].bits[3] != NONE)
            continue;
        open_target(&kinds[i]);
        bind_random_texture(SIZE, SIZE);
        set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
        set(TRIPTYCH_STATE_ALPHABLENDENABLE, "false");
        expect_pixels(0, &kinds[i], 15, black, "destination alpha");
    }
}

static void test_alpha_that_is_not_stored_is_one(void)
{
    on_every_engine(check_missing_alpha);
}

/* --- Several targets --- */

static void set_masks(const uint32_t mask[4])
{
    static const enum triptych_state state[4] = {
        TRIPTYCH_STATE_COLORWRITEENABLE, TRIPTYCH_STATE_COLORWRITEENABLE1, TRIPTYCH_STATE_COLORWRITEENABLE2,
        TRIPTYCH_STATE_COLORWRITEENABLE3};
    for (int t = 0; t < 4; t++)
        OK(triptych_set_state(device, state[t], mask[t]));
}

/* Random formats and masks; each target gets the colour through its own mask. */
static void check_targets(void)
{
    for (int round = 0; round < 40; round++) {
        const struct kind *kind[4];
        uint32_t mask[4];
        float color[4];
        for (int t = 0; t < 4; t++) {
            kind[t] = t && !(random_word() % 8) ? NULL : &kinds[random_word() % KINDS];
            mask[t] = random_word() % 4 ? random_word() % 16 : 0;
            color[t] = (float)random_between(0, 1);
        }
        open_targets(kind);
        bind_random_texture(SIZE, SIZE);
        set_masks(mask);
        OK(triptych_clear(device, color, 1));
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
        for (unsigned t = 0; t < 4 && kind[t]; t++)
            expect_pixels(t, kind[t], mask[t], color, "several targets");
    }
}

static void test_every_target_has_its_mask_and_format(void)
{
    on_every_engine(check_targets);
}

/* Every target is blended with its own contents. Two draws with a factor of one half give three quarters. */
static void check_blended_targets(void)
{
    const struct kind *kind[4] = {&kinds[0], &kinds[18], &kinds[12], NULL};
    open_targets(kind);
    OK(triptych_clear(device, (const float[4]){0, 0, 0, 0}, 1));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "blendfactor");
    set(TRIPTYCH_STATE_DESTBLEND, "invblendfactor");
    OK(triptych_set_state(device, TRIPTYCH_STATE_BLENDFACTOR, 0x33333333)); /* 0.2 */
    for (int i = 0; i < 2; i++)
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    for (unsigned t = 0; t < 3; t++) {
        float value = 0, fifth = 51.0f / 255.0f;
        for (int i = 0; i < 2; i++)
            value = kept(kind[t]->bits[0], fifth + value * (1 - fifth));
        OK(triptych_read_target_numbers(device, t, numbers[0], sizeof numbers));
        expect_number(t, 0, 0, value, "blended");
    }
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_read_target(device, 3, image, sizeof image));
}

static void test_every_target_is_blended_with_its_own(void)
{
    on_every_engine(check_blended_targets);
}

/* Each channel of the constant factor is another one: luminance is blended as red is. Colours are packed, or
 * binary32 if a second target needs that. */
static void check_blended_light(const struct kind *second)
{
    const struct kind light = {TRIPTYCH_SURFACE_A8L8, {8, 8, 8, 8}};
    open_targets((const struct kind *const[4]){&light, second, NULL, NULL});
    OK(triptych_clear(device, (const float[4]){0.4f, 0.8f, 1, 0}, 1));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "blendfactor");
    set(TRIPTYCH_STATE_DESTBLEND, "destcolor");
    OK(triptych_set_state(device, TRIPTYCH_STATE_BLENDFACTOR, 0xff0033ff)); /* red 0, green 0.2, blue 1 */
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "false");
    OK(triptych_read_target_numbers(device, 0, numbers[0], sizeof numbers));
    for (int p = 0; p < SIZE * SIZE; p++)
        for (int c = 0; c < 4; c++)
            expect_number(0, p, c, c < 3 ? 41.0f / 255 : 1, "blended luminance"); /* 0.4 * 0.4 */
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 6));           /* not red */
    draw_square(0, 0, NULL, 0, 0, 1, 1);
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 1));
    draw_square(0, 0x80204060, NULL, 0, 0, 0.5, 1);
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 15));
    OK(triptych_read_target_numbers(device, 0, numbers[0], sizeof numbers));
    for (int c = 0; c < 4; c++)
        expect_number(0, 0, c, c < 3 ? 32.0f / 255 : 1, "masked luminance");
}

static void check_light(void)
{
    check_blended_light(NULL);
    check_blended_light(&kinds[18]);
}

static void test_luminance_is_red(void)
{
    on_every_engine(check_light);
}

/* A clear of some channels: those of luminance are red's, also if another target has each by itself. */
static void check_masked_clear(void)
{
    const struct triptych_target_description description = {
        .width = SIZE,
        .height = SIZE,
        .color_format = {TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_L8, TRIPTYCH_SURFACE_A8}};
    struct triptych_clear_values values = {
        .flags = TRIPTYCH_CLEAR_COLOR, .color = {0.2f, 0.4f, 0.6f, 0.8f}, .color_mask = 15};
    const struct triptych_rectangle part = {3, 5, 20, 9};
    OK(triptych_set_target_description(device, &description));
    OK(triptych_clear_rectangles(device, &values, NULL, 0));
    for (int c = 0; c < 4; c++)
        values.color[c] = 1;
    for (unsigned mask = 1; mask < 16; mask += 4) { /* red, and others */
        values.color_mask = mask & 9;
        OK(triptych_clear_rectangles(device, &values, &part, 1));
    }
    const float expected[3][4] = {{1, 0.4f, 0.6f, 1}, {1, 1, 1, 1}, {0, 0, 0, 1}};
    for (unsigned t = 0; t < 3; t++) {
        OK(triptych_read_target_numbers(device, t, numbers[0], sizeof numbers));
        for (int c = 0; c < 4; c++)
            expect_number(t, 6 * SIZE + 4, c, expected[t][c], "cleared");
    }
}

static void test_clears_of_some_channels_clear_luminance_with_red(void)
{
    on_every_engine(check_masked_clear);
}

/* --- Dithering --- */

static int threshold(int x, int y)
{
    static const int bayer[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    return (255 * (2 * bayer[y % 4][x % 4] + 1) + 16) / 32;
}

static void check_dither(const struct kind *const kind[4])
{
    open_targets(kind);
    bind_random_texture(SIZE, SIZE);
    set(TRIPTYCH_STATE_DITHERENABLE, "true");
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_target_numbers(device, 0, numbers[0], sizeof numbers));
    for (int p = 0; p < SIZE * SIZE; p++)
        for (int c = 0; c < 3; c++) {
            int byte = (int)channel(texel[p], c), levels = (1 << kind[0]->bits[c]) - 1;
            int t = threshold(p % SIZE, p / SIZE), level = (byte * levels + t) / 255;
            if (kind[1])
                level = (int)fmaf((float)byte / 255.0f, (float)levels, (float)t / 255.0f);
            expect_number(0, p, c, rintf((float)level * 255 / (float)levels) / 255, "dithered");
        }
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_number(0, p, 3, kept(kind[0]->bits[3], (float)(texel[p] >> 24) / 255.0f), "alpha");
}

/* Checks packed colours, and binary32 colours, which the pipeline uses if a second target needs them. */
static void check_dithers(void)
{
    for (int i = 4; i < 9; i++) {
        check_dither((const struct kind *const[4]){&kinds[i], NULL, NULL, NULL});
        check_dither((const struct kind *const[4]){&kinds[i], &kinds[18], NULL, NULL});
    }
}

static void test_few_bits_are_dithered_by_place(void)
{
    on_every_engine(check_dithers);
}

/* A colour that is exactly a level becomes that level everywhere. */
static void check_dither_of_levels(void)
{
    open_target(&kinds[7]);
    set(TRIPTYCH_STATE_DITHERENABLE, "true");
    for (uint32_t level = 0; level < 16; level++) {
        draw_square(0, level * 0x11111111, NULL, 0, 0, 1, 1);
        OK(triptych_read_color(device, image, sizeof image));
        for (int p = 0; p < SIZE * SIZE; p++)
            expect_pixel(p % SIZE, p / SIZE, level * 0x11111111, "a level");
    }
}

static void test_levels_are_not_changed_by_dithering(void)
{
    on_every_engine(check_dither_of_levels);
}

/* --- Errors --- */

static void check_refusals(void)
{
    struct triptych_target_description compressed = {
        .width = 4, .height = 4, .color_format = {TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_DXT1}};
    struct triptych_target_description unknown = {
        .width = 4, .height = 4, .color_format = {(enum triptych_surface_format)12345}};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_UNSUPPORTED, triptych_set_target_description(device, &compressed));
    TEST_ASSERT_EQUAL_STRING("format DXT1 of colour target 1: expected one that can be a target",
                             triptych_error(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_target_description(device, &unknown));
    TEST_ASSERT_EQUAL_STRING("format 12345 of colour target 0: expected one of Direct3D 9's",
                             triptych_error(device));
    OK(triptych_read_color(device, image, sizeof image)); /* the target of before is there */
}

static void test_surfaces_that_cannot_be_targets_are_refused(void)
{
    on_every_engine(check_refusals);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_formats_keep_their_bits);
    RUN_TEST(test_clears_are_converted_to_the_format);
    RUN_TEST(test_alpha_that_is_not_stored_is_one);
    RUN_TEST(test_every_target_has_its_mask_and_format);
    RUN_TEST(test_every_target_is_blended_with_its_own);
    RUN_TEST(test_luminance_is_red);
    RUN_TEST(test_clears_of_some_channels_clear_luminance_with_red);
    RUN_TEST(test_few_bits_are_dithered_by_place);
    RUN_TEST(test_levels_are_not_changed_by_dithering);
    RUN_TEST(test_surfaces_that_cannot_be_targets_are_refused);
    return UNITY_END();
}
