/* Colours in binary32, on every engine: stages, specular, alpha test, fog and blending with floating-point
 * targets, and the precision of targets of more than 8 bits. Expected values are computed here with the
 * operations of the definitions. */
#include "base/half.h"
#include "tests/support/picture/canvas.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static float numbers[SIZE * SIZE][4], stored[SIZE * SIZE][4];
static uint32_t under[SIZE * SIZE];

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static void open_target(enum triptych_surface_format format)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {format}};
    OK(triptych_set_target_description(device, &description));
}

static void read_numbers(void)
{
    OK(triptych_read_target_numbers(device, 0, numbers[0], sizeof numbers));
}

static void expect_number(int p, int c, float expected, const char *what)
{
    char message[160];
    float got = numbers[p][c];
    if (!memcmp(&got, &expected, sizeof got) || (got == 0 && expected == 0))
        return;
    snprintf(message, sizeof message, "%s: pixel %d, channel %d: expected %a, got %a", what, p, c,
             (double)expected, (double)got);
    TEST_FAIL_MESSAGE(message);
}

static float saturated(float value)
{
    return value > 0 ? value < 1 ? value : 1 : 0;
}

static float fraction(uint32_t word, int c)
{
    return (float)channel(word, c) / 255.0f;
}

/* --- Stages -------------------------------------------------------------------------------------------- */

static uint32_t factor; /* an image's word */

/* Argument 1 is the texture, argument 2 the factor, and argument 0 the complement of the factor. */
static float operate(const char *word, const float a[4], const float b[4], int c)
{
    float x = a[c], y = b[c], z = 1 - b[c];
    if (!strcmp(word, "modulate"))
        return x * y;
    if (!strcmp(word, "modulate2x"))
        return x * y * 2;
    if (!strcmp(word, "modulate4x"))
        return x * y * 4;
    if (!strcmp(word, "add"))
        return x + y;
    if (!strcmp(word, "addsigned"))
        return x + y - 0.5f;
    if (!strcmp(word, "addsigned2x"))
        return (x + y - 0.5f) * 2;
    if (!strcmp(word, "subtract"))
        return x - y;
    if (!strcmp(word, "addsmooth"))
        return fmaf(1 - x, y, x);
    if (!strcmp(word, "blendfactoralpha"))
        return fmaf(y, 1 - b[3], x * b[3]);
    if (!strcmp(word, "blendtexturealphapm"))
        return fmaf(1 - a[3], y, x);
    if (!strcmp(word, "multiplyadd"))
        return fmaf(x, y, z);
    if (!strcmp(word, "lerp"))
        return fmaf(y, 1 - z, x * z);
    float sum = 0; /* dotproduct3 */
    for (int i = 0; i < 3; i++)
        sum = fmaf(a[i] - 0.5f, b[i] - 0.5f, sum);
    return sum * 4;
}

static void expect_operation(const char *word)
{
    read_numbers();
    float b[4];
    for (int c = 0; c < 4; c++)
        b[c] = fraction(factor, c);
    int joint = !strcmp(word, "dotproduct3");
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        float a[4];
        for (int c = 0; c < 4; c++)
            a[c] = fraction(texel[p], c);
        for (int c = 0; c < 3; c++)
            expect_number(p, c, saturated(operate(word, a, b, c)), word);
        expect_number(p, 3, joint ? saturated(operate(word, a, b, 3)) : a[3], word);
    }
}

static void check_operations(void)
{
    static const char *const words[] = {
        "modulate",    "modulate2x",       "modulate4x",         "add",  "addsigned",
        "addsigned2x", "subtract",         "addsmooth",          "lerp", "multiplyadd",
        "dotproduct3", "blendfactoralpha", "blendtexturealphapm"};
    open_target(TRIPTYCH_SURFACE_A32B32G32R32F);
    bind_random_texture(SIZE, SIZE);
    set_stage(0, TRIPTYCH_STAGE_COLORARG1, "texture");
    set_stage(0, TRIPTYCH_STAGE_COLORARG2, "tfactor");
    set_stage(0, TRIPTYCH_STAGE_COLORARG0, "tfactor_complement");
    for (unsigned i = 0; i < sizeof words / sizeof *words; i++) {
        uint32_t packed = random_word();
        factor = image_word(packed);
        OK(triptych_set_state(device, TRIPTYCH_STATE_TEXTUREFACTOR, packed));
        set_stage(0, TRIPTYCH_STAGE_COLOROP, words[i]);
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
        expect_operation(words[i]);
    }
}

static void test_stages_are_not_rounded(void)
{
    on_every_engine(check_operations);
}

