/* Meshes with bones: the matrices of the bones at a time of an animation, compared with values computed by
 * hand. */
#include "base/file.h"
#include "command/assets/mesh.h"
#include "command/assets/skeleton.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

/* A square whose upper side, two units up, follows an arm that turns by a quarter about it in one second,
 * from x to y. The lower right corner follows both. */
static const char flag[] =
    "xof 0303txt 0032\n"
    "AnimTicksPerSecond { 10; }\n"
    "Frame Root { FrameTransformMatrix { 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, "
    "0.0,0.0,0.0,1.0;; }\n"
    "  Frame Arm { FrameTransformMatrix { 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, "
    "0.0,2.0,0.0,1.0;; } }\n"
    "  Mesh square { 4; 0;0;0;, 1;0;0;, 0;2;0;, 1;2;0;; 2; 3;0,1,2;, 3;1,3,2;;\n"
    "    XSkinMeshHeader { 2; 2; 2; }\n"
    "    SkinWeights { \"Root\"; 2; 0,1; 1.0,0.75; 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, "
    "0.0,0.0,0.0,1.0;; }\n"
    "    SkinWeights { \"Arm\"; 3; 1,2,3; 0.25,1.0,1.0; 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, "
    "0.0,-2.0,0.0,1.0;; }\n"
    "  }\n"
    "}\n"
    "AnimationSet Wave { Animation { { Arm } AnimationKey { 4; 2;\n"
    "  0; 16; 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, 0.0,2.0,0.0,1.0;;,\n"
    "  10; 16; 0.0,1.0,0.0,0.0, -1.0,0.0,0.0,0.0, 0.0,0.0,1.0,0.0, 0.0,2.0,0.0,1.0;;; } } }\n";

static struct error error;
static struct stream *stream;
static char path[64];

void setUp(void)
{
    error_clear(&error);
    stream = NULL;
    strcpy(path, "/tmp/triptych-bones.XXXXXX.x");
    close(mkstemps(path, 2));
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_write(path, flag, strlen(flag), &error), error.text);
}

void tearDown(void)
{
    stream_free(stream);
    unlink(path);
}

/* Reads a stream of the mesh with these options and calls. */
static int read_stream(const char *options, const char *calls)
{
    char text[1024];
    int bytes = snprintf(text, sizeof text, "triptych 1\ntarget 8 8\nmesh flag file \"%s\" %s\n%s", path,
                         options, calls);
    return stream_parse("bones.tri", text, (size_t)bytes, &stream, &error);
}

static const struct resource *read_flag(const char *options, const char *calls)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, read_stream(options, calls), error.text);
    return &stream->resources[0];
}

/* The position that the pipeline computes for a vertex: the sum over four bones, the last weight 1 minus the
 * others. */
static void pose_vertex(const struct resource *mesh, uint32_t v, double (*matrices)[4][4], double out[3])
{
    const struct layout *layout = &mesh->layout;
    const uint8_t *vertex = mesh->vertices + (size_t)v * layout->stride;
    const float *at = (const float *)(vertex + layout->offset[TRIPTYCH_POSITION]);
    const float *weight = (const float *)(vertex + layout->offset[TRIPTYCH_WEIGHTS]);
    const uint8_t *bone = vertex + layout->offset[TRIPTYCH_INDICES];
    double left = 1;
    memset(out, 0, 3 * sizeof *out);
    for (int i = 0; i < 4; i++) {
        double w = i < 3 ? (double)weight[i] : left;
        left -= w;
        for (int c = 0; c < 3; c++)
            out[c] += w * ((double)at[0] * matrices[bone[i]][0][c] + (double)at[1] * matrices[bone[i]][1][c] +
                           (double)at[2] * matrices[bone[i]][2][c] + matrices[bone[i]][3][c]);
    }
}

/* Expects a vertex at x, y in the posed mesh. */
static void expect_vertex(const struct resource *mesh, double (*matrices)[4][4], double x, double y)
{
    double nearest = INFINITY, at[3];
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        pose_vertex(mesh, v, matrices, at);
        nearest = fmin(nearest, hypot(at[0] - x, at[1] - y));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, nearest);
}

static void expect_flag_at(double time, const char *options, double scale, double x, double y)
{
    const double diagonal = 0.70710678118654752;
    const struct resource *mesh = read_flag(options, "");
    double matrices[8][4][4];
    TEST_ASSERT_EQUAL_UINT(4, mesh->vertex_count);
    TEST_ASSERT_EQUAL_UINT(2, mesh->skeleton->bone_count);
    TEST_ASSERT_EQUAL_INT(0, skeleton_pose(mesh->skeleton, 0, time, matrices));
    expect_vertex(mesh, matrices, (0 - x) * scale, (0 - y) * scale);
    expect_vertex(mesh, matrices, (0 - x) * scale, (2 - y) * scale);
    expect_vertex(mesh, matrices, (diagonal - x) * scale, (2 + diagonal - y) * scale);
    /* a quarter follows the arm: (1, -2) from it, turned by half a right angle */
    expect_vertex(mesh, matrices, (0.75 + 0.25 * 3 * diagonal - x) * scale,
                  (0.25 * (2 - diagonal) - y) * scale);
    stream_free(stream);
    stream = NULL;
}

