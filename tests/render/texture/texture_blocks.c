/* Texels in their own format: the bytes of updates come back, also from compressed textures, whose other
 * texels are compressed. */
#include "tests/support/blit/mips.h"

#include "render/texture/texture.h"
#include "tests/support/picture/canvas.h"

#include <stdlib.h>
#include <string.h>

static struct triptych_texture *texture;
static struct error reason;

void setUp(void)
{
    texture = NULL;
    error_clear(&reason);
}

void tearDown(void)
{
    if (texture)
        texture_destroy(texture);
    close_canvas();
}

static void make(enum triptych_texture_type type, enum triptych_surface_format format, unsigned width,
                 unsigned height, unsigned depth)
{
    const struct triptych_texture_description description = {type, format, width, height, depth, 0};
    if (texture)
        texture_destroy(texture);
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, texture_create(&description, false, &texture, &reason),
                                  reason.text);
}

static void fill_random(uint8_t *data, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++)
        data[i] = (uint8_t)random_word();
}

static const enum triptych_surface_format compressed[] = {
    TRIPTYCH_SURFACE_DXT1, TRIPTYCH_SURFACE_DXT2, TRIPTYCH_SURFACE_DXT3, TRIPTYCH_SURFACE_DXT4,
    TRIPTYCH_SURFACE_DXT5, TRIPTYCH_SURFACE_ATI1, TRIPTYCH_SURFACE_ATI2};

enum { COMPRESSED = sizeof compressed / sizeof *compressed };

/* --- Blocks as they were given --- */

/* Levels of 20 x 12 down to 1 x 1. Most have blocks that are cut. */
static void test_blocks_of_updates_come_back(void)
{
    for (int f = 0; f < COMPRESSED; f++) {
        uint8_t data[5][5 * 3 * 16], back[sizeof data[0]];
        make(TRIPTYCH_TEXTURE_2D, compressed[f], 20, 12, 1);
        for (unsigned level = 0; level < 5; level++) {
            size_t row = texture_row_bytes(texture->format, (uint32_t)texture->level[level].width);
            fill_random(data[level], sizeof data[level]);
            texture_update(texture, 0, level, NULL, data[level], row, 0);
        }
        for (unsigned level = 0; level < 5; level++) {
            size_t row = texture_row_bytes(texture->format, (uint32_t)texture->level[level].width);
            texture_read(texture, 0, level, NULL, back, row, 0);
            TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(data[level], back, texture_level_bytes(texture, level),
                                                 texture->format->name);
        }
    }
}

static void test_parts_of_faces_and_slices_come_back_with_their_pitches(void)
{
    const struct triptych_box box = {4, 4, 1, 8, 4, 2};
    uint8_t data[2 * 100], back[2 * 100], zeros[16];
    fill_random(data, sizeof data);
    make(TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_DXT5, 16, 8, 4);
    texture_update(texture, 0, 0, &box, data, 40, 100);
    memset(back, 0x5a, sizeof back);
    texture_read(texture, 0, 0, &box, back, 40, 100);
    for (unsigned z = 0; z < 2; z++) {
        TEST_ASSERT_EQUAL_HEX8_ARRAY(data + 100 * z, back + 100 * z, 32);
        TEST_ASSERT_EACH_EQUAL_HEX8(0x5a, back + 100 * z + 32, 68);
    }
    texture_read(texture, 0, 0, &(struct triptych_box){0, 0, 1, 4, 4, 1}, zeros, 16, 0);
    TEST_ASSERT_EACH_EQUAL_HEX8(0, zeros, 16);
    make(TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_DXT1, 4, 4, 1);
    for (unsigned face = 0; face < 6; face++)
        texture_update(texture, face, 1, NULL, data + 8 * face, 8, 0);
    for (unsigned face = 0; face < 6; face++) {
        texture_read(texture, face, 1, NULL, back, 8, 0);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(data + 8 * face, back, 8);
        texture_read(texture, face, 0, NULL, back, 8, 0);
        TEST_ASSERT_EACH_EQUAL_HEX8(0, back, 8);
    }
}

static void test_uncompressed_parts_come_back(void)
{
    const struct triptych_box box = {1, 2, 1, 3, 2, 2};
    uint8_t data[4 * 20], back[4 * 20];
    fill_random(data, sizeof data);
    memset(back, 0x5a, sizeof back);
    make(TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_R5G6B5, 8, 8, 4);
    texture_update(texture, 0, 0, &box, data, 10, 40);
    texture_read(texture, 0, 0, &box, back, 10, 40);
    for (unsigned z = 0; z < 2; z++)
        for (unsigned y = 0; y < 2; y++) {
            TEST_ASSERT_EQUAL_HEX8_ARRAY(data + 40 * z + 10 * y, back + 40 * z + 10 * y, 6);
            TEST_ASSERT_EACH_EQUAL_HEX8(0x5a, back + 40 * z + 10 * y + 6, 4);
        }
}

