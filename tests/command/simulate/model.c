/* The model of more threads, on timelines whose result is computed by hand. */
#include "command/simulate/model.h"
#include "render/queue/phase.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { PARTS = 16, TASKS = 1024, LONG_NS = 1000000 /* an estimate for which sleeping threads are woken */ };

static struct timeline_part part[PARTS];
static uint32_t task_ns[TASKS];
static struct timeline timeline;
static struct handover costs;

void setUp(void)
{
    timeline = (struct timeline){.part = part, .task_ns = task_ns};
    costs = (struct handover){.poll_ns = 1e9};
}

void tearDown(void)
{
}

static void add_serial(enum timeline_kind kind, uint64_t ns)
{
    part[timeline.parts++] = (struct timeline_part){.kind = kind, .first = timeline.tasks, .ns = ns};
}

static void add_tasks(enum timeline_kind kind, uint64_t estimate_ns, uint32_t count, uint32_t ns)
{
    part[timeline.parts++] = (struct timeline_part){
        .kind = kind, .first = timeline.tasks, .tasks = count, .estimate_ns = estimate_ns};
    for (uint32_t i = 0; i < count; i++)
        task_ns[timeline.tasks++] = ns;
}

static struct model_time run(unsigned threads)
{
    struct model_time time;
    struct error error = {""};
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, model_run(&timeline, threads, &costs, &time, &error), error.text);
    return time;
}

static void one_thread_takes_the_sum(void)
{
    add_serial(TIMELINE_SUBMIT, 1000);
    add_serial(TIMELINE_CUT, 10);
    add_tasks(TIMELINE_GEOMETRY, LONG_NS, 5, 100);
    add_serial(TIMELINE_LINK, 20);
    add_tasks(TIMELINE_TILES, LONG_NS, 7, 300);
    struct model_time time = run(1);
    TEST_ASSERT_EQUAL_DOUBLE(1000 + 10 + 500 + 20 + 2100, time.frame);
    TEST_ASSERT_EQUAL_DOUBLE(time.frame, time.busy);
    TEST_ASSERT_EQUAL_DOUBLE(500, time.part[TIMELINE_GEOMETRY]);
    TEST_ASSERT_EQUAL_DOUBLE(2100, time.part[TIMELINE_TILES]);
}

static void tasks_are_shared_out_and_serial_parts_are_not(void)
{
    add_serial(TIMELINE_SUBMIT, 1000);
    add_tasks(TIMELINE_GEOMETRY, LONG_NS, 10, 100);
    add_serial(TIMELINE_LINK, 50);
    add_tasks(TIMELINE_TILES, LONG_NS, 9, 100);
    TEST_ASSERT_EQUAL_DOUBLE(1000 + 500 + 50 + 500, run(2).frame);
    TEST_ASSERT_EQUAL_DOUBLE(1000 + 300 + 50 + 300, run(4).frame);
    TEST_ASSERT_EQUAL_DOUBLE(1000 + 100 + 50 + 100, run(64).frame);
    TEST_ASSERT_EQUAL_DOUBLE(1000 + 1000 + 50 + 900, run(64).busy);
}

static void the_longest_task_bounds_a_part(void)
{
    add_serial(TIMELINE_SUBMIT, 0);
    add_tasks(TIMELINE_GEOMETRY, LONG_NS, 8, 100);
    task_ns[3] = 700;
    TEST_ASSERT_EQUAL_DOUBLE(700, run(8).frame);
    TEST_ASSERT_EQUAL_DOUBLE(800, run(2).frame); /* 100 and 700, and beside it the others */
}

static void a_short_part_has_one_thread(void)
{
    add_serial(TIMELINE_SUBMIT, 0);
    add_tasks(TIMELINE_GEOMETRY, 0, 10, 100);
    TEST_ASSERT_EQUAL_DOUBLE(1000, run(4).frame);
}

static void a_part_that_was_estimated_too_short_gets_threads_later(void)
{
    add_serial(TIMELINE_SUBMIT, 0);
    add_tasks(TIMELINE_GEOMETRY, 0, 40, PHASE_PATIENCE_NS / 10);
    double frame = run(31).frame;
    TEST_ASSERT_TRUE(frame > PHASE_PATIENCE_NS && frame < 2 * PHASE_PATIENCE_NS);
}

static void the_application_fills_a_buffer_while_another_is_rendered(void)
{
    for (int i = 0; i < 3; i++) {
        add_serial(TIMELINE_SUBMIT, 1000);
        part[timeline.parts - 1].background = i < 2;
        add_serial(TIMELINE_CUT, 400);
    }
    TEST_ASSERT_EQUAL_DOUBLE(3 * 1400, run(1).frame);
    TEST_ASSERT_EQUAL_DOUBLE(3 * 1000 + 400, run(2).frame);
    TEST_ASSERT_EQUAL_DOUBLE(1000 + 600 + 600, run(2).part[TIMELINE_SUBMIT]); /* the rest is overlapped */
}

