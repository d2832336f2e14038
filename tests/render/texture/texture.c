/* Texture objects: the positions of levels, faces and slices in memory, updates of parts, mip levels,
 * refusals, and the order of updates and draws. */
#include "tests/support/blit/mips.h"

#include "render/texture/texture.h"
#include "tests/support/picture/canvas.h"

#include <math.h>
#include <stdio.h>
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

static enum triptych_result make(enum triptych_texture_type type, enum triptych_surface_format format,
                                 unsigned width, unsigned height, unsigned depth, unsigned levels)
{
    const struct triptych_texture_description description = {type, format, width, height, depth, levels};
    if (texture)
        texture_destroy(texture);
    error_clear(&reason);
    return texture_create(&description, false, &texture, &reason);
}

#define MAKE(...) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, make(__VA_ARGS__), reason.text)

/* --- Layout --- */

static void test_levels_halve_down_to_one_texel(void)
{
    static const int sizes[][3] = {{20, 5, 1}, {10, 2, 1}, {5, 1, 1}, {2, 1, 1}, {1, 1, 1}};
    MAKE(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 20, 5, 1, 0);
    TEST_ASSERT_EQUAL_UINT(5, texture->levels);
    int offset = 0;
    for (unsigned i = 0; i < 5; i++) {
        const struct texture_level *level = &texture->level[i];
        TEST_ASSERT_EQUAL_INT_ARRAY(sizes[i], ((int[]){level->width, level->height, level->depth}), 3);
        TEST_ASSERT_EQUAL_INT(offset, level->offset);
        TEST_ASSERT_EQUAL_INT(level->width + 1, level->pitch);
        TEST_ASSERT_EQUAL_INT(level->pitch * level->height, level->slice_texels);
        offset += (sizes[i][0] + 1) * sizes[i][1];
    }
    TEST_ASSERT_EQUAL_UINT(offset, texture->face_texels);
}

/* Rows of less than 128 texels have one more than they need; others end where a cache line of words does. */
static void test_rows_of_wide_levels_begin_at_cache_lines(void)
{
    static const int widths[] = {255, 127}, pitches[] = {256, 128};
    static const unsigned sizes[][2] = {{128, 144}, {1023, 1024}, {1024, 1040}, {1025, 1040}};
    MAKE(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 255, 1, 1, 0);
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL_INT(widths[i], texture->level[i].width);
        TEST_ASSERT_EQUAL_INT(pitches[i], texture->level[i].pitch);
    }
    for (unsigned i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        texture_destroy(texture);
        texture = NULL;
        MAKE(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, sizes[i][0], 2, 1, 1);
        TEST_ASSERT_EQUAL_INT(sizes[i][1], texture->level[0].pitch);
        TEST_ASSERT_EQUAL_INT(2 * sizes[i][1], texture->level[0].slice_texels);
    }
}

static void test_faces_follow_one_another_with_all_their_levels(void)
{
    MAKE(TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_R32F, 8, 8, 1, 2);
    TEST_ASSERT_EQUAL_UINT(6, texture->faces);
    TEST_ASSERT_EQUAL_UINT(72 + 20, texture->face_texels);
    TEST_ASSERT_EQUAL_PTR(texture->texels + 4 * (5 * 92 + 72), texture_level_texels(texture, 5, 1));
}

static void test_a_volume_halves_its_depth_too(void)
{
    MAKE(TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_L8, 4, 2, 9, 0);
    TEST_ASSERT_EQUAL_UINT(4, texture->levels);
    TEST_ASSERT_EQUAL_INT(4, texture->level[1].depth);
    TEST_ASSERT_EQUAL_INT(1, texture->level[3].depth);
    TEST_ASSERT_EQUAL_UINT(5 * 2 * 9 + 3 * 1 * 4 + 2 * 2 + 2, texture->face_texels);
}

static void test_contents_start_as_zeros_of_the_format(void)
{
    MAKE(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_X8R8G8B8, 3, 5, 1, 0);
    for (uint32_t i = 0; i < texture->face_texels; i++)
        TEST_ASSERT_EQUAL_HEX32(0xff000000, texture->texels[i]);
    MAKE(TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_DXT5, 5, 5, 1, 0);
    for (uint32_t i = 0; i < 6 * texture->face_texels; i++)
        TEST_ASSERT_EQUAL_HEX32(0, texture->texels[i]);
    MAKE(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_V8U8, 3, 1, 1, 1);
    static const float expected[4] = {0, 0, 1, 1};
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_MEMORY(expected, texture->texels + 4 * i, sizeof expected);
}

