/* The intervals against published tables and examples. */
#include "command/bench/interval.h"

#include <math.h>
#include <string.h>
#include <unity.h>

static struct interval interval;

void setUp(void)
{
}

void tearDown(void)
{
}

/* The critical values of Mann and Whitney's U for a two-sided level of 5 %, as tables print them (Siegel
 * 1956, table K): a difference is significant if U is at most this. The rank is one more. */
static void ranks_are_those_of_the_published_table(void)
{
    static const size_t rows[][3] = {
        {4, 4, 0},    {3, 5, 0},    {5, 5, 2},    {6, 6, 5},    {7, 7, 8},     {8, 8, 13},
        {9, 9, 17},   {10, 10, 23}, {11, 11, 30}, {12, 12, 37}, {13, 13, 45},  {14, 14, 55},
        {15, 15, 64}, {16, 16, 75}, {17, 17, 87}, {18, 18, 99}, {5, 10, 8},    {7, 9, 12},
        {10, 15, 39}, {9, 20, 48},  {12, 18, 61}, {3, 15, 5},   {19, 19, 113}, {20, 20, 127},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        TEST_ASSERT_EQUAL_UINT64(rows[i][2] + 1, interval_rank(rows[i][0], rows[i][1]));
        TEST_ASSERT_EQUAL_UINT64(rows[i][2] + 1, interval_rank(rows[i][1], rows[i][0]));
    }
}

static void three_against_four_are_too_few(void)
{
    const double a[] = {1, 2, 3}, b[] = {10, 20, 30, 40};
    TEST_ASSERT_EQUAL_UINT64(0, interval_rank(3, 4));
    TEST_ASSERT_EQUAL_INT(0, interval_of(a, 3, b, 4, &interval));
    TEST_ASSERT_TRUE(interval.low == 0 && interval.high == 0 && interval.times > 0);
    TEST_ASSERT_FALSE(interval_shows_difference(&interval));
    TEST_ASSERT_EQUAL_STRING("too few runs", interval_verdict(&interval, "less", "greater"));
}

/* Above 50 values the rank is that of the normal distribution, which continues the exact one. */
static void the_normal_ranks_continue_the_exact_ones(void)
{
    TEST_ASSERT_EQUAL_UINT64(966, interval_rank(50, 50));
    TEST_ASSERT_EQUAL_UINT64(1007, interval_rank(51, 51));
    TEST_ASSERT_EQUAL_UINT64(25, interval_rank(50, 3));
    TEST_ASSERT_UINT64_WITHIN(2, 26, interval_rank(51, 3));
    TEST_ASSERT_UINT64_WITHIN(500, 474664, interval_rank(1000, 1000));
}

/* Permeability of the human chorioamnion (Hollander and Wolfe 1973, p. 69; also the example of R's
 * wilcox.test): the shift is 0.305, with an interval from -0.15 to 0.76. Exponents make quotients of
 * shifts. */
static void the_interval_is_that_of_a_published_example(void)
{
    double term[] = {0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46},
           early[] = {1.15, 0.88, 0.90, 0.74, 1.21};
    for (int i = 0; i < 10; i++)
        term[i] = exp(term[i]);
    for (int i = 0; i < 5; i++)
        early[i] = exp(early[i]);
    TEST_ASSERT_EQUAL_INT(0, interval_of(term, 10, early, 5, &interval));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.305, log(interval.times));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -0.15, log(interval.low));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.76, log(interval.high));
    TEST_ASSERT_EQUAL_STRING("no difference shown", interval_verdict(&interval, "less", "greater"));
}

static void exchanged_samples_have_the_reciprocal_interval(void)
{
    const double a[] = {2.1, 2.0, 2.2, 2.3, 1.9}, b[] = {1.0, 1.1, 0.9, 1.2, 1.05, 0.95};
    struct interval back;
    TEST_ASSERT_EQUAL_INT(0, interval_of(a, 5, b, 6, &interval));
    TEST_ASSERT_EQUAL_INT(0, interval_of(b, 6, a, 5, &back));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1 / interval.low, back.high);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1 / interval.high, back.low);
    TEST_ASSERT_EQUAL_STRING("greater", interval_verdict(&interval, "less", "greater"));
    TEST_ASSERT_EQUAL_STRING("less", interval_verdict(&back, "less", "greater"));
}

static void equal_samples_show_no_difference(void)
{
    const double a[] = {1, 1, 1, 1, 1, 1, 1};
    TEST_ASSERT_EQUAL_INT(0, interval_of(a, 7, a, 7, &interval));
    TEST_ASSERT_TRUE(interval.times == 1 && interval.low == 1 && interval.high == 1);
    TEST_ASSERT_EQUAL_STRING("no difference shown", interval_verdict(&interval, "less", "greater"));
}

/* One disturbed run of eight changes neither the result nor the verdict. */
static void an_outlier_hardly_matters(void)
{
    const double a[] = {2.0, 2.1, 1.9, 2.05, 1.95, 2.02, 1.98, 900},
                 b[] = {1.0, 1.1, 0.9, 1.05, 0.95, 1.02, 0.98, 1.01};
    TEST_ASSERT_EQUAL_INT(0, interval_of(a, 8, b, 8, &interval));
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 2, interval.times);
    TEST_ASSERT_TRUE(interval.low > 1.8 && interval.high < 2.4);
}

static void values_that_are_not_positive_have_no_quotients(void)
{
    const double good[] = {1, 2, 3, 4, 5}, zero[] = {1, 2, 0, 4, 5}, endless[] = {1, 2, INFINITY, 4, 5};
    const double *const bad[] = {zero, endless};
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL_INT(0, interval_of(good, 5, bad[i], 5, &interval));
        TEST_ASSERT_TRUE(interval.times == 0);
        TEST_ASSERT_EQUAL_STRING("-", interval_verdict(&interval, "less", "greater"));
    }
    TEST_ASSERT_EQUAL_INT(0, interval_of(good, 5, good, 0, &interval));
    TEST_ASSERT_TRUE(interval.times == 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(ranks_are_those_of_the_published_table);
    RUN_TEST(three_against_four_are_too_few);
    RUN_TEST(the_normal_ranks_continue_the_exact_ones);
    RUN_TEST(the_interval_is_that_of_a_published_example);
    RUN_TEST(exchanged_samples_have_the_reciprocal_interval);
    RUN_TEST(equal_samples_show_no_difference);
    RUN_TEST(an_outlier_hardly_matters);
    RUN_TEST(values_that_are_not_positive_have_no_quotients);
    return UNITY_END();
}
