/* The clipper is compared with a reference in double precision that does not use lanes, codes or an order of
 * vertices. The tests also check the properties that the pipeline needs: new vertices are inside of the
 * planes and identical on shared edges, flat slots have the values of the provoking vertex, the original
 * vertices do not change, and the number of lanes suffices. */
#include "render/geometry/clip.h"
#include "tests/support/geometry/clipping.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
    clipping_begin();
}

void tearDown(void)
{
    clipping_end();
}

/* --- Vertices --- */

static uint32_t code_at(uint32_t lane)
{
    uint32_t code;
    memcpy(&code, clipping_word(SLOT_CODE, lane), sizeof code);
    return code;
}

static void put_inside_top_guard(uint32_t lane)
{
    float w = clipping_uniform(0.1f, 5);
    clipping_put(lane, clipping_uniform(-3, 3), nextafterf(clipping_job.guard_top * w, 0),
                 clipping_uniform(-1, 1), w);
}

/* --- Reference --- */

enum { REFERENCE_MAXIMUM = 16 };

struct reference {
    double point[REFERENCE_MAXIMUM][SLOT_COUNT];
    int count;
};

static double reference_distance(int plane, const double p[SLOT_COUNT])
{
    const struct job *job = &clipping_job;
    double w = p[SLOT_W];
    const double d[] = {w - CLIP_EYE_W,
                        p[SLOT_Z],
                        w - p[SLOT_Z],
                        p[SLOT_X] - (double)job->guard_left * w,
                        (double)job->guard_right * w - p[SLOT_X],
                        p[SLOT_Y] - (double)job->guard_bottom * w,
                        (double)job->guard_top * w - p[SLOT_Y]};
    if (plane < CLIPPING_FIRST_USER)
        return d[plane];
    const float *u = clipping_job.clip_plane[plane - CLIPPING_FIRST_USER];
    return (double)u[0] * p[SLOT_X] + (double)u[1] * p[SLOT_Y] + (double)u[2] * p[SLOT_Z] + (double)u[3] * w;
}

/* Clips at all planes, independently of codes, beginning with the last plane. */
static struct reference reference_clip(const uint32_t lane[3])
{
    struct reference r = {.count = 3};
    for (int i = 0; i < 3; i++)
        for (int s = 0; s < SLOT_COUNT; s++)
            r.point[i][s] = s == SLOT_CODE ? 0 : *clipping_word(s, lane[i]);
    for (int plane = CLIP_PLANES - 1; plane >= 0; plane--) {
        struct reference next = {.count = 0};
        for (int i = 0; i < r.count; i++) {
            const double *p = r.point[i], *q = r.point[(i + 1) % r.count];
            double dp = reference_distance(plane, p), dq = reference_distance(plane, q);
            if (dp >= 0)
                memcpy(next.point[next.count++], p, sizeof r.point[0]);
            if ((dp >= 0) != (dq >= 0)) {
                for (int s = 0; s < SLOT_COUNT; s++)
                    next.point[next.count][s] = (p[s] * dq - q[s] * dp) / (dq - dp);
                next.count++;
            }
        }
        r = next;
    }
    return r;
}

/* Twice the area of a polygon's projection onto the plane of two slots, computed as a fan, and the moments of
 * all slots over these areas. If two polygons have equal areas and moments, the same functions are
 * interpolated over the same area. */
struct moments {
    double area[3]; /* in x y, y z and z w, because a polygon may be perpendicular to one of these planes */
    double moment[SLOT_COUNT];
};

static void add_triangle(struct moments *m, const double *p, const double *q, const double *r)
{
    static const uint8_t axes[3][2] = {{SLOT_X, SLOT_Y}, {SLOT_Y, SLOT_Z}, {SLOT_Z, SLOT_W}};
    double area = 0;
    for (int i = 0; i < 3; i++) {
        int u = axes[i][0], v = axes[i][1];
        area = (q[u] - p[u]) * (r[v] - p[v]) - (r[u] - p[u]) * (q[v] - p[v]);
        m->area[i] += area;
        for (int s = 0; s < SLOT_COUNT; s++)
            m->moment[s] += area * (p[s] + q[s] + r[s]) / 3;
    }
}

