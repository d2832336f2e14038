/* Two triangles that are a rectangle are joined to one record, which covers exactly their pixels, and gives
 * them the same positions in textures; others are not. */
#include "render/geometry/bin.h"
#include "render/geometry/bin_pair.h"

#include "base/bits.h"
#include "ir/ir.h"
#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "render/raster/raster_part.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <string.h>
#include <unity.h>

enum {
    WORDS = 4,
    BYTES = sizeof(struct triangle_head) + WORDS * sizeof(float),
    PIXEL = 1 << SUBPIXEL_BITS,
    LETTERS = 20000
};

union record {
    struct triangle_head head;
    uint8_t bytes[BYTES];
};

/* A record with 1/w, a colour, and the coordinates of a texture. */
struct letter {
    struct triangle_head head;
    struct plane reciprocal_w;
    float color[4];
    struct plane coordinate[2];
};

static const struct pair_form flat_form = {.bytes = BYTES},
                              letter_form = {.bytes = sizeof(struct letter),
                                             .smooth = 1,
                                             .lookups = 1,
                                             .lookup = {{offsetof(struct letter, coordinate), 3}}};

static struct job job;

static uint64_t state;

void setUp(void)
{
    state = test_seed();
}

void tearDown(void)
{
}

static uint32_t draw(void) /* xorshift64* */
{
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return (uint32_t)(state * 0x2545F4914F6CDD1DULL >> 32);
}

static int below(int count)
{
    return (int)(draw() % (uint32_t)count);
}

/* A triangle of three of a box's corners, in an orientation that setup gives, with the same words in all. */
static union record half_of(const struct rectangle *box, const int corner[3])
{
    union record r;
    memset(&r, 0, sizeof r);
    r.head.visible = -1;
    for (int i = 0; i < 3; i++) {
        r.head.x[i] = corner[i] & 1 ? box->x1 : box->x0;
        r.head.y[i] = corner[i] & 2 ? box->y1 : box->y0;
    }
    int64_t area = (int64_t)(r.head.x[1] - r.head.x[0]) * (r.head.y[2] - r.head.y[0]) -
                   (int64_t)(r.head.x[2] - r.head.x[0]) * (r.head.y[1] - r.head.y[0]);
    if (area < 0) {
        int32_t x = r.head.x[1], y = r.head.y[1];
        r.head.x[1] = r.head.x[2], r.head.y[1] = r.head.y[2];
        r.head.x[2] = x, r.head.y[2] = y;
    }
    memset(r.bytes + sizeof r.head, 0x3c, BYTES - sizeof r.head);
    return r;
}

static union record half_without(const struct rectangle *box, int free_corner)
{
    int first = below(3), corner[3];
    for (int i = 0, n = first; i < 4; i++)
        if (i != free_corner)
            corner[n++ % 3] = i;
    return half_of(box, corner);
}

static struct rectangle random_box(int32_t least, int32_t most)
{
    struct rectangle box;
    box.x0 = below(100 * PIXEL) - 20 * PIXEL;
    box.y0 = below(100 * PIXEL) - 20 * PIXEL;
    box.x1 = box.x0 + least + below(most - least);
    box.y1 = box.y0 + 1 + below(most);
    return box;
}

/* Adds the coverage of a record in a tile, and returns whether no pixel had it before. */
static bool add_coverage(uint16_t blocks[TILE_BLOCKS], const union record *record,
                         const struct rectangle *scissor, int column, int row)
{
    struct entry entries[TILE_BLOCKS + 4];
    uint32_t count = raster_tile(&record->head, scissor, column, row, 64, entries);
    bool alone = true;
    for (uint32_t i = 0; i < count; i++) {
        alone &= !(blocks[entries[i].block] & entries[i].coverage);
        blocks[entries[i].block] |= entries[i].coverage;
    }
    return alone;
}

static void a_joined_pair_covers_the_pixels_of_both_halves(void)
{
    for (int round = 0; round < 20000 / (int)test_stride(); round++) {
        struct rectangle box = random_box(1, 130 * PIXEL), scissor = {0, 0, 128, 128};
        int free_corner = below(4), column = round & 1, row = round >> 1 & 1;
        uint16_t apart[TILE_BLOCKS] = {0}, joined[TILE_BLOCKS] = {0};
        if (round & 4)
            scissor = (struct rectangle){below(64), 3, 70 + below(58), 101};
        union record first = half_without(&box, free_corner), second = half_without(&box, free_corner ^ 3);
        add_coverage(apart, &first, &scissor, column, row);
        TEST_ASSERT_TRUE(add_coverage(apart, &second, &scissor, column, row));
        TEST_ASSERT_TRUE(bin_pair_join(first.bytes, second.bytes, &flat_form, &job));
        add_coverage(joined, &first, &scissor, column, row);
        TEST_ASSERT_EQUAL_HEX16_ARRAY(apart, joined, TILE_BLOCKS);
    }
}

