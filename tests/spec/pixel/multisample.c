/* Multisampling, on every engine: the coverage, depth and stencil of every sample, compared with exact
 * arithmetic, and masks and counts of queries. */
#include "tests/spec/pixel/samples.h"

#include <limits.h>
#include <math.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

/* --- What is covered ----------------------------------------------------------------------------------- */

/* Each triangle increments the stencil of the samples that it covers. */
static void check_coverage(void)
{
    for (unsigned which = 0; which < PATTERNS; which++) {
        static uint32_t expected[SAMPLES][SIZE * SIZE];
        static uint8_t count[SAMPLES][SIZE * SIZE];
        uint64_t passed = 0, result;
        triptych_query *query;
        use_samples(which);
        memset(expected, 0, sizeof expected);
        memset(count, 0, sizeof count);
        set(TRIPTYCH_STATE_STENCILENABLE, "true");
        set(TRIPTYCH_STATE_STENCILPASS, "incr");
        OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
        OK(triptych_query_begin(device, query));
        for (int round = 0; round < 40; round++) {
            struct corner t[3];
            random_triangle(t);
            draw_triangle(t);
            for (unsigned i = 0; i < samples(); i++)
                for (int p = 0; p < SIZE * SIZE; p++)
                    if (covers_sample(t, i, p)) {
                        expected[i][p] = image_word(t[0].color);
                        count[i][p]++;
                        passed++;
                    }
        }
        OK(triptych_query_end(device, query));
        read_all();
        for (unsigned i = 0; i < samples(); i++) {
            for (int p = 0; p < SIZE * SIZE; p++)
                expect_color(i, p, expected[i][p], "coverage");
            TEST_ASSERT_EQUAL_UINT8_ARRAY(count[i], stencil[i], SIZE * SIZE);
        }
        OK(triptych_query_result(device, query, &result));
        TEST_ASSERT_EQUAL_UINT64(passed, result);
        set(TRIPTYCH_STATE_STENCILENABLE, "false");
    }
}

static void test_every_sample_has_its_own_coverage(void)
{
    on_every_engine(check_coverage);
}

/* Each sample on the diagonal of a square belongs to one of the square's two triangles. */
static void check_shared_edges(void)
{
    struct corner a = {0, 0, 0, 0x01010101}, b = {EXTENT, 0, 0, 0x01010101}, c = {0, EXTENT, 0, 0x01010101},
                  d = {EXTENT, EXTENT, 0, 0x01010101};
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "one");
    set(TRIPTYCH_STATE_DESTBLEND, "one");
    for (unsigned which = 0; which < PATTERNS; which++) {
        use_samples(which);
        for (int round = 0; round < 4; round++) {
            struct corner middle = random_corner(0);
            middle.z = 0;
            middle.color = 0x01010101;
            draw_triangle((const struct corner[3]){a, b, middle});
            draw_triangle((const struct corner[3]){b, d, middle});
            draw_triangle((const struct corner[3]){d, c, middle});
            draw_triangle((const struct corner[3]){c, a, middle});
        }
        read_all();
        for (unsigned i = 0; i < samples(); i++)
            for (int p = 0; p < SIZE * SIZE; p++)
                expect_color(i, p, 0x04040404, "fans");
    }
}

static void test_each_sample_belongs_to_one_of_two_triangles(void)
{
    on_every_engine(check_shared_edges);
}

/* --- Masks --------------------------------------------------------------------------------------------- */

static void check_masks(void)
{
    for (unsigned round = 0; round < 24; round++) {
        struct corner t[3];
        uint32_t mask = round < 4 ? 0 : random_word();
        int centres = (int)(round & 1);
        use_samples(round % PATTERNS);
        OK(triptych_set_state(device, TRIPTYCH_STATE_MULTISAMPLEMASK, mask));
        set(TRIPTYCH_STATE_MULTISAMPLEANTIALIAS, centres ? "false" : "true");
        random_triangle(t);
        draw_triangle(t);
        read_all();
        for (unsigned i = 0; i < samples(); i++)
            for (int p = 0; p < SIZE * SIZE; p++) {
                int covered = (mask >> i & 1) && (centres ? covers_centre(t, p) : covers_sample(t, i, p));
                expect_color(i, p, covered ? image_word(t[0].color) : 0, centres ? "centres" : "mask");
            }
    }
}

static void test_masks_exclude_samples(void)
{
    on_every_engine(check_masks);
}

