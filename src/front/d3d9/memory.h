/* The memory that a program can reach: objects, whose addresses are COM pointers, and what Lock returns.
 * The host provides it, because a program in another process reaches it by the same addresses. */
#ifndef D3D9_MEMORY_H
#define D3D9_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

struct d3d9_memory_host {
    void *(*allocate)(size_t bytes); /* aligned to 64 bytes, zeros; null: none is left */
    void (*free)(void *);
};

/* Selects the host before the first allocation. Without a call it is the C library's memory. */
void d3d9_memory_set_host(const struct d3d9_memory_host *);
/* Returns true if a host was selected: the program is another process, whose other memory cannot be
 * reached. */
bool d3d9_memory_is_shared(void);
/* Returns `bytes` bytes of zeros, aligned to 64 bytes; null if none are left. */
void *d3d9_memory_allocate(size_t bytes);
/* Null is allowed. */
void d3d9_memory_free(void *);

#endif