static void a_rectangle_touches_and_covers_the_tiles_of_its_bounds(void)
{
    struct rectangle box = {0, 10 * PIXEL, 192 * PIXEL, 128 * PIXEL}, scissor = {0, 0, 256, 256};
    union record first = half_without(&box, 1), second = half_without(&box, 2);
    struct raster raster;
    TEST_ASSERT_TRUE(raster_prepare(&raster, &first.head, &scissor));
    TEST_ASSERT_FALSE(raster_covers(&raster, 1, 1));
    TEST_ASSERT_TRUE(bin_pair_join(first.bytes, second.bytes, &flat_form, &job));
    TEST_ASSERT_TRUE(raster_prepare(&raster, &first.head, &scissor));
    for (int column = 0; column < 3; column++) {
        TEST_ASSERT_TRUE(raster_touches(&raster, column, 0));
        TEST_ASSERT_FALSE(raster_covers(&raster, column, 0));
        TEST_ASSERT_TRUE(raster_covers(&raster, column, 1));
    }
}

/* In a cell, a wide rectangle has the bits that its edges would give. */
static void a_wide_rectangle_is_in_the_tiles_of_its_bounds(void)
{
    static struct wide wide = {.count = 1};
    struct rectangle scissor = {0, 0, 256, 256};
    for (int round = 0; round < 2000; round++) {
        struct rectangle box = random_box(1, 250 * PIXEL);
        union record first = half_without(&box, 1), second = half_without(&box, 2);
        struct raster *raster = &wide.triangle[0].raster;
        struct bin_cell cell;
        if (round & 1)
            scissor = (struct rectangle){64, 64, 128 + below(65), 128 + below(65)};
        if (!bin_pair_join(first.bytes, second.bytes, &flat_form, &job) ||
            !raster_prepare(raster, &first.head, &scissor))
            continue;
        for (int at = 0; at < 16; at++) {
            int x0 = at % 4 * TILE_SIZE, y0 = at / 4 * TILE_SIZE;
            const struct rectangle *b = &raster->bounds;
            bool meets = b->x0 < x0 + TILE_SIZE && b->x1 > x0 && b->y0 < y0 + TILE_SIZE && b->y1 > y0;
            uint32_t covers = raster_covers(raster, at % 4, at / 4) ? BIN_COVERS : 0;
            wide.triangle[0].offset = 640 | BIN_RECTANGLE;
            bin_wide_cell(&wide, (uint32_t)(at % 4), (uint32_t)(at / 4), &cell);
            TEST_ASSERT_EQUAL_UINT32(meets, cell.count);
            if (meets)
                TEST_ASSERT_EQUAL_HEX32(640 | BIN_RECTANGLE | covers, cell.triangle[0]);
        }
    }
}

static void expect_apart(union record first, union record second)
{
    union record before = first;
    TEST_ASSERT_FALSE(bin_pair_join(first.bytes, second.bytes, &flat_form, &job));
    TEST_ASSERT_EQUAL_MEMORY(before.bytes, first.bytes, BYTES);
}

/* The words after the head are a plane of depth here, and a colour of one word. */
static bool joins_depths(struct plane first, struct plane second)
{
    static const struct pair_form depth_form = {.bytes = BYTES, .depth = 1};
    struct rectangle box = {0, 10 * PIXEL, 192 * PIXEL, 128 * PIXEL};
    union record a = half_without(&box, 1), b = half_without(&box, 2);
    memcpy(a.bytes + sizeof a.head, &first, sizeof first);
    memcpy(b.bytes + sizeof b.head, &second, sizeof second);
    return bin_pair_join(a.bytes, b.bytes, &depth_form, &job);
}

static void a_pair_of_one_depth_is_joined(void)
{
    const struct plane level = {0.5f, 0, 0}, other = {0.75f, 0, 0}, across = {0.5f, 1e-30f, 0},
                       down = {0.5f, 0, 1e-30f}, wrong = {0.5f, NAN, 0};
    TEST_ASSERT_TRUE(joins_depths(level, level));
    TEST_ASSERT_TRUE(joins_depths(level, (struct plane){0.5f, -0.0f, 0}));
    TEST_ASSERT_FALSE(joins_depths(level, other));
    TEST_ASSERT_FALSE(joins_depths(across, across));
    TEST_ASSERT_FALSE(joins_depths(level, across));
    TEST_ASSERT_FALSE(joins_depths(down, down));
    TEST_ASSERT_FALSE(joins_depths(down, level));
    TEST_ASSERT_FALSE(joins_depths(wrong, wrong));
}