static struct moments reference_moments(const struct reference *r)
{
    struct moments m = {0};
    for (int i = 1; i + 1 < r->count; i++)
        add_triangle(&m, r->point[0], r->point[i], r->point[i + 1]);
    return m;
}

static struct moments clipped_moments(int count, uint32_t triangle[][3])
{
    struct moments m = {0};
    for (int t = 0; t < count; t++) {
        double point[3][SLOT_COUNT];
        for (int i = 0; i < 3; i++)
            for (int s = 0; s < SLOT_COUNT; s++)
                point[i][s] = s == SLOT_CODE ? 0 : *clipping_word(s, triangle[t][i]);
        add_triangle(&m, point[0], point[1], point[2]);
    }
    return m;
}

static void expect_close(const uint32_t lane[3], const struct moments *expected, const struct moments *actual)
{
    double size = 1, tolerance;
    for (int i = 0; i < 3; i++)
        for (int s = 0; s < SLOT_CODE; s++)
            size = fmax(size, fabs((double)*clipping_word(s, lane[i])));
    tolerance = size * size * 40 * 0x1p-24;
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected->area[i], actual->area[i]);
    for (int s = 0; s < SLOT_COUNT; s++)
        TEST_ASSERT_DOUBLE_WITHIN(tolerance * size * 2, expected->moment[s], actual->moment[s]);
}

static uint32_t codes_of(const uint32_t lane[3])
{
    return code_at(lane[0]) | code_at(lane[1]) | code_at(lane[2]);
}

static void test_area_and_varyings_are_those_of_a_double_precision_reference(void)
{
    int clipped = 0, empty = 0, largest = 0;
    for (int round = 0; round < 60000; round++) {
        static const uint32_t lane[3] = {3, 0, 7};
        for (int i = 0; i < 3; i++)
            clipping_put_random(lane[i], round & 1 ? CLIPPING_WIDE : CLIPPING_MODERATE);
        struct clipper clipper = clipping_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        int count = clip_triangle(&clipper, lane, triangle);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(0, count);
        struct reference reference = reference_clip(lane);
        struct moments expected = reference_moments(&reference);
        struct moments actual = clipped_moments(count, triangle);
        expect_close(lane, &expected, &actual);
        clipped += (codes_of(lane) & CLIP_NEEDED) && count > 0;
        empty += count == 0;
        largest = count > largest ? count : largest;
    }
    TEST_ASSERT_GREATER_THAN_INT(10000, clipped);
    TEST_ASSERT_GREATER_THAN_INT(1000, empty);
    TEST_ASSERT_GREATER_THAN_INT(4, largest);
}

static void test_user_planes_cut_like_the_reference(void)
{
    int clipped = 0, largest = 0;
    for (int round = 0; round < 30000; round++) {
        static const uint32_t lane[3] = {3, 0, 7};
        clipping_set_user_planes(1 + round % CLIP_PLANES_USER);
        for (int i = 0; i < 3; i++)
            clipping_put_random(lane[i], round & 8 ? CLIPPING_WIDE : CLIPPING_MODERATE);
        struct clipper clipper = clipping_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        int count = clip_triangle(&clipper, lane, triangle);
        struct reference reference = reference_clip(lane);
        struct moments expected = reference_moments(&reference), actual = clipped_moments(count, triangle);
        expect_close(lane, &expected, &actual);
        clipped += (codes_of(lane) & CLIP_USER_ALL) && count > 0;
        largest = count > largest ? count : largest;
        memset(clipping_job.clip_plane, 0, sizeof clipping_job.clip_plane);
    }
    TEST_ASSERT_GREATER_THAN_INT(3000, clipped);
    TEST_ASSERT_GREATER_THAN_INT(5, largest);
}

