/* Depth in each format, on every engine: the stored values, comparisons, and the depth of a w-buffer,
 * compared with arithmetic of more precision. */
#include "tests/support/picture/canvas.h"

#include <math.h>
#include <string.h>

static float depth[SIZE * SIZE];

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static void use_format(enum triptych_depth_format format)
{
    struct triptych_target_description description = {.width = SIZE, .height = SIZE, .depth_format = format};
    OK(triptych_set_target_description(device, &description));
    set(TRIPTYCH_STATE_ZENABLE, "true");
    OK(triptych_clear(device, (const float[4]){0, 0, 0, 0}, 1));
}

/* Returns the code of a depth: its integer, or the ordinal number of its floating-point value. */
static double code_of(enum triptych_depth_format format, float z)
{
    int exponent;
    if (format == TRIPTYCH_DEPTH_D24FS8) {
        frexp((double)z, &exponent); /* z = m * 2^exponent, m from 1/2 */
        double unit = ldexp(1, exponent < -13 ? -34 : exponent - 21);
        return nearbyint((double)z / unit) * unit;
    }
    if (format == TRIPTYCH_DEPTH_D32)
        return nearbyint((double)z * 0x1p32) - ((double)z > 0.5);
    return nearbyint(
        (double)(z * (ldexpf(1, (int)triptych_depth_bits(format)) - 1))); /* the product in binary32 */
}

static double value_of(enum triptych_depth_format format, float z)
{
    if (format == TRIPTYCH_DEPTH_D32F_LOCKABLE)
        return (double)z;
    double code = code_of(format, z);
    return format == TRIPTYCH_DEPTH_D24FS8 ? code : code / (ldexp(1, (int)triptych_depth_bits(format)) - 1);
}

static float random_depth(void)
{
    switch (random_word() % 8) {
    case 0: return (float)(random_word() & 1);
    case 1: return ldexpf((float)(random_word() >> 8), -24 - (int)(random_word() % 24));
    default: return (float)(random_word() >> 8) * 0x1p-24f;
    }
}

static void select_column(unsigned x)
{
    OK(triptych_set_scissor(device, x, 0, 1, SIZE));
}

static void check_format(enum triptych_depth_format format)
{
    static const struct {
        const char *word;
        int orders; /* 1 less, 2 equal, 4 greater */
    } functions[] = {{"less", 1},    {"equal", 2},    {"lessequal", 3},
                     {"greater", 4}, {"notequal", 5}, {"greaterequal", 6}};
    float first[SIZE], second[SIZE];
    use_format(format);
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
    for (unsigned x = 0; x < SIZE; x++) {
        int64_t steps = (int64_t)(random_word() % 5) - 2;
        first[x] = random_depth();
        second[x] = (float)fmin(
            1, fmax(0, (double)first[x] + (double)steps * ldexp(0.7, -(int)(14 + random_word() % 12))));
        select_column(x);
        set(TRIPTYCH_STATE_ZFUNC, "always");
        draw_square(first[x], 0, NULL, 0, 0, 1, 1);
    }
    OK(triptych_read_depth(device, depth, sizeof depth));
    for (unsigned x = 0; x < SIZE; x++)
        for (unsigned y = 0; y < SIZE; y++)
            TEST_ASSERT_EQUAL_FLOAT_MESSAGE((float)value_of(format, first[x]), depth[y * SIZE + x],
                                            triptych_depth_format_name(format));
    for (unsigned x = 0; x < SIZE; x++) {
        select_column(x);
        set(TRIPTYCH_STATE_ZFUNC, functions[x % 6].word);
        draw_square(second[x], 0xffffffff, NULL, 0, 0, 1, 1);
    }
    OK(triptych_read_depth(device, depth, sizeof depth));
    OK(triptych_read_color(device, image, sizeof image));
    for (unsigned x = 0; x < SIZE; x++) {
        double a = value_of(format, second[x]), b = value_of(format, first[x]);
        int passes = functions[x % 6].orders & (a < b ? 1 : a == b ? 2 : 4);
        expect_pixel((int)x, 7, passes ? 0xffffffff : 0, triptych_depth_format_name(format));
        TEST_ASSERT_EQUAL_FLOAT((float)(passes ? a : b), depth[x]);
    }
}

static void check_formats(void)
{
    for (int i = 0; i < TRIPTYCH_DEPTH_COUNT; i++)
        for (int round = 0; round < 4; round++)
            if (triptych_depth_bits((enum triptych_depth_format)i))
                check_format((enum triptych_depth_format)i);
}

static void test_depth_is_stored_and_compared_with_the_formats_precision(void)
{
    on_every_engine(check_formats);
}

/* Without a depth surface all pixels pass, and no depth is written. */
static void check_no_depth(void)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .depth_format = TRIPTYCH_DEPTH_NONE};
    OK(triptych_set_target_description(device, &description));
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "never");
    draw_square(0.5f, 0xff123456, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, image_word(0xff123456), "no depth");
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_read_depth(device, depth, sizeof depth));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_clear(device, NULL, 1));
    OK(triptych_clear(device, (const float[4]){0, 0, 0, 0}, -1));
}

static void test_a_target_without_depth_has_no_depth_test(void)
{
    on_every_engine(check_no_depth);
}

/* The square is tilted away from the eye by 45 degrees. The test computes w of each pixel row from its
 * plane. */
enum { NEAR = 2, FAR = 10 };

static void check_w_buffer(void)
{
    static const enum triptych_depth_format formats[] = {TRIPTYCH_DEPTH_D32F_LOCKABLE, TRIPTYCH_DEPTH_D24S8,
                                                         TRIPTYCH_DEPTH_D16};
    const float q = (float)FAR / (FAR - NEAR);
    const float projection[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, q, 1}, {0, 0, -q * NEAR, 0}};
    const float lean[4][4] = {{20, 0, 0, 0}, {0, 20, 20, 0}, {0, 0, 1, 0}, {0, 0, 5, 1}};
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        use_format(formats[i]);
        set(TRIPTYCH_STATE_ZENABLE, "usew");
        set(TRIPTYCH_STATE_ZFUNC, "always");
        OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_PROJECTION, projection));
        OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_WORLD, lean));
        draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
        OK(triptych_read_depth(device, depth, sizeof depth));
        for (int y = 0; y < SIZE; y++) {
            double ndc = 1 - 2 * (y + 0.5) / SIZE; /* y / w = ndc on the plane w = 5 + y */
            double w = 5 / (1 - ndc);
            if (w < NEAR || w > FAR)
                continue;
            for (int x = 0; x < SIZE; x++)
                TEST_ASSERT_FLOAT_WITHIN(i == 2 ? 0x1p-15 : 0x1p-18, (w - NEAR) / (FAR - NEAR),
                                         depth[y * SIZE + x]);
        }
        OK(triptych_set_transform(
            device, TRIPTYCH_TRANSFORM_PROJECTION,
            (const float[4][4]){{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}));
    }
}

static void test_a_w_buffer_is_linear_between_near_and_far(void)
{
    on_every_engine(check_w_buffer);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_depth_is_stored_and_compared_with_the_formats_precision);
    RUN_TEST(test_a_target_without_depth_has_no_depth_test);
    RUN_TEST(test_a_w_buffer_is_linear_between_near_and_far);
    return UNITY_END();
}