/* A face of 8x8 texels in rows: 9 a row. */
static void test_texels_of_one_or_two_bytes_take_that_memory(void)
{
    static const struct {
        enum triptych_surface_format format;
        size_t bytes;
    } cases[] = {{TRIPTYCH_SURFACE_A8, 1},   {TRIPTYCH_SURFACE_L8, 1},   {TRIPTYCH_SURFACE_R8, 1},
                 {TRIPTYCH_SURFACE_A8L8, 2}, {TRIPTYCH_SURFACE_R8G8, 2}, {TRIPTYCH_SURFACE_A8R8G8B8, 4},
                 {TRIPTYCH_SURFACE_A4L4, 4}, {TRIPTYCH_SURFACE_L16, 16}};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        MAKE(TRIPTYCH_TEXTURE_2D, cases[i].format, 8, 8, 1, 1);
        TEST_ASSERT_EQUAL_UINT64(72 * cases[i].bytes, texture_storage_bytes(texture));
        const uint8_t *first = texture_level_texels(texture, 0, 0);
        struct texture_image image = texture_slice(texture, 0, 0, 0);
        TEST_ASSERT_EQUAL_PTR(first + (9 * 2 + 3) * cases[i].bytes, texture_texel(&image, 3, 2));
    }
}

/* --- Refusals --- */

static void test_bad_descriptions_are_refused_with_a_reason(void)
{
    static const struct {
        struct triptych_texture_description description;
        enum triptych_result result;
        const char *reason;
    } cases[] = {
        {{3, TRIPTYCH_SURFACE_L8, 1, 1, 1, 1}, TRIPTYCH_BAD_ARGUMENT, "texture type 3"},
        {{0, 0, 1, 1, 1, 1}, TRIPTYCH_BAD_ARGUMENT, "format 0: expected one of Direct3D 9's"},
        {{0, TRIPTYCH_SURFACE_P8, 1, 1, 1, 1}, TRIPTYCH_UNSUPPORTED, "format P8 is not supported"},
        {{0, TRIPTYCH_SURFACE_D32F_LOCKABLE, 1, 1, 1, 1}, TRIPTYCH_UNSUPPORTED, "D32F_LOCKABLE"},
        {{1, TRIPTYCH_SURFACE_D16, 8, 8, 1, 1}, TRIPTYCH_BAD_ARGUMENT, "format D16 for a cube texture"},
        {{0, TRIPTYCH_SURFACE_L8, 0, 1, 1, 1}, TRIPTYCH_BAD_ARGUMENT, "0 x 1 texels: expected 1 to 8192"},
        {{0, TRIPTYCH_SURFACE_L8, 1, 8193, 1, 1}, TRIPTYCH_BAD_ARGUMENT, "1 x 8193 texels"},
        {{2, TRIPTYCH_SURFACE_L8, 2049, 1, 1, 1}, TRIPTYCH_BAD_ARGUMENT, "expected 1 to 2048 a side"},
        {{2, TRIPTYCH_SURFACE_L8, 1, 1, 2049, 1}, TRIPTYCH_BAD_ARGUMENT, "depth 2049: expected 1 to 2048"},
        {{0, TRIPTYCH_SURFACE_L8, 1, 1, 2, 1}, TRIPTYCH_BAD_ARGUMENT, "2d texture of depth 2: expected 1"},
        {{1, TRIPTYCH_SURFACE_L8, 4, 2, 1, 1}, TRIPTYCH_BAD_ARGUMENT, "4 x 2 texels: expected a square"},
        {{0, TRIPTYCH_SURFACE_L8, 4, 2, 1, 4}, TRIPTYCH_BAD_ARGUMENT, "4 levels: expected at most 3"},
        {{2, TRIPTYCH_SURFACE_L8, 2048, 2048, 2048, 1}, TRIPTYCH_BAD_ARGUMENT, "34628173824 bytes"},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        error_clear(&reason);
        TEST_ASSERT_EQUAL_INT_MESSAGE(cases[i].result,
                                      texture_create(&cases[i].description, false, &texture, &reason),
                                      cases[i].reason);
        TEST_ASSERT_NULL(texture);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(reason.text, cases[i].reason), reason.text);
    }
}

static void refuse(unsigned face, unsigned level, struct triptych_box box, size_t row, size_t slice,
                   const char *part)
{
    error_clear(&reason);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          texture_check_update(texture, face, level, &box, row, slice, &reason));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(reason.text, part), reason.text);
}

