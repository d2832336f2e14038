/* Compares large memory. Unity compares bytes one by one, and reports the first that differs. */
#ifndef TESTS_SUPPORT_SYSTEM_BYTES_H
#define TESTS_SUPPORT_SYSTEM_BYTES_H

#include <string.h>
#include <unity.h>

#define TEST_ASSERT_SAME_BYTES(expected, got, bytes, what)                                                   \
    do {                                                                                                     \
        if (memcmp(expected, got, bytes))                                                                    \
            TEST_ASSERT_EQUAL_MEMORY_MESSAGE(expected, got, bytes, what);                                    \
    } while (0)

#endif
