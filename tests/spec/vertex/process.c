/* Vertices after transformation, on every engine: positions are those of the documented formulas, and every
 * output is equal on all engines. Drawn as vertices in the window they give the picture of the draw. */
#include "tests/support/picture/canvas.h"

#include "base/bits.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

enum { VERTICES = 600 }; /* more than the lanes of a batch */

struct vertex {
    float position[3], normal[3];
    uint32_t diffuse, specular;
    float size;
    float texcoord[4];
};

static struct vertex vertex[VERTICES];
static struct triptych_processed_vertex out[VERTICES + 1], kept[VERTICES];
static unsigned engines;
static uint32_t direct[SIZE * SIZE];

static triptych_buffer *buffer_of(const void *data, size_t bytes)
{
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, data, bytes, &buffer));
    return buffer;
}

static void bind(enum triptych_attribute attribute, enum triptych_format format, triptych_buffer *buffer,
                 size_t offset)
{
    struct triptych_element element = {format, buffer, offset, sizeof(struct vertex)};
    OK(triptych_set_element(device, attribute, &element));
}

static void bind_vertices(void)
{
    for (int i = 0; i < VERTICES; i++) {
        for (int c = 0; c < 3; c++) {
            vertex[i].position[c] = (float)dyadic(-2, 2);
            vertex[i].normal[c] = (float)dyadic(-1, 1);
        }
        vertex[i].diffuse = random_word();
        vertex[i].specular = random_word();
        vertex[i].size = (float)dyadic(1, 9);
        for (int c = 0; c < 4; c++)
            vertex[i].texcoord[c] = (float)dyadic(-4, 4);
    }
    triptych_buffer *buffer = buffer_of(vertex, sizeof vertex);
    bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3, buffer, offsetof(struct vertex, position));
    bind(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3, buffer, offsetof(struct vertex, normal));
    bind(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR, buffer, offsetof(struct vertex, diffuse));
    bind(TRIPTYCH_SPECULAR, TRIPTYCH_FORMAT_COLOR, buffer, offsetof(struct vertex, specular));
    bind(TRIPTYCH_POINT_SIZE, TRIPTYCH_FORMAT_FLOAT1, buffer, offsetof(struct vertex, size));
    bind(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT4, buffer, offsetof(struct vertex, texcoord));
}

static const float view[4][4] = {{0.8f, 0, 0.6f, 0}, {0, 1, 0, 0}, {-0.6f, 0, 0.8f, 0}, {0.25f, -0.5f, 4, 1}};
static const float projection[4][4] = {{1.5f, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 1.125f, 1}, {0, 0, -1.125f, 0}};

static void transform(const float from[4], const float m[4][4], double to[4])
{
    for (int c = 0; c < 4; c++) {
        to[c] = 0;
        for (int r = 0; r < 4; r++)
            to[c] += (double)from[r] * (double)m[r][c];
    }
}

static void expect_near(double expected, float got, const char *what)
{
    char message[120];
    if (fabs(expected - (double)got) <= 1e-5 * (1 + fabs(expected)))
        return;
    snprintf(message, sizeof message, "%s: expected %.9g, got %.9g", what, expected, (double)got);
    TEST_FAIL_MESSAGE(message);
}

/* The first engine's outputs are those of all. */
static void expect_same_on_engines(void)
{
    if (engines++)
        TEST_ASSERT_EQUAL_MEMORY(kept, out, sizeof kept);
    memcpy(kept, out, sizeof kept);
}

static void set_transforms(void)
{
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_VIEW, view));
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_PROJECTION, projection));
    OK(triptych_set_viewport(device, &(struct triptych_viewport){-20, 8, 100, 40, 0.25f, 0.75f}));
}

/* --- Fixed function --- */

static void expect_position(const struct vertex *v, const struct triptych_processed_vertex *got)
{
    const float world[4] = {v->position[0], v->position[1], v->position[2], 1};
    double camera[4], clip[4];
    float rounded[4];
    transform(world, view, camera);
    for (int c = 0; c < 4; c++)
        rounded[c] = (float)camera[c];
    transform(rounded, projection, clip);
    for (int c = 0; c < 4; c++)
        expect_near(clip[c], got->clip[c], "clip");
    expect_near(-20 + 50 + 50 * clip[0] / clip[3], got->position[0], "x");
    expect_near(8 + 20 - 20 * clip[1] / clip[3], got->position[1], "y");
    expect_near(0.25 + 0.5 * clip[2] / clip[3], got->position[2], "depth");
    expect_near(1 / clip[3], got->position[3], "1/w");
}