static void test_bad_updates_are_refused_with_a_reason(void)
{
    MAKE(TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_L16, 8, 8, 4, 2);
    refuse(1, 0, (struct triptych_box){0, 0, 0, 8, 8, 4}, 16, 128,
           "face 1, level 0: expected 0 to 0, 0 to 1");
    refuse(0, 2, (struct triptych_box){0, 0, 0, 1, 1, 1}, 16, 128, "face 0, level 2");
    refuse(0, 1, (struct triptych_box){1, 0, 0, 4, 4, 2}, 16, 128, "a part of level 1's 4 x 4 x 2");
    refuse(0, 0, (struct triptych_box){0, 0, 0, 0, 1, 1}, 16, 128, "0 x 1 x 1 texels");
    refuse(0, 0, (struct triptych_box){UINT32_MAX, 0, 0, 2, 1, 1}, 16, 128, "expected a part");
    refuse(0, 0, (struct triptych_box){0, 0, 0, 8, 8, 4}, 15, 128, "at least 16 for a row");
    refuse(0, 0, (struct triptych_box){0, 0, 0, 8, 8, 4}, 16, 127, "8 rows for a slice");
    refuse(0, 0, (struct triptych_box){0, 0, 0, 8, 8, 4}, 0, 0, "at least 16");
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, texture_check_update(texture, 0, 1, NULL, 8, 32, &reason));
    MAKE(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_DXT1, 10, 10, 1, 0);
    refuse(0, 0, (struct triptych_box){2, 0, 0, 4, 4, 1}, 64, 0, "of whole 4x4 blocks");
    refuse(0, 0, (struct triptych_box){0, 0, 0, 4, 5, 1}, 64, 0, "of whole 4x4 blocks");
    struct triptych_box edge = {8, 4, 0, 2, 6, 1};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, texture_check_update(texture, 0, 0, &edge, 8, 0, &reason));
}

/* --- Changes --- */

static void test_an_update_changes_its_box_and_nothing_else(void)
{
    uint8_t data[4 * 40] = {0}; /* 3 x 2 x 2 texels of 1 byte, rows 5 and slices 20 bytes apart */
    MAKE(TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_A8, 8, 8, 6, 2);
    const struct triptych_box box = {1, 2, 1, 3, 2, 2};
    for (uint8_t i = 0; i < 40; i++)
        data[i] = (uint8_t)(i + 1);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, texture_check_update(texture, 0, 1, &box, 5, 20, &reason));
    texture_update(texture, 0, 1, &box, data, 5, 20);
    const uint8_t *first = texture_level_texels(texture, 0, 0), *level = texture_level_texels(texture, 0, 1);
    for (uint32_t i = 0; i < 9 * 8 * 6; i++)
        TEST_ASSERT_EQUAL_HEX8(0, first[i]);
    for (unsigned z = 0; z < 3; z++)
        for (unsigned y = 0; y < 4; y++)
            for (unsigned x = 0; x < 4; x++) {
                int inside = x >= 1 && y >= 2 && z >= 1;
                unsigned value = inside ? data[(z - 1) * 20 + (y - 2) * 5 + x - 1] : 0;
                TEST_ASSERT_EQUAL_HEX8(value, level[(z * 4 + y) * 5 + x]);
            }
}

/* --- Mip levels --- */

/* The definition by areas: returns the part of source texel j that is within target texel i, if n source
 * texels become m target texels. */
static double covered(unsigned i, unsigned j, unsigned n, unsigned m)
{
    double low = fmax((double)i * n / m, j), high = fmin((double)(i + 1) * n / m, j + 1);
    return fmax(high - low, 0) * m / n;
}

static double expected_mean(unsigned level, unsigned x, unsigned y, unsigned z, int c)
{
    const struct texture_level *from = &texture->level[level - 1], *to = &texture->level[level];
    const uint8_t *bytes = texture_level_texels(texture, 0, level - 1);
    const float *floats = (const float *)(const void *)bytes;
    double sum = 0;
    for (unsigned k = 0; k < (unsigned)from->depth; k++)
        for (unsigned j = 0; j < (unsigned)from->height; j++)
            for (unsigned i = 0; i < (unsigned)from->width; i++) {
                size_t at = 4 * ((k * (size_t)from->height + j) * (size_t)from->pitch + i) + (unsigned)c;
                double value = texture->format->storage == STORAGE_RGBA8 ? bytes[at] : (double)floats[at];
                sum += value * covered(x, i, (unsigned)from->width, (unsigned)to->width) *
                       covered(y, j, (unsigned)from->height, (unsigned)to->height) *
                       covered(z, k, (unsigned)from->depth, (unsigned)to->depth);
            }
    return sum;
}