/* Specular is added after the stages, and the sum is at most 1. Alpha does not change. */
static void check_specular(void)
{
    static const float specular[4][4] = {{0.25f, 0.5f, 0.125f, 1},
                                         {0.25f, 0.5f, 0.125f, 1},
                                         {0.25f, 0.5f, 0.125f, 1},
                                         {0.25f, 0.5f, 0.125f, 1}};
    struct triptych_element element = {TRIPTYCH_FORMAT_FLOAT4, NULL, 0, sizeof *specular};
    open_target(TRIPTYCH_SURFACE_A16B16G16R16F);
    bind_random_texture(SIZE, SIZE);
    OK(triptych_buffer_create(device, specular, sizeof specular, &element.buffer));
    OK(triptych_set_element(device, TRIPTYCH_SPECULAR, &element));
    set(TRIPTYCH_STATE_SPECULARENABLE, "true");
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    read_numbers();
    for (int p = 0; p < SIZE * SIZE; p++)
        for (int c = 0; c < 4; c++) {
            float color = fraction(texel[p], c), sum = c < 3 ? saturated(color + specular[0][c]) : color;
            expect_number(p, c, half_to_float(float_to_half(sum)), "specular");
        }
}

static void test_specular_is_added_after_the_stages(void)
{
    on_every_engine(check_specular);
}

/* --- Alpha test, fog ----------------------------------------------------------------------------------- */

/* The same pixels pass as with packed colours, because alpha is a byte of the texture. */
static void check_alpha_test(void)
{
    open_target(TRIPTYCH_SURFACE_A32B32G32R32F);
    bind_random_texture(SIZE, SIZE);
    set(TRIPTYCH_STATE_ALPHATESTENABLE, "true");
    for (uint32_t function = 1; function <= 8; function++) {
        uint32_t reference = texel[random_word() % (SIZE * SIZE)] >> 24;
        OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAFUNC, function));
        OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAREF, reference));
        OK(triptych_clear(device, (const float[4]){-7, -7, -7, -7}, 1));
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
        read_numbers();
        for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
            uint32_t alpha = texel[p] >> 24;
            int order = alpha < reference ? 1 : alpha == reference ? 2 : 4, passes = (function - 1) & order;
            expect_number(p, 0, passes ? fraction(texel[p], 0) : -7, "alpha test");
        }
    }
}

static void test_alpha_is_tested_as_a_byte(void)
{
    on_every_engine(check_alpha_test);
}

/* Without perspective, the fog distance is the depth, and its quarters are exact. */
static void check_fog(void)
{
    open_target(TRIPTYCH_SURFACE_A32B32G32R32F);
    bind_random_texture(SIZE, SIZE);
    uint32_t packed = random_word(), fog = image_word(packed);
    set(TRIPTYCH_STATE_FOGENABLE, "true");
    set(TRIPTYCH_STATE_FOGTABLEMODE, "linear");
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGCOLOR, packed));
    draw_square(0.25f, 0xffffffff, NULL, 0, 0, 1, 1);
    read_numbers();
    for (int p = 0; p < SIZE * SIZE; p++)
        for (int c = 0; c < 4; c++) {
            float color = fraction(texel[p], c);
            expect_number(p, c, c < 3 ? fmaf(fraction(fog, c), 0.25f, color * 0.75f) : color, "fog");
        }
}

static void test_fog_blends_colours_that_are_not_rounded(void)
{
    on_every_engine(check_fog);
}

/* --- Blending ------------------------------------------------------------------------------------------ */

enum { ADD = 1, SUBTRACT, REVSUBTRACT, MIN, MAX };

static uint32_t constant; /* an image's word */

static float blend_factor(uint32_t number, const float s[4], const float d[4], int c)
{
    switch (number) {
    case 1: return 0;
    case 2: return 1;
    case 3: return s[c];
    case 4: return 1 - s[c];
    case 5: return s[3];
    case 6: return 1 - s[3];
    case 7: return d[3];
    case 8: return 1 - d[3];
    case 9: return d[c];
    case 10: return 1 - d[c];
    case 11: return c == 3 ? 1 : s[3] < 1 - d[3] ? s[3] : 1 - d[3];
    case 14: return fraction(constant, c);
    case 18: return fraction(constant, 3);
    case 19: return 1 - fraction(constant, 3);
    default: return 1 - fraction(constant, c);
    }
}

static float blended(uint32_t operation, uint32_t source, uint32_t target, const float s[4], const float d[4],
                     int c)
{
    float new = s[c] * blend_factor(source, s, d, c), old = d[c] * blend_factor(target, s, d, c);
    switch (operation) {
    case ADD: return new + old;
    case SUBTRACT: return new - old;
    case REVSUBTRACT: return old - new;
    case MIN: return s[c] < d[c] ? s[c] : d[c];
    default: return s[c] > d[c] ? s[c] : d[c];
    }
}

