/* Blending by the second colour of a shader, oC1, on every engine: all pairs of factors in bytes, and in
 * binary32. Expected values are computed here from the definition. */
#include "tests/support/picture/canvas.h"
#include "tests/support/picture/drawn.h"
#include "tests/support/system/seed.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { SECOND_COLOR = 16, INVERSE_SECOND_COLOR, SECOND_ALPHA = 20, INVERSE_SECOND_ALPHA };
enum { ADD = 1, SUBTRACT, REVSUBTRACT, OPERATIONS = 3 };

static const char two_colors[] =
    "ps_2_0\ndcl t0.xy\ndcl_2d s0\ndcl_2d s1\ntexld r0, t0, s0\ntexld r1, t0, s1\n"
    "mov oC0, r0\nmov oC1, r1\n";
static const char one_color[] = "ps_2_0\ndcl t0.xy\ndcl_2d s0\ntexld r0, t0, s0\nmov oC0, r0\n";

static uint32_t stored[SIZE * SIZE], second[SIZE * SIZE];

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static triptych_texture *make_texture(uint32_t *words)
{
    triptych_texture *texture;
    for (int p = 0; p < SIZE * SIZE; p++)
        words[p] = random_word();
    OK(triptych_texture_create(device, words, SIZE, SIZE, &texture));
    return texture;
}

static triptych_texture *textures[3]; /* the stored colours, the first and the second */

static void begin(enum triptych_surface_format format)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {format}};
    OK(triptych_set_target_description(device, &description));
    textures[0] = make_texture(stored);
    textures[1] = make_texture(texel);
    textures[2] = make_texture(second);
}

static void draw_blended(const char *shader, uint32_t operation, uint32_t source, uint32_t target)
{
    use_shaders(NULL, one_color);
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "false");
    OK(triptych_set_texture(device, 0, textures[0]));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    use_shaders(NULL, shader);
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    OK(triptych_set_texture(device, 0, textures[1]));
    OK(triptych_set_texture(device, 1, textures[2]));
    OK(triptych_set_state(device, TRIPTYCH_STATE_BLENDOP, operation));
    OK(triptych_set_state(device, TRIPTYCH_STATE_SRCBLEND, source));
    OK(triptych_set_state(device, TRIPTYCH_STATE_DESTBLEND, target));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
}

/* --- Bytes --- */

static unsigned factor(uint32_t number, uint32_t s, uint32_t t, uint32_t d, int c)
{
    switch (number) {
    case 1: return 0;
    case 2: return 255;
    case 3: return channel(s, c);
    case 5: return s >> 24;
    case 9: return channel(d, c);
    case SECOND_COLOR: return channel(t, c);
    case INVERSE_SECOND_COLOR: return 255 - channel(t, c);
    case SECOND_ALPHA: return t >> 24;
    default: return 255 - (t >> 24);
    }
}

enum { FACTORS = 9 };
static const uint8_t factors[FACTORS] = {
    1, 2, 3, 5, 9, SECOND_COLOR, INVERSE_SECOND_COLOR, SECOND_ALPHA, INVERSE_SECOND_ALPHA};

static unsigned rounded(unsigned sum)
{
    return (2 * sum + 255) / 510;
}

/* The products of f and 1 - f are rounded together. */
static unsigned blended(uint32_t operation, uint32_t source, uint32_t target, uint32_t s, uint32_t t,
                        uint32_t d, int c)
{
    unsigned x = channel(s, c) * factor(source, s, t, d, c), y = channel(d, c) * factor(target, s, t, d, c);
    unsigned new = rounded(x), old = rounded(y);
    bool pair = source >= SECOND_COLOR && (source ^ 1) == target;
    if (operation == ADD)
        return pair ? rounded(x + y) : new + old > 255 ? 255 : new + old;
    if (operation == REVSUBTRACT)
        return old > new ? old - new : 0;
    return new > old ? new - old : 0;
}

