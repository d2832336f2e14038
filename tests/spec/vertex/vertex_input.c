/* Vertex input on every engine: the numbers that each type in memory represents, vertices in window
 * coordinates, streams, instances and flexible vertex formats. Expected values are computed from the
 * definition in double. */
#include "tests/support/picture/canvas.h"
#include "tests/support/picture/shading.h"

#include "base/half.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
    shading_close();
}

/* --- Types --------------------------------------------------------------------------------------------- */

enum { VERTICES = 64, WORDS = 4, BYTES = WORDS * 4 };

/* Three more bytes can be read after the last vertex. */
static uint8_t memory[VERTICES * (BYTES + 1) + 3 + 3];

static double binary16(unsigned half)
{
    int exponent = half >> 10 & 31, mantissa = half & 1023;
    double sign = half & 0x8000 ? -1 : 1;
    if (exponent == 31)
        return mantissa ? NAN : sign * INFINITY;
    return sign * (exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24));
}

static uint32_t bits_at(const uint8_t *at, unsigned bit, unsigned bits)
{
    uint64_t value = 0;
    for (unsigned i = bit / 8; i <= (bit + bits - 1) / 8; i++)
        value |= (uint64_t)at[i] << 8 * (i - bit / 8);
    return (uint32_t)(value >> bit % 8 & (((uint64_t)1 << bits) - 1));
}

static int64_t as_signed(uint32_t value, unsigned bits)
{
    return value >> (bits - 1) ? (int64_t)value - ((int64_t)1 << bits) : (int64_t)value;
}

/* The meaning of the name of a type of integers, such as ushort3n. */
struct named {
    const char *name;
    unsigned bits;
    bool is_signed;
};

static const struct named names[] = {{"byte", 8, true},     {"ubyte", 8, false}, {"short", 16, true},
                                     {"ushort", 16, false}, {"int", 32, true},   {"uint", 32, false},
                                     {"fixed", 32, true},   {"udec", 10, false}, {"dec", 10, true}};

/* The integer before the division, as a binary32. */
static double integer_at(const struct named *named, const uint8_t *at, unsigned c)
{
    uint32_t field = bits_at(at, c * named->bits, named->bits);
    return (double)(named->is_signed ? (float)as_signed(field, named->bits) : (float)field);
}

/* Component c of a type of integers, by its name: with "n" the largest integer is 1. */
static double integer(const struct named *named, const char *rest, const uint8_t *at, unsigned c)
{
    double value = integer_at(named, at, c), most = ldexp(1, (int)named->bits - named->is_signed) - 1;
    return !strcmp(named->name, "fixed") ? value / 65536 : rest[1] == 'n' ? value / most : value;
}

/* Component c as Direct3D 9's D3DDECLTYPE, or the name of the type, defines it. */
static double component(enum triptych_format format, const uint8_t *at, int c)
{
    static const uint8_t color_byte[4] = {2, 1, 0, 3};
    const char *word = key_vertex_types[format].word;
    size_t letters = strcspn(word, "0123456789");
    float number;
    if (format == TRIPTYCH_FORMAT_COLOR)
        return at[color_byte[c]] / 255.0;
    bool half = !strncmp(word, "float16_", 8);
    if (c >= word[half ? 8 : letters] - '0')
        return c == 3;
    if (half)
        return binary16(bits_at(at, 16 * (unsigned)c, 16));
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strlen(names[i].name) == letters && !strncmp(names[i].name, word, letters))
            return integer(&names[i], word + letters, at, (unsigned)c);
    memcpy(&number, at + 4 * c, sizeof number);
    return (double)number;
}

/* A vertex in the window: a 1/w of 0 is 1. */
static double in_window(double value, int c)
{
    return c == 3 && value == 0 ? 1 : value;
}

/* Within one unit in the last place; integers, binary16 and the ends of ranges are exact. */
static void expect_component(enum triptych_format format, const uint8_t *at, int c, float got)
{
    double expected = in_window(component(format, at, c), c);
    int normalised = key_vertex_types[format].scale != 1;
    double tolerance = normalised && expected != 0 && fabs(expected) != 1 ? fabs(expected) * 0x1p-23 : 0;
    char message[128];
    snprintf(message, sizeof message, "%s component %d of %08x %08x: expected %.9g, got %.9g",
             key_vertex_types[format].word, c, (unsigned)bits_at(at, 0, 32), (unsigned)bits_at(at, 32, 32),
             expected, (double)got);
    if (isnan(expected) ? !isnan(got)
                        : !(fabs(expected - (double)got) <= tolerance) && expected != (double)got)
        TEST_FAIL_MESSAGE(message);
}

