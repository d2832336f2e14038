#include "state.h"

size_t misses_fifo(const struct key *draws, size_t count, size_t room)
{
    (void)draws;
    (void)room;
    return count;
}

size_t misses_lru(const struct key *draws, size_t count, size_t room)
{
    (void)draws;
    (void)room;
    return count;
}
