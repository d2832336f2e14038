/* Meshes: computed normals and texture coordinates, centring and scaling, and the exact normals of Bézier
 * patches. */
#include "command/assets/mesh.h"

#include "base/file.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

static struct error error;
static struct mesh mesh;
static char path[64];

void setUp(void)
{
    error_clear(&error);
    mesh = (struct mesh){0};
    strcpy(path, "/tmp/triptych-mesh.XXXXXX.obj");
    close(mkstemps(path, 4));
}

void tearDown(void)
{
    mesh_free(&mesh);
    unlink(path);
}

static void use_ending(const char *ending)
{
    unlink(path);
    snprintf(path, sizeof path, "/tmp/triptych-mesh.XXXXXX.%s", ending);
    close(mkstemps(path, (int)strlen(ending) + 1));
}

static void write_file(const char *text)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_write(path, text, strlen(text), &error), error.text);
}

static void read_model(const char *text, const struct mesh_options *options)
{
    mesh_free(&mesh);
    write_file(text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, mesh_read_model(&mesh, path, 0, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, mesh_finish(&mesh, path, options, &error), error.text);
}

static void read_bezier(const char *text, unsigned subdivisions)
{
    static const struct mesh_options options = {.source = MESH_BEZIER};
    mesh_free(&mesh);
    write_file(text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, mesh_read_bezier(&mesh, path, subdivisions, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, mesh_finish(&mesh, path, &options, &error), error.text);
}

static const struct mesh_vertex *corner(uint32_t i)
{
    TEST_ASSERT_TRUE(mesh.indices[i] < mesh.vertex_count);
    return &mesh.vertices[mesh.indices[i]];
}

static double dot(const float a[3], const float b[3])
{
    return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
}

/* --- Models --- */

/* A tent over the y axis: two quads that meet in a ridge at height 1, open below, and an unused vertex. */
static const char tent[] = "v -1 0 0\nv -1 0 2\nv 0 1 2\nv 0 1 0\nv 1 0 2\nv 1 0 0\nv 9 9 9\n"
                           "f 1 2 3 4\nf 4 3 5 6\n";

/* The face's normal; its length is twice its area. */
static void face_normal(uint32_t triangle, float normal[3])
{
    float edge[2][3];
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < 3; c++)
            edge[e][c] = corner(triangle + 1 + (uint32_t)e)->position[c] - corner(triangle)->position[c];
    for (int c = 0; c < 3; c++)
        normal[c] = edge[0][(c + 1) % 3] * edge[1][(c + 2) % 3] - edge[0][(c + 2) % 3] * edge[1][(c + 1) % 3];
}

/* The sum over all triangles with a corner at the position, of any vertex. */
static void expect_average_normal(const struct mesh_vertex *vertex)
{
    float sum[3] = {0}, normal[3];
    for (uint32_t i = 0; i < mesh.index_count; i++)
        if (!memcmp(corner(i)->position, vertex->position, sizeof vertex->position)) {
            face_normal(i / 3 * 3, normal);
            for (int c = 0; c < 3; c++)
                sum[c] += normal[c];
        }
    for (int c = 0; c < 3; c++)
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, sum[c] / sqrtf((float)dot(sum, sum)), vertex->normal[c]);
}

static void polygons_become_triangles_and_missing_normals_are_averaged_over_faces(void)
{
    static const struct mesh_options options = {.normals = NORMALS_SMOOTH};
    read_model(tent, &options);
    TEST_ASSERT_EQUAL_UINT(12, mesh.index_count);
    TEST_ASSERT_EQUAL_UINT(6, mesh.vertex_count);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        expect_average_normal(&mesh.vertices[v]);
}

/* Two vertices at one position with different texture coordinates get the same normal. */
static void normals_are_averaged_across_texture_seams(void)
{
    static const struct mesh_options options = {.normals = NORMALS_SMOOTH};
    read_model("v -1 0 0\nv 0 1 0\nv 0 1 2\nv 1 0 0\nvt 0 0\nvt 1 1\n"
               "f 1/1 3/1 2/1\nf 2/2 3/2 4/2\n",
               &options);
    TEST_ASSERT_EQUAL_UINT(6, mesh.vertex_count);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        expect_average_normal(&mesh.vertices[v]);
}

