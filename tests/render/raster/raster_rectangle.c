/* Rectangles cover exactly the pixels whose centres are in their bounds and in the scissor rectangle. */
#include "render/raster/raster_part.h"

#include "base/random.h"
#include "tests/support/system/seed.h"

#include <string.h>
#include <unity.h>

enum { ROUNDS = 4000, RECORDS = 12, RECORD_BYTES = 64, PIXEL = 1 << SUBPIXEL_BITS };

static union {
    struct triangle_head head;
    uint8_t bytes[RECORD_BYTES];
} records[RECORDS];

static uint32_t offsets[RECORDS];
static struct entry entries[PIXEL_ENTRIES + 4];
static struct random source;

void setUp(void)
{
    source = random_start(test_seed(), 0);
    for (uint32_t i = 0; i < RECORDS; i++)
        offsets[i] = i * RECORD_BYTES;
}

void tearDown(void)
{
}

static int below(int count)
{
    return (int)random_below(&source, (uint32_t)count);
}

static void make_rectangle(struct triangle_head *head)
{
    int32_t x = below(80 * PIXEL) - 8 * PIXEL, y = below(80 * PIXEL) - 8 * PIXEL;
    int32_t most = below(4) ? 12 * PIXEL : 80 * PIXEL;
    memset(head, 0, sizeof *head);
    head->visible = HEAD_RECTANGLE;
    head->x[0] = head->x[2] = x;
    head->x[1] = x + 1 + below(most);
    head->y[0] = y;
    head->y[1] = head->y[2] = y + 1 + below(most);
}

static bool covers(const struct triangle_head *head, const struct rectangle *scissor, int32_t x, int32_t y)
{
    int32_t centre_x = x * PIXEL + PIXEL / 2, centre_y = y * PIXEL + PIXEL / 2;
    return centre_x >= head->x[0] && centre_x < head->x[1] && centre_y >= head->y[0] &&
           centre_y < head->y[1] && x >= scissor->x0 && x < scissor->x1 && y >= scissor->y0 &&
           y < scissor->y1;
}

/* The lanes of a block that the definition covers. */
static unsigned expected(const struct triangle_head *head, const struct rectangle *scissor, unsigned block)
{
    unsigned lanes = 0;
    for (unsigned lane = 0; lane < BLOCK_PIXELS; lane++) {
        int32_t x = (int32_t)(block % ROW_BLOCKS * BLOCK_SIZE + (lane & 1) + 2 * (lane >> 2 & 1));
        int32_t y = (int32_t)(block / ROW_BLOCKS * BLOCK_SIZE + (lane >> 1 & 1) + 2 * (lane >> 3 & 1));
        lanes |= (unsigned)covers(head, scissor, x, y) << lane;
    }
    return lanes;
}

/* Checks the entries of one record, and returns how many there are. */
static uint32_t check(uint32_t record, const struct rectangle *scissor, const struct entry *entry)
{
    uint32_t count = 0;
    for (unsigned block = 0; block < TILE_BLOCKS; block++) {
        unsigned lanes = expected(&records[record].head, scissor, block);
        if (!lanes)
            continue;
        TEST_ASSERT_EQUAL_UINT16(block, entry[count].block);
        TEST_ASSERT_EQUAL_HEX16(lanes, entry[count].coverage);
        TEST_ASSERT_EQUAL_UINT32(record * RECORD_BYTES, entry[count].triangle);
        TEST_ASSERT_EQUAL_FLOAT(block % ROW_BLOCKS * BLOCK_SIZE, entry[count].x);
        TEST_ASSERT_EQUAL_FLOAT(block / ROW_BLOCKS * BLOCK_SIZE, entry[count].y);
        count++;
    }
    return count;
}