/* Of four samples, 0.375 is the limit of two: (2 * 1 + 1) / 8. */
static void check_sample_coverage(void)
{
    static const struct {
        float coverage;
        uint32_t two, four, eight;
    } cases[] = {{1, 3, 15, 255},  {0, 0, 0, 0},       {0.375f, 1, 3, 7},   {0.3749f, 1, 1, 7},
                 {0.5f, 1, 3, 15}, {0.75f, 3, 7, 63},  {0.99f, 3, 15, 255}, {7, 3, 15, 255},
                 {-1, 0, 0, 0},    {0.0625f, 0, 0, 1}, {0.0624f, 0, 0, 0}};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++)
        for (unsigned round = 0; round < 6; round++) {
            struct corner t[3];
            use_samples(round % PATTERNS);
            uint32_t expected = samples() == 2   ? cases[i].two
                                : samples() == 4 ? cases[i].four
                                                 : cases[i].eight;
            uint32_t mask = round & 1 ? 0x55 : 0xff;
            OK(triptych_set_state(device, TRIPTYCH_STATE_MULTISAMPLEMASK, mask));
            OK(triptych_set_state(device, TRIPTYCH_STATE_SAMPLECOVERAGE,
                                  triptych_float_bits(cases[i].coverage)));
            set(TRIPTYCH_STATE_SAMPLECOVERAGEINVERT, round > 2 ? "true" : "false");
            expected = (round > 2 ? ~expected : expected) & mask;
            random_triangle(t);
            draw_triangle(t);
            read_all();
            for (unsigned s = 0; s < samples(); s++)
                for (int p = 0; p < SIZE * SIZE; p += 3)
                    expect_color(s, p,
                                 expected >> s & 1 && covers_sample(t, s, p) ? image_word(t[0].color) : 0,
                                 "sample coverage");
        }
}

static void test_sample_coverage_keeps_the_first_samples_or_the_others(void)
{
    on_every_engine(check_sample_coverage);
}

/* --- Depth --------------------------------------------------------------------------------------------- */

static void check_depths(void)
{
    for (unsigned which = 0; which < PATTERNS; which++)
        for (int centres = 0; centres < 2; centres++) {
            struct corner t[3] = {
                {-200, -300, 0, 0xffffffff}, {3000, 100, 1, 0xffffffff}, {300, 3000, 0.5f, 0xffffffff}};
            use_samples(which);
            set(TRIPTYCH_STATE_ZENABLE, "true");
            set(TRIPTYCH_STATE_ZFUNC, "less");
            set(TRIPTYCH_STATE_MULTISAMPLEANTIALIAS, centres ? "false" : "true");
            OK(triptych_clear_buffers(device, TRIPTYCH_CLEAR_DEPTH | TRIPTYCH_CLEAR_COLOR,
                                      (const float[4]){0, 0, 0, 0}, 0.25f, 0));
            draw_triangle(t);
            read_all();
            for (unsigned i = 0; i < samples(); i++)
                for (int p = 0; p < SIZE * SIZE; p++) {
                    int at[2];
                    sample_place(i, p, at);
                    if (centres) {
                        at[0] = p % SIZE * UNIT + UNIT / 2;
                        at[1] = p / SIZE * UNIT + UNIT / 2;
                    }
                    double z = plane_at(t, at[0], at[1]);
                    int covered = covers(t, at[0], at[1]);
                    if (fabs(z - 0.25) < 0x1p-20)
                        continue;
                    TEST_ASSERT_FLOAT_WITHIN(0x1p-22f, covered && z < 0.25 ? z : 0.25, depth[i][p]);
                    expect_color(i, p, covered && z < 0.25 ? 0xffffffff : 0, "depth");
                }
            set(TRIPTYCH_STATE_ZENABLE, "false");
        }
}

static void test_depth_is_each_samples_own(void)
{
    on_every_engine(check_depths);
}

/* --- Alpha to coverage --------------------------------------------------------------------------------- */

