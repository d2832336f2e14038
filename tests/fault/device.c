/* Scenes that are drawn while each request of a device is refused once: each memory block, mapping and thread
 * that a call of the interface requests (sweep.h). */
#define _GNU_SOURCE
#include "tests/fault/sweep.h"

#include <math.h>
#include <xxhash.h>

enum { WIDTH = 80, HEIGHT = 70, PIXELS = WIDTH * HEIGHT };

void setUp(void)
{
}

void tearDown(void)
{
    fault_disarm();
    fault.watching = false;
    triptych_device_destroy(device);
    device = NULL;
}

static void add_to_digest(const void *data, size_t bytes)
{
    digest = XXH3_64bits_withSeed(data, bytes, digest);
}

static void read_target(bool stencil)
{
    static uint32_t color[PIXELS];
    static float depth[PIXELS];
    static uint8_t stencils[PIXELS];
    TRY(triptych_read_color(device, color, sizeof color));
    TRY(triptych_read_depth(device, depth, sizeof depth));
    add_to_digest(color, sizeof color);
    add_to_digest(depth, sizeof depth);
    if (!stencil)
        return;
    TRY(triptych_read_stencil(device, stencils, sizeof stencils));
    add_to_digest(stencils, sizeof stencils);
}

/* --- Scenes --------------------------------------------------------------------------------------------- */

struct vertex {
    float position[3];
    float normal[3];
    uint32_t color;
    float coordinates[3];
    float weights[1];
    uint32_t matrices;
};

enum { VERTICES = 36 };

static triptych_buffer *make_vertices(void)
{
    struct vertex vertices[VERTICES];
    triptych_buffer *buffer;
    for (int i = 0; i < VERTICES; i++) {
        float angle = (float)i * 2.399f, radius = 0.3f + 0.09f * (float)(i % 13);
        vertices[i] = (struct vertex){{radius * cosf(angle), radius * sinf(angle), (float)i / VERTICES},
                                      {0.6f * cosf(angle), 0.6f * sinf(angle), -0.8f},
                                      0xff406080u * (uint32_t)(i + 1) | 0xff000000u,
                                      {cosf(angle), sinf(angle), (float)(i % 5) - 2},
                                      {(float)(i % 4) / 4},
                                      (uint32_t)(i % 3) | (uint32_t)(i % 2) << 8};
    }
    TRY(triptych_buffer_create(device, vertices, sizeof vertices, &buffer));
    return buffer;
}

