/* Derivation of setup keys: lines, points and parts of triangles, depth bias, clip planes, conventions. */
#include "tests/support/picture/derivation.h"

void setUp(void)
{
    derivation_begin();
}

void tearDown(void)
{
}

static void derive_as(enum primitive primitive)
{
    derive_keys(&state, primitive, key);
    derive_job(&state, &key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &job);
}

static void fill_modes_are_for_triangles(void)
{
    static const struct {
        const char *mode;
        enum primitive primitive;
    } modes[] = {{"solid", PRIMITIVE_TRIANGLE}, {"wireframe", PRIMITIVE_EDGE}, {"point", PRIMITIVE_CORNER}};
    for (int i = 0; i < 3; i++) {
        SET(fillmode, modes[i].mode);
        TEST_ASSERT_EQUAL_INT(modes[i].primitive, derive_primitive(&state, TRIPTYCH_TRIANGLE_LIST));
        TEST_ASSERT_EQUAL_INT(modes[i].primitive, derive_primitive(&state, TRIPTYCH_TRIANGLE_STRIP));
        TEST_ASSERT_EQUAL_INT(modes[i].primitive, derive_primitive(&state, TRIPTYCH_TRIANGLE_FAN));
        TEST_ASSERT_EQUAL_INT(PRIMITIVE_POINT, derive_primitive(&state, TRIPTYCH_POINT_LIST));
        TEST_ASSERT_EQUAL_INT(PRIMITIVE_LINE, derive_primitive(&state, TRIPTYCH_LINE_LIST));
        TEST_ASSERT_EQUAL_INT(PRIMITIVE_LINE, derive_primitive(&state, TRIPTYCH_LINE_STRIP));
    }
}

static void culling_and_depth_bias_are_for_triangles_and_their_parts(void)
{
    SET(cullmode, "cw");
    set_value(TRIPTYCH_STATE_DEPTHBIAS, 0x3a000000);
    for (int p = 0; p < PRIMITIVE_COUNT; p++) {
        derive_as((enum primitive)p);
        int has_area = p != PRIMITIVE_LINE && p != PRIMITIVE_POINT;
        TEST_ASSERT_EQUAL_INT(p, key[UNIT_SETUP].setup.primitive);
        TEST_ASSERT_EQUAL_INT(has_area ? CULL_CLOCKWISE : CULL_NONE, key[UNIT_SETUP].setup.cull);
        TEST_ASSERT_EQUAL_INT(has_area ? DEPTH_BIAS_CONSTANT : DEPTH_BIAS_NONE,
                              key[UNIT_SETUP].setup.depth_bias);
    }
}

static void depth_bias_has_only_the_terms_that_are_needed(void)
{
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(DEPTH_BIAS_NONE, key[UNIT_SETUP].setup.depth_bias);
    set_value(TRIPTYCH_STATE_DEPTHBIAS, 0x80000000); /* -0 */
    set_value(TRIPTYCH_STATE_SLOPESCALEDEPTHBIAS, 0x80000000);
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(DEPTH_BIAS_NONE, key[UNIT_SETUP].setup.depth_bias);
    set_value(TRIPTYCH_STATE_SLOPESCALEDEPTHBIAS, 0x3f800000);
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(DEPTH_BIAS_SLOPE, key[UNIT_SETUP].setup.depth_bias);
    TEST_ASSERT_EQUAL_FLOAT(1, job.depth_bias_slope);
    SET(zenable, "false");
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(DEPTH_BIAS_NONE, key[UNIT_SETUP].setup.depth_bias);
}

static void points_are_flat_except_for_the_coordinates_of_sprites(void)
{
    state.texture[0] = &texture;
    state.light_enabled[0] = 1;
    for (int sprite = 0; sprite < 2; sprite++) {
        SET(pointspriteenable, sprite ? "true" : "false");
        derive_as(PRIMITIVE_POINT);
        TEST_ASSERT_EQUAL_INT(INTERPOLATION_FLAT, key[UNIT_PIXEL].pixel.varying[VARYING_diffuse]);
        TEST_ASSERT_EQUAL_INT(sprite ? INTERPOLATION_SMOOTH : INTERPOLATION_FLAT,
                              key[UNIT_PIXEL].pixel.varying[VARYING_texcoord0]);
        TEST_ASSERT_EQUAL_INT(!sprite, key[UNIT_VERTEX].vertex.varying[VARYING_texcoord0]);
        TEST_ASSERT_EQUAL_INT(sprite ? ATTRIBUTE_FORMAT_NONE : ATTRIBUTE_FORMAT_FLOAT2,
                              key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_TEXCOORD]);
        derive_as(PRIMITIVE_LINE);
        TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, key[UNIT_PIXEL].pixel.varying[VARYING_texcoord0]);
    }
}

