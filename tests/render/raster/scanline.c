/* A scanline rasterizer beside the renderer's, which tests half-spaces: both cover the same pixels.
 *
 * It walks down the rows of a tile with three edges. An edge keeps the first or last pixel of its row as a
 * quotient and a remainder, and a row adds those of its slope: one row follows from the row before. Its spans
 * become the same blocks with coverage that the renderer has.
 *
 * With MEASURE=1 it also prints the time of both for triangles of several sizes, in ns for each triangle in
 * a tile. */
#include "render/raster/raster.h"
#include "base/clock.h"
#include "tests/support/system/seed.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { TRIANGLES = 2048, SUB = 256, TARGET = 1024 };

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

static int32_t between(int32_t low, int32_t high)
{
    return low + (int32_t)(draw() % ((uint32_t)(high - low) + 1));
}

/* --- The scanline rasterizer --- */

/* floor(n / d), and the remainder 0 <= *rest < d; d > 0. */
static int64_t divide(int64_t n, int64_t d, int64_t *rest)
{
    int64_t q = n / d, r = n % d;
    if (r < 0) {
        r += d;
        q--;
    }
    *rest = r;
    return q;
}

/* A side of the triangle: pixels from x on are inside of a left one, and those below x of a right one.
 * A horizontal one has no divisor; it is inside while `rest` is not negative. */
struct side {
    int64_t x, rest, step, step_rest, divisor;
    bool left;
};

/* Edge i of the raster, in row y. */
static struct side side_of(const struct raster *raster, int i, int32_t y)
{
    int64_t a = raster->a[i], b = raster->b[i], e = raster->c[i] + b * y;
    struct side side = {.left = a > 0, .divisor = a < 0 ? -a : a, .rest = e, .step_rest = b};
    if (!a)
        return side;
    side.x = divide(a > 0 ? a - 1 - e : e, side.divisor, &side.rest) + (a < 0);
    side.step = divide(a > 0 ? -b : b, side.divisor, &side.step_rest);
    return side;
}

/* Limits the span of the row, and goes on to the next one. */
static void take_side(struct side *side, int32_t *from, int32_t *to)
{
    if (!side->divisor && side->rest < 0)
        *to = *from;
    else if (side->divisor && side->left && side->x > *from)
        *from = side->x < *to ? (int32_t)side->x : *to;
    else if (side->divisor && !side->left && side->x < *to)
        *to = side->x > *from ? (int32_t)side->x : *from;
    side->x += side->step;
    side->rest += side->step_rest;
    if (side->divisor && side->rest >= side->divisor) {
        side->rest -= side->divisor;
        side->x++;
    }
}

/* Adds pixels `from` to `to` - 1 of a row of the tile. Bits of a block are in the order of lanes. */
static void add_span(uint16_t *blocks, int32_t row, int32_t from, int32_t to)
{
    uint16_t *line = blocks + row / BLOCK_SIZE * (TILE_SIZE / BLOCK_SIZE);
    int shift = (row & 1) * 2 + (row >> 1 & 1) * 8;
    for (int32_t block = from / BLOCK_SIZE; block * BLOCK_SIZE < to; block++) {
        uint32_t first = from > block * BLOCK_SIZE ? (uint32_t)(from - block * BLOCK_SIZE) : 0;
        uint32_t end =
            to - block * BLOCK_SIZE < BLOCK_SIZE ? (uint32_t)(to - block * BLOCK_SIZE) : BLOCK_SIZE;
        uint32_t pixels = (1u << end) - (1u << first);
        line[block] |= (uint16_t)(((pixels & 3) | (pixels & 12) << 2) << shift);
    }
}

/* The coverage of the tile's blocks. Returns false if the triangle does not meet it. */
static bool scan_tile(const struct triangle_head *head, const struct rectangle *scissor, int column, int row,
                      uint16_t blocks[TILE_BLOCKS])
{
    struct raster raster;
    int32_t x = column * TILE_SIZE, y = row * TILE_SIZE;
    if (!raster_prepare(&raster, head, scissor))
        return false;
    const struct rectangle *b = &raster.bounds;
    int32_t y0 = b->y0 > y ? b->y0 : y, y1 = b->y1 < y + TILE_SIZE ? b->y1 : y + TILE_SIZE;
    int32_t x0 = b->x0 > x ? b->x0 : x, x1 = b->x1 < x + TILE_SIZE ? b->x1 : x + TILE_SIZE;
    if (x0 >= x1 || y0 >= y1)
        return false;
    struct side side[3] = {side_of(&raster, 0, y0), side_of(&raster, 1, y0), side_of(&raster, 2, y0)};
    memset(blocks, 0, TILE_BLOCKS * sizeof *blocks);
    for (int32_t at = y0; at < y1; at++) {
        int32_t from = x0, to = x1;
        for (int i = 0; i < 3; i++)
            take_side(&side[i], &from, &to);
        if (from < to)
            add_span(blocks, at - y, from - x, to - x);
    }
    return true;
}

