/* The thread pool: every wanted worker runs once a round, in the contract's floating-point environment. */
#include "draw/pool.h"

#include "base/mxcsr.h"

#include <errno.h>
#include <stdatomic.h>
#include <unity.h>

static struct pool *pool;
static _Atomic unsigned runs[POOL_THREADS_MAXIMUM];
static _Atomic unsigned wrong_environment;

void setUp(void)
{
    for (int i = 0; i < POOL_THREADS_MAXIMUM; i++)
        runs[i] = 0;
    wrong_environment = 0;
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

static void each_wanted_worker_runs_once_a_round(void)
{
    pool = pool_create(4, NULL, NULL);
    TEST_ASSERT_EQUAL_UINT32(4, pool_workers(pool));
    for (int i = 0; i < 300; i++)
        pool_run(pool, 1 + i % 4, count_run, &pool);
    TEST_ASSERT_EQUAL_UINT32(300, runs[0]);
    TEST_ASSERT_EQUAL_UINT32(225, runs[1]);
    TEST_ASSERT_EQUAL_UINT32(150, runs[2]);
    TEST_ASSERT_EQUAL_UINT32(75, runs[3]);
}

static void the_number_wanted_is_clamped(void)
{
    pool = pool_create(2, NULL, NULL);
    pool_run(pool, 0, count_run, &pool);
    pool_run(pool, 1000, count_run, &pool);
    TEST_ASSERT_EQUAL_UINT32(2, runs[0]);
    TEST_ASSERT_EQUAL_UINT32(1, runs[1]);
    TEST_ASSERT_EQUAL_UINT32(0, runs[2]);
}

static void a_limit_holds_until_it_is_lifted(void)
{
    pool = pool_create(3, NULL, NULL);
    pool_limit(pool, 2);
    pool_run(pool, 3, count_run, &pool);
    TEST_ASSERT_EQUAL_UINT32(0, runs[2]);
    pool_limit(pool, 0);
    pool_run(pool, 3, count_run, &pool);
    TEST_ASSERT_EQUAL_UINT32(2, runs[1]);
    TEST_ASSERT_EQUAL_UINT32(1, runs[2]);
}

static void tasks_run_in_the_contracts_environment_and_the_callers_is_restored(void)
{
    pool = pool_create(3, NULL, NULL);
    unsigned saved = _mm_getcsr(), odd = (saved & ~0x3fu) | _MM_ROUND_DOWN;
    _mm_setcsr(odd);
    pool_run(pool, 3, count_run, &pool);
    unsigned after = _mm_getcsr() & ~0x3fu;
    _mm_setcsr(saved);
    TEST_ASSERT_EQUAL_HEX32(odd, after);
    TEST_ASSERT_EQUAL_UINT32(0, wrong_environment);
    TEST_ASSERT_EQUAL_UINT32(3, runs[0] + runs[1] + runs[2]);
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
    pool_run(pool, 16, count_run, &pool);
    TEST_ASSERT_EQUAL_UINT32(3, runs[0] + runs[1] + runs[2]);
}

static void zero_means_as_many_as_processors(void)
{
    pool = pool_create(0, NULL, NULL);
    TEST_ASSERT_TRUE(pool_workers(pool) >= 1 && pool_workers(pool) <= POOL_THREADS_MAXIMUM);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_wanted_worker_runs_once_a_round);
    RUN_TEST(the_number_wanted_is_clamped);
    RUN_TEST(a_limit_holds_until_it_is_lifted);
    RUN_TEST(tasks_run_in_the_contracts_environment_and_the_callers_is_restored);
    RUN_TEST(refused_threads_make_a_smaller_pool);
    RUN_TEST(zero_means_as_many_as_processors);
    return UNITY_END();
}
