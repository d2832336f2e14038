/* The thread pool: the workers that join a round, the background, and the floating-point environment of the
 * contract. */
#include "render/queue/pool.h"

#include "machine/mxcsr.h"

#include <errno.h>
#include <sched.h>
#include <stdatomic.h>
#include <time.h>
#include <unity.h>

static struct pool *pool;
static _Atomic unsigned runs[POOL_THREADS_MAXIMUM];
static _Atomic unsigned wrong_environment, ended;

void setUp(void)
{
    for (int i = 0; i < POOL_THREADS_MAXIMUM; i++)
        runs[i] = 0;
    wrong_environment = ended = 0;
}

void tearDown(void)
{
    pool_destroy(pool);
    pool = NULL;
}

static void count_run(void *user, unsigned worker)
{
    TEST_ASSERT_EQUAL_PTR(&pool, user);
    runs[worker]++;
    if ((_mm_getcsr() & ~0x3fu) != MXCSR_CONTRACT)
        wrong_environment++;
}

static void the_caller_runs_every_round_and_others_no_more_than_once(void)
{
    pool = pool_create(4, NULL, NULL);
    TEST_ASSERT_EQUAL_UINT32(4, pool_workers(pool));
    for (unsigned i = 0; i < 300; i++) {
        pool_run(pool, 0, 1 + i % 4, i % 3, count_run, &pool);
        TEST_ASSERT_EQUAL_UINT32(i + 1, runs[0]);
        for (int w = 1; w < 4; w++)
            TEST_ASSERT_TRUE(runs[w] <= i + 1);
    }
}

/* A task whose caller does not complete its part before a number of workers have joined. */
static _Atomic unsigned present, awaited;

static void gather(void *user, unsigned worker)
{
    count_run(user, worker);
    present++;
    while (present < awaited)
        sched_yield();
}

static void gather_all(unsigned workers, unsigned expected, enum pool_call call)
{
    present = 0;
    awaited = expected;
    pool_run(pool, 0, workers, call, gather, &pool);
    TEST_ASSERT_EQUAL_UINT32(expected, present);
}

static void let_workers_sleep(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 20 * 1000 * 1000}, NULL);
}

static void all_sleeping_workers_that_are_invited_join(void)
{
    pool = pool_create(7, NULL, NULL);
    for (int i = 0; i < 20; i++) {
        if (i % 2)
            let_workers_sleep();
        gather_all(7, 7, POOL_ALL);
    }
    for (int w = 0; w < 7; w++)
        TEST_ASSERT_EQUAL_UINT32(20, runs[w]);
}

static void no_more_workers_join_than_are_called(void)
{
    pool = pool_create(7, NULL, NULL);
    for (unsigned i = 0; i < 200; i++)
        gather_all(1 + i % 7, 1 + i % 7, POOL_ALL);
    gather_all(0, 1, POOL_ALL);
    gather_all(1000, 7, POOL_ALL);
}

static void come_and_linger(void *user, unsigned worker)
{
    gather(user, worker);
    if (worker) {
        nanosleep(&(struct timespec){.tv_nsec = 5 * 1000 * 1000}, NULL);
        ended++;
    }
}

static void the_caller_waits_for_all_that_joined(void)
{
    pool = pool_create(3, NULL, NULL);
    for (unsigned i = 1; i <= 5; i++) {
        present = 0;
        awaited = 3;
        pool_run(pool, 0, 3, POOL_ALL, come_and_linger, &pool);
        TEST_ASSERT_EQUAL_UINT32(2 * i, ended);
    }
}

static void call_the_others(void *user, unsigned worker)
{
    if (worker == 0)
        pool_call(pool, 3);
    gather(user, worker);
}

static void others_can_be_called_in_the_middle_of_a_round(void)
{
    pool = pool_create(4, NULL, NULL);
    for (int i = 0; i < 100; i++) {
        if (i % 20 == 0)
            let_workers_sleep();
        present = 0;
        awaited = 3;
        pool_run(pool, 0, 3, i % 2 ? POOL_ALONE : POOL_AWAKE, call_the_others, &pool);
        TEST_ASSERT_EQUAL_UINT32(3, present);
    }
}

static void a_round_for_the_caller_wakes_no_thread(void)
{
    pool = pool_create(3, NULL, NULL);
    let_workers_sleep();
    uint64_t before = pool_wakes(pool);
    for (int i = 0; i < 100; i++)
        pool_run(pool, 0, 3, i % 2 ? POOL_ALONE : POOL_AWAKE, count_run, &pool);
    TEST_ASSERT_EQUAL_UINT64(before, pool_wakes(pool));
    TEST_ASSERT_EQUAL_UINT32(100, runs[0]);
}

