/* The clipper on lines, edges of polygons and flat values, and its use of lanes. The part inside of all
 * planes stays, flat slots have the values of the provoking vertex, the original vertices do not change, and
 * the number of lanes suffices. */
#include "render/geometry/clip.h"
#include "tests/support/geometry/clipping.h"

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

static const uint8_t flat_diffuse[VARYING_COUNT] = {INTERPOLATION_FLAT,
                                                    [1 ... VARYING_COUNT - 1] = INTERPOLATION_SMOOTH};

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

/* Returns true if two vertices are on the same edge of the triangle. Red, green and blue are the barycentric
 * coordinates of a vertex, and on an edge one of them is exactly zero. */
static bool on_edge(uint32_t a, uint32_t b)
{
    for (int c = 0; c < 3; c++)
        if (*clipping_word(SLOT_diffuse + c, a) == 0 && *clipping_word(SLOT_diffuse + c, b) == 0)
            return true;
    return false;
}

static void test_polygons_mark_their_corners_and_edges(void)
{
    int cut = 0;
    for (int round = 0; round < 20000; round++) {
        static const uint32_t lane[3] = {3, 0, 7};
        clipping_set_user_planes(round % 3);
        for (int i = 0; i < 3; i++) {
            clipping_put_random(lane[i], round & 8 ? CLIPPING_WIDE : CLIPPING_MODERATE);
            for (int c = 0; c < 3; c++)
                *clipping_word(SLOT_diffuse + c, lane[i]) = c == i;
        }
        struct clipper clipper = clipping_clipper();
        struct clipped clipped;
        TEST_ASSERT_EQUAL_INT(0, clip_polygon(&clipper, lane, &clipped));
        for (int i = 0; i < clipped.count; i++) {
            uint32_t a = clipped.lane[i], b = clipped.lane[(i + 1) % clipped.count];
            TEST_ASSERT_EQUAL_INT(a < CLIPPING_FIRST_FREE, clipped.corners >> i & 1);
            bool edge = clipped.edges >> i & 1;
            TEST_ASSERT_TRUE(!edge || on_edge(a, b));
            cut += !edge;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(2000, cut);
}

/* --- Lines --- */

/* Computes the interval of t in which the line, from lane 0 at t = 0 to lane 1 at t = 1, is inside of all
 * planes. Returns false if it is empty. */
static bool line_interval(const uint32_t lane[2], double interval[2])
{
    interval[0] = 0;
    interval[1] = 1;
    for (int plane = 0; plane < CLIP_PLANES; plane++) {
        double end[2][SLOT_COUNT] = {{0}}, d[2];
        for (int i = 0; i < 2; i++) {
            for (int s = 0; s < SLOT_CODE; s++)
                end[i][s] = *clipping_word(s, lane[i]);
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
        size = fmax(size,
                    fmax(fabs((double)*clipping_word(s, lane[0])), fabs((double)*clipping_word(s, lane[1]))));
    for (int s = 0; s < SLOT_COUNT; s++)
        if (s != SLOT_CODE) {
            double a = *clipping_word(s, lane[0]), b = *clipping_word(s, lane[1]);
            TEST_ASSERT_DOUBLE_WITHIN(size * 4e-6, a + t * (b - a), *clipping_word(s, got));
        }
}

static void test_lines_keep_the_part_inside_of_all_planes(void)
{
    int kept = 0, dropped = 0;
    for (int round = 0; round < 40000; round++) {
        static const uint32_t lane[2] = {5, 2};
        uint32_t left[2];
        double interval[2];
        clipping_set_user_planes(round % (CLIP_PLANES_USER + 1));
        clipping_put_random(lane[0], round & 8 ? CLIPPING_WIDE : CLIPPING_MODERATE);
        clipping_put_random(lane[1], round & 8 ? CLIPPING_WIDE : CLIPPING_MODERATE);
        struct clipper clipper = clipping_clipper();
        int count = clip_line(&clipper, lane, left);
        bool any = line_interval(lane, interval);
        if (any && interval[1] - interval[0] < 1e-5)
            continue; /* rounding decides if the line is visible */
        TEST_ASSERT_EQUAL_INT(any, count);
        for (int i = 0; i < 2 && any; i++)
            expect_at(lane, interval[i], left[i]);
        kept += any && clipper.next > CLIPPING_FIRST_FREE;
        dropped += !any;
        memset(clipping_job.clip_plane, 0, sizeof clipping_job.clip_plane);
    }
    TEST_ASSERT_GREATER_THAN_INT(5000, kept);
    TEST_ASSERT_GREATER_THAN_INT(5000, dropped);
}

static void test_lines_that_find_no_lanes_change_nothing(void)
{
    static const uint32_t lane[2] = {5, 2};
    static float before[SLOT_COUNT * CLIPPING_LANES];
    uint32_t left[2];
    clipping_put(5, 0, 0, -1, 1);
    clipping_put(2, 0, 0, 3, 2);
    struct clipper clipper = clipping_clipper();
    clipper.next = CLIPPING_LANES - 1;
    memcpy(before, clipping_batch, sizeof clipping_batch);
    TEST_ASSERT_EQUAL_INT(-1, clip_line(&clipper, lane, left));
    TEST_ASSERT_EQUAL_UINT32(CLIPPING_LANES - 1, clipper.next);
    TEST_ASSERT_EQUAL_MEMORY(before, clipping_batch, sizeof clipping_batch);
    clipper.next = CLIPPING_LANES - 2;
    TEST_ASSERT_EQUAL_INT(1, clip_line(&clipper, lane, left));
    TEST_ASSERT_EQUAL_FLOAT(0, *clipping_word(SLOT_Z, left[0]));
    TEST_ASSERT_EQUAL_FLOAT(*clipping_word(SLOT_W, left[1]), *clipping_word(SLOT_Z, left[1]));
}

static void test_cut_lines_have_the_flat_values_of_their_first_vertex(void)
{
    static const uint32_t lane[2] = {5, 2};
    uint32_t left[2];
    clipping_put(5, 0, 0, -1, 1);
    clipping_put(2, 0, 0, 1, 2);
    struct clipper clipper = clipper_create(&clipping_job, flat_diffuse, clipping_batch, CLIPPING_FIRST_FREE);
    TEST_ASSERT_EQUAL_INT(1, clip_line(&clipper, lane, left));
    TEST_ASSERT_EQUAL_UINT32(CLIPPING_FIRST_FREE, left[0]);
    TEST_ASSERT_EQUAL_UINT32(2, left[1]);
    for (int c = 0; c < 4; c++)
        TEST_ASSERT_EQUAL_FLOAT(*clipping_word(SLOT_diffuse + c, 5),
                                *clipping_word(SLOT_diffuse + c, left[0]));
}

/* --- Flat values, lanes --- */

static void test_the_fan_begins_with_the_flat_values_of_vertex_0(void)
{
    int replaced = 0;
    for (int round = 0; round < 30000; round++) {
        static const uint32_t lane[3] = {2, 0, 1};
        for (uint32_t i = 0; i < 3; i++)
            clipping_put_random(i, round & 1 ? CLIPPING_WIDE : CLIPPING_MODERATE);
        struct clipper clipper =
            clipper_create(&clipping_job, flat_diffuse, clipping_batch, CLIPPING_FIRST_FREE);
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        int count = clip_triangle(&clipper, lane, triangle);
        for (int t = 0; t < count; t++) {
            for (int s = SLOT_diffuse; s <= SLOT_diffuse_last; s++)
                TEST_ASSERT_EQUAL_MEMORY(clipping_word(s, 2), clipping_word(s, triangle[t][0]),
                                         sizeof(float));
            replaced += triangle[t][0] != 2;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(1000, replaced);
}

/* Other slots, lanes before `next`, and lanes after the new `next` keep their bytes. */
static void test_only_new_lanes_and_used_slots_are_written(void)
{
    static const uint8_t texcoord[VARYING_COUNT] = {INTERPOLATION_NONE, INTERPOLATION_SMOOTH};
    static float before[SLOT_COUNT * CLIPPING_LANES];
    for (int round = 0; round < 2000; round++) {
        static const uint32_t lane[3] = {7, 3, 5};
        for (uint32_t i = 0; i < CLIPPING_LANES; i++)
            clipping_put_random(i, CLIPPING_WIDE);
        memcpy(before, clipping_batch, sizeof clipping_batch);
        struct clipper clipper = clipper_create(&clipping_job, texcoord, clipping_batch, CLIPPING_FIRST_FREE);
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        TEST_ASSERT_GREATER_OR_EQUAL_INT(0, clip_triangle(&clipper, lane, triangle));
        for (int s = 0; s < SLOT_COUNT; s++) {
            bool used = s < SLOT_diffuse || s > SLOT_diffuse_last;
            uint32_t kept = used ? CLIPPING_FIRST_FREE : CLIPPING_LANES;
            TEST_ASSERT_EQUAL_MEMORY(&before[s * CLIPPING_LANES], clipping_word(s, 0), kept * sizeof(float));
            if (clipper.next < CLIPPING_LANES)
                TEST_ASSERT_EQUAL_MEMORY(&before[s * CLIPPING_LANES + (int)clipper.next],
                                         clipping_word(s, clipper.next),
                                         (CLIPPING_LANES - clipper.next) * sizeof(float));
        }
    }
}

static void test_running_out_of_lanes_changes_nothing_and_can_be_retried(void)
{
    static float before[SLOT_COUNT * CLIPPING_LANES];
    int refused = 0;
    for (int round = 0; round < 4000; round++) {
        static const uint32_t lane[3] = {0, 1, 2};
        for (uint32_t i = 0; i < 3; i++)
            clipping_put_random(i, CLIPPING_WIDE);
        struct clipper roomy = clipping_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3], retried[CLIP_TRIANGLES_MAXIMUM][3];
        roomy.next = CLIPPING_LANES - CLIP_VERTICES_MAXIMUM;
        int count = clip_triangle(&roomy, lane, triangle);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(0, count);
        uint32_t needed = roomy.next - (CLIPPING_LANES - CLIP_VERTICES_MAXIMUM);
        memcpy(before, clipping_batch, sizeof clipping_batch);
        struct clipper tight = clipping_clipper();
        tight.next = CLIPPING_LANES - needed;
        TEST_ASSERT_EQUAL_INT(count, clip_triangle(&tight, lane, retried)); /* just enough */
        TEST_ASSERT_EQUAL_UINT32(CLIPPING_LANES, tight.next);
        if (needed == 0)
            continue;
        memcpy(clipping_batch, before, sizeof clipping_batch);
        tight.next = CLIPPING_LANES - needed + 1;
        TEST_ASSERT_EQUAL_INT(-1, clip_triangle(&tight, lane, retried));
        TEST_ASSERT_EQUAL_UINT32(CLIPPING_LANES - needed + 1, tight.next);
        TEST_ASSERT_EQUAL_MEMORY(before, clipping_batch, sizeof clipping_batch);
        refused++;
    }
    TEST_ASSERT_GREATER_THAN_INT(1000, refused);
}

/* The clipper does not check codes. With any codes, the polygon has at most its maximum of vertices, inside
 * of the original triangle. */
static void test_contradictory_codes_stay_within_the_maximum(void)
{
    for (int round = 0; round < 100000; round++) {
        static const uint32_t lane[3] = {0, 1, 2};
        for (uint32_t i = 0; i < 3; i++) {
            clipping_put_random(i, round % CLIPPING_SPREADS);
            uint32_t code = clipping_draw() & clipping_draw() & CLIP_NEEDED;
            memcpy(clipping_word(SLOT_CODE, i), &code, sizeof code);
        }
        struct clipper clipper = clipping_clipper();
        uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3];
        int count = clip_triangle(&clipper, lane, triangle);
        TEST_ASSERT_TRUE(count >= 0 && count <= CLIP_TRIANGLES_MAXIMUM);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(CLIPPING_FIRST_FREE + CLIP_VERTICES_MAXIMUM, clipper.next);
        for (uint32_t made = CLIPPING_FIRST_FREE; made < clipper.next; made++)
            for (int s = 0; s < SLOT_CODE; s++)
                TEST_ASSERT_TRUE(isfinite(*clipping_word(s, made)));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_polygons_mark_their_corners_and_edges);
    RUN_TEST(test_lines_keep_the_part_inside_of_all_planes);
    RUN_TEST(test_lines_that_find_no_lanes_change_nothing);
    RUN_TEST(test_cut_lines_have_the_flat_values_of_their_first_vertex);
    RUN_TEST(test_the_fan_begins_with_the_flat_values_of_vertex_0);
    RUN_TEST(test_only_new_lanes_and_used_slots_are_written);
    RUN_TEST(test_running_out_of_lanes_changes_nothing_and_can_be_retried);
    RUN_TEST(test_contradictory_codes_stay_within_the_maximum);
    return UNITY_END();
}