/* --- Blocks that are made --- */

static void encode_and_decode(enum triptych_surface_format format, const uint32_t texels[16],
                              uint32_t decoded[16])
{
    uint8_t block[16], again[16];
    format_encode(format_find(format), texels, 4, 4, 4, block, 0);
    format_encode(format_find(format), texels, 4, 4, 4, again, 0);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(block, again, format_find(format)->bytes);
    format_decode(format_find(format), block, 0, 4, 4, decoded, 4);
}

static void test_two_colors_of_565_are_compressed_without_loss(void)
{
    for (int n = 0; n < 200; n++) {
        uint16_t pair[2] = {(uint16_t)random_word(), (uint16_t)random_word()};
        uint32_t color[2], texels[16], decoded[16], pattern = random_word();
        format_decode(format_find(TRIPTYCH_SURFACE_R5G6B5), pair, 0, 2, 1, color, 2);
        for (int i = 0; i < 16; i++)
            texels[i] = color[pattern >> i & 1];
        for (int f = 0; f < 5; f++) {
            encode_and_decode(compressed[f], texels, decoded);
            TEST_ASSERT_EQUAL_HEX32_ARRAY(texels, decoded, 16);
        }
    }
}

static void test_transparent_texels_stay_transparent_in_dxt1(void)
{
    uint32_t texels[16], decoded[16];
    for (int i = 0; i < 16; i++)
        texels[i] = i % 3 ? 0xff0000ff : 0x00ff00ff;
    encode_and_decode(TRIPTYCH_SURFACE_DXT1, texels, decoded);
    for (int i = 0; i < 16; i++)
        TEST_ASSERT_EQUAL_HEX32(i % 3 ? 0xff0000ff : 0, decoded[i]);
    memset(texels, 0, sizeof texels);
    encode_and_decode(TRIPTYCH_SURFACE_DXT1, texels, decoded);
    TEST_ASSERT_EACH_EQUAL_HEX32(0, decoded, 16);
}

static int difference(uint32_t a, uint32_t b)
{
    int most = 0;
    for (int c = 0; c < 4; c++) {
        int d = (int)(a >> 8 * c & 255) - (int)(b >> 8 * c & 255);
        most = d > most ? d : -d > most ? -d : most;
    }
    return most;
}

/* Four steps are 21 apart along a ramp of 64, and eight steps of alpha 18 along a ramp of 128. Red and green
 * of the second ramp grow in opposite directions. */
static void test_ramps_are_compressed_to_the_nearest_step(void)
{
    for (int opposite = 0; opposite < 2; opposite++) {
        uint32_t texels[16], decoded[16];
        for (uint32_t i = 0; i < 16; i++) {
            uint32_t green = opposite ? 164 - 4 * i : 100 + 4 * i;
            texels[i] = (60 + 8 * i) << 24 | 50u << 16 | green << 8 | (100 + 4 * i);
        }
        encode_and_decode(TRIPTYCH_SURFACE_DXT5, texels, decoded);
        for (int i = 0; i < 16; i++)
            TEST_ASSERT_LESS_OR_EQUAL_INT(15, difference(texels[i], decoded[i]));
        encode_and_decode(TRIPTYCH_SURFACE_DXT3, texels, decoded);
        for (int i = 0; i < 16; i++)
            TEST_ASSERT_LESS_OR_EQUAL_INT(15, difference(texels[i], decoded[i]));
    }
}

static void test_values_of_0_and_255_have_codes_of_their_own(void)
{
    uint32_t texels[16], decoded[16];
    for (uint32_t i = 0; i < 16; i++) {
        static const uint32_t values[4] = {0, 100, 105, 255};
        texels[i] = 0xff000000 | values[i % 4] * 0x010101u;
    }
    encode_and_decode(TRIPTYCH_SURFACE_ATI1, texels, decoded);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(texels, decoded, 16);
}

