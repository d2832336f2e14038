/* The rasterizer is compared with a brute-force oracle: the exact edge functions of every pixel in 64 bits.
 *
 * The oracle has its own rule for centres on an edge: the centre is moved to the right by an infinitesimal
 * and down by a smaller one, and must then be inside. The test of meshes (raster_mesh.c) checks the rule in a
 * third way: it only counts that exactly one triangle covers each centre inside of a closed mesh. */
#include "machine/cpu.h"
#include "render/raster/raster.h"
#include "tests/render/raster/random.h"
#include "tests/support/geometry/covered.h"
#include "tests/support/system/seed.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { WINDOW_MAXIMUM = 4194303, TARGET = TARGET_SIZE_MAXIMUM, TARGET_TILES = TARGET / TILE_SIZE };

void setUp(void)
{
    random_begin();
    random_state ^= test_seed();
}

void tearDown(void)
{
}

/* --- Oracle --- */

static bool inside_edge(const struct triangle_head *h, int p, int q, int32_t x, int32_t y)
{
    int64_t ex = h->x[q] - h->x[p], ey = h->y[q] - h->y[p];
    int64_t sx = (int64_t)x * 256 + 128 - h->x[p], sy = (int64_t)y * 256 + 128 - h->y[p];
    int64_t cross = ex * sy - ey * sx;
    if (cross != 0)
        return cross > 0;
    return ey != 0 ? ey < 0 : ex > 0; /* the sign of the change for a step right, or if it is 0, down */
}

static bool inside_triangle(const struct triangle_head *h, int32_t x, int32_t y)
{
    return inside_edge(h, 0, 1, x, y) && inside_edge(h, 1, 2, x, y) && inside_edge(h, 2, 0, x, y);
}

/* --- Rasterizing as the renderer does --- */