/* Rounds a value to a channel's precision: binary32 if `bits` is 32, binary16 if it is -16, otherwise this
 * number of bits. */
static float kept(int bits, float value)
{
    if (bits == 32)
        return value;
    if (bits == -16)
        return half_to_float(float_to_half(value));
    float levels = (float)((1 << bits) - 1);
    return rintf(saturated(value) * levels) / levels;
}

/* Fills the target with values, draws a texture over them with a blending, and checks every pixel. */
static void expect_blended(const int bits[4], uint32_t operation, uint32_t source, uint32_t target)
{
    char what[64];
    snprintf(what, sizeof what, "operation %u of %u and %u", (unsigned)operation, (unsigned)source,
             (unsigned)target);
    read_numbers();
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        float s[4];
        for (int c = 0; c < 4; c++)
            s[c] = fraction(texel[p], c);
        for (int c = 0; c < 4; c++)
            expect_number(p, c, kept(bits[c], blended(operation, source, target, s, stored[p], c)), what);
    }
}

static triptych_texture *make_texture(uint32_t *words)
{
    triptych_texture *texture;
    for (int p = 0; p < SIZE * SIZE; p++)
        words[p] = random_word();
    OK(triptych_texture_create(device, words, SIZE, SIZE, &texture));
    return texture;
}

static void check_blending_of(enum triptych_surface_format format, const int bits[4])
{
    open_target(format);
    triptych_texture *first = make_texture(under), *second = make_texture(texel);
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
    for (unsigned i = 0; i < test_share_of(120, 8); i++) {
        static const uint8_t factors[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 14, 15, 18, 19};
        uint32_t operation = 1 + random_word() % 5, source = factors[random_word() % sizeof factors];
        uint32_t target = factors[random_word() % sizeof factors], packed = random_word();
        constant = image_word(packed);
        OK(triptych_set_texture(device, 0, first));
        set(TRIPTYCH_STATE_ALPHABLENDENABLE, "false");
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
        OK(triptych_read_target_numbers(device, 0, stored[0], sizeof stored));
        OK(triptych_set_texture(device, 0, second));
        set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
        OK(triptych_set_state(device, TRIPTYCH_STATE_BLENDFACTOR, packed));
        OK(triptych_set_state(device, TRIPTYCH_STATE_BLENDOP, operation));
        OK(triptych_set_state(device, TRIPTYCH_STATE_SRCBLEND, source));
        OK(triptych_set_state(device, TRIPTYCH_STATE_DESTBLEND, target));
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
        expect_blended(bits, operation, source, target);
    }
}

static void check_blending(void)
{
    check_blending_of(TRIPTYCH_SURFACE_A32B32G32R32F, (const int[4]){32, 32, 32, 32});
    check_blending_of(TRIPTYCH_SURFACE_A16B16G16R16F, (const int[4]){-16, -16, -16, -16});
    check_blending_of(TRIPTYCH_SURFACE_A16B16G16R16, (const int[4]){16, 16, 16, 16});
    check_blending_of(TRIPTYCH_SURFACE_A2R10G10B10, (const int[4]){10, 10, 10, 2});
}

static void test_blending_is_as_defined(void)
{
    on_every_engine(check_blending);
}

/* In floating-point targets, sums may be outside of 0 to 1. Beyond the range of binary16 they are
 * infinite. */
static void check_range(void)
{
    static const float start[4] = {60000, -3, 0.25f, 65504};
    open_target(TRIPTYCH_SURFACE_A16B16G16R16F);
    OK(triptych_clear(device, start, 1));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_DESTBLEND, "one");
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    read_numbers();
    for (int c = 0; c < 4; c++)
        expect_number(0, c, kept(-16, start[c] + 1), "one more");
    set(TRIPTYCH_STATE_SRCBLEND, "destcolor");
    OK(triptych_clear(device, (const float[4]){40000, 8, 8, 8}, 1));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    read_numbers();
    TEST_ASSERT_TRUE(isinf(numbers[0][0]));
    expect_number(0, 1, 16, "twice 8");
}

static void test_floating_point_is_not_clamped(void)
{
    on_every_engine(check_range);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_stages_are_not_rounded);
    RUN_TEST(test_specular_is_added_after_the_stages);
    RUN_TEST(test_alpha_is_tested_as_a_byte);
    RUN_TEST(test_fog_blends_colours_that_are_not_rounded);
    RUN_TEST(test_blending_is_as_defined);
    RUN_TEST(test_floating_point_is_not_clamped);
    return UNITY_END();
}
