/* The whole renderer through the public interface, with the emulator: the pixels of draws, and their
 * order. */
#include "tests/render/device/screen.h"

#include <math.h>
#include <string.h>

void setUp(void)
{
    open_device(1);
}

void tearDown(void)
{
    close_device();
}

/* --- What is drawn --- */

static void a_new_target_is_zero_and_as_far_as_possible(void)
{
    read_image();
    for (int i = 0; i < SIZE * SIZE; i++) {
        TEST_ASSERT_EQUAL_HEX32(0, image[i]);
        TEST_ASSERT_EQUAL_FLOAT(1, depth[i]);
    }
}

static void a_rectangle_has_exactly_its_pixels(void)
{
    draw_rectangle(3, 5, 130, 77, 0.25f, RED_ARGB);
    read_image();
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            int inside = x >= 3 && x < 130 && y >= 5 && y < 77;
            TEST_ASSERT_EQUAL_HEX32(inside ? RED : 0, pixel(x, y));
            TEST_ASSERT_EQUAL_FLOAT(inside ? 0.25f : 1, depth[y * SIZE + x]);
        }
    struct triptych_statistics statistics;
    triptych_get_statistics(device, &statistics);
    TEST_ASSERT_EQUAL_UINT64(127 * 72, statistics.pixels_shaded);
}

/* The triangle is the lower left half of a square. It covers the pixels whose centres are below the diagonal,
 * or on it if the diagonal is a left edge. */
static void a_triangle_covers_half_of_its_square(void)
{
    struct vertex vertex[3] = {at(0, 0, 0, RED_ARGB), at(100, 100, 0, RED_ARGB), at(0, 100, 0, RED_ARGB)};
    draw_list(vertex, 1);
    read_image();
    uint32_t under = 100 * 99 / 2, red = count_color(RED);
    TEST_ASSERT_TRUE(red == under || red == under + 100);
}

static void a_gradient_has_the_right_value_at_every_pixel(void)
{
    struct vertex vertex[6] = {at(0, 0, 0, 0xff000000),     at(200, 0, 0, 0xffff0000),
                               at(0, 200, 1, 0xff0000ff),   at(200, 0, 0, 0xffff0000),
                               at(200, 200, 1, 0xffff00ff), at(0, 200, 1, 0xff0000ff)};
    draw_list(vertex, 2);
    read_image();
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            TEST_ASSERT_INT_WITHIN(1, (int)lrint((x + .5) * 255 / SIZE), pixel(x, y) & 255);
            TEST_ASSERT_INT_WITHIN(1, (int)lrint((y + .5) * 255 / SIZE), pixel(x, y) >> 16 & 255);
            TEST_ASSERT_FLOAT_WITHIN(1e-6f, (y + .5f) / SIZE, depth[y * SIZE + x]);
        }
}

/* Colour / w and 1/w are linear on the screen. Halfway between w = 1 and w = 3 on the screen is a quarter of
 * the way between the colours. */
static void interpolation_is_perspective_correct(void)
{
    struct vertex vertex[6] = {at(0, 0, 0, 0xff000000),     at(200, 0, 0, 0xffff0000),
                               at(0, 200, 0, 0xff000000),   at(200, 0, 0, 0xffff0000),
                               at(200, 200, 0, 0xffff0000), at(0, 200, 0, 0xff000000)};
    for (int i = 0; i < 6; i++)
        if (vertex[i].color == 0xffff0000)
            for (int c = 0; c < 4; c++)
                vertex[i].position[c] *= 3;
    draw_list(vertex, 2);
    read_image();
    for (int x = 0; x < SIZE; x++) {
        double s = (x + .5) / SIZE, expected = s / 3 / ((1 - s) + s / 3);
        TEST_ASSERT_INT_WITHIN(1, (int)lrint(expected * 255), pixel(x, 90) & 255);
    }
}

