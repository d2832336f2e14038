/* Logic operations on the bits of targets, on every engine. The expected bits are those of the truth table,
 * bit by bit. */
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

/* In the order of the table of OpenGL ES 1.1.12, section 4.1.9. The number of a row is its truth table: bit 0
 * is the result of 1 and 1, bit 1 of a new 1 and a stored 0, bit 2 of a new 0 and a stored 1, bit 3 of 0 and
 * 0. */
static const char *const operations[] = {
    "clear", "and",   "andreverse", "copy",      "andinverted",  "noop",       "xor",  "or",
    "nor",   "equiv", "invert",     "orreverse", "copyinverted", "orinverted", "nand", "set",
};
enum { OPERATIONS = sizeof operations / sizeof *operations };

static unsigned truth(unsigned operation, unsigned s, unsigned d, unsigned bits)
{
    unsigned result = 0;
    for (unsigned i = 0; i < bits; i++) {
        unsigned place = 3 - (2 * (s >> i & 1) + (d >> i & 1));
        result |= (operation >> place & 1) << i;
    }
    return result;
}

struct kind {
    enum triptych_surface_format format;
    unsigned bits[4]; /* red to alpha; 0: not stored */
};

static const struct kind kinds[] = {
    {TRIPTYCH_SURFACE_A8R8G8B8, {8, 8, 8, 8}},         {TRIPTYCH_SURFACE_X8R8G8B8, {8, 8, 8, 0}},
    {TRIPTYCH_SURFACE_R5G6B5, {5, 6, 5, 0}},           {TRIPTYCH_SURFACE_A1R5G5B5, {5, 5, 5, 1}},
    {TRIPTYCH_SURFACE_A4R4G4B4, {4, 4, 4, 4}},         {TRIPTYCH_SURFACE_A2R10G10B10, {10, 10, 10, 2}},
    {TRIPTYCH_SURFACE_A16B16G16R16, {16, 16, 16, 16}},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static uint32_t new_texel[SIZE * SIZE], old_texel[SIZE * SIZE];
static float numbers[SIZE * SIZE][4];

static void open_targets(enum triptych_surface_format first, enum triptych_surface_format second)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {first, second}};
    OK(triptych_set_target_description(device, &description));
}

static void draw_random(uint32_t *words)
{
    bind_random_texture(SIZE, SIZE);
    memcpy(words, texel, sizeof texel);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
}

static unsigned code_of(uint32_t word, int c, unsigned bits)
{
    return (unsigned)rint(channel(word, c) * (double)((1u << bits) - 1) / 255);
}

static void fail_at(const struct kind *kind, unsigned operation, int p, int c, const unsigned codes[4])
{
    char what[160];
    snprintf(what, sizeof what,
             "%s, format %d, pixel %d, channel %d: new %#x, stored %#x: expected %#x, got %#x",
             operations[operation], (int)kind->format, p, c, codes[0], codes[1], codes[2], codes[3]);
    TEST_FAIL_MESSAGE(what);
}

static void expect_codes(const struct kind *kind, unsigned operation, uint32_t mask)
{
    OK(triptych_read_target_numbers(device, 0, numbers[0], sizeof numbers));
    for (int p = 0; p < SIZE * SIZE; p++)
        for (int c = 0; c < 4; c++) {
            unsigned bits = kind->bits[c];
            if (!bits)
                continue;
            unsigned s = code_of(new_texel[p], c, bits), d = code_of(old_texel[p], c, bits);
            unsigned expected = mask >> c & 1 ? truth(operation, s, d, bits) : d;
            unsigned got = (unsigned)rint((double)numbers[p][c] * ((1u << bits) - 1));
            if (got != expected)
                fail_at(kind, operation, p, c, (unsigned[]){s, d, expected, got});
        }
}

/* Blending is enabled, but has no effect. */
static void draw_operation(unsigned operation, uint32_t mask)
{
    set(TRIPTYCH_STATE_LOGICOP, "none");
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "false");
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 15));
    draw_random(old_texel);
    set(TRIPTYCH_STATE_LOGICOP, operations[operation]);
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "zero");
    set(TRIPTYCH_STATE_DESTBLEND, "srcalpha");
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, mask));
    draw_random(new_texel);
}

