/* Copies of rectangles of pixels at any scale, compared with pixels that the test finds one by one. */
#include "tests/render/target/pixels.h"
#include "tests/support/blit/blits.h"

#include <math.h>

void setUp(void)
{
    error_clear(&reason);
}

void tearDown(void)
{
    drop(&pixels);
    drop(&other);
}

static void copy_all(struct pixels_copy *copy)
{
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(&copy->to, &reason));
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, pixels_acquire_copy(copy, &emulated_blits, &reason), reason.text);
    for (uint32_t i = 0; i < pixels_parts(&copy->target); i++)
        pixels_copy_part(copy, i);
    blit_release(&emulated_blits, copy->blend);
}

/* The nearest pixel of the source, by the definition. */
static void expect_points(const struct pixels_copy *copy)
{
    for (uint32_t y = 0; y < copy->target.height; y++)
        for (uint32_t x = 0; x < copy->target.width; x++) {
            uint32_t u = (uint32_t)floor((x + 0.5) * copy->source.width / copy->target.width);
            uint32_t v = (uint32_t)floor((y + 0.5) * copy->source.height / copy->target.height);
            for (uint32_t p = 0; p < pixels_words(&copy->to); p++)
                TEST_ASSERT_EQUAL_HEX32(*word_at(&copy->from, copy->source.x + u, copy->source.y + v, 0, p),
                                        *word_at(&copy->to, copy->target.x + x, copy->target.y + y, 0, p));
        }
}

enum { SENTINEL = 0x3e800000 };

static void fill_with_sentinels(const struct pixels *p)
{
    const struct triptych_rectangle whole = {0, 0, WIDTH, HEIGHT};
    const uint32_t words[4] = {SENTINEL, SENTINEL, SENTINEL, SENTINEL};
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(p, &reason));
    for (uint32_t i = 0; i < pixels_parts(&whole); i++) {
        struct triptych_rectangle part = pixels_part(&whole, i);
        pixels_fill(p, &part, words);
    }
}

/* Pixels outside of the copy are still those of the fill. */
static void expect_untouched(const struct pixels_copy *copy)
{
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            uint32_t row[4];
            pixels_read_row(&copy->to, x, y, 1, row);
            if (x - copy->target.x >= copy->target.width || y - copy->target.y >= copy->target.height)
                TEST_ASSERT_EQUAL_HEX32(SENTINEL, row[0]);
        }
}

static void test_points_are_copied_at_any_place_and_scale(void)
{
    for (int n = 0; n < 120; n++) {
        struct pixels_copy copy = {.source = {random_word() % 64, random_word() % 30, 0, 0},
                                   .target = {random_word() % 64, random_word() % 30, 0, 0}};
        make_color(&pixels, drawn[n % 4], 1);
        if (n % 3)
            make_color(&other, drawn[n % 4], 1);
        else
            make_texels(&other, drawn[n % 4]);
        fill_random(&pixels);
        fill_with_sentinels(&other);
        copy.from = pixels;
        copy.to = other;
        copy.source.width = 1 + random_word() % (WIDTH - copy.source.x);
        copy.source.height = 1 + random_word() % (HEIGHT - copy.source.y);
        copy.target.width = 1 + random_word() % (WIDTH - copy.target.x);
        copy.target.height = 1 + random_word() % (HEIGHT - copy.target.y);
        if (n % 5 == 0) {
            copy.target.width = copy.source.width = 64;
            copy.target.height = copy.source.height = 33;
            copy.linear = n % 2; /* the same size */
        }
        copy_all(&copy);
        expect_points(&copy);
        expect_untouched(&copy);
    }
}

static double clamped(double low, double most)
{
    return fmin(fmax(low, 0), most);
}

/* One channel of a blend of four texels of a float format. */
static double blended(const struct pixels_copy *copy, uint32_t x, uint32_t y, uint32_t p)
{
    double u = (x + 0.5) * copy->source.width / copy->target.width - 0.5;
    double v = (y + 0.5) * copy->source.height / copy->target.height - 0.5;
    double sum = 0;
    for (int n = 0; n < 4; n++) {
        uint32_t s = (uint32_t)clamped(floor(u) + n % 2, copy->source.width - 1);
        uint32_t t = (uint32_t)clamped(floor(v) + n / 2, copy->source.height - 1);
        float number;
        memcpy(&number, word_at(&copy->from, copy->source.x + s, copy->source.y + t, 0, p), sizeof number);
        sum += (double)number * (n % 2 ? u - floor(u) : 1 - (u - floor(u))) *
               (n / 2 ? v - floor(v) : 1 - (v - floor(v)));
    }
    return sum;
}

