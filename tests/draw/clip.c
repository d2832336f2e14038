/* The clipper against a reference that clips in double precision and knows nothing of lanes, codes or the
 * order of vertices, and against the properties that the pipeline relies on: new vertices inside of the
 * planes, identical on shared edges, values of the provoking vertex in flat slots, originals untouched, room
 * for what it promises. */
#include "base/mxcsr.h"
#include "draw/clip.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include <unity.h>

enum {
    SEED = 20240118,
    LANES = VERTEX_CAPACITY,
    FIRST_FREE = 16,
    FIRST_USER = CLIP_PLANES - CLIP_PLANES_USER
};

static _Alignas(64) float batch[SLOT_COUNT * LANES];
static struct job job;
static int user_planes;
static uint64_t state;
static unsigned saved;

void setUp(void)
{
    state = SEED;
    saved = mxcsr_enter();
    memset(batch, 0xff, sizeof batch); /* no lane is what it should be by chance */
    job.guard_x = 16.0f;
    job.guard_y = 12.5f;
    memset(job.clip_plane, 0, sizeof job.clip_plane);
    user_planes = 0;
}

void tearDown(void)
{
    mxcsr_leave(saved);
}

static uint32_t draw(void) /* xorshift64* */
{
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return (uint32_t)(state * 0x2545F4914F6CDD1DULL >> 32);
}

static float uniform(float low, float high)
{
    return low + (high - low) * (float)(draw() >> 8) * 0x1p-24f;
}

/* --- Vertices
 * -------------------------------------------------------------------------------------------------- */

static float *word(int slot, uint32_t lane)
{
    return &batch[slot * LANES + (int)lane];
}

static uint32_t code_at(uint32_t lane)
{
    uint32_t code;
    memcpy(&code, word(SLOT_CODE, lane), sizeof code);
    return code;
}

/* As spec/clip.h has it: every test asks for inside, in float. */
static uint32_t code_of(float x, float y, float z, float w)
{
    float gx = job.guard_x * w, gy = job.guard_y * w;
    uint32_t code = 0;
    code |= -w <= x ? 0 : CLIP_LEFT;
    code |= x <= w ? 0 : CLIP_RIGHT;
    code |= -w <= y ? 0 : CLIP_BOTTOM;
    code |= y <= w ? 0 : CLIP_TOP;
    code |= 0 <= z ? 0 : CLIP_NEAR;
    code |= z <= w ? 0 : CLIP_FAR;
    code |= CLIP_EYE_W <= w ? 0 : CLIP_EYE;
    code |= -gx <= x ? 0 : CLIP_GUARD_LEFT;
    code |= x <= gx ? 0 : CLIP_GUARD_RIGHT;
    code |= -gy <= y ? 0 : CLIP_GUARD_BOTTOM;
    code |= y <= gy ? 0 : CLIP_GUARD_TOP;
    for (int i = 0; i < user_planes; i++) {
        const float *p = job.clip_plane[i];
        code |= fmaf(x, p[0], fmaf(y, p[1], fmaf(z, p[2], w * p[3]))) >= 0 ? 0 : CLIP_USER << i;
    }
    return code;
}

static uint32_t position_code(uint32_t lane)
{
    return code_of(*word(SLOT_X, lane), *word(SLOT_Y, lane), *word(SLOT_Z, lane), *word(SLOT_W, lane));
}

static void put(uint32_t lane, float x, float y, float z, float w)
{
    *word(SLOT_X, lane) = x;
    *word(SLOT_Y, lane) = y;
    *word(SLOT_Z, lane) = z;
    *word(SLOT_W, lane) = w;
    uint32_t code = position_code(lane);
    memcpy(word(SLOT_CODE, lane), &code, sizeof code);
    for (int s = SLOT_CODE + 1; s < SLOT_COUNT; s++)
        *word(s, lane) = uniform(-2, 2);
}

static float signed_power(int low, int high)
{
    return ldexpf(uniform(-1, 1), low + (int)(draw() % (uint32_t)(high - low + 1)));
}

static void put_inside_top_guard(uint32_t lane)
{
    float w = uniform(0.1f, 5);
    put(lane, uniform(-3, 3), nextafterf(job.guard_y * w, 0), uniform(-1, 1), w);
}

enum spread { MODERATE, WIDE, EXTREME, DEEP, ON_PLANES, SPREADS };

