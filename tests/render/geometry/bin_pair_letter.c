/* The halves of rectangles with coordinates of textures, such as letters, are joined if that gives all pixels
 * the same positions in the textures. */
#include "base/bits.h"
#include "ir/ir.h"
#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "render/raster/raster_part.h"
#include "tests/render/geometry/half.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <unity.h>

enum { LETTERS = 20000 };

/* A record with 1/w, a colour, and the coordinates of a texture. */
struct letter {
    struct triangle_head head;
    struct plane reciprocal_w;
    float color[4];
    struct plane coordinate[2];
};

static const struct pair_form letter_form = {.bytes = sizeof(struct letter),
                                             .smooth = 1,
                                             .diffuse = offsetof(struct letter, color),
                                             .lookups = 1,
                                             .lookup = {{offsetof(struct letter, coordinate), 3}}};

static struct job job;

void setUp(void)
{
    state = test_seed();
}

void tearDown(void)
{
}

static bool chance(int one_in)
{
    return !below(one_in);
}

/* An axis of the texture: its size in 1/256 texel, and how positions depend on pixels. */
struct ramp {
    float size;
    double start, step[2]; /* at the box's first corner; for each pixel to the right and down */
};

static struct ramp random_ramp(unsigned axis)
{
    static const float steps[] = {256, 256, 256, -256, 128, 3, 0, 512.4f};
    struct ramp ramp = {.size = (float)(256 << below(12))};
    double scaled = 0;
    if (chance(4))
        ramp.size = (float)(256 * (1 + below(300)));
    if (chance(3))
        scaled = 256.0 * (1 + below(40)) / (1 + below(60));
    ramp.start = below(1 << 19) - (chance(2) ? 1 << 18 : 0);
    ramp.step[axis] = scaled ? scaled : (double)steps[below(8)];
    if (chance(8))
        ramp.step[!axis] = (double)steps[below(8)];
    if (chance(2))
        ramp.start += (below(1000) - 500) * 0.001;
    if (chance(4))
        ramp.step[axis] += (below(1000) - 500) * 0.00002;
    return ramp;
}

static float with_error(double value)
{
    float r = (float)value;
    return chance(2) || r == 0 ? r : bits_to_float((int32_t)bits_of_float(r) + below(5) - 2);
}

/* The planes that setup would find, with an error of rounding in each word, and a small step where there is
 * none. */
static void set_coordinates(struct letter *letter, const struct rectangle *box, const struct ramp ramp[2])
{
    letter->head.origin_x = (float)letter->head.x[0] / PIXEL;
    letter->head.origin_y = (float)letter->head.y[0] / PIXEL;
    double x = (letter->head.x[0] - box->x0) / (double)PIXEL,
           y = (letter->head.y[0] - box->y0) / (double)PIXEL;
    for (int axis = 0; axis < 2; axis++) {
        const struct ramp *r = &ramp[axis];
        struct plane *plane = &letter->coordinate[axis];
        plane->value = with_error((r->start + x * r->step[0] + y * r->step[1]) / (double)r->size);
        plane->dx = with_error(r->step[0] / (double)r->size);
        plane->dy = with_error(r->step[1] / (double)r->size);
        if (chance(2) && plane->dx == 0)
            plane->dx = 0x1p-40f;
        if (chance(2) && plane->dy == 0)
            plane->dy = -0x1p-40f;
    }
}

static struct letter letter_without(const struct rectangle *box, int free_corner, const struct ramp ramp[2])
{
    struct letter letter = {.reciprocal_w = {1, 0, 0}, .color = {1, 0.5f, 0.25f, 1}};
    letter.head = half_without(box, free_corner).head;
    set_coordinates(&letter, box, ramp);
    return letter;
}

static int32_t bits_of_mad(float a, float b, float c)
{
    return (int32_t)ir_evaluate(IR_mad_f, bits_of_float(a), bits_of_float(b), bits_of_float(c), 0);
}

