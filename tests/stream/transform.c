/* The operations of `transform`: where they take points, in what order they are multiplied, which way round.
 */
#include "stream/stream.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unity.h>

static struct error error;
static float matrix[4][4];

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

static void transform(const char *operations)
{
    char text[512];
    struct stream *stream;
    int length = snprintf(text, sizeof text, "triptych 1\ntransform world %s\n", operations);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("t", text, (size_t)length, &stream, &error), error.text);
    memcpy(matrix, stream->calls[0].transform.matrix, sizeof matrix);
    stream_free(stream);
}

/* The point's image after the division by w, row vector times matrix. */
static void expect_image(double x, double y, double z, double to_x, double to_y, double to_z)
{
    const double p[4] = {x, y, z, 1}, expected[3] = {to_x, to_y, to_z};
    double image[4] = {0};
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            image[j] += p[i] * (double)matrix[i][j];
    for (int j = 0; j < 3; j++)
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, expected[j], image[j] / image[3]);
}

static void operations_apply_from_left_to_right(void)
{
    transform("scale 2 2 2 translate 1 0 0");
    expect_image(1, 1, 1, 3, 2, 2);
    transform("translate 1 0 0 scale 2 2 2");
    expect_image(1, 1, 1, 4, 2, 2);
}

static void a_matrix_is_read_row_by_row(void)
{
    transform("matrix 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16");
    for (int i = 0; i < 16; i++)
        TEST_ASSERT_EQUAL_FLOAT(i + 1, matrix[i / 4][i % 4]);
}

static void quarter_turns_are_exact_and_take_x_to_y_to_z_to_x(void)
{
    static const float z[4][4] = {{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    transform("rotate 90 0 0 5");
    for (int i = 0; i < 16; i++)
        TEST_ASSERT_TRUE(z[i / 4][i % 4] == matrix[i / 4][i % 4]);
    transform("rotate 90 1 0 0");
    expect_image(0, 1, 0, 0, 0, 1);
    transform("rotate 90 0 1 0");
    expect_image(0, 0, 1, 1, 0, 0);
    transform("rotate 120 1 1 1");
    expect_image(1, 2, 3, 3, 1, 2);
    transform("rotate -1080 0 0 1");
    expect_image(1, 2, 3, 1, 2, 3);
}

static void left_handed_cameras_look_along_z_and_right_handed_ones_against_it(void)
{
    transform("lookat 1 2 3  1 2 13  0 1 0");
    expect_image(1, 2, 13, 0, 0, 10);
    expect_image(2, 3, 3, 1, 1, 0);
    transform("lookat-rh 1 2 3  1 2 13  0 1 0");
    expect_image(1, 2, 13, 0, 0, -10);
    expect_image(2, 3, 3, -1, 1, 0);
}

static void perspectives_map_near_to_0_and_far_to_1(void)
{
    double edge = tan(30 * 3.14159265358979 / 180);
    transform("perspective 60 2 1 100");
    expect_image(0, 0, 1, 0, 0, 0);
    expect_image(0, 0, 100, 0, 0, 1);
    expect_image(2 * edge * 5, edge * 5, 5, 1, 1, (100.0 / 99) * (1 - 1.0 / 5));
    transform("perspective-rh 60 2 1 100");
    expect_image(0, 0, -1, 0, 0, 0);
    expect_image(2 * edge * 100, -edge * 100, -100, 1, -1, 1);
}

static void orthographic_boxes_map_to_the_clip_volume(void)
{
    transform("orthographic 1 5 -2 6 10 20");
    expect_image(1, -2, 10, -1, -1, 0);
    expect_image(5, 6, 20, 1, 1, 1);
    transform("orthographic-rh 1 5 -2 6 10 20");
    expect_image(1, -2, -10, -1, -1, 0);
    expect_image(5, 6, -20, 1, 1, 1);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(operations_apply_from_left_to_right);
    RUN_TEST(a_matrix_is_read_row_by_row);
    RUN_TEST(quarter_turns_are_exact_and_take_x_to_y_to_z_to_x);
    RUN_TEST(left_handed_cameras_look_along_z_and_right_handed_ones_against_it);
    RUN_TEST(perspectives_map_near_to_0_and_far_to_1);
    RUN_TEST(orthographic_boxes_map_to_the_clip_volume);
    return UNITY_END();
}
