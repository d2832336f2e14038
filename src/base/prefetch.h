/* Asking for cache lines that will be written: they come without a copy left in other cores' caches, which a store would
 * have to wait for.
 *
 * Source: AMD64 Architecture Programmer's Manual volume 3, PREFETCHW; processors of Intel that do not have it do nothing
 * (SDM volume 2). Compilers take it for baseline code only where they are told to. */
#ifndef BASE_PREFETCH_H
#define BASE_PREFETCH_H

#include <stddef.h>

enum { PREFETCH_LINE = 64 };

/* The lines of `bytes` from there on, which need not be there. */
static inline void prefetch_to_write(const void *from, size_t bytes)
{
    const char *at = from;
    for (size_t i = 0; i < bytes; i += PREFETCH_LINE)
        __asm__ volatile("prefetchw %0" : : "m"(at[i]));
}

#endif