/* As spec/pixel/interpolate.h and spec/texture/address.h have it, where w is 1. */
static long position_of(const struct letter *letter, int axis, float size, int32_t column, int32_t row)
{
    const struct plane *plane = &letter->coordinate[axis];
    float x = (float)column + 0.5f - letter->head.origin_x, y = (float)row + 0.5f - letter->head.origin_y;
    float down = bits_to_float(bits_of_mad(y, plane->dy, plane->value));
    return lrintf(bits_to_float(bits_of_mad(x, plane->dx, down)) * size);
}

/* The pixels at which the two letters have other positions. */
static unsigned count_differences(const struct letter *a, const struct letter *b, const struct rectangle *box,
                                  const struct ramp ramp[2])
{
    unsigned different = 0;
    for (int32_t row = pixel_from(box->y0); row < pixel_from(box->y1); row++)
        for (int32_t column = pixel_from(box->x0); column < pixel_from(box->x1); column++)
            for (int axis = 0; axis < 2; axis++)
                different += position_of(a, axis, ramp[axis].size, column, row) !=
                             position_of(b, axis, ramp[axis].size, column, row);
    return different;
}

static struct rectangle letter_box(void)
{
    struct rectangle box = random_box(1, 12 * PIXEL);
    box.y1 = box.y0 + 1 + below(12 * PIXEL);
    if (chance(2))
        box.x0 &= -PIXEL, box.y0 &= -PIXEL, box.x1 |= PIXEL - 1, box.y1 |= PIXEL - 1;
    if (chance(16))
        box.x1 += below(200 * PIXEL);
    return box;
}

static void joined_letters_have_the_positions_of_both_halves(void)
{
    unsigned joined = 0, different = 0, apart = 0, saved = mxcsr_enter();
    for (int round = 0; round < LETTERS / (int)test_stride(); round++) {
        struct rectangle box = letter_box();
        struct ramp ramp[2] = {random_ramp(0), random_ramp(1)};
        int free_corner = below(4);
        struct letter first = letter_without(&box, free_corner, ramp), both = first;
        struct letter second = letter_without(&box, free_corner ^ 3, ramp);
        job.texture[3].width_256 = ramp[0].size, job.texture[3].height_256 = ramp[1].size;
        bool joins = bin_pair_join((uint8_t *)&both, (const uint8_t *)&second, &letter_form, &job);
        unsigned here = count_differences(&first, &second, &box, ramp);
        joined += joins;
        apart += !joins && here;
        if (joins)
            different += here + count_differences(&first, &both, &box, ramp);
        else
            TEST_ASSERT_EQUAL_MEMORY(&first, &both, sizeof first);
    }
    mxcsr_leave(saved);
    TEST_ASSERT_EQUAL_UINT32(0, different);
    TEST_ASSERT_GREATER_THAN(LETTERS / (int)test_stride() / 8, joined);
    TEST_ASSERT_GREATER_THAN(LETTERS / (int)test_stride() / 64, apart);
}

static const struct rectangle page = {3 * PIXEL, 5 * PIXEL, 12 * PIXEL, 18 * PIXEL};
static const struct ramp texel_by_texel[2] = {{512 * 256, 300 * 256, {256, 0}},
                                              {512 * 256, 7 * 256, {0, 256}}};

static bool joins(struct letter first, struct letter second)
{
    job.texture[3].width_256 = job.texture[3].height_256 = 512 * 256;
    return bin_pair_join((uint8_t *)&first, (const uint8_t *)&second, &letter_form, &job);
}

