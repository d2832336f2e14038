/* Memory in large pages, if the system has them. A first touch of the whole block, as by a clear, then costs
 * one page fault for 2 MiB instead of 512, and accesses need fewer TLB entries. */
#ifndef MACHINE_LARGE_H
#define MACHINE_LARGE_H

#include <stddef.h>

/* Allocates at least `bytes`, aligned to a cache line; free it with free(). Returns null if memory is short.
 */
void *large_allocate(size_t bytes);

#endif
