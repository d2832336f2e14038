/* Hash tables of numbers, by open addressing with linear probing.
 *
 * The items are in the caller's array. The table has their numbers, from 1; a slot of 0 is free. A slot has
 * 16 bits if numbers are small and clearing the table costs more than searching it, else 32. The caller
 * compares items, so hashes are not stored. At most half of the slots should be used.
 *
 * Calls are inlined with their comparison and their width, so a search costs the same as a loop written for
 * the item. */
#ifndef BASE_HASH_H
#define BASE_HASH_H

#include <stdbool.h>
#include <stdint.h>

struct hash_table {
    void *slot;
    uint32_t mask; /* slots - 1; slots are a power of two */
    bool wide;     /* a slot is uint32_t, else uint16_t */
};

/* Returns true if the item of that number is the one searched for. */
typedef bool hash_is(const void *context, uint32_t number);

/* The least power of two that is at least twice `count`, and at least `least`, itself a power of two. */
static inline uint32_t hash_slots(uint32_t count, uint32_t least)
{
    uint32_t slots = least;
    while (slots < 2 * count)
        slots *= 2;
    return slots;
}

/* The number in a slot; 0: none. */
static inline uint32_t hash_get(struct hash_table table, uint32_t slot)
{
    return table.wide ? ((const uint32_t *)table.slot)[slot] : ((const uint16_t *)table.slot)[slot];
}

static inline void hash_set(struct hash_table table, uint32_t slot, uint32_t number)
{
    if (table.wide)
        ((uint32_t *)table.slot)[slot] = number;
    else
        ((uint16_t *)table.slot)[slot] = (uint16_t)number;
}

/* The slot of the item searched for, or the free slot where its number belongs. One slot at least is free. */
__attribute__((always_inline)) static inline uint32_t hash_find(struct hash_table table, uint32_t hash,
                                                                hash_is *is, const void *context)
{
    uint32_t slot = hash & table.mask, number;
    while ((number = hash_get(table, slot)) && !is(context, number))
        slot = (slot + 1) & table.mask;
    return slot;
}

/* --- Tables that grow: wide ones, whose slots are allocated --- */

typedef uint32_t hash_of(const void *context, uint32_t number);

/* Makes room for one more item besides numbers 1 to `count`, which the table must hold. An empty table is
 * {0}. Returns 0, or -1 with the table unchanged if memory is refused. Release it with free(table->slot). */
int hash_reserve(struct hash_table *table, uint32_t count, hash_of *hash, const void *context);

#endif
