#include "base/hash.h"

#include <stdlib.h>

enum { FIRST_SLOTS = 64 };

static bool is_never(const void *context, uint32_t number)
{
    (void)context;
    (void)number;
    return false;
}

int hash_reserve(struct hash_table *table, uint32_t count, hash_of *hash, const void *context)
{
    size_t slots = table->slot ? (size_t)table->mask + 1 : 0;
    if (2 * ((size_t)count + 1) <= slots)
        return 0;
    slots = slots ? 2 * slots : FIRST_SLOTS;
    struct hash_table larger = {calloc(slots, sizeof(uint32_t)), (uint32_t)(slots - 1), true};
    if (!larger.slot)
        return -1;
    for (uint32_t number = 1; number <= count; number++)
        hash_set(larger, hash_find(larger, hash(context, number), is_never, NULL), number);
    free(table->slot);
    *table = larger;
    return 0;
}
