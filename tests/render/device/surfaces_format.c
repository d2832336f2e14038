/* Formats of surfaces: copies to them, fills, and rectangles of them with rows in either order. */
#include "tests/render/device/surface.h"

static const struct triptych_surface the_target;

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static void copy_to_other_formats(void)
{
    triptych_texture *grey = make(TRIPTYCH_SURFACE_L8), *alpha = make(TRIPTYCH_SURFACE_A8),
                     *deep = make(TRIPTYCH_SURFACE_L16), *blocks = make(TRIPTYCH_SURFACE_DXT1);
    triptych_texture *const textures[] = {grey, alpha, deep, blocks};
    clear_to(0x80402010); /* alpha 0x80, blue 0x40 */
    for (int i = 0; i < 4; i++) {
        const struct triptych_surface to = of_texture(textures[i]);
        OK(triptych_copy(device, &the_target, NULL, &to, NULL, TRIPTYCH_COPY_LINEAR));
    }
    OK(triptych_texture_read(device, grey, 0, 0, NULL, back, SIZE, 0));
    TEST_ASSERT_EACH_EQUAL_HEX8(0x10, back, SIZE * SIZE);
    OK(triptych_texture_read(device, alpha, 0, 0, NULL, back, SIZE, 0));
    TEST_ASSERT_EACH_EQUAL_HEX8(0x80, back, SIZE * SIZE);
    OK(triptych_texture_read(device, deep, 0, 0, NULL, back, 2 * SIZE, 0));
    TEST_ASSERT_EACH_EQUAL_HEX16(0x1010, back, SIZE * SIZE);
    OK(triptych_read_surface(device, &(struct triptych_surface){.texture = blocks}, image, sizeof image));
    TEST_ASSERT_EACH_EQUAL_HEX32(0xff422010, image, SIZE * SIZE); /* blue 0x40 is 8 / 31 */
}

static void test_copies_go_to_formats_that_are_not_drawn_to(void)
{
    on_every_engine(copy_to_other_formats);
}

/* Blocks that are not written keep their bytes, and those that are written belong to the texels. */
static void write_compressed(void)
{
    triptych_texture *texture = make(TRIPTYCH_SURFACE_DXT5);
    const struct triptych_surface surface = of_texture(texture);
    const struct triptych_rectangle blocks = {4, 8, 8, 4}, pixels = {6, 9, 1, 1}, odd = {5, 8, 4, 4};
    uint8_t data[32] = {0xff, 0xff, 0, 0, 0, 0, 0, 0, 0x1f}, read[32]; /* blue, then anything */
    for (unsigned i = 16; i < 32; i++)
        data[i] = (uint8_t)(i * 73 + 5);
    OK(triptych_write_rectangle(device, &surface, &blocks, 0, data, 32));
    OK(triptych_read_rectangle(device, &surface, &blocks, TRIPTYCH_SURFACE_DXT5, read, 32));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, read, 32);
    OK(triptych_fill(device, &surface, &pixels, (const float[4]){1, 0, 0, 1}));
    TEST_ASSERT_EQUAL_HEX32(0xffff0000, read_at(surface, 6, 9));
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, read_at(surface, 5, 9));
    OK(triptych_read_rectangle(device, &surface, &blocks, 0, read, 32));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data + 16, read + 16, 16);
    TEST_ASSERT_TRUE(memcmp(data, read, 16));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_read_rectangle(device, &surface, &odd, 0, read, 32));
    TEST_ASSERT_EQUAL_STRING("4 x 4 pixels at 5, 8 in format DXT5: expected whole 4x4 blocks",
                             triptych_error(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_read_rectangle(device, &surface, &blocks, 0, read, -32));
    TEST_ASSERT_EQUAL_STRING("pitch of -32 bytes for compressed texels: expected a positive one",
                             triptych_error(device));
}

/* Reads a part with the first row first and with the last one first. */
static void expect_turned(struct triptych_surface surface, const struct triptych_rectangle *part,
                          enum triptych_surface_format format, uint32_t down[SIZE][SIZE])
{
    static uint32_t up[SIZE][SIZE];
    memset(down, 0x5a, sizeof up);
    memset(up, 0x5a, sizeof up);
    OK(triptych_read_rectangle(device, &surface, part, format, down[0], sizeof *down));
    OK(triptych_read_rectangle(device, &surface, part, format, up[part->height - 1], -(ptrdiff_t)sizeof *up));
    for (unsigned y = 0; y < SIZE; y++)
        TEST_ASSERT_EQUAL_HEX32_ARRAY(down[y], up[y < part->height ? part->height - 1 - y : y], SIZE);
}

/* The second part has whole blocks. It ends with a part of a row of blocks. */
static const struct triptych_rectangle turned[] = {{2, 3, SIZE - 3, SIZE - 7}, {4, 8, 48, 37}};

