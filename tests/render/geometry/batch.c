/* Batching: the groups of vertices and primitives that routines get, the primitives that clip codes drop, and
 * the bins. */
#include "tests/render/geometry/logged.h"

void setUp(void)
{
    begin_log();
}

void tearDown(void)
{
    end_log();
}

static void an_engine_that_observes_gets_each_primitive_by_itself(void)
{
    draw.primitive = TRIPTYCH_TRIANGLE_STRIP;
    TEST_ASSERT_EQUAL_UINT32(4, run(3, 4));
    TEST_ASSERT_EQUAL_UINT32(3, first_primitive);
    TEST_ASSERT_EQUAL_UINT32(1, vertex_calls);
    engine.observes = true;
    TEST_ASSERT_EQUAL_UINT32(4, run(3, 4));
    TEST_ASSERT_EQUAL_UINT32(6, first_primitive);
    TEST_ASSERT_EQUAL_UINT32(5, vertex_calls);
}

/* There are more parts than fit in a group for setup. Each part occurs once. */
static void many_parts_are_cut_into_groups(void)
{
    draw_as(TRIPTYCH_TRIANGLE_LIST, PRIMITIVE_EDGE, SHAPE_LINE);
    TEST_ASSERT_EQUAL_UINT32(1000, run(0, 1000));
    TEST_ASSERT_EQUAL_UINT64(3000, batch->counts.triangles_set_up);
    for (uint32_t i = 0; i < 1000; i++)
        for (uint32_t k = 0; k < 3; k++)
            expect_triangle(3 * i + k, 3 * i + k, 3 * i + (k + 1) % 3, 3 * i + (k + 2) % 3);
}

/* The side planes of the frustum drop no line or point. The depth planes and user planes do. Ignored bits
 * have no effect. */
static void clip_codes_drop_lines_and_points(void)
{
    uint32_t codes[14] = {CLIP_LEFT, CLIP_LEFT, CLIP_NEAR, CLIP_NEAR, CLIP_USER, CLIP_USER, CLIP_INVALID,
                          0,         CLIP_EYE,  CLIP_EYE,  CLIP_FAR,  CLIP_FAR,  0,         0};
    clip_codes = codes;
    draw_as(TRIPTYCH_LINE_LIST, PRIMITIVE_LINE, SHAPE_LINE);
    TEST_ASSERT_EQUAL_UINT32(7, run(0, 7));
    TEST_ASSERT_EQUAL_UINT64(2, batch->counts.triangles_set_up);
    expect_line(0, 0, 1, false);
    expect_line(1, 12, 13, false);
    draw_as(TRIPTYCH_POINT_LIST, PRIMITIVE_POINT, SHAPE_POINT);
    draw.point_clipped = CLIP_NEEDED | CLIP_INVALID;
    TEST_ASSERT_EQUAL_UINT32(14, run(0, 14));
    TEST_ASSERT_EQUAL_UINT64(5, batch->counts.triangles_set_up);
    TEST_ASSERT_EQUAL_UINT32(7, triangle_log[2][0]);
    draw.clip_ignored = CLIP_DEPTH | CLIP_USER_ALL;
    TEST_ASSERT_EQUAL_UINT32(14, run(0, 14));
    TEST_ASSERT_EQUAL_UINT64(11, batch->counts.triangles_set_up);
    draw.point_clipped |= CLIP_FRUSTUM; /* the convention pointclip center */
    TEST_ASSERT_EQUAL_UINT32(14, run(0, 14));
    TEST_ASSERT_EQUAL_UINT64(9, batch->counts.triangles_set_up);
    draw_as(TRIPTYCH_TRIANGLE_LIST, PRIMITIVE_TRIANGLE, SHAPE_TRIANGLE);
    codes[0] = codes[1] = codes[2] = CLIP_NEAR | CLIP_USER;
    TEST_ASSERT_EQUAL_UINT32(1, run(0, 1));
    TEST_ASSERT_EQUAL_UINT64(1, batch->counts.triangles_set_up);
}

