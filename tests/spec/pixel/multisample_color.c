/* Colours of samples, on every engine: the centroids that they are computed at, blending of each sample, and
 * averages. */
#include "tests/spec/pixel/samples.h"

#include <math.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

/* Red increases from 0 to 255 across the triangle. All samples of a pixel have the colour of its centroid. */
static void check_centroids(void)
{
    for (unsigned which = 0; which < PATTERNS; which++)
        for (int centres = 0; centres < 2; centres++) {
            struct corner t[3] = {
                {5, 9, 0, 0xff000000}, {EXTENT - 3, 300, 1, 0xffff0000}, {200, EXTENT - 7, 0, 0xff000000}};
            use_samples(which);
            set(TRIPTYCH_STATE_MULTISAMPLEANTIALIAS, centres ? "false" : "true");
            draw_triangle(t);
            read_all();
            for (int p = 0; p < SIZE * SIZE; p++) {
                unsigned first = samples(), covered = 0;
                for (unsigned i = samples(); i-- > 0;)
                    if (covers_sample(t, i, p)) {
                        first = i;
                        covered++;
                    }
                if (centres ? !covers_centre(t, p) : !covered)
                    continue;
                int at[2] = {p % SIZE * UNIT + UNIT / 2, p / SIZE * UNIT + UNIT / 2};
                if (covered < samples() && !centres)
                    sample_place(first, p, at);
                double red = plane_at(t, at[0], at[1]) * 255;
                for (unsigned i = 0; i < samples(); i++)
                    if (centres || covers_sample(t, i, p)) {
                        TEST_ASSERT_TRUE(fabs(red - channel(color[i][p], 0)) <= 0.5001);
                        TEST_ASSERT_EQUAL_HEX32(0xff000000, color[i][p] & 0xffffff00);
                    }
            }
        }
}

static void test_colours_are_the_centroids(void)
{
    on_every_engine(check_centroids);
}

static unsigned rounded(unsigned product)
{
    return (unsigned)floor(product / 255.0 + 0.5);
}

/* Draws overlapping triangles that are blended additively and by alpha. Alpha below 64 is discarded. */
static void check_blending(void)
{
    for (unsigned which = 0; which < PATTERNS; which++) {
        static uint32_t expected[SAMPLES][SIZE * SIZE];
        use_samples(which);
        memset(expected, 0, sizeof expected);
        set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
        set(TRIPTYCH_STATE_SRCBLEND, "srcalpha");
        set(TRIPTYCH_STATE_DESTBLEND, "one");
        set(TRIPTYCH_STATE_ALPHATESTENABLE, "true");
        set(TRIPTYCH_STATE_ALPHAFUNC, "greaterequal");
        OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAREF, 64));
        for (int round = 0; round < 12; round++) {
            struct corner t[3];
            random_triangle(t);
            draw_triangle(t);
            uint32_t word = image_word(t[0].color), alpha = channel(word, 3);
            for (unsigned i = 0; i < samples() && alpha >= 64; i++)
                for (int p = 0; p < SIZE * SIZE; p++) {
                    uint32_t new = 0;
                    for (int c = 0; c < 4; c++) {
                        unsigned sum = rounded(channel(word, c) * alpha) + channel(expected[i][p], c);
                        new |= (sum > 255 ? 255 : sum) << 8 * c;
                    }
                    expected[i][p] = covers_sample(t, i, p) ? new : expected[i][p];
                }
        }
        read_all();
        OK(triptych_read_color(device, image, sizeof image));
        for (int p = 0; p < SIZE * SIZE; p++) {
            uint32_t average = 0;
            for (unsigned i = 0; i < samples(); i++)
                expect_color(i, p, expected[i][p], "blending");
            for (int c = 0; c < 4; c++) {
                unsigned sum = samples() / 2;
                for (unsigned i = 0; i < samples(); i++)
                    sum += channel(expected[i][p], c);
                average |= sum / samples() << 8 * c;
            }
            expect_pixel(p % SIZE, p / SIZE, average, "the average");
        }
    }
}

static void test_samples_are_blended_separately_and_averaged(void)
{
    on_every_engine(check_blending);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_colours_are_the_centroids);
    RUN_TEST(test_samples_are_blended_separately_and_averaged);
    return UNITY_END();
}