/* Alpha to coverage: of n samples the first round(alpha * n / 255) remain, in colour and in stencil. */
static void check_alpha_to_coverage(void)
{
    struct corner t[3] = {{0, 0, 0, 0}, {2 * EXTENT, 0, 0, 0}, {0, 2 * EXTENT, 0, 0}};
    for (unsigned which = 0; which < PATTERNS; which++)
        for (unsigned alpha = 0; alpha < 256; alpha += (which == 2 ? 1 : 3) * test_stride_of(5)) {
            use_samples(which);
            set(TRIPTYCH_STATE_STENCILENABLE, "true");
            set(TRIPTYCH_STATE_STENCILPASS, "incr");
            set(TRIPTYCH_STATE_ADAPTIVETESS_Y, "atoc");
            set(TRIPTYCH_STATE_ALPHATESTENABLE, alpha & 1 ? "true" : "false");
            for (int i = 0; i < 3; i++)
                t[i].color = alpha << 24 | 0x123456;
            draw_triangle(t);
            read_all();
            unsigned all = samples(), remain = alpha & 1 ? (2 * alpha * all + 255) / 510 : all;
            for (unsigned i = 0; i < all; i++) {
                expect_color(i, 5, i < remain ? image_word(t[0].color) : 0, "alpha to coverage");
                TEST_ASSERT_EQUAL_UINT8(i < remain, stencil[i][5]);
            }
        }
}

static void test_alpha_decides_how_many_samples_remain(void)
{
    on_every_engine(check_alpha_to_coverage);
}

/* The alpha test discards all samples; a target with one sample per pixel has no such coverage. */
static void check_alpha_to_coverage_with_tests(void)
{
    struct corner t[3] = {
        {0, 0, 0, 0x80ffffff}, {2 * EXTENT, 0, 0, 0x80ffffff}, {0, 2 * EXTENT, 0, 0x80ffffff}};
    set(TRIPTYCH_STATE_ADAPTIVETESS_Y, "atoc");
    set(TRIPTYCH_STATE_ALPHATESTENABLE, "true");
    set(TRIPTYCH_STATE_ALPHAFUNC, "greater");
    for (unsigned reference = 127; reference < 129; reference++) {
        use_samples(1);
        OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAREF, reference));
        draw_triangle(t);
        read_all();
        for (unsigned i = 0; i < samples(); i++)
            expect_color(i, 5, i < 2 && reference < 128 ? image_word(t[0].color) : 0, "the alpha test");
    }
    OK(triptych_set_target_description(device,
                                       &(struct triptych_target_description){.width = SIZE, .height = SIZE}));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAREF, 0));
    draw_triangle(t);
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(5, 0, image_word(t[0].color), "one sample");
}

static void test_the_alpha_test_precedes_coverage(void)
{
    on_every_engine(check_alpha_to_coverage_with_tests);
}

/* --- Refusals ------------------------------------------------------------------------------------------ */

static void check_refusals(void)
{
    struct triptych_target_description description = {.width = 4, .height = 4, .samples = 3};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_target_description(device, &description));
    TEST_ASSERT_EQUAL_STRING("3 samples per pixel: expected 1, 2, 4 or 8", triptych_error(device));
    description.samples = 4;
    description.color_format[1] = TRIPTYCH_SURFACE_A8R8G8B8;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_target_description(device, &description));
    TEST_ASSERT_EQUAL_STRING("colour target 1: expected only one with several samples per pixel",
                             triptych_error(device));
    use_samples(0);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_read_sample(device, 2, color[0], sizeof color[0], NULL, 0, NULL, 0));
    TEST_ASSERT_EQUAL_STRING("sample 2: the target has 2 per pixel", triptych_error(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_read_sample(device, UINT_MAX, color[0],
                                                                      sizeof color[0], NULL, 0, NULL, 0));
    OK(triptych_set_target_description(
        device, &(struct triptych_target_description){
                    .width = 1, .height = 1, .samples = 2, .depth_format = TRIPTYCH_DEPTH_D16}));
    depth[0][0] = 7;
    TEST_ASSERT_EQUAL_INT(
        TRIPTYCH_BAD_CALL,
        triptych_read_sample(device, 0, NULL, 0, depth[0], sizeof depth[0], stencil[0], sizeof stencil[0]));
    TEST_ASSERT_EQUAL_STRING("the target's depth format is d16: expected one with stencil",
                             triptych_error(device));
    TEST_ASSERT_EQUAL_FLOAT(7, depth[0][0]);
}

static void test_invalid_numbers_of_samples_and_formats_are_refused(void)
{
    on_every_engine(check_refusals);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_sample_has_its_own_coverage);
    RUN_TEST(test_masks_exclude_samples);
    RUN_TEST(test_sample_coverage_keeps_the_first_samples_or_the_others);
    RUN_TEST(test_depth_is_each_samples_own);
    RUN_TEST(test_alpha_decides_how_many_samples_remain);
    RUN_TEST(test_the_alpha_test_precedes_coverage);
    RUN_TEST(test_each_sample_belongs_to_one_of_two_triangles);
    RUN_TEST(test_invalid_numbers_of_samples_and_formats_are_refused);
    return UNITY_END();
}
