/* Moves within an attachment, compared with a copy of all its pixels: any distance, even and odd rows,
 * tiles that only remember a clear, one plane and four, depth, both orders of memory. */
#include "tests/render/target/pixels.h"
#include "tests/support/system/seed.h"

enum {
    TILES_ACROSS = (WIDTH + TILE_SIZE - 1) / TILE_SIZE,
    TILES_DOWN = (HEIGHT + TILE_SIZE - 1) / TILE_SIZE
};

static uint32_t before[HEIGHT][WIDTH][4];

void setUp(void)
{
    error_clear(&reason);
    seed = test_seed();
}

void tearDown(void)
{
    drop(&pixels);
    drop(&other);
    quad_rows = false;
}

static void read_all(uint32_t row[HEIGHT][WIDTH][4])
{
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++)
            pixels_read_row(&pixels, x, y, 1, row[y][x]);
}

/* Makes some tiles remember a value for all their pixels instead of having words. */
static void clear_some_tiles(void)
{
    for (uint32_t tile = 0; tile < TILES_ACROSS * TILES_DOWN; tile++) {
        if (random_word() % 3)
            continue;
        struct attachment *a = pixels.tiles;
        if (a->format)
            a->color_clear[tile] = (struct color_clear){.word = {1, 2, 3, 4}, .pending = true};
        else
            a->depth_clear[tile] = (struct depth_clear){.word = 7, .pending = true};
    }
}

static void move_and_compare(const struct triptych_rectangle *from, const struct triptych_rectangle *to)
{
    uint32_t words = pixels_words(&pixels);
    read_all(before);
    TEST_ASSERT_TRUE(pixels_move(&pixels, from, to));
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            uint32_t now[4], right = x - to->x, down = y - to->y;
            bool moved = right < to->width && down < to->height;
            const uint32_t *expected = moved ? before[from->y + down][from->x + right] : before[y][x];
            pixels_read_row(&pixels, x, y, 1, now);
            TEST_ASSERT_EQUAL_HEX32_ARRAY(expected, now, words);
        }
}

static uint32_t any(uint32_t count, uint32_t unit)
{
    return random_word() % (count / unit + 1) * unit;
}

/* A rectangle and its new place; in units of a block, or any. */
static void move_somewhere(uint32_t unit)
{
    struct triptych_rectangle from = {.width = any(WIDTH - unit, unit) + unit,
                                      .height = 1 + any(HEIGHT - 1, 1)};
    struct triptych_rectangle to = from;
    from.x = any(WIDTH - from.width, unit);
    to.x = random_word() % 3 ? from.x : any(WIDTH - from.width, unit);
    from.y = any(HEIGHT - from.height, 1);
    to.y = random_word() % 4 ? any(HEIGHT - from.height, 1) : from.y;
    clear_some_tiles();
    move_and_compare(&from, &to);
}

static void move_often(void)
{
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(&pixels, &reason));
    fill_random(&pixels);
    for (unsigned i = 0; i < test_share(60); i++)
        move_somewhere(i % 3 ? BLOCK_SIZE : 1);
}

static void a_part_moves_to_any_place(void)
{
    for (int order = 0; order < 2; order++) {
        quad_rows = order;
        for (int n = 0; n < 4; n++) {
            make_color(&pixels, drawn[n], 1);
            move_often();
        }
        make_depth(&pixels, TRIPTYCH_DEPTH_D24S8);
        move_often();
    }
}

static void rows_move_up_and_down_by_a_few(void)
{
    make_color(&pixels, TRIPTYCH_SURFACE_A8R8G8B8, 1);
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(&pixels, &reason));
    fill_random(&pixels);
    for (uint32_t step = 1; step < 10; step++)
        for (int up = 0; up < 2; up++) {
            struct triptych_rectangle low = {4, 5, 100, 40}, high = {4, 5 + step, 100, 40};
            move_and_compare(up ? &high : &low, up ? &low : &high);
        }
}

static void other_copies_are_refused(void)
{
    const struct triptych_rectangle part = {0, 0, 8, 8}, larger = {8, 8, 9, 8};
    make_color(&pixels, TRIPTYCH_SURFACE_A8R8G8B8, 1);
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(&pixels, &reason));
    TEST_ASSERT_FALSE(pixels_move(&pixels, &part, &larger));
    make_texels(&pixels, TRIPTYCH_SURFACE_A8R8G8B8);
    TEST_ASSERT_FALSE(pixels_move(&pixels, &part, &part));
    make_color(&pixels, TRIPTYCH_SURFACE_A8R8G8B8, 4);
    TEST_ASSERT_FALSE(pixels_move(&pixels, &part, &part));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_part_moves_to_any_place);
    RUN_TEST(rows_move_up_and_down_by_a_few);
    RUN_TEST(other_copies_are_refused);
    return UNITY_END();
}
