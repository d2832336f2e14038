/* The memory of one call of a routine as a file: the head, the pointers, the bytes. All are little-endian. */
#ifndef TESTS_SUPPORT_PORTABLE_IMAGE_H
#define TESTS_SUPPORT_PORTABLE_IMAGE_H

#include <stdint.h>

struct image_head {
    uint64_t bytes, pointers;
    uint64_t call; /* offset of the arguments */
    uint64_t result, result_bytes;
};

/* The eight bytes at `at` are the address of byte `to`. */
struct image_pointer {
    uint64_t at, to;
};

#endif
