/* Primitives, on every engine. Each is drawn a second time as a list of triangles, lines or points with the
 * vertices that def/state/primitive.def defines: both pictures are equal, in all shade and fill modes,
 * clipped or not, with vertices in order and with indices of all sizes. */
#include "tests/support/picture/shape.h"

#include <stdbool.h>
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

enum { VERTICES = 24, CORNERS_MAXIMUM = 4 * VERTICES };

struct corner_list {
    uint32_t vertex[CORNERS_MAXIMUM];
    unsigned count;
};

static void add(struct corner_list *list, unsigned a, unsigned b, unsigned c, unsigned corners)
{
    const unsigned vertex[3] = {a, b, c};
    for (unsigned i = 0; i < corners; i++)
        list->vertex[list->count++] = vertex[i];
}

/* The vertices of primitive p of a draw of n primitives, in the order of its winding. Returns their number.
 */
static unsigned vertices_of(enum triptych_primitive primitive, unsigned p, unsigned n, unsigned vertex[4])
{
    switch (primitive) {
    case TRIPTYCH_LINE_LOOP: vertex[0] = p, vertex[1] = (p + 1) % n; return 2;
    case TRIPTYCH_QUAD_LIST:
        for (unsigned i = 0; i < 4; i++)
            vertex[i] = 4 * p + i;
        return 4;
    case TRIPTYCH_QUAD_STRIP:
        vertex[0] = 2 * p, vertex[1] = 2 * p + 1, vertex[2] = 2 * p + 3, vertex[3] = 2 * p + 2;
        return 4;
    default: TEST_FAIL(); return 0;
    }
}

/* The triangles or lines of n primitives. */
static void split(enum triptych_primitive primitive, unsigned n, struct corner_list *list)
{
    list->count = 0;
    for (unsigned p = 0; p < n; p++) {
        unsigned v[4];
        if (primitive == TRIPTYCH_POLYGON) {
            add(list, 0, p + 1, p + 2, 3);
        } else if (vertices_of(primitive, p, n, v) == 2) {
            add(list, v[0], v[1], 0, 2);
        } else {
            add(list, v[0], v[1], v[2], 3);
            add(list, v[0], v[2], v[3], 3);
        }
    }
}

/* The edges around n quads or a polygon, and their corners. */
static void outline(enum triptych_primitive primitive, unsigned n, struct corner_list *edges,
                    struct corner_list *corners)
{
    edges->count = corners->count = 0;
    for (unsigned i = 0; primitive == TRIPTYCH_POLYGON && i < n + 2; i++) {
        add(edges, i, (i + 1) % (n + 2), 0, 2);
        add(corners, i, 0, 0, 1);
    }
    for (unsigned p = 0; primitive != TRIPTYCH_POLYGON && p < n; p++) {
        unsigned v[4];
        vertices_of(primitive, p, n, v);
        for (unsigned i = 0; i < 4; i++) {
            add(edges, v[i], v[(i + 1) % 4], 0, 2);
            add(corners, v[i], 0, 0, 1);
        }
    }
}

/* --- Drawing --- */

static triptych_buffer *buffer_of(const void *data, size_t bytes)
{
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, data, bytes, &buffer));
    return buffer;
}

static void bind(enum triptych_attribute attribute, enum triptych_format format, triptych_buffer *buffer,
                 size_t offset)
{
    struct triptych_element element = {format, buffer, offset, sizeof(struct shape_vertex)};
    OK(triptych_set_element(device, attribute, &element));
}

/* Random vertices in clip space, around the target; with `deep` some are outside of the depths. */
static void bind_vertices(bool deep)
{
    struct shape_vertex vertex[VERTICES];
    for (int i = 0; i < VERTICES; i++)
        vertex[i] = (struct shape_vertex){(float)dyadic(-1.25, 1.25),
                                          (float)dyadic(-1.25, 1.25),
                                          (float)(deep ? dyadic(-0.5, 1.5) : dyadic(0, 1)),
                                          random_word(),
                                          (float)dyadic(0, 4),
                                          (float)dyadic(0, 4)};
    triptych_buffer *buffer = buffer_of(vertex, sizeof vertex);
    bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3, buffer, offsetof(struct shape_vertex, x));
    bind(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR, buffer, offsetof(struct shape_vertex, color));
    bind(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT2, buffer, offsetof(struct shape_vertex, u));
}

