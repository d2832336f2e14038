/* Draws (front/d3d9/draw): what is valid, what is drawn, and what a draw unbinds. */
#include "front/d3d9/draw/buffer.h"
#include "tests/support/front/device.h"

#include <string.h>
#include <unity.h>

enum { POINTS = 1, TRIANGLES = 4, STRIP = 5, INVALID = D3D9_INVALID_CALL, INDEX16 = 101, INDEX32 = 102 };
enum { XYZRHW_DIFFUSE = 0x044, XYZ_DIFFUSE = 0x042 };
enum { RED = 0xffff0000, GREEN = 0xff00ff00, BLUE = 0xff0000ff };

struct vertex {
    float x, y, z, w;
    uint32_t color;
};

static struct d3d9_device *device;
static struct d3d9_vertex_buffer *vertices;
static struct d3d9_index_buffer *indices;

/* A strip over the whole target. */
static void quad(struct vertex v[4], uint32_t color)
{
    for (int i = 0; i < 4; i++)
        v[i] = (struct vertex){i & 1 ? BARE_WIDTH : -1, i & 2 ? BARE_HEIGHT : -1, 0, 1, color};
}

static void write(struct d3d9_vertex_buffer *buffer, uint32_t color, uint32_t flags)
{
    void *data = NULL;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_vertex_buffer_lock(buffer, 0, 0, &data, flags));
    quad(data, color);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_vertex_buffer_unlock(buffer));
}

void setUp(void)
{
    static const uint16_t order[6] = {0, 1, 2, 2, 1, 3};
    void *data;
    device = bare_device_make(D3D9_CREATE_HARDWARE_VERTICES);
    bare_device_begin(device);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_vertex_buffer(device, 4 * sizeof(struct vertex),
                                                                      D3D9_USAGE_DYNAMIC, 0,
                                                                      D3D9_POOL_DEFAULT, &vertices, NULL));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_index_buffer(device, sizeof order, 0, INDEX16,
                                                                     D3D9_POOL_MANAGED + 1, &indices, NULL));
    d3d9_index_buffer_lock(indices, 0, 0, &data, 0);
    memcpy(data, order, sizeof order);
    d3d9_index_buffer_unlock(indices);
    d3d9_device_set_fvf(device, XYZRHW_DIFFUSE);
    d3d9_device_set_stream_source(device, 0, vertices, 0, sizeof(struct vertex));
    d3d9_device_set_indices(device, indices);
    write(vertices, RED, 0);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release((struct d3d9_object *)vertices));
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release((struct d3d9_object *)indices));
    bare_device_free(device);
}

static void expect(uint32_t color)
{
    TEST_ASSERT_EQUAL_HEX32(color, bare_device_pixel(device, 0, 0));
    TEST_ASSERT_EQUAL_HEX32(color, bare_device_pixel(device, BARE_WIDTH - 1, BARE_HEIGHT - 1));
}

static void draw(void)
{
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_draw_primitive(device, STRIP, 0, 2));
}

static int32_t draw_indexed(void)
{
    return d3d9_device_draw_indexed_primitive(device, TRIANGLES, 0, 0, 4, 0, 2);
}

static void vertices_and_indices_of_buffers_are_drawn(void)
{
    draw();
    expect(RED);
    write(vertices, GREEN, 0);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, draw_indexed());
    expect(GREEN);
}

static void each_draw_has_the_bytes_of_its_time(void)
{
    static const uint32_t flags[] = {0, D3D9_LOCK_DISCARD, D3D9_LOCK_NO_OVERWRITE, D3D9_LOCK_READ_ONLY};
    struct d3d9_viewport half = {.width = BARE_WIDTH / 2, .height = BARE_HEIGHT, .max_z = 1};
    for (int i = 0; i < 2; i++) {
        struct d3d9_viewport whole = {.width = BARE_WIDTH, .height = BARE_HEIGHT, .max_z = 1};
        write(vertices, RED, 0);
        d3d9_device_set_viewport(device, &whole);
        draw();
        write(vertices, BLUE, flags[i]);
        d3d9_device_set_viewport(device, &half);
        draw();
        TEST_ASSERT_EQUAL_HEX32(BLUE, bare_device_pixel(device, 0, 0));
        TEST_ASSERT_EQUAL_HEX32(RED, bare_device_pixel(device, BARE_WIDTH - 1, 0));
    }
}

