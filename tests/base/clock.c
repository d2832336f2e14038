/* Clocks: they advance, and the units agree. */
#include "base/clock.h"

#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_time_never_goes_back(void)
{
    uint64_t before = clock_ns();
    for (int i = 0; i < 1000; i++) {
        uint64_t now = clock_ns();
        TEST_ASSERT_TRUE(now >= before);
        before = now;
    }
}

static void test_nanoseconds_and_seconds_are_the_same_time(void)
{
    double before = clock_seconds(), between = (double)clock_ns() * 1e-9, after = clock_seconds();
    TEST_ASSERT_TRUE(before <= between + 1e-6 && between <= after + 1e-6);
}

static void test_a_sleeping_thread_uses_no_processor_time(void)
{
    const struct timespec pause = {.tv_nsec = 20000000};
    uint64_t time = clock_ns(), used = clock_ns_of(CLOCK_THREAD_CPUTIME_ID);
    nanosleep(&pause, NULL);
    time = clock_ns() - time;
    used = clock_ns_of(CLOCK_THREAD_CPUTIME_ID) - used;
    TEST_ASSERT_TRUE(time >= 20000000);
    TEST_ASSERT_TRUE(used < time / 2);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_time_never_goes_back);
    RUN_TEST(test_nanoseconds_and_seconds_are_the_same_time);
    RUN_TEST(test_a_sleeping_thread_uses_no_processor_time);
    return UNITY_END();
}