static void test_linear_copies_blend_the_four_pixels_around(void)
{
    for (int n = 0; n < 20; n++) {
        struct pixels_copy copy = {.source = {random_word() % 64, random_word() % 30, 0, 0},
                                   .target = {random_word() % 64, random_word() % 30, 0, 0},
                                   .linear = true};
        make_color(&pixels, TRIPTYCH_SURFACE_A32B32G32R32F, 1);
        make_color(&other, TRIPTYCH_SURFACE_A32B32G32R32F, 1);
        fill_random(&pixels);
        copy.from = pixels;
        copy.to = other;
        copy.source.width = 1 + random_word() % (WIDTH - copy.source.x);
        copy.source.height = 1 + random_word() % (HEIGHT - copy.source.y);
        copy.target.width = 1 + random_word() % (WIDTH - copy.target.x);
        copy.target.height = 1 + random_word() % (HEIGHT - copy.target.y);
        copy_all(&copy);
        for (uint32_t y = 0; y < copy.target.height; y++)
            for (uint32_t x = 0; x < copy.target.width; x++)
                for (uint32_t p = 0; p < 4; p++) {
                    float number;
                    memcpy(&number, word_at(&other, copy.target.x + x, copy.target.y + y, 0, p),
                           sizeof number);
                    TEST_ASSERT_TRUE(fabs(number - blended(&copy, x, y, p)) < 1e-6);
                }
    }
}

/* 4000 pixels to 7: the source of neighbours is too long to be read together. */
static void test_long_rows_shrink_to_a_few_pixels(void)
{
    enum { LONG = 4000 };
    static uint32_t row[LONG + 1];
    for (uint32_t i = 0; i < LONG; i++)
        row[i] = i;
    make_color(&other, TRIPTYCH_SURFACE_A8R8G8B8, 1);
    for (int linear = 0; linear < 2; linear++) {
        struct pixels_copy copy = {.from = {.format = other.format,
                                            .width = LONG,
                                            .height = 1,
                                            .image = {(uint8_t *)row, LONG + 1, 4, false, false, false}},
                                   .to = other,
                                   .source = {0, 0, LONG, 1},
                                   .target = {60, 1, 7, 1},
                                   .linear = linear};
        copy_all(&copy);
        for (uint32_t x = 0; x < 7; x++) {
            double place = (x + 0.5) * LONG / 7;
            uint32_t found = *word_at(&other, 60 + x, 1, 0, 0);
            if (!linear)
                TEST_ASSERT_EQUAL_UINT((uint32_t)place, found);
            else
                TEST_ASSERT_TRUE((found & 0xff00) == ((uint32_t)(place - 0.5) & 0xff00));
        }
    }
}

static void test_depth_and_stencil_are_copied(void)
{
    make_depth(&pixels, TRIPTYCH_DEPTH_D24S8);
    make_depth(&other, TRIPTYCH_DEPTH_D24S8);
    fill_random(&pixels);
    struct pixels_copy copy = {
        .from = pixels, .to = other, .source = {3, 5, 90, 40}, .target = {7, 9, 90, 40}};
    copy_all(&copy);
    expect_points(&copy);
}

/* Whole tiles: words, and a clear that is only remembered. Depth keeps its bounds. */
static void test_whole_tiles_are_copied_with_their_clears(void)
{
    const uint32_t word = 0x12345678;
    make_color(&pixels, TRIPTYCH_SURFACE_G16R16, 1);
    make_color(&other, TRIPTYCH_SURFACE_G16R16, 1);
    fill_random(&pixels);
    fill_random(&other);
    struct pixels_copy copy = {
        .from = pixels, .to = other, .source = {0, 0, 64, 70}, .target = {64, 0, 64, 70}, .linear = true};
    copy_all(&copy);
    expect_points(&copy);
    pixels_fill(&pixels, &(struct triptych_rectangle){0, 0, 64, 64}, (uint32_t[]){1, 2, 3, 4});
    copy_all(&copy);
    TEST_ASSERT_TRUE(other.tiles->color_clear[1].pending);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(((uint32_t[]){1, 2, 3, 4}), other.tiles->color_clear[1].word, 4);
    make_depth(&pixels, TRIPTYCH_DEPTH_D24S8);
    make_depth(&other, TRIPTYCH_DEPTH_D24S8);
    fill_random(&pixels);
    pixels_fill(&pixels, &(struct triptych_rectangle){64, 0, 64, 64}, &word);
    copy = (struct pixels_copy){
        .from = pixels, .to = other, .source = {0, 0, 128, 64}, .target = {0, 0, 128, 64}};
    copy_all(&copy);
    TEST_ASSERT_TRUE(other.tiles->depth_clear[1].pending);
    TEST_ASSERT_EQUAL_HEX32(word, other.tiles->depth_clear[1].word);
    TEST_ASSERT_EQUAL_HEX32(0x12345600, other.tiles->depth_clear[1].range.most);
    TEST_ASSERT_EQUAL_HEX32(0, other.tiles->depth_clear[0].range.least);
    copy.source.width = copy.target.width = 64;
    expect_points(&copy);
}

/* Every test for both orders of words in memory. */
int main(void)
{
    UNITY_BEGIN();
    for (int order = 0; order < 2; order++) {
        quad_rows = order;
        RUN_TEST(test_points_are_copied_at_any_place_and_scale);
        RUN_TEST(test_linear_copies_blend_the_four_pixels_around);
        RUN_TEST(test_long_rows_shrink_to_a_few_pixels);
        RUN_TEST(test_depth_and_stencil_are_copied);
        RUN_TEST(test_whole_tiles_are_copied_with_their_clears);
    }
    return UNITY_END();
}
