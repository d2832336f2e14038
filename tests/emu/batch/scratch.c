/* The scratch memory of the batch interpreter: blocks are distinct and reused, and a refused block delays a
 * call. */
#define _GNU_SOURCE
#include "tests/support/system/fault.h"

#include "emu/batch/scratch.h"
#include "emu/batch/schedule.h"

#include <unity.h>

enum { BLOCKS = 4 };

void setUp(void)
{
}

void tearDown(void)
{
    fault_disarm();
}

static void test_simultaneous_calls_have_separate_blocks(void)
{
    uint8_t *block[BLOCKS];
    TEST_ASSERT_TRUE(batch_scratch_hold());
    for (int i = 0; i < BLOCKS; i++) {
        block[i] = batch_scratch_take();
        TEST_ASSERT_EQUAL_UINT(0, (uintptr_t)block[i] % 64);
        memset(block[i], i, SCRATCH_LIMIT);
    }
    for (int i = 0; i < BLOCKS; i++) {
        TEST_ASSERT_EQUAL_UINT8(i, block[i][0]);
        TEST_ASSERT_EQUAL_UINT8(i, block[i][SCRATCH_LIMIT - 1]);
        batch_scratch_give(block[i]);
    }
    TEST_ASSERT_EQUAL_PTR(block[BLOCKS - 1], batch_scratch_take());
    batch_scratch_give(block[BLOCKS - 1]);
    batch_scratch_release();
}

static void test_the_last_routine_frees_all_blocks(void)
{
    fault_watch();
    TEST_ASSERT_TRUE(batch_scratch_hold());
    TEST_ASSERT_TRUE(batch_scratch_hold());
    uint8_t *first = batch_scratch_take(), *second = batch_scratch_take();
    batch_scratch_give(first);
    batch_scratch_give(second);
    batch_scratch_release();
    batch_scratch_release();
    const char *lost = fault_lost();
    TEST_ASSERT_NULL_MESSAGE(lost, lost);
}

static void test_a_build_fails_when_the_first_block_is_refused(void)
{
    fault_arm(1, true);
    bool held = batch_scratch_hold();
    fault_disarm();
    TEST_ASSERT_FALSE(held);
    TEST_ASSERT_TRUE(batch_scratch_hold());
    batch_scratch_release();
}

static atomic_bool taken;

static void *take_and_give(void *refuse)
{
    if (refuse)
        fault_arm(1, true);
    uint8_t *block = batch_scratch_take();
    if (refuse)
        fault_disarm();
    atomic_store(&taken, true);
    batch_scratch_give(block);
    return NULL;
}

static void test_a_call_without_memory_waits_for_a_block(void)
{
    pthread_t thread;
    TEST_ASSERT_TRUE(batch_scratch_hold());
    uint8_t *block = batch_scratch_take();
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&thread, NULL, take_and_give, &fault));
    usleep(50000);
    TEST_ASSERT_FALSE(atomic_load(&taken));
    batch_scratch_give(block);
    TEST_ASSERT_EQUAL_INT(0, pthread_join(thread, NULL));
    TEST_ASSERT_TRUE(atomic_load(&taken));
    batch_scratch_release();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_simultaneous_calls_have_separate_blocks);
    RUN_TEST(test_the_last_routine_frees_all_blocks);
    RUN_TEST(test_a_build_fails_when_the_first_block_is_refused);
    RUN_TEST(test_a_call_without_memory_waits_for_a_block);
    return UNITY_END();
}