static void read_upside_down(void)
{
    static uint32_t down[SIZE][SIZE];
    const struct triptych_surface surface = of_image(make_image(TRIPTYCH_SURFACE_A8R8G8B8, 0, 1));
    write_picture(surface);
    for (int i = 0; i < 2; i++) {
        const struct triptych_rectangle *part = turned + i;
        for (unsigned f = 0; f < 3; f++) {
            static const enum triptych_surface_format formats[] = {
                TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_X8R8G8B8, TRIPTYCH_SURFACE_A8B8G8R8};
            expect_turned(surface, part, formats[f], down);
            for (unsigned y = 0; y < part->height; y++)
                for (unsigned x = 0; x < part->width; x++) {
                    uint32_t word = color_at(part->x + x, part->y + y), red = word >> 16 & 255;
                    uint32_t turned_word = (word & 0xff00ff00) | (word & 255) << 16 | red;
                    TEST_ASSERT_EQUAL_HEX32(f == 2   ? turned_word
                                            : f == 1 ? word & 0xffffff
                                                     : word,
                                            down[y][x]);
                }
        }
    }
}

/* Tiles that are cleared, and one with a part that is not. */
static void read_cleared(void)
{
    static uint32_t down[SIZE][SIZE];
    const struct triptych_surface surface = of_image(make_image(TRIPTYCH_SURFACE_A8R8G8B8, 0, 1));
    const struct triptych_rectangle corner = {SIZE - 13, 10, 1, 2};
    OK(triptych_fill(device, &surface, NULL, (const float[4]){0, 0, 1, 1}));
    for (int drawn = 0; drawn < 2; drawn++) {
        if (drawn)
            OK(triptych_fill(device, &surface, &corner, (const float[4]){1, 0, 0, 1}));
        for (int i = 0; i < 2; i++) {
            expect_turned(surface, turned + i, TRIPTYCH_SURFACE_A8R8G8B8, down);
            for (unsigned y = 0; y < turned[i].height; y++)
                TEST_ASSERT_EQUAL_HEX32(drawn && (y + turned[i].y) / 2 == 5 ? 0xffff0000 : 0xff0000ff,
                                        down[y][corner.x - turned[i].x]);
        }
    }
}

static void test_a_negative_pitch_turns_the_rows_upside_down(void)
{
    on_every_engine(read_upside_down);
    on_every_engine(read_cleared);
}

static void test_compressed_surfaces_are_written_and_read_in_blocks_and_in_pixels(void)
{
    on_every_engine(write_compressed);
}

static void fill_all(void)
{
    const float color[4] = {0xad / 255.0f, 0xbe / 255.0f, 0xef / 255.0f, 0xde / 255.0f};
    const struct triptych_rectangle part = {4, 4, 4, 4};
    static const struct {
        enum triptych_surface_format format;
        uint32_t words[2];
    } cases[] = {{TRIPTYCH_SURFACE_A8R8G8B8, {0xdeadbeef, 0}},
                 {TRIPTYCH_SURFACE_R5G6B5, {0xadfd, 0}},
                 {TRIPTYCH_SURFACE_G16R16, {0xbebeadad, 0}},
                 {TRIPTYCH_SURFACE_A16B16G16R16, {0xbebeadad, 0xdedeefef}},
                 {TRIPTYCH_SURFACE_R16F, {0x396d, 0}},
                 {TRIPTYCH_SURFACE_A16B16G16R16F, {0x39f6396d, 0x3af73b7f}}};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct triptych_surface surface = of_image(make_image(cases[i].format, 0, 1));
        uint32_t words[2] = {0, 0}, outside[2] = {0, 0};
        OK(triptych_fill(device, &surface, &part, color));
        OK(triptych_read_rectangle(device, &surface, &(struct triptych_rectangle){7, 7, 1, 1}, 0, words, 8));
        OK(triptych_read_rectangle(device, &surface, &(struct triptych_rectangle){8, 7, 1, 1}, 0, outside,
                                   8));
        TEST_ASSERT_EQUAL_HEX32_ARRAY(cases[i].words, words, 2);
        TEST_ASSERT_TRUE(memcmp(words, outside, sizeof words));
        OK(triptych_fill(device, &surface, NULL, color));
        OK(triptych_read_rectangle(device, &surface, &(struct triptych_rectangle){63, 63, 1, 1}, 0, words,
                                   8));
        TEST_ASSERT_EQUAL_HEX32_ARRAY(cases[i].words, words, 2);
    }
}

static void test_a_fill_has_the_value_of_the_format(void)
{
    on_every_engine(fill_all);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_copies_go_to_formats_that_are_not_drawn_to);
    RUN_TEST(test_a_negative_pitch_turns_the_rows_upside_down);
    RUN_TEST(test_compressed_surfaces_are_written_and_read_in_blocks_and_in_pixels);
    RUN_TEST(test_a_fill_has_the_value_of_the_format);
    return UNITY_END();
}