static void draw_list(enum triptych_primitive primitive, const struct corner_list *list, unsigned corners)
{
    OK(triptych_set_indices(device, buffer_of(list->vertex, sizeof list->vertex), 32));
    OK(triptych_draw_indexed(device, primitive, 0, 0, list->count / corners));
}

static uint32_t expected[SIZE * SIZE];

static void keep_expected(void)
{
    read_shapes();
    memcpy(expected, image, sizeof expected);
    clear_shapes();
}

static void expect_same(const char *what)
{
    read_shapes();
    for (int i = 0; i < SIZE * SIZE; i++)
        expect_pixel(i % SIZE, i / SIZE, expected[i], what);
    clear_shapes();
}

static const struct {
    enum triptych_primitive primitive;
    const char *name;
    unsigned each, more; /* vertices */
} kinds[] = {{TRIPTYCH_LINE_LOOP, "line loop", 1, 0},
             {TRIPTYCH_QUAD_LIST, "quads", 4, 0},
             {TRIPTYCH_QUAD_STRIP, "quad strip", 2, 2},
             {TRIPTYCH_POLYGON, "polygon", 1, 2}};

enum { KINDS = sizeof kinds / sizeof *kinds };

static unsigned random_count(int kind)
{
    return 1 + random_word() % ((VERTICES - kinds[kind].more) / kinds[kind].each);
}

/* --- Filled, and lines --- */

static void check_filled(void)
{
    static const char *const shades[] = {"flat", "gouraud"};
    static const char *const culls[] = {"none", "cw", "ccw"};
    for (int i = 0; i < 120; i++) {
        int kind = i % KINDS;
        unsigned n = random_count(kind);
        struct corner_list parts;
        bind_vertices(i & 8);
        set(TRIPTYCH_STATE_SHADEMODE, shades[i / 4 % 2]);
        set(TRIPTYCH_STATE_CULLMODE, culls[random_word() % 3]);
        set_number(TRIPTYCH_STATE_LASTPIXEL, 0);
        split(kinds[kind].primitive, n, &parts);
        if (kinds[kind].primitive == TRIPTYCH_LINE_LOOP)
            draw_list(TRIPTYCH_LINE_LIST, &parts, 2);
        else
            draw_list(TRIPTYCH_TRIANGLE_LIST, &parts, 3);
        keep_expected();
        set_number(TRIPTYCH_STATE_LASTPIXEL, random_word() & 1); /* a loop has none */
        OK(triptych_draw(device, kinds[kind].primitive, 0, n));
        expect_same(kinds[kind].name);
    }
}

static void test_primitives_are_triangles_or_lines_in_the_order_of_their_vertices(void)
{
    on_every_engine(check_filled);
}

/* --- The provoking vertex --- */

static void provoke(enum triptych_provoking_vertex which)
{
    OK(triptych_set_convention(device, TRIPTYCH_PROVOKING_VERTEX, which));
}

/* The triangles of n primitives, each from its last vertex on; a polygon's from its first. */
static void split_from_last(enum triptych_primitive primitive, unsigned n, struct corner_list *list)
{
    list->count = 0;
    for (unsigned p = 0; p < n; p++) {
        unsigned q = 4 * p;
        switch (primitive) {
        case TRIPTYCH_TRIANGLE_LIST: add(list, 3 * p + 2, 3 * p, 3 * p + 1, 3); break;
        case TRIPTYCH_TRIANGLE_STRIP:
            if (p & 1)
                add(list, p + 2, p + 1, p, 3);
            else
                add(list, p + 2, p, p + 1, 3);
            break;
        case TRIPTYCH_TRIANGLE_FAN: add(list, p + 2, 0, p + 1, 3); break;
        case TRIPTYCH_POLYGON: add(list, 0, p + 1, p + 2, 3); break;
        case TRIPTYCH_QUAD_LIST:
            add(list, q + 3, q, q + 1, 3);
            add(list, q + 3, q + 1, q + 2, 3);
            break;
        default:
            q = 2 * p;
            add(list, q + 3, q + 2, q, 3);
            add(list, q + 3, q, q + 1, 3);
        }
    }
}

