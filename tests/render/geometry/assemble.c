/* Primitive assembly: the vertices of each primitive. */
#include "tests/render/geometry/logged.h"

void setUp(void)
{
    begin_log();
}

void tearDown(void)
{
    end_log();
}

static void lists_take_three_vertices_each(void)
{
    draw.primitive = TRIPTYCH_TRIANGLE_LIST;
    draw.base = 100;
    TEST_ASSERT_EQUAL_UINT32(4, run(0, 4));
    TEST_ASSERT_EQUAL_UINT64(4, batch->counts.triangles_set_up);
    TEST_ASSERT_EQUAL_UINT64(12, batch->counts.vertices_shaded);
    for (uint32_t i = 0; i < 4; i++)
        expect_triangle(i, 100 + 3 * i, 101 + 3 * i, 102 + 3 * i);
}

static void strips_keep_the_winding_and_begin_with_their_own_vertex(void)
{
    draw.primitive = TRIPTYCH_TRIANGLE_STRIP;
    TEST_ASSERT_EQUAL_UINT32(4, run(0, 4));
    TEST_ASSERT_EQUAL_UINT64(6, batch->counts.vertices_shaded);
    expect_triangle(0, 0, 1, 2);
    expect_triangle(1, 1, 3, 2);
    expect_triangle(2, 2, 3, 4);
    expect_triangle(3, 3, 5, 4);
}

static void fans_share_their_first_vertex(void)
{
    draw.primitive = TRIPTYCH_TRIANGLE_FAN;
    TEST_ASSERT_EQUAL_UINT32(3, run(0, 3));
    TEST_ASSERT_EQUAL_UINT64(5, batch->counts.vertices_shaded);
    expect_triangle(0, 1, 2, 0);
    expect_triangle(1, 2, 3, 0);
    expect_triangle(2, 3, 4, 0);
}

static void lines_and_points_take_two_vertices_and_one(void)
{
    draw.last_pixel = true;
    draw.count = 4;
    draw_as(TRIPTYCH_LINE_LIST, PRIMITIVE_LINE, SHAPE_LINE);
    TEST_ASSERT_EQUAL_UINT32(4, run(0, 4));
    TEST_ASSERT_EQUAL_UINT64(8, batch->counts.vertices_shaded);
    for (uint32_t i = 0; i < 4; i++) {
        expect_line(i, 2 * i, 2 * i + 1, true);
        TEST_ASSERT_EQUAL_UINT32(2 * i, other_log[i].provoking);
    }
    draw_as(TRIPTYCH_LINE_STRIP, PRIMITIVE_LINE, SHAPE_LINE);
    TEST_ASSERT_EQUAL_UINT32(4, run(0, 4));
    TEST_ASSERT_EQUAL_UINT64(5, batch->counts.vertices_shaded);
    for (uint32_t i = 0; i < 4; i++)
        expect_line(i, i, i + 1, i == 3);
    draw_as(TRIPTYCH_POINT_LIST, PRIMITIVE_POINT, SHAPE_POINT);
    TEST_ASSERT_EQUAL_UINT32(4, run(0, 4));
    TEST_ASSERT_EQUAL_UINT64(4, batch->counts.triangles_set_up);
    for (uint32_t i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT32(i, triangle_log[i][0]);
        TEST_ASSERT_EQUAL_UINT32(i, other_log[i].provoking);
    }
}

/* A triangle gives three edges or three corners. Each has the other vertices of the triangle, from which
 * setup computes the winding. */
static void parts_of_triangles_come_with_their_triangle(void)
{
    draw_as(TRIPTYCH_TRIANGLE_STRIP, PRIMITIVE_EDGE, SHAPE_LINE);
    for (int corners = 0; corners < 3; corners++) {
        draw.flat = corners == 2;
        if (corners)
            draw_as(TRIPTYCH_TRIANGLE_STRIP, PRIMITIVE_CORNER, SHAPE_POINT);
        TEST_ASSERT_EQUAL_UINT32(2, run(0, 2));
        TEST_ASSERT_EQUAL_UINT64(6, batch->counts.triangles_set_up);
        expect_triangle(0, 0, 1, 2);
        expect_triangle(1, 1, 2, 0);
        expect_triangle(2, 2, 0, 1);
        expect_triangle(3, 1, 3, 2);
        expect_triangle(4, 3, 2, 1);
        expect_triangle(5, 2, 1, 3);
        for (int i = 0; i < 6; i++)
            TEST_ASSERT_EQUAL_UINT32(corners == 1 ? triangle_log[i][0] : (uint32_t)i / 3,
                                     other_log[i].provoking);
    }
}

static void a_run_may_begin_anywhere(void)
{
    draw.primitive = TRIPTYCH_TRIANGLE_STRIP;
    run(3, 2);
    expect_triangle(0, 3, 5, 4);
    expect_triangle(1, 4, 5, 6);
}

static void indices_of_16_and_32_bits_are_moved_by_the_base(void)
{
    static const uint16_t short_index[] = {5, 65535, 7};
    static const uint32_t long_index[] = {70000, 3, 80000};
    draw.indices = short_index;
    draw.index_bits = 16;
    draw.base = (uint32_t)-5;
    run(0, 1);
    expect_triangle(0, 0, 65530, 2);
    draw.indices = long_index;
    draw.index_bits = 32;
    draw.base = (uint32_t)-3;
    run(0, 1);
    expect_triangle(0, 69997, 0, 79997);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(lists_take_three_vertices_each);
    RUN_TEST(strips_keep_the_winding_and_begin_with_their_own_vertex);
    RUN_TEST(fans_share_their_first_vertex);
    RUN_TEST(lines_and_points_take_two_vertices_and_one);
    RUN_TEST(parts_of_triangles_come_with_their_triangle);
    RUN_TEST(a_run_may_begin_anywhere);
    RUN_TEST(indices_of_16_and_32_bits_are_moved_by_the_base);
    return UNITY_END();
}