static bool same_head(const struct triangle_head *a, const struct triangle_head *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

static void expect_oracle(const struct covered *a, const struct triangle_head *h)
{
    for (int32_t y = 0; y < a->height; y++)
        for (int32_t x = 0; x < a->width; x++)
            if (a->count[y * a->width + x] != inside_triangle(h, a->cut.x0 + x, a->cut.y0 + y))
                covered_fail(h, &a->cut, a->cut.x0 + x, a->cut.y0 + y, "coverage is not the oracle's");
}

/* --- Random triangles --- */

static int32_t limited(int64_t v)
{
    return (int32_t)(v < -WINDOW_MAXIMUM ? -WINDOW_MAXIMUM : v > WINDOW_MAXIMUM ? WINDOW_MAXIMUM : v);
}

/* Chooses vertices within `reach` of (x, y), at multiples of `grid` plus `offset`. All units are 1/256
 * pixel. */
static void scatter(struct triangle_head *h, int32_t x, int32_t y, int32_t reach, int32_t grid,
                    int32_t offset)
{
    for (int i = 0; i < 3; i++) {
        h->x[i] = limited((x + between(-reach, reach)) / grid * grid + offset);
        h->y[i] = limited((y + between(-reach, reach)) / grid * grid + offset);
    }
}

enum shape {
    TINY,
    NINE_PIXELS,
    BLOCKS,
    SIXTEEN_BITS,
    MIDDLE,
    TILES,
    HUGE,
    SLIVER,
    GRID,
    CENTRES,
    NEEDLE,
    NEARLY_LINE,
    CORNERS,
    SHAPES
};

/* Chooses vertices mostly at the corners of a box. */
static void box_corners(struct triangle_head *h, int32_t x, int32_t y, int32_t width, int32_t height)
{
    for (int i = 0; i < 3; i++) {
        h->x[i] = limited(x + (draw() % 4 ? draw() & 1 ? width : 0 : between(0, width)));
        h->y[i] = limited(y + (draw() % 4 ? draw() & 1 ? height : 0 : between(0, height)));
    }
}

/* A triangle of the shape about the window position (x, y). */
static void random_head(struct triangle_head *h, enum shape shape, int32_t x, int32_t y)
{
    switch (shape) {
    case TINY: scatter(h, x, y, 300, 1, 0); break;
    case BLOCKS: scatter(h, x, y, 1500, 1, 0); break;
    case NINE_PIXELS: box_corners(h, x, y, between(1900, 2400), between(1900, 2400)); break;
    case SIXTEEN_BITS: box_corners(h, x, y, between(5000, 5600), between(5000, 5600)); break;
    case MIDDLE: scatter(h, x, y, 8000, 1, 0); break;
    case TILES: scatter(h, x, y, 60000, 1, 0); break;
    case HUGE: scatter(h, 0, 0, WINDOW_MAXIMUM, 1, 0); break;
    case GRID: scatter(h, x, y, 6000, 64, 0); break;
    case CENTRES: scatter(h, x, y, 4000, 256, 128); break;
    case SLIVER:
        scatter(h, x, y, 12000, 1, 0);
        h->x[2] = limited(h->x[1] + between(-40, 40));
        h->y[2] = limited(h->y[1] + between(-40, 40));
        break;
    case NEEDLE: /* across the whole range, about a pixel wide */
        scatter(h, x, y, 200, 1, 0);
        h->x[2] = between(-WINDOW_MAXIMUM, WINDOW_MAXIMUM);
        h->y[2] = between(-WINDOW_MAXIMUM, WINDOW_MAXIMUM);
        break;
    case NEARLY_LINE: { /* three points of a line, one of them moved by one unit */
        int32_t dx = between(-30, 30), dy = between(-30, 30);
        for (int i = 0; i < 3; i++) {
            int32_t t = between(-300, 300);
            h->x[i] = limited((int64_t)x + dx * t);
            h->y[i] = limited((int64_t)y + dy * t);
        }
        h->x[0] = limited(h->x[0] + between(-1, 1));
        h->y[0] = limited(h->y[0] + between(-1, 1));
        break;
    }
    case CORNERS: /* vertices at the limits, which give the largest steps */
        for (int i = 0; i < 3; i++) {
            h->x[i] = draw() & 1 ? WINDOW_MAXIMUM : -WINDOW_MAXIMUM;
            h->y[i] = draw() & 1 ? WINDOW_MAXIMUM : -WINDOW_MAXIMUM;
        }
        h->x[between(0, 2)] = x;
        h->y[between(0, 2)] = y;
        break;
    default: TEST_FAIL();
    }
}

/* A rectangle of the target near pixel (x, y), at most `size` pixels wide and high; sometimes at the target's
 * edges. */
static struct rectangle random_cut(int32_t x, int32_t y, int32_t size)
{
    struct rectangle r = {x - between(0, size / 2), y - between(0, size / 2), x + between(0, size / 2),
                          y + between(0, size / 2)};
    if (draw() % 4 == 0)
        r = (struct rectangle){r.x0 & -4, r.y0 & -4, r.x1 & -4, r.y1 & -4};
    r.x0 = r.x0 < 0 ? 0 : r.x0;
    r.y0 = r.y0 < 0 ? 0 : r.y0;
    r.x1 = r.x1 > TARGET ? TARGET : r.x1 < r.x0 ? r.x0 : r.x1;
    r.y1 = r.y1 > TARGET ? TARGET : r.y1 < r.y0 ? r.y0 : r.y1;
    return r;
}

/* One to four whole tiles near pixel (x, y), so that only the tiles' sides cut triangles. */
static struct rectangle whole_tiles(int32_t x, int32_t y)
{
    struct rectangle r = {x & -TILE_SIZE, y & -TILE_SIZE, (x & -TILE_SIZE) + TILE_SIZE,
                          (y & -TILE_SIZE) + TILE_SIZE};
    r.x0 -= r.x0 && draw() & 1 ? TILE_SIZE : 0;
    r.y0 -= r.y0 && draw() & 1 ? TILE_SIZE : 0;
    return r;
}

/* All tests together compare 142,000 triangles, or with a seed more than a million. */
static unsigned share_of(unsigned triangles)
{
    enum { LONGER = 8, FEW = 4000 };
    if (getenv("TRIPTYCH_SEED"))
        return LONGER * triangles;
    return triangles <= FEW ? test_share(triangles) : test_share_of(triangles, 12);
}

/* Compares random triangles with the oracle, in random rectangles of `cut_size`, or in whole tiles if it is
 * 0. */
static void compare_shape(enum shape shape, unsigned triangles, int32_t cut_size)
{
    uint64_t covered = 0;
    for (unsigned i = 0; i < share_of(triangles); i++) {
        int32_t x = between(0, TARGET - 1), y = between(0, TARGET - 1);
        struct triangle_head h = {.visible = -1};
        do
            random_head(&h, shape, x * 256 + between(-256, 256), y * 256 + between(-256, 256));
        while (!covered_orient(&h));
        struct covered a = covered_make(cut_size ? random_cut(x, y, cut_size) : whole_tiles(x, y));
        struct triangle_head before = h;
        covered_count(&a, &h);
        expect_oracle(&a, &h);
        TEST_ASSERT_TRUE(same_head(&before, &h));
        for (int p = 0; p < a.width * a.height; p++)
            covered += a.count[p];
        free(a.count);
    }
    TEST_ASSERT_GREATER_THAN_UINT64(0, covered); /* some of the triangles are in the rectangles */
}

static void test_tiny_triangles_equal_the_oracle(void)
{
    compare_shape(TINY, 30000, 8);
}

static void test_triangles_of_a_few_blocks_equal_the_oracle(void)
{
    compare_shape(BLOCKS, 20000, 24);
}

static void test_triangles_in_whole_tiles_equal_the_oracle(void)
{
    compare_shape(TINY, 3000, 0);
    compare_shape(BLOCKS, 3000, 0);
    compare_shape(NINE_PIXELS, 3000, 0);
    compare_shape(SIXTEEN_BITS, 4000, 0);
    compare_shape(MIDDLE, 1000, 0);
    compare_shape(CENTRES, 2000, 0);
    compare_shape(NEARLY_LINE, 1000, 0);
}

static void test_triangles_within_a_tile_equal_the_oracle(void)
{
    compare_shape(MIDDLE, 10000, 80);
}

static void test_triangles_over_tiles_equal_the_oracle(void)
{
    compare_shape(TILES, 800, 400);
}

static void test_huge_triangles_equal_the_oracle(void)
{
    compare_shape(HUGE, 8000, 60);
    compare_shape(CORNERS, 8000, 60);
}

static void test_slivers_equal_the_oracle(void)
{
    compare_shape(SLIVER, 8000, 60);
    compare_shape(NEEDLE, 8000, 60);
    compare_shape(NEARLY_LINE, 8000, 60);
}

static void test_edges_through_centres_equal_the_oracle(void)
{
    compare_shape(GRID, 8000, 60);
    compare_shape(CENTRES, 16000, 40);
}

/* --- The rule, in single pixels --- */

static uint32_t coverage_of(const struct triangle_head *h, struct rectangle cut)
{
    struct covered a = covered_make(cut);
    covered_count(&a, h);
    uint32_t sum = 0;
    for (int p = 0; p < a.width * a.height; p++)
        sum += a.count[p];
    free(a.count);
    return sum;
}

static const struct rectangle whole = {0, 0, 64, 64};

static void test_left_and_top_edges_belong_to_the_triangle_right_and_bottom_ones_do_not(void)
{
    struct triangle_head upper_left = {
        -1, {128, 1152, 128}, {128, 128, 1152}, 0, 0}; /* legs through 4 centres */
    struct triangle_head lower_right = {-1, {1152, 1152, 128}, {128, 1152, 1152}, 0, 0};
    TEST_ASSERT_EQUAL_UINT32(
        10, coverage_of(&upper_left, whole)); /* 4 + 3 + 2 + 1: the diagonal is a right edge */
    TEST_ASSERT_EQUAL_UINT32(6,
                             coverage_of(&lower_right, whole)); /* 1 + 2 + 3: the diagonal is its left edge */
}

static void test_triangles_that_are_invisible_or_outside_of_the_scissor_are_rejected(void)
{
    struct triangle_head h = {-1, {0, 4096, 0}, {0, 0, 4096}, 0, 0};
    struct raster r;
    TEST_ASSERT_TRUE(raster_prepare(&r, &h, &whole));
    TEST_ASSERT_FALSE(raster_prepare(&r, &h, &(struct rectangle){16, 0, 64, 64}));
    TEST_ASSERT_FALSE(raster_prepare(&r, &h, &(struct rectangle){0, 16, 64, 64}));
    TEST_ASSERT_FALSE(raster_prepare(&r, &h, &(struct rectangle){8, 8, 8, 20}));
    TEST_ASSERT_FALSE(raster_prepare(&r, &h, &(struct rectangle){8, 20, 20, 8}));
    struct triangle_head between_centres = {-1, {130, 380, 130}, {130, 130, 380}, 0, 0};
    TEST_ASSERT_FALSE(raster_prepare(&r, &between_centres, &whole));
    struct entry entries[TILE_BLOCKS];
    TEST_ASSERT_EQUAL_UINT32(0, raster_tile(&h, &whole, 1, 0, 0, entries));
    h.visible = 0;
    TEST_ASSERT_FALSE(raster_prepare(&r, &h, &whole));
    TEST_ASSERT_EQUAL_UINT32(0, raster_tile(&h, &whole, 0, 0, 0, entries));
}

static void test_a_covered_tile_is_256_whole_blocks(void)
{
    struct triangle_head h = {-1, {-1000, WINDOW_MAXIMUM, -1000}, {-1000, -1000, WINDOW_MAXIMUM}, 0, 0};
    struct rectangle target = {0, 0, TARGET, TARGET};
    struct entry entries[TILE_BLOCKS];
    TEST_ASSERT_EQUAL_UINT32(TILE_BLOCKS, raster_tile(&h, &target, 3, 5, 7, entries));
    for (int i = 0; i < TILE_BLOCKS; i++) {
        TEST_ASSERT_EQUAL_HEX16(0xffff, entries[i].coverage);
        TEST_ASSERT_EQUAL_UINT16(i, entries[i].block);
        TEST_ASSERT_EQUAL_FLOAT((float)(3 * 64 + i % 16 * 4), entries[i].x);
        TEST_ASSERT_EQUAL_FLOAT((float)(5 * 64 + i / 16 * 4), entries[i].y);
        TEST_ASSERT_EQUAL_UINT32(7, entries[i].triangle);
    }
}

static void test_whole_tiles_are_written_alike_with_and_without_avx2(void)
{
    struct rectangle target = {0, 0, TARGET, TARGET};
    struct raster_site site;
    struct entry entries[2][TILE_BLOCKS + 1];
    raster_enter(&site, &target, 3, 5);
    for (int avx2 = 0; avx2 < 2; avx2++) {
        memset(entries[avx2], 0x5a, sizeof entries[avx2]);
        site.rows = avx2 && cpu_has_avx2_fma();
        TEST_ASSERT_EQUAL_UINT32(TILE_BLOCKS, raster_whole(&site, 7 << 6, entries[avx2]));
    }
    TEST_ASSERT_EQUAL_MEMORY(entries[0], entries[1], sizeof entries[0]);
    TEST_ASSERT_EQUAL_UINT16(255, entries[0][255].block);
    TEST_ASSERT_EQUAL_HEX16(0xffff, entries[0][255].coverage);
    TEST_ASSERT_EQUAL_FLOAT(3 * 64 + 60, entries[0][255].x);
    TEST_ASSERT_EQUAL_FLOAT(5 * 64 + 60, entries[0][255].y);
    TEST_ASSERT_EQUAL_UINT32(7 << 6, entries[0][255].triangle);
}

static void test_the_first_row_of_a_whole_tile_is_that_of_all_rows(void)
{
    enum { ROW = TILE_SIZE / BLOCK_SIZE };
    struct rectangle target = {0, 0, TARGET, TARGET};
    struct raster_site site;
    struct entry entries[TILE_BLOCKS], row[ROW + 1], after;
    memset(row, 0x5a, sizeof row);
    after = row[ROW];
    raster_enter(&site, &target, 3, 5);
    raster_whole(&site, 7 << 6, entries);
    TEST_ASSERT_EQUAL_UINT32(ROW, raster_first_row(3, 5, 7 << 6, row));
    TEST_ASSERT_EQUAL_MEMORY(entries, row, ROW * sizeof *row);
    TEST_ASSERT_EQUAL_MEMORY(&after, row + ROW, sizeof after);
}

static int by_block(const void *a, const void *b)
{
    return ((const struct entry *)a)->block - ((const struct entry *)b)->block;
}

/* --- Lists --- */

enum { RECORDS = 19, STRIDE = 64, ROUNDING_BITS = 13 };
static alignas(64) uint8_t records[RECORDS * STRIDE];
static uint32_t offset[RECORDS];

/* Triangles near the tile whose first pixel is (x, y). */
static void make_list(int32_t x, int32_t y, bool huge)
{
    static const enum shape shapes[] = {TINY,        TINY,        TINY,   BLOCKS,      BLOCKS,
                                        NINE_PIXELS, NINE_PIXELS, MIDDLE, SLIVER,      NEEDLE,
                                        NEARLY_LINE, CENTRES,     TILES,  SIXTEEN_BITS};
    for (uint32_t i = 0; i < RECORDS; i++) {
        enum shape shape = huge && draw() & 1 ? HUGE : shapes[draw() % (sizeof shapes / sizeof *shapes)];
        int32_t grid = draw() & 1 ? 1 : 128; /* edges through centres */
        struct triangle_head h = {.visible = -1};
        do {
            random_head(&h, shape, x * 256 + between(-1024, 65 * 256), y * 256 + between(-1024, 65 * 256));
            for (int v = 0; v < 3; v++) {
                h.x[v] = h.x[v] / grid * grid;
                h.y[v] = h.y[v] / grid * grid;
            }
        } while (!covered_orient(&h));
        offset[i] = i * STRIDE;
        memcpy(records + offset[i], &h, sizeof h);
    }
}

/* raster_list() in a thread with another rounding mode that traps invalid operations, divisions by zero and
 * overflow. */
static uint32_t list_in_mode(const struct raster_site *site, unsigned mode, uint32_t count,
                             struct entry *entries, uint32_t *used)
{
    const unsigned saved = _mm_getcsr();
    _mm_setcsr((_MM_MASK_MASK & ~(_MM_MASK_INVALID | _MM_MASK_DIV_ZERO | _MM_MASK_OVERFLOW)) |
               mode << ROUNDING_BITS);
    uint32_t done = raster_list(site, records, offset, count, entries, used);
    _mm_setcsr(saved);
    return done;
}

/* A list of triangles gives the same entries as its triangles one by one, except for the order of a
 * triangle's blocks, with each kernel that the processor has and in each rounding mode. It stops before a
 * triangle whose entries might not fit. A triangle by itself has its blocks in order. */
static void test_lists_are_their_triangles_one_after_the_other(void)
{
    uint32_t stops = 0;
    for (unsigned round = 0; round < test_share_of(20000, 16); round++) {
        static struct entry entries[PIXEL_ENTRIES], one[TILE_BLOCKS], ordered[TILE_BLOCKS];
        int column = between(0, TARGET_TILES - 1), row = between(0, TARGET_TILES - 1);
        int32_t x = column * TILE_SIZE, y = row * TILE_SIZE;
        uint32_t used = draw() % 800, before = used, count = 1 + draw() % RECORDS;
        struct rectangle cut = {0, 0, TARGET, TARGET};
        struct raster_site site;
        if (round % 4 == 0)
            cut = random_cut(x + 32, y + 32, 80);
        make_list(x, y, round % 8 == 1);
        raster_enter(&site, &cut, column, row);
        site.kernel &= round % 8 != 2;
        site.rows &= round % 3 != 1;
        uint32_t done = list_in_mode(&site, draw() & 3, count, entries, &used), next = before;
        for (uint32_t i = 0; i < done; i++) {
            uint32_t blocks =
                raster_tile((const void *)(records + offset[i]), &cut, column, row, offset[i], one);
            TEST_ASSERT_LESS_OR_EQUAL_UINT32(PIXEL_ENTRIES, next + blocks);
            qsort(entries + next, blocks, sizeof *entries, by_block);
            if (blocks)
                TEST_ASSERT_EQUAL_MEMORY(one, entries + next, blocks * sizeof *one);
            TEST_ASSERT_EQUAL_UINT32(blocks, raster_blocks(&site, records, offset[i], ordered));
            if (blocks)
                TEST_ASSERT_EQUAL_MEMORY(one, ordered, blocks * sizeof *one);
            next += blocks;
        }
        TEST_ASSERT_EQUAL_UINT32(next, used);
        TEST_ASSERT_TRUE(done == count || used > PIXEL_ENTRIES - TILE_BLOCKS);
        stops += done < count;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(test_share_of(10, 16), stops);
}

static void test_rows_are_found_where_the_processor_has_avx2(void)
{
    struct raster_site site;
    raster_enter(&site, &whole, 0, 0);
    TEST_ASSERT_EQUAL(cpu_has_avx2_fma(), site.rows);
}

/* --- Tiles --- */

/* Tiles that raster_tiles() or raster_touches() leave out have no entries. */
static void test_rejected_tiles_have_no_pixels(void)
{
    static const enum shape shapes[] = {TILES, HUGE, SLIVER, NEEDLE, CENTRES, CORNERS};
    uint32_t rejected = 0;
    for (unsigned i = 0; i < test_share_of(1500, 10); i++) {
        int32_t x = between(0, TARGET), y = between(0, TARGET);
        struct triangle_head h = {.visible = -1};
        do
            random_head(&h, shapes[i % 6], x * 256, y * 256);
        while (!covered_orient(&h));
        struct rectangle cut = random_cut(x, y, 600);
        struct raster r;
        bool may = raster_prepare(&r, &h, &cut);
        struct rectangle tiles = may ? raster_tiles(&r.bounds) : (struct rectangle){0, 0, 0, 0};
        for (int row = cut.y0 / 64; row <= cut.y1 / 64 && row < TARGET_TILES; row++)
            for (int column = cut.x0 / 64; column <= cut.x1 / 64 && column < TARGET_TILES; column++) {
                bool in = column >= tiles.x0 && column < tiles.x1 && row >= tiles.y0 && row < tiles.y1;
                if (in && raster_touches(&r, column, row))
                    continue;
                struct entry entries[TILE_BLOCKS];
                TEST_ASSERT_EQUAL_UINT32(0, raster_tile(&h, &cut, column, row, 0, entries));
                rejected++;
            }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(test_share_of(1000, 10), rejected);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_left_and_top_edges_belong_to_the_triangle_right_and_bottom_ones_do_not);
    RUN_TEST(test_triangles_that_are_invisible_or_outside_of_the_scissor_are_rejected);
    RUN_TEST(test_a_covered_tile_is_256_whole_blocks);
    RUN_TEST(test_whole_tiles_are_written_alike_with_and_without_avx2);
    RUN_TEST(test_the_first_row_of_a_whole_tile_is_that_of_all_rows);
    RUN_TEST(test_tiny_triangles_equal_the_oracle);
    RUN_TEST(test_triangles_of_a_few_blocks_equal_the_oracle);
    RUN_TEST(test_triangles_in_whole_tiles_equal_the_oracle);
    RUN_TEST(test_triangles_within_a_tile_equal_the_oracle);
    RUN_TEST(test_triangles_over_tiles_equal_the_oracle);
    RUN_TEST(test_huge_triangles_equal_the_oracle);
    RUN_TEST(test_slivers_equal_the_oracle);
    RUN_TEST(test_edges_through_centres_equal_the_oracle);
    RUN_TEST(test_lists_are_their_triangles_one_after_the_other);
    RUN_TEST(test_rows_are_found_where_the_processor_has_avx2);
    RUN_TEST(test_rejected_tiles_have_no_pixels);
    return UNITY_END();
}
