/* The operations of `transform`: the images of points, the order of multiplication, and the handedness. */
#include "command/stream/stream.h"

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

/* Expects this image of a point: the row vector times the matrix, divided by w. */
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

/* --- Constants of shaders ------------------------------------------------------------------------------- */

/* Fills `matrix` with the shader constants that the last call of the text sets from the transforms before
 * it. */
static void constants(const char *text)
{
    struct stream *stream;
    static float transforms[TRIPTYCH_TRANSFORM_COUNT][4][4];
    char all[512];
    int length = snprintf(all, sizeof all, "triptych 1\n%s\n", text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("t", all, (size_t)length, &stream, &error), error.text);
    for (uint32_t i = 0; i + 1 < stream->call_count; i++)
        memcpy(transforms[stream->calls[i].transform.which], stream->calls[i].transform.matrix,
               sizeof *transforms);
    const struct call *call = &stream->calls[stream->call_count - 1];
    if (call->type == CALL_CONSTANT_MATRIX)
        TEST_ASSERT_EQUAL_INT(0, stream_constants(call, (const float(*)[4][4])transforms, matrix));
    else
        memcpy(matrix, call->constants.floats, sizeof matrix);
    stream_free(stream);
}

/* Expects this result of m4x4 for a point: its dot products with the constants. */
static void expect_products(double x, double y, double z, double to_x, double to_y, double to_z)
{
    const double p[4] = {x, y, z, 1}, expected[4] = {to_x, to_y, to_z, 1};
    for (int i = 0; i < 4; i++) {
        double product = 0;
        for (int j = 0; j < 4; j++)
            product += p[j] * (double)matrix[i][j];
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, expected[i], product);
    }
}

static void constants_are_columns_for_m4x4(void)
{
    constants("vertexconstant 0 transform scale 2 2 2 translate 1 0 0");
    expect_products(1, 1, 1, 3, 2, 2);
    constants(
        "transform world scale 2 2 2\ntransform view translate 1 0 0\nvertexconstant 0 transform world view");
    expect_products(1, 1, 1, 3, 2, 2);
    constants(
        "transform world scale 2 2 2\ntransform view translate 1 0 0\nvertexconstant 0 transform view world");
    expect_products(1, 1, 1, 4, 2, 2);
    constants("transform texture 5 matrix 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16\n"
              "pixelconstant 0 transform texture 5 transposed");
    for (int i = 0; i < 16; i++)
        TEST_ASSERT_EQUAL_FLOAT(i + 1, matrix[i / 4][i % 4]);
}

static void inverses_undo_what_the_matrix_does(void)
{
    constants("vertexconstant 0 transform rotate 33 1 2 3 scale 1 2 -4 translate 5 6 7 inverse");
    float inverse[4][4];
    memcpy(inverse, matrix, sizeof inverse);
    constants("vertexconstant 0 transform rotate 33 1 2 3 scale 1 2 -4 translate 5 6 7");
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            double product = 0;
            for (int k = 0; k < 4; k++)
                product += (double)matrix[i][k] * (double)inverse[k][j];
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, i == j, product);
        }
    /* a matrix whose first pivot is zero */
    constants("transform world matrix 0 2 0 0 4 0 0 0 0 0 0 8 0 0 1 0\nvertexconstant 0 transform world "
              "inverse transposed");
    TEST_ASSERT_EQUAL_FLOAT(0.25f, matrix[0][1]);
    TEST_ASSERT_EQUAL_FLOAT(0.5f, matrix[1][0]);
    TEST_ASSERT_EQUAL_FLOAT(1, matrix[2][3]);
    TEST_ASSERT_EQUAL_FLOAT(0.125f, matrix[3][2]);
}

/* Normals stay perpendicular to their surface. */
static void the_inverse_transposed_is_for_normals(void)
{
    constants("transform world scale 1 4 1\nvertexconstant 0 transform world inverse transposed count 3");
    const double tangent[3] = {1, -1 * 4, 0}; /* of the plane x + y = 0, scaled */
    double normal[3] = {0};
    for (int i = 0; i < 3; i++)
        normal[i] = (double)matrix[i][0] + (double)matrix[i][1];
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, normal[0] * tangent[0] + normal[1] * tangent[1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1, normal[0]);
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
    RUN_TEST(constants_are_columns_for_m4x4);
    RUN_TEST(inverses_undo_what_the_matrix_does);
    RUN_TEST(the_inverse_transposed_is_for_normals);
    return UNITY_END();
}