/* The program promises not to write to what draws read; if it does, they may read it. */
static void vertices_without_overwriting_reach_queued_draws(void)
{
    draw();
    write(vertices, GREEN, D3D9_LOCK_NO_OVERWRITE);
    expect(GREEN);
    draw();
    write(vertices, BLUE, D3D9_LOCK_NO_OVERWRITE | D3D9_LOCK_DISCARD);
    expect(BLUE);
    draw();
    write(vertices, RED, D3D9_LOCK_DISCARD);
    expect(BLUE);
}

/* Queued draws have the indices that were checked for them. */
static void indices_never_reach_queued_draws(void)
{
    static const uint16_t order[6] = {0, 1, 2, 2, 1, 3}, outside[6] = {65535, 65534, 65533, 0, 0, 0};
    struct d3d9_index_buffer *dynamic;
    void *data;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK,
                            d3d9_device_create_index_buffer(device, sizeof order, D3D9_USAGE_DYNAMIC, INDEX16,
                                                            D3D9_POOL_DEFAULT, &dynamic, NULL));
    d3d9_index_buffer_lock(dynamic, 0, 0, &data, D3D9_LOCK_NO_OVERWRITE);
    memcpy(data, order, sizeof order);
    d3d9_index_buffer_unlock(dynamic);
    d3d9_device_set_indices(device, dynamic);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, draw_indexed());
    d3d9_index_buffer_lock(dynamic, 0, 0, &data, D3D9_LOCK_NO_OVERWRITE);
    memcpy(data, outside, sizeof outside);
    d3d9_index_buffer_unlock(dynamic);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, draw_indexed());
    expect(RED);
    d3d9_device_set_indices(device, NULL);
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release((struct d3d9_object *)dynamic));
}

static void a_locked_buffer_can_be_drawn(void)
{
    void *data;
    d3d9_vertex_buffer_lock(vertices, 0, 0, &data, 0);
    quad(data, GREEN);
    draw();
    expect(GREEN);
    quad(data, BLUE);
    draw();
    expect(BLUE);
    d3d9_vertex_buffer_unlock(vertices);
}

static void draws_that_are_not_valid_are_refused(void)
{
    struct vertex v[4];
    uint16_t order[3] = {0, 1, 2};
    quad(v, BLUE);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_draw_primitive(device, 0, 0, 1));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_draw_primitive(device, 7, 0, 1));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_draw_primitive_up(device, STRIP, 0, v, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_draw_primitive_up(device, STRIP, 2, NULL, 20));
    TEST_ASSERT_EQUAL_INT32(
        INVALID, d3d9_device_draw_indexed_primitive_up(device, TRIANGLES, 0, 4, 1, order, INDEX16, v, 0));
    d3d9_device_set_vertex_declaration(device, NULL);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_draw_primitive(device, STRIP, 0, 2));
    TEST_ASSERT_EQUAL_INT32(INVALID, draw_indexed());
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_draw_primitive_up(device, STRIP, 2, v, sizeof *v));
    expect(0);
}

static void scenes_do_not_nest(void)
{
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_begin_scene(device));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_end_scene(device));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_end_scene(device));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_begin_scene(device));
}

static void draws_need_no_scene(void)
{
    struct vertex v[4];
    d3d9_device_end_scene(device);
    draw();
    expect(RED);
    quad(v, GREEN);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_draw_primitive_up(device, STRIP, 2, v, sizeof *v));
    expect(GREEN);
}

static void expect_stream(void *buffer, uint32_t stride)
{
    struct d3d9_vertex_buffer *bound = NULL;
    uint32_t offset = 7, bound_stride = 7;
    d3d9_device_get_stream_source(device, 0, &bound, &offset, &bound_stride);
    TEST_ASSERT_EQUAL_PTR(buffer, bound);
    TEST_ASSERT_EQUAL_UINT32(0, offset);
    TEST_ASSERT_EQUAL_UINT32(stride, bound_stride);
    if (bound)
        d3d9_object_release((struct d3d9_object *)bound);
}

static void a_draw_from_memory_unbinds_its_stream(void)
{
    struct vertex v[4];
    struct d3d9_index_buffer *bound = indices;
    uint32_t order[6] = {1, 2, 3, 3, 2, 4};
    quad(v, GREEN);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_draw_primitive_up(device, STRIP, 2, v, sizeof *v));
    expect(GREEN);
    expect_stream(NULL, 0);
    d3d9_device_set_stream_source(device, 0, vertices, 0, sizeof *v);
    struct vertex five[5];
    quad(five + 1, BLUE);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_draw_indexed_primitive_up(device, TRIANGLES, 1, 4, 2, order,
                                                                           INDEX32, five, sizeof *five));
    expect(BLUE);
    expect_stream(NULL, 0);
    d3d9_device_get_indices(device, &bound);
    TEST_ASSERT_NULL(bound);
}