static void flat_normals_are_those_of_each_face(void)
{
    static const struct mesh_options options = {.normals = NORMALS_FLAT};
    read_model(tent, &options);
    TEST_ASSERT_EQUAL_UINT(12, mesh.index_count);
    TEST_ASSERT_EQUAL_UINT(12, mesh.vertex_count);
    for (uint32_t i = 0; i < mesh.index_count; i += 3) {
        double side = corner(i)->position[0] + corner(i + 1)->position[0] + corner(i + 2)->position[0];
        for (uint32_t c = i; c < i + 3; c++) {
            TEST_ASSERT_FLOAT_WITHIN(1e-6f, side < 0 ? -0.70710678f : 0.70710678f, corner(c)->normal[0]);
            TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.70710678f, corner(c)->normal[1]);
        }
    }
}

static void normals_of_the_file_stay(void)
{
    static const struct mesh_options options = {.normals = NORMALS_FLAT};
    read_model("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2//1 3//1\n", &options);
    for (uint32_t i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_FLOAT(1, corner(i)->normal[0]);
}

static void texture_coordinates_come_with_v_down(void)
{
    static const struct mesh_options options = {0};
    read_model("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n", &options);
    TEST_ASSERT_EQUAL_INT(1, mesh.has_texcoord);
    for (uint32_t i = 0; i < 3; i++)
        if (corner(i)->position[0] == 0 && corner(i)->position[1] == 0)
            TEST_ASSERT_EQUAL_FLOAT(0.75f, corner(i)->texcoord[1]);
}

static void center_and_fit_move_and_scale_the_bounding_box(void)
{
    static const struct mesh_options both = {.center = 1, .fit = 4}, fit = {.fit = 4};
    static const float centered[3] = {2, 1, 2}, fitted[3] = {2, 2, 4};
    float most[3];
    for (int pass = 0; pass < 2; pass++) {
        read_model(tent, pass ? &fit : &both);
        for (int c = 0; c < 3; c++) {
            most[c] = -INFINITY;
            for (uint32_t i = 0; i < mesh.index_count; i++)
                most[c] = fmaxf(most[c], corner(i)->position[c]);
            TEST_ASSERT_EQUAL_FLOAT(pass ? fitted[c] : centered[c], most[c]);
        }
    }
}

/* Around a drum of 8 sides, u runs from 0 to 1, and no triangle turns back across the seam. */
static void projected_texture_coordinates_go_round_without_turning_back(void)
{
    char text[2048], *at = text;
    for (int i = 0; i < 8; i++)
        at += sprintf(at, "v %.9g 0 %.9g\nv %.9g 1 %.9g\n", sin(i * 0.785398163 + 0.1),
                      cos(i * 0.785398163 + 0.1), sin(i * 0.785398163 + 0.1), cos(i * 0.785398163 + 0.1));
    for (int i = 0; i < 8; i++)
        at +=
            sprintf(at, "f %d %d %d %d\n", 2 * i + 1, (2 * i + 2) % 16 + 1, (2 * i + 2) % 16 + 2, 2 * i + 2);
    for (int kind = TEXCOORDS_SPHERICAL; kind <= TEXCOORDS_CYLINDRICAL; kind++) {
        const struct mesh_options options = {.texcoords = (enum texcoords)kind};
        read_model(text, &options);
        TEST_ASSERT_EQUAL_UINT(48, mesh.index_count);
        for (uint32_t i = 0; i < mesh.index_count; i += 3) {
            float a = corner(i)->texcoord[0], b = corner(i + 1)->texcoord[0], c = corner(i + 2)->texcoord[0];
            float span = fmaxf(a, fmaxf(b, c)) - fminf(a, fminf(b, c));
            TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.125f, span);
        }
    }
    const struct mesh_options planar = {.texcoords = TEXCOORDS_PLANAR};
    read_model(text, &planar);
    for (uint32_t i = 0; i < mesh.index_count; i++) {
        TEST_ASSERT_EQUAL_FLOAT(1 - corner(i)->position[1], corner(i)->texcoord[1]);
        TEST_ASSERT_TRUE(corner(i)->texcoord[0] >= 0 && corner(i)->texcoord[0] <= 1);
    }
}