static const struct {
    enum triptych_primitive primitive;
    const char *name;
    unsigned most; /* of VERTICES */
} areas[] = {
    {TRIPTYCH_TRIANGLE_LIST, "last of triangles", 8},  {TRIPTYCH_TRIANGLE_STRIP, "last of a strip", 22},
    {TRIPTYCH_TRIANGLE_FAN, "last of a fan", 22},      {TRIPTYCH_QUAD_LIST, "last of quads", 6},
    {TRIPTYCH_QUAD_STRIP, "last of a quad strip", 11}, {TRIPTYCH_POLYGON, "first of a polygon", 22}};

enum { AREAS = sizeof areas / sizeof *areas };

static void draw_both(int kind, unsigned n, bool indexed)
{
    uint16_t order[VERTICES];
    struct corner_list parts;
    split_from_last(areas[kind].primitive, n, &parts);
    provoke(TRIPTYCH_PROVOKING_VERTEX_FIRST);
    draw_list(TRIPTYCH_TRIANGLE_LIST, &parts, 3);
    keep_expected();
    provoke(TRIPTYCH_PROVOKING_VERTEX_LAST);
    for (int i = 0; i < VERTICES; i++)
        order[i] = (uint16_t)i;
    OK(triptych_set_indices(device, buffer_of(order, sizeof order), 16));
    if (indexed)
        OK(triptych_draw_indexed(device, areas[kind].primitive, 0, 0, n));
    else
        OK(triptych_draw(device, areas[kind].primitive, 0, n));
    expect_same(areas[kind].name);
}

static void check_last(void)
{
    static const char *const culls[] = {"none", "cw", "ccw"};
    set(TRIPTYCH_STATE_SHADEMODE, "flat");
    for (int i = 0; i < 12 * AREAS; i++) {
        int kind = i % AREAS;
        bool solid = areas[kind].primitive > TRIPTYCH_TRIANGLE_FAN || i / AREAS % 3;
        bind_vertices(i & 8);
        set(TRIPTYCH_STATE_CULLMODE, culls[random_word() % 3]);
        set(TRIPTYCH_STATE_FILLMODE, solid ? "solid" : "wireframe");
        draw_both(kind, 1 + random_word() % areas[kind].most, i / AREAS & 1);
    }
    set(TRIPTYCH_STATE_FILLMODE, "solid");
    set(TRIPTYCH_STATE_SHADEMODE, "gouraud");
    bind_vertices(false);
    provoke(TRIPTYCH_PROVOKING_VERTEX_FIRST);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 5));
    keep_expected();
    provoke(TRIPTYCH_PROVOKING_VERTEX_LAST);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 5));
    expect_same("without flat shading nothing changes");
}

