/* Two triangles that are a rectangle are joined to one record, which covers exactly their pixels; others are
 * not. */
#include "render/geometry/bin.h"
#include "render/raster/raster_part.h"
#include "tests/render/geometry/half.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <unity.h>

static const struct pair_form flat_form = {.bytes = BYTES};

static struct job job;

void setUp(void)
{
    state = test_seed();
}

void tearDown(void)
{
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

static void colours_from_0_to_1_are_unit(void)
{
    static const struct {
        float color;
        bool is_unit;
    } colors[] = {{0, true},          {1, true},
                  {0x1p-126f, true},  {0x1.fffffep-1f, true},
                  {0.5f, true},       {0x1.000002p0f, false},
                  {-0.0f, false},     {0x1.fffffcp-127f, false},
                  {0x1p-149f, false}, {-0x1p-149f, false},
                  {-1, false},        {INFINITY, false},
                  {NAN, false},       {-NAN, false}};
    struct setup_key key = {.primitive = PRIMITIVE_TRIANGLE};
    union record record;
    memset(&record, 0xff, sizeof record);
    const struct pair_form none = form_of(&key, 0);
    TEST_ASSERT_TRUE(bin_pair_has_unit_color(record.bytes, &none));
    key.varying[VARYING_diffuse] = INTERPOLATION_FLAT;
    const struct pair_form form = form_of(&key, 0);
    for (unsigned i = 0; i < 4 * sizeof colors / sizeof *colors; i++) {
        const float half = 0.5f;
        for (unsigned c = 0; c < 4; c++)
            memcpy(record.bytes + sizeof record.head + c * sizeof half,
                   c == i % 4 ? &colors[i / 4].color : &half, sizeof half);
        TEST_ASSERT_EQUAL(colors[i / 4].is_unit, bin_pair_has_unit_color(record.bytes, &form));
    }
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
    RUN_TEST(records_of_flat_values_are_joined);
    RUN_TEST(colours_from_0_to_1_are_unit);
    return UNITY_END();
}
