/* Vertex blending and tweening on every engine, against sums of transformed positions in double: vertexblend
 * with up to three weights, indexedvertexblendenable with a palette of 256 matrices, tweenfactor. */
#include "tests/support/picture/canvas.h"
#include "tests/support/picture/shading.h"

#include "render/derive/derive.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { VERTICES = 32 };

static struct vertex {
    float position[4], second[4], normal[3], second_normal[3];
    float weights[4];
    uint8_t indices[4];
} vertex[VERTICES];

static struct palette_entry *palette;

void setUp(void)
{
    palette = malloc(WORLD_MATRICES * sizeof *palette);
    TEST_ASSERT_NOT_NULL(palette);
}

void tearDown(void)
{
    shading_close();
    free(palette);
}

static void randomize(float *values, int count, double low, double high)
{
    for (int i = 0; i < count; i++)
        values[i] = (float)random_between(low, high);
}

static void randomize_matrix(unsigned which)
{
    randomize(shading_state.transform[which][0], 16, -1, 1);
    for (int i = 0; i < 3; i++)
        shading_state.transform[which][i][3] = 0;
    shading_state.transform[which][3][3] = 1;
}

static void bind_vertices(void)
{
    for (int i = 0; i < VERTICES; i++) {
        randomize(vertex[i].position, 4, -1, 1);
        randomize(vertex[i].second, 4, -1, 1);
        randomize(vertex[i].normal, 3, -1, 1);
        randomize(vertex[i].second_normal, 3, -1, 1);
        randomize(vertex[i].weights, 4, 0, 0.5);
        for (int c = 0; c < 4; c++)
            vertex[i].indices[c] = (uint8_t)random_word();
    }
    shading_bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT4, vertex[0].position, sizeof *vertex);
    shading_bind(TRIPTYCH_POSITION1, TRIPTYCH_FORMAT_FLOAT4, vertex[0].second, sizeof *vertex);
    shading_bind(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3, vertex[0].normal, sizeof *vertex);
    shading_bind(TRIPTYCH_NORMAL1, TRIPTYCH_FORMAT_FLOAT3, vertex[0].second_normal, sizeof *vertex);
    shading_bind(TRIPTYCH_WEIGHTS, TRIPTYCH_FORMAT_FLOAT4, vertex[0].weights, sizeof *vertex);
    shading_bind(TRIPTYCH_INDICES, TRIPTYCH_FORMAT_UBYTE4, vertex[0].indices, sizeof *vertex);
    for (unsigned t = 0; t < TRIPTYCH_TRANSFORM_COUNT; t++)
        randomize_matrix(t);
    randomize(shading_state.transform[TRIPTYCH_TRANSFORM_PROJECTION][0], 16, -1, 1);
}

static void multiplied(const double v[4], unsigned which, double out[4])
{
    float(*m)[4] = shading_state.transform[which];
    for (int c = 0; c < 4; c++)
        out[c] =
            v[0] * (double)m[0][c] + v[1] * (double)m[1][c] + v[2] * (double)m[2][c] + v[3] * (double)m[3][c];
}

static unsigned world(unsigned i)
{
    return i ? TRIPTYCH_TRANSFORM_WORLD1 + i - 1 : TRIPTYCH_TRANSFORM_WORLD;
}

/* The sum over matrices of weight * p * world * view, through the projection. */
static void expected_position(const struct vertex *v, int matrices, int indexed, double out[4])
{
    double camera[4] = {0}, left = 1;
    for (int i = 0; i < matrices; i++) {
        double p[4], in_world[4], in_camera[4], weight = i < matrices - 1 ? (double)v->weights[i] : left;
        left -= weight;
        for (int c = 0; c < 4; c++)
            p[c] = (double)v->position[c];
        multiplied(p, world(indexed ? v->indices[i] : (unsigned)i), in_world);
        multiplied(in_world, TRIPTYCH_TRANSFORM_VIEW, in_camera);
        for (int c = 0; c < 4; c++)
            camera[c] += weight * in_camera[c];
    }
    multiplied(camera, TRIPTYCH_TRANSFORM_PROJECTION, out);
}