static void put_random(uint32_t lane, enum spread spread)
{
    static const float on[] = {0, 1, -1, 2, 16, -16, 12.5f, -12.5f, CLIP_EYE_W, 0.5f};
    switch (spread) {
    case MODERATE: put(lane, uniform(-3, 3), uniform(-3, 3), uniform(-1, 3), uniform(-1, 3)); break;
    case WIDE: put(lane, uniform(-90, 90), uniform(-90, 90), uniform(-2, 6), uniform(-1, 5)); break;
    case EXTREME:
        put(lane, signed_power(-60, 120), signed_power(-60, 120), signed_power(-60, 120),
            signed_power(-60, 120));
        break;
    case DEEP: put(lane, uniform(-1, 1), uniform(-1, 1), signed_power(-30, 60), uniform(-1, 5)); break;
    default: put(lane, on[draw() % 10], on[draw() % 10], on[draw() % 10], on[draw() % 10]); break;
    }
}

static const uint8_t all_smooth[VARYING_COUNT] = {[0 ... VARYING_COUNT - 1] = INTERPOLATION_SMOOTH};
static const uint8_t flat_diffuse[VARYING_COUNT] = {INTERPOLATION_FLAT,
                                                    [1 ... VARYING_COUNT - 1] = INTERPOLATION_SMOOTH};

static struct clipper smooth_clipper(void)
{
    struct clipper clipper = clipper_create(&job, all_smooth, batch, FIRST_FREE);
    clipper.smooth |= 1ull << SLOT_POINT_SIZE;
    return clipper;
}

/* --- Reference
 * ------------------------------------------------------------------------------------------------- */

enum { REFERENCE_MAXIMUM = 16 };

struct reference {
    double point[REFERENCE_MAXIMUM][SLOT_COUNT];
    int count;
};

static double reference_distance(int plane, const double p[SLOT_COUNT])
{
    double w = p[SLOT_W], gx = job.guard_x * w, gy = job.guard_y * w;
    const double d[] = {w - CLIP_EYE_W, p[SLOT_Z],      w - p[SLOT_Z], gx + p[SLOT_X],
                        gx - p[SLOT_X], gy + p[SLOT_Y], gy - p[SLOT_Y]};
    if (plane < FIRST_USER)
        return d[plane];
    const float *u = job.clip_plane[plane - FIRST_USER];
    return (double)u[0] * p[SLOT_X] + (double)u[1] * p[SLOT_Y] + (double)u[2] * p[SLOT_Z] + (double)u[3] * w;
}

/* All planes, whatever the codes say, last plane first. */
static struct reference reference_clip(const uint32_t lane[3])
{
    struct reference r = {.count = 3};
    for (int i = 0; i < 3; i++)
        for (int s = 0; s < SLOT_COUNT; s++)
            r.point[i][s] = s == SLOT_CODE ? 0 : *word(s, lane[i]);
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

/* Twice the area of a polygon's projection into the plane of two slots, as a fan; with it go its moments
 * against a third slot: equal moments of all varyings mean that the same function is interpolated over the
 * same area. */
struct moments {
    double area[3]; /* in x y, y z and z w: a polygon edge-on to one is not to all */
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
                point[i][s] = s == SLOT_CODE ? 0 : *word(s, triangle[t][i]);
        add_triangle(&m, point[0], point[1], point[2]);
    }
    return m;
}

static void expect_close(const uint32_t lane[3], const struct moments *expected, const struct moments *actual)
{
    double size = 1, tolerance;
    for (int i = 0; i < 3; i++)
        for (int s = 0; s < SLOT_CODE; s++)
            size = fmax(size, fabs((double)*word(s, lane[i])));
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
            put_random(lane[i], round & 1 ? WIDE : MODERATE);
        struct clipper clipper = smooth_clipper();
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

static void set_user_planes(int count)
{
    user_planes = count;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 4; c++)
            job.clip_plane[i][c] = uniform(c < 3 ? -1 : 0, 1);
}

static void test_user_planes_cut_like_the_reference(void)
{
    int clipped = 0, largest = 0;
    for (int round = 0; round < 30000; round++) {
        static const uint32_t lane[3] = {3, 0, 7};
        set_user_planes(1 + round % CLIP_PLANES_USER);
        for (int i = 0; i < 3; i++)
            put_random(lane[i], round & 8 ? WIDE : MODERATE);
        struct clipper clipper = smooth_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        int count = clip_triangle(&clipper, lane, triangle);
        struct reference reference = reference_clip(lane);
        struct moments expected = reference_moments(&reference), actual = clipped_moments(count, triangle);
        expect_close(lane, &expected, &actual);
        clipped += (codes_of(lane) & CLIP_USER_ALL) && count > 0;
        largest = count > largest ? count : largest;
        memset(job.clip_plane, 0, sizeof job.clip_plane);
    }
    TEST_ASSERT_GREATER_THAN_INT(3000, clipped);
    TEST_ASSERT_GREATER_THAN_INT(5, largest);
}