/* As the renderer has them: blocks that are not empty, with their places. */
static uint32_t list_blocks(const uint16_t blocks[TILE_BLOCKS], int column, int row, struct entry *entries)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < TILE_BLOCKS; i++)
        if (blocks[i])
            entries[count++] = (struct entry){
                .x = (float)(column * TILE_SIZE + (int)(i % (TILE_SIZE / BLOCK_SIZE)) * BLOCK_SIZE),
                .y = (float)(row * TILE_SIZE + (int)(i / (TILE_SIZE / BLOCK_SIZE)) * BLOCK_SIZE),
                .coverage = blocks[i],
                .block = (uint16_t)i};
    return count;
}

static uint32_t scan(const struct triangle_head *head, const struct rectangle *scissor, int column, int row,
                     uint32_t triangle, struct entry *entries)
{
    uint16_t blocks[TILE_BLOCKS];
    (void)triangle;
    return scan_tile(head, scissor, column, row, blocks) ? list_blocks(blocks, column, row, entries) : 0;
}

/* --- Triangles --- */

static bool is_positive(const struct triangle_head *h)
{
    int64_t ax = h->x[1] - h->x[0], ay = h->y[1] - h->y[0], bx = h->x[2] - h->x[0], by = h->y[2] - h->y[0];
    return ax * by - ay * bx > 0;
}

/* A triangle with corners within `size` pixels, about the middle of the target's tile (1, 1). */
static struct triangle_head random_head(int32_t size)
{
    struct triangle_head head = {.visible = -1};
    int32_t x = between(64 * SUB, 128 * SUB), y = between(64 * SUB, 128 * SUB);
    do
        for (int i = 0; i < 3; i++) {
            head.x[i] = x + between(-size * SUB / 2, size * SUB / 2);
            head.y[i] = y + between(-size * SUB / 2, size * SUB / 2);
        }
    while (!is_positive(&head));
    return head;
}

static const struct rectangle whole = {0, 0, TARGET, TARGET};
static const int32_t sizes[] = {2, 4, 8, 16, 64, 256, 2048};

static void expect_the_same(const struct triangle_head *head, const struct rectangle *scissor)
{
    static struct entry expected[TILE_BLOCKS], got[TILE_BLOCKS];
    for (int tile = 0; tile < 9; tile++) {
        uint32_t count = raster_tile(head, scissor, tile % 3, tile / 3, 0, expected);
        TEST_ASSERT_EQUAL_UINT32(count, scan(head, scissor, tile % 3, tile / 3, 0, got));
        for (uint32_t i = 0; i < count; i++) {
            TEST_ASSERT_EQUAL_UINT16(expected[i].block, got[i].block);
            TEST_ASSERT_EQUAL_HEX16(expected[i].coverage, got[i].coverage);
            TEST_ASSERT_TRUE(expected[i].x == got[i].x && expected[i].y == got[i].y);
        }
    }
}

static void both_rasterizers_cover_the_same_pixels(void)
{
    unsigned count = test_share(4000);
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (unsigned i = 0; i < count; i++) {
            struct triangle_head head = random_head(sizes[s]);
            struct rectangle part = {between(40, 90), between(40, 90), between(91, 150), between(91, 150)};
            expect_the_same(&head, i % 2 ? &part : &whole);
        }
}

/* Edges that are horizontal, vertical or pass through centres. */
static void both_rasterizers_have_the_same_rule_of_edges(void)
{
    for (unsigned i = 0; i < test_share(20000); i++) {
        struct triangle_head head = {.visible = -1};
        do
            for (int k = 0; k < 3; k++) {
                head.x[k] = between(60, 140) * SUB + 128;
                head.y[k] = between(60, 140) * SUB + 128;
            }
        while (!is_positive(&head));
        if (i % 3 == 0)
            head.y[1] = head.y[0];
        if (i % 3 == 1)
            head.x[1] = head.x[0];
        if (is_positive(&head))
            expect_the_same(&head, &whole);
    }
}

/* --- Times --- */

static struct triangle_head heads[TRIANGLES];

/* Least ns for a triangle in the tile. */
static double time_of(raster_function *function)
{
    static struct entry entries[TILE_BLOCKS];
    double least = 1e30;
    for (int attempt = 0; attempt < 7; attempt++) {
        uint64_t begin = clock_ns();
        for (int i = 0; i < TRIANGLES; i++)
            function(heads + i, &whole, 1, 1, 0, entries);
        double ns = (double)(clock_ns() - begin) / TRIANGLES;
        least = ns < least ? ns : least;
    }
    return least;
}

static void times_are_measured_on_request(void)
{
    if (!getenv("MEASURE"))
        return;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        for (int i = 0; i < TRIANGLES; i++)
            heads[i] = random_head(sizes[s]);
        double lines = time_of(scan), spaces = time_of(raster_tile);
        printf("size %d scanline %.1f half-space %.1f\n", (int)sizes[s], lines, spaces);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(both_rasterizers_cover_the_same_pixels);
    RUN_TEST(both_rasterizers_have_the_same_rule_of_edges);
    RUN_TEST(times_are_measured_on_request);
    return UNITY_END();
}