/* Planes in world space. The camera moves the world by (0, 0, 4), and the projection sets w to z. */
static void clip_planes_are_packed_and_in_clip_space(void)
{
    static const float move[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 4, 1}};
    static const float project[4][4] = {{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 1, 1}, {0, 0, -1, 0}};
    static const float planes[2][4] = {{1, -2, 0.5f, 0.25f}, {0, 0, -1, 3}};
    static const float points[][3] = {{1, 2, 2}, {-1, 0.5f, -2}, {4, -3, 9}};
    state_set_transform(&state, TRIPTYCH_TRANSFORM_VIEW, move, NULL);
    state_set_transform(&state, TRIPTYCH_TRANSFORM_PROJECTION, project, NULL);
    state_set_clip_plane(&state, 1, planes[0], NULL);
    state_set_clip_plane(&state, 4, planes[1], NULL);
    set_value(TRIPTYCH_STATE_CLIPPLANEENABLE, 1 << 1 | 1 << 4);
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(2, key[UNIT_VERTEX].vertex.clip_planes);
    double ratio[2] = {0};
    for (int i = 0; i < 2; i++)
        for (int p = 0; p < 3; p++) {
            double world = (double)planes[i][3], clip = 0, z = (double)points[p][2] + 4;
            double at[4] = {2 * (double)points[p][0], 2 * (double)points[p][1], z - 1, z};
            for (int c = 0; c < 3; c++)
                world += (double)points[p][c] * (double)planes[i][c];
            for (int c = 0; c < 4; c++)
                clip += at[c] * (double)job.clip_plane[i][c];
            TEST_ASSERT_TRUE(clip / world > 0);
            if (p)
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, ratio[i], clip / world);
            ratio[i] = clip / world;
        }
    SET(clipping, "false");
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_VERTEX].vertex.clip_planes);
    TEST_ASSERT_EQUAL_HEX32(CLIP_DEPTH | CLIP_USER_ALL, derive_clip_ignored(&state));
}

/* Near at 1 and far at 11, with clip depth from 0 and from -w. */
static void w_buffers_use_the_depth_range(void)
{
    static const float direct3d[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1.1f, 1}, {0, 0, -1.1f, 0}};
    static const float opengl[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1.2f, 1}, {0, 0, -2.2f, 0}};
    for (unsigned minus = 0; minus < 2; minus++) {
        state_set_convention(&state, TRIPTYCH_DEPTH_RANGE, minus, NULL);
        state_set_transform(&state, TRIPTYCH_TRANSFORM_PROJECTION, minus ? opengl : direct3d, NULL);
        SET(zenable, "usew");
        derive_as(PRIMITIVE_TRIANGLE);
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.1f, job.w_scale);
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, -0.1f, job.w_offset);
    }
}

static void conventions_move_the_window_and_the_depth(void)
{
    derive_as(PRIMITIVE_TRIANGLE);
    struct job before = job;
    state_set_convention(&state, TRIPTYCH_PIXEL_CENTER, TRIPTYCH_PIXEL_CENTER_INTEGER, NULL);
    state_set_convention(&state, TRIPTYCH_DEPTH_RANGE, TRIPTYCH_DEPTH_RANGE_MINUS, NULL);
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_FLOAT(before.offset_x + 128, job.offset_x);
    TEST_ASSERT_EQUAL_FLOAT(before.offset_y + 128, job.offset_y);
    for (int i = 0; i < 4; i++) {
        const float *a = before.world_view_projection[i], *b = job.world_view_projection[i];
        TEST_ASSERT_EQUAL_FLOAT((a[2] + a[3]) / 2, b[2]);
        TEST_ASSERT_EQUAL_FLOAT(a[3], b[3]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(fill_modes_are_for_triangles);
    RUN_TEST(culling_and_depth_bias_are_for_triangles_and_their_parts);
    RUN_TEST(depth_bias_has_only_the_terms_that_are_needed);
    RUN_TEST(points_are_flat_except_for_the_coordinates_of_sprites);
    RUN_TEST(clip_planes_are_packed_and_in_clip_space);
    RUN_TEST(conventions_move_the_window_and_the_depth);
    RUN_TEST(w_buffers_use_the_depth_range);
    return UNITY_END();
}
