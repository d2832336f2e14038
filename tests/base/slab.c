/* Slabs: new blocks are zero, old ones keep their contents, and threads never share one. */
#include "base/slab.h"

#include <stdint.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_a_new_block_is_zero_and_aligned(void)
{
    struct slab slab = SLAB(100003);
    uint8_t *block = slab_take(&slab);
    TEST_ASSERT_NOT_NULL(block);
    TEST_ASSERT_EQUAL_UINT(0, (uintptr_t)block % 16);
    for (int i = 0; i < 100003; i++)
        TEST_ASSERT_EQUAL_UINT8(0, block[i]);
    slab_give(&slab, block);
}

static void test_a_block_that_is_used_again_has_its_old_contents(void)
{
    struct slab slab = SLAB(4099);
    uint8_t *block = slab_take(&slab);
    memset(block, 0xa5, 4099);
    slab_give(&slab, block);
    TEST_ASSERT_EQUAL_PTR(block, slab_take(&slab));
    for (int i = 0; i < 4099; i++)
        TEST_ASSERT_EQUAL_UINT8(0xa5, block[i]);
    slab_give(&slab, block);
}

static void test_the_last_block_given_is_taken_first(void)
{
    struct slab slab = SLAB(64);
    void *first = slab_take(&slab), *second = slab_take(&slab);
    TEST_ASSERT_TRUE(first != second);
    slab_give(&slab, first);
    slab_give(&slab, second);
    TEST_ASSERT_EQUAL_PTR(second, slab_take(&slab));
    TEST_ASSERT_EQUAL_PTR(first, slab_take(&slab));
    slab_give(&slab, first);
    slab_give(&slab, second);
    slab_give(&slab, NULL);
}

static void test_a_cleared_slab_gives_new_blocks(void)
{
    struct slab slab = SLAB(4099);
    uint8_t *kept = slab_take(&slab), *given = slab_take(&slab);
    memset(kept, 1, 4099);
    memset(given, 1, 4099);
    slab_give(&slab, given);
    slab_clear(&slab);
    TEST_ASSERT_EQUAL_UINT8(1, kept[4098]); /* it is in use */
    uint8_t *fresh = slab_take(&slab);
    for (int i = 0; i < 4099; i++)
        TEST_ASSERT_EQUAL_UINT8(0, fresh[i]);
    slab_give(&slab, fresh);
    slab_give(&slab, kept);
    slab_clear(&slab);
}

static struct slab shared = SLAB(sizeof(int));

/* Counts the rounds in which another thread wrote to the block. */
static void *take_and_give(void *mark)
{
    uintptr_t shared_blocks = 0;
    for (int i = 0; i < 2000; i++) {
        volatile int *block = slab_take(&shared);
        *block = *(int *)mark;
        for (int j = 0; j < 20; j++)
            shared_blocks += *block != *(int *)mark;
        slab_give(&shared, (void *)(uintptr_t)block);
    }
    return (void *)shared_blocks;
}

static void test_two_threads_never_have_the_same_block(void)
{
    pthread_t thread[4];
    int mark[4] = {1, 2, 3, 4};
    for (int i = 0; i < 4; i++)
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&thread[i], NULL, take_and_give, &mark[i]));
    for (int i = 0; i < 4; i++) {
        void *shared_blocks;
        pthread_join(thread[i], &shared_blocks);
        TEST_ASSERT_NULL(shared_blocks);
    }
}

static void test_refused_memory_is_null(void)
{
    struct slab slab = SLAB(SIZE_MAX / 4);
    TEST_ASSERT_NULL(slab_take(&slab));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_new_block_is_zero_and_aligned);
    RUN_TEST(test_a_block_that_is_used_again_has_its_old_contents);
    RUN_TEST(test_the_last_block_given_is_taken_first);
    RUN_TEST(test_a_cleared_slab_gives_new_blocks);
    RUN_TEST(test_two_threads_never_have_the_same_block);
    RUN_TEST(test_refused_memory_is_null);
    return UNITY_END();
}
