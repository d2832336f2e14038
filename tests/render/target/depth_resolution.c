/* The smallest difference of distance that a depth buffer distinguishes, by the format and by what is stored:
 * z of a perspective projection, w, or 1/z, for planes at 1 and 1000.
 *
 *   z      far / (far - near) * (1 - near / distance): the usual projection
 *   w      (distance - near) / (far - near): the state zenable usew
 *   1/z    near / distance: a projection without a far plane, whose near plane has depth 1, and the state
 *          zfunc greater */
#include "machine/mxcsr.h"
#include "render/target/depth.h"

#include <math.h>
#include <unity.h>

static const double NEAR = 1, FAR = 1000;

static unsigned saved;

void setUp(void)
{
    saved = mxcsr_enter();
}

void tearDown(void)
{
    mxcsr_leave(saved);
}

typedef double stored(double distance);

static double z(double distance)
{
    return FAR / (FAR - NEAR) * (1 - NEAR / distance);
}

static double w(double distance)
{
    return (distance - NEAR) / (FAR - NEAR);
}

static double inverse(double distance)
{
    return NEAR / distance;
}

/* The different words of 1024 distances from one on. */
static int count_words(enum triptych_depth_format format, stored *what, double distance, double range)
{
    uint32_t last = depth_encode(format, (float)what(distance));
    int words = 0;
    for (int i = 1; i <= 1024; i++) {
        uint32_t word = depth_encode(format, (float)what(distance + range * i / 1024));
        words += word != last;
        last = word;
    }
    return words;
}

static double resolution(enum triptych_depth_format format, stored *what, double distance)
{
    double range = distance * 0x1p-30;
    int words;
    while ((words = count_words(format, what, distance, range)) < 64)
        range *= 2;
    return range / words;
}

/* Within a fifth of the expected one: binary32 values have gaps of different sizes. */
static void expect(double expected, enum triptych_depth_format format, stored *what, double distance)
{
    double found = resolution(format, what, distance);
    TEST_ASSERT_TRUE_MESSAGE(found > expected / 1.2 && found < expected * 1.2, depth_formats[format].name);
}

/* The derivative of z is far / (far - near) * near / distance^2. */
static void z_as_an_integer_loses_with_the_square_of_the_distance(void)
{
    static const double distances[] = {1.5, 10, 100, 500};
    for (int i = 0; i < 4; i++) {
        double d = distances[i], slope = FAR / (FAR - NEAR) * NEAR / (d * d);
        expect(1 / slope / 0xffffff, TRIPTYCH_DEPTH_D24X8, z, d);
        if (d * d < 1e4)
            expect(1 / slope / 0xffff, TRIPTYCH_DEPTH_D16, z, d);
    }
}

/* Depths from 1/2 to 1 have 24 bits in binary32 too: a float does not help z. */
static void z_as_a_float_is_not_better_in_the_distance(void)
{
    double integer = resolution(TRIPTYCH_DEPTH_D24X8, z, 500);
    double number = resolution(TRIPTYCH_DEPTH_D32F_LOCKABLE, z, 500);
    TEST_ASSERT_TRUE(number > integer / 1.3 && number < integer * 1.3);
}

static void w_distinguishes_the_same_difference_everywhere(void)
{
    static const double distances[] = {1.5, 10, 100, 300};
    for (int i = 0; i < 4; i++) {
        expect((FAR - NEAR) / 0xffffff, TRIPTYCH_DEPTH_D24X8, w, distances[i]);
        expect((FAR - NEAR) / 0xffff, TRIPTYCH_DEPTH_D16, w, distances[i]);
    }
}

/* As an integer, near / distance has the derivative of z: the order of the values does not matter. */
static void the_inverse_as_an_integer_is_not_better_than_z(void)
{
    for (double d = 2; d < 600; d *= 3) {
        double ratio = resolution(TRIPTYCH_DEPTH_D24X8, inverse, d) / resolution(TRIPTYCH_DEPTH_D24X8, z, d);
        TEST_ASSERT_TRUE(ratio > 0.8 && ratio < 1.25);
    }
}

/* A float's error is relative to its value, and so is that of the distance: 2^-24 to 2^-23 of it, or 2^-21 to
 * 2^-20 in 24 bits. */
static void the_inverse_as_a_float_is_as_precise_as_the_distance(void)
{
    for (double d = 1.5; d < 900; d *= 2.1) {
        double number = resolution(TRIPTYCH_DEPTH_D32F_LOCKABLE, inverse, d) / d;
        double narrow = resolution(TRIPTYCH_DEPTH_D24FS8, inverse, d) / d;
        TEST_ASSERT_TRUE(number > 0x1p-24 / 1.1 && number < 0x1p-23 * 1.1);
        TEST_ASSERT_TRUE(narrow > 0x1p-21 / 1.1 && narrow < 0x1p-20 * 1.1);
    }
}

/* At half of the far plane. */
static void the_inverse_as_a_float_is_the_most_precise_of_the_three_and_z_the_least(void)
{
    double of_z = resolution(TRIPTYCH_DEPTH_D24X8, z, 500), of_w = resolution(TRIPTYCH_DEPTH_D24X8, w, 500);
    double of_inverse = resolution(TRIPTYCH_DEPTH_D32F_LOCKABLE, inverse, 500);
    TEST_ASSERT_TRUE(of_z > 100 * of_w && of_inverse < of_w);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(z_as_an_integer_loses_with_the_square_of_the_distance);
    RUN_TEST(z_as_a_float_is_not_better_in_the_distance);
    RUN_TEST(w_distinguishes_the_same_difference_everywhere);
    RUN_TEST(the_inverse_as_an_integer_is_not_better_than_z);
    RUN_TEST(the_inverse_as_a_float_is_as_precise_as_the_distance);
    RUN_TEST(the_inverse_as_a_float_is_the_most_precise_of_the_three_and_z_the_least);
    return UNITY_END();
}
