/* Smooth edges of triangles in the pipeline, on every engine: the numbers of the edges of each primitive,
 * clipping, the alpha test, the channels that are multiplied, and targets with several samples. */
#include "tests/support/smooth/smooth.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

/* --- The numbers of edges ------------------------------------------------------------------------------- */

/* A draw, and the same triangles one by one: their vertices by number, and the bit of each edge; 4: none. */
struct numbering {
    enum triptych_primitive primitive;
    unsigned vertices, triangles;
    struct {
        uint8_t vertex[3], bit[3];
    } of[3];
};

static const struct numbering numberings[] = {
    {TRIPTYCH_TRIANGLE_LIST, 3, 1, {{{0, 1, 2}, {0, 1, 2}}}},
    {TRIPTYCH_TRIANGLE_STRIP, 5, 3, {{{0, 1, 2}, {0, 1, 2}}, {{1, 2, 3}, {0, 1, 2}}, {{2, 3, 4}, {0, 1, 2}}}},
    {TRIPTYCH_TRIANGLE_FAN, 5, 3, {{{0, 1, 2}, {0, 1, 2}}, {{0, 2, 3}, {0, 1, 2}}, {{0, 3, 4}, {0, 1, 2}}}},
    {TRIPTYCH_QUAD_LIST, 4, 2, {{{0, 1, 2}, {0, 1, 4}}, {{0, 2, 3}, {4, 2, 3}}, {{0}, {0}}}},
    {TRIPTYCH_QUAD_STRIP, 4, 2, {{{0, 1, 3}, {0, 1, 4}}, {{0, 3, 2}, {4, 2, 3}}, {{0}, {0}}}},
    {TRIPTYCH_POLYGON, 5, 3, {{{0, 1, 2}, {0, 1, 4}}, {{0, 2, 3}, {4, 1, 4}}, {{0, 3, 4}, {4, 1, 2}}}},
};

/* Where the last vertex gives the colour, quads are divided by their other diagonal. */
static const struct numbering last_numberings[] = {
    {TRIPTYCH_QUAD_LIST, 4, 2, {{{3, 0, 1}, {3, 0, 4}}, {{3, 1, 2}, {4, 1, 2}}, {{0}, {0}}}},
    {TRIPTYCH_QUAD_STRIP, 4, 2, {{{3, 2, 0}, {2, 3, 4}}, {{3, 0, 1}, {4, 0, 1}}, {{0}, {0}}}},
};

static void draw_one_by_one(const struct numbering *n, const struct shape_vertex *v, unsigned edges)
{
    smooth_begin(0);
    for (unsigned t = 0; t < n->triangles; t++) {
        struct shape_vertex corner[3];
        unsigned bits = 0;
        for (unsigned k = 0; k < 3; k++) {
            corner[k] = v[n->of[t].vertex[k]];
            bits |= (edges >> n->of[t].bit[k] & 1) << k;
        }
        set_number(TRIPTYCH_STATE_EDGEANTIALIAS, bits);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, corner, 3);
    }
    read_shapes();
}

static void expect_same(const uint32_t *expected, const struct numbering *n, unsigned edges)
{
    char text[120];
    for (int p = 0; p < SIZE * SIZE; p++) {
        int difference = (int)channel(image[p], 3) - (int)channel(expected[p], 3);
        if (difference >= -1 && difference <= 1)
            continue;
        snprintf(text, sizeof text, "primitive %d, edges %u at (%d, %d): expected %u, got %u", n->primitive,
                 edges, p % SIZE, p / SIZE, channel(expected[p], 3), channel(image[p], 3));
        TEST_FAIL_MESSAGE(text);
    }
}