static void letters_that_differ_are_not_joined(void)
{
    struct letter first = letter_without(&page, 3, texel_by_texel),
                  same = letter_without(&page, 0, texel_by_texel);
    TEST_ASSERT_TRUE(joins(first, same));
    struct letter second = same;
    second.color[3] = 0;
    TEST_ASSERT_FALSE(joins(first, second));
    for (int sign = -1; sign <= 1; sign += 2) {
        second = same, second.coordinate[0].value += (float)sign * 0.6f / (512 * 256);
        TEST_ASSERT_FALSE(joins(first, second));
        TEST_ASSERT_FALSE(joins(second, first));
        second = same, second.coordinate[1].dy += (float)sign * 0.05f / (512 * 256);
        TEST_ASSERT_FALSE(joins(first, second));
        TEST_ASSERT_FALSE(joins(second, first));
    }
    second = same, second.coordinate[0].dx = NAN;
    TEST_ASSERT_FALSE(joins(first, second));
    second = same, second.coordinate[1].value = INFINITY;
    TEST_ASSERT_FALSE(joins(second, second));
}

static void w_of_letters_is_one(void)
{
    struct letter first = letter_without(&page, 3, texel_by_texel),
                  same = letter_without(&page, 0, texel_by_texel);
    struct letter second = same;
    second.reciprocal_w.dx = -0.0f;
    TEST_ASSERT_TRUE(joins(first, second));
    second.reciprocal_w.dx = 0x1p-100f;
    TEST_ASSERT_FALSE(joins(first, second));
    first.reciprocal_w.value = same.reciprocal_w.value = 0.5f;
    TEST_ASSERT_FALSE(joins(first, same));
}

static void steps_of_rounding_become_zero(void)
{
    struct letter first = letter_without(&page, 3, texel_by_texel),
                  second = letter_without(&page, 0, texel_by_texel);
    first.coordinate[0].dy = 0x1p-36f;
    first.coordinate[1].dx = -0x1p-36f;
    job.texture[3].width_256 = job.texture[3].height_256 = 512 * 256;
    TEST_ASSERT_TRUE(bin_pair_join((uint8_t *)&first, (const uint8_t *)&second, &letter_form, &job));
    TEST_ASSERT_EQUAL_FLOAT(0, first.coordinate[0].dy);
    TEST_ASSERT_EQUAL_FLOAT(0, first.coordinate[1].dx);
    TEST_ASSERT_EQUAL_FLOAT(1.0f / 512, first.coordinate[0].dx);
    TEST_ASSERT_EQUAL_FLOAT(1.0f / 512, first.coordinate[1].dy);
}

/* A plane that reaches far has large errors of rounding, so that its positions are compared one by one. */
static void positions_beyond_the_reach_are_compared_one_by_one(void)
{
    for (int far = 0; far < 4; far++) {
        struct ramp ramp[2] = {texel_by_texel[0], texel_by_texel[1]};
        ramp[0].start = far ? 1 << 19 : 1 << 18;
        struct letter first = letter_without(&page, 3, ramp), second = letter_without(&page, 0, ramp);
        first.coordinate[0].value = second.coordinate[0].value = (float)(ramp[0].start / (512 * 256));
        second.coordinate[0].value += (second.head.origin_x > 3 ? 9.0f : 0) / 512;
        first.coordinate[0].value += (first.head.origin_x > 3 ? 9.0f : 0) / 512;
        first.coordinate[0].dx = second.coordinate[0].dx = 1.0f / 512;
        second.coordinate[0].value += far > 1 ? 0x1p-16f : 0;
        bool same = !count_differences(&first, &second, &page, ramp);
        TEST_ASSERT_EQUAL(far < 2, same);
        TEST_ASSERT_EQUAL(same && (!far || cpu_has_avx2_fma()), joins(first, second));
    }
}

/* The halves of a page's image of 96 texels on 312 pixels, and 72 on 150, with the words that setup finds. */
static const struct rectangle picture = {24 * PIXEL, 106 * PIXEL, 336 * PIXEL, 256 * PIXEL};
static const struct ramp scaled[2] = {{96 * 256, 0, {96 * 256 / 312.0, 0}},
                                      {72 * 256, 0, {0, 72 * 256 / 150.0}}};

static struct letter half_of_picture(int free_corner)
{
    struct letter letter = letter_without(&picture, free_corner, scaled);
    bool right = letter.head.x[0] > picture.x0, low = letter.head.y[0] > picture.y0;
    letter.coordinate[0] = (struct plane){right, (float)(1 / 312.0), 0};
    letter.coordinate[1] = (struct plane){low, 0, (float)(1 / 150.0)};
    return letter;
}

