/* Texture coordinates on every engine, against the definition in double: texcoordindex with sets and
 * generators, texturetransformflags with every count and every number of components, projection. */
#include "tests/support/picture/canvas.h"
#include "tests/support/picture/shading.h"

#include <math.h>
#include <string.h>

enum { VERTICES = 32 };

static struct vertex {
    float position[3], normal[3];
    float set[2][4];
} vertex[VERTICES];

static struct triptych_texture texture; /* 4 x 4, one level */

void setUp(void)
{
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 4, 4, 1, 1};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, texture_describe(&description, &texture, NULL));
}

void tearDown(void)
{
    shading_close();
    close_canvas();
}

static void randomize(float *values, int count, double low, double high)
{
    for (int i = 0; i < count; i++)
        values[i] = (float)random_between(low, high);
}

static void set_stage_number(int stage, enum triptych_stage_state state, uint32_t value)
{
    shading_number(TRIPTYCH_STAGE_STATES, (unsigned)stage, state, value);
}

/* Positions in front of the camera, turned by a quarter about z so that spaces differ. */
static void bind_vertices(void)
{
    static const float world[4][4] = {{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {0.5f, 0.25f, 3, 1}};
    for (int i = 0; i < VERTICES; i++) {
        randomize(vertex[i].position, 3, -1, 1);
        randomize(vertex[i].normal, 3, -1, 1);
        randomize(vertex[i].set[0], 8, 0.25, 2);
    }
    memcpy(shading_state.transform[TRIPTYCH_TRANSFORM_WORLD], world, sizeof world);
    for (int i = 0; i < 8; i++)
        randomize(shading_state.transform[TRIPTYCH_TRANSFORM_TEXTURE0 + i][0], 16, -1, 1);
    shading_bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3, vertex[0].position, sizeof *vertex);
    shading_bind(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3, vertex[0].normal, sizeof *vertex);
    shading_state.texture[0] = shading_state.texture[1] = &texture;
    SHADING_SET(lighting, "false");
    SHADING_SET(normalizenormals, "true");
}

static void bind_sets(int components)
{
    enum triptych_format format = (enum triptych_format)(TRIPTYCH_FORMAT_FLOAT1 + components - 1);
    shading_bind(TRIPTYCH_TEXCOORD, format, vertex[0].set[0], sizeof *vertex);
    shading_bind(TRIPTYCH_TEXCOORD3, format, vertex[0].set[1], sizeof *vertex);
}

static void unit(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int c = 0; c < 3; c++)
        v[c] /= length;
}

/* Camera space; the view is the identity. */
static void to_camera(const float v[3], double w, double out[3])
{
    float(*m)[4] = shading_state.transform[TRIPTYCH_TRANSFORM_WORLD];
    for (int c = 0; c < 3; c++)
        out[c] = (double)v[0] * (double)m[0][c] + (double)v[1] * (double)m[1][c] +
                 (double)v[2] * (double)m[2][c] + w * (double)m[3][c];
}

/* Generator 1 to 4 of Direct3D 9. */
static void generated(const struct vertex *v, int generator, double out[4])
{
    double p[3], n[3], along[3], cosine = 0;
    to_camera(v->position, 1, p);
    to_camera(v->normal, 0, n);
    unit(n);
    memcpy(along, p, sizeof along);
    unit(along);
    for (int c = 0; c < 3; c++)
        cosine += along[c] * n[c];
    double r[3];
    for (int c = 0; c < 3; c++)
        r[c] = along[c] - 2 * cosine * n[c];
    double m = 2 * sqrt(r[0] * r[0] + r[1] * r[1] + (r[2] + 1) * (r[2] + 1));
    const double results[4][3] = {
        {n[0], n[1], n[2]}, {p[0], p[1], p[2]}, {r[0], r[1], r[2]}, {r[0] / m + 0.5, r[1] / m + 0.5, 0}};
    memcpy(out, results[generator - 1], sizeof results[0]);
    out[3] = 1;
}

