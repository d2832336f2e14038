/* Texture wrapping: coordinates are interpolated along the shorter way around, on whole and cut triangles,
 * lines and edges.
 *
 * The coordinates go from 7/8 to 1/8 over 64 pixels. The texture is 256 texels wide. With wrapping they go
 * forwards over 1/4 of the texture, one texel a pixel; without wrapping they go backwards over 3/4. */
#include "tests/support/picture/canvas.h"

#include <stdio.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

enum { WIDTH = 256 };
static uint32_t row[WIDTH];

static void bind_row(unsigned set)
{
    triptych_texture *texture;
    for (int i = 0; i < WIDTH; i++)
        row[i] = random_word() | 1; /* not the background */
    OK(triptych_texture_create(device, row, WIDTH, 1, &texture));
    OK(triptych_set_texture(device, 0, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
    OK(triptych_set_stage_state(device, 0, TRIPTYCH_STAGE_TEXCOORDINDEX, set));
}

static uint32_t expected_texel(int x, int wraps)
{
    return row[wraps ? (224 + x) % WIDTH : 223 - 3 * x - 1];
}

static void expect_columns(int first, int last, int wraps, const char *what)
{
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++) {
        int x = p % SIZE;
        if (x >= first && x < last)
            expect_pixel(x, p / SIZE, expected_texel(x, wraps), what);
        else
            expect_pixel(x, p / SIZE, 0, what);
    }
}

static void check_triangles(void)
{
    bind_row(0);
    for (uint32_t wrap = 0; wrap < 16; wrap++) {
        OK(triptych_set_state(device, TRIPTYCH_STATE_WRAP0, wrap));
        OK(triptych_set_state(device, TRIPTYCH_STATE_WRAP1, 15)); /* of another set */
        clear_to(0);
        draw_square(0.5f, 0, NULL, 0.875f, 0, 0.125f, 0);
        expect_columns(0, SIZE, wrap & 1, "a triangle");
    }
}

/* The same with the second coordinate. */
static void check_second_coordinate(void)
{
    triptych_texture *texture;
    bind_row(0);
    OK(triptych_texture_create(device, row, 1, WIDTH, &texture));
    OK(triptych_set_texture(device, 0, texture));
    for (uint32_t wrap = 0; wrap < 4; wrap++) {
        OK(triptych_set_state(device, TRIPTYCH_STATE_WRAP0, wrap));
        draw_square(0.5f, 0, NULL, 0, 0.875f, 0, 0.125f);
        OK(triptych_read_color(device, image, sizeof image));
        for (int p = 0; p < SIZE * SIZE; p++)
            expect_pixel(p % SIZE, p / SIZE, expected_texel(p / SIZE, wrap >> 1), "the second coordinate");
    }
}

/* If a plane cuts both triangles, the coordinates of the rest do not change. */
static void check_cut_triangles(void)
{
    static const float left[4] = {-1, 0, 0, 0}, right[4] = {1, 0, 0, 0.5f};
    bind_row(0);
    OK(triptych_set_state(device, TRIPTYCH_STATE_WRAP0, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CLIPPLANEENABLE, 3));
    OK(triptych_set_clip_plane(device, 0, left));
    OK(triptych_set_clip_plane(device, 1, right));
    clear_to(0);
    draw_square(0.5f, 0, NULL, 0.875f, 0, 0.125f, 0);
    expect_columns(SIZE / 4, SIZE / 2, 1, "a triangle that is cut");
}

static const enum triptych_state wraps[16] = {
    TRIPTYCH_STATE_WRAP0,  TRIPTYCH_STATE_WRAP1,  TRIPTYCH_STATE_WRAP2,  TRIPTYCH_STATE_WRAP3,
    TRIPTYCH_STATE_WRAP4,  TRIPTYCH_STATE_WRAP5,  TRIPTYCH_STATE_WRAP6,  TRIPTYCH_STATE_WRAP7,
    TRIPTYCH_STATE_WRAP8,  TRIPTYCH_STATE_WRAP9,  TRIPTYCH_STATE_WRAP10, TRIPTYCH_STATE_WRAP11,
    TRIPTYCH_STATE_WRAP12, TRIPTYCH_STATE_WRAP13, TRIPTYCH_STATE_WRAP14, TRIPTYCH_STATE_WRAP15};

/* The whole target with the coordinates in another set. */
static void draw_with_set(unsigned set)
{
    static const float vertex[4][4] = {
        {-1, 1, 0.875f, 0}, {1, 1, 0.125f, 0}, {-1, -1, 0.875f, 0}, {1, -1, 0.125f, 0}};
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    struct triptych_element element = {TRIPTYCH_FORMAT_FLOAT2, buffer, 0, sizeof vertex[0]};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &element));
    element.offset = 2 * sizeof(float);
    OK(triptych_set_element(device, (enum triptych_attribute)(TRIPTYCH_TEXCOORD + set), &element));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
}

