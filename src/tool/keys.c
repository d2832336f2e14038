/* A device whose engine draws nothing plays the stream and tells the keys of each draw that it records. */
#include "tool/keys.h"

#include "draw/device.h"
#include "shader/program.h"

#include <stdlib.h>
#include <string.h>

enum { NOTHING = UINT32_MAX };

/* An engine whose vertices are all outside of the same side: nothing gets as far as setup. */
static void run_nothing(const void *call, const struct routine *routine)
{
    const struct vertex_call *vertices = call;
    if (routine->unit != UNIT_VERTEX)
        return;
    for (uint32_t i = 0; i < VERTEX_CAPACITY; i++) {
        int32_t code = CLIP_LEFT;
        memcpy((char *)vertices->out + SLOT_CODE * VERTEX_SLOT_BYTES + i * sizeof code, &code, sizeof code);
    }
}

static const char *always_there(void)
{
    return NULL;
}

static struct routine *build_nothing(struct code_arena *arena, enum unit unit, const union key *key,
                                     struct error *error);

static void free_nothing(struct code_arena *arena, struct routine *routine)
{
    (void)arena;
    free(routine);
}

static const struct engine engine_nothing = {
    .name = "nothing",
    .description = "finds keys",
    .width = 4,
    .without_arena = 1,
    .unavailable = always_there,
    .build = build_nothing,
    .free = free_nothing,
};

static struct routine *build_nothing(struct code_arena *arena, enum unit unit, const union key *key,
                                     struct error *error)
{
    struct routine *routine = calloc(1, sizeof *routine);
    (void)arena;
    if (!routine) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    routine->engine = &engine_nothing;
    routine->run = run_nothing;
    routine->unit = unit;
    routine->key = *key;
    return routine;
}

/* Room for one more; the array doubles. */
static bool reserve(void *array, size_t size, size_t count)
{
    void **at = array;
    if (count & (count - 1))
        return true;
    void *larger = realloc(*at, (count ? 2 * count : 1) * size);
    if (larger)
        *at = larger;
    return larger;
}

/* Room for one more number in an index; `hash_of` tells where those it has are. */
static bool reserve_index(struct key_index *index, size_t count, const struct keys *c,
                          uint64_t (*hash_of)(const struct keys *, size_t))
{
    if (2 * (count + 1) <= index->slots)
        return true;
    size_t slots = index->slots ? 2 * index->slots : 64;
    uint32_t *slot = malloc(slots * sizeof *slot);
    if (!slot)
        return false;
    memset(slot, 0xff, slots * sizeof *slot);
    for (size_t i = 0; i < count; i++) {
        size_t at = hash_of(c, i) & (slots - 1);
        while (slot[at] != NOTHING)
            at = (at + 1) & (slots - 1);
        slot[at] = (uint32_t)i;
    }
    free(index->slot);
    *index = (struct key_index){slot, slots};
    return true;
}

static uint64_t hash_of_found(const struct keys *c, size_t i)
{
    return key_hash(c->found[i].unit, &c->found[i].packed);
}

static uint64_t hash_of_set(const struct keys *c, size_t i)
{
    const uint32_t *routine = c->set[i].routine;
    uint64_t hash = routine[0];
    for (int unit = 1; unit < UNIT_COUNT; unit++)
        hash = (hash ^ routine[unit]) * 0x9e3779b97f4a7c15ull;
    return hash ^ hash >> 32;
}

/* The program that a key numbers, held; null if there is none. */
static const struct program *hold_program(enum unit unit, const union key *key)
{
    const struct program *program = key_shader(unit, key);
    return program ? program_hold(program->number) : NULL;
}

/* The routine's number, a new one if it was not seen before. */
static uint32_t note_routine(struct keys *c, enum unit unit, const union key *key)
{
    if (!reserve(&c->found, sizeof *c->found, c->count) ||
        !reserve_index(&c->routines, c->count, c, hash_of_found))
        return c->failed = true, 0;
    struct key_found *found = c->found + c->count;
    *found = (struct key_found){.unit = unit, .key = *key, .packed = key_pack(unit, key)};
    size_t at = hash_of_found(c, c->count) & (c->routines.slots - 1);
    for (; c->routines.slot[at] != NOTHING; at = (at + 1) & (c->routines.slots - 1)) {
        const struct key_found *other = c->found + c->routines.slot[at];
        if (other->unit == unit && key_equal(&other->packed, &found->packed))
            return c->routines.slot[at];
    }
    found->program = hold_program(unit, key);
    c->routines.slot[at] = (uint32_t)c->count;
    return (uint32_t)c->count++;
}

static void note_draw(void *user, uint64_t number, const union key key[UNIT_COUNT])
{
    struct keys *c = user;
    struct key_set set;
    (void)number;
    for (int unit = 0; unit < UNIT_COUNT; unit++)
        set.routine[unit] = note_routine(c, unit, &key[unit]);
    if (c->failed || !reserve(&c->set, sizeof *c->set, c->sets) ||
        !reserve_index(&c->draws, c->sets, c, hash_of_set)) {
        c->failed = true;
        return;
    }
    c->set[c->sets] = set;
    size_t at = hash_of_set(c, c->sets) & (c->draws.slots - 1);
    for (; c->draws.slot[at] != NOTHING; at = (at + 1) & (c->draws.slots - 1))
        if (!memcmp(&c->set[c->draws.slot[at]], &set, sizeof set))
            return;
    c->draws.slot[at] = (uint32_t)c->sets++;
}

static int play(struct triptych_device *device, const struct stream *stream, int (*stop)(void),
                struct error *error)
{
    struct player *player;
    if (stream_prepare(stream, device, &player, error))
        return -1;
    int bad = 0;
    for (uint32_t i = 0; i < stream->frame_count && !bad && !(stop && stop()); i++)
        bad = player_frame(player, i, error);
    player_free(player);
    return bad;
}

int keys_collect(struct keys *keys, const struct stream *stream, int (*stop)(void), struct error *error)
{
    const struct device_options options = {.threads = 1};
    struct triptych_device *device;
    if (device_create(&engine_nothing, &options, &device, error) != TRIPTYCH_OK)
        return -1;
    device_on_draw(device, note_draw, keys);
    int bad = play(device, stream, stop, error);
    device_destroy(device);
    if (!bad && keys->failed)
        return error_set(error, "no memory for the keys of %zu routines", keys->count);
    return bad;
}

void keys_free(struct keys *keys)
{
    for (size_t i = 0; i < keys->count; i++)
        if (keys->found[i].program)
            program_release(keys->found[i].program);
    free(keys->found);
    free(keys->set);
    free(keys->routines.slot);
    free(keys->draws.slot);
    *keys = (struct keys){0};
}
