#include "fence.h"

#include <sys/mman.h>
#include <unistd.h>

static size_t round_to_pages(size_t bytes)
{
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    return (bytes + page - 1) / page * page;
}

uint8_t *fence(size_t bytes)
{
    size_t room = round_to_pages(bytes), page = round_to_pages(1);
    uint8_t *start = mmap(NULL, room + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED)
        return NULL;
    if (mprotect(start + room, page, PROT_NONE)) {
        munmap(start, room + page);
        return NULL;
    }
    return start + room - bytes;
}

void unfence(uint8_t *memory, size_t bytes)
{
    size_t room = round_to_pages(bytes);
    if (memory)
        munmap(memory + bytes - room, room + round_to_pages(1));
}
