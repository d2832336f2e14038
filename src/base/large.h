/* Memory in large pages where the system has them: what is touched for the first time all at once, as a target is when it
 * is cleared, costs a page fault for 2 MiB instead of 512 of them, and fewer entries of the TLB for ever after. */
#ifndef BASE_LARGE_H
#define BASE_LARGE_H

#include <stddef.h>

/* At least so many bytes, aligned to a cache line; null when memory is short. To be freed with free(). */
void *large_allocate(size_t bytes);

#endif