static void a_refused_draw_from_memory_keeps_the_stride(void)
{
    struct vertex v[4];
    quad(v, GREEN);
    d3d9_device_set_vertex_declaration(device, NULL);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_draw_primitive_up(device, STRIP, 2, v, sizeof *v));
    expect_stream(NULL, sizeof *v);
}

static void vertices_outside_of_a_buffer_are_not_drawn(void)
{
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_draw_primitive(device, STRIP, 100, 2));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_draw_primitive(device, STRIP, 0, 1000));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_draw_indexed_primitive(device, TRIANGLES, -7, 0, 4, 0, 2));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_draw_indexed_primitive(device, TRIANGLES, 0, 0, 4, 6, 2));
    d3d9_device_set_indices(device, NULL);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, draw_indexed());
    expect(0);
}

static void a_stream_without_buffer_is_zeros(void)
{
    static const struct d3d9_vertex_element elements[] = {
        {.type = 3, .usage = 9}, {.stream = 1, .type = 4, .usage = 10}, {.stream = 255, .type = 17}};
    struct d3d9_declaration *declaration;
    d3d9_device_create_vertex_declaration(device, elements, &declaration);
    d3d9_device_set_vertex_declaration(device, declaration);
    d3d9_object_release((struct d3d9_object *)declaration);
    draw();
    expect(0);
    d3d9_device_set_stream_source(device, 1, vertices, 16, sizeof(struct vertex));
    draw();
    expect(RED);
}

static void transformed_vertices_pass_the_vertex_shader(void)
{
    static const uint32_t code[] = {0xfffe0101, 0x0000001f, 0x80000000, 0x900f0000,
                                    0x00000001, 0xc00f0000, 0x90000000, 0x0000ffff};
    struct d3d9_vertex_shader *shader;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_vertex_shader(device, code, &shader));
    d3d9_device_set_vertex_shader(device, shader);
    d3d9_object_release((struct d3d9_object *)shader);
    draw();
    expect(RED);
}

/* Positions in the window, with the pixel's centre at whole numbers, and colours. */
static void processed_vertices_are_written_to_a_buffer(void)
{
    static const struct {
        float x, y, z;
        uint32_t color;
    } source[2] = {{-1, 1, 0.25F, 0x80ff8040}, {0.5F, 0, 0.5F, GREEN}};
    struct d3d9_vertex_buffer *from, *to;
    struct vertex *got;
    void *data;
    d3d9_device_create_vertex_buffer(device, sizeof source, 0, XYZ_DIFFUSE, D3D9_POOL_SYSTEM, &from, NULL);
    d3d9_device_create_vertex_buffer(device, 3 * sizeof *got, 0, XYZRHW_DIFFUSE, D3D9_POOL_SYSTEM, &to, NULL);
    d3d9_vertex_buffer_lock(from, 0, 0, &data, 0);
    memcpy(data, source, sizeof source);
    d3d9_vertex_buffer_unlock(from);
    d3d9_device_set_fvf(device, XYZ_DIFFUSE);
    d3d9_device_set_stream_source(device, 0, from, 0, sizeof *source);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_process_vertices(device, 0, 1, 2, to, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_process_vertices(device, 0, 2, 2, to, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_process_vertices(device, 0, 0, 2, NULL, NULL, 0));
    d3d9_vertex_buffer_lock(to, 0, 0, &data, D3D9_LOCK_READ_ONLY);
    got = data;
    TEST_ASSERT_EQUAL_HEX32(0, got[0].color);
    TEST_ASSERT_EQUAL_FLOAT(0, got[1].x);
    TEST_ASSERT_EQUAL_FLOAT(0, got[1].y);
    TEST_ASSERT_EQUAL_FLOAT(0.25F, got[1].z);
    TEST_ASSERT_EQUAL_FLOAT(1, got[1].w);
    TEST_ASSERT_EQUAL_HEX32(0x80ff8040, got[1].color);
    TEST_ASSERT_EQUAL_FLOAT(BARE_WIDTH * 0.75F, got[2].x);
    TEST_ASSERT_EQUAL_FLOAT(BARE_HEIGHT * 0.5F, got[2].y);
    TEST_ASSERT_EQUAL_HEX32(GREEN, got[2].color);
    d3d9_vertex_buffer_unlock(to);
    d3d9_device_set_stream_source(device, 0, NULL, 0, 0);
    d3d9_object_release((struct d3d9_object *)from);
    d3d9_object_release((struct d3d9_object *)to);
}

/* vs_1_1 with the colour c256, which only software vertex processing has. */
static void a_shader_of_model_1_draws_with_constants_of_software_devices(void)
{
    static const uint32_t code[] = {0xfffe0101, 0x0000001f, 0x80000000, 0x900f0000, 0x00000051, 0xa00f0100,
                                    0,          0x3f800000, 0,          0x3f800000, 0x00000001, 0xd00f0000,
                                    0xa0e40100, 0x00000001, 0xc00f0000, 0x90e40000, 0x0000ffff};
    struct d3d9_device *other = device;
    struct d3d9_vertex_shader *shader = NULL;
    struct vertex v[4];
    device = bare_device_make(D3D9_CREATE_SOFTWARE_VERTICES);
    bare_device_begin(device);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_vertex_shader(device, code, &shader));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_vertex_shader(device, shader));
    d3d9_device_set_fvf(device, 0x002);
    quad(v, RED);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_draw_primitive_up(device, STRIP, 2, v, sizeof v[0]));
    expect(GREEN);
    d3d9_object_release((struct d3d9_object *)shader);
    bare_device_free(device);
    device = other;
}