static void fill_vertex(enum triptych_format format, int v, uint8_t *vertex)
{
    static const uint32_t edges[] = {0,          0xffffffff, 0x80008000, 0x7fff7fff, 0x80018001, 0x80000000,
                                     0x00010001, 0x7c007bff, 0xfc00fbff, 0x04000001, 0x03ff83ff, 0x7fffffff,
                                     0x3c00bc00, 0x1ff7fdff, 0x20080200, 0x3fffffff, 0x7e017c01, 0x80807f7f,
                                     0x01000001, 0x01000003, 0xff000080, 0xff000180, 0xff00017f, 0x81000001};
    enum { EDGES = sizeof edges / sizeof *edges };
    for (int w = 0; w < WORDS; w++) {
        uint32_t word = v < EDGES ? edges[(v + w) % EDGES] : random_word();
        float number = (float)random_between(-100, 100);
        if (key_vertex_types[format].encoding == ENCODING_FLOAT)
            memcpy(&word, &number, sizeof number);
        memcpy(vertex + 4 * w, &word, sizeof word);
    }
}

/* Vertices in the window pass through as they were fetched. They begin at this byte. */
static void check_type(enum triptych_format format, size_t begin, size_t stride)
{
    for (int v = 0; v < VERTICES; v++)
        fill_vertex(format, v, memory + begin + (size_t)v * stride);
    shading_bind(TRIPTYCH_POSITIONT, format, memory + begin, stride);
    shade(VERTICES);
    for (uint32_t v = 0; v < VERTICES; v++)
        for (int c = 0; c < 4; c++)
            expect_component(format, memory + begin + v * stride, c, shaded_slot(SLOT_X + c, v));
}

static void check_types(void)
{
    for (int format = 1; format < TRIPTYCH_FORMAT_COUNT; format++)
        check_type((enum triptych_format)format, 0, BYTES);
}

/* Every byte of a word, with vertices that begin at different ones. */
static void check_alignments(void)
{
    for (int format = 1; format < TRIPTYCH_FORMAT_COUNT; format++)
        for (size_t begin = 0; begin < 4; begin++)
            check_type((enum triptych_format)format, begin, BYTES + begin % 2);
}

static void test_attributes_begin_at_any_byte(void)
{
    shading_on_every_engine(check_alignments);
}

/* Vertices without gaps: those of a byte are a byte apart. */
static void check_packed(void)
{
    for (int format = 1; format < TRIPTYCH_FORMAT_COUNT; format++) {
        size_t stride = key_vertex_types[format].bytes;
        for (size_t i = 0; i < VERTICES * stride + 3; i++)
            memory[i] = key_vertex_types[format].encoding == ENCODING_FLOAT ? 0x3f : (uint8_t)random_word();
        shading_bind(TRIPTYCH_POSITIONT, (enum triptych_format)format, memory, stride);
        shade(VERTICES);
        for (uint32_t v = 0; v < VERTICES; v++)
            for (int c = 0; c < 4; c++)
                expect_component((enum triptych_format)format, memory + v * stride, c,
                                 shaded_slot(SLOT_X + c, v));
    }
}

static void test_vertices_need_no_gaps(void)
{
    shading_on_every_engine(check_packed);
}

/* Sums of two powers of two that are halfway between two binary32: the even one is taken. */
static void check_rounding(void)
{
    static const uint32_t words[] = {0x01000001, 0x01000003, 0x80000080, 0x80000180,
                                     0xfffffeff, 0xffffff7f, 0xffffff80, 0xffffffff};
    static const double unsigned_value[] = {0x1.0p24,      0x1.000004p24, 0x1.0p31, 0x1.000004p31,
                                            0x1.fffffep31, 0x1.fffffep31, 0x1p32,   0x1p32};
    static const double signed_value[] = {0x1.0p24, 0x1.000004p24, -0x1.fffffep30, -0x1.fffffap30,
                                          -257,     -129,          -128,           -1};
    enum { COUNT = sizeof words / sizeof *words };
    shading_bind(TRIPTYCH_POSITIONT, TRIPTYCH_FORMAT_UINT1, words, 4);
    shade(COUNT);
    for (uint32_t v = 0; v < COUNT; v++)
        TEST_ASSERT_TRUE(unsigned_value[v] == (double)shaded_slot(SLOT_X, v));
    shading_bind(TRIPTYCH_POSITIONT, TRIPTYCH_FORMAT_INT1, words, 4);
    shade(COUNT);
    for (uint32_t v = 0; v < COUNT; v++)
        TEST_ASSERT_TRUE(signed_value[v] == (double)shaded_slot(SLOT_X, v));
}