static void vertices_follow_their_bones_in_proportion_to_their_weights(void)
{
    expect_flag_at(0.5, "bones", 1, 0, 0);
}

static void animations_repeat_after_their_end(void)
{
    expect_flag_at(7.5, "bones", 1, 0, 0);
    expect_flag_at(-0.5, "bones", 1, 0, 0);
}

static void a_centred_and_scaled_mesh_moves_the_same_way(void)
{
    expect_flag_at(0.5, "bones center fit 6", 3, 0.5, 1);
}

static void at_rest_bones_change_nothing(void)
{
    const struct resource *mesh = read_flag("bones center fit 5", "");
    double matrices[8][4][4];
    TEST_ASSERT_EQUAL_INT(0, skeleton_pose(mesh->skeleton, 0, 0, matrices));
    for (int b = 0; b < 2; b++)
        for (int i = 0; i < 16; i++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, i % 5 == 0, matrices[b][i / 4][i % 4]);
}

static void without_the_word_bones_there_are_none(void)
{
    const struct resource *mesh = read_flag("", "");
    TEST_ASSERT_NULL(mesh->skeleton);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_FORMAT_NONE, mesh->layout.format[TRIPTYCH_WEIGHTS]);
}

/* The operations after the time move the whole mesh. */
static void a_pose_sets_a_world_matrix_for_each_bone(void)
{
    const struct resource *mesh =
        read_flag("bones", "pose flag \"Wave\" 0.5 scale 2 2 2 translate 10 0 0\nclear depth 1\n");
    double matrices[2][4][4];
    TEST_ASSERT_EQUAL_UINT(4, stream->call_count); /* target, two matrices, clear */
    for (uint32_t b = 0; b < 2; b++) {
        const struct call *call = &stream->calls[1 + b];
        TEST_ASSERT_EQUAL_INT(CALL_TRANSFORM, call->type);
        TEST_ASSERT_EQUAL_INT(b ? TRIPTYCH_TRANSFORM_WORLD1 : TRIPTYCH_TRANSFORM_WORLD,
                              call->transform.which);
        for (int i = 0; i < 16; i++)
            matrices[b][i / 4][i % 4] = (double)call->transform.matrix[i / 4][i % 4];
    }
    expect_vertex(mesh, matrices, 10, 0);
    expect_vertex(mesh, matrices, 10, 4);
}

static void impossible_poses_are_refused_with_their_position(void)
{
    static const struct {
        const char *options, *call, *reason;
    } bad[] = {
        {"", "pose flag \"Wave\" 0\n", "bones.tri:4:6: found a mesh without bones, expected one with"},
        {"bones", "pose flag \"Wink\" 0\n",
         "bones.tri:4:11: found an animation that the mesh does not have, expected \"Wave\""},
        {"bones", "pose flag Wave 0\n", "bones.tri:4:11: found 'Wave', expected the name of an animation"},
        {"bones", "pose flag \"Wave\"\n",
         "bones.tri:4:17: found the end of the line, expected a number (time)"},
        {"bones", "pose mast \"Wave\" 0\n", "bones.tri:4:6: found 'mast', expected the name of a mesh"},
        {"bones", "pose flag \"Wave\" 0 turn\n", "bones.tri:4:20: found 'turn', expected"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        error_clear(&error);
        TEST_ASSERT_EQUAL_INT(-1, read_stream(bad[i].options, bad[i].call));
        TEST_ASSERT_EQUAL_STRING_LEN(bad[i].reason, error.text, strlen(bad[i].reason));
    }
}

static void a_matrix_times_its_inverse_is_the_identity(void)
{
    static const double m[4][4] = {{2, 1, 0, 0}, {-1, 3, 0.5, 0}, {0, 0.25, -4, 0}, {7, -8, 9, 1}};
    static const double flat[4][4] = {{1, 1, 0, 0}, {2, 2, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    double inverse[4][4];
    TEST_ASSERT_EQUAL_INT(0, skeleton_invert(m, inverse));
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            double sum = 0;
            for (int k = 0; k < 4; k++)
                sum += m[i][k] * inverse[k][j];
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, i == j, sum);
        }
    TEST_ASSERT_EQUAL_INT(-1, skeleton_invert(flat, inverse));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(vertices_follow_their_bones_in_proportion_to_their_weights);
    RUN_TEST(animations_repeat_after_their_end);
    RUN_TEST(a_centred_and_scaled_mesh_moves_the_same_way);
    RUN_TEST(at_rest_bones_change_nothing);
    RUN_TEST(without_the_word_bones_there_are_none);
    RUN_TEST(a_pose_sets_a_world_matrix_for_each_bone);
    RUN_TEST(impossible_poses_are_refused_with_their_position);
    RUN_TEST(a_matrix_times_its_inverse_is_the_identity);
    return UNITY_END();
}
