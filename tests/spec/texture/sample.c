/* Sampling of volumes and cubes, compared with its definition (src/spec/texture/address.h, cube.h, sample.h)
 * on every engine. */
#include "tests/support/picture/sampled.h"
#include "tests/support/system/seed.h"

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static void check_volumes(void)
{
    static const int sizes[][3] = {{8, 8, 8}, {5, 6, 7}, {16, 2, 4}, {1, 1, 12}};
    for (unsigned i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        sampled_define(TRIPTYCH_TEXTURE_VOLUME, sizes[i][0], sizes[i][1], sizes[i][2], 1);
        for (unsigned n = i % test_stride_of(3); n < 2 * SAMPLED_ADDRESSINGS; n += test_stride_of(3)) {
            int mode = (int)n % SAMPLED_ADDRESSINGS, filter = n / SAMPLED_ADDRESSINGS;
            sampled.address[0] = sampled.address[1] = (mode + 1) % SAMPLED_ADDRESSINGS;
            sampled.address[2] = mode;
            sampled.mag = sampled.min = filter;
            sampled_check(&sampled_minified);
            sampled_check(&sampled_magnified);
        }
    }
    sampled_expect_few_left_out(0);
}

static void test_volumes_blend_eight_texels(void)
{
    on_every_engine(check_volumes);
}

static void check_cubes(void)
{
    enum { VIEWS = 7 };
    static const struct sampled_coordinates views[VIEWS] = {
        {{1, 0, 0}, {0, 0.25, 1.5}, {0, 2, 0}},      {{-1, 0.125, 0}, {0, 0, 1}, {0, 1.5, 0.25}},
        {{0, 1, 0}, {3, 0, 0}, {0, 0, 3}},           {{0, -1, 0}, {1, 0.5, 0}, {0, 0, 5}},
        {{0.125, 0, 1}, {4, 0, 0}, {0, 4, 0.5}},     {{0, 0, -1}, {8, 0, 0}, {0, 8, 0}},
        {{0.0625, 0.03125, 0}, {1, 0, 2}, {2, 1, 0}}};
    for (int size = 4; size <= 32; size *= 8) {
        sampled_define(TRIPTYCH_TEXTURE_CUBE, size, size, 1, size == 4 ? 1 : 6);
        for (unsigned i = 0; i < VIEWS * 2 * (SAMPLED_MIP_BOTH + 1); i += test_stride_of(5)) {
            sampled.mag = sampled.min = i / VIEWS % 2;
            sampled.mip = (int)(i / VIEWS / 2);
            sampled.address[0] = sampled.address[1] = SAMPLED_BORDER; /* which cubes do not have */
            sampled_check(&views[i % VIEWS]);
        }
    }
    sampled_expect_few_left_out(0.25);
}

static void test_cubes_return_texels_of_the_vectors_face(void)
{
    on_every_engine(check_cubes);
}

/* Each axis of a face by itself. */
static void check_addressed_cubes(void)
{
    static const struct sampled_coordinates views[] = {{{1, 0, 0}, {0, 0.25, 2.5}, {0, 3, 0}},
                                                       {{0.125, 0, 1}, {4, 0, 0}, {0, 4, 0.5}},
                                                       {{0, 0, -1}, {8, 0, 0}, {0, 8, 0}}};
    for (int size = 4; size <= 12; size += 8)
        for (int mode = 0; mode < SAMPLED_ADDRESSINGS; mode++) {
            sampled_define(TRIPTYCH_TEXTURE_CUBE, size, size, 1, size == 4 ? 3 : 1);
            sampled.wrapped = true;
            sampled.address[0] = mode;
            sampled.address[1] = (mode + 1) % SAMPLED_ADDRESSINGS;
            for (int filter = SAMPLED_POINT; filter <= SAMPLED_LINEAR; filter++)
                for (unsigned i = 0; i < sizeof views / sizeof *views; i++) {
                    sampled.mag = sampled.min = filter;
                    sampled.mip = size == 4 ? SAMPLED_MIP_BOTH : SAMPLED_MIP_NO;
                    sampled_check(&views[i]);
                }
        }
    sampled_expect_few_left_out(0.25);
}

static void test_faces_of_cubes_are_addressed_if_the_convention_is_the_samplers(void)
{
    on_every_engine(check_addressed_cubes);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_volumes_blend_eight_texels);
    RUN_TEST(test_cubes_return_texels_of_the_vectors_face);
    RUN_TEST(test_faces_of_cubes_are_addressed_if_the_convention_is_the_samplers);
    return UNITY_END();
}