static void test_wide_integers_are_rounded_to_the_nearest(void)
{
    shading_on_every_engine(check_rounding);
}

static void test_each_type_has_the_values_of_its_name(void)
{
    shading_on_every_engine(check_types);
}

/* Compares all binary16 numbers with the conversion that writes texture and vertex files. */
static void check_halves(void)
{
    static uint16_t half[VERTEX_CAPACITY * 4];
    for (uint32_t first = 0; first < 65536; first += VERTEX_CAPACITY * 4) {
        for (uint32_t i = 0; i < VERTEX_CAPACITY * 4; i++)
            half[i] = (uint16_t)(first + i);
        shading_bind(TRIPTYCH_POSITIONT, TRIPTYCH_FORMAT_FLOAT16_4, half, 8);
        shade(VERTEX_CAPACITY);
        for (uint32_t i = 0; i < VERTEX_CAPACITY * 4; i++) {
            float got = shaded_slot(SLOT_X + (int)(i % 4), i / 4);
            float expected = half_to_float(half[i]); /* not converted: a signalling NaN would become quiet */
            if (i % 4 == 3 && expected == 0)
                expected = 1;
            double exact = in_window(binary16(half[i]), (int)(i % 4));
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, memcmp(&got, &expected, sizeof got), "binary16");
            TEST_ASSERT_TRUE(isnan(exact) ? isnan(got) : exact == (double)got);
            TEST_ASSERT_TRUE(isnan(exact) || exact != binary16(half[i]) || float_to_half(got) == half[i]);
        }
    }
}

static void test_every_binary16_is_converted_exactly(void)
{
    shading_on_every_engine(check_halves);
}

/* A position of four components is divided by its w, whatever its type; others have w = 1. */
static void check_fourth_component(void)
{
    static const int16_t shorts[4] = {10, 20, 30, 4};
    shading_bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_SHORT4, shorts, 8);
    shade(1);
    for (int c = 0; c < 4; c++)
        TEST_ASSERT_EQUAL_FLOAT(shorts[c], shaded_slot(SLOT_X + c, 0));
    shading_bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_SHORT2, shorts, 8);
    shade(1);
    TEST_ASSERT_EQUAL_FLOAT(0, shaded_slot(SLOT_Z, 0));
    TEST_ASSERT_EQUAL_FLOAT(1, shaded_slot(SLOT_W, 0));
}

static void test_positions_of_four_components_have_a_w(void)
{
    shading_on_every_engine(check_fourth_component);
}

/* --- Vertices in the window ---------------------------------------------------------------------------- */

struct window_vertex {
    float x, y, z, reciprocal_w;
    uint32_t color;
};

static triptych_buffer *buffer_of(const void *data, size_t bytes)
{
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, data, bytes, &buffer));
    return buffer;
}

static void draw_window(const struct window_vertex *vertices, uint32_t count)
{
    enum { XYZRHW_DIFFUSE = 0x004 | 0x040 };
    OK(triptych_set_fvf(device, XYZRHW_DIFFUSE));
    OK(triptych_set_stream(device, 0, buffer_of(vertices, count * sizeof *vertices), 0, sizeof *vertices));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, count - 2));
    OK(triptych_read_color(device, image, sizeof image));
}

static void draw_rectangle(float x0, float y0, float x1, float y1, float z, float reciprocal_w)
{
    const struct window_vertex vertices[4] = {{x0, y0, z, reciprocal_w, 0xff204060},
                                              {x1, y0, z, reciprocal_w, 0xff204060},
                                              {x0, y1, z, reciprocal_w, 0xff204060},
                                              {x1, y1, z, reciprocal_w, 0xff204060}};
    draw_window(vertices, 4);
}

static void expect_rectangle(int x0, int y0, int x1, int y1, const char *what)
{
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            int inside = x >= x0 && x < x1 && y >= y0 && y < y1;
            expect_pixel(x, y, inside ? image_word(0xff204060) : 0xff000000, what);
        }
}

