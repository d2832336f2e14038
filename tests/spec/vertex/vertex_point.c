/* Sizes of points that differ from vertex to vertex, on every engine: those of the vertices, and
 * pointscaleenable with its terms pointscale_a, pointscale_b and pointscale_c, against the formula in double.
 */
#include "tests/support/picture/canvas.h"
#include "tests/support/picture/shading.h"

#include <math.h>

enum { VERTICES = 32 };

static struct vertex {
    float position[3], size;
} vertex[VERTICES];

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
    shading_close();
}

static void bind_vertices(int sizes)
{
    for (int i = 0; i < VERTICES; i++) {
        for (int c = 0; c < 3; c++)
            vertex[i].position[c] = (float)random_between(-3, 3);
        vertex[i].size = (float)random_between(0, 3);
    }
    shading_bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3, vertex[0].position, sizeof *vertex);
    shading_bind(TRIPTYCH_POINT_SIZE, sizes ? TRIPTYCH_FORMAT_FLOAT1 : TRIPTYCH_FORMAT_NONE, &vertex[0].size,
                 sizeof *vertex);
    shading_primitive = PRIMITIVE_POINT;
}

static double limited(double size, double least, double most)
{
    return size > most ? most : fmax(size, least);
}

static void check_sizes(int sizes, int scaled, const float term[3], double least, double most)
{
    SHADING_REAL(pointscale_a, term[0]);
    SHADING_REAL(pointscale_b, term[1]);
    SHADING_REAL(pointscale_c, term[2]);
    SHADING_REAL(pointsize, 2.5f);
    SHADING_REAL(pointsize_min, (float)least);
    SHADING_REAL(pointsize_max, (float)most);
    SHADING_NUMBER(pointscaleenable, (uint32_t)scaled);
    shade(VERTICES);
    for (uint32_t i = 0; i < VERTICES; i++) {
        const struct vertex *v = &vertex[i];
        double size = sizes ? (double)v->size : 2.5, d = 0;
        for (int c = 0; c < 3; c++)
            d += (double)v->position[c] * (double)v->position[c];
        d = sqrt(d);
        double sum = (double)term[0] + (double)term[1] * d + (double)term[2] * d * d;
        if (scaled)
            size *= 64 * sqrt(1 / sum);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, limited(size, least, most), (double)shaded_slot(SLOT_POINT_SIZE, i));
    }
}

static void check_formulas(void)
{
    static const float terms[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {0.5f, 0.25f, 0.125f}, {0, 0, 0}};
    for (int sizes = 0; sizes < 2; sizes++) {
        bind_vertices(sizes);
        for (unsigned i = 0; i < sizeof terms / sizeof *terms; i++) {
            check_sizes(sizes, 1, terms[i], 1, 64);
            check_sizes(sizes, 1, terms[i], 20, 30);
            check_sizes(sizes, 1, terms[i], 0, 8000);
            check_sizes(sizes, 1, terms[i], 30, 20);
        }
        if (sizes)
            check_sizes(1, 0, terms[0], 0.5, 2);
    }
}

static void test_sizes_follow_the_formula(void)
{
    shading_on_every_engine(check_formulas);
}

/* The vertex size is read only where it can differ. */
static void check_keys(void)
{
    bind_vertices(0);
    shade(1);
    TEST_ASSERT_EQUAL_INT(POINT_SIZE_CONSTANT, shading_key[UNIT_VERTEX].vertex.point_size);
    TEST_ASSERT_EQUAL_INT(0, shading_key[UNIT_SETUP].setup.point_size);
    bind_vertices(1);
    shade(1);
    TEST_ASSERT_EQUAL_INT(POINT_SIZE_VERTEX, shading_key[UNIT_VERTEX].vertex.point_size);
    TEST_ASSERT_EQUAL_INT(1, shading_key[UNIT_SETUP].setup.point_size);
    SHADING_SET(pointscaleenable, "true");
    shading_primitive = PRIMITIVE_TRIANGLE;
    shade(1);
    TEST_ASSERT_EQUAL_INT(POINT_SIZE_CONSTANT, shading_key[UNIT_VERTEX].vertex.point_size);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE,
                          shading_key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_POINT_SIZE]);
}

static void test_triangles_have_no_size(void)
{
    shading_on_every_engine(check_keys);
}

/* Three points of three sizes in the window, the last below the minimum. */
static void check_picture(void)
{
    static const struct {
        float x, y, z, reciprocal_w, size;
        uint32_t color;
    } points[3] = {{16, 16, 0.5f, 1, 10, 0xffff0000},
                   {48, 16, 0.5f, 1, 4, 0xff00ff00},
                   {32, 48, 0.5f, 1, 1, 0xff0000ff}};
    enum { XYZRHW_PSIZE_DIFFUSE = 0x004 | 0x020 | 0x040 };
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, points, sizeof points, &buffer));
    OK(triptych_set_fvf(device, XYZRHW_PSIZE_DIFFUSE));
    OK(triptych_set_stream(device, 0, buffer, 0, sizeof *points));
    OK(triptych_set_state(device, TRIPTYCH_STATE_POINTSIZE_MIN, bits_of_float(6)));
    set(TRIPTYCH_STATE_POINTSCALEENABLE, "true");
    clear_to(0xff000000);
    OK(triptych_draw(device, TRIPTYCH_POINT_LIST, 0, 3));
    OK(triptych_read_color(device, image, sizeof image));
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            uint32_t expected = 0xff000000;
            for (int i = 0; i < 3; i++) {
                double half = fmax((double)points[i].size, 6) / 2;
                if (fabs(x + 0.5 - (double)points[i].x) < half && fabs(y + 0.5 - (double)points[i].y) < half)
                    expected = image_word(points[i].color);
            }
            expect_pixel(x, y, expected, "sizes of vertices");
        }
}

static void test_points_have_the_size_of_their_vertices(void)
{
    on_every_engine(check_picture);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_sizes_follow_the_formula);
    RUN_TEST(test_triangles_have_no_size);
    RUN_TEST(test_points_have_the_size_of_their_vertices);
    return UNITY_END();
}