static void other_triangles_are_not_joined(void)
{
    for (int round = 0; round < 2000; round++) {
        struct rectangle box = random_box(1, 130 * PIXEL), other = box;
        int free_corner = below(4);
        union record first = half_without(&box, free_corner);
        expect_apart(first, half_without(&box, free_corner));
        expect_apart(first, half_without(&box, free_corner ^ 1));
        expect_apart(first, half_without(&box, free_corner ^ 2));
        other.x1++;
        expect_apart(first, half_without(&other, free_corner ^ 3));
        union record slanted = half_without(&box, free_corner ^ 3);
        slanted.head.x[round % 3] += slanted.head.x[round % 3] == box.x0 ? 1 : -1;
        expect_apart(first, slanted);
        expect_apart(slanted, first);
    }
}

static void a_pair_of_other_colours_is_not_joined(void)
{
    struct rectangle box = random_box(1, 130 * PIXEL);
    for (size_t byte = sizeof(struct triangle_head); byte < BYTES; byte++) {
        union record second = half_without(&box, 2);
        second.bytes[byte] ^= 1;
        expect_apart(half_without(&box, 1), second);
    }
}

/* --- Coordinates of textures ---------------------------------------------------------------------------- */

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

/* --- Forms ---------------------------------------------------------------------------------------------- */

static struct pair_form form_of(const struct setup_key *key, unsigned samplers)
{
    uint16_t of_channels[TEXTURE_STAGES] = {[2] = (uint16_t)samplers};
    return bin_pair_form(key, PRECISION_EXACT, of_channels);
}

static void records_of_flat_values_are_joined(void)
{
    struct setup_key key = {.primitive = PRIMITIVE_TRIANGLE}, other;
    TEST_ASSERT_EQUAL_UINT32(sizeof(struct triangle_head), form_of(&key, 0).bytes);
    key.varying[VARYING_diffuse] = INTERPOLATION_FLAT;
    TEST_ASSERT_EQUAL_UINT32(BYTES, form_of(&key, 0).bytes);
    TEST_ASSERT_FALSE(form_of(&key, 0).smooth);
    other = key, other.varying[VARYING_diffuse] = INTERPOLATION_SMOOTH;
    TEST_ASSERT_EQUAL_UINT32(0, form_of(&other, 0).bytes);
    other = key, other.depth = 1;
    TEST_ASSERT_EQUAL_UINT32(BYTES + sizeof(struct plane), form_of(&other, 0).bytes);
    TEST_ASSERT_EQUAL_UINT32(1, form_of(&other, 0).depth);
    other = key, other.facing = 1;
    TEST_ASSERT_EQUAL_UINT32(0, form_of(&other, 0).bytes);
    other = key, other.smooth = 1;
    TEST_ASSERT_EQUAL_UINT32(0, form_of(&other, 0).bytes);
    other = key, other.primitive = PRIMITIVE_LINE;
    TEST_ASSERT_EQUAL_UINT32(0, form_of(&other, 0).bytes);
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
    RUN_TEST(a_joined_pair_covers_the_pixels_of_both_halves);
    RUN_TEST(a_rectangle_touches_and_covers_the_tiles_of_its_bounds);
    RUN_TEST(a_wide_rectangle_is_in_the_tiles_of_its_bounds);
    RUN_TEST(a_pair_of_one_depth_is_joined);
    RUN_TEST(other_triangles_are_not_joined);
    RUN_TEST(a_pair_of_other_colours_is_not_joined);
    RUN_TEST(joined_letters_have_the_positions_of_both_halves);
    RUN_TEST(letters_that_differ_are_not_joined);
    RUN_TEST(w_of_letters_is_one);
    RUN_TEST(steps_of_rounding_become_zero);
    RUN_TEST(positions_beyond_the_reach_are_compared_one_by_one);
    RUN_TEST(scaled_images_are_joined_where_all_positions_are_the_same);
    RUN_TEST(a_step_across_a_scaled_image_is_found);
    RUN_TEST(records_of_flat_values_are_joined);
    RUN_TEST(records_of_coordinates_that_sample_are_joined);
    return UNITY_END();
}