/* With a mirrored node, fronts stay fronts, and normals stay on their side. */
static void node_transforms_are_applied_and_mirrors_keep_fronts(void)
{
    static const char gltf[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
        "\"nodes\":[{\"children\":[1],\"translation\":[10,0,0]},{\"mesh\":0,\"scale\":[-2,1,1]}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,0]}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";
    static const struct mesh_options options = {0};
    use_ending("gltf");
    read_model(gltf, &options);
    TEST_ASSERT_EQUAL_UINT(3, mesh.index_count);
    for (uint32_t i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(corner(i)->position[0] == 10 || corner(i)->position[0] == 8);
        TEST_ASSERT_EQUAL_FLOAT(1, corner(i)->normal[2]);
    }
}

static void models_without_triangles_and_damaged_ones_are_refused(void)
{
    static const struct mesh_options options = {0};
    static const char *const bad[] = {"", "v 0 0 0\nv 1 0 0\nl 1 2\n", "not a model", "v 0 0 0\nf 1 2 3\n"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        mesh_free(&mesh);
        error_clear(&error);
        write_file(bad[i]);
        int result = mesh_read_model(&mesh, path, 0, &error);
        if (!result)
            result = mesh_finish(&mesh, path, &options, &error);
        TEST_ASSERT_EQUAL_INT_MESSAGE(-1, result, bad[i]);
        TEST_ASSERT_EQUAL_STRING_LEN(path, error.text, strlen(path));
        TEST_ASSERT_NULL(strchr(error.text, '\n'));
    }
}

static void expect_without_triangles(const char *text)
{
    char expected[128];
    write_file(text);
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, mesh_read_model(&mesh, path, 1, &error));
    snprintf(expected, sizeof expected, "%s: no triangles", path);
    TEST_ASSERT_EQUAL_STRING(expected, error.text);
}

static void bones_without_a_skeleton_are_refused(void)
{
    use_ending("x");
    expect_without_triangles("xof 0302txt 0064\nFrame a {\n}\n");
}

/* Assimp writes the nodes of a RAW file's groups over one another: the last remains, the others are null. */
static void null_nodes_are_skipped(void)
{
    static const char raw[] = "first\n0 0 0 1 0 0 0 1 0 a.png\nsecond\n0 0 1 1 0 1 0 1 1 b.png\n";
    use_ending("raw");
    write_file(raw);
    for (int bones = 0; bones < 2; bones++) {
        mesh_free(&mesh);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, mesh_read_model(&mesh, path, bones, &error), error.text);
        TEST_ASSERT_EQUAL_UINT(0, mesh.index_count % 3);
        TEST_ASSERT_TRUE(mesh.index_count);
    }
}

/* Assimp would allocate what the header claims, and read it for minutes. */
static void a_ply_header_that_claims_more_than_the_file_is_refused_immediately(void)
{
    char expected[256];
    static const char ply[] = "ply\nformat ascii 1.0\nelement vertex 100000000000\nproperty float x\n"
                              "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    use_ending("ply");
    write_file(ply);
    TEST_ASSERT_EQUAL_INT(-1, mesh_read_model(&mesh, path, 0, &error));
    snprintf(expected, sizeof expected, "%s:3: 100000000000 entries of vertex in a file of %zu bytes", path,
             sizeof ply - 1);
    TEST_ASSERT_EQUAL_STRING(expected, error.text);
}

/* --- Bézier patches --- */

/* A flat patch: control points on a grid give P(u, v) = (3u, 3v, 0). dP/dv x dP/du points along -z. */
static const char flat[] = "BEZ333 # flat\n0 0 0 1 0 0 2 0 0 3 0 0\n0 1 0 1 1 0 2 1 0 3 1 0\n"
                           "0 2 0 1 2 0 2 2 0 3 2 0\n0 3 0 1 3 0 2 3 0 3 3 0\n";

