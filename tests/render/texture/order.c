/* Orders of texels: the numbers of texels in tiles, and that a texture in tiles holds what the same texture
 * in rows holds, whatever is done with it. */
#include "tests/support/blit/mips.h"

#include "render/texture/texture.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { ROWS, TILES, ORDERS };

static struct triptych_texture *texture[ORDERS];
static struct error reason;
static uint64_t seed = 1;

static uint32_t random_word(void)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (uint32_t)(seed * 0x2545f4914f6cdd1dull >> 32);
}

static uint32_t below(uint32_t limit)
{
    return random_word() % limit;
}

void setUp(void)
{
    error_clear(&reason);
}

static void destroy(void)
{
    for (int i = 0; i < ORDERS; i++)
        if (texture[i])
            texture_destroy(texture[i]);
    memset(texture, 0, sizeof texture);
}

void tearDown(void)
{
    destroy();
}

static void make(enum triptych_texture_type type, enum triptych_surface_format format, unsigned width,
                 unsigned height, unsigned depth, unsigned levels)
{
    const struct triptych_texture_description description = {type, format, width, height, depth, levels};
    destroy();
    for (int i = 0; i < ORDERS; i++)
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            TRIPTYCH_OK, texture_create(&description, i == TILES, &texture[i], &reason), reason.text);
    TEST_ASSERT_FALSE(texture[ROWS]->tiled);
    TEST_ASSERT_TRUE(texture[TILES]->tiled);
}

/* --- Numbers of texels --- */

/* Counts the texels tile by tile, and row by row within a tile. */
static void test_a_slice_is_rows_of_tiles_of_rows(void)
{
    make(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 10, 7, 1, 1);
    struct texture_image image = texture_slice(texture[TILES], 0, 0, 0);
    TEST_ASSERT_EQUAL_INT(12, texture[TILES]->level[0].pitch);
    TEST_ASSERT_EQUAL_INT(12 * 8, texture[TILES]->level[0].slice_texels);
    size_t number = 0;
    for (size_t row = 0; row < 8; row += 4)
        for (size_t column = 0; column < 12; column += 4)
            for (size_t i = 0; i < 16; i++)
                TEST_ASSERT_EQUAL_UINT64(number++, texture_index(&image, column + i % 4, row + i / 4));
}

static void test_a_tile_of_bytes_is_a_line_of_the_cache(void)
{
    make(TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_A8R8G8B8, 9, 9, 1, 0);
    for (unsigned face = 0; face < 6; face++)
        for (unsigned level = 0; level < texture[TILES]->levels; level++) {
            struct texture_image image = texture_slice(texture[TILES], face, level, 0);
            uintptr_t first = (uintptr_t)texture_texel(&image, 0, 0),
                      last = (uintptr_t)texture_texel(&image, 3, 3);
            TEST_ASSERT_EQUAL_UINT64(0, first % 64);
            TEST_ASSERT_EQUAL_UINT64(first + 60, last);
        }
}

/* A texture whose rows fit, but whose tiles would not: 2048 x 65 x 2000 texels of 16 bytes, 68 rows in tiles.
 * Only its description is made. */
static void test_a_texture_that_is_too_large_in_tiles_stays_in_rows(void)
{
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_A32B32G32R32F, 2048, 65, 2000, 1};
    struct triptych_texture rows, tiles;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, texture_describe(&description, &rows, &reason));
    tiles = rows;
    texture_order_tiles(&tiles);
    TEST_ASSERT_FALSE(tiles.tiled);
    TEST_ASSERT_EQUAL_UINT(rows.face_texels, tiles.face_texels);
    TEST_ASSERT_EQUAL_MEMORY(rows.level, tiles.level, sizeof rows.level);
}

/* --- The same texels --- */

static void expect_same_texels(void)
{
    size_t bytes = texture_texel_bytes(texture[ROWS]);
    uint8_t *texels[ORDERS];
    for (int i = 0; i < ORDERS; i++) {
        texels[i] = malloc(bytes);
        texture_read_texels(texture[i], texels[i]);
    }
    TEST_ASSERT_EQUAL_MEMORY(texels[ROWS], texels[TILES], bytes);
    texture_write_texels(texture[TILES], texels[ROWS]);
    texture_read_texels(texture[TILES], texels[TILES]);
    TEST_ASSERT_EQUAL_MEMORY(texels[ROWS], texels[TILES], bytes);
    for (int i = 0; i < ORDERS; i++)
        free(texels[i]);
}

