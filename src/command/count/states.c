#include "command/count/states.h"

#include <stdlib.h>

static uint32_t hash_of_item(const void *set, uint32_t number)
{
    uint64_t hash = ((const struct count_states_set *)set)->item[number - 1].hash;
    return (uint32_t)(hash ^ hash >> 32);
}

/* The item searched for is the one after the last. */
static bool is_item(const void *set, uint32_t number)
{
    const struct count_states_set *s = set;
    return s->item[number - 1].hash == s->item[s->count].hash;
}

static bool reserve(struct count_states_set *set)
{
    if (set->count & (set->count + 1))
        return !hash_reserve(&set->table, (uint32_t)set->count, hash_of_item, set);
    struct count_states_item *larger = realloc(set->item, 2 * (set->count + 1) * sizeof *larger);
    if (!larger)
        return false;
    set->item = larger;
    return !hash_reserve(&set->table, (uint32_t)set->count, hash_of_item, set);
}

/* Finds a hash or adds it, in frame 0. Returns null if memory is refused. */
static struct count_states_item *find(struct count_states_set *set, uint64_t hash)
{
    if (!reserve(set))
        return NULL;
    set->item[set->count] = (struct count_states_item){hash, 0};
    uint32_t slot = hash_find(set->table, hash_of_item(set, (uint32_t)set->count + 1), is_item, set);
    uint32_t number = hash_get(set->table, slot);
    if (number)
        return set->item + number - 1;
    hash_set(set->table, slot, (uint32_t)++set->count);
    return set->item + set->count - 1;
}

void count_states_begin_frame(struct count_states *states)
{
    states->frame = (struct count_states_frame){0};
    states->frames++;
    states->last = 0;
}

/* The hash of a unit's key; the key is added to those of its unit. */
static uint64_t note_key(struct count_states *states, enum unit unit, const union key *key)
{
    struct packed_key packed = key_pack(unit, key);
    uint64_t hash = key_hash(unit, &packed);
    states->failed |= !find(&states->keys[unit], hash);
    return hash;
}

void count_states_note(struct count_states *states, const union key key[UNIT_COUNT])
{
    uint64_t hash = 0;
    for (enum unit unit = 0; unit < UNIT_COUNT; unit++)
        hash = (hash ^ note_key(states, unit, &key[unit])) * 0x9e3779b97f4a7c15u;
    struct count_states_item *item = find(&states->sets, hash);
    if (!item) {
        states->failed = true;
        return;
    }
    struct count_states_frame *frame = &states->frame;
    bool changed = hash != states->last;
    frame->draws++;
    frame->changes += changed;
    frame->returns += changed && item->frame == states->frames;
    frame->fresh += !item->frame;
    frame->states += item->frame != states->frames;
    item->frame = states->frames;
    states->last = hash;
}

static void free_set(struct count_states_set *set)
{
    free(set->item);
    free(set->table.slot);
}

void count_states_free(struct count_states *states)
{
    free_set(&states->sets);
    for (enum unit unit = 0; unit < UNIT_COUNT; unit++)
        free_set(&states->keys[unit]);
    *states = (struct count_states){0};
}