static void check_mips(void)
{
    float *number = (float *)(void *)texture->texels;
    if (texture->format->storage == STORAGE_RGBA8)
        for (uint32_t i = 0; i < texture->face_texels; i++)
            texture->texels[i] = random_word();
    else
        for (uint32_t i = 0; i < 4 * texture->face_texels; i++)
            number[i] = (float)random_between(-4, 4);
    make_mips(texture);
    for (unsigned l = 1; l < texture->levels; l++) {
        const struct texture_level *to = &texture->level[l];
        const uint8_t *bytes = texture_level_texels(texture, 0, l);
        const float *floats = (const float *)(const void *)bytes;
        for (int i = 0; i < 4 * to->slice_texels * to->depth; i++) {
            int at = i / 4, y = at / to->pitch % to->height, z = at / to->slice_texels;
            int x = at % to->pitch % to->width;
            double mean = expected_mean(l, (unsigned)x, (unsigned)y, (unsigned)z, i % 4);
            if (texture->format->storage == STORAGE_RGBA8)
                TEST_ASSERT_DOUBLE_WITHIN(0.5 + 1e-9, mean, bytes[i]);
            else
                TEST_ASSERT_DOUBLE_WITHIN(1e-6, mean, floats[i]);
        }
    }
}

static void test_mips_are_means_by_area_whatever_the_size(void)
{
    static const unsigned sizes[][3] = {{16, 8, 1}, {7, 7, 1},  {13, 1, 1}, {1, 6, 1},
                                        {9, 10, 1}, {33, 2, 1}, {4, 6, 1},  {34, 12, 1}};
    for (unsigned i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int wide = 0; wide < 2; wide++) {
            MAKE(TRIPTYCH_TEXTURE_2D, wide ? TRIPTYCH_SURFACE_A32B32G32R32F : TRIPTYCH_SURFACE_A8R8G8B8,
                 sizes[i][0], sizes[i][1], 1, 0);
            check_mips();
        }
    MAKE(TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_A8R8G8B8, 5, 6, 7, 0);
    check_mips();
    MAKE(TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_A16B16G16R16F, 6, 3, 4, 0);
    check_mips();
}

/* --- Ends of rows --- */

static void expect_closed_rows(void)
{
    size_t bytes = format_texel_bytes(texture->format);
    for (unsigned face = 0; face < texture->faces; face++)
        for (unsigned l = 0; l < texture->levels; l++) {
            const struct texture_level *level = &texture->level[l];
            const uint8_t *row = texture_level_texels(texture, face, l);
            for (int y = 0; y < level->height * level->depth; y++, row += (size_t)level->pitch * bytes)
                TEST_ASSERT_EQUAL_MEMORY(row, row + (size_t)level->width * bytes, bytes);
        }
}

static void fill_randomly(uint8_t *data, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++)
        data[i] = (uint8_t)(random_word() % 61);
}

static void test_rows_end_with_their_first_texel_after_every_change(void)
{
    static const struct triptych_box box = {0, 1, 1, 2, 3, 2};
    static uint8_t data[8 * 6 * 4 * 16 * 2];
    for (int wide = 0; wide < 2; wide++) {
        enum triptych_surface_format format =
            wide ? TRIPTYCH_SURFACE_A32B32G32R32F : TRIPTYCH_SURFACE_A8R8G8B8;
        unsigned bytes = wide ? 16 : 4;
        MAKE(TRIPTYCH_TEXTURE_VOLUME, format, 8, 6, 4, 0);
        expect_closed_rows();
        fill_randomly(data, sizeof data);
        texture_update(texture, 0, 0, NULL, data, 8 * bytes, 8 * 6 * bytes);
        expect_closed_rows();
        texture_update(texture, 0, 0, &box, data + 64, 2 * bytes, 6 * bytes);
        expect_closed_rows();
        make_mips(texture);
        expect_closed_rows();
        TEST_ASSERT_TRUE(texture_texel_bytes(texture) <= sizeof data);
        texture_write_texels(texture, data);
        expect_closed_rows();
    }
}