static void check_fixed(void)
{
    static const float scale[4][4] = {{2, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 4, 0}, {0.5f, 0, 0, 1}};
    bind_vertices();
    set_transforms();
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_TEXTURE0 + 2, scale));
    OK(triptych_set_stage_state(device, 2, TRIPTYCH_STAGE_TEXCOORDINDEX, 0));
    set_stage(2, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, "count4");
    OK(triptych_set_state(device, TRIPTYCH_STATE_POINTSIZE_MAX, triptych_float_bits(6)));
    OK(triptych_process_vertices(device, 0, VERTICES, out));
    for (int i = 0; i < VERTICES; i++) {
        const struct vertex *v = &vertex[i];
        expect_position(v, &out[i]);
        for (int c = 0; c < 4; c++) {
            expect_near(channel(image_word(v->diffuse), c) / 255.0, out[i].color[0][c], "diffuse");
            expect_near(channel(image_word(v->specular), c) / 255.0, out[i].color[1][c], "specular");
            TEST_ASSERT_EQUAL_FLOAT(v->texcoord[c], out[i].texcoord[0][c]);
            TEST_ASSERT_EQUAL_FLOAT(c == 3 ? 1 : 0, out[i].texcoord[1][c]);
        }
        expect_near((double)v->texcoord[0] * 2 + 0.5 * (double)v->texcoord[3], out[i].texcoord[2][0], "u");
        expect_near((double)v->texcoord[2] * 4, out[i].texcoord[2][2], "third");
        TEST_ASSERT_EQUAL_FLOAT(fminf(v->size, 6), out[i].point_size);
        TEST_ASSERT_EQUAL_FLOAT(1, out[i].fog);
    }
    expect_same_on_engines();
}

/* NaNs of both signs and of any payload, as they are and as operands. */
static void check_nan(void)
{
    static const uint32_t nan[] = {0x7fc00000, 0xffc00000, 0x7fc00001, 0xffffffff};
    bind_vertices();
    for (int i = 0; i < VERTICES; i++) {
        vertex[i].texcoord[0] = bits_to_float(nan[i % 4]);
        vertex[i].position[1] = bits_to_float(nan[i / 4 % 4]);
    }
    triptych_buffer *buffer = buffer_of(vertex, sizeof vertex);
    bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3, buffer, offsetof(struct vertex, position));
    bind(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT4, buffer, offsetof(struct vertex, texcoord));
    set_transforms();
    OK(triptych_process_vertices(device, 0, VERTICES, out));
    for (int i = 0; i < VERTICES; i++) {
        TEST_ASSERT_EQUAL_HEX32(0x7fc00000, bits_of_float(out[i].texcoord[0][0]));
        TEST_ASSERT_EQUAL_HEX32(0x7fc00000, bits_of_float(out[i].clip[1]));
        TEST_ASSERT_EQUAL_HEX32(0x7fc00000, bits_of_float(out[i].position[1]));
    }
    expect_same_on_engines();
}

static void test_a_nan_has_one_form(void)
{
    engines = 0;
    on_every_engine(check_nan);
}

static void test_fixed_function(void)
{
    engines = 0;
    on_every_engine(check_fixed);
}

static void light(void)
{
    struct triptych_light directional = {
        .type = TRIPTYCH_LIGHT_DIRECTIONAL, .diffuse = {1, 0.5f, 0.25f, 1}, .specular = {1, 1, 1, 1}};
    directional.direction[2] = 1;
    set(TRIPTYCH_STATE_LIGHTING, "true");
    set(TRIPTYCH_STATE_SPECULARENABLE, "true");
    OK(triptych_set_light(device, 0, &directional));
    OK(triptych_enable_light(device, 0, 1));
}