static void blocks_have_the_pixels_of_their_bounds(void)
{
    for (unsigned round = 0; round < ROUNDS / test_stride() / RECORDS; round++) {
        struct rectangle scissor = {0, 0, TILE_SIZE, TILE_SIZE};
        struct raster_site site;
        uint32_t used = 3, at = 3;
        if (round & 1)
            scissor = (struct rectangle){below(40), below(40), 30 + below(34), 30 + below(34)};
        raster_enter(&site, &scissor, 0, 0);
        for (uint32_t i = 0; i < RECORDS; i++)
            make_rectangle(&records[i].head);
        uint32_t done = raster_rectangles(&site, records->bytes, offsets, RECORDS, entries, &used);
        for (uint32_t i = 0; i < done; i++)
            at += check(i, &scissor, entries + at);
        TEST_ASSERT_EQUAL_UINT32(at, used);
        TEST_ASSERT_TRUE(done == RECORDS || used > PIXEL_ENTRIES - TILE_BLOCKS);
    }
}

static void a_list_ends_before_the_entries_have_no_room(void)
{
    struct rectangle scissor = {0, 0, TILE_SIZE, TILE_SIZE};
    struct raster_site site;
    uint32_t used = 0;
    raster_enter(&site, &scissor, 0, 0);
    for (uint32_t i = 0; i < RECORDS; i++) {
        make_rectangle(&records[i].head);
        records[i].head.x[0] = records[i].head.y[0] = 0;
        records[i].head.x[1] = records[i].head.y[1] = TILE_SIZE * PIXEL;
        records[i].head.x[2] = 0, records[i].head.y[2] = TILE_SIZE * PIXEL;
    }
    TEST_ASSERT_EQUAL_UINT32(PIXEL_ENTRIES / TILE_BLOCKS,
                             raster_rectangles(&site, records->bytes, offsets, RECORDS, entries, &used));
    TEST_ASSERT_EQUAL_UINT32(PIXEL_ENTRIES, used);
    TEST_ASSERT_EQUAL_UINT32(0, raster_rectangles(&site, records->bytes, offsets, 1, entries, &used));
}

/* Both lists together are the entries of a rectangle; one has whole blocks only, which increase. */
static void whole_blocks_are_apart_if_there_are_enough(void)
{
    static struct entry whole[TILE_BLOCKS], rest[TILE_BLOCKS];
    unsigned divided = 0;
    for (unsigned round = 0; round < ROUNDS / test_stride(); round++) {
        struct rectangle scissor = {below(4), below(4), TILE_SIZE - below(4), TILE_SIZE - below(4)};
        struct raster_site site;
        uint32_t used = 0, left, least = 1 + (uint32_t)below(20), all = 0;
        raster_enter(&site, &scissor, 0, 0);
        make_rectangle(&records[0].head);
        raster_rectangles(&site, records->bytes, offsets, 1, entries, &used);
        uint32_t found = raster_divide_rectangle(&site, records->bytes, 0, least, whole, rest, &left);
        for (uint32_t i = 0; i < used; i++)
            all += entries[i].coverage == UINT16_MAX;
        TEST_ASSERT_EQUAL_UINT32(all, found);
        const uint32_t apart = found >= least ? found : 0;
        TEST_ASSERT_EQUAL_UINT32(used, apart + left);
        for (uint32_t i = 0, next = 0; i < used; i++) {
            const bool is_next = next < apart && whole[next].block == entries[i].block;
            const struct entry *same = is_next ? &whole[next++] : rest;
            while (!is_next && same < rest + left && same->block != entries[i].block)
                same++;
            TEST_ASSERT_TRUE(is_next || same < rest + left);
            TEST_ASSERT_EQUAL_MEMORY(&entries[i], same, sizeof *same);
        }
        divided += apart && left;
    }
    TEST_ASSERT_GREATER_THAN(ROUNDS / test_stride() / 8, divided);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(blocks_have_the_pixels_of_their_bounds);
    RUN_TEST(whole_blocks_are_apart_if_there_are_enough);
    RUN_TEST(a_list_ends_before_the_entries_have_no_room);
    return UNITY_END();
}