/* `t` has the second colours. */
static void expect_bytes(uint32_t operation, uint32_t source, uint32_t target, const uint32_t *t)
{
    char what[64];
    snprintf(what, sizeof what, "operation %u of %u and %u", (unsigned)operation, (unsigned)source,
             (unsigned)target);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        uint32_t word = 0;
        for (int c = 0; c < 4; c++)
            word |= blended(operation, source, target, texel[p], t[p], stored[p], c) << 8 * c;
        expect_pixel(p % SIZE, p / SIZE, word, what);
    }
}

static void check_bytes(void)
{
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    for (unsigned i = 0; i < OPERATIONS * FACTORS * FACTORS; i += test_stride_of(2)) {
        uint32_t operation = 1 + i / (FACTORS * FACTORS), source = factors[i / FACTORS % FACTORS];
        draw_blended(two_colors, operation, source, factors[i % FACTORS]);
        expect_bytes(operation, source, factors[i % FACTORS], second);
    }
}

static void test_the_second_colour_is_a_factor(void)
{
    on_every_engine(check_bytes);
}

static void check_missing(void)
{
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    draw_blended(one_color, ADD, SECOND_COLOR, 2);
    expect_bytes(ADD, SECOND_COLOR, 2, texel);
    draw_blended(one_color, ADD, SECOND_ALPHA, INVERSE_SECOND_ALPHA);
    expect_bytes(ADD, SECOND_ALPHA, INVERSE_SECOND_ALPHA, texel);
}

static void test_without_a_second_colour_the_first_is_the_factor(void)
{
    on_every_engine(check_missing);
}

/* --- Binary32 --- */

static float numbers[SIZE * SIZE][4];

static float fraction(uint32_t word, int c)
{
    return (float)channel(word, c) / 255.0f;
}

static void check_numbers(void)
{
    begin(TRIPTYCH_SURFACE_A32B32G32R32F);
    draw_blended(two_colors, ADD, SECOND_ALPHA, INVERSE_SECOND_COLOR);
    OK(triptych_read_target_numbers(device, 0, numbers[0], sizeof numbers));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride())
        for (int c = 0; c < 4; c++) {
            float new = fraction(texel[p], c) * fraction(second[p], 3);
            float old = fraction(stored[p], c) * (1 - fraction(second[p], c));
            TEST_ASSERT_EQUAL_FLOAT(new + old, numbers[p][c]);
            TEST_ASSERT_TRUE(new + old == numbers[p][c]);
        }
}

static void test_the_second_colour_is_a_factor_in_binary32(void)
{
    on_every_engine(check_numbers);
}

/* --- Targets --- */

static void check_targets(void)
{
    struct triptych_target_description description = {
        .width = SIZE,
        .height = SIZE,
        .color_format = {TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_A8R8G8B8}};
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    OK(triptych_set_target_description(device, &description));
    clear_to(0x11223344);
    use_shaders(NULL, two_colors);
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    OK(triptych_set_texture(device, 0, textures[1]));
    OK(triptych_set_texture(device, 1, textures[2]));
    for (int by_second = 1; by_second >= 0; by_second--) {
        set(TRIPTYCH_STATE_SRCBLEND, by_second ? "srccolor2" : "one");
        set(TRIPTYCH_STATE_DESTBLEND, "zero");
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
        OK(triptych_read_target(device, 1, image, sizeof image));
        for (int p = 0; p < SIZE * SIZE; p += pixel_stride())
            expect_pixel(p % SIZE, p / SIZE, by_second ? 0x11223344 : second[p], "the second target");
    }
}

static void test_the_second_target_keeps_its_colours_while_its_colour_is_a_factor(void)
{
    on_every_engine(check_targets);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_second_colour_is_a_factor);
    RUN_TEST(test_without_a_second_colour_the_first_is_the_factor);
    RUN_TEST(test_the_second_colour_is_a_factor_in_binary32);
    RUN_TEST(test_the_second_target_keeps_its_colours_while_its_colour_is_a_factor);
    return UNITY_END();
}