static void test_ignored_planes_do_not_cut(void)
{
    static const uint32_t lane[3] = {3, 0, 7};
    clipping_put(3, 0, 0, -0.5f, 1);
    clipping_put(0, 1, 0, 0.5f, 1);
    clipping_put(7, 0, 1, 1.5f, 1);
    struct clipper clipper = clipping_clipper();
    uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
    clipper.ignored = CLIP_DEPTH;
    TEST_ASSERT_EQUAL_INT(1, clip_triangle(&clipper, lane, triangle));
    TEST_ASSERT_EQUAL_UINT32(CLIPPING_FIRST_FREE, clipper.next);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(lane, triangle[0], 3);
}

/* --- Properties of the vertices --- */

/* Expects a vertex inside of all planes. The limits of the guard planes are products, and the vertex may be
 * outside by the rounding error of the product. */
static void expect_inside(uint32_t lane)
{
    float x = *clipping_word(SLOT_X, lane), y = *clipping_word(SLOT_Y, lane),
          z = *clipping_word(SLOT_Z, lane), w = *clipping_word(SLOT_W, lane);
    TEST_ASSERT_TRUE(isfinite(x) && isfinite(y) && isfinite(z) && isfinite(w));
    TEST_ASSERT_TRUE(w >= CLIP_EYE_W);
    TEST_ASSERT_TRUE(z >= 0 && z <= w);
    double slack = 1 + 4 * 0x1p-24;
    TEST_ASSERT_TRUE((double)x >= (double)clipping_job.guard_left * w * slack);
    TEST_ASSERT_TRUE((double)x <= (double)clipping_job.guard_right * w * slack);
    TEST_ASSERT_TRUE((double)y >= (double)clipping_job.guard_bottom * w * slack);
    TEST_ASSERT_TRUE((double)y <= (double)clipping_job.guard_top * w * slack);
    TEST_ASSERT_EQUAL_HEX32(0, code_at(lane) & CLIP_NEEDED);
}

static void expect_vertices_inside(enum clipping_spread spread, int rounds)
{
    int kept = 0;
    for (int round = 0; round < rounds; round++) {
        static const uint32_t lane[3] = {1, 2, 5};
        for (int i = 0; i < 3; i++)
            clipping_put_random(lane[i], spread);
        struct clipper clipper = clipping_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        int count = clip_triangle(&clipper, lane, triangle);
        for (int t = 0; t < count; t++)
            for (int i = 0; i < 3; i++)
                expect_inside(triangle[t][i]);
        kept += count > 0;
    }
    TEST_ASSERT_GREATER_THAN_INT(rounds / 200, kept);
}

static void test_vertices_are_inside_of_all_planes(void)
{
    expect_vertices_inside(CLIPPING_MODERATE, 20000);
    expect_vertices_inside(CLIPPING_WIDE, 20000);
    expect_vertices_inside(CLIPPING_ON_PLANES, 20000);
}

static void test_vertices_are_finite_and_inside_for_extreme_coordinates(void)
{
    expect_vertices_inside(CLIPPING_EXTREME, 100000);
    expect_vertices_inside(CLIPPING_DEEP, 50000);
    for (int round = 0; round < 20000; round++) { /* with the largest floats */
        static const uint32_t lane[3] = {1, 2, 5};
        static const float coordinate[] = {FLT_MAX, -FLT_MAX, FLT_MAX / 16, FLT_MIN, 1, 0, CLIP_EYE_W};
        for (int i = 0; i < 3; i++)
            clipping_put(lane[i], coordinate[clipping_draw() % 7], coordinate[clipping_draw() % 7],
                         coordinate[clipping_draw() % 7], coordinate[clipping_draw() % 7]);
        struct clipper clipper = clipping_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        int count = clip_triangle(&clipper, lane, triangle);
        for (int t = 0; t < count; t++)
            for (int i = 0; i < 3; i++)
                expect_inside(triangle[t][i]);
    }
}

/* A fourteenth of the way from w to w + 7 units is exactly between two floats. A fourteenth is not a double,
 * so the errors of z and w would decide how each of them is rounded. */