/* The cosine of the light, which comes along +z, times a channel of the vertex' diffuse colour. */
static double lit(const struct vertex *v, int c)
{
    const float *n = v->normal;
    double length =
        sqrt((double)n[0] * (double)n[0] + (double)n[1] * (double)n[1] + (double)n[2] * (double)n[2]);
    return fmax(-(double)n[2] / length, 0) * channel(image_word(v->diffuse), c) / 255.0;
}

static void check_lit(void)
{
    bind_vertices();
    set_transforms();
    light();
    set(TRIPTYCH_STATE_NORMALIZENORMALS, "true");
    set(TRIPTYCH_STATE_FOGENABLE, "true");
    set(TRIPTYCH_STATE_FOGVERTEXMODE, "linear");
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGSTART, triptych_float_bits(2)));
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGEND, triptych_float_bits(6)));
    OK(triptych_process_vertices(device, 0, VERTICES, out));
    for (int i = 0; i < VERTICES; i++) {
        double distance = (double)out[i].clip[3];
        expect_near(fmin(fmax((6 - distance) / 4, 0), 1), out[i].fog, "fog");
        expect_near(lit(&vertex[i], 0), out[i].color[0][0], "red");
        expect_near(lit(&vertex[i], 2) / 4, out[i].color[0][2], "blue");
    }
    expect_same_on_engines();
}

static void test_light_and_fog(void)
{
    engines = 0;
    on_every_engine(check_lit);
}

/* --- A shader --- */

static void check_shader(void)
{
    static const char text[] =
        "vs_2_0\ndcl_position v0\ndcl_texcoord v1\ndcl_color v2\ndef c1, 2, 0.5, 3, 1\n"
        "mul oPos, v0, c1\nmov oT3, v1\nmul oT5.xy, v1, c0\nmov oD0, v2\n"
        "mul oPts.x, c1.z, c1.x\nmov oFog.x, c1.y\n";
    const float factor[4] = {4, 8, 0, 0};
    triptych_shader *shader;
    bind_vertices();
    OK(triptych_shader_assemble(device, "process", text, strlen(text), &shader));
    OK(triptych_set_vertex_shader(device, shader));
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 0, factor, 1));
    set(TRIPTYCH_STATE_FOGENABLE, "true");
    OK(triptych_process_vertices(device, 0, VERTICES, out));
    for (int i = 0; i < VERTICES; i++) {
        const struct vertex *v = &vertex[i];
        TEST_ASSERT_EQUAL_FLOAT(2 * v->position[0], out[i].clip[0]);
        TEST_ASSERT_EQUAL_FLOAT(1, out[i].clip[3]);
        expect_near(32 + 32 * 2 * (double)v->position[0], out[i].position[0], "x");
        for (int c = 0; c < 4; c++)
            TEST_ASSERT_EQUAL_FLOAT(v->texcoord[c], out[i].texcoord[3][c]);
        TEST_ASSERT_EQUAL_FLOAT(4 * v->texcoord[0], out[i].texcoord[5][0]);
        TEST_ASSERT_EQUAL_FLOAT(8 * v->texcoord[1], out[i].texcoord[5][1]);
        TEST_ASSERT_EQUAL_FLOAT(1, out[i].texcoord[5][3]);
        expect_near(channel(image_word(v->diffuse), 1) / 255.0, out[i].color[0][1], "diffuse");
        TEST_ASSERT_EQUAL_FLOAT(6, out[i].point_size);
        TEST_ASSERT_EQUAL_FLOAT(0.5f, out[i].fog);
    }
    expect_same_on_engines();
}

static void test_shader_outputs(void)
{
    engines = 0;
    on_every_engine(check_shader);
}

/* --- In the window --- */

static void check_window(void)
{
    static const float given[2][4] = {{12.5f, -3, 0.5f, 0.25f}, {1e6f, 7, 2, 1}};
    struct triptych_element element = {TRIPTYCH_FORMAT_FLOAT4, buffer_of(given, sizeof given), 0, 16};
    OK(triptych_set_element(device, TRIPTYCH_POSITIONT, &element));
    OK(triptych_process_vertices(device, 1, 1, out));
    TEST_ASSERT_EQUAL_MEMORY(given[1], out[0].position, sizeof given[1]);
    TEST_ASSERT_EQUAL_MEMORY(given[1], out[0].clip, sizeof given[1]);
    TEST_ASSERT_EQUAL_FLOAT(1, out[0].color[0][0]);
    TEST_ASSERT_EQUAL_FLOAT(0, out[0].color[1][0]);
}