static bool join_pictures(struct letter *first, struct letter second)
{
    job.texture[3].width_256 = 96 * 256, job.texture[3].height_256 = 72 * 256;
    return bin_pair_join((uint8_t *)first, (const uint8_t *)&second, &letter_form, &job);
}

static void scaled_images_are_joined_where_all_positions_are_the_same(void)
{
    struct letter first = half_of_picture(3), second = half_of_picture(0), joined = first;
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("positions are compared one by one with AVX2 and FMA");
    joined.coordinate[0].dy = 0x1p-50f;
    TEST_ASSERT_TRUE(join_pictures(&joined, second));
    TEST_ASSERT_EQUAL_FLOAT(0, joined.coordinate[0].dy);
    TEST_ASSERT_EQUAL_UINT32(0, count_differences(&joined, &second, &picture, scaled));
    joined = first, joined.coordinate[0].dx = 0x1p-126f;
    TEST_ASSERT_FALSE(join_pictures(&joined, second));
    joined = first, joined.coordinate[0].dy = (float)(1 / 150.0);
    TEST_ASSERT_FALSE(join_pictures(&joined, second));
}

/* A step across changes a position in the first or the last column or row only. */
static void a_step_across_a_scaled_image_is_found(void)
{
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("positions are compared one by one with AVX2 and FMA");
    for (int half = 0; half < 2; half++)
        for (int sign = -1; sign <= 1; sign += 2) {
            struct letter letter[2] = {half_of_picture(3), half_of_picture(0)}, joined;
            float step = (float)sign * 0.6f / (72 * 256) / 150;
            letter[half].coordinate[0].dy = step;
            joined = letter[0];
            TEST_ASSERT_FALSE(join_pictures(&joined, letter[1]));
            letter[half].coordinate[0].dy = 0;
            letter[half].coordinate[1].dx = step / 2;
            joined = letter[0];
            TEST_ASSERT_FALSE(join_pictures(&joined, letter[1]));
        }
}

static void records_of_coordinates_that_sample_are_joined(void)
{
    struct setup_key key = {.primitive = PRIMITIVE_TRIANGLE};
    key.varying[VARYING_diffuse] = INTERPOLATION_FLAT;
    key.varying[VARYING_texcoord2] = INTERPOLATION_SMOOTH;
    struct pair_form form = form_of(&key, 1 << 3);
    TEST_ASSERT_EQUAL_MEMORY(&letter_form, &form, sizeof form);
    TEST_ASSERT_EQUAL_UINT32(PAIR_LOOKUPS, form_of(&key, 0x1111).lookups);
    TEST_ASSERT_EQUAL_UINT32(0, form_of(&key, 0x1113).bytes);
    TEST_ASSERT_EQUAL_UINT32(0, form_of(&key, 0).bytes);
    uint16_t samplers[TEXTURE_STAGES] = {[2] = 1};
    TEST_ASSERT_EQUAL_UINT32(0, bin_pair_form(&key, PRECISION_PARTIAL, samplers).bytes);
    key.varying[VARYING_fog] = INTERPOLATION_SMOOTH;
    TEST_ASSERT_EQUAL_UINT32(0, form_of(&key, 1).bytes);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(joined_letters_have_the_positions_of_both_halves);
    RUN_TEST(letters_that_differ_are_not_joined);
    RUN_TEST(w_of_letters_is_one);
    RUN_TEST(steps_of_rounding_become_zero);
    RUN_TEST(positions_beyond_the_reach_are_compared_one_by_one);
    RUN_TEST(scaled_images_are_joined_where_all_positions_are_the_same);
    RUN_TEST(a_step_across_a_scaled_image_is_found);
    RUN_TEST(records_of_coordinates_that_sample_are_joined);
    return UNITY_END();
}