/* A grid of 15 x 15 vertices fits in one batch. Each vertex is shaded once for each draw. */
static void shared_vertices_are_shaded_once_a_batch(void)
{
    static uint16_t index[14 * 14 * 6];
    uint16_t *to = index;
    for (uint16_t y = 0; y < 14; y++)
        for (uint16_t x = 0; x < 14; x++) {
            uint16_t a = (uint16_t)(15 * y + x), quad[6] = {a, a + 1, a + 15, a + 1, a + 16, a + 15};
            memcpy(to, quad, sizeof quad);
            to += 6;
        }
    draw.indices = index;
    draw.index_bits = 16;
    TEST_ASSERT_EQUAL_UINT32(392, run(0, 392));
    TEST_ASSERT_EQUAL_UINT32(1, vertex_calls);
    TEST_ASSERT_EQUAL_UINT64(225, batch->counts.vertices_shaded);
    TEST_ASSERT_EQUAL_UINT64(392, batch->counts.triangles_set_up);
    TEST_ASSERT_EQUAL_UINT32(240, vertices_padded);
    for (uint32_t i = 0; i < 392; i++)
        expect_triangle(i, index[3 * i], index[3 * i + 1], index[3 * i + 2]);
    run(0, 392);
    TEST_ASSERT_EQUAL_UINT64(225, batch->counts.vertices_shaded);
}

/* The lanes after the last vertex repeat this vertex. */
static void calls_are_padded_to_the_lanes_of_a_routine(void)
{
    draw.primitive = TRIPTYCH_TRIANGLE_LIST;
    for (uint32_t lanes = 1; lanes <= LANES_MAXIMUM; lanes *= 2) {
        vertices_padded = triangles_padded = 0;
        vertex_routine.lanes = setup_routine.lanes = lanes;
        TEST_ASSERT_EQUAL_UINT32(3, run(0, 3));
        TEST_ASSERT_EQUAL_UINT32((9 + lanes - 1) / lanes * lanes, vertices_padded);
        TEST_ASSERT_EQUAL_UINT32((3 + lanes - 1) / lanes * lanes, triangles_padded);
        for (uint32_t i = 0; i < 3; i++)
            expect_triangle(i, 3 * i, 3 * i + 1, 3 * i + 2);
    }
}

static void long_runs_are_cut_into_batches(void)
{
    TEST_ASSERT_EQUAL_UINT32(1000, run(0, 1000));
    TEST_ASSERT_EQUAL_UINT64(1000, batch->counts.triangles_set_up);
    TEST_ASSERT_EQUAL_UINT64(1000, batch->counts.triangles_visible);
    TEST_ASSERT_EQUAL_UINT64(3000, batch->counts.vertices_shaded);
    for (uint32_t i = 0; i < 1000; i++)
        expect_triangle(i, 3 * i, 3 * i + 1, 3 * i + 2);
}

/* A batch has room for 119 triangles of quads. It takes 118 if they may be joined, and shades the corners of
 * the other one again. */
static void pairs_of_triangles_are_not_split_between_batches(void)
{
    draw.primitive = TRIPTYCH_QUAD_LIST;
    draw.pairs.bytes = sizeof(struct triangle_head);
    TEST_ASSERT_EQUAL_UINT32(400, run(0, 400));
    TEST_ASSERT_EQUAL_UINT32(355, first_primitive);
    batch->joins_pairs = true;
    TEST_ASSERT_EQUAL_UINT32(400, run(0, 400));
    TEST_ASSERT_EQUAL_UINT32(354, first_primitive);
    TEST_ASSERT_EQUAL_UINT64(3 * 239 + 46 * 2, batch->counts.vertices_shaded);
    TEST_ASSERT_EQUAL_UINT64(400, batch->counts.triangles_set_up);
    for (uint32_t i = 0; i < 400; i++)
        expect_triangle(i, i / 2 * 4, i / 2 * 4 + 1 + i % 2, i / 2 * 4 + 2 + i % 2);
    TEST_ASSERT_EQUAL_UINT32(1, run(3, 1));
    TEST_ASSERT_EQUAL_UINT32(7, run(3, 7));
}

/* The triangles have few vertices, but there are more of them than a batch may contain. */
static void many_triangles_of_few_vertices_are_cut_too(void)
{
    static uint16_t index[3 * 1500];
    for (uint16_t i = 0; i < 4500; i++)
        index[i] = i % 5;
    draw.indices = index;
    draw.index_bits = 16;
    TEST_ASSERT_EQUAL_UINT32(1500, run(0, 1500));
    TEST_ASSERT_EQUAL_UINT64(1500, batch->counts.triangles_set_up);
    TEST_ASSERT_EQUAL_UINT64(15, batch->counts.vertices_shaded);
}

static void clip_codes_drop_invisible_triangles(void)
{
    uint32_t codes[5][3] = {
        {CLIP_LEFT, CLIP_LEFT, CLIP_LEFT | CLIP_TOP}, /* all left: dropped */
        {CLIP_LEFT, CLIP_RIGHT, CLIP_TOP},            /* nothing in common: kept */
        {CLIP_INVALID, 0, 0},                         /* not a number: dropped */
        {0, 0, 0},                                    /* inside */
        {CLIP_EYE | CLIP_NEAR, CLIP_NEAR, CLIP_NEAR}, /* all outside: dropped */
    };
    clip_codes = &codes[0][0];
    TEST_ASSERT_EQUAL_UINT32(5, run(0, 5));
    TEST_ASSERT_EQUAL_UINT64(2, batch->counts.triangles_set_up);
    expect_triangle(0, 3, 4, 5);
    expect_triangle(1, 9, 10, 11);
}

