/* Prefetch for writing: the line arrives without a copy in other cores' caches, which a store would have to
 * invalidate.
 *
 * Source: AMD64 Architecture Programmer's Manual volume 3, PREFETCHW. Intel processors without it ignore it
 * (SDM volume 2). Compilers emit it in baseline code only with a flag, hence the assembly. */
#ifndef MACHINE_PREFETCH_H
#define MACHINE_PREFETCH_H

#include <stddef.h>

enum { PREFETCH_LINE = 64 };

/* Prefetches the lines of `bytes` from `from` on. The memory need not be mapped. */
static inline void prefetch_to_write(const void *from, size_t bytes)
{
    const char *at = from;
    for (size_t i = 0; i < bytes; i += PREFETCH_LINE)
        __asm__ volatile("prefetchw %0" : : "m"(at[i]));
}

#endif
