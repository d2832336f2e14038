/* The bits that triangles have in bins. */
#include "render/geometry/bin.h"

#include <string.h>
#include <unity.h>

enum { COLUMNS = 8, ROWS = 8, STRIDE = 128, SIDE = 16 };

static struct arena arena;
static struct bin_writer writer;
static struct routine routine;
static struct draw draw;
static struct error error;

/* A draw with one varying of one plane, whose class allows steps along neither axis. */
void setUp(void)
{
    TEST_ASSERT_EQUAL(0, arena_create(&arena, ARENA_BYTES, &error));
    memset(&routine, 0, sizeof routine);
    routine.key.pixel.varying[VARYING_fog] = INTERPOLATION_SMOOTH;
    draw = (struct draw){.scissor = {0, 0, COLUMNS * TILE_SIZE, ROWS * TILE_SIZE},
                         .stride = STRIDE,
                         .shape = SHAPE_TRIANGLE,
                         .span = SPAN_LEVEL,
                         .span_narrowest = SPAN_LEVEL,
                         .span_widest = SPAN_LEVEL,
                         .span_extent = SIDE};
    draw.routine[UNIT_PIXEL] = &routine;
    bin_begin_round(&writer, &arena, COLUMNS, ROWS, 31);
    bin_begin_chunk(&writer, 0);
}

void tearDown(void)
{
    bin_end_chunk(&writer);
    arena_destroy(&arena);
}

/* Writes a right triangle with its corner at (x, y), and its varying's step along x. */
static void put(uint32_t number, int x, int y, int width, int height, float step)
{
    const int32_t one = 1 << SUBPIXEL_BITS;
    struct triangle_head head = {.visible = -1,
                                 .x = {x * one, (x + width) * one, x * one},
                                 .y = {y * one, y * one, (y + height) * one}};
    uint8_t *record = bin_reserve(&writer, (number + 1) * STRIDE) + number * STRIDE;
    struct triangle_layout layout = layout_of_pixel(&routine.key.pixel);
    struct plane constant = {1, 0, 0}, plane = {1, step, 0};
    memset(record, 0, STRIDE);
    memcpy(record, &head, sizeof head);
    memcpy(record + layout.reciprocal_w, &constant, sizeof constant);
    if (routine.key.pixel.varying[VARYING_fog])
        memcpy(record + layout.varying[VARYING_fog], &plane, sizeof plane);
}

/* The bits of the tile's first triangle, which are those of its cell too. */
static uint32_t bits_of(uint32_t tile)
{
    const struct bin_cell *cell = bin_cell(&arena, writer.open[tile]);
    TEST_ASSERT_TRUE(writer.open[tile]);
    TEST_ASSERT_EQUAL(1, cell->count);
    TEST_ASSERT_EQUAL(cell->bits, cell->triangle[0] & BIN_BITS);
    return cell->bits;
}

static void test_large_triangles_of_the_class_have_the_bit_of_spans(void)
{
    const uint32_t row = COLUMNS;
    put(0, 0, 0, SIDE, 2 * SIDE, 0);
    put(1, TILE_SIZE, 0, SIDE - 1, 2 * SIDE, 0);
    put(2, 2 * TILE_SIZE, 0, 2 * SIDE, SIDE - 1, 0);
    put(3, 3 * TILE_SIZE, 0, SIDE, 2 * SIDE, 1);
    put(4, 0, TILE_SIZE, TILE_SIZE + SIDE, SIDE, 0);
    put(5, 4 * TILE_SIZE, 0, SIDE, SIDE, 0); /* its area is less than that of enough blocks' centres */
    TEST_ASSERT_EQUAL(6, bin_records(&writer, 6, &draw));
    TEST_ASSERT_EQUAL(BIN_SPANS, bits_of(0));
    TEST_ASSERT_EQUAL(0, bits_of(1));
    TEST_ASSERT_EQUAL(0, bits_of(2));
    TEST_ASSERT_EQUAL(0, bits_of(3));
    TEST_ASSERT_EQUAL(0, bits_of(4));
    TEST_ASSERT_EQUAL(BIN_SPANS, bits_of(row));
    TEST_ASSERT_EQUAL(BIN_SPANS, bits_of(row + 1));
}