static uint32_t random_below(uint32_t bound) /* Park and Miller */
{
    static uint32_t state = 1;
    state = (uint32_t)((uint64_t)state * 48271 % 2147483647);
    return state % bound;
}

static bool is_dropped(uint32_t a, uint32_t b, uint32_t c) /* clip codes */
{
    return (a & b & c & CLIP_FRUSTUM) || ((a | b | c) & CLIP_INVALID);
}

/* The vertices of lists with and without indices are inside, outside of one or another plane, or invalid. The
 * triangles that are set up are the same, in the same order, as if each was in a batch of its own. */
static void triangles_are_dropped_as_in_batches_of_one(void)
{
    enum { VERTICES = 3000, TRIANGLES = VERTICES / 3, FIRST = 7 };
    static const uint32_t side[] = {CLIP_LEFT, CLIP_RIGHT, CLIP_TOP, CLIP_BOTTOM | CLIP_LEFT, CLIP_INVALID};
    static uint32_t codes[FIRST + VERTICES], *const moved = codes + FIRST, index[VERTICES];
    static uint16_t short_index[VERTICES];
    uint32_t dropped = 0;
    clip_codes = codes;
    draw.base = FIRST;
    for (uint32_t round = 0; round < 60; round++) {
        uint32_t kinds = round % 6, reach = 1 + random_below(400), expected = 0;
        draw.index_bits = round / 6 % 3 * 16;
        draw.indices = draw.index_bits == 16 ? (const void *)short_index : draw.index_bits ? index : NULL;
        for (uint32_t i = 0; i < VERTICES; i++) {
            moved[i] = kinds && random_below(4) ? side[random_below(kinds)] : 0;
            if (round % 6 == 1 && i % 1024 < 512)
                moved[i] = CLIP_LEFT; /* whole batches */
            index[i] = draw.index_bits ? (i / 2 + random_below(reach)) % VERTICES : i;
            short_index[i] = (uint16_t)index[i];
        }
        TEST_ASSERT_EQUAL_UINT32(TRIANGLES, run(0, TRIANGLES));
        for (uint32_t i = 0; i < TRIANGLES; i++) {
            const uint32_t *corner = index + 3 * i;
            if (!is_dropped(moved[corner[0]], moved[corner[1]], moved[corner[2]]))
                expect_triangle(expected++, FIRST + corner[0], FIRST + corner[1], FIRST + corner[2]);
        }
        TEST_ASSERT_EQUAL_UINT64(expected, batch->counts.triangles_set_up);
        dropped += TRIANGLES - expected;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(1000, dropped);
}

/* The vertices that are shaded for a list if each batch takes triangles while it has room for three more. */
static uint64_t vertices_of_batches(const uint32_t *index, uint32_t triangles, uint32_t limit)
{
    uint64_t shaded = 0;
    uint32_t seen[64] = {0}, batch_number = 1, count = 0;
    for (uint32_t i = 0; i < triangles; i++) {
        if (count + 3 > limit) {
            batch_number++;
            count = 0;
        }
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t *last = &seen[index[3 * i + k]];
            count += *last != batch_number;
            shaded += *last != batch_number;
            *last = batch_number;
        }
    }
    return shaded;
}

/* Triangles of lists are assembled in pairs, but no batch ends while it has room for one. */
static void batches_are_filled_up_to_their_limit(void)
{
    enum { TRIANGLES = 301, VERTICES = 60 };
    static uint32_t index[3 * TRIANGLES];
    static uint16_t short_index[3 * TRIANGLES];
    for (uint32_t round = 0; round < 40; round++) {
        uint32_t reach = 1 + random_below(20), limit = round % 4 ? 3 + random_below(14) : 24;
        for (uint32_t i = 0; i < 3 * TRIANGLES; i++) {
            index[i] = (i / 6 + random_below(reach)) % VERTICES;
            short_index[i] = (uint16_t)index[i];
        }
        draw.index_bits = round & 1 ? 16 : 32;
        draw.indices = round & 1 ? (const void *)short_index : index;
        batch->limit = limit;
        TEST_ASSERT_EQUAL_UINT32(TRIANGLES, run(0, TRIANGLES));
        TEST_ASSERT_EQUAL_UINT64(vertices_of_batches(index, TRIANGLES, limit), batch->counts.vertices_shaded);
        for (uint32_t i = 0; i < TRIANGLES; i++)
            expect_triangle(i, index[3 * i], index[3 * i + 1], index[3 * i + 2]);
    }
}