/* The result of a stage: its coordinates after its matrix. */
static void expected_coordinates(const struct vertex *v, int stage, int components, double out[4])
{
    uint32_t index = shading_state.stage[stage][TRIPTYCH_STAGE_TEXCOORDINDEX];
    uint32_t count = shading_state.stage[stage][TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS] & 7;
    float(*m)[4] = shading_state.transform[TRIPTYCH_TRANSFORM_TEXTURE0 + stage];
    double from[4] = {0, 0, 0, 1};
    if (index >> 16) {
        generated(v, (int)(index >> 16), from);
        components = 3;
    } else
        for (int c = 0; c < components; c++)
            from[c] = (double)v->set[(index & 7) == 3][c];
    memcpy(out, from, 4 * sizeof *out);
    if (!count)
        return;
    for (int c = components; c < 4; c++)
        from[c] = c == components;
    for (uint32_t c = 0; c < 4; c++) {
        out[c] = 0;
        for (int row = 0; row < 4 && c < count; row++)
            out[c] += from[row] * (double)m[row][c];
    }
}

static void check_channel(int stage, int channel, int components)
{
    uint32_t flags = shading_state.stage[stage][TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS], count = flags & 7;
    uint32_t index = shading_state.stage[stage][TRIPTYCH_STAGE_TEXCOORDINDEX];
    int projected = (flags & 256) && (!count || count > 2);
    int last = count == 3 || (!count && !(index >> 16) && components == 3) ? 2 : 3;
    TEST_ASSERT_EQUAL_INT(projected, shading_key[UNIT_VERTEX].vertex.varying[varying_divisor(channel)]);
    for (uint32_t i = 0; i < VERTICES; i++) {
        double expected[4];
        expected_coordinates(&vertex[i], stage, components, expected);
        for (int c = 0; c < 2; c++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, expected[c],
                                      (double)shaded_slot(varying_slot[varying_texcoord(channel)] + c, i));
        if (shading_varying[varying_third(channel)])
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, expected[2],
                                      (double)shaded_slot(varying_slot[varying_third(channel)], i));
        if (projected)
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, expected[last],
                                      (double)shaded_slot(varying_slot[varying_divisor(channel)], i));
    }
}

/* --- Tests --------------------------------------------------------------------------------------------- */

static void check_all(void)
{
    static const uint32_t indices[] = {0, 3, 0x10000, 0x20001, 0x30002, 0x40003};
    bind_vertices();
    shading_set(TRIPTYCH_STAGE_STATES, 1, TRIPTYCH_STAGE_COLOROP, "modulate");
    for (int components = 1; components <= 4; components++)
        for (unsigned i = 0; i < sizeof indices / sizeof *indices; i++)
            for (uint32_t flags = 0; flags < 10; flags++) {
                bind_sets(components);
                set_stage_number(0, TRIPTYCH_STAGE_TEXCOORDINDEX, indices[i]);
                set_stage_number(0, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, flags % 5 + (flags < 5 ? 0 : 256));
                set_stage_number(1, TRIPTYCH_STAGE_TEXCOORDINDEX, indices[(i + 1) % 6]);
                set_stage_number(1, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, (flags + 2) % 5);
                shading_varying[VARYING_third0] = flags & 1 ? INTERPOLATION_SMOOTH : INTERPOLATION_NONE;
                shade(VERTICES);
                check_channel(0, 0, components);
                check_channel(1, 1, components);
            }
}

static void test_coordinates_are_selected_generated_and_transformed(void)
{
    shading_on_every_engine(check_all);
}

/* Stages with the same coordinates share a varying, unless a matrix changes the coordinates. */
static void check_sharing(void)
{
    bind_vertices();
    bind_sets(2);
    shading_set(TRIPTYCH_STAGE_STATES, 1, TRIPTYCH_STAGE_COLOROP, "modulate");
    set_stage_number(1, TRIPTYCH_STAGE_TEXCOORDINDEX, 0);
    shade(1);
    TEST_ASSERT_EQUAL_INT(0, shading_key[UNIT_PIXEL].pixel.coordinates[1]);
    set_stage_number(0, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, 2);
    set_stage_number(1, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, 2);
    shade(1);
    TEST_ASSERT_EQUAL_INT(1, shading_key[UNIT_PIXEL].pixel.coordinates[1]);
}

static void test_stages_with_matrices_have_coordinates_of_their_own(void)
{
    shading_on_every_engine(check_sharing);
}