static void check_positions(int matrices, int indexed)
{
    shade(VERTICES);
    for (uint32_t i = 0; i < VERTICES; i++) {
        double expected[4];
        expected_position(&vertex[i], matrices, indexed, expected);
        for (int c = 0; c < 4; c++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, expected[c], (double)shaded_slot(SLOT_X + c, i));
    }
}

/* Makes the palette that indices need. In a draw the device makes it. */
static const struct palette_entry *make_palette(void)
{
    derive_palette(&shading_state, palette);
    return palette;
}

static void check_blending(void)
{
    static const char *const words[] = {"0weights", "1weights", "2weights", "3weights"};
    bind_vertices();
    for (int indexed = 0; indexed < 2; indexed++)
        for (int weights = 0; weights < 4; weights++) {
            SHADING_SET(vertexblend, words[weights]);
            SHADING_NUMBER(indexedvertexblendenable, (uint32_t)indexed);
            shading_palette = make_palette();
            check_positions(weights + 1, indexed);
        }
    SHADING_SET(vertexblend, "disable");
    check_positions(1, 0);
}

static void test_positions_are_blended_by_weights(void)
{
    shading_on_every_engine(check_blending);
}

/* An index after the end of the palette selects its last matrix, and an index before its start the first
 * one. */
static void check_limits(void)
{
    static const float wild[4] = {1e9f, -3, 255.4f, 300};
    bind_vertices();
    SHADING_SET(vertexblend, "3weights");
    SHADING_SET(indexedvertexblendenable, "true");
    shading_palette = make_palette();
    shading_bind(TRIPTYCH_INDICES, TRIPTYCH_FORMAT_FLOAT4, wild, 0);
    for (int i = 0; i < VERTICES; i++)
        memcpy(vertex[i].indices, (uint8_t[4]){255, 0, 255, 255}, 4);
    check_positions(4, 1);
    static const uint32_t color = 0x04010203; /* red 1, green 2, blue 3, alpha 4 */
    shading_bind(TRIPTYCH_INDICES, TRIPTYCH_FORMAT_COLOR, &color, 0);
    for (int i = 0; i < VERTICES; i++)
        memcpy(vertex[i].indices, (uint8_t[4]){1, 2, 3, 4}, 4);
    check_positions(4, 1);
    shading_bind(TRIPTYCH_INDICES, TRIPTYCH_FORMAT_NONE, NULL, 0);
    for (int i = 0; i < VERTICES; i++)
        memset(vertex[i].indices, 0, 4);
    check_positions(4, 1);
}

static void test_indices_are_limited_to_the_palette(void)
{
    shading_on_every_engine(check_limits);
}

/* One light along each axis, so that the colour is the positive part of the blended normal. */
static void light_axes(void)
{
    memset(&shading_state.material, 0, sizeof shading_state.material);
    for (int i = 0; i < 3; i++) {
        shading_state.material.diffuse[i] = 1;
        shading_state.light_enabled[i] = 1;
        shading_state.light[i] = (struct triptych_light){.type = TRIPTYCH_LIGHT_DIRECTIONAL};
        shading_state.light[i].diffuse[i] = 1;
        shading_state.light[i].direction[i] = -1;
    }
    float(*view)[4] = shading_state.transform[TRIPTYCH_TRANSFORM_VIEW];
    memset(view, 0, 16 * sizeof(float));
    for (int i = 0; i < 4; i++)
        view[i][i] = 1;
}

/* Matrices that rotate and stretch along axes, whose inverse transposes are simple. */
static void check_normals(void)
{
    static const float stretch[4][3] = {{2, 1, 1}, {1, 4, 1}, {1, 1, 0.5f}, {0.25f, 2, 1}};
    bind_vertices();
    light_axes();
    for (unsigned i = 0; i < 4; i++) {
        float(*m)[4] = shading_state.transform[world(i)];
        memset(m, 0, 16 * sizeof(float));
        for (int c = 0; c < 3; c++)
            m[c][c] = stretch[i][c];
        m[3][3] = 1;
    }
    SHADING_SET(vertexblend, "3weights");
    shading_varying[VARYING_diffuse] = INTERPOLATION_SMOOTH;
    shade(VERTICES);
    for (uint32_t i = 0; i < VERTICES; i++) {
        double left = 1, normal[3] = {0};
        for (int m = 0; m < 4; m++) {
            double weight = m < 3 ? (double)vertex[i].weights[m] : left;
            left -= weight;
            for (int c = 0; c < 3; c++)
                normal[c] += weight * (double)vertex[i].normal[c] / (double)stretch[m][c];
        }
        for (int c = 0; c < 3; c++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, fmin(fmax(normal[c], 0), 1),
                                      (double)shaded_slot(SLOT_diffuse + c, i));
    }
}