static void the_application_waits_for_the_buffer_before(void)
{
    for (int i = 0; i < 3; i++) {
        add_serial(TIMELINE_SUBMIT, 100);
        part[timeline.parts - 1].background = i < 2;
        add_serial(TIMELINE_CUT, 1000);
    }
    TEST_ASSERT_EQUAL_DOUBLE(100 + 3 * 1000, run(2).frame);
}

static void the_application_helps_while_it_waits(void)
{
    add_serial(TIMELINE_SUBMIT, 0);
    part[0].background = true;
    add_tasks(TIMELINE_GEOMETRY, LONG_NS, 10, 100);
    add_serial(TIMELINE_SUBMIT, 500);
    TEST_ASSERT_EQUAL_DOUBLE(800, run(2).frame); /* five tasks, then two at a time: 500 + 300 */
}

static void entering_and_leaving_cost_time(void)
{
    costs.enter_ns = 50;
    costs.leave_ns = 30;
    add_serial(TIMELINE_SUBMIT, 0);
    add_tasks(TIMELINE_GEOMETRY, LONG_NS, 2, 1000);
    TEST_ASSERT_EQUAL_DOUBLE(50 + 1000 + 30, run(2).frame);
}

static void sleeping_threads_are_woken_in_a_tree(void)
{
    costs.wake_ns = 1000;
    costs.poll_ns = 10;
    add_serial(TIMELINE_SUBMIT, 100);
    add_tasks(TIMELINE_GEOMETRY, LONG_NS, 7, 10000);
    TEST_ASSERT_EQUAL_DOUBLE(100 + 2 * 1000 + 10000, run(7).frame);
    costs.poll_ns = 1000;
    TEST_ASSERT_EQUAL_DOUBLE(100 + 10000, run(7).frame);
}

static void one_thread_at_a_time_takes_from_a_counter(void)
{
    costs.take_ns = 100;
    add_serial(TIMELINE_SUBMIT, 0);
    add_tasks(TIMELINE_GEOMETRY, LONG_NS, 4, 1000);
    TEST_ASSERT_EQUAL_DOUBLE(400 + 1000, run(4).frame);
}

static void a_thread_that_comes_too_late_costs_nothing(void)
{
    costs.enter_ns = 5000;
    costs.leave_ns = 1000;
    add_serial(TIMELINE_SUBMIT, 0);
    add_tasks(TIMELINE_GEOMETRY, LONG_NS, 4, 1000);
    TEST_ASSERT_EQUAL_DOUBLE(4000, run(2).frame);
}

static void tiles_are_taken_in_runs_that_get_shorter(void)
{
    add_serial(TIMELINE_SUBMIT, 0);
    add_tasks(TIMELINE_TILES, LONG_NS, 320, 1000);
    TEST_ASSERT_EQUAL_DOUBLE(160000, run(2).frame);
    TEST_ASSERT_EQUAL_DOUBLE(20000, run(16).frame);
}

static void medians_are_taken_part_by_part_and_task_by_task(void)
{
    static const uint64_t ns[3] = {5, 9, 7};
    struct timeline samples[3] = {{0}};
    for (int i = 0; i < 3; i++) {
        timeline_restart(samples + i);
        timeline_end(samples + i);
        timeline_begin(samples + i, TIMELINE_TILES, 100);
        timeline_task(samples + i);
        timeline_task(samples + i);
        timeline_end(samples + i);
        TEST_ASSERT_EQUAL_UINT32(2, samples[i].parts);
        TEST_ASSERT_EQUAL_UINT32(2, samples[i].part[1].tasks);
        TEST_ASSERT_TRUE(samples[i].part[1].ns >= samples[i].task_ns[0]);
        samples[i].part[0].ns = ns[i];
        samples[i].task_ns[1] = (uint32_t)(10 * ns[(i + 1) % 3]);
    }
    TEST_ASSERT_TRUE(timeline_take_medians(samples, 3));
    TEST_ASSERT_EQUAL_UINT64(7, samples[0].part[0].ns);
    TEST_ASSERT_EQUAL_UINT32(70, samples[0].task_ns[1]);
    samples[2].part[1].tasks = 1;
    TEST_ASSERT_FALSE(timeline_take_medians(samples, 3));
    for (int i = 0; i < 3; i++)
        timeline_free(samples + i);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(one_thread_takes_the_sum);
    RUN_TEST(tasks_are_shared_out_and_serial_parts_are_not);
    RUN_TEST(the_longest_task_bounds_a_part);
    RUN_TEST(a_short_part_has_one_thread);
    RUN_TEST(a_part_that_was_estimated_too_short_gets_threads_later);
    RUN_TEST(the_application_fills_a_buffer_while_another_is_rendered);
    RUN_TEST(the_application_waits_for_the_buffer_before);
    RUN_TEST(the_application_helps_while_it_waits);
    RUN_TEST(entering_and_leaving_cost_time);
    RUN_TEST(sleeping_threads_are_woken_in_a_tree);
    RUN_TEST(one_thread_at_a_time_takes_from_a_counter);
    RUN_TEST(a_thread_that_comes_too_late_costs_nothing);
    RUN_TEST(tiles_are_taken_in_runs_that_get_shorter);
    RUN_TEST(medians_are_taken_part_by_part_and_task_by_task);
    return UNITY_END();
}