static uint32_t part_of(uint32_t size, uint32_t side, uint32_t *first)
{
    *first = below(size) / side * side;
    uint32_t count = 1 + below(size - *first);
    uint32_t whole = (count + side - 1) / side * side;
    return *first + whole < size ? whole : size - *first;
}

/* Updates a random part of a level of both, and reads one back. */
static void update_and_read(void)
{
    static uint8_t data[1 << 18], read[ORDERS][1 << 18];
    const struct triptych_texture *t = texture[ROWS];
    unsigned face = below(t->faces), level = below(t->levels), side = t->format->side;
    struct triptych_box whole = texture_whole_level(t, level), box;
    box.width = part_of(whole.width, side, &box.x);
    box.height = part_of(whole.height, side, &box.y);
    box.depth = part_of(whole.depth, 1, &box.z);
    size_t row = texture_row_bytes(t->format, box.width) + 3;
    size_t slice = row * format_blocks(t->format, box.height) + 5;
    TEST_ASSERT_TRUE(slice * box.depth <= sizeof data);
    for (size_t i = 0; i < slice * box.depth; i++)
        data[i] = (uint8_t)(random_word() % 61);
    for (int i = 0; i < ORDERS; i++) {
        texture_update(texture[i], face, level, &box, data, row, slice);
        memset(read[i], 0, slice * box.depth);
        texture_read(texture[i], face, level, &box, read[i], row, slice);
    }
    TEST_ASSERT_EQUAL_MEMORY(read[ROWS], read[TILES], slice * box.depth);
}

static void check_updates(enum triptych_texture_type type, enum triptych_surface_format format,
                          unsigned width, unsigned height, unsigned depth)
{
    make(type, format, width, height, depth, 0);
    expect_same_texels();
    for (int i = 0; i < 12; i++) {
        update_and_read();
        expect_same_texels();
    }
    for (int i = 0; i < ORDERS; i++)
        make_mips(texture[i]);
    expect_same_texels();
    for (int i = 0; i < ORDERS; i++)
        texture_set_order(texture[i], i == ROWS);
    TEST_ASSERT_TRUE(texture[ROWS]->tiled);
    TEST_ASSERT_FALSE(texture[TILES]->tiled);
    expect_same_texels();
}

static void test_updates_reads_and_mips_are_the_same_in_both_orders(void)
{
    static const enum triptych_surface_format formats[] = {
        TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_R5G6B5, TRIPTYCH_SURFACE_A32B32G32R32F,
        TRIPTYCH_SURFACE_DXT1,     TRIPTYCH_SURFACE_DXT5,   TRIPTYCH_SURFACE_A8,
        TRIPTYCH_SURFACE_A8L8};
    for (unsigned i = 0; i < sizeof formats / sizeof *formats; i++) {
        check_updates(TRIPTYCH_TEXTURE_2D, formats[i], 1 + below(150), 1 + below(40), 1);
        check_updates(TRIPTYCH_TEXTURE_2D, formats[i], 64, 64, 1);
        check_updates(TRIPTYCH_TEXTURE_CUBE, formats[i], 37, 37, 1);
        check_updates(TRIPTYCH_TEXTURE_VOLUME, formats[i], 19, 9, 7);
    }
}

/* A part of a row, at any place and of any length. */
static void test_parts_of_rows_are_read_and_written(void)
{
    make(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 23, 9, 1, 1);
    struct texture_image image = texture_slice(texture[TILES], 0, 0, 0);
    for (int round = 0; round < 200; round++) {
        uint32_t x = below(23), y = below(9), count = below(24 - x), row[23], back[23], before[23];
        texture_read_row(&image, 0, y, 23, before);
        for (uint32_t i = 0; i < count; i++)
            row[i] = before[x + i] = random_word();
        texture_write_row(&image, x, y, count, row);
        texture_read_row(&image, x, y, count, back);
        if (count)
            TEST_ASSERT_EQUAL_HEX32_ARRAY(row, back, count);
        texture_read_row(&image, 0, y, 23, back);
        TEST_ASSERT_EQUAL_HEX32_ARRAY(before, back, 23);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_slice_is_rows_of_tiles_of_rows);
    RUN_TEST(test_a_tile_of_bytes_is_a_line_of_the_cache);
    RUN_TEST(test_a_texture_that_is_too_large_in_tiles_stays_in_rows);
    RUN_TEST(test_updates_reads_and_mips_are_the_same_in_both_orders);
    RUN_TEST(test_parts_of_rows_are_read_and_written);
    return UNITY_END();
}