/* A triangle that the draw's reading does not have is counted for the first wider one. */
static void test_triangles_of_wider_readings_are_counted(void)
{
    enum { KINDS = 5 };
    static const enum span least[KINDS] = {SPAN_WHITE, SPAN_LEVEL, SPAN_GRADIENT, SPAN_FADE, SPAN_LEVEL};
    static const enum span most[KINDS] = {SPAN_FADE, SPAN_FADE, SPAN_FADE, SPAN_FADE, SPAN_LEVEL};
    const struct plane one = {1, 0, 0}, half = {0.5f, 0, 0}, varied = {0.5f, 0x1p-10f, -0x1p-10f};
    draw.counts_spans = true;
    draw.span_narrowest = SPAN_WHITE;
    draw.span_widest = SPAN_FADE;
    memset(routine.key.pixel.varying, 0, sizeof routine.key.pixel.varying);
    routine.key.pixel.varying[VARYING_diffuse] = INTERPOLATION_SMOOTH;
    const struct triangle_layout layout = layout_of_pixel(&routine.key.pixel);
    for (unsigned span = SPAN_NONE; span < SPAN_COUNT; span++) {
        draw.span = (uint8_t)span;
        draw.counts_spans = span < SPAN_FADE;
        bin_end_chunk(&writer);
        bin_begin_chunk(&writer, span);
        for (uint32_t i = 0; i < KINDS; i++) {
            put(i, (int)i * TILE_SIZE, 0, SIDE, 2 * SIDE, 0);
            uint8_t *record = bin_reserve(&writer, KINDS * STRIDE) + i * STRIDE;
            const struct plane wide = {i == 4 ? 2.0f : 1.0f, 0, 0};
            memcpy(record + layout.reciprocal_w, &wide, sizeof one);
            for (unsigned c = 0; c < 4; c++)
                memcpy(record + layout.varying[VARYING_diffuse] + c * sizeof one,
                       i == 3 || (i == 2 && c < 3) ? &varied
                       : i == 1 && c == 2          ? &half
                                                   : &one,
                       sizeof one);
        }
        TEST_ASSERT_EQUAL(KINDS, bin_records(&writer, KINDS, &draw));
        for (unsigned i = 0; i < KINDS; i++) {
            unsigned bits = span >= least[i] && span <= most[i] ? BIN_SPANS
                            : span < least[i]                   ? BIN_READING * least[i]
                                                                : 0;
            TEST_ASSERT_EQUAL(bits, bits_of(i));
        }
    }
}

static void test_only_what_the_scissor_leaves_counts_as_large(void)
{
    put(0, 0, 0, SIDE, 2 * SIDE, 0);
    draw.scissor.x1 = SIDE - 1;
    TEST_ASSERT_EQUAL(1, bin_records(&writer, 1, &draw));
    TEST_ASSERT_EQUAL(0, bits_of(0));
}

static void test_a_draw_without_spans_has_no_bits_of_them(void)
{
    draw.span_extent = 0;
    put(0, 0, 0, SIDE, 2 * SIDE, 0);
    TEST_ASSERT_EQUAL(1, bin_records(&writer, 1, &draw));
    TEST_ASSERT_EQUAL(0, bits_of(0));
}

/* Two halves become a record with a bit in all tiles that it meets; without the setting they stay apart. */
static void test_pairs_of_triangles_have_the_bit_of_rectangles(void)
{
    const int32_t low = 32 << SUBPIXEL_BITS, high = 96 << SUBPIXEL_BITS;
    draw.span_extent = 0;
    draw.pairs = (struct pair_form){.bytes = sizeof(struct triangle_head)};
    for (int joins = 0; joins < 2; joins++) {
        put(0, 32, 32, 64, 64, 0);
        put(1, 32, 32, 64, 64, 0);
        struct triangle_head *other =
            (struct triangle_head *)(void *)(bin_reserve(&writer, 2 * STRIDE) + STRIDE);
        *other = (struct triangle_head){.visible = -1, .x = {high, high, low}, .y = {low, high, high}};
        writer.joins = joins;
        TEST_ASSERT_EQUAL(2, bin_records(&writer, 2, &draw));
        TEST_ASSERT_EQUAL(joins, writer.joined);
        for (uint32_t tile = 0; tile < 2 && joins; tile++) {
            TEST_ASSERT_EQUAL(BIN_RECTANGLE, bits_of(tile));
            TEST_ASSERT_EQUAL(BIN_RECTANGLE, bits_of(tile + COLUMNS));
        }
        if (!joins)
            TEST_ASSERT_EQUAL(0, bin_cell(&arena, writer.open[0])->bits);
        bin_end_chunk(&writer);
        bin_begin_chunk(&writer, 1);
    }
}

static void test_a_triangle_that_covers_a_tile_has_both_bits(void)
{
    put(0, 0, 0, 3 * TILE_SIZE, 3 * TILE_SIZE, 0);
    TEST_ASSERT_EQUAL(1, bin_records(&writer, 1, &draw));
    TEST_ASSERT_EQUAL(BIN_COVERS | BIN_SPANS, bits_of(0));
    TEST_ASSERT_EQUAL(BIN_SPANS, bits_of(2));
    TEST_ASSERT_TRUE(bin_covers(&arena, writer.open[0]));
    TEST_ASSERT_FALSE(bin_covers(&arena, writer.open[2]));
}

