/* A device with an engine that draws nothing plays the stream and reports the keys of each recorded draw. */
#include "command/list/keys.h"

#include "render/device/device.h"
#include "shader/program/program.h"

#include <stdlib.h>
#include <string.h>

/* An engine whose vertices are all outside the same clip plane, so that no triangle reaches setup. */
static void run_nothing(const void *call, const struct routine *routine)
{
    const struct vertex_arguments *vertices = call;
    if (routine->unit != UNIT_VERTEX)
        return;
    for (uint32_t i = 0; i < VERTEX_CAPACITY; i++) {
        int32_t code = CLIP_LEFT;
        memcpy((char *)vertices->out + SLOT_CODE * VERTEX_SLOT_BYTES + i * sizeof code, &code, sizeof code);
    }
}

static void free_nothing(struct code_arena *arena, struct routine *routine)
{
    (void)arena;
    free(routine);
}

static struct routine *build_nothing(const struct engine *self, struct code_arena *arena, enum unit unit,
                                     const union key *key, struct error *error)
{
    struct routine *routine = calloc(1, sizeof *routine);
    (void)arena;
    if (!routine) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    routine->engine = self;
    routine->run = run_nothing;
    routine->unit = unit;
    routine->key = *key;
    return routine;
}

static const struct engine engine_nothing = {
    .name = "nothing",
    .description = "finds keys",
    .width = 4,
    .without_arena = true,
    .build = build_nothing,
    .free = free_nothing,
};

/* Makes room for one more element; the capacity doubles. */
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

static uint32_t hash_of_found(const void *keys, uint32_t number)
{
    const struct key_found *found = &((const struct keys *)keys)->found[number - 1];
    return (uint32_t)key_hash(found->unit, &found->packed);
}

static bool is_found(const void *keys, uint32_t number)
{
    const struct keys *c = keys;
    const struct key_found *other = &c->found[number - 1], *wanted = &c->found[c->count];
    return other->unit == wanted->unit && key_equal(&other->packed, &wanted->packed);
}

static uint32_t hash_of_set(const void *keys, uint32_t number)
{
    const uint32_t *routine = ((const struct keys *)keys)->set[number - 1].routine;
    uint64_t hash = routine[0];
    for (int unit = 1; unit < UNIT_COUNT; unit++)
        hash = (hash ^ routine[unit]) * 0x9e3779b97f4a7c15ull;
    return (uint32_t)(hash ^ hash >> 32);
}

static bool is_set(const void *keys, uint32_t number)
{
    const struct keys *c = keys;
    return !memcmp(&c->set[number - 1], &c->set[c->sets], sizeof c->set[0]);
}

/* Holds the program that the key numbers. Returns null if there is none. */
static const struct program *hold_program(enum unit unit, const union key *key)
{
    const struct program *program = key_shader(unit, key);
    return program ? program_hold(program->number) : NULL;
}

/* Returns the routine's index. Adds the routine if it is new. */
static uint32_t note_routine(struct keys *c, enum unit unit, const union key *key)
{
    if (!reserve(&c->found, sizeof *c->found, c->count) ||
        hash_reserve(&c->routines, (uint32_t)c->count, hash_of_found, c))
        return c->failed = true, 0;
    struct key_found *found = c->found + c->count;
    *found = (struct key_found){.unit = unit, .key = *key, .packed = key_pack(unit, key)};
    uint32_t slot = hash_find(c->routines, hash_of_found(c, (uint32_t)c->count + 1), is_found, c);
    uint32_t number = hash_get(c->routines, slot);
    if (number)
        return number - 1;
    found->program = hold_program(unit, key);
    hash_set(c->routines, slot, (uint32_t)c->count + 1);
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
        hash_reserve(&c->draws, (uint32_t)c->sets, hash_of_set, c)) {
        c->failed = true;
        return;
    }
    c->set[c->sets] = set;
    uint32_t slot = hash_find(c->draws, hash_of_set(c, (uint32_t)c->sets + 1), is_set, c);
    if (!hash_get(c->draws, slot))
        hash_set(c->draws, slot, (uint32_t)++c->sets);
}

static int play(struct triptych_device *device, const struct stream *stream, uint32_t frames,
                int (*stop)(void), struct error *error)
{
    struct player *player;
    if (stream_prepare(stream, device, &player, error))
        return -1;
    int bad = 0;
    for (uint32_t i = 0; i < frames && !bad && !(stop && stop()); i++)
        bad = player_frame(player, i, error);
    player_free(player);
    return bad;
}

static int collect(struct keys *keys, const struct stream *stream, uint32_t frames, int (*stop)(void),
                   struct error *error)
{
    const struct device_options options = {.threads = 1};
    struct triptych_device *device;
    if (device_create(&engine_nothing, &options, &device, error) != TRIPTYCH_OK)
        return -1;
    device_on_draw(device, note_draw, keys);
    int bad = play(device, stream, frames, stop, error);
    device_destroy(device);
    if (!bad && keys->failed)
        return error_set(error, "no memory for the keys of %zu routines", keys->count);
    return bad;
}

int keys_collect(struct keys *keys, const struct stream *stream, int (*stop)(void), struct error *error)
{
    return collect(keys, stream, stream->frame_count, stop, error);
}

int keys_collect_first(struct keys *keys, const struct stream *stream, struct error *error)
{
    return collect(keys, stream, stream->frame_count ? 1 : 0, NULL, error);
}

size_t keys_index(const struct keys *keys, const struct key_found *routine)
{
    for (size_t i = 0; i < keys->count; i++)
        if (keys->found[i].unit == routine->unit && key_equal(&keys->found[i].packed, &routine->packed))
            return i;
    return keys->count;
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
