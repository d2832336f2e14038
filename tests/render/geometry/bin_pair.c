/* Two triangles that are a rectangle are joined to one record, which covers exactly their pixels; others
 * are not. */
#include "render/geometry/bin_pair.h"
#include "render/raster/raster.h"
#include "tests/support/system/seed.h"

#include <string.h>
#include <unity.h>

enum { WORDS = 4, BYTES = sizeof(struct triangle_head) + WORDS * sizeof(float), PIXEL = 1 << SUBPIXEL_BITS };

union record {
    struct triangle_head head;
    uint8_t bytes[BYTES];
};

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
        struct rectangle box = random_box(PAIR_EXTENT, 130 * PIXEL), scissor = {0, 0, 128, 128};
        int free_corner = below(4), column = round & 1, row = round >> 1 & 1;
        uint16_t apart[TILE_BLOCKS] = {0}, joined[TILE_BLOCKS] = {0};
        if (round & 4)
            scissor = (struct rectangle){below(64), 3, 70 + below(58), 101};
        union record first = half_without(&box, free_corner), second = half_without(&box, free_corner ^ 3);
        add_coverage(apart, &first, &scissor, column, row);
        TEST_ASSERT_TRUE(add_coverage(apart, &second, &scissor, column, row));
        TEST_ASSERT_TRUE(bin_pair_join(first.bytes, second.bytes, BYTES));
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
    TEST_ASSERT_TRUE(bin_pair_join(first.bytes, second.bytes, BYTES));
    TEST_ASSERT_TRUE(raster_prepare(&raster, &first.head, &scissor));
    for (int column = 0; column < 3; column++) {
        TEST_ASSERT_TRUE(raster_touches(&raster, column, 0));
        TEST_ASSERT_FALSE(raster_covers(&raster, column, 0));
        TEST_ASSERT_TRUE(raster_covers(&raster, column, 1));
    }
}

static void expect_apart(union record first, union record second)
{
    union record before = first;
    TEST_ASSERT_FALSE(bin_pair_join(first.bytes, second.bytes, BYTES));
    TEST_ASSERT_EQUAL_MEMORY(before.bytes, first.bytes, BYTES);
}

static void other_triangles_are_not_joined(void)
{
    for (int round = 0; round < 2000; round++) {
        struct rectangle box = random_box(PAIR_EXTENT, 130 * PIXEL), other = box;
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
    struct rectangle box = random_box(PAIR_EXTENT, 130 * PIXEL);
    for (size_t byte = sizeof(struct triangle_head); byte < BYTES; byte++) {
        union record second = half_without(&box, 2);
        second.bytes[byte] ^= 1;
        expect_apart(half_without(&box, 1), second);
    }
}

static void small_pairs_stay_with_the_kernel_of_tiny_triangles(void)
{
    struct rectangle box = {0, 0, PAIR_EXTENT - 1, PAIR_EXTENT - 1};
    expect_apart(half_without(&box, 0), half_without(&box, 3));
    box.y1++;
    union record first = half_without(&box, 0), second = half_without(&box, 3);
    TEST_ASSERT_TRUE(bin_pair_join(first.bytes, second.bytes, BYTES));
}

static void only_records_without_planes_are_joined(void)
{
    struct setup_key key = {.primitive = PRIMITIVE_TRIANGLE};
    TEST_ASSERT_EQUAL_UINT32(sizeof(struct triangle_head), bin_pair_bytes(&key));
    key.varying[VARYING_diffuse] = INTERPOLATION_FLAT;
    TEST_ASSERT_EQUAL_UINT32(BYTES, bin_pair_bytes(&key));
    struct setup_key other = key;
    other.varying[VARYING_diffuse] = INTERPOLATION_SMOOTH;
    TEST_ASSERT_EQUAL_UINT32(0, bin_pair_bytes(&other));
    other = key, other.depth = 1;
    TEST_ASSERT_EQUAL_UINT32(0, bin_pair_bytes(&other));
    other = key, other.facing = 1;
    TEST_ASSERT_EQUAL_UINT32(0, bin_pair_bytes(&other));
    other = key, other.w = 1;
    TEST_ASSERT_EQUAL_UINT32(0, bin_pair_bytes(&other));
    other = key, other.primitive = PRIMITIVE_LINE;
    TEST_ASSERT_EQUAL_UINT32(0, bin_pair_bytes(&other));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_joined_pair_covers_the_pixels_of_both_halves);
    RUN_TEST(a_rectangle_touches_and_covers_the_tiles_of_its_bounds);
    RUN_TEST(other_triangles_are_not_joined);
    RUN_TEST(a_pair_of_other_colours_is_not_joined);
    RUN_TEST(small_pairs_stay_with_the_kernel_of_tiny_triangles);
    RUN_TEST(only_records_without_planes_are_joined);
    return UNITY_END();
}