static void test_ignored_planes_do_not_cut(void)
{
    static const uint32_t lane[3] = {3, 0, 7};
    put(3, 0, 0, -0.5f, 1);
    put(0, 1, 0, 0.5f, 1);
    put(7, 0, 1, 1.5f, 1);
    struct clipper clipper = smooth_clipper();
    uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
    clipper.ignored = CLIP_DEPTH;
    TEST_ASSERT_EQUAL_INT(1, clip_triangle(&clipper, lane, triangle));
    TEST_ASSERT_EQUAL_UINT32(FIRST_FREE, clipper.next);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(lane, triangle[0], 3);
}

/* Red, green and blue hold how much of each corner a vertex is: on an edge of the triangle one of them is
 * exactly zero. */
static bool on_edge(uint32_t a, uint32_t b)
{
    for (int c = 0; c < 3; c++)
        if (*word(SLOT_diffuse + c, a) == 0 && *word(SLOT_diffuse + c, b) == 0)
            return true;
    return false;
}

static void test_polygons_know_their_corners_and_edges(void)
{
    int cut = 0;
    for (int round = 0; round < 20000; round++) {
        static const uint32_t lane[3] = {3, 0, 7};
        set_user_planes(round % 3);
        for (int i = 0; i < 3; i++) {
            put_random(lane[i], round & 8 ? WIDE : MODERATE);
            for (int c = 0; c < 3; c++)
                *word(SLOT_diffuse + c, lane[i]) = c == i;
        }
        struct clipper clipper = smooth_clipper();
        struct clipped clipped;
        TEST_ASSERT_EQUAL_INT(0, clip_polygon(&clipper, lane, &clipped));
        for (int i = 0; i < clipped.count; i++) {
            uint32_t a = clipped.lane[i], b = clipped.lane[(i + 1) % clipped.count];
            TEST_ASSERT_EQUAL_INT(a < FIRST_FREE, clipped.corners >> i & 1);
            bool edge = clipped.edges >> i & 1;
            TEST_ASSERT_TRUE(!edge || on_edge(a, b));
            cut += !edge;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(2000, cut);
}

/* --- Lines
 * ------------------------------------------------------------------------------------------------------- */

/* From which t to which t of the way from lane 0 to lane 1 all planes have it inside. */
static bool line_interval(const uint32_t lane[2], double interval[2])
{
    interval[0] = 0;
    interval[1] = 1;
    for (int plane = 0; plane < CLIP_PLANES; plane++) {
        double end[2][SLOT_COUNT] = {{0}}, d[2];
        for (int i = 0; i < 2; i++) {
            for (int s = 0; s < SLOT_CODE; s++)
                end[i][s] = *word(s, lane[i]);
            d[i] = reference_distance(plane, end[i]);
        }
        if (d[0] < 0 && d[1] < 0)
            return false;
        if (d[0] < 0)
            interval[0] = fmax(interval[0], d[0] / (d[0] - d[1]));
        if (d[1] < 0)
            interval[1] = fmin(interval[1], d[0] / (d[0] - d[1]));
    }
    return interval[0] < interval[1];
}

static void expect_at(const uint32_t lane[2], double t, uint32_t got)
{
    double size = 1;
    for (int s = 0; s < SLOT_CODE; s++)
        size = fmax(size, fmax(fabs((double)*word(s, lane[0])), fabs((double)*word(s, lane[1]))));
    for (int s = 0; s < SLOT_COUNT; s++)
        if (s != SLOT_CODE) {
            double a = *word(s, lane[0]), b = *word(s, lane[1]);
            TEST_ASSERT_DOUBLE_WITHIN(size * 4e-6, a + t * (b - a), *word(s, got));
        }
}

static void test_lines_keep_what_is_inside_of_all_planes(void)
{
    int kept = 0, dropped = 0;
    for (int round = 0; round < 40000; round++) {
        static const uint32_t lane[2] = {5, 2};
        uint32_t left[2];
        double interval[2];
        set_user_planes(round % (CLIP_PLANES_USER + 1));
        put_random(lane[0], round & 8 ? WIDE : MODERATE);
        put_random(lane[1], round & 8 ? WIDE : MODERATE);
        struct clipper clipper = smooth_clipper();
        int count = clip_line(&clipper, lane, left);
        bool any = line_interval(lane, interval);
        if (any && interval[1] - interval[0] < 1e-5)
            continue; /* rounding may decide */
        TEST_ASSERT_EQUAL_INT(any, count);
        for (int i = 0; i < 2 && any; i++)
            expect_at(lane, interval[i], left[i]);
        kept += any && clipper.next > FIRST_FREE;
        dropped += !any;
        memset(job.clip_plane, 0, sizeof job.clip_plane);
    }
    TEST_ASSERT_GREATER_THAN_INT(5000, kept);
    TEST_ASSERT_GREATER_THAN_INT(5000, dropped);
}

static void test_lines_that_find_no_lanes_change_nothing(void)
{
    static const uint32_t lane[2] = {5, 2};
    static float before[SLOT_COUNT * LANES];
    uint32_t left[2];
    put(5, 0, 0, -1, 1);
    put(2, 0, 0, 3, 2);
    struct clipper clipper = smooth_clipper();
    clipper.next = LANES - 1;
    memcpy(before, batch, sizeof batch);
    TEST_ASSERT_EQUAL_INT(-1, clip_line(&clipper, lane, left));
    TEST_ASSERT_EQUAL_UINT32(LANES - 1, clipper.next);
    TEST_ASSERT_EQUAL_MEMORY(before, batch, sizeof batch);
    clipper.next = LANES - 2;
    TEST_ASSERT_EQUAL_INT(1, clip_line(&clipper, lane, left));
    TEST_ASSERT_EQUAL_FLOAT(0, *word(SLOT_Z, left[0]));
    TEST_ASSERT_EQUAL_FLOAT(*word(SLOT_W, left[1]), *word(SLOT_Z, left[1]));
}

static void test_cut_lines_have_the_flat_values_of_their_first_vertex(void)
{
    static const uint32_t lane[2] = {5, 2};
    uint32_t left[2];
    put(5, 0, 0, -1, 1);
    put(2, 0, 0, 1, 2);
    struct clipper clipper = clipper_create(&job, flat_diffuse, batch, FIRST_FREE);
    TEST_ASSERT_EQUAL_INT(1, clip_line(&clipper, lane, left));
    TEST_ASSERT_EQUAL_UINT32(FIRST_FREE, left[0]);
    TEST_ASSERT_EQUAL_UINT32(2, left[1]);
    for (int c = 0; c < 4; c++)
        TEST_ASSERT_EQUAL_FLOAT(*word(SLOT_diffuse + c, 5), *word(SLOT_diffuse + c, left[0]));
}

/* --- Properties of the vertices
 * -------------------------------------------------------------------------------- */

/* Of the guard planes, which are products, the limit may be missed by the rounding of the product. */
static void expect_inside(uint32_t lane)
{
    float x = *word(SLOT_X, lane), y = *word(SLOT_Y, lane), z = *word(SLOT_Z, lane), w = *word(SLOT_W, lane);
    TEST_ASSERT_TRUE(isfinite(x) && isfinite(y) && isfinite(z) && isfinite(w));
    TEST_ASSERT_TRUE(w >= CLIP_EYE_W);
    TEST_ASSERT_TRUE(z >= 0 && z <= w);
    double slack = 1 + 4 * 0x1p-24;
    TEST_ASSERT_TRUE(fabs((double)x) <= (double)job.guard_x * w * slack);
    TEST_ASSERT_TRUE(fabs((double)y) <= (double)job.guard_y * w * slack);
    TEST_ASSERT_EQUAL_HEX32(0, code_at(lane) & CLIP_NEEDED);
}

static void expect_vertices_inside(enum spread spread, int rounds)
{
    int kept = 0;
    for (int round = 0; round < rounds; round++) {
        static const uint32_t lane[3] = {1, 2, 5};
        for (int i = 0; i < 3; i++)
            put_random(lane[i], spread);
        struct clipper clipper = smooth_clipper();
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
    expect_vertices_inside(MODERATE, 20000);
    expect_vertices_inside(WIDE, 20000);
    expect_vertices_inside(ON_PLANES, 20000);
}

static void test_vertices_are_finite_and_inside_for_extreme_coordinates(void)
{
    expect_vertices_inside(EXTREME, 100000);
    expect_vertices_inside(DEEP, 50000);
    for (int round = 0; round < 20000; round++) { /* the largest floats there are */
        static const uint32_t lane[3] = {1, 2, 5};
        static const float coordinate[] = {FLT_MAX, -FLT_MAX, FLT_MAX / 16, FLT_MIN, 1, 0, CLIP_EYE_W};
        for (int i = 0; i < 3; i++)
            put(lane[i], coordinate[draw() % 7], coordinate[draw() % 7], coordinate[draw() % 7],
                coordinate[draw() % 7]);
        struct clipper clipper = smooth_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        int count = clip_triangle(&clipper, lane, triangle);
        for (int t = 0; t < count; t++)
            for (int i = 0; i < 3; i++)
                expect_inside(triangle[t][i]);
    }
}

/* A fourteenth of the way from w to w + 7 units is a tie between two floats, and a fourteenth is not a
 * double: the errors of z and w decide to which side each of them goes. */
static void test_vertices_on_the_far_plane_have_z_equal_to_w(void)
{
    for (int round = 1; round <= 4000; round++) {
        static const uint32_t lane[3] = {0, 1, 2};
        float w = 1.5f + (float)round * 0x1p-14f, far_w = w + 7 * 0x1p-23f, depth = (float)round * 0x1p-20f;
        put(0, 0, 0, w - depth, w);
        put(1, 0, 1, far_w + 13 * depth, far_w);
        put(2, 1, 0, 0.5f, 1);
        struct clipper clipper = smooth_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        TEST_ASSERT_EQUAL_INT(2, clip_triangle(&clipper, lane, triangle));
        for (uint32_t made = FIRST_FREE; made < FIRST_FREE + 2; made++)
            TEST_ASSERT_EQUAL_MEMORY(word(SLOT_W, made), word(SLOT_Z, made), sizeof(float));
    }
}

static void test_a_triangle_inside_comes_back_as_it_is(void)
{
    static const uint32_t lane[3] = {9, 4, 6};
    put(9, 0, 0, 0.5f, 1);
    put(4, 1.5f, 0, 0, 1); /* right of the frustum: not the clipper's business */
    put(6, 0, 1, 1, 1);
    struct clipper clipper = smooth_clipper();
    uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
    TEST_ASSERT_EQUAL_INT(1, clip_triangle(&clipper, lane, triangle));
    TEST_ASSERT_EQUAL_UINT32_ARRAY(lane, triangle[0], 3);
    TEST_ASSERT_EQUAL_UINT32(FIRST_FREE, clipper.next);
}

static void test_the_near_plane_cuts_where_it_should(void)
{
    static const uint32_t lane[3] = {0, 1, 2};
    put(0, -0.5f, 0, -0.25f, 1); /* outside: a quarter of the way to the others */
    put(1, 0.5f, 0, 0.75f, 1);
    put(2, -0.5f, 0.5f, 0.75f, 1);
    *word(SLOT_texcoord0, 0) = 8;
    *word(SLOT_texcoord0, 1) = 16;
    struct clipper clipper = smooth_clipper();
    uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
    TEST_ASSERT_EQUAL_INT(2, clip_triangle(&clipper, lane, triangle));
    TEST_ASSERT_EQUAL_UINT32(FIRST_FREE + 2, clipper.next);
    const uint32_t expected[2][3] = {{FIRST_FREE, 1, 2}, {FIRST_FREE, 2, FIRST_FREE + 1}};
    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected[0], triangle[0], 3);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected[1], triangle[1], 3);
    TEST_ASSERT_EQUAL_FLOAT(-0.25f, *word(SLOT_X, FIRST_FREE));
    TEST_ASSERT_EQUAL_FLOAT(0, *word(SLOT_Z, FIRST_FREE));
    TEST_ASSERT_EQUAL_FLOAT(10, *word(SLOT_texcoord0, FIRST_FREE));
    TEST_ASSERT_EQUAL_FLOAT(0.125f, *word(SLOT_Y, FIRST_FREE + 1));
}

/* --- Shared edges
 * ---------------------------------------------------------------------------------------------- */

static bool same_vertex(uint32_t a, uint32_t b)
{
    for (int s = 0; s < SLOT_COUNT; s++)
        if (s != SLOT_CODE && memcmp(word(s, a), word(s, b), sizeof(float)) != 0)
            return false;
    return true;
}

/* New vertices of the shared edge are told by a varying that is 0 at both its ends and 1 elsewhere. */
enum { MARK = SLOT_texcoord0 };

/* The new lanes from `first` to `last` that lie on the edge; returns how many. */
static int lanes_on_edge(uint32_t first, uint32_t last, uint32_t found[LANES])
{
    int count = 0;
    for (uint32_t lane = first; lane < last; lane++)
        if (*word(MARK, lane) == 0)
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

/* Two triangles with the edge 0-1, which the second walks the other way and from any vertex on. If all
 * of the first triangle is next to the edge, it may have more vertices that look as if they were on it. */
static int compare_shared_edge(int round, bool degenerate)
{
    for (uint32_t lane = 0; lane < 4; lane++)
        *word(MARK, lane) = lane >= 2;
    const uint32_t turned[3][3] = {{1, 0, 3}, {0, 3, 1}, {3, 1, 0}};
    const uint32_t first[3] = {0, 1, 2};
    struct clipper clipper = smooth_clipper();
    uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, clip_triangle(&clipper, first, triangle));
    uint32_t middle = clipper.next;
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, clip_triangle(&clipper, turned[round % 3], triangle));
    uint32_t a[LANES], b[LANES];
    int n = lanes_on_edge(FIRST_FREE, middle, a);
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
            put_random(lane, round & 1 ? WIDE : MODERATE);
        int n = compare_shared_edge(round, false);
        shared += n > 0;
        twice += n > 1;
    }
    TEST_ASSERT_GREATER_THAN_INT(5000, shared);
    TEST_ASSERT_GREATER_THAN_INT(500, twice);
}