static void test_vertices_on_the_far_plane_have_z_equal_to_w(void)
{
    for (int round = 1; round <= 4000; round++) {
        static const uint32_t lane[3] = {0, 1, 2};
        float w = 1.5f + (float)round * 0x1p-14f, far_w = w + 7 * 0x1p-23f, depth = (float)round * 0x1p-20f;
        clipping_put(0, 0, 0, w - depth, w);
        clipping_put(1, 0, 1, far_w + 13 * depth, far_w);
        clipping_put(2, 1, 0, 0.5f, 1);
        struct clipper clipper = clipping_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        TEST_ASSERT_EQUAL_INT(2, clip_triangle(&clipper, lane, triangle));
        for (uint32_t made = CLIPPING_FIRST_FREE; made < CLIPPING_FIRST_FREE + 2; made++)
            TEST_ASSERT_EQUAL_MEMORY(clipping_word(SLOT_W, made), clipping_word(SLOT_Z, made), sizeof(float));
    }
}

static void test_a_triangle_inside_comes_back_as_it_is(void)
{
    static const uint32_t lane[3] = {9, 4, 6};
    clipping_put(9, 0, 0, 0.5f, 1);
    clipping_put(4, 1.5f, 0, 0, 1); /* right of the frustum, where the clipper does not cut */
    clipping_put(6, 0, 1, 1, 1);
    struct clipper clipper = clipping_clipper();
    uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
    TEST_ASSERT_EQUAL_INT(1, clip_triangle(&clipper, lane, triangle));
    TEST_ASSERT_EQUAL_UINT32_ARRAY(lane, triangle[0], 3);
    TEST_ASSERT_EQUAL_UINT32(CLIPPING_FIRST_FREE, clipper.next);
}

static void test_the_near_plane_cuts_where_it_should(void)
{
    static const uint32_t lane[3] = {0, 1, 2};
    clipping_put(0, -0.5f, 0, -0.25f, 1); /* outside: a quarter of the way to the others */
    clipping_put(1, 0.5f, 0, 0.75f, 1);
    clipping_put(2, -0.5f, 0.5f, 0.75f, 1);
    *clipping_word(SLOT_texcoord0, 0) = 8;
    *clipping_word(SLOT_texcoord0, 1) = 16;
    struct clipper clipper = clipping_clipper();
    uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
    TEST_ASSERT_EQUAL_INT(2, clip_triangle(&clipper, lane, triangle));
    TEST_ASSERT_EQUAL_UINT32(CLIPPING_FIRST_FREE + 2, clipper.next);
    const uint32_t expected[2][3] = {{CLIPPING_FIRST_FREE, 1, 2},
                                     {CLIPPING_FIRST_FREE, 2, CLIPPING_FIRST_FREE + 1}};
    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected[0], triangle[0], 3);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected[1], triangle[1], 3);
    TEST_ASSERT_EQUAL_FLOAT(-0.25f, *clipping_word(SLOT_X, CLIPPING_FIRST_FREE));
    TEST_ASSERT_EQUAL_FLOAT(0, *clipping_word(SLOT_Z, CLIPPING_FIRST_FREE));
    TEST_ASSERT_EQUAL_FLOAT(10, *clipping_word(SLOT_texcoord0, CLIPPING_FIRST_FREE));
    TEST_ASSERT_EQUAL_FLOAT(0.125f, *clipping_word(SLOT_Y, CLIPPING_FIRST_FREE + 1));
}

/* --- Shared edges --- */

static bool same_vertex(uint32_t a, uint32_t b)
{
    for (int s = 0; s < SLOT_COUNT; s++)
        if (s != SLOT_CODE && memcmp(clipping_word(s, a), clipping_word(s, b), sizeof(float)) != 0)
            return false;
    return true;
}

/* A varying that is 0 at both ends of the shared edge and 1 at the other vertices identifies new vertices of
 * this edge. */
enum { MARK = SLOT_texcoord0 };

