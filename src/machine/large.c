#define _GNU_SOURCE /* madvise */
#include "machine/large.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/mman.h>

enum { LARGE = 2 << 20, LINE = 64, SHARE = 4 };

/* Rounds up to whole large pages if that wastes at most one byte in SHARE. */
static size_t rounded(size_t bytes)
{
    size_t whole = (bytes + LARGE - 1) & ~(size_t)(LARGE - 1);
    return whole - bytes <= bytes / SHARE ? whole : (bytes + LINE - 1) & ~(size_t)(LINE - 1);
}

void *large_allocate(size_t bytes)
{
    if (bytes < LARGE)
        return aligned_alloc(LINE, (bytes + LINE - 1) & ~(size_t)(LINE - 1));
    size_t size = rounded(bytes);
    void *memory;
    int reason = posix_memalign(&memory, LARGE, size); /* any size, unlike aligned_alloc */
    if (reason)
        memory = NULL;
    else
        madvise(memory, size & ~(size_t)(LARGE - 1), MADV_HUGEPAGE); /* the kernel may reject this advice */
    errno = reason;
    return memory;
}