static void test_normals_are_blended_by_inverse_transposes(void)
{
    shading_on_every_engine(check_normals);
}

static void check_tweening(void)
{
    bind_vertices();
    light_axes();
    float(*m)[4] = shading_state.transform[TRIPTYCH_TRANSFORM_WORLD];
    memset(m, 0, 16 * sizeof(float));
    for (int i = 0; i < 4; i++)
        m[i][i] = 1;
    SHADING_SET(vertexblend, "tweening");
    shading_varying[VARYING_diffuse] = INTERPOLATION_SMOOTH;
    for (int step = 0; step <= 4; step++) {
        double t = step / 4.0;
        SHADING_NUMBER(tweenfactor, bits_of_float((float)t));
        shade(VERTICES);
        for (uint32_t i = 0; i < VERTICES; i++) {
            const struct vertex *v = &vertex[i];
            double p[4], clip[4];
            for (int c = 0; c < 4; c++)
                p[c] = (1 - t) * (double)v->position[c] + t * (double)v->second[c];
            multiplied(p, TRIPTYCH_TRANSFORM_PROJECTION, clip);
            for (int c = 0; c < 4; c++)
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, clip[c], (double)shaded_slot(SLOT_X + c, i));
            for (int c = 0; c < 3; c++) {
                double n = (1 - t) * (double)v->normal[c] + t * (double)v->second_normal[c];
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, fmin(fmax(n, 0), 1),
                                          (double)shaded_slot(SLOT_diffuse + c, i));
            }
        }
    }
}

static void test_tweening_goes_from_one_position_to_the_other(void)
{
    shading_on_every_engine(check_tweening);
}

/* Through the interface: draws queued with different palettes each keep their own. */
static void check_palettes(void)
{
    static const float square[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    static const float seven = 7;
    triptych_buffer *corners, *index;
    OK(triptych_buffer_create(device, square, sizeof square, &corners));
    OK(triptych_buffer_create(device, &seven, sizeof seven, &index));
    OK(triptych_set_element(device, TRIPTYCH_POSITION,
                            &(struct triptych_element){TRIPTYCH_FORMAT_FLOAT2, corners, 0, 8}));
    OK(triptych_set_element(device, TRIPTYCH_INDICES,
                            &(struct triptych_element){TRIPTYCH_FORMAT_FLOAT1, index, 0, 0}));
    set(TRIPTYCH_STATE_VERTEXBLEND, "0weights");
    set(TRIPTYCH_STATE_INDEXEDVERTEXBLENDENABLE, "true");
    clear_to(0xff000000);
    for (int i = 0; i < 8; i++) { /* column i, every second row */
        float matrix[4][4] = {{0.25f, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
        matrix[3][0] = -1 + 0.25f * (float)i;
        matrix[3][1] = i % 2 ? 0 : -1;
        OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_WORLD1 + 6, matrix));
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    }
    OK(triptych_read_color(device, image, sizeof image));
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            expect_pixel(x, y, (y < SIZE / 2) == (x / 8 % 2) ? 0xffffffff : 0xff000000, "palette");
}

static void test_every_draw_keeps_its_palette(void)
{
    on_every_engine(check_palettes);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_positions_are_blended_by_weights);
    RUN_TEST(test_indices_are_limited_to_the_palette);
    RUN_TEST(test_normals_are_blended_by_inverse_transposes);
    RUN_TEST(test_tweening_goes_from_one_position_to_the_other);
    RUN_TEST(test_every_draw_keeps_its_palette);
    return UNITY_END();
}