/* Stores the new lanes from `first` to `last` that are on the edge. Returns their number. */
static int lanes_on_edge(uint32_t first, uint32_t last, uint32_t found[CLIPPING_LANES])
{
    int count = 0;
    for (uint32_t lane = first; lane < last; lane++)
        if (*clipping_word(MARK, lane) == 0)
            found[count++] = lane;
    return count;
}

static void expect_subset(int n, const uint32_t a[], int m, const uint32_t b[])
{
    for (int i = 0; i < n; i++) {
        bool found = false;
        for (int j = 0; j < m && !found; j++)
            found = same_vertex(a[i], b[j]);
        TEST_ASSERT_TRUE_MESSAGE(found, "a vertex on the shared edge is not the neighbour's");
    }
}

/* Clips two triangles with the edge 0-1. The second has the opposite direction and starts at any vertex. If
 * the first triangle is very narrow (`degenerate`), it may have more vertices that seem to be on the edge. */
static int compare_shared_edge(int round, bool degenerate)
{
    for (uint32_t lane = 0; lane < 4; lane++)
        *clipping_word(MARK, lane) = lane >= 2;
    const uint32_t turned[3][3] = {{1, 0, 3}, {0, 3, 1}, {3, 1, 0}};
    const uint32_t first[3] = {0, 1, 2};
    struct clipper clipper = clipping_clipper();
    uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, clip_triangle(&clipper, first, triangle));
    uint32_t middle = clipper.next;
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, clip_triangle(&clipper, turned[round % 3], triangle));
    uint32_t a[CLIPPING_LANES], b[CLIPPING_LANES];
    int n = lanes_on_edge(CLIPPING_FIRST_FREE, middle, a);
    int m = lanes_on_edge(middle, clipper.next, b);
    expect_subset(m, b, n, a);
    if (!degenerate) {
        TEST_ASSERT_EQUAL_INT(n, m);
        expect_subset(n, a, m, b);
    }
    return m;
}

static void test_triangles_that_share_an_edge_get_identical_vertices_on_it(void)
{
    int shared = 0, twice = 0;
    for (int round = 0; round < 60000; round++) {
        for (uint32_t lane = 0; lane < 4; lane++)
            clipping_put_random(lane, round & 1 ? CLIPPING_WIDE : CLIPPING_MODERATE);
        int n = compare_shared_edge(round, false);
        shared += n > 0;
        twice += n > 1;
    }
    TEST_ASSERT_GREATER_THAN_INT(5000, shared);
    TEST_ASSERT_GREATER_THAN_INT(500, twice);
}

/* The edge is one unit in the last place from a plane. Rounding puts new vertices on both sides of the plane,
 * and only one of the triangles has a vertex outside. */
static void test_shared_edges_along_a_plane_get_identical_vertices(void)
{
    int shared = 0;
    for (int round = 0; round < 20000; round++) {
        put_inside_top_guard(0);
        put_inside_top_guard(1);
        clipping_put(2, clipping_uniform(-3, 3), 200, 0.5f, 1);
        clipping_put(3, clipping_uniform(-3, 3), clipping_uniform(-3, 3), 0.5f, 1);
        shared += compare_shared_edge(round, true) > 0;
    }
    TEST_ASSERT_GREATER_THAN_INT(5000, shared);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_triangle_inside_comes_back_as_it_is);
    RUN_TEST(test_the_near_plane_cuts_where_it_should);
    RUN_TEST(test_area_and_varyings_are_those_of_a_double_precision_reference);
    RUN_TEST(test_user_planes_cut_like_the_reference);
    RUN_TEST(test_ignored_planes_do_not_cut);
    RUN_TEST(test_vertices_are_inside_of_all_planes);
    RUN_TEST(test_vertices_are_finite_and_inside_for_extreme_coordinates);
    RUN_TEST(test_vertices_on_the_far_plane_have_z_equal_to_w);
    RUN_TEST(test_triangles_that_share_an_edge_get_identical_vertices_on_it);
    RUN_TEST(test_shared_edges_along_a_plane_get_identical_vertices);
    return UNITY_END();
}