static void use_vertices(bool blending)
{
    static const struct triptych_declaration_element elements[] = {
        {0, offsetof(struct vertex, position), TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {0, offsetof(struct vertex, normal), TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_NORMAL, 0},
        {0, offsetof(struct vertex, color), TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 0},
        {0, offsetof(struct vertex, coordinates), TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_TEXCOORD, 0},
        {0, offsetof(struct vertex, weights), TRIPTYCH_FORMAT_FLOAT1, TRIPTYCH_USAGE_BLENDWEIGHT, 0},
        {0, offsetof(struct vertex, matrices), TRIPTYCH_FORMAT_UBYTE4, TRIPTYCH_USAGE_BLENDINDICES, 0},
    };
    TRY(triptych_set_declaration(device, elements, blending ? 6 : 4));
    TRY(triptych_set_stream(device, 0, make_vertices(), 0, sizeof(struct vertex)));
}

static void use_state(enum triptych_state state, uint32_t value)
{
    TRY(triptych_set_state(device, state, value));
}

static void clear(void)
{
    TRY(triptych_clear_buffers(device, TRIPTYCH_CLEAR_COLOR | TRIPTYCH_CLEAR_DEPTH,
                               (const float[4]){0.1f, 0.2f, 0.3f, 1}, 1, 0));
}

static triptych_texture *make_texture(enum triptych_texture_type type, enum triptych_surface_format format)
{
    static const uint32_t texels[16] = {0xff0000ff, 0xff00ff00, 0xffff0000, 0xffffffff, 0x80808080,
                                        0xff00ffff, 0xffff00ff, 0xffffff00, 0xff102030};
    struct triptych_texture_description description = {type, format, 4, 4, 1, 0};
    triptych_texture *texture;
    TRY(triptych_texture_define(device, &description, &texture));
    for (unsigned face = 0; face < (type == TRIPTYCH_TEXTURE_CUBE ? 6u : 1u); face++)
        TRY(triptych_texture_update(device, texture, face, 0, NULL, texels, 16, 64));
    TRY(triptych_texture_generate_mips(device, texture));
    return texture;
}

static void sample(unsigned stage, triptych_texture *texture, uint32_t filter)
{
    TRY(triptych_set_texture(device, stage, texture));
    TRY(triptych_set_sampler_state(device, stage, TRIPTYCH_SAMPLER_MINFILTER, filter));
    TRY(triptych_set_sampler_state(device, stage, TRIPTYCH_SAMPLER_MAGFILTER, filter));
    TRY(triptych_set_sampler_state(device, stage, TRIPTYCH_SAMPLER_MIPFILTER, filter));
}

/* A scene with textures of three kinds, several samples a pixel, indices, a query, and a texture that
 * receives the picture. */
static void draw_fixed_function(unsigned threads)
{
    static const uint16_t indices[] = {0, 5, 9, 14, 3, 8, 21, 30, 2, 11, 17, 26};
    struct triptych_target_description target = {
        .width = WIDTH, .height = HEIGHT, .depth_format = TRIPTYCH_DEPTH_D24S8, .samples = 4};
    triptych_query *query;
    triptych_buffer *order;
    uint64_t passed;
    open_device(threads, 0);
    TRY(triptych_set_target_description(device, &target));
    clear();
    use_vertices(false);
    use_state(TRIPTYCH_STATE_CULLMODE, 1);
    use_state(TRIPTYCH_STATE_LIGHTING, 1);
    use_state(TRIPTYCH_STATE_AMBIENT, 0xff404040);
    TRY(triptych_set_light(device, 0,
                           &(struct triptych_light){.diffuse = {1, 1, 1, 1}, .direction = {0, 0, 1}}));
    TRY(triptych_enable_light(device, 0, 1));
    TRY(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
    TRY(triptych_query_begin(device, query));
    TRY(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 12));
    TRY(triptych_query_end(device, query));
    TRY(triptych_buffer_create(device, indices, sizeof indices, &order));
    TRY(triptych_set_indices(device, order, 16));
    sample(0, make_texture(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8), 2);
    sample(1, make_texture(TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_X8R8G8B8), 2);
    TRY(triptych_set_stage_state(device, 1, TRIPTYCH_STAGE_COLOROP, 4));
    TRY(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 0, 10));
    TRY(triptych_query_result(device, query, &passed));
    add_to_digest(&passed, sizeof passed);
    read_target(true);
}

/* A compressed texture: its blocks, and those of a computed level. */
static void read_compressed(void)
{
    uint8_t blocks[16];
    triptych_texture *texture = make_texture(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_DXT5);
    for (unsigned level = 0; level < 2; level++) {
        TRY(triptych_texture_read(device, texture, 0, level, NULL, blocks, 16, 0));
        add_to_digest(blocks, sizeof blocks);
    }
}

/* Rectangles: a copy within a surface, depth of a texture, and a fill of an image. */
static void change_rectangles(triptych_texture *texture)
{
    uint32_t read[16] = {0x40000001, 0x80000002};
    const struct triptych_rectangle part[2] = {{0, 0, 20, 20}, {3, 5, 20, 20}}, corner = {0, 0, 4, 4};
    const struct triptych_image_description description = {
        .format = TRIPTYCH_SURFACE_A8R8G8B8, .width = 8, .height = 8, .samples = 2};
    triptych_texture *depth = make_texture(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_INTZ);
    struct triptych_surface surface[3] = {{.texture = texture}, {.texture = depth}};
    TRY(triptych_image_create(device, &description, &surface[2].image));
    TRY(triptych_copy(device, &surface[0], &part[0], &surface[0], &part[1], TRIPTYCH_COPY_POINT));
    TRY(triptych_write_rectangle(device, &surface[1], &corner, 0, read, 16));
    TRY(triptych_fill(device, &surface[2], &corner, (const float[4]){0, 1, 0, 1}));
    for (int i = 0; i < 3; i++) {
        TRY(triptych_read_rectangle(device, &surface[i], &corner, 0, read, 16));
        add_to_digest(read, sizeof read);
    }
}

/* A scene that draws to a texture, copies it and samples it; vertices that choose matrices; and many draws
 * with a small cache of routines. */