static void depth_decides_whatever_the_order(void)
{
    draw_rectangle(0, 0, 100, 100, 0.3f, RED_ARGB);
    draw_rectangle(50, 50, 150, 150, 0.6f, GREEN_ARGB);
    draw_rectangle(0, 0, 200, 200, 0.9f, 0xff0000ff);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(10000, count_color(RED));
    TEST_ASSERT_EQUAL_UINT32(7500, count_color(GREEN));
    TEST_ASSERT_EQUAL_UINT32(22500, count_color(BLUE));
}

static void later_draws_cover_earlier_ones(void)
{
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    for (int i = 0; i < 100; i++)
        draw_rectangle(10, 10, 90, 90, 0.5f, 0xff000000 | (uint32_t)i);
    draw_rectangle(10, 10, 90, 90, 0.5f, RED_ARGB);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(6400, count_color(RED));
}

static void strips_fans_and_indices_draw_the_same_square(void)
{
    static const uint16_t list[] = {9, 0, 1, 2, 1, 3, 2};
    static const uint32_t fan[] = {1000, 1001, 1003, 1002};
    struct vertex v[4] = {at(20, 20, 0, RED_ARGB), at(90, 20, 0, RED_ARGB), at(20, 90, 0, RED_ARGB),
                          at(90, 90, 0, RED_ARGB)};
    uint32_t expected[SIZE * SIZE];
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 3));
    bind(buffer_of(v, sizeof v));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    read_image();
    TEST_ASSERT_EQUAL_UINT32(4900, count_color(RED));
    memcpy(expected, image, sizeof expected);
    for (int i = 0; i < 2; i++) {
        OK(triptych_clear(device, (float[4]){0, 0, 0, 0}, 1));
        if (i == 0) {
            OK(triptych_set_indices(device, buffer_of(list, sizeof list), 16));
            OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 1, 2));
        } else {
            OK(triptych_set_indices(device, buffer_of(fan, sizeof fan), 32));
            OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_FAN, -1000, 0, 2));
        }
        read_image();
        TEST_ASSERT_EQUAL_MEMORY(expected, image, sizeof image);
    }
}

static void flat_shading_takes_the_first_vertex(void)
{
    struct vertex v[5] = {at(0, 0, 0, 0xff000001), at(100, 0, 0, 0xff000002), at(0, 100, 0, 0xff000003),
                          at(100, 100, 0, 0xff000004), at(0, 200, 0, 0xff000005)};
    OK(triptych_set_state(device, TRIPTYCH_STATE_SHADEMODE, 1));
    bind(buffer_of(v, sizeof v));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 3));
    read_image();
    TEST_ASSERT_EQUAL_HEX32(0xff010000, pixel(10, 10));
    TEST_ASSERT_EQUAL_HEX32(0xff020000, pixel(90, 90));
    TEST_ASSERT_EQUAL_HEX32(0xff030000, pixel(10, 150));
}

static void clipping_at_the_eye_leaves_no_hole(void)
{
    struct vertex v[3] = {
        {{-9, -9, .5f, 1}, RED_ARGB}, {{0, 30, .5f, -1}, RED_ARGB}, {{9, -9, .5f, 1}, RED_ARGB}};
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    draw_list(v, 1);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(SIZE * SIZE, count_color(RED));
}

static void culling_goes_by_the_winding_on_the_screen(void)
{
    static const uint32_t visible[4] = {0, 6400, 0, 6400};
    struct vertex clockwise[6] = {at(10, 10, 0, RED_ARGB), at(90, 10, 0, RED_ARGB), at(10, 90, 0, RED_ARGB),
                                  at(90, 10, 0, RED_ARGB), at(90, 90, 0, RED_ARGB), at(10, 90, 0, RED_ARGB)};
    for (uint32_t mode = 1; mode <= 3; mode++) {
        OK(triptych_clear(device, (float[4]){0, 0, 0, 0}, 1));
        OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, mode));
        draw_list(clockwise, 2);
        read_image();
        TEST_ASSERT_EQUAL_UINT32(visible[mode], count_color(RED));
    }
}

/* --- Clears and the viewport --- */

