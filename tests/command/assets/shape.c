/* Meshes without a file: shapes enclose their volume, fronts and normals point outside, and a shadow volume
 * is closed and has the volume of the prism over the lit area. */
#include "command/stream/stream.h"

#include <math.h>
#include <stdio.h>
#include <unity.h>

static const double pi = 3.14159265358979323846;
static struct error error;
static struct stream *stream;

void setUp(void)
{
    error_clear(&error);
    stream = NULL;
}

void tearDown(void)
{
    stream_free(stream);
}

/* The last mesh that the lines define. */
static const struct resource *make(const char *lines)
{
    char text[512];
    int bytes = snprintf(text, sizeof text, "triptych 1\n%s\ntarget 8 8\n", lines);
    stream_free(stream);
    int result = stream_parse("shape.tri", text, (size_t)bytes, &stream, &error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, result, error.text);
    return &stream->resources[stream->resource_count - 1];
}

static const float *part(const struct resource *mesh, enum triptych_attribute attribute, uint32_t corner)
{
    uint32_t index = mesh->index_bits == 16 ? ((const uint16_t *)mesh->indices)[corner]
                                            : ((const uint32_t *)mesh->indices)[corner];
    TEST_ASSERT_TRUE(index < mesh->vertex_count);
    return (const float *)(mesh->vertices + (size_t)index * mesh->layout.stride +
                           mesh->layout.offset[attribute]);
}

static const float *position(const struct resource *mesh, uint32_t corner)
{
    return part(mesh, TRIPTYCH_POSITION, corner);
}

static void face_normal(const struct resource *mesh, uint32_t first, double normal[3])
{
    const float *a = position(mesh, first), *b = position(mesh, first + 1), *c = position(mesh, first + 2);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        normal[i] =
            ((double)b[j] - a[j]) * ((double)c[k] - a[k]) - ((double)b[k] - a[k]) * ((double)c[j] - a[j]);
    }
}

/* The volume of a closed mesh; negative if its fronts are inside. */
static double volume(const struct resource *mesh)
{
    double sum = 0, normal[3];
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        face_normal(mesh, i, normal);
        for (int c = 0; c < 3; c++)
            sum += normal[c] * (double)position(mesh, i)[c] / 6;
    }
    return sum;
}

static int same(const float *a, const float *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static int runs(const struct resource *mesh, uint32_t corner, const float *from, const float *to)
{
    uint32_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
    return same(position(mesh, corner), from) && same(position(mesh, next), to);
}

/* Along every edge, the same number of triangles run in each direction. */
static void expect_closed(const struct resource *mesh)
{
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        const float *a = position(mesh, i), *b = position(mesh, i % 3 == 2 ? i - 2 : i + 1);
        int ways = 0;
        for (uint32_t j = 0; j < mesh->index_count; j++)
            ways += runs(mesh, j, a, b) - runs(mesh, j, b, a);
        TEST_ASSERT_EQUAL_INT(0, ways);
    }
}

static void expect_normals_outside(const struct resource *mesh)
{
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        const float *n = part(mesh, TRIPTYCH_NORMAL, i);
        double face[3], along = 0, length = 0;
        face_normal(mesh, i / 3 * 3, face);
        for (int c = 0; c < 3; c++) {
            along += face[c] * (double)n[c];
            length += (double)n[c] * (double)n[c];
        }
        TEST_ASSERT_TRUE(along > 0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1, length);
    }
}

static void closed_shapes_enclose_their_volume_with_fronts_and_normals_outside(void)
{
    static const struct {
        const char *text;
        double volume, within;
    } shapes[] = {
        {"mesh m box", 8, 0}, {"mesh m sphere 24 16", 4, 0.2}, {"mesh m torus 0.25 24 12", 1.15, 0.1}};
    TEST_ASSERT_DOUBLE_WITHIN(0.2, 4 * pi / 3,
                              4); /* the sphere's and the torus' volume, less the error of facets */
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 2 * pi * pi * 0.0625, 1.15);
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        const struct resource *mesh = make(shapes[i].text);
        expect_closed(mesh);
        expect_normals_outside(mesh);
        TEST_ASSERT_DOUBLE_WITHIN(shapes[i].within, shapes[i].volume, volume(mesh));
    }
}