static void draw_to_textures(unsigned threads)
{
    static uint32_t read[64 * 64];
    static const float matrix[4][4] = {{0.5f, 0, 0, 0}, {0, 0.5f, 0, 0}, {0, 0, 1, 0}, {0.2f, 0, 0, 1}};
    struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 64, 64, 1, 1};
    triptych_texture *texture[2];
    open_device(threads, 1);
    TRY(triptych_set_target(device, WIDTH, HEIGHT));
    clear();
    use_vertices(true);
    use_state(TRIPTYCH_STATE_CULLMODE, 1);
    use_state(TRIPTYCH_STATE_LIGHTING, 0);
    use_state(TRIPTYCH_STATE_VERTEXBLEND, 1);
    use_state(TRIPTYCH_STATE_INDEXEDVERTEXBLENDENABLE, 1);
    TRY(triptych_set_transform(device, TRIPTYCH_TRANSFORM_WORLD1, matrix));
    for (int i = 0; i < 2; i++)
        TRY(triptych_texture_define(device, &description, &texture[i]));
    TRY(triptych_set_target_surfaces(device,
                                     &(struct triptych_target_surfaces){.color = {{.texture = texture[0]}},
                                                                        .depth_format = TRIPTYCH_DEPTH_D16}));
    clear();
    TRY(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 12));
    TRY(triptych_set_target_surfaces(device, NULL));
    struct triptych_surface from = {texture[0], 0, 0, NULL}, to = {texture[1], 0, 0, NULL};
    TRY(triptych_copy(device, &from, &(struct triptych_rectangle){0, 0, 32, 32}, &to,
                      &(struct triptych_rectangle){3, 5, 50, 41}, TRIPTYCH_COPY_LINEAR));
    TRY(triptych_read_surface(device, &to, read, sizeof read));
    add_to_digest(read, sizeof read);
    read_compressed();
    change_rectangles(texture[1]);
    sample(0, texture[1], 1);
    TRY(triptych_draw(device, TRIPTYCH_TRIANGLE_FAN, 0, 20));
    read_target(false);
}

static void shade(const char *vertex, const char *pixel)
{
    triptych_shader *shader[2];
    TRY(triptych_shader_assemble(device, "vertex", vertex, strlen(vertex), &shader[0]));
    TRY(triptych_shader_assemble(device, "pixel", pixel, strlen(pixel), &shader[1]));
    TRY(triptych_set_vertex_shader(device, shader[0]));
    TRY(triptych_set_pixel_shader(device, shader[1]));
}

/* A scene with shaders from text and from bytecode: loops, calls, constants of all kinds and a lookup. */
static void draw_with_shaders(unsigned threads)
{
    /* It contains a constant table with a name for c0. */
    static const uint32_t bytecode[] = {
        0xffff0200, 0x000efffe, 0x42415443, 28,         0,          0xffff0200, 1,          28,
        0,          0,          48,         0x00000002, 1,          0,          0,          0x00000043,
        0x05000051, 0xa00f0000, 0x3f000000, 0x3e800000, 0x3f800000, 0x3f800000, 0x02000001, 0x800f0000,
        0xa0e40000, 0x02000001, 0x800f0800, 0x80e40000, 0x0000ffff};
    triptych_shader *shader;
    open_device(threads, 0);
    TRY(triptych_set_target(device, WIDTH, HEIGHT));
    clear();
    use_vertices(false);
    use_state(TRIPTYCH_STATE_CULLMODE, 1);
    shade(
        "vs_3_0\ndef c9, 0.5, 1, 0, 0\ndcl_position v0\ndcl_color v1\ndcl_texcoord v2\ndcl_position o0\n"
        "dcl_color o1\ndcl_texcoord o2\nmov r0, v1\nloop aL, i0\nadd r0, r0, c[aL]\nendloop\nif b1\ncall l0\n"
        "endif\nmov o0, v0\nmov o1, r0\nmov o2, v2\nret\nlabel l0\nmul r0, r0, c9.x\nret\n",
        "ps_3_0\ndcl_color v0\ndcl_texcoord v1\ndcl_2d s0\nmov r1, v0\nrep i1\nmul r1, r1, c2\nadd r1, r1, "
        "c3\nendrep\n"
        "texld r0, v1, s0\nadd r0, r0, r1\nmov oC0, r0\n");
    sample(0, make_texture(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_G16R16), 2);
    TRY(triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 0, (const float[8]){0.1f, 0, 0.2f}, 2));
    TRY(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 2, (const float[8]){0.5f, 0.5f, 0.4f, 1},
                                   2));
    TRY(triptych_set_shader_integers(device, TRIPTYCH_SHADER_VERTEX, 0, (const int32_t[4]){2, 0, 1}, 1));
    TRY(triptych_set_shader_integers(device, TRIPTYCH_SHADER_PIXEL, 1, (const int32_t[4]){3}, 1));
    TRY(triptych_set_shader_booleans(device, TRIPTYCH_SHADER_VERTEX, 1, (const int32_t[1]){1}, 1));
    TRY(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 12));
    TRY(triptych_shader_create(device, "bytecode", bytecode, sizeof bytecode, &shader));
    TRY(triptych_set_pixel_shader(device, shader));
    TRY(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 3, 3));
    TRY(triptych_shader_destroy(device, shader));
    TRY(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 20, 3));
    read_target(false);
}