static void test_computed_levels_are_compressed_when_they_are_read(void)
{
    uint8_t data[4 * 8], back[8];
    for (unsigned i = 0; i < 4; i++)
        memcpy(data + 8 * i, (const uint8_t[8]){0x00, 0xf8, 0, 0, 0, 0, 0, 0}, 8);
    make(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_DXT1, 8, 8, 1);
    texture_update(texture, 0, 0, NULL, data, 16, 0);
    make_mips(texture);
    for (unsigned level = 1; level < 4; level++) {
        uint32_t decoded[16];
        texture_read(texture, 0, level, NULL, back, 8, 0);
        format_decode(texture->format, back, 0, 4, 4, decoded, 4);
        TEST_ASSERT_EACH_EQUAL_HEX32(0xff0000ff, decoded, 16);
    }
    uint8_t first[4 * 8];
    texture_read(texture, 0, 0, NULL, first, 16, 0);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, first, sizeof data);
}

/* An update of one block of a level whose blocks are stale: the others belong to the texels. */
static void test_an_update_of_a_computed_level_keeps_its_other_texels(void)
{
    uint32_t texels[64], decoded[64];
    uint8_t back[4 * 8];
    const uint8_t block[8] = {0xe0, 0x07, 0, 0, 0x44, 0, 0, 0};
    make(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_DXT1, 8, 8, 1);
    uint32_t *all = calloc(1, texture_texel_bytes(texture));
    for (int i = 0; i < 64; i++)
        all[i] = 0xffff0000;
    texture_write_texels(texture, all);
    free(all);
    texture_update(texture, 0, 0, &(struct triptych_box){4, 0, 0, 4, 4, 1}, block, 8, 0);
    texture_read(texture, 0, 0, NULL, back, 16, 0);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(block, back + 8, 8);
    format_decode(texture->format, back, 16, 8, 8, decoded, 8);
    for (int i = 0; i < 64; i++)
        texels[i] = texture->texels[i / 8 * 9 + i % 8];
    TEST_ASSERT_EQUAL_HEX32_ARRAY(texels, decoded, 64);
    TEST_ASSERT_EQUAL_HEX32(0xffff0000, decoded[0]);
}

/* --- The interface --- */

static void read_back(void)
{
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_DXT3, 8, 8, 1, 1};
    triptych_texture *made;
    uint8_t data[64], back[64];
    fill_random(data, sizeof data);
    OK(triptych_texture_define(device, &description, &made));
    OK(triptych_texture_update(device, made, 0, 0, NULL, data, 32, 0));
    OK(triptych_texture_read(device, made, 0, 0, NULL, back, 32, 0));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, back, 64);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_texture_read(device, made, 0, 1, NULL, back, 32, 0));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_texture_read(device, made, 0, 0, NULL, back, 31, 0));
    TEST_ASSERT_EQUAL_INT(
        TRIPTYCH_BAD_ARGUMENT,
        triptych_texture_read(device, made, 0, 0, &(struct triptych_box){2, 0, 0, 4, 4, 1}, back, 32, 0));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_texture_read(device, NULL, 0, 0, NULL, back, 32, 0));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_texture_read(device, made, 0, 0, NULL, NULL, 32, 0));
}

static void read_drawn(void)
{
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_R5G6B5, 8, 8, 1, 1};
    triptych_texture *made;
    uint16_t back[64];
    OK(triptych_texture_define(device, &description, &made));
    OK(triptych_set_target_surfaces(device,
                                    &(struct triptych_target_surfaces){.color = {{made, 0, 0, NULL}}}));
    OK(triptych_clear(device, (const float[4]){1, 0, 1, 1}, -1));
    OK(triptych_texture_read(device, made, 0, 0, NULL, back, 16, 0));
    for (int i = 0; i < 64; i++)
        TEST_ASSERT_EQUAL_HEX16(0xf81f, back[i]);
}

static void test_the_interface_reads_what_was_updated_and_refuses_other_parts(void)
{
    on_every_engine(read_back);
}

static void test_texels_that_were_drawn_are_read(void)
{
    on_every_engine(read_drawn);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_blocks_of_updates_come_back);
    RUN_TEST(test_parts_of_faces_and_slices_come_back_with_their_pitches);
    RUN_TEST(test_uncompressed_parts_come_back);
    RUN_TEST(test_two_colors_of_565_are_compressed_without_loss);
    RUN_TEST(test_transparent_texels_stay_transparent_in_dxt1);
    RUN_TEST(test_ramps_are_compressed_to_the_nearest_step);
    RUN_TEST(test_values_of_0_and_255_have_codes_of_their_own);
    RUN_TEST(test_computed_levels_are_compressed_when_they_are_read);
    RUN_TEST(test_an_update_of_a_computed_level_keeps_its_other_texels);
    RUN_TEST(test_the_interface_reads_what_was_updated_and_refuses_other_parts);
    RUN_TEST(test_texels_that_were_drawn_are_read);
    return UNITY_END();
}