/* Three points of horizontal lines, in red, green and blue; the first is outside of the depths. */
static void check_lines(void)
{
    enum { RED = 0xff0000ff, GREEN = 0xff00ff00, BLUE = 0xffff0000 }; /* words of images */
    const struct shape_vertex v[3] = {{0, 10.5f, -0.5f, 0xffff0000, 0, 0},
                                      {20.5f, 10.5f, 0.5f, 0xff00ff00, 0, 0},
                                      {40.5f, 10.5f, 0.5f, 0xff0000ff, 0, 0}};
    set(TRIPTYCH_STATE_SHADEMODE, "flat");
    set_number(TRIPTYCH_STATE_LASTPIXEL, 0);
    for (unsigned last = 0; last < 2; last++) {
        provoke(last);
        clear_shapes();
        draw_shape(TRIPTYCH_LINE_STRIP, v, 3);
        read_shapes();
        expect_pixel(15, 10, last ? GREEN : RED, "the first line of a strip, clipped");
        expect_pixel(25, 10, last ? BLUE : GREEN, "the second line of a strip");
        clear_shapes();
        OK(triptych_draw(device, TRIPTYCH_LINE_LOOP, 1, 2));
        read_shapes();
        expect_pixel(20, 10, last ? BLUE : GREEN, "the first pixel of a loop");
        expect_pixel(30, 10, last ? GREEN : BLUE, "the way back");
        clear_shapes();
        draw_shape(TRIPTYCH_LINE_LIST, v + 1, 2);
        read_shapes();
        expect_pixel(30, 10, last ? BLUE : GREEN, "a line of a list");
    }
}

static void test_the_last_vertex_can_give_flat_colours(void)
{
    on_every_engine(check_last);
    on_every_engine(check_lines);
}

/* --- Outlines --- */

static void add_colors(void)
{
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "one");
    set(TRIPTYCH_STATE_DESTBLEND, "one");
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_COLORARG1, "tfactor");
    set_number(TRIPTYCH_STATE_TEXTUREFACTOR, 0xff010204);
}

/* Pixels count how often they are drawn. */
static void check_outlines(void)
{
    add_colors();
    for (int i = 0; i < 90; i++) {
        int kind = 1 + i % (KINDS - 1);
        unsigned n = random_count(kind);
        struct corner_list edges, corners;
        bind_vertices(i & 4);
        outline(kinds[kind].primitive, n, &edges, &corners);
        set_number(TRIPTYCH_STATE_LASTPIXEL, i & 1);
        draw_list(TRIPTYCH_LINE_LIST, &edges, 2);
        keep_expected();
        set(TRIPTYCH_STATE_FILLMODE, "wireframe");
        OK(triptych_draw(device, kinds[kind].primitive, 0, n));
        expect_same(kinds[kind].name);
        draw_list(TRIPTYCH_POINT_LIST, &corners, 1);
        keep_expected();
        set(TRIPTYCH_STATE_FILLMODE, "point");
        OK(triptych_draw(device, kinds[kind].primitive, 0, n));
        expect_same(kinds[kind].name);
        set(TRIPTYCH_STATE_FILLMODE, "solid");
    }
}

static void test_outlines_have_no_inner_edges_and_each_corner_once(void)
{
    on_every_engine(check_outlines);
}

/* --- Indices --- */

static void check_indices(void)
{
    uint8_t bytes[VERTICES];
    uint16_t words[VERTICES];
    for (int primitive = 0; primitive < TRIPTYCH_PRIMITIVE_COUNT; primitive++) {
        bind_vertices(false);
        for (int i = 0; i < VERTICES; i++)
            words[i] = bytes[i] = (uint8_t)(random_word() % VERTICES + 1);
        OK(triptych_set_indices(device, buffer_of(words, sizeof words), 16));
        OK(triptych_draw_indexed(device, primitive, -1, 4, 4));
        keep_expected();
        OK(triptych_set_indices(device, buffer_of(bytes, sizeof bytes), 8));
        OK(triptych_draw_indexed(device, primitive, -1, 4, 4));
        expect_same("indices of 8 bits");
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, primitive, 0, 4, VERTICES));
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, primitive, -100, 4, 4));
    }
}

static void test_indices_of_8_bits_are_those_of_16(void)
{
    on_every_engine(check_indices);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_primitives_are_triangles_or_lines_in_the_order_of_their_vertices);
    RUN_TEST(test_outlines_have_no_inner_edges_and_each_corner_once);
    RUN_TEST(test_indices_of_8_bits_are_those_of_16);
    RUN_TEST(test_the_last_vertex_can_give_flat_colours);
    return UNITY_END();
}