/* Direct3D 9's vertices with a 1/w of 0 have the colours and texels of those with 1. */
static void check_window_without_w(void)
{
    static const uint32_t colors[4] = {0xff0000ff, 0xff00ff00, 0xffff0000, 0xffffffff};
    float given[4][4] = {{5, 5, 0.5f, 1}, {60, 5, 0.5f, 1}, {5, 60, 0.5f, 1}, {60, 60, 0.5f, 1}};
    struct triptych_element color = {TRIPTYCH_FORMAT_COLOR, buffer_of(colors, sizeof colors), 0, 4};
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &color));
    for (int i = 0; i < 2; i++) {
        struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer_of(given, sizeof given), 0, 16};
        OK(triptych_set_element(device, TRIPTYCH_POSITIONT, &position));
        clear_to(0);
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
        OK(triptych_read_color(device, i ? image : direct, sizeof image));
        for (int v = 0; v < 4; v++)
            given[v][3] = 0;
    }
    TEST_ASSERT_NOT_EQUAL(direct[10 * SIZE + 10], direct[50 * SIZE + 50]);
    TEST_ASSERT_EQUAL_MEMORY(direct, image, sizeof image);
}

static void test_vertices_in_the_window_without_w(void)
{
    on_every_engine(check_window_without_w);
}

static void test_vertices_in_the_window_stay(void)
{
    on_every_engine(check_window);
}

/* The projected vertices are snapped to 1/256 pixel again: edges of this square are far from pixel centres.
 */
static void check_drawn_again(void)
{
    OK(triptych_set_viewport(device, &(struct triptych_viewport){-10, 5, 66, 51, 0, 1}));
    clear_to(0);
    draw_square(0.5f, 0xff4080c0, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, direct, sizeof direct));
    OK(triptych_process_vertices(device, 0, 4, out));
    clear_to(0);
    triptych_buffer *buffer = buffer_of(out, 4 * sizeof *out);
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof *out};
    struct triptych_element color = {TRIPTYCH_FORMAT_FLOAT4, buffer,
                                     offsetof(struct triptych_processed_vertex, color), sizeof *out};
    OK(triptych_set_element(device, TRIPTYCH_POSITION,
                            &(struct triptych_element){TRIPTYCH_FORMAT_NONE, NULL, 0, 0}));
    OK(triptych_set_element(device, TRIPTYCH_POSITIONT, &position));
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &color));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    OK(triptych_read_color(device, image, sizeof image));
    TEST_ASSERT_EQUAL_MEMORY(direct, image, sizeof image);
}

static void test_processed_vertices_drawn_in_the_window_give_the_same_picture(void)
{
    on_every_engine(check_drawn_again);
}

/* --- Misuse --- */

static void check_refusals(void)
{
    memset(out, 0xaa, sizeof out);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_process_vertices(device, 0, 1, out));
    bind_vertices();
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_process_vertices(device, 0, 1, NULL));
    OK(triptych_process_vertices(device, 0, 0, NULL));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_process_vertices(device, 0, VERTICES + 1, out));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_process_vertices(device, UINT32_MAX, 2, out));
    TEST_ASSERT_EQUAL_HEX32(0xaaaaaaaa, bits_of_float(out[0].position[0]));
    OK(triptych_process_vertices(device, VERTICES - 1, 1, out));
    TEST_ASSERT_EQUAL_HEX32(0xaaaaaaaa, bits_of_float(out[1].position[0]));
}

static void test_vertices_outside_of_buffers_are_refused(void)
{
    on_every_engine(check_refusals);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_fixed_function);
    RUN_TEST(test_a_nan_has_one_form);
    RUN_TEST(test_light_and_fog);
    RUN_TEST(test_shader_outputs);
    RUN_TEST(test_vertices_in_the_window_stay);
    RUN_TEST(test_vertices_in_the_window_without_w);
    RUN_TEST(test_processed_vertices_drawn_in_the_window_give_the_same_picture);
    RUN_TEST(test_vertices_outside_of_buffers_are_refused);
    return UNITY_END();
}
