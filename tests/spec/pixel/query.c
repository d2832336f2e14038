/* Occlusion queries count exactly the pixels that pass the alpha, stencil and depth tests, on every engine,
 * with any number of threads and draws. Calls in the wrong order are refused. */
#include "tests/support/picture/canvas.h"

#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static triptych_query *make_query(void)
{
    triptych_query *query;
    OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
    return query;
}

static unsigned result_of(triptych_query *query)
{
    uint64_t result;
    OK(triptych_query_result(device, query, &result));
    return (unsigned)result;
}

static void draw_part(float z, unsigned x, unsigned y, unsigned width, unsigned height)
{
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
    OK(triptych_set_scissor(device, x, y, width, height));
    draw_square(z, random_word(), NULL, 0, 0, 1, 1);
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "false");
}

static void use_stencil(void)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .depth_format = TRIPTYCH_DEPTH_D24S8};
    OK(triptych_set_target_description(device, &description));
}

static void check_counts(void)
{
    triptych_query *whole = make_query(), *first = make_query(), *second = make_query();
    use_stencil();
    set(TRIPTYCH_STATE_ZENABLE, "true");
    OK(triptych_query_begin(device, whole));
    OK(triptych_query_begin(device, first));
    draw_part(0.5f, 3, 5, 20, 30); /* 600 */
    OK(triptych_query_end(device, first));
    OK(triptych_query_begin(device, second));
    draw_part(0.75f, 3, 5, 20, 31); /* 20: the rest is hidden */
    draw_part(0.25f, 0, 0, 7, 7);   /* 49 */
    OK(triptych_query_end(device, second));
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 0));
    set(TRIPTYCH_STATE_ZWRITEENABLE, "false");
    draw_part(0.125f, 10, 10, 11, 11); /* 121 */
    OK(triptych_query_end(device, whole));
    draw_part(0.125f, 0, 0, 11, 11);
    TEST_ASSERT_EQUAL_UINT(600, result_of(first));
    TEST_ASSERT_EQUAL_UINT(69, result_of(second));
    TEST_ASSERT_EQUAL_UINT(790, result_of(whole));
    TEST_ASSERT_EQUAL_UINT(69, result_of(second));
    OK(triptych_query_begin(device, first));
    OK(triptych_query_end(device, first));
    TEST_ASSERT_EQUAL_UINT(0, result_of(first));
}

static void test_pixels_that_pass_are_counted(void)
{
    on_every_engine(check_counts);
}

/* The picture has 64 values of alpha, a stencil in its left half, and a nearer depth in its upper half. */
static void check_tests(void)
{
    triptych_query *query = make_query();
    unsigned expected = 0;
    use_stencil();
    OK(triptych_clear_buffers(device, TRIPTYCH_CLEAR_DEPTH | TRIPTYCH_CLEAR_STENCIL, NULL, 1, 0));
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_STENCILENABLE, "true");
    set(TRIPTYCH_STATE_STENCILPASS, "replace");
    OK(triptych_set_state(device, TRIPTYCH_STATE_STENCILREF, 3));
    draw_part(0.875f, 0, 0, SIZE / 2, SIZE);
    set(TRIPTYCH_STATE_STENCILENABLE, "false");
    draw_part(0.25f, 0, 0, SIZE, SIZE / 2);
    for (int writes = 0; writes < 2; writes++) {
        bind_random_texture(SIZE, SIZE);
        expected = 0;
        for (unsigned p = 0; p < SIZE * SIZE; p++)
            expected += (texel[p] >> 24) > 100 && p % SIZE < SIZE / 2 && p / SIZE >= SIZE / 2;
        set(TRIPTYCH_STATE_ALPHATESTENABLE, "true");
        set(TRIPTYCH_STATE_ALPHAFUNC, "greater");
        OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAREF, 100));
        set(TRIPTYCH_STATE_STENCILENABLE, "true");
        set(TRIPTYCH_STATE_STENCILFUNC, "equal");
        set(TRIPTYCH_STATE_STENCILPASS, writes ? "incr" : "keep");
        set(TRIPTYCH_STATE_ZWRITEENABLE, "false");
        OK(triptych_query_begin(device, query));
        draw_square(0.5f, 0xffffffff, NULL, 0, 0, 1, 1);
        OK(triptych_query_end(device, query));
        TEST_ASSERT_EQUAL_UINT(expected, result_of(query));
    }
}

static void test_every_test_reduces_the_count(void)
{
    on_every_engine(check_tests);
}

/* More draws than a queue holds, with results read in between. */
static void test_queries_span_any_number_of_draws(void)
{
    enum { DRAWS = 2600 };
    for (unsigned threads = 1; threads <= 3; threads += 2) {
        struct triptych_options options = {.engine = "emulate", .threads = threads};
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &device, NULL, 0));
        OK(triptych_set_target(device, 200, 150));
        set(TRIPTYCH_STATE_LIGHTING, "false");
        set(TRIPTYCH_STATE_ZENABLE, "false");
        triptych_query *whole = make_query(), *part = make_query();
        OK(triptych_query_begin(device, whole));
        for (unsigned i = 0; i < DRAWS; i++) {
            if (i == 1000)
                OK(triptych_query_begin(device, part));
            draw_part(0.5f, i % 64, i % 100, 1 + i % 30, 1);
            if (i == 1500)
                OK(triptych_query_end(device, part));
        }
        OK(triptych_query_end(device, whole));
        unsigned expected[2] = {0, 0};
        for (unsigned i = 0; i < DRAWS; i++) {
            expected[0] += 1 + i % 30;
            expected[1] += i >= 1000 && i <= 1500 ? 1 + i % 30 : 0;
        }
        TEST_ASSERT_EQUAL_UINT(expected[0], result_of(whole));
        TEST_ASSERT_EQUAL_UINT(expected[1], result_of(part));
        close_canvas();
    }
}

static void check_refusals(void)
{
    uint64_t result;
    triptych_query *query = make_query(), *event;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_query_end(device, query));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_query_result(device, query, &result));
    OK(triptych_query_begin(device, query));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_query_begin(device, query));
    TEST_ASSERT_EQUAL_STRING("begin of a query that has begun: expected its end first",
                             triptych_error(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_query_result(device, query, &result));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_query_create(device, TRIPTYCH_QUERY_COUNT, &event));
    TEST_ASSERT_NULL(event);
    OK(triptych_query_create(device, TRIPTYCH_QUERY_EVENT, &event));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_query_begin(device, event));
    OK(triptych_query_end(device, event));
    TEST_ASSERT_EQUAL_UINT(1, result_of(event));
    triptych_query *early, *late;
    uint64_t before, after;
    OK(triptych_query_create(device, TRIPTYCH_QUERY_TIMESTAMP, &early));
    OK(triptych_query_create(device, TRIPTYCH_QUERY_TIMESTAMP, &late));
    OK(triptych_query_end(device, early));
    OK(triptych_query_result(device, early, &before));
    draw_square(0.5f, 0, NULL, 0, 0, 1, 1);
    OK(triptych_query_end(device, late));
    OK(triptych_query_result(device, late, &after));
    TEST_ASSERT_TRUE(before < after);
}

static void test_calls_out_of_order_are_refused(void)
{
    on_every_engine(check_refusals);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_pixels_that_pass_are_counted);
    RUN_TEST(test_every_test_reduces_the_count);
    RUN_TEST(test_queries_span_any_number_of_draws);
    RUN_TEST(test_calls_out_of_order_are_refused);
    return UNITY_END();
}
