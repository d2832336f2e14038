/* Derivation of the job: the values that routines read are correct for the state. */
#include "tests/support/picture/derivation.h"

#include <math.h>
#include <string.h>
#include <xmmintrin.h>

void setUp(void)
{
    derivation_begin();
}

void tearDown(void)
{
}

static void attributes_point_at_the_first_vertex(void)
{
    derive();
    TEST_ASSERT_EQUAL_PTR(buffer.data + 16, job.attribute[ATTRIBUTE_POSITION].data);
    TEST_ASSERT_EQUAL_INT(32, job.attribute[ATTRIBUTE_POSITION].stride);
    TEST_ASSERT_NULL(job.attribute[ATTRIBUTE_TEXCOORD].data);
}

static void the_viewport_maps_ndc_to_subpixels(void)
{
    state_set_viewport(&state, &(struct triptych_viewport){100, 20, 300, 200, 0.25f, 0.75f}, NULL);
    derive();
    TEST_ASSERT_EQUAL_FLOAT(100 * 256, -job.scale_x + job.offset_x);
    TEST_ASSERT_EQUAL_FLOAT(400 * 256, job.scale_x + job.offset_x);
    TEST_ASSERT_EQUAL_FLOAT(20 * 256, job.scale_y + job.offset_y);
    TEST_ASSERT_EQUAL_FLOAT(220 * 256, -job.scale_y + job.offset_y);
    TEST_ASSERT_EQUAL_FLOAT(0.25f, job.depth_offset);
    TEST_ASSERT_EQUAL_FLOAT(0.5f, job.depth_scale);
}

/* A bound of the band is `pixels` away, or 2^20 halves of the viewport. */
static void expect_band(float guard, float scale, float offset, double pixels)
{
    double window = ((double)guard * (double)scale + (double)offset) / 256;
    TEST_ASSERT_TRUE(fabs((double)guard) == 0x1p20 || fabs(window - pixels) < 0.01);
    TEST_ASSERT_TRUE(fabs(window) <= 16383.5);
}

static void the_guard_band_stays_within_its_limit_and_outside_the_frustum(void)
{
    static const struct triptych_viewport cases[] = {
        {0, 0, 8192, 8192, 0, 1},     {8191, 0, 1, 8192, 0, 1}, {0, 0, 1, 1, 0, 1},
        {8191.5f, 3, .5f, 7, 0, 1},   {-8192, -1, 9, 99, 0, 1}, {-8000, -8000, 16000, 16000, 0, 1},
        {0, -16000, 50, 16000, 0, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_viewport(&state, &cases[i], NULL));
        derive();
        expect_band(job.guard_left, job.scale_x, job.offset_x, -16383);
        expect_band(job.guard_right, job.scale_x, job.offset_x, 16383);
        expect_band(job.guard_bottom, job.scale_y, job.offset_y, 16383);
        expect_band(job.guard_top, job.scale_y, job.offset_y, -16383);
        TEST_ASSERT_TRUE(job.guard_left <= -1 && job.guard_right >= 1);
        TEST_ASSERT_TRUE(job.guard_bottom <= -1 && job.guard_top >= 1);
    }
}

static void expect_rectangle(int x0, int y0, int x1, int y1)
{
    struct rectangle r = derive_area(&state, false);
    TEST_ASSERT_EQUAL_INT(x0, r.x0);
    TEST_ASSERT_EQUAL_INT(y0, r.y0);
    TEST_ASSERT_EQUAL_INT(x1, r.x1);
    TEST_ASSERT_EQUAL_INT(y1, r.y1);
}

static void set_scissor(uint32_t x, uint32_t y, uint32_t width, uint32_t height)
{
    state_set_scissor(&state, (struct scissor){x, y, width, height});
}

static void the_scissor_rectangle_cuts_the_viewport_while_its_test_is_on(void)
{
    state.viewport = (struct triptych_viewport){10, 20, 30, 40, 0, 1};
    set_scissor(15, 0, 100, 30);
    expect_rectangle(10, 20, 40, 60);
    SET(scissortestenable, "true");
    expect_rectangle(15, 20, 40, 30);
    set_scissor(12, 25, 3, 200);
    expect_rectangle(12, 25, 15, 60);
}

static void a_rectangle_beside_the_viewport_leaves_nothing(void)
{
    state.viewport = (struct triptych_viewport){10, 20, 30, 40, 0, 1};
    SET(scissortestenable, "true");
    set_scissor(0, 0, 5, 480);
    expect_rectangle(10, 20, 10, 60);
    set_scissor(100, 25, 0, 10);
    expect_rectangle(100, 25, 100, 35);
    set_scissor(UINT32_MAX, 3, UINT32_MAX, UINT32_MAX);
    expect_rectangle(640, 20, 640, 60);
}

static void the_scissor_is_the_viewports_pixel_centres(void)
{
    state.viewport = (struct triptych_viewport){1.5f, 0.25f, 2, 1.5f, 0, 1};
    struct rectangle r = derive_area(&state, false);
    TEST_ASSERT_EQUAL_INT(1, r.x0);
    TEST_ASSERT_EQUAL_INT(3, r.x1);
    TEST_ASSERT_EQUAL_INT(0, r.y0);
    TEST_ASSERT_EQUAL_INT(2, r.y1);
}

static void matrices_multiply_in_row_order(void)
{
    float(*world)[4] = state.transform[TRIPTYCH_TRANSFORM_WORLD];
    float(*view)[4] = state.transform[TRIPTYCH_TRANSFORM_VIEW];
    world[0][0] = 2; /* scale x, then move x */
    view[3][0] = 10;
    state.transform[TRIPTYCH_TRANSFORM_PROJECTION][0][0] = 3;
    derive();
    TEST_ASSERT_EQUAL_FLOAT(2, job.world_view[0][0]);
    TEST_ASSERT_EQUAL_FLOAT(10, job.world_view[3][0]);
    TEST_ASSERT_EQUAL_FLOAT(6, job.world_view_projection[0][0]);
    TEST_ASSERT_EQUAL_FLOAT(30, job.world_view_projection[3][0]);
}