static void a_flat_patch_is_its_grid(void)
{
    read_bezier(flat, 3);
    TEST_ASSERT_EQUAL_UINT(16, mesh.vertex_count);
    TEST_ASSERT_EQUAL_UINT(54, mesh.index_count);
    for (uint32_t v = 0; v < 16; v++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)(v % 4), mesh.vertices[v].position[0]);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)(v / 4), mesh.vertices[v].position[1]);
        TEST_ASSERT_EQUAL_FLOAT(-1, mesh.vertices[v].normal[2]);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)(v % 4) / 3, mesh.vertices[v].texcoord[0]);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)(v / 4) / 3, mesh.vertices[v].texcoord[1]);
    }
}

static void texture_coordinates_and_colors_are_those_of_the_corners(void)
{
    char text[1024];
    snprintf(text, sizeof text, "CBEZ333_ST%s 0 0 2 0 0 4 2 4  1 0 0 1  0 1 0 1  0 0 1 1  1 1 1 0\n",
             flat + 6);
    read_bezier(text, 2);
    TEST_ASSERT_EQUAL_INT(1, mesh.has_color);
    TEST_ASSERT_EQUAL_HEX32(0xffff0000, mesh.vertices[0].color);
    TEST_ASSERT_EQUAL_HEX32(0xff00ff00, mesh.vertices[2].color);
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, mesh.vertices[6].color);
    TEST_ASSERT_EQUAL_HEX32(0x00ffffff, mesh.vertices[8].color);
    TEST_ASSERT_EQUAL_HEX32(0xbf808080, mesh.vertices[4].color);
    TEST_ASSERT_EQUAL_FLOAT(1, mesh.vertices[4].texcoord[0]);
    TEST_ASSERT_EQUAL_FLOAT(2, mesh.vertices[4].texcoord[1]);
}

/* The slope of the surface from points nearby, in binary64 by de Casteljau's construction, independently of
 * the derivatives of Bernstein polynomials. */
static void point_at(const float patch[16][3], double u, double v, double out[3])
{
    for (int i = 0; i < 3; i++) {
        double p[4][4];
        for (int k = 0; k < 16; k++)
            p[k / 4][k % 4] = patch[k][i];
        for (int level = 3; level > 0; level--)
            for (int y = 0; y < 4; y++)
                for (int x = 0; x < level; x++)
                    p[y][x] += u * (p[y][x + 1] - p[y][x]);
        for (int level = 3; level > 0; level--)
            for (int y = 0; y < level; y++)
                p[y][0] += v * (p[y + 1][0] - p[y][0]);
        out[i] = p[0][0];
    }
}

static void slope_normal(const float patch[16][3], double u, double v, double n[3])
{
    static const double step = 1e-5;
    double right[3], left[3], up[3], down[3];
    point_at(patch, u + step, v, right);
    point_at(patch, u - step, v, left);
    point_at(patch, u, v + step, up);
    point_at(patch, u, v - step, down);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = (up[j] - down[j]) * (right[k] - left[k]) - (up[k] - down[k]) * (right[j] - left[j]);
    }
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++)
        n[i] /= length;
}

static void normals_are_the_slope_of_the_surface(void)
{
    float patch[16][3];
    char text[2048], *at = text + sprintf(text, "BBP\n");
    uint32_t random = 1;
    for (int k = 0; k < 16; k++)
        for (int i = 0; i < 3; i++) {
            random = random * 1664525 + 1013904223;
            patch[k][i] = (i == 0   ? (float)(k % 4)
                           : i == 1 ? (float)(k / 4)
                                    : 0) +
                          (float)(random >> 24) / 300;
            at += sprintf(at, " %.9g", (double)patch[k][i]);
        }
    read_bezier(text, 8);
    for (uint32_t y = 0; y <= 8; y++)
        for (uint32_t x = 0; x <= 8; x++) {
            const struct mesh_vertex *vertex = &mesh.vertices[9 * y + x];
            double position[3], normal[3];
            point_at(patch, x / 8.0, y / 8.0, position);
            slope_normal(patch, x / 8.0, y / 8.0, normal);
            for (int i = 0; i < 3; i++) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-6, position[i], vertex->position[i]);
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, normal[i], vertex->normal[i]);
            }
        }
}

/* Every normal has unit length and points to the front of the triangles around it. At the top of the lid it
 * points up, although the derivatives of the patches vanish there. */
