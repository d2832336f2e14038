#include "memory.h"
#include <stdlib.h>
#include <string.h>

static void *allocate(size_t bytes)
{
    enum { ALIGNMENT = 64 };
    size_t whole = (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    void *memory = whole < bytes ? NULL : aligned_alloc(ALIGNMENT, whole ? whole : ALIGNMENT);
    return memory ? memset(memory, 0, whole) : NULL;
}

static struct d3d9_memory_host host = {allocate, free};

void d3d9_memory_set_host(const struct d3d9_memory_host *with)
{
    host = *with;
}

bool d3d9_memory_is_shared(void)
{
    return host.allocate != allocate;
}

void *d3d9_memory_allocate(size_t bytes)
{
    return host.allocate(bytes);
}

void d3d9_memory_free(void *memory)
{
    if (memory)
        host.free(memory);
}