/* Each set has its state. */
static void check_sets(void)
{
    for (unsigned set = 0; set < 8; set++) {
        bind_row(set);
        for (unsigned i = 0; i < 8; i++) {
            clear_to(0);
            OK(triptych_set_state(device, wraps[i], 1));
            draw_with_set(set);
            OK(triptych_set_state(device, wraps[i], 0));
            expect_columns(0, SIZE, i == set, "a set");
        }
    }
}

/* Sets that vertices do not have change nothing. */
static void check_further_sets(void)
{
    bind_row(0);
    for (int i = 8; i < 16; i++)
        OK(triptych_set_state(device, wraps[i], 15));
    clear_to(0);
    draw_square(0.5f, 0, NULL, 0.875f, 0, 0.125f, 0);
    expect_columns(0, SIZE, 0, "wrap8 to wrap15");
}

static void check_outlines(void)
{
    bind_row(0);
    OK(triptych_set_state(device, TRIPTYCH_STATE_WRAP0, 1));
    set(TRIPTYCH_STATE_FILLMODE, "wireframe");
    clear_to(0);
    draw_square(0.5f, 0, NULL, 0.875f, 0, 0.125f, 0);
    OK(triptych_read_color(device, image, sizeof image));
    for (int x = 0, drawn = 0; x < SIZE; x++) {
        uint32_t word = image[(SIZE - 1) * SIZE + x];
        drawn += word != 0;
        if (word)
            expect_pixel(x, SIZE - 1, expected_texel(x, 1), "an edge");
        TEST_ASSERT_GREATER_OR_EQUAL_INT(x, drawn);
    }
}

/* Draws the upper and lower side of the square as lines. They are half as long as the target, so that the 64
 * texels have half a pixel each. */
static void check_lines(void)
{
    triptych_texture *texture;
    int drawn = 0;
    bind_row(0);
    OK(triptych_texture_create(device, row, 64, 1, &texture));
    OK(triptych_set_texture(device, 0, texture));
    OK(triptych_set_state(device, TRIPTYCH_STATE_WRAP0, 1));
    extent = 0.5f;
    draw_square(0.5f, 0, NULL, 0.875f, 0, 0.125f, 0);
    extent = 1;
    clear_to(0);
    OK(triptych_draw(device, TRIPTYCH_LINE_LIST, 0, 2));
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++) {
        int x = p % SIZE;
        if (!image[p])
            continue;
        expect_pixel(x, p / SIZE, row[(56 + (x - SIZE / 4) / 2) % 64], "a line");
        drawn++;
    }
    TEST_ASSERT_INT_WITHIN(2, SIZE, drawn);
}

static void test_triangles(void)
{
    on_every_engine(check_triangles);
}

static void test_the_second_coordinate(void)
{
    on_every_engine(check_second_coordinate);
}

static void test_triangles_that_are_cut(void)
{
    on_every_engine(check_cut_triangles);
}

static void test_each_set(void)
{
    on_every_engine(check_sets);
}

static void test_sets_that_vertices_do_not_have(void)
{
    on_every_engine(check_further_sets);
}

static void test_edges(void)
{
    on_every_engine(check_outlines);
}

static void test_lines(void)
{
    on_every_engine(check_lines);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_triangles);
    RUN_TEST(test_the_second_coordinate);
    RUN_TEST(test_triangles_that_are_cut);
    RUN_TEST(test_each_set);
    RUN_TEST(test_sets_that_vertices_do_not_have);
    RUN_TEST(test_edges);
    RUN_TEST(test_lines);
    return UNITY_END();
}