/* The edge is one unit in the last place from a plane: rounding puts new vertices on either side of it, and
 * only one of the triangles has a vertex that is outside. */
static void test_shared_edges_along_a_plane_get_identical_vertices(void)
{
    int shared = 0;
    for (int round = 0; round < 20000; round++) {
        put_inside_top_guard(0);
        put_inside_top_guard(1);
        put(2, uniform(-3, 3), 200, 0.5f, 1);
        put(3, uniform(-3, 3), uniform(-3, 3), 0.5f, 1);
        shared += compare_shared_edge(round, true) > 0;
    }
    TEST_ASSERT_GREATER_THAN_INT(5000, shared);
}

/* --- Flat values, lanes
 * ---------------------------------------------------------------------------------------- */

static void test_the_fan_begins_with_the_flat_values_of_vertex_0(void)
{
    int replaced = 0;
    for (int round = 0; round < 30000; round++) {
        static const uint32_t lane[3] = {2, 0, 1};
        for (uint32_t i = 0; i < 3; i++)
            put_random(i, round & 1 ? WIDE : MODERATE);
        struct clipper clipper = clipper_create(&job, flat_diffuse, batch, FIRST_FREE);
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        int count = clip_triangle(&clipper, lane, triangle);
        for (int t = 0; t < count; t++) {
            for (int s = SLOT_diffuse; s <= SLOT_diffuse_last; s++)
                TEST_ASSERT_EQUAL_MEMORY(word(s, 2), word(s, triangle[t][0]), sizeof(float));
            replaced += triangle[t][0] != 2;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(1000, replaced);
}

/* Other slots, lanes before `next`, and lanes after the new `next` keep their bytes. */
static void test_only_new_lanes_and_used_slots_are_written(void)
{
    static const uint8_t texcoord[VARYING_COUNT] = {INTERPOLATION_NONE, INTERPOLATION_SMOOTH};
    static float before[SLOT_COUNT * LANES];
    for (int round = 0; round < 2000; round++) {
        static const uint32_t lane[3] = {7, 3, 5};
        for (uint32_t i = 0; i < LANES; i++)
            put_random(i, WIDE);
        memcpy(before, batch, sizeof batch);
        struct clipper clipper = clipper_create(&job, texcoord, batch, FIRST_FREE);
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        TEST_ASSERT_GREATER_OR_EQUAL_INT(0, clip_triangle(&clipper, lane, triangle));
        for (int s = 0; s < SLOT_COUNT; s++) {
            bool used = s < SLOT_diffuse || s > SLOT_diffuse_last;
            uint32_t kept = used ? FIRST_FREE : LANES;
            TEST_ASSERT_EQUAL_MEMORY(&before[s * LANES], word(s, 0), kept * sizeof(float));
            if (clipper.next < LANES)
                TEST_ASSERT_EQUAL_MEMORY(&before[s * LANES + (int)clipper.next], word(s, clipper.next),
                                         (LANES - clipper.next) * sizeof(float));
        }
    }
}

static void test_running_out_of_lanes_changes_nothing_and_can_be_retried(void)
{
    static float before[SLOT_COUNT * LANES];
    int refused = 0;
    for (int round = 0; round < 4000; round++) {
        static const uint32_t lane[3] = {0, 1, 2};
        for (uint32_t i = 0; i < 3; i++)
            put_random(i, WIDE);
        struct clipper roomy = smooth_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3], retried[CLIP_TRIANGLES_MAXIMUM][3];
        roomy.next = LANES - CLIP_VERTICES_MAXIMUM;
        int count = clip_triangle(&roomy, lane, triangle);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(0, count);
        uint32_t needed = roomy.next - (LANES - CLIP_VERTICES_MAXIMUM);
        memcpy(before, batch, sizeof batch);
        struct clipper tight = smooth_clipper();
        tight.next = LANES - needed;
        TEST_ASSERT_EQUAL_INT(count, clip_triangle(&tight, lane, retried)); /* just enough */
        TEST_ASSERT_EQUAL_UINT32(LANES, tight.next);
        if (needed == 0)
            continue;
        memcpy(batch, before, sizeof batch);
        tight.next = LANES - needed + 1;
        TEST_ASSERT_EQUAL_INT(-1, clip_triangle(&tight, lane, retried));
        TEST_ASSERT_EQUAL_UINT32(LANES - needed + 1, tight.next);
        TEST_ASSERT_EQUAL_MEMORY(before, batch, sizeof batch);
        refused++;
    }
    TEST_ASSERT_GREATER_THAN_INT(1000, refused);
}

/* Codes are taken at their word: whatever they are, the polygon stays within its maximum and the originals.
 */
static void test_contradictory_codes_stay_within_the_maximum(void)
{
    for (int round = 0; round < 100000; round++) {
        static const uint32_t lane[3] = {0, 1, 2};
        for (uint32_t i = 0; i < 3; i++) {
            put_random(i, round % SPREADS);
            uint32_t code = draw() & draw() & CLIP_NEEDED;
            memcpy(word(SLOT_CODE, i), &code, sizeof code);
        }
        struct clipper clipper = smooth_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        int count = clip_triangle(&clipper, lane, triangle);
        TEST_ASSERT_TRUE(count >= 0 && count <= CLIP_TRIANGLES_MAXIMUM);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(FIRST_FREE + CLIP_VERTICES_MAXIMUM, clipper.next);
        for (uint32_t made = FIRST_FREE; made < clipper.next; made++)
            for (int s = 0; s < SLOT_CODE; s++)
                TEST_ASSERT_TRUE(isfinite(*word(s, made)));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_triangle_inside_comes_back_as_it_is);
    RUN_TEST(test_the_near_plane_cuts_where_it_should);
    RUN_TEST(test_area_and_varyings_are_those_of_a_double_precision_reference);
    RUN_TEST(test_user_planes_cut_like_the_reference);
    RUN_TEST(test_ignored_planes_do_not_cut);
    RUN_TEST(test_polygons_know_their_corners_and_edges);
    RUN_TEST(test_lines_keep_what_is_inside_of_all_planes);
    RUN_TEST(test_lines_that_find_no_lanes_change_nothing);
    RUN_TEST(test_cut_lines_have_the_flat_values_of_their_first_vertex);
    RUN_TEST(test_vertices_are_inside_of_all_planes);
    RUN_TEST(test_vertices_are_finite_and_inside_for_extreme_coordinates);
    RUN_TEST(test_vertices_on_the_far_plane_have_z_equal_to_w);
    RUN_TEST(test_triangles_that_share_an_edge_get_identical_vertices_on_it);
    RUN_TEST(test_shared_edges_along_a_plane_get_identical_vertices);
    RUN_TEST(test_the_fan_begins_with_the_flat_values_of_vertex_0);
    RUN_TEST(test_only_new_lanes_and_used_slots_are_written);
    RUN_TEST(test_running_out_of_lanes_changes_nothing_and_can_be_retried);
    RUN_TEST(test_contradictory_codes_stay_within_the_maximum);
    return UNITY_END();
}