static void the_teapot_has_unit_normals_on_the_front_of_its_triangles(void)
{
    static const struct mesh_options options = {.source = MESH_BEZIER};
    static const char teapot[] = "bench/streams/assets/teapot.bez";
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, mesh_read_bezier(&mesh, teapot, 16, &error), error.text);
    uint32_t on_top = 0;
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        const struct mesh_vertex *vertex = &mesh.vertices[v];
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1, dot(vertex->normal, vertex->normal));
        if (vertex->position[2] > 1.05f) {
            TEST_ASSERT_FLOAT_WITHIN(1e-5f, 1, vertex->normal[2]);
            on_top++;
        }
    }
    TEST_ASSERT_EQUAL_UINT(4 * 17, on_top);
    TEST_ASSERT_EQUAL_INT(0, mesh_finish(&mesh, teapot, &options, &error));
    /* Four patches meet at the top and four at the bottom; their cells there have one triangle each. */
    TEST_ASSERT_EQUAL_UINT(3 * (32 * 2 * 16 * 16 - 8 * 16), mesh.index_count);
    for (uint32_t i = 0; i < mesh.index_count; i += 3) {
        float face[3];
        face_normal(i, face);
        for (uint32_t c = i; c < i + 3; c++)
            TEST_ASSERT_TRUE(dot(face, corner(c)->normal) > 0);
    }
}

/* By the divergence theorem, the triangles of the body enclose a positive volume if their fronts are outside.
 */
static void the_teapots_fronts_are_outside(void)
{
    double volume = 0;
    TEST_ASSERT_EQUAL_INT(0, mesh_read_bezier(&mesh, "bench/streams/assets/teapot.bez", 8, &error));
    for (uint32_t i = 0; i < mesh.index_count; i += 3) {
        const float *a = corner(i)->position, *b = corner(i + 1)->position, *c = corner(i + 2)->position;
        float cross[3] = {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]};
        volume += dot(a, cross) / 6;
    }
    TEST_ASSERT_TRUE(volume > 0.2);
}

static void damaged_patches_are_refused_with_their_position(void)
{
    static const struct {
        const char *text, *place;
    } bad[] = {
        {"", ":1:1: found the end of the file, expected the header"},
        {"BEZ223\n", ":1:1: found 'BEZ223', expected the header"},
        {"# c\nBBP\n1 2 3\n", ":4:1: found the end of the file, expected a number (a coordinate"},
        {"BBP 1 2 three", ":1:9: found 'three', expected a number"},
        {"BBP 1 2 {", ":1:9: found '{', expected a number"},
        {"BBP 1e99", ":1:5: found '1e99'"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        error_clear(&error);
        write_file(bad[i].text);
        TEST_ASSERT_EQUAL_INT(-1, mesh_read_bezier(&mesh, path, 4, &error));
        TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(bad[i].place, error.text + strlen(path), strlen(bad[i].place),
                                             error.text);
        mesh_free(&mesh);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(polygons_become_triangles_and_missing_normals_are_averaged_over_faces);
    RUN_TEST(normals_are_averaged_across_texture_seams);
    RUN_TEST(flat_normals_are_those_of_each_face);
    RUN_TEST(normals_of_the_file_stay);
    RUN_TEST(texture_coordinates_come_with_v_down);
    RUN_TEST(center_and_fit_move_and_scale_the_bounding_box);
    RUN_TEST(projected_texture_coordinates_go_round_without_turning_back);
    RUN_TEST(node_transforms_are_applied_and_mirrors_keep_fronts);
    RUN_TEST(models_without_triangles_and_damaged_ones_are_refused);
    RUN_TEST(bones_without_a_skeleton_are_refused);
    RUN_TEST(null_nodes_are_skipped);
    RUN_TEST(a_ply_header_that_claims_more_than_the_file_is_refused_immediately);
    RUN_TEST(a_flat_patch_is_its_grid);
    RUN_TEST(texture_coordinates_and_colors_are_those_of_the_corners);
    RUN_TEST(normals_are_the_slope_of_the_surface);
    RUN_TEST(the_teapot_has_unit_normals_on_the_front_of_its_triangles);
    RUN_TEST(the_teapots_fronts_are_outside);
    RUN_TEST(damaged_patches_are_refused_with_their_position);
    return UNITY_END();
}