static void check_numbering(const struct numbering *n)
{
    static uint32_t expected[SIZE * SIZE];
    const struct shape_vertex round[5] = {smooth_vertex(8.3, 40.1), smooth_vertex(12.4, 9.6),
                                          smooth_vertex(44.7, 5.2), smooth_vertex(57.8, 33.9),
                                          smooth_vertex(31.3, 59.2)};
    const struct shape_vertex zigzag[5] = {smooth_vertex(5.3, 10.1), smooth_vertex(12.4, 52.6),
                                           smooth_vertex(24.7, 7.2), smooth_vertex(38.8, 55.9),
                                           smooth_vertex(57.3, 12.7)};
    bool strip = n->primitive == TRIPTYCH_TRIANGLE_STRIP || n->primitive == TRIPTYCH_QUAD_STRIP;
    const struct shape_vertex *v = strip ? zigzag : round;
    for (unsigned edges = 0; edges < 16; edges += 1 + random_word() % 3) {
        draw_one_by_one(n, v, edges);
        memcpy(expected, image, sizeof expected);
        smooth_begin(edges);
        draw_shape(n->primitive, v, n->vertices);
        read_shapes();
        expect_same(expected, n, edges);
    }
}

static void check_numberings(void)
{
    set(TRIPTYCH_STATE_SHADEMODE, "flat");
    for (int last = 0; last < 2; last++) {
        OK(triptych_set_convention(device, TRIPTYCH_PROVOKING_VERTEX,
                                   last ? TRIPTYCH_PROVOKING_VERTEX_LAST : TRIPTYCH_PROVOKING_VERTEX_FIRST));
        for (unsigned i = 0; i < sizeof numberings / sizeof *numberings; i++) {
            bool quads = i == 3 || i == 4;
            check_numbering(last && quads ? &last_numberings[i - 3] : &numberings[i]);
        }
    }
}

static void test_bits_number_the_edges_of_each_primitive(void)
{
    on_every_engine(check_numberings);
}

/* --- Masks of primitives -------------------------------------------------------------------------------- */

/* Triangles of one draw whose first vertices have masks; with flat shading and the last vertex as the
 * provoking one, the last vertices. The masks are numbers of any type. */
static void check_masks(void)
{
    static const struct {
        enum triptych_format format;
        float number[3];
        uint8_t byte[4];
        unsigned mask;
    } kinds[] = {
        {TRIPTYCH_FORMAT_FLOAT1, {5}, {0}, 5},          {TRIPTYCH_FORMAT_FLOAT3, {2.75f, 9, 9}, {0}, 2},
        {TRIPTYCH_FORMAT_UBYTE1, {0}, {3}, 3},          {TRIPTYCH_FORMAT_BYTE2, {0}, {4, 7}, 4},
        {TRIPTYCH_FORMAT_UBYTE1, {0}, {255}, 15},       {TRIPTYCH_FORMAT_BYTE1, {0}, {0xfe}, 0},
        {TRIPTYCH_FORMAT_FLOAT1, {-1}, {0}, 0},         {TRIPTYCH_FORMAT_FLOAT16_2, {0}, {0, 0x46}, 6},
        {TRIPTYCH_FORMAT_COLOR, {0}, {9, 9, 255, 9}, 1}};
    static uint32_t expected[SIZE * SIZE];
    const struct shape_vertex v[6] = {smooth_vertex(3.3, 5.1),   smooth_vertex(29.4, 9.6),
                                      smooth_vertex(14.7, 50.2), smooth_vertex(36.8, 61.9),
                                      smooth_vertex(33.3, 12.7), smooth_vertex(60.2, 40.3)};
    for (unsigned i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        bool last = i & 1;
        uint8_t data[6][12] = {{0}};
        triptych_buffer *buffer;
        memcpy(data[last ? 5 : 3], kinds[i].number, sizeof kinds[i].number);
        if (kinds[i].byte[0] || kinds[i].byte[1])
            memcpy(data[last ? 5 : 3], kinds[i].byte, sizeof kinds[i].byte);
        set(TRIPTYCH_STATE_SHADEMODE, last ? "flat" : "gouraud");
        OK(triptych_set_convention(device, TRIPTYCH_PROVOKING_VERTEX,
                                   last ? TRIPTYCH_PROVOKING_VERTEX_LAST : TRIPTYCH_PROVOKING_VERTEX_FIRST));
        set(TRIPTYCH_STATE_EDGEMASKENABLE, "false");
        smooth_begin(0);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        set_number(TRIPTYCH_STATE_EDGEANTIALIAS, kinds[i].mask & 6);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v + 3, 3);
        read_shapes();
        memcpy(expected, image, sizeof expected);
        OK(triptych_buffer_create(device, data, sizeof data, &buffer));
        const struct triptych_element element = {kinds[i].format, buffer, 0, sizeof *data},
                                      none = {TRIPTYCH_FORMAT_NONE, NULL, 0, 0};
        OK(triptych_set_element(device, TRIPTYCH_TEXCOORD7, &element));
        set(TRIPTYCH_STATE_EDGEMASKENABLE, "true");
        smooth_begin(6);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 6);
        read_shapes();
        for (int p = 0; p < SIZE * SIZE; p++)
            expect_pixel(p % SIZE, p / SIZE, expected[p], "triangles with masks");
        OK(triptych_set_element(device, TRIPTYCH_TEXCOORD7, &none));
        OK(triptych_buffer_destroy(device, buffer));
    }
}

