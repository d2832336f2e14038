/* Sampling, compared with its definition (src/spec/texture/detail.h, sample.h) on every engine: levels of
 * detail, different filters for magnification and minification, anisotropy. */
#include "tests/support/picture/sampled.h"
#include "tests/support/system/seed.h"

#include <math.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static const struct sampled_coordinates equal = {{0.25, -0.5, 0.375}, {2, 0, 0}, {0, 2, 0}};
static const struct sampled_coordinates strong = {{0, 0, 0}, {37, -12, 20}, {9, 50, 3}};

static const struct sampled_coordinates *const scales[] = {&sampled_magnified, &equal, &sampled_minified,
                                                           &strong};

static void check_sized(const int size[3])
{
    enum { FILTERS = 4, SCALES = 4 };
    int largest = size[0] > size[1] ? size[0] : size[1];
    sampled_define(TRIPTYCH_TEXTURE_2D, size[0], size[1], 1, (int)log2(largest) + 1);
    for (unsigned i = 0; i < FILTERS * SCALES * (SAMPLED_MIP_BOTH + 1); i += test_stride_of(5)) {
        unsigned scale = i % SCALES, filters = i / SCALES % FILTERS;
        sampled.mip = (int)(i / SCALES / FILTERS);
        sampled.mag = filters & 1;
        sampled.min = filters >> 1;
        sampled.first = 0;
        sampled.bias = 0;
        sampled_check(scales[scale]);
        sampled.first = (int)scale % 3 + 1;
        sampled.bias = scale * 0.75 - 1;
        sampled_check(scales[scale]);
    }
}

static void check_levels(void)
{
    static const int sizes[][3] = {{32, 32, 1}, {20, 13, 1}, {64, 4, 1}};
    for (unsigned i = 0; i < sizeof sizes / sizeof *sizes; i++)
        check_sized(sizes[i]);
    sampled_expect_few_left_out(0.2);
}

static void test_levels_follow_the_size_of_texels(void)
{
    on_every_engine(check_levels);
}

/* Tests exact scales. Texels of the size of pixels are magnified, and twice as many texels a pixel are the
 * next level. */
static void check_exact_levels(void)
{
    sampled_define(TRIPTYCH_TEXTURE_2D, 64, 64, 1, 7);
    sampled.mag = SAMPLED_POINT;
    sampled.min = SAMPLED_LINEAR;
    sampled.mip = SAMPLED_MIP_BOTH;
    for (int level = -1; level < 8; level++) {
        double extent = ldexp(1, level);
        sampled_check(&(struct sampled_coordinates){{0, 0, 0}, {extent, 0, 0}, {0, extent / 2, 0}});
        sampled_check(&(struct sampled_coordinates){{0, 0, 0}, {0, extent / 4, 0}, {extent, 0, 0}});
    }
    sampled.first = 100; /* beyond the last level: that one */
    sampled_check(&sampled_minified);
    sampled.mip = SAMPLED_MIP_NEAREST;
    sampled.bias = 1e30;
    sampled.first = 0;
    sampled_show(&sampled_magnified);
    expect_pixel(SIZE / 2, SIZE / 2, sampled_word(0, 6, 0), "a bias beyond all levels");
    sampled_expect_few_left_out(0.3);
}

static void test_every_doubling_is_a_level(void)
{
    on_every_engine(check_exact_levels);
}

/* Scales around the limits, in quarters of a level. */
static void check_late_levels(void)
{
    sampled_define(TRIPTYCH_TEXTURE_2D, 64, 64, 1, 7);
    sampled.late = true;
    for (int filters = 0; filters < 4; filters++)
        for (int mip = SAMPLED_MIP_NO; mip <= SAMPLED_MIP_BOTH; mip++)
            for (int quarter = -1; quarter < 6; quarter++) {
                double extent = exp2(quarter / 4.0) + 0.01;
                sampled.mag = filters & 1 ? SAMPLED_LINEAR : SAMPLED_POINT;
                sampled.min = filters & 2 ? SAMPLED_LINEAR : SAMPLED_POINT;
                sampled.mip = mip;
                sampled_check(&(struct sampled_coordinates){{0, 0, 0}, {extent, 0, 0}, {0, extent / 2, 0}});
            }
    sampled_expect_few_left_out(0.3);
}

static void test_point_filters_of_levels_begin_beyond_half_a_level_if_the_convention_is_half(void)
{
    on_every_engine(check_late_levels);
}

/* The distances between taps are exact in binary for 1, 3 and 7 taps. */
static void check_anisotropy(void)
{
    enum { VIEWS = 6 };
    static const struct sampled_coordinates views[VIEWS] = {
        {{0, 0, 0}, {12, 0, 0}, {0, 4, 0}},           /* 3 taps */
        {{0.5, 0.25, 0}, {1, 7, 0}, {-1, 0, 0}},      /* 7 and a little more, limited */
        {{0.125, 0, 0}, {0, 2, 0}, {14, 0, 0}},       /* down, 7 taps */
        {{0.25, 0.25, 0}, {0.5, 0, 0}, {0, 0.25, 0}}, /* magnified */
        {{0.25, 0.25, 0}, {3, 0, 0}, {0, 3, 0}},      /* as long both ways: one tap */
        {{0.25, 0.25, 0}, {3, 0, 0}, {0, 0, 0}}};     /* without a shorter change: the largest number */
    static const int taps[] = {3, 7};
    sampled_define(TRIPTYCH_TEXTURE_2D, 32, 32, 1, 6);
    sampled.min = SAMPLED_ANISOTROPIC;
    for (unsigned i = 0; i < VIEWS * (SAMPLED_MIP_BOTH + 1) * 2; i += test_stride_of(5)) {
        sampled.mag = i % 2 ? SAMPLED_LINEAR : SAMPLED_POINT;
        sampled.mip = (int)(i / 2 / VIEWS);
        sampled.taps = taps[i % 2];
        sampled_check(&views[i / 2 % VIEWS]);
    }
    sampled.taps = 1; /* anisotropic with one tap is linear */
    sampled_check(&sampled_minified);
    sampled_expect_few_left_out(0.2);
}

static void test_anisotropy_is_the_mean_along_the_longer_change(void)
{
    on_every_engine(check_anisotropy);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_levels_follow_the_size_of_texels);
    RUN_TEST(test_every_doubling_is_a_level);
    RUN_TEST(test_point_filters_of_levels_begin_beyond_half_a_level_if_the_convention_is_half);
    RUN_TEST(test_anisotropy_is_the_mean_along_the_longer_change);
    return UNITY_END();
}