static void check_kind(const struct kind *kind, enum triptych_surface_format second)
{
    open_targets(kind->format, second);
    for (unsigned i = 0; i < OPERATIONS; i++) {
        draw_operation(i, 15);
        expect_codes(kind, i, 15);
    }
}

static void check_formats(void)
{
    for (int i = 0; i < KINDS; i++)
        check_kind(&kinds[i], (enum triptych_surface_format)0);
}

static void test_each_bit_follows_the_truth_table(void)
{
    on_every_engine(check_formats);
}

/* With a second target of floating point, colours are binary32. That target takes the new colour, even if the
 * operation keeps the first one. */
static void check_binary32(void)
{
    for (int i = 0; i < KINDS; i += 2) {
        check_kind(&kinds[i], TRIPTYCH_SURFACE_A32B32G32R32F);
        OK(triptych_read_target_numbers(device, 1, numbers[0], sizeof numbers));
        for (int p = 0; p < SIZE * SIZE; p++)
            for (int c = 0; c < 4; c++)
                TEST_ASSERT_TRUE(numbers[p][c] == (float)channel(new_texel[p], c) / 255.0f);
    }
}

static void test_floating_point_takes_the_new_colour(void)
{
    on_every_engine(check_binary32);
}

static void check_masks(void)
{
    for (int i = 0; i < KINDS; i += 2)
        for (uint32_t mask = 0; mask < 16; mask += 5) {
            unsigned operation = random_word() % OPERATIONS;
            open_targets(kinds[i].format, (enum triptych_surface_format)0);
            draw_operation(operation, mask);
            expect_codes(&kinds[i], operation, mask);
        }
}

static void test_channels_that_are_not_written_keep_their_bits(void)
{
    on_every_engine(check_masks);
}

/* Encoded colours have no operation, and their alpha has none either, also where it is the only channel. The
 * new channels are 0 and 255, which are their own encodings. */
static void check_srgb(void)
{
    open_targets(TRIPTYCH_SURFACE_A8R8G8B8, (enum triptych_surface_format)0);
    for (unsigned i = 0; i < OPERATIONS; i++)
        for (uint32_t mask = 1; mask < 16; mask += 7) { /* red, alpha, all */
            set(TRIPTYCH_STATE_LOGICOP, "none");
            OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 15));
            clear_to(0x12345678);
            set(TRIPTYCH_STATE_SRGBWRITEENABLE, "true");
            set(TRIPTYCH_STATE_LOGICOP, operations[i]);
            OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, mask));
            draw_square(0, 0xffff00ff, NULL, 0, 0, 1, 1);
            OK(triptych_read_color(device, image, sizeof image));
            uint32_t expected = mask == 1 ? 0x123456ff : mask == 8 ? 0xff345678 : 0xffff00ff;
            for (int p = 0; p < SIZE * SIZE; p++)
                expect_pixel(p % SIZE, p / SIZE, expected, operations[i]);
        }
}

static void test_srgb_takes_the_new_colour(void)
{
    on_every_engine(check_srgb);
}

/* Every sample has its own bits: the right half differs in the stored colour before samples are averaged. */
static void check_samples(void)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .samples = 4, .color_format = {TRIPTYCH_SURFACE_A8R8G8B8}};
    OK(triptych_set_target_description(device, &description));
    set(TRIPTYCH_STATE_LOGICOP, "none");
    clear_to(0);
    set(TRIPTYCH_STATE_LOGICOP, "xor");
    OK(triptych_set_state(device, TRIPTYCH_STATE_MULTISAMPLEMASK, 3));
    draw_square(0, 0xff0000ff, NULL, 0, 0, 1, 1); /* samples 0 and 1 */
    OK(triptych_set_state(device, TRIPTYCH_STATE_MULTISAMPLEMASK, 6));
    draw_square(0, 0xff0000ff, NULL, 0, 0, 1, 1); /* 1 is 0 again, 2 is set */
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, 0x80800000, "two of four samples");
}

static void test_samples_have_bits_of_their_own(void)
{
    on_every_engine(check_samples);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_bit_follows_the_truth_table);
    RUN_TEST(test_floating_point_takes_the_new_colour);
    RUN_TEST(test_channels_that_are_not_written_keep_their_bits);
    RUN_TEST(test_srgb_takes_the_new_colour);
    RUN_TEST(test_samples_have_bits_of_their_own);
    return UNITY_END();
}