static void test_primitives_of_a_draw_have_masks(void)
{
    on_every_engine(check_masks);
}

/* Other parts of a vertex are not read. */
static void check_short_masks(void)
{
    const uint8_t data[3] = {7, 7, 7};
    const struct shape_vertex v[6] = {smooth_vertex(3.3, 5.1),   smooth_vertex(29.4, 9.6),
                                      smooth_vertex(14.7, 50.2), smooth_vertex(36.8, 61.9),
                                      smooth_vertex(33.3, 12.7), smooth_vertex(60.2, 40.3)};
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, data, sizeof data, &buffer));
    const struct triptych_element element = {TRIPTYCH_FORMAT_UBYTE1, buffer, 0, 1};
    OK(triptych_set_element(device, TRIPTYCH_TEXCOORD7, &element));
    set(TRIPTYCH_STATE_EDGEMASKENABLE, "true");
    smooth_begin(7);
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 1, 1));
    set(TRIPTYCH_STATE_EDGEMASKENABLE, "false");
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 6);
}

static void test_every_vertex_of_a_draw_has_a_mask(void)
{
    on_every_engine(check_short_masks);
}

/* --- Other parts of the pipeline ------------------------------------------------------------------------ */

static double depth_at(const struct shape_vertex v[3], const struct area_side side[3], double x, double y)
{
    double depth = 0;
    for (int i = 0; i < 3; i++) {
        const struct area_side *opposite = &side[(i + 1) % 3];
        depth += (double)v[i].z * (opposite->a * x + opposite->b * y + opposite->c);
    }
    return depth / fabs(smooth_twice_area(v));
}

/* The far plane cuts a triangle to a smaller one, or to two. The new edge follows the rule of centres.
 * Pixels at the ends of the edge between the two belong to one of them. */
static void check_clipped(float first, float others)
{
    struct shape_vertex v[3] = {smooth_vertex(4.2, 32.6), smooth_vertex(60.7, 6.3),
                                smooth_vertex(58.1, 57.4)};
    v[0].z = first;
    v[1].z = v[2].z = others;
    struct area_side side[3] = {smooth_side(v, 0), smooth_side(v, 1), smooth_side(v, 2)};
    double part = (double)((1 - first) / (others - first)), along_x = (double)(v[1].x - v[0].x);
    double x1 = (double)v[0].x + part * along_x, y1 = (double)v[0].y + part * (double)(v[1].y - v[0].y);
    struct area_side between = area_side_of(x1, y1, (double)v[2].x, (double)v[2].y, 0);
    smooth_begin(7);
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int x = p % SIZE, y = p / SIZE;
        double depth = depth_at(v, side, x + 0.5, y + 0.5);
        bool end = area_cuts(&between, 1, x, y) && area_cuts(side, 3, x, y);
        if (end || fabs(depth - 1) < 0.01)
            continue;
        expect_area(depth < 1 ? area_within(side, 3, x, y) : 0, p,
                    area_cuts(side, 3, x, y) > 1 ? SMOOTH_CORNER : SMOOTH_STRAIGHT, "a clipped triangle");
    }
}