static void test_wide_triangles_have_the_bits_in_each_tile(void)
{
    struct bin_cell cell;
    put(0, 0, 0, COLUMNS * TILE_SIZE, ROWS * TILE_SIZE, 0);
    TEST_ASSERT_EQUAL(1, bin_records(&writer, 1, &draw));
    TEST_ASSERT_TRUE(writer.wide);
    bin_wide_cell(bin_wide(&arena, writer.wide), 0, 0, &cell);
    TEST_ASSERT_EQUAL(1, cell.count);
    TEST_ASSERT_EQUAL(BIN_COVERS | BIN_SPANS, cell.bits);
    bin_wide_cell(bin_wide(&arena, writer.wide), COLUMNS - 1, 0, &cell);
    TEST_ASSERT_EQUAL(BIN_SPANS, cell.bits);
}

/* Two wide triangles. Only the first of them covers the first tile. */
static void test_any_of_several_wide_triangles_covers_a_tile(void)
{
    struct bin_cell cell;
    put(0, 0, 0, COLUMNS * TILE_SIZE, ROWS * TILE_SIZE, 0);
    put(1, 1, 0, COLUMNS * TILE_SIZE, ROWS * TILE_SIZE, 0);
    TEST_ASSERT_EQUAL(2, bin_records(&writer, 2, &draw));
    const struct wide *wide = bin_wide(&arena, writer.wide);
    TEST_ASSERT_TRUE(bin_wide_covers(wide, 0, 0));
    for (uint32_t tile = 0; tile < COLUMNS * ROWS; tile++) {
        bin_wide_cell(wide, tile % COLUMNS, tile / COLUMNS, &cell);
        TEST_ASSERT_EQUAL(!!(cell.bits & BIN_COVERS), bin_wide_covers(wide, tile % COLUMNS, tile / COLUMNS));
    }
    TEST_ASSERT_FALSE(bin_wide_covers(wide, COLUMNS - 1, ROWS - 1));
}

/* Every tile of the target has a triangle; each band's chain has the tiles of its numbers. */
static void test_heads_are_in_the_chains_of_their_bands(void)
{
    const uint32_t tiles = COLUMNS * ROWS, shift = bin_band_shift(tiles), in_band = 1u << shift;
    bin_begin_round(&writer, &arena, COLUMNS, ROWS, shift);
    bin_begin_chunk(&writer, 3);
    for (uint32_t i = 0; i < tiles; i++)
        put(i, (int)(i % COLUMNS) * TILE_SIZE, (int)(i / COLUMNS) * TILE_SIZE, SIDE, SIDE, 0);
    TEST_ASSERT_EQUAL(tiles, bin_records(&writer, tiles, &draw));
    bin_end_chunk(&writer);
    TEST_ASSERT_EQUAL(tiles, writer.head_count);
    TEST_ASSERT_EQUAL(BIN_BANDS, writer.bands);
    for (uint32_t band = 0, tile; band < BIN_BANDS; band++) {
        uint32_t head = writer.heads[band];
        for (tile = (band + 1) * in_band; head; head = bin_cell(&arena, head)->sibling)
            TEST_ASSERT_EQUAL(--tile, bin_cell(&arena, head)->tile);
        TEST_ASSERT_EQUAL(band * in_band, tile);
    }
    TEST_ASSERT_EACH_EQUAL_UINT32(0, writer.open, tiles);
}

/* The number of the tile's triangles in the chunk, 0 or 1. */
static uint32_t is_in(uint32_t tile)
{
    return writer.open[tile] ? bin_cell(&arena, writer.open[tile])->count : 0;
}

/* Bins the first of `count` records, the others being invisible, in a chunk of its own. Returns a bit for
 * each tile that has it. */
static uint64_t tiles_of_first(uint32_t count, int x, int y, int width, int height, int kept)
{
    uint64_t tiles = 0;
    bin_end_chunk(&writer);
    bin_begin_chunk(&writer, 0);
    for (uint32_t i = 0; i < count; i++) {
        put(i, x, y, width, height, 0);
        if (i)
            memset(arena.base + writer.at + i * STRIDE, 0, sizeof(int32_t));
    }
    TEST_ASSERT_EQUAL(kept, bin_records(&writer, count, &draw));
    for (uint32_t tile = 0; tile < COLUMNS * ROWS; tile++)
        tiles |= (uint64_t)is_in(tile) << tile;
    return tiles;
}