static void clears_are_in_order_with_draws_and_stay_in_the_viewport(void)
{
    draw_rectangle(0, 0, 200, 200, 0.5f, RED_ARGB);
    OK(triptych_set_viewport(device, &(struct triptych_viewport){30, 40, 100, 64, 0, 1}));
    OK(triptych_clear(device, (float[4]){0, 1, 0, 1}, 0.75f));
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, 64, 64, 0, 1}));
    OK(triptych_clear(device, (float[4]){0, 0, 1, 1}, -1));
    OK(triptych_clear(device, NULL, 0.25f));
    read_image();
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            int green = x >= 30 && x < 130 && y >= 40 && y < 104, blue = x < 64 && y < 64;
            TEST_ASSERT_EQUAL_HEX32(blue ? BLUE : green ? GREEN : RED, pixel(x, y));
            TEST_ASSERT_EQUAL_FLOAT(blue ? 0.25f : green ? 0.75f : 0.5f, depth[y * SIZE + x]);
        }
}

static void clear_colours_round_as_the_pipelines(void)
{
    OK(triptych_clear(device, (float[4]){0.5f, -3, 7, 1.0f / 255}, 1e-42f));
    read_image();
    TEST_ASSERT_EQUAL_HEX32(0x01ff0080, pixel(7, 9));
    TEST_ASSERT_EQUAL_FLOAT(0, depth[0]);
}

static void nothing_is_drawn_outside_the_viewport(void)
{
    OK(triptych_set_viewport(device, &(struct triptych_viewport){33, 21, 70, 90, 0, 1}));
    struct vertex v[3] = {
        {{-50, -50, 0, 1}, RED_ARGB}, {{0, 90, 0, 1}, RED_ARGB}, {{50, -50, 0, 1}, RED_ARGB}};
    draw_list(v, 1);
    read_image();
    TEST_ASSERT_EQUAL_UINT32(70 * 90, count_color(RED));
    TEST_ASSERT_EQUAL_HEX32(RED, pixel(33, 21));
    TEST_ASSERT_EQUAL_HEX32(RED, pixel(102, 110));
}

static void a_new_target_starts_without_the_old_contents(void)
{
    draw_rectangle(0, 0, 200, 200, 0.5f, RED_ARGB);
    OK(triptych_set_target(device, 1, 1));
    uint32_t one = 7;
    OK(triptych_read_color(device, &one, sizeof one));
    TEST_ASSERT_EQUAL_HEX32(0, one);
    unsigned width, height;
    triptych_target_size(device, &width, &height);
    TEST_ASSERT_TRUE(width == 1 && height == 1);
}

/* --- Snapshots --- */

static void later_changes_do_not_reach_a_recorded_draw(void)
{
    static const float far_away[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {9, 9, 0, 1}};
    draw_rectangle(10, 10, 90, 90, 0.5f, RED_ARGB);
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_WORLD, far_away));
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 0));
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, 20, 20, 0, 1}));
    struct triptych_element none = {.format = TRIPTYCH_FORMAT_NONE};
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &none));
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &none));
    read_image();
    TEST_ASSERT_EQUAL_UINT32(6400, count_color(RED));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_new_target_is_zero_and_as_far_as_possible);
    RUN_TEST(a_rectangle_has_exactly_its_pixels);
    RUN_TEST(a_triangle_covers_half_of_its_square);
    RUN_TEST(a_gradient_has_the_right_value_at_every_pixel);
    RUN_TEST(interpolation_is_perspective_correct);
    RUN_TEST(depth_decides_whatever_the_order);
    RUN_TEST(later_draws_cover_earlier_ones);
    RUN_TEST(strips_fans_and_indices_draw_the_same_square);
    RUN_TEST(flat_shading_takes_the_first_vertex);
    RUN_TEST(clipping_at_the_eye_leaves_no_hole);
    RUN_TEST(culling_goes_by_the_winding_on_the_screen);
    RUN_TEST(clears_are_in_order_with_draws_and_stay_in_the_viewport);
    RUN_TEST(clear_colours_round_as_the_pipelines);
    RUN_TEST(nothing_is_drawn_outside_the_viewport);
    RUN_TEST(a_new_target_starts_without_the_old_contents);
    RUN_TEST(later_changes_do_not_reach_a_recorded_draw);
    return UNITY_END();
}
