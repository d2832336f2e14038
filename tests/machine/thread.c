/* Stacks of the library's threads (machine/thread.h). */
#include "machine/thread.h"

#include <stddef.h>
#include <unity.h>

enum { USED = 3 << 20 };

void setUp(void)
{
}

void tearDown(void)
{
}

static void *use_stack(void *sum)
{
    volatile char memory[USED];
    for (size_t i = 0; i < USED; i += 4096)
        memory[i] = 1;
    for (size_t i = 0; i < USED; i += 4096)
        *(int *)sum += memory[i];
    return NULL;
}

static void a_thread_can_use_three_mebibytes(void)
{
    pthread_t thread;
    int sum = 0;
    TEST_ASSERT_NOT_NULL(thread_attributes());
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&thread, thread_attributes(), use_stack, &sum));
    TEST_ASSERT_EQUAL_INT(0, pthread_join(thread, NULL));
    TEST_ASSERT_EQUAL_INT(USED / 4096, sum);
}

static void the_size_does_not_depend_on_the_limit_of_the_process(void)
{
    size_t bytes = 0;
    TEST_ASSERT_EQUAL_INT(0, pthread_attr_getstacksize(thread_attributes(), &bytes));
    TEST_ASSERT_EQUAL_UINT64(4 << 20, bytes);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_thread_can_use_three_mebibytes);
    RUN_TEST(the_size_does_not_depend_on_the_limit_of_the_process);
    return UNITY_END();
}