enum { ALPHABLENDENABLE = 27, SRCBLEND = 19, DESTBLEND = 20, BLENDOP = 171, SRCCOLOR2 = 16, INVSRCCOLOR2 };

static void blend(uint32_t source, uint32_t target, uint32_t operation)
{
    d3d9_device_set_render_state(device, ALPHABLENDENABLE, 1);
    d3d9_device_set_render_state(device, SRCBLEND, source);
    d3d9_device_set_render_state(device, DESTBLEND, target);
    d3d9_device_set_render_state(device, BLENDOP, operation);
}

/* oC0 is v0, oC1 is c0: the part of the target that is covered. */
static void the_second_colour_of_a_shader_is_a_factor(void)
{
    static const uint32_t code[] = {0xffff0200, 0x05000051, 0xa00f0000, 0x3f800000, 0x00000000, 0x3e4ccccd,
                                    0x3f800000, 0x0200001f, 0x80000000, 0x900f0000, 0x02000001, 0x800f0000,
                                    0x90e40000, 0x02000001, 0x800f0001, 0xa0e40000, 0x02000001, 0x800f0800,
                                    0x80e40000, 0x02000001, 0x800f0801, 0x80e40001, 0x0000ffff};
    struct d3d9_pixel_shader *shader = NULL;
    write(vertices, 0xffcc6633, 0);
    draw();
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_pixel_shader(device, code, &shader));
    d3d9_device_set_pixel_shader(device, shader);
    blend(2, INVSRCCOLOR2, 1);
    write(vertices, 0x00336600, 0);
    draw();
    expect(0x0033cc29);
    d3d9_device_set_pixel_shader(device, NULL);
    d3d9_object_release((struct d3d9_object *)shader);
    blend(SRCCOLOR2, 1, 1); /* without a shader, the first colour */
    write(vertices, 0xff804020, 0);
    draw();
    expect(0xff401004);
}

static void factors_and_operations_of_opengl_do_not_exist(void)
{
    write(vertices, 0x40804020, 0);
    for (uint32_t number = 18; number < 24; number++) {
        blend(number, number, 6);
        draw();
        expect(0x40804020);
    }
}

static void without_target_nothing_is_drawn(void)
{
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_render_target(device, 0, NULL));
    d3d9_device_bind_target(device, 0, NULL);
    d3d9_device_bind_depth(device, NULL);
    draw();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(vertices_and_indices_of_buffers_are_drawn);
    RUN_TEST(each_draw_has_the_bytes_of_its_time);
    RUN_TEST(vertices_without_overwriting_reach_queued_draws);
    RUN_TEST(indices_never_reach_queued_draws);
    RUN_TEST(a_locked_buffer_can_be_drawn);
    RUN_TEST(draws_that_are_not_valid_are_refused);
    RUN_TEST(scenes_do_not_nest);
    RUN_TEST(draws_need_no_scene);
    RUN_TEST(a_draw_from_memory_unbinds_its_stream);
    RUN_TEST(a_refused_draw_from_memory_keeps_the_stride);
    RUN_TEST(vertices_outside_of_a_buffer_are_not_drawn);
    RUN_TEST(a_stream_without_buffer_is_zeros);
    RUN_TEST(transformed_vertices_pass_the_vertex_shader);
    RUN_TEST(processed_vertices_are_written_to_a_buffer);
    RUN_TEST(a_shader_of_model_1_draws_with_constants_of_software_devices);
    RUN_TEST(the_second_colour_of_a_shader_is_a_factor);
    RUN_TEST(factors_and_operations_of_opengl_do_not_exist);
    RUN_TEST(without_target_nothing_is_drawn);
    return UNITY_END();
}