static void open_shapes_have_their_fronts_outside(void)
{
    expect_normals_outside(make("mesh m cylinder 12 3"));
    const struct resource *mesh = make("mesh m grid 3 2");
    expect_normals_outside(mesh);
    TEST_ASSERT_EQUAL_UINT(12, mesh->vertex_count);
    TEST_ASSERT_EQUAL_UINT(36, mesh->index_count);
}

/* u grows to the right and v down as seen from the front, so texture corners turn against the front. */
static void texture_coordinates_are_upright_and_repeated(void)
{
    static const char *const shapes[] = {"mesh m box repeat 3 2", "mesh m grid 2 2 repeat 3 2",
                                         "mesh m sphere 8 6 repeat 3 2", "mesh m cylinder 8 2 repeat 3 2",
                                         "mesh m torus 0.3 8 6 repeat 3 2"};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        const struct resource *mesh = make(shapes[i]);
        float most[2] = {0};
        for (uint32_t c = 0; c < mesh->index_count; c += 3) {
            const float *t[3];
            for (uint32_t k = 0; k < 3; k++) {
                t[k] = part(mesh, TRIPTYCH_TEXCOORD, c + k);
                most[0] = fmaxf(most[0], t[k][0]);
                most[1] = fmaxf(most[1], t[k][1]);
            }
            TEST_ASSERT_TRUE((t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) <
                             (t[1][1] - t[0][1]) * (t[2][0] - t[0][0]));
        }
        TEST_ASSERT_EQUAL_FLOAT(3, most[0]);
        TEST_ASSERT_EQUAL_FLOAT(2, most[1]);
    }
}

static void a_shadow_volume_is_the_prism_of_the_lit_faces(void)
{
    static const struct {
        const char *text;
        double volume;
    } shadows[] = {
        {"mesh m box\nmesh s shadow m directional 0 -2 0 5", 4 * 5},
        {"mesh m box\nmesh s shadow m directional 1 -1 1 5", 20 * 1.7320508075688772},
        {"mesh m grid 4 4\nmesh s shadow m directional 3 -4 0 10", 4 * 10 * 0.8},
        {"mesh m torus 0.25 48 24\nmesh s shadow m directional 0 -1 0 8", 0},
    };
    for (size_t i = 0; i < sizeof shadows / sizeof *shadows; i++) {
        const struct resource *mesh = make(shadows[i].text);
        expect_closed(mesh);
        if (shadows[i].volume > 0)
            TEST_ASSERT_DOUBLE_WITHIN(1e-4, shadows[i].volume, volume(mesh));
        else /* a ring from 0.75 to 1.25 */
            TEST_ASSERT_DOUBLE_WITHIN(0.15, 8 * pi * (1.25 * 1.25 - 0.75 * 0.75), volume(mesh));
    }
}

static void a_point_lights_shadow_goes_away_from_it(void)
{
    const float light[3] = {1, 4, -2};
    const struct resource *mesh = make("mesh m sphere 12 8\nmesh s shadow m point 1 4 -2 6");
    expect_closed(mesh);
    TEST_ASSERT_TRUE(volume(mesh) > 0);
    for (uint32_t v = 0; v < mesh->vertex_count; v += 2) {
        const float *near = (const float *)(mesh->vertices + (size_t)v * mesh->layout.stride);
        const float *far = near + mesh->layout.stride / 4;
        double distance = 0, farther = 0;
        for (int i = 0; i < 3; i++) {
            distance += ((double)near[i] - light[i]) * ((double)near[i] - light[i]);
            farther += ((double)far[i] - light[i]) * ((double)far[i] - light[i]);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, sqrt(distance) + 6, sqrt(farther));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(closed_shapes_enclose_their_volume_with_fronts_and_normals_outside);
    RUN_TEST(open_shapes_have_their_fronts_outside);
    RUN_TEST(texture_coordinates_are_upright_and_repeated);
    RUN_TEST(a_shadow_volume_is_the_prism_of_the_lit_faces);
    RUN_TEST(a_point_lights_shadow_goes_away_from_it);
    return UNITY_END();
}
