#include "memory/extent.h"

#include <stdint.h>
#include <string.h>
#include <unity.h>

static struct extents list;

void setUp(void)
{
}

void tearDown(void)
{
    extents_free(&list);
    TEST_ASSERT_NULL(list.first);
    TEST_ASSERT_EQUAL_UINT64(0, list.bytes);
    TEST_ASSERT_EQUAL_UINT64(0, list.count);
}

static void add(size_t bytes)
{
    void *data = extent_allocate(bytes);
    TEST_ASSERT_NOT_NULL(data);
    extents_add(&list, data);
}

static void data_are_aligned_and_have_all_bytes(void)
{
    for (size_t bytes = 1; bytes < 300; bytes += 13) {
        uint8_t *data = extent_allocate(bytes);
        TEST_ASSERT_EQUAL_UINT64(0, (uintptr_t)data % EXTENT_ALIGNMENT);
        memset(data, 1, bytes);
        TEST_ASSERT_EQUAL_UINT64(bytes, extent_of(data)->bytes);
        extent_free(data);
    }
    TEST_ASSERT_NULL(extent_allocate(SIZE_MAX));
    extent_free(NULL);
}

static void an_extent_of_the_size_is_taken(void)
{
    for (size_t bytes = 100; bytes <= 300; bytes += 100)
        add(bytes);
    TEST_ASSERT_NULL(extents_take(&list, 150));
    void *data = extents_take(&list, 200);
    TEST_ASSERT_EQUAL_UINT64(200, extent_of(data)->bytes);
    TEST_ASSERT_NULL(extents_take(&list, 200));
    TEST_ASSERT_EQUAL_UINT64(400, list.bytes);
    TEST_ASSERT_EQUAL_UINT64(2, list.count);
    extent_free(data);
}

static void the_search_is_bounded(void)
{
    add(7);
    for (int i = 0; i < EXTENTS_SEARCHED; i++)
        add(8);
    TEST_ASSERT_NULL(extents_take(&list, 7));
    extent_free(extents_take(&list, 8));
    void *data = extents_take(&list, 7);
    TEST_ASSERT_NOT_NULL(data);
    extent_free(data);
}

static void a_list_moves_to_another(void)
{
    struct extents from = {0};
    add(10);
    for (size_t bytes = 1; bytes <= 3; bytes++)
        extents_add(&from, extent_allocate(bytes));
    extents_move(&list, &from);
    TEST_ASSERT_NULL(from.first);
    TEST_ASSERT_EQUAL_UINT64(0, from.bytes);
    TEST_ASSERT_EQUAL_UINT64(16, list.bytes);
    TEST_ASSERT_EQUAL_UINT64(4, list.count);
}

static void a_list_is_trimmed_by_count_and_by_bytes(void)
{
    for (int i = 0; i < 10; i++)
        add(100);
    extents_trim(&list, 7, SIZE_MAX);
    TEST_ASSERT_EQUAL_UINT64(7, list.count);
    extents_trim(&list, SIZE_MAX, 399);
    TEST_ASSERT_EQUAL_UINT64(3, list.count);
    TEST_ASSERT_EQUAL_UINT64(300, list.bytes);
    add(1000);
    extents_trim(&list, SIZE_MAX, 399);
    TEST_ASSERT_EQUAL_UINT64(3, list.count);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(data_are_aligned_and_have_all_bytes);
    RUN_TEST(an_extent_of_the_size_is_taken);
    RUN_TEST(the_search_is_bounded);
    RUN_TEST(a_list_moves_to_another);
    RUN_TEST(a_list_is_trimmed_by_count_and_by_bytes);
    return UNITY_END();
}