static void a_limit_holds_until_it_is_lifted(void)
{
    pool = pool_create(3, NULL, NULL);
    pool_limit(pool, 2);
    TEST_ASSERT_EQUAL_UINT32(2, pool_limited(pool));
    gather_all(3, 2, POOL_ALL);
    TEST_ASSERT_EQUAL_UINT32(0, runs[2]);
    pool_limit(pool, 0);
    gather_all(3, 3, POOL_ALL);
    TEST_ASSERT_EQUAL_UINT32(1, runs[2]);
}

static void tasks_run_in_the_contracts_environment_and_the_callers_is_restored(void)
{
    pool = pool_create(3, NULL, NULL);
    unsigned saved = _mm_getcsr(), odd = (saved & ~0x3fu) | _MM_ROUND_DOWN;
    _mm_setcsr(odd);
    gather_all(3, 3, POOL_ALL);
    unsigned after = _mm_getcsr() & ~0x3fu;
    _mm_setcsr(saved);
    TEST_ASSERT_EQUAL_HEX32(odd, after);
    TEST_ASSERT_EQUAL_UINT32(0, wrong_environment);
}

/* --- The background --- */

static _Atomic unsigned rounds_begun;
static _Atomic bool go_on;

/* Rounds that `awaited` workers must join. */
static void lead_rounds(void *user, unsigned worker)
{
    TEST_ASSERT_EQUAL_UINT32(1, worker);
    for (int i = 0; i < 50; i++) {
        present = 0;
        rounds_begun++;
        pool_run(pool, worker, 4, POOL_ALL, gather, user);
    }
}

static void the_thread_that_waits_for_the_background_is_one_of_its_workers(void)
{
    pool = pool_create(3, NULL, NULL);
    for (int i = 0; i < 4; i++) {
        if (i % 2)
            let_workers_sleep();
        awaited = 3;
        rounds_begun = 0;
        pool_start(pool, lead_rounds, &pool);
        pool_wait(pool);
        TEST_ASSERT_EQUAL_UINT32(50, rounds_begun);
        for (int w = 0; w < 3; w++)
            TEST_ASSERT_EQUAL_UINT32(50 * (i + 1), runs[w]);
    }
    pool_wait(pool); /* returns because nothing runs */
}

static void wait_for_go(void *user, unsigned worker)
{
    count_run(user, worker);
    while (!go_on)
        sched_yield();
}

static void the_background_runs_while_its_caller_does_other_work(void)
{
    pool = pool_create(2, NULL, NULL);
    go_on = false;
    pool_start(pool, wait_for_go, &pool);
    go_on = true; /* after the start, without which it would never end */
    pool_wait(pool);
    TEST_ASSERT_EQUAL_UINT32(1, runs[1]);
    TEST_ASSERT_EQUAL_UINT32(0, runs[0]);
    TEST_ASSERT_EQUAL_UINT32(0, wrong_environment);
}

static int threads_left;

static int refuse_later(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                        void *argument)
{
    return threads_left-- > 0 ? pthread_create(thread, attributes, run, argument) : EAGAIN;
}

static void refused_threads_make_a_smaller_pool(void)
{
    threads_left = 2;
    pool = pool_create(16, refuse_later, NULL);
    TEST_ASSERT_EQUAL_UINT32(3, pool_workers(pool));
    gather_all(16, 3, POOL_ALL);
}

static void zero_means_one_worker_for_each_processor(void)
{
    pool = pool_create(0, NULL, NULL);
    TEST_ASSERT_TRUE(pool_workers(pool) >= 1 && pool_workers(pool) <= POOL_THREADS_MAXIMUM);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_caller_waits_for_all_that_joined);
    if (Unity.TestFailures) /* a worker may still be in an earlier round, and other tests would hang */
        return UNITY_END();
    RUN_TEST(the_caller_runs_every_round_and_others_no_more_than_once);
    RUN_TEST(all_sleeping_workers_that_are_invited_join);
    RUN_TEST(no_more_workers_join_than_are_called);
    RUN_TEST(others_can_be_called_in_the_middle_of_a_round);
    RUN_TEST(a_round_for_the_caller_wakes_no_thread);
    RUN_TEST(a_limit_holds_until_it_is_lifted);
    RUN_TEST(tasks_run_in_the_contracts_environment_and_the_callers_is_restored);
    RUN_TEST(the_thread_that_waits_for_the_background_is_one_of_its_workers);
    RUN_TEST(the_background_runs_while_its_caller_does_other_work);
    RUN_TEST(refused_threads_make_a_smaller_pool);
    RUN_TEST(zero_means_one_worker_for_each_processor);
    return UNITY_END();
}