static void test_texels_are_copied_without_the_ends(void)
{
    static uint8_t data[6 * (7 * 7 + 3 * 3 + 1) * 4], copy[sizeof data];
    MAKE(TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_A8R8G8B8, 7, 7, 1, 0);
    TEST_ASSERT_EQUAL_UINT(sizeof data, texture_texel_bytes(texture));
    fill_randomly(data, sizeof data);
    texture_write_texels(texture, data);
    texture_read_texels(texture, copy);
    TEST_ASSERT_EQUAL_MEMORY(data, copy, sizeof data);
    const uint32_t *face = texture_level_texels(texture, 5, 1);
    TEST_ASSERT_EQUAL_MEMORY(data + 4 * (5 * 59 + 49 + 3), face + 4, 12);
}

static void test_mips_round_halves_up_and_each_face_has_its_own(void)
{
    MAKE(TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_A8R8G8B8, 2, 2, 1, 0);
    for (unsigned face = 0; face < 6; face++) {
        uint32_t *texel = texture_level_texels(texture, face, 0);
        texel[0] = face + 1; /* the mean is (face + 1) / 4 */
        texel[1] = texel[3] = texel[4] = 0;
    }
    make_mips(texture);
    for (unsigned face = 0; face < 6; face++)
        TEST_ASSERT_EQUAL_HEX32((face + 3) / 4, *(uint32_t *)texture_level_texels(texture, face, 1));
}

/* --- Order --- */

/* Draws squares with the colour of one texel, which changes between draws that cover half the target each.
 * The device renders them only at the end, or earlier if the change requires it. */
static void check_order(void)
{
    const uint32_t before = 0xff112233, after = 0xff445566;
    triptych_texture *drawn, *other;
    OK(triptych_texture_create(device, &before, 1, 1, &drawn));
    OK(triptych_texture_create(device, &before, 1, 1, &other));
    OK(triptych_set_texture(device, 0, drawn));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
    clear_to(0);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_set_texture(device, 0, other)); /* unbound when it changes */
    OK(triptych_texture_update(device, drawn, 0, 0, NULL, &after, 4, 0));
    OK(triptych_set_texture(device, 0, drawn));
    extent = 0.5f;
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    extent = 1;
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(0, 0, before, "drawn before the change");
    expect_pixel(SIZE / 2, SIZE / 2, after, "drawn after the change");
}

static void test_draws_read_the_texels_of_the_time_of_their_recording(void)
{
    on_every_engine(check_order);
}

static void check_errors(void)
{
    const struct triptych_texture_description volume = {
        TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_P8, 1, 1, 1, 1};
    triptych_texture *made = (triptych_texture *)&made;
    uint32_t word = 0;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_UNSUPPORTED, triptych_texture_define(device, &volume, &made));
    TEST_ASSERT_NULL(made);
    TEST_ASSERT_EQUAL_STRING("format P8 is not supported for textures", triptych_error(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_texture_define(device, NULL, &made));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_texture_generate_mips(device, NULL));
    OK(triptych_texture_create(device, &word, 1, 1, &made));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_texture_update(device, made, 0, 0, NULL, NULL, 4, 0));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_texture_update(device, made, 0, 1, NULL, &word, 4, 0));
    OK(triptych_texture_generate_mips(device, made));
}

static void test_calls_that_fail_report_why(void)
{
    on_every_engine(check_errors);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_levels_halve_down_to_one_texel);
    RUN_TEST(test_rows_of_wide_levels_begin_at_cache_lines);
    RUN_TEST(test_faces_follow_one_another_with_all_their_levels);
    RUN_TEST(test_a_volume_halves_its_depth_too);
    RUN_TEST(test_contents_start_as_zeros_of_the_format);
    RUN_TEST(test_texels_of_one_or_two_bytes_take_that_memory);
    RUN_TEST(test_bad_descriptions_are_refused_with_a_reason);
    RUN_TEST(test_bad_updates_are_refused_with_a_reason);
    RUN_TEST(test_an_update_changes_its_box_and_nothing_else);
    RUN_TEST(test_mips_are_means_by_area_whatever_the_size);
    RUN_TEST(test_rows_end_with_their_first_texel_after_every_change);
    RUN_TEST(test_texels_are_copied_without_the_ends);
    RUN_TEST(test_mips_round_halves_up_and_each_face_has_its_own);
    RUN_TEST(test_draws_read_the_texels_of_the_time_of_their_recording);
    RUN_TEST(test_calls_that_fail_report_why);
    return UNITY_END();
}