static void test_a_record_by_itself_is_binned_as_one_in_a_group(void)
{
    const int small = SIDE / 2, outside = COLUMNS * TILE_SIZE;
    const struct {
        int x, y, width, height, kept;
        uint64_t tiles;
    } cases[] = {{5, 5, small, small, 1, 1},
                 {5, 5, SIDE, SIDE, 1, 1},
                 {TILE_SIZE - 4, 5, small, small, 1, 3},
                 {5, TILE_SIZE - 4, small, small, 1, 1 | 1 << COLUMNS},
                 {outside, 5, small, small, 0, 0},
                 {3 * TILE_SIZE + 5, 5, small, small, 1, 8}};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++)
        for (uint32_t count = 1; count <= 2; count++)
            TEST_ASSERT_EQUAL_HEX64(cases[i].tiles,
                                    tiles_of_first(count, cases[i].x, cases[i].y, cases[i].width,
                                                   cases[i].height, cases[i].kept));
}

static void test_an_invisible_record_by_itself_is_dropped(void)
{
    put(0, 5, 5, SIDE, SIDE, 0);
    memset(arena.base + writer.at, 0, sizeof(int32_t));
    const uint32_t at = writer.at;
    TEST_ASSERT_EQUAL(0, bin_records(&writer, 1, &draw));
    TEST_ASSERT_EQUAL(at, writer.at);
    TEST_ASSERT_EQUAL(0, writer.head_count);
}

/* Tiles of a range that is one tile high or wide have the triangle, also if it is too low to cover one. */
static void test_a_triangle_along_a_row_of_tiles_is_in_all_that_it_touches(void)
{
    struct entry entries[TILE_BLOCKS];
    for (int x = 0; x < 2 * TILE_SIZE; x += 7)
        for (int width = 3; width < 4 * TILE_SIZE; width += 29) {
            const uint64_t found = tiles_of_first(1, x, 5, width, TILE_SIZE / 2, 1);
            const uint8_t *record =
                arena.base + (bin_cell(&arena, writer.heads[0])->triangle[0] & ~(uint32_t)BIN_BITS);
            for (int tile = 0; tile < COLUMNS; tile++) {
                const struct triangle_head *head = (const struct triangle_head *)(const void *)record;
                const uint32_t blocks = raster_tile(head, &draw.scissor, tile, 0, 0, entries);
                TEST_ASSERT_TRUE(!blocks || found >> tile & 1);
            }
        }
}

static void test_a_triangle_that_covers_a_tile_of_a_row_has_the_bit(void)
{
    put(0, 0, 0, 20 * TILE_SIZE, 20 * TILE_SIZE, 0);
    draw.scissor = (struct rectangle){5, 0, 3 * TILE_SIZE, TILE_SIZE};
    TEST_ASSERT_EQUAL(1, bin_records(&writer, 1, &draw));
    TEST_ASSERT_EQUAL(BIN_SPANS, bits_of(0));
    TEST_ASSERT_EQUAL(BIN_COVERS | BIN_SPANS, bits_of(1));
}

static void test_shifts_of_bands_are_the_least(void)
{
    TEST_ASSERT_EQUAL(0, bin_band_shift(1));
    TEST_ASSERT_EQUAL(0, bin_band_shift(BIN_BANDS));
    TEST_ASSERT_EQUAL(1, bin_band_shift(BIN_BANDS + 1));
    TEST_ASSERT_EQUAL(10, bin_band_shift(TARGET_TILES_MAXIMUM));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_large_triangles_of_the_class_have_the_bit_of_spans);
    RUN_TEST(test_triangles_of_wider_readings_are_counted);
    RUN_TEST(test_only_what_the_scissor_leaves_counts_as_large);
    RUN_TEST(test_a_draw_without_spans_has_no_bits_of_them);
    RUN_TEST(test_pairs_of_triangles_have_the_bit_of_rectangles);
    RUN_TEST(test_a_triangle_that_covers_a_tile_has_both_bits);
    RUN_TEST(test_wide_triangles_have_the_bits_in_each_tile);
    RUN_TEST(test_any_of_several_wide_triangles_covers_a_tile);
    RUN_TEST(test_heads_are_in_the_chains_of_their_bands);
    RUN_TEST(test_a_record_by_itself_is_binned_as_one_in_a_group);
    RUN_TEST(test_an_invisible_record_by_itself_is_dropped);
    RUN_TEST(test_a_triangle_along_a_row_of_tiles_is_in_all_that_it_touches);
    RUN_TEST(test_a_triangle_that_covers_a_tile_of_a_row_has_the_bit);
    RUN_TEST(test_shifts_of_bands_are_the_least);
    return UNITY_END();
}