/* Returns the number of triangles in a tile's bin. Fails unless they are in order. */
static uint32_t binned(uint32_t tile)
{
    uint32_t count = 0, last = 0;
    for (uint32_t head = heads; head; head = bin_cell(&arena, head)->sibling) {
        if (bin_cell(&arena, head)->tile != tile)
            continue;
        TEST_ASSERT_EQUAL_UINT32(7, bin_cell(&arena, head)->chunk);
        for (uint32_t cell = head; cell; cell = bin_cell(&arena, cell)->next)
            for (uint32_t i = 0; i < bin_cell(&arena, cell)->count; i++, count++) {
                TEST_ASSERT_TRUE(bin_cell(&arena, cell)->triangle[i] > last);
                last = bin_cell(&arena, cell)->triangle[i];
            }
    }
    return count;
}

static void bins_hold_each_visible_triangle_once_in_order(void)
{
    run(0, 1000);
    TEST_ASSERT_EQUAL_UINT32(1000, binned(0));
    TEST_ASSERT_EQUAL_UINT32(0, binned(1));
}

static void triangles_outside_of_the_scissor_rectangle_are_dropped(void)
{
    draw.scissor = (struct rectangle){64, 0, 128, 64};
    run(0, 100);
    TEST_ASSERT_EQUAL_UINT64(100, batch->counts.triangles_set_up);
    TEST_ASSERT_EQUAL_UINT64(0, batch->counts.triangles_visible);
    TEST_ASSERT_EQUAL_UINT32(0, heads);
}

/* The arena has room for some of the groups. The bins contain the finished primitives and no others, and
 * continuing from there gives the others. */
static void a_full_arena_stops_at_a_primitive_and_goes_on_from_it(void)
{
    atomic_store(&arena.used, ARENA_BYTES - ARENA_BLOCK);
    uint32_t total = 10000, done = run(0, total);
    TEST_ASSERT_TRUE(done > 0 && done < total);
    TEST_ASSERT_EQUAL_UINT32(done, binned(0));
    atomic_store(&arena.used, ARENA_BYTES);
    TEST_ASSERT_EQUAL_UINT32(0, run(done, total - done));
    TEST_ASSERT_EQUAL_UINT32(0, heads);
    arena_reset(&arena);
    TEST_ASSERT_EQUAL_UINT32(total - done, run(done, total - done));
    TEST_ASSERT_EQUAL_UINT32(total - done, binned(0));
}

/* The same with edges. A primitive has three records, and the batch never stops between them. */
static void a_full_arena_never_stops_within_a_triangle(void)
{
    uint32_t total = 4000, first = 0, edges = 0, stops = 0;
    draw_as(TRIPTYCH_TRIANGLE_LIST, PRIMITIVE_EDGE, SHAPE_LINE);
    while (first < total) {
        atomic_store(&arena.used, ARENA_BYTES - ARENA_BLOCK);
        uint32_t done = run(first, total - first);
        TEST_ASSERT_TRUE(done > 0);
        edges += binned(0);
        first += done;
        TEST_ASSERT_EQUAL_UINT32(3 * first, edges);
        stops += first < total;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, stops);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(an_engine_that_observes_gets_each_primitive_by_itself);
    RUN_TEST(many_parts_are_cut_into_groups);
    RUN_TEST(clip_codes_drop_lines_and_points);
    RUN_TEST(shared_vertices_are_shaded_once_a_batch);
    RUN_TEST(calls_are_padded_to_the_lanes_of_a_routine);
    RUN_TEST(long_runs_are_cut_into_batches);
    RUN_TEST(pairs_of_triangles_are_not_split_between_batches);
    RUN_TEST(many_triangles_of_few_vertices_are_cut_too);
    RUN_TEST(clip_codes_drop_invisible_triangles);
    RUN_TEST(triangles_are_dropped_as_in_batches_of_one);
    RUN_TEST(batches_are_filled_up_to_their_limit);
    RUN_TEST(bins_hold_each_visible_triangle_once_in_order);
    RUN_TEST(triangles_outside_of_the_scissor_rectangle_are_dropped);
    RUN_TEST(a_full_arena_stops_at_a_primitive_and_goes_on_from_it);
    RUN_TEST(a_full_arena_never_stops_within_a_triangle);
    return UNITY_END();
}