/* Normals times the normal matrix stay perpendicular to surfaces times world * view. */
static void the_normal_matrix_keeps_normals_perpendicular(void)
{
    static const float matrix[3][3] = {{1, 2, -1}, {0.5f, -3, 2}, {4, 0, 1.5f}};
    for (int i = 0; i < 3; i++)
        memcpy(state.transform[TRIPTYCH_TRANSFORM_WORLD][i], matrix[i], sizeof matrix[i]);
    state.light_enabled[0] = 1;
    derive();
    const float normal[3] = {1, 1, -2}, tangent[3] = {4, 2, 3};
    float n[3] = {0}, t[3] = {0};
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) {
            n[c] += normal[r] * job.normal[r][c];
            t[c] += tangent[r] * job.world_view[r][c];
        }
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0, n[0] * t[0] + n[1] * t[1] + n[2] * t[2]);
    TEST_ASSERT_TRUE(fabsf(n[0]) + fabsf(n[1]) + fabsf(n[2]) > 0.1f);
}

/* A matrix with a fourth column: the inverse transpose of all of it. This one takes the normal 0 0 1 to 0. */
static void the_normal_matrix_is_the_inverse_transpose_of_four_columns(void)
{
    static const float matrix[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, -1}, {10, 10, 10, 0}};
    static const float expected[3][3] = {{1, 0, -1}, {0, 1, -1}, {0, 0, 0}};
    memcpy(state.transform[TRIPTYCH_TRANSFORM_WORLD], matrix, sizeof matrix);
    state.light_enabled[0] = 1;
    derive();
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            TEST_ASSERT_FLOAT_WITHIN(1e-6f, expected[i][j], job.normal[i][j]);
}

static void directional_lights_point_to_the_light_in_camera_space(void)
{
    state.light_enabled[0] = 1;
    state.light[0].direction[0] = 0;
    state.light[0].direction[2] = 5; /* travels along +z */
    float(*view)[4] = state.transform[TRIPTYCH_TRANSFORM_VIEW];
    view[2][2] = 0;
    view[2][0] = 1; /* z becomes x */
    view[0][0] = 0;
    view[0][2] = -1;
    derive();
    TEST_ASSERT_EQUAL_FLOAT(-1, job.light[0].position[0]);
    TEST_ASSERT_EQUAL_FLOAT(0, job.light[0].position[1]);
    TEST_ASSERT_EQUAL_FLOAT(0, job.light[0].position[2]);
}

static void base_colour_is_the_sum_of_constant_terms(void)
{
    state.value[TRIPTYCH_STATE_AMBIENT] = 0x00ff8000;
    SET(colorvertex, "false");
    state.material = (struct triptych_material){
        .diffuse = {.5f, 1, 1, .25f}, .ambient = {.5f, .5f, .5f, 1}, .emissive = {.125f, 0, 0, 1}};
    state.light_enabled[0] = state.light_enabled[1] = 1;
    state.light[0].ambient[2] = 1;
    state.light[1].type = TRIPTYCH_LIGHT_POINT;
    state.light[1].ambient[0] = 1;
    derive();
    TEST_ASSERT_EQUAL_FLOAT(.625f, job.base_color[0]);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, .5f * 128 / 255, job.base_color[1]);
    TEST_ASSERT_EQUAL_FLOAT(.5f, job.base_color[2]);
    TEST_ASSERT_EQUAL_FLOAT(.25f, job.base_color[3]);
    TEST_ASSERT_EQUAL_FLOAT(.5f, job.light[0].diffuse[0]);
    TEST_ASSERT_EQUAL_FLOAT(.5f, job.light[1].ambient[0]);
}

static void the_job_does_not_depend_on_the_callers_rounding(void)
{
    struct job nearest;
    state.light_enabled[0] = 1;
    state.light[0].direction[0] = 0.3f;
    state.transform[TRIPTYCH_TRANSFORM_WORLD][0][1] = 0.1f;
    state.transform[TRIPTYCH_TRANSFORM_VIEW][1][2] = 0.7f;
    derive();
    nearest = job;
    unsigned saved = _mm_getcsr();
    _mm_setcsr(saved | _MM_ROUND_UP);
    derive();
    TEST_ASSERT_EQUAL_HEX32((saved | _MM_ROUND_UP) & ~0x3fu, _mm_getcsr() & ~0x3fu);
    _mm_setcsr(saved);
    TEST_ASSERT_EQUAL_MEMORY(&nearest, &job, sizeof job);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(attributes_point_at_the_first_vertex);
    RUN_TEST(the_viewport_maps_ndc_to_subpixels);
    RUN_TEST(the_guard_band_stays_within_its_limit_and_outside_the_frustum);
    RUN_TEST(the_scissor_rectangle_cuts_the_viewport_while_its_test_is_on);
    RUN_TEST(a_rectangle_beside_the_viewport_leaves_nothing);
    RUN_TEST(the_scissor_is_the_viewports_pixel_centres);
    RUN_TEST(matrices_multiply_in_row_order);
    RUN_TEST(the_normal_matrix_keeps_normals_perpendicular);
    RUN_TEST(the_normal_matrix_is_the_inverse_transpose_of_four_columns);
    RUN_TEST(directional_lights_point_to_the_light_in_camera_space);
    RUN_TEST(base_colour_is_the_sum_of_constant_terms);
    RUN_TEST(the_job_does_not_depend_on_the_callers_rounding);
    return UNITY_END();
}