/* A vertex without coordinates has 0 0 0 1. A vertex in window coordinates is not transformed. */
static void check_none(void)
{
    bind_vertices();
    set_stage_number(0, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, 256);
    shade(VERTICES);
    for (uint32_t i = 0; i < VERTICES; i++) {
        TEST_ASSERT_EQUAL_FLOAT(0, shaded_slot(SLOT_texcoord0, i));
        TEST_ASSERT_EQUAL_FLOAT(1, shaded_slot(SLOT_divisor0, i));
    }
    shading_state.transform[TRIPTYCH_TRANSFORM_TEXTURE0][2][0] = 3;
    shading_state.transform[TRIPTYCH_TRANSFORM_TEXTURE0][3][0] = 5; /* 0 0 0 1 times the matrix */
    set_stage_number(0, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, 3);
    shade(VERTICES);
    TEST_ASSERT_EQUAL_FLOAT(5, shaded_slot(SLOT_texcoord0, 0));
    bind_sets(3);
    shading_bind(TRIPTYCH_POSITIONT, TRIPTYCH_FORMAT_FLOAT4, vertex, sizeof *vertex);
    set_stage_number(0, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, 256 + 3);
    set_stage_number(0, TRIPTYCH_STAGE_TEXCOORDINDEX, 0x20000);
    shade(VERTICES);
    for (uint32_t i = 0; i < VERTICES; i++) {
        TEST_ASSERT_EQUAL_FLOAT(vertex[i].set[0][0], shaded_slot(SLOT_texcoord0, i));
        TEST_ASSERT_EQUAL_FLOAT(vertex[i].set[0][2], shaded_slot(SLOT_divisor0, i));
    }
    set_stage_number(0, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, 256);
    shade(VERTICES);
    for (uint32_t i = 0; i < VERTICES; i++)
        TEST_ASSERT_EQUAL_FLOAT(vertex[i].set[0][2], shaded_slot(SLOT_divisor0, i));
}

static void test_missing_coordinates_are_zero_and_those_in_the_window_are_unchanged(void)
{
    shading_on_every_engine(check_none);
}

/* The coordinates (u q, v q, q), where q increases from left to right, are divided by q. The picture must be
 * the texture without distortion. */
static void check_projection(void)
{
    float corner[4][3];
    triptych_buffer *buffer;
    bind_random_texture(SIZE, SIZE);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    TEST_ASSERT_EQUAL_HEX32_ARRAY(texel, image, SIZE * SIZE);
    for (int i = 0; i < 4; i++) {
        float q = i & 1 ? 3 : 0.5f;
        corner[i][0] = (i & 1 ? 1.0f : 0.0f) * q;
        corner[i][1] = (i & 2 ? 1.0f : 0.0f) * q;
        corner[i][2] = q;
    }
    OK(triptych_buffer_create(device, corner, sizeof corner, &buffer));
    OK(triptych_set_element(device, TRIPTYCH_TEXCOORD,
                            &(struct triptych_element){TRIPTYCH_FORMAT_FLOAT3, buffer, 0, 12}));
    float identity[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_TEXTURE0, identity));
    set_stage(0, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, "count3_projected");
    clear_to(0);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    OK(triptych_read_color(device, image, sizeof image));
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x + y < SIZE - 1;
             x++) { /* in the first triangle u q = 3 x, v q = y / 2, q = 1/2 + 5/2 x */
            double across = (x + 0.5) / SIZE, q = 0.5 + 2.5 * across;
            double u = 3 * across / q * SIZE, v = 0.5 * (y + 0.5) / q;
            if (fabs(u - nearbyint(u)) > 4e-3 && fabs(v - nearbyint(v)) > 4e-3)
                expect_pixel(x, y, texel[(int)v * SIZE + (int)u], "projected");
        }
}

static void test_projected_coordinates_are_divided_at_the_pixel(void)
{
    on_every_engine(check_projection);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_coordinates_are_selected_generated_and_transformed);
    RUN_TEST(test_stages_with_matrices_have_coordinates_of_their_own);
    RUN_TEST(test_missing_coordinates_are_zero_and_those_in_the_window_are_unchanged);
    RUN_TEST(test_projected_coordinates_are_divided_at_the_pixel);
    return UNITY_END();
}