/* A scene with every kind of primitive, edges instead of faces, user clip planes, and triangles that cross
 * the plane of the eye. */
static void draw_lines_and_points(unsigned threads)
{
    static const float perspective[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 2}, {0, 0, -0.2f, -0.3f}};
    open_device(threads, 0);
    TRY(triptych_set_target(device, WIDTH, HEIGHT));
    clear();
    use_vertices(false);
    use_state(TRIPTYCH_STATE_CULLMODE, 1);
    use_state(TRIPTYCH_STATE_LIGHTING, 0);
    use_state(TRIPTYCH_STATE_CLIPPLANEENABLE, 1);
    use_state(TRIPTYCH_STATE_POINTSIZE, triptych_float_bits(5));
    TRY(triptych_set_clip_plane(device, 0, (const float[4]){1, 0.3f, 0, 0.4f}));
    TRY(triptych_set_transform(device, TRIPTYCH_TRANSFORM_PROJECTION, perspective));
    TRY(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 12));
    TRY(triptych_draw(device, TRIPTYCH_POINT_LIST, 0, 36));
    TRY(triptych_draw(device, TRIPTYCH_LINE_STRIP, 0, 30));
    use_state(TRIPTYCH_STATE_FILLMODE, 2);
    TRY(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 2, 20));
    read_target(false);
}

/* A scene with buffers and textures that change between draws, and with immediate draws. The data of one
 * exceed the memory for immediate vertices. */
static void draw_with_changes(unsigned threads)
{
    static const uint16_t indices[3] = {0, 5, 9};
    static const uint32_t texels[19] = {0xff00ff00};
    enum { MANY = (5 << 20) / sizeof(struct vertex) };
    static struct vertex vertices[MANY];
    triptych_buffer *buffer;
    size_t offset, stride;
    void *data;
    open_device(threads, 0);
    TRY(triptych_set_target(device, WIDTH, HEIGHT));
    clear();
    use_state(TRIPTYCH_STATE_CULLMODE, 1);
    use_vertices(false);
    TRY(triptych_get_stream(device, 0, &buffer, &offset, &stride));
    triptych_texture *texture = make_texture(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8);
    sample(0, texture, 1);
    for (int i = 0; i < 3; i++) {
        TRY(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, (uint32_t)i, 8));
        TRY(triptych_buffer_update(device, buffer, 40 * (size_t)i + 4, &(float){0.25f}, 4));
        TRY(triptych_texture_update(device, texture, 0, 0, NULL, texels + i, 16, 0));
        TRY(triptych_texture_generate_mips(device, texture));
    }
    TRY(triptych_buffer_map(device, buffer, 0, 6 * stride, TRIPTYCH_MAP_WRITE, &data));
    memcpy(vertices, data, 6 * stride);
    TRY(triptych_buffer_unmap(device, buffer));
    TRY(triptych_draw_user(device, TRIPTYCH_TRIANGLE_STRIP, 4, vertices, stride));
    TRY(triptych_draw_indexed_user(device, TRIPTYCH_TRIANGLE_LIST, 1, indices, 16, MANY, vertices, stride));
    TRY(triptych_texture_destroy(device, texture));
    TRY(triptych_buffer_destroy(device, buffer));
    read_target(false);
}