/* Matrices, lights and the viewport's scale do not change vertices in window coordinates. */
static void check_window_positions(void)
{
    float matrix[4][4] = {{3, 1, 4, 1}, {5, 9, 2, 6}, {5, 3, 5, 8}, {9, 7, 9, 3}};
    float depth[SIZE * SIZE];
    set(TRIPTYCH_STATE_LIGHTING, "true");
    set(TRIPTYCH_STATE_ZENABLE, "true");
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_WORLD, matrix));
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_PROJECTION, matrix));
    clear_to(0xff000000);
    draw_rectangle(7, 11, 33, 50, 0.375f, 0.3f);
    expect_rectangle(7, 11, 33, 50, "window");
    OK(triptych_read_depth(device, depth, sizeof depth));
    TEST_ASSERT_EQUAL_FLOAT(0.375f, depth[20 * SIZE + 20]);
    TEST_ASSERT_EQUAL_FLOAT(1, depth[5 * SIZE + 5]);
    OK(triptych_set_viewport(device, &(struct triptych_viewport){16, 16, 32, 32, 0.5f, 0.6f}));
    OK(triptych_clear(device, (float[4]){0, 0, 0, 1}, 1));
    draw_rectangle(20, 0, 60, 64, 0.25f, 7);
    for (int y = 16; y < 48; y++)
        for (int x = 16; x < 48; x++)
            expect_pixel(x, y, x >= 20 ? image_word(0xff204060) : 0xff000000, "viewport");
    OK(triptych_read_depth(device, depth, sizeof depth));
    TEST_ASSERT_EQUAL_FLOAT(0.25f, depth[20 * SIZE + 20]);
}

static void test_vertices_in_window_coordinates_are_not_moved(void)
{
    on_every_engine(check_window_positions);
}

/* Far outside of the guard band the clipper cuts triangles. The colours of the rest do not change. */
static void check_far_windows(void)
{
    static const float far[] = {20000, 1e6f, 1e9f, 1e30f};
    for (int i = 0; i < 4; i++) {
        clear_to(0xff000000);
        draw_rectangle(-far[i], -far[i], far[i], far[i], 0.5f, 1);
        expect_rectangle(0, 0, SIZE, SIZE, "far");
        clear_to(0xff000000);
        draw_rectangle(10, -far[i], far[i], 40, 0.5f, 3);
        expect_rectangle(10, 0, SIZE, 40, "far to the right");
    }
}

static void test_vertices_far_outside_of_the_window_are_clipped(void)
{
    on_every_engine(check_far_windows);
}

/* The colour along x between two ends with different 1/w is perspective. It is the same if the right end is
 * far away and cut off. */
static void check_perspective(double left, double right, float end)
{
    struct window_vertex v[4];
    for (int i = 0; i < 4; i++)
        v[i] = (struct window_vertex){.x = i & 1 ? end : 0,
                                      .y = i & 2 ? SIZE : 0,
                                      .z = 0.5f,
                                      .reciprocal_w = (float)(i & 1 ? right : left),
                                      .color = i & 1 ? 0xffffffff : 0xff000000};
    clear_to(0xff000000);
    draw_window(v, 4);
    for (int x = 0; x < SIZE; x++) {
        double t = (x + 0.5) / (double)end, value = t * right / (left + t * (right - left));
        double got = channel(image[8 * SIZE + x], 0);
        TEST_ASSERT_DOUBLE_WITHIN(0.51, 255 * value, got);
    }
}

static void check_perspectives(void)
{
    check_perspective(1, 1, SIZE);
    check_perspective(1, 0.125, SIZE);
    check_perspective(0.01, 2, SIZE);
    check_perspective(1, 1, 40000);
    check_perspective(1, 900, 40000);
}

static void test_colours_in_the_window_are_perspective_by_their_reciprocal_w(void)
{
    on_every_engine(check_perspectives);
}

/* --- Streams ------------------------------------------------------------------------------------------- */