static void check_clipping(void)
{
    check_clipped(0, 1.5f);
    check_clipped(1.5f, 0.25f);
}

static void test_edges_of_the_clipper_are_not_smooth(void)
{
    on_every_engine(check_clipping);
}

/* The test has the product of alpha and coverage; with 0xff alpha it is the coverage's byte. */
static void check_alpha_test(void)
{
    static uint32_t all[SIZE * SIZE];
    struct shape_vertex v[3];
    smooth_far_triangle(v, 0.7, 3, false);
    smooth_begin(1);
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    memcpy(all, image, sizeof all);
    set(TRIPTYCH_STATE_ALPHATESTENABLE, "true");
    set(TRIPTYCH_STATE_ALPHAFUNC, "greater");
    set_number(TRIPTYCH_STATE_ALPHAREF, 99);
    clear_shapes();
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, channel(all[p], 3) > 99 ? all[p] : 0, "tested");
}

static void test_the_alpha_test_follows_the_coverage(void)
{
    on_every_engine(check_alpha_test);
}

static unsigned product(unsigned a, unsigned b)
{
    return (2 * a * b + 255) / 510;
}

/* The colour's channels, and the bytes of the coverage that a white triangle leaves. */
static void check_channels(void)
{
    static uint32_t part[SIZE * SIZE];
    for (int all = 0; all < 2; all++) {
        struct shape_vertex v[3];
        smooth_far_triangle(v, 2.1, -4, true);
        set(TRIPTYCH_STATE_COVERAGETARGET, "alpha");
        smooth_begin(1);
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        read_shapes();
        memcpy(part, image, sizeof part);
        for (int i = 0; i < 3; i++)
            v[i].color = 0xc8a06432;
        set(TRIPTYCH_STATE_COVERAGETARGET, all ? "color" : "alpha");
        clear_shapes();
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        read_shapes();
        for (int p = 0; p < SIZE * SIZE; p++) {
            uint32_t color = image_word(0xc8a06432), expected = 0;
            for (int c = 0; c < 4 && smooth_is_drawn(p); c++) {
                bool multiplied = all || c == 3;
                expected |= product(channel(color, c), multiplied ? channel(part[p], 3) : 255) << 8 * c;
            }
            expect_pixel(p % SIZE, p / SIZE, expected, all ? "all channels" : "alpha");
        }
    }
}

static void test_alpha_or_all_channels_are_multiplied(void)
{
    on_every_engine(check_channels);
}

/* With several samples, coverage is that of samples. */
static void check_samples(void)
{
    static uint32_t plain[SIZE * SIZE];
    const struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {TRIPTYCH_SURFACE_A8R8G8B8}, .samples = 4};
    const float black[4] = {0};
    struct shape_vertex v[3] = {smooth_vertex(4.2, 32.6), smooth_vertex(60.7, 6.3),
                                smooth_vertex(58.1, 57.4)};
    OK(triptych_set_target_description(device, &description));
    for (unsigned edges = 0; edges < 8; edges += 7) {
        set_number(TRIPTYCH_STATE_EDGEANTIALIAS, edges);
        OK(triptych_clear(device, black, 1));
        draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
        OK(triptych_read_color(device, image, sizeof image));
        if (!edges)
            memcpy(plain, image, sizeof plain);
    }
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, plain[p], "several samples");
}

static void test_targets_with_several_samples_have_no_smooth_edges(void)
{
    on_every_engine(check_samples);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bits_number_the_edges_of_each_primitive);
    RUN_TEST(test_primitives_of_a_draw_have_masks);
    RUN_TEST(test_every_vertex_of_a_draw_has_a_mask);
    RUN_TEST(test_edges_of_the_clipper_are_not_smooth);
    RUN_TEST(test_the_alpha_test_follows_the_coverage);
    RUN_TEST(test_alpha_or_all_channels_are_multiplied);
    RUN_TEST(test_targets_with_several_samples_have_no_smooth_edges);
    return UNITY_END();
}
