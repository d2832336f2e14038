#include "command/bench/summary.h"

#include <unity.h>

#include <math.h>
#include <stdlib.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_nothing_measured_is_all_zero(void)
{
    struct summary summary = summary_of(NULL, 0);
    TEST_ASSERT_EACH_EQUAL_UINT8(0, &summary, sizeof summary);
}

static void test_one_value_is_its_own_summary(void)
{
    double value[] = {7};
    struct summary summary = summary_of(value, 1);
    TEST_ASSERT_EQUAL_DOUBLE(7, summary.median);
    TEST_ASSERT_EQUAL_DOUBLE(7, summary.p99);
    TEST_ASSERT_EQUAL_DOUBLE(0, summary.deviation);
}

static void test_odd_and_even_counts(void)
{
    double odd[] = {100, 1, 3};
    struct summary summary = summary_of(odd, 3);
    TEST_ASSERT_EQUAL_DOUBLE(3, summary.median);
    TEST_ASSERT_EQUAL_DOUBLE(1, summary.least);
    TEST_ASSERT_EQUAL_DOUBLE(100, summary.most);
    TEST_ASSERT_EQUAL_DOUBLE(2, summary.deviation); /* of 0 2 97 */
    double even[] = {4, 1, 2, 9};
    summary = summary_of(even, 4);
    TEST_ASSERT_EQUAL_DOUBLE(3, summary.median);
    TEST_ASSERT_EQUAL_DOUBLE(1.5, summary.deviation); /* of 1 1 2 6 */
}

static void test_p10_and_p90_are_the_nearest_ranks(void)
{
    double values[25];
    for (int i = 0; i < 25; i++)
        values[i] = 25 - i;
    struct summary summary = summary_of(values, 25);
    TEST_ASSERT_EQUAL_DOUBLE(3, summary.p10);
    TEST_ASSERT_EQUAL_DOUBLE(23, summary.p90);
    summary = summary_of(values, 1);
    TEST_ASSERT_EQUAL_DOUBLE(1, summary.p10);
    TEST_ASSERT_EQUAL_DOUBLE(1, summary.p90);
}

static void test_p99_is_the_nearest_rank(void)
{
    double values[200];
    for (int i = 0; i < 200; i++)
        values[i] = 200 - i;
    TEST_ASSERT_EQUAL_DOUBLE(198, summary_of(values, 200).p99);
    TEST_ASSERT_EQUAL_DOUBLE(99, summary_of(values, 100).p99);
    TEST_ASSERT_EQUAL_DOUBLE(50, summary_of(values, 50).p99);
}

/* Merging outwards from the median gives the same result as sorting the distances. */
static void test_deviation_is_the_median_of_the_distances(void)
{
    srand(1);
    for (int round = 0; round < 1000; round++) {
        double values[40], distances[40];
        size_t count = 1 + (size_t)(rand() % 40);
        for (size_t i = 0; i < count; i++)
            values[i] = rand() % 25;
        struct summary summary = summary_of(values, count);
        for (size_t i = 0; i < count; i++)
            distances[i] = fabs(values[i] - summary.median);
        TEST_ASSERT_EQUAL_DOUBLE(summary_of(distances, count).median, summary.deviation);
    }
}

static void test_a_window_is_the_largest_sum_of_consecutive_values(void)
{
    const double values[] = {5, 1, 4, 3, 0, 6};
    TEST_ASSERT_EQUAL_DOUBLE(6, summary_window(values, 6, 1));
    TEST_ASSERT_EQUAL_DOUBLE(7, summary_window(values, 6, 2));
    TEST_ASSERT_EQUAL_DOUBLE(10, summary_window(values, 6, 3));
    TEST_ASSERT_EQUAL_DOUBLE(19, summary_window(values, 6, 10));
    TEST_ASSERT_EQUAL_DOUBLE(0, summary_window(values, 0, 3));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_measured_is_all_zero);
    RUN_TEST(test_one_value_is_its_own_summary);
    RUN_TEST(test_odd_and_even_counts);
    RUN_TEST(test_p99_is_the_nearest_rank);
    RUN_TEST(test_p10_and_p90_are_the_nearest_ranks);
    RUN_TEST(test_deviation_is_the_median_of_the_distances);
    RUN_TEST(test_a_window_is_the_largest_sum_of_consecutive_values);
    return UNITY_END();
}