/* Draws eight instances, two of each colour, with additive blending. */
static void check_instances(void)
{
    enum { INSTANCES = 8 };
    static const uint32_t color[INSTANCES / 2] = {0xff112233, 0xff445566, 0xff778899, 0xffaabbcc};
    static const uint16_t index[4] = {0, 1, 2, 3};
    static const struct triptych_declaration_element elements[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITION, 0},
        {1, 0, TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 0},
        {2, 4, TRIPTYCH_FORMAT_FLOAT1, TRIPTYCH_USAGE_TANGENT, 0}};
    const float square[4][4] = {{-1, 1, 0, 1}, {1, 1, 0, 1}, {-1, -1, 0, 1}, {1, -1, 0, 1}};
    OK(triptych_set_declaration(device, elements, 3));
    OK(triptych_set_stream(device, 0, buffer_of(square, sizeof square), 0, sizeof square[0]));
    OK(triptych_set_stream(device, 1, buffer_of(color, sizeof color), 0, 4));
    OK(triptych_set_stream_frequency(device, 0, TRIPTYCH_FREQUENCY_INDEXED, INSTANCES));
    OK(triptych_set_stream_frequency(device, 1, TRIPTYCH_FREQUENCY_INSTANCE, 2));
    OK(triptych_set_indices(device, buffer_of(index, sizeof index), 16));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "one");
    set(TRIPTYCH_STATE_DESTBLEND, "one");
    clear_to(0xff000000);
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 0, 2));
    OK(triptych_read_color(device, image, sizeof image));
    uint32_t expected = 0xff000000;
    for (int c = 0; c < 3; c++) {
        unsigned sum = 0;
        for (int i = 0; i < INSTANCES / 2; i++)
            sum += 2 * channel(image_word(color[i]), c);
        expected |= (sum > 255 ? 255 : sum) << 8 * c;
    }
    expect_pixel(3, 3, expected, "all instances, added");
    struct triptych_statistics statistics;
    triptych_get_statistics(device, &statistics);
    TEST_ASSERT_EQUAL_UINT64(2 * INSTANCES, statistics.triangles);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    OK(triptych_set_stream_frequency(device, 0, TRIPTYCH_FREQUENCY_INDEXED, INSTANCES + 1));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 0, 2));
    OK(triptych_set_stream(device, 1, NULL, 0, 0));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 0, 2));
}

static void test_instances_step_through_their_streams(void)
{
    on_every_engine(check_instances);
}

/* If positions step by instance, the three corners of a triangle are one point, and no pixel is covered. If
 * they step by vertex, the corners differ. */
static void check_instance_positions(void)
{
    enum { INSTANCES = 8 };
    float column[INSTANCES][4];
    uint32_t color[4] = {0xff102030, 0xff102030, 0xff102030, 0xff102030};
    static const uint16_t index[3] = {0, 1, 2};
    static const struct triptych_declaration_element elements[] = {
        {3, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITIONT, 0},
        {0, 0, TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 0}};
    for (int i = 0; i < INSTANCES; i++)
        memcpy(column[i], (float[4]){(float)i, 0, 0, 1}, sizeof column[i]);
    OK(triptych_set_declaration(device, elements, 2));
    OK(triptych_set_stream(device, 0, buffer_of(color, sizeof color), 0, 4));
    OK(triptych_set_stream(device, 3, buffer_of(column, sizeof column), 0, sizeof column[0]));
    OK(triptych_set_stream_frequency(device, 0, TRIPTYCH_FREQUENCY_INDEXED, INSTANCES));
    OK(triptych_set_stream_frequency(device, 3, TRIPTYCH_FREQUENCY_INSTANCE, 1));
    OK(triptych_set_indices(device, buffer_of(index, sizeof index), 16));
    clear_to(0xff000000);
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1));
    OK(triptych_read_color(device, image, sizeof image));
    expect_rectangle(0, 0, 0, 0, "three corners at one place");
    OK(triptych_set_stream_frequency(device, 3, TRIPTYCH_FREQUENCY_VERTEX, 1));
    OK(triptych_set_stream_frequency(device, 0, TRIPTYCH_FREQUENCY_VERTEX, 1));
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1));
}

static void test_an_instances_position_is_the_same_for_all_its_corners(void)
{
    on_every_engine(check_instance_positions);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_type_has_the_values_of_its_name);
    RUN_TEST(test_attributes_begin_at_any_byte);
    RUN_TEST(test_vertices_need_no_gaps);
    RUN_TEST(test_wide_integers_are_rounded_to_the_nearest);
    RUN_TEST(test_every_binary16_is_converted_exactly);
    RUN_TEST(test_positions_of_four_components_have_a_w);
    RUN_TEST(test_vertices_in_window_coordinates_are_not_moved);
    RUN_TEST(test_vertices_far_outside_of_the_window_are_clipped);
    RUN_TEST(test_colours_in_the_window_are_perspective_by_their_reciprocal_w);
    RUN_TEST(test_instances_step_through_their_streams);
    RUN_TEST(test_an_instances_position_is_the_same_for_all_its_corners);
    return UNITY_END();
}
