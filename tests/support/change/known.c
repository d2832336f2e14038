#include "known.h"

#include "contract/key_query.h"

#include <stdlib.h>
#include <unity.h>

struct known *known_keys;

size_t known_count;
static size_t known_room;

static uint32_t *slot; /* by the key's hash: 1 + an index of `known`, or 0 */

static size_t slots;

static void insert_slot(uint32_t index)
{
    size_t at = key_hash(known_keys[index].unit, &known_keys[index].packed) & (slots - 1);
    while (slot[at])
        at = (at + 1) & (slots - 1);
    slot[at] = index + 1;
}

static void grow_known(void)
{
    known_room = known_room ? 2 * known_room : 4096;
    slots = 4 * known_room;
    known_keys = realloc(known_keys, known_room * sizeof *known_keys);
    free(slot);
    slot = calloc(slots, sizeof *slot);
    TEST_ASSERT_TRUE(known_keys && slot);
    for (uint32_t i = 0; i < known_count; i++)
        insert_slot(i);
}

static bool is_known(enum unit unit, const struct packed_key *packed)
{
    size_t at = key_hash(unit, packed) & (slots - 1);
    for (; slot[at]; at = (at + 1) & (slots - 1))
        if (known_keys[slot[at] - 1].unit == unit && key_equal(&known_keys[slot[at] - 1].packed, packed))
            return true;
    return false;
}

void known_remember(const struct derived *d)
{
    for (int u = 0; u < UNIT_COUNT; u++) {
        if (known_count == known_room)
            grow_known();
        if (is_known(u, &d->packed[u]))
            continue;
        known_keys[known_count] = (struct known){.unit = u, .packed = d->packed[u], .key = d->key[u]};
        insert_slot((uint32_t)known_count++);
    }
}

void known_free(void)
{
    free(known_keys);
    free(slot);
}