/* A scene with instances. The cache has no room, so routines are evicted while the draws are recorded. */
static void draw_instances(unsigned threads)
{
    static const uint16_t indices[] = {0, 7, 19, 4, 25, 31};
    static const float places[3][4] = {{0}, {0.3f, 0.1f, 0}, {-0.4f, 0.2f, 0}};
    static const struct triptych_declaration_element elements[] = {
        {0, offsetof(struct vertex, position), TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {0, offsetof(struct vertex, color), TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 0},
        {1, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_TEXCOORD, 0},
    };
    triptych_buffer *order, *place;
    open_device(threads, 1);
    TRY(triptych_set_target(device, WIDTH, HEIGHT));
    clear();
    TRY(triptych_buffer_create(device, indices, sizeof indices, &order));
    TRY(triptych_buffer_create(device, places, sizeof places, &place));
    TRY(triptych_set_indices(device, order, 16));
    TRY(triptych_set_declaration(device, elements, 3));
    TRY(triptych_set_stream(device, 0, make_vertices(), 0, sizeof(struct vertex)));
    TRY(triptych_set_stream(device, 1, place, 0, 16));
    TRY(triptych_set_stream_frequency(device, 0, TRIPTYCH_FREQUENCY_INDEXED, 3));
    TRY(triptych_set_stream_frequency(device, 1, TRIPTYCH_FREQUENCY_INSTANCE, 1));
    use_state(TRIPTYCH_STATE_CULLMODE, 1);
    use_state(TRIPTYCH_STATE_ZENABLE, 0);
    use_state(TRIPTYCH_STATE_ALPHABLENDENABLE, 1);
    use_state(TRIPTYCH_STATE_SRCBLEND, 2);
    use_state(TRIPTYCH_STATE_DESTBLEND, 2);
    shade("vs_2_0\ndcl_position v0\ndcl_color v1\ndcl_texcoord v2\nmov r0, v2\nadd r0, r0, v0\nmov oPos, "
          "r0\nmov oD0, v1\n",
          "ps_2_0\ndcl v0\nmov r0, v0\nmov oC0, r0\n");
    TRY(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 2));
    read_target(false);
}

/* A scene with more routines than the first size of the cache's hash table. */
static void draw_with_many_states(unsigned threads)
{
    open_device(threads, 0);
    TRY(triptych_set_target(device, WIDTH, HEIGHT));
    clear();
    use_vertices(false);
    use_state(TRIPTYCH_STATE_CULLMODE, 1);
    use_state(TRIPTYCH_STATE_ALPHABLENDENABLE, 1);
    for (uint32_t i = 0; i < 70; i++) {
        use_state(TRIPTYCH_STATE_SRCBLEND, 1 + i % 10);
        use_state(TRIPTYCH_STATE_DESTBLEND, 3 + i / 10);
        TRY(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, i % 30, 1));
    }
    read_target(false);
}

/* --- Tests ---------------------------------------------------------------------------------------------- */

static void test_fixed_function_with_textures_and_queries(void)
{
    on_engines(draw_fixed_function);
}

static void test_drawing_to_textures_and_copies(void)
{
    on_engines(draw_to_textures);
}

static void test_shaders_with_loops_and_constants(void)
{
    on_engines(draw_with_shaders);
}

static void test_lines_points_and_clipping(void)
{
    on_engines(draw_lines_and_points);
}

static void test_buffers_and_textures_that_change(void)
{
    on_engines(draw_with_changes);
}

static void test_a_draw_of_instances_is_recorded_whole_or_not_at_all(void)
{
    on_engines(draw_instances);
}

static void test_a_table_of_routines_that_cannot_grow(void)
{
    engine = "emulate";
    refuse_everything(draw_with_many_states, 1, false);
    refuse_everything(draw_with_many_states, 1, true);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_fixed_function_with_textures_and_queries);
    RUN_TEST(test_drawing_to_textures_and_copies);
    RUN_TEST(test_shaders_with_loops_and_constants);
    RUN_TEST(test_lines_points_and_clipping);
    RUN_TEST(test_buffers_and_textures_that_change);
    RUN_TEST(test_a_draw_of_instances_is_recorded_whole_or_not_at_all);
    RUN_TEST(test_a_table_of_routines_that_cannot_grow);
    printf("%lu requests refused at %u places\n", fault.total, fault_sites->count);
    return UNITY_END();
}
