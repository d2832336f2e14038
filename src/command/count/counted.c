/* A new device plays the frames of a stream once, in order. The keys of its draws are observed, and its cache
 * and its tiers are read at the end. On one thread, and with an engine that does not depend on time, all but
 * the times is the same in each run. */
#include "command/count/counted.h"

#include "base/clock.h"
#include "render/device/device.h"

static void note_draw(void *user, uint64_t number, const union key key[UNIT_COUNT])
{
    (void)number;
    count_states_note(user, key);
}

static int play_frames(struct counted *c, struct triptych_device *device, int (*stop)(void),
                       struct error *error)
{
    struct player *player;
    if (stream_prepare(c->stream, device, &player, error))
        return -1;
    int bad = 0;
    for (unsigned i = 0; i < c->frames && !bad && !stop(); i++) {
        uint64_t start = clock_ns();
        count_states_begin_frame(&c->states);
        bad = player_frame(player, i, error);
        device_finish(device);
        c->frame[i] = (struct count_frame){c->states.frame, (double)(clock_ns() - start) / 1e6};
    }
    player_free(player);
    if (!bad && c->states.failed)
        return error_set(error, "no memory for the states of %u frames", c->frames);
    return bad;
}

static uint64_t load(const uint64_t *value)
{
    return __atomic_load_n(value, __ATOMIC_RELAXED);
}

static void add_tier(const struct routine_tier *tier, struct routine_tier *sum)
{
    sum->engine = tier->engine;
    sum->runs += load(&tier->runs);
    sum->elements += load(&tier->elements);
    sum->build_ns += load(&tier->build_ns);
    sum->builds += __atomic_load_n(&tier->builds, __ATOMIC_RELAXED);
    sum->drops += __atomic_load_n(&tier->drops, __ATOMIC_RELAXED);
    sum->code_bytes += __atomic_load_n(&tier->code_bytes, __ATOMIC_RELAXED);
}

static void read_tiers(struct triptych_device *device, struct routine_tiers *sum)
{
    struct routine routine;
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++)
        for (unsigned t = 0; routine.tiers && t < routine.tiers->count; t++) {
            sum->count = routine.tiers->count;
            add_tier(routine.tiers->tier + t, sum->tier + t);
        }
}

static void add_tracking(const struct routine_tracking *tracking, struct routine_tracking *sum)
{
    sum->draws += tracking->draws;
    sum->burnt_draws += tracking->burnt_draws;
    sum->compared += tracking->compared;
    sum->guards += tracking->guards;
    sum->failures += tracking->failures;
    sum->words += tracking->words;
    sum->variants += tracking->variants;
    sum->burnt += tracking->burnt;
    sum->refused += tracking->refused;
    sum->bytes += tracking->bytes;
}

static void read_tracking(struct counted *c, struct triptych_device *device)
{
    struct routine routine;
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++)
        if (routine.tracking) {
            c->tracked[routine.unit]++;
            add_tracking(routine.tracking, &c->tracking[routine.unit]);
        }
}

static void read_second(struct count_second *sum, struct triptych_device *device)
{
    struct routine routine;
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++)
        if (routine.second) {
            sum->routines++;
            sum->built += routine.second->bytes != 0;
            sum->blocks += __atomic_load_n(&routine.second->blocks, __ATOMIC_RELAXED);
            sum->runs += __atomic_load_n(&routine.second->runs, __ATOMIC_RELAXED);
            sum->bytes += routine.second->bytes;
        }
}

int count_play(struct counted *c, unsigned threads, const struct setting_values *settings, int (*stop)(void),
               struct error *error)
{
    struct triptych_device *device;
    c->budget = c->budget ? c->budget : CACHE_BYTES;
    const struct device_options options = {.threads = threads, .cache_bytes = c->budget, .measure = true};
    if (device_create(c->engine, &options, &device, error) != TRIPTYCH_OK)
        return -1;
    device_set_settings(device, settings);
    device_on_draw(device, note_draw, &c->states);
    int bad = play_frames(c, device, stop, error);
    device_count_hits(device);
    c->cache = cache_statistics(device->cache);
    read_tiers(device, &c->tiers);
    read_tracking(c, device);
    read_second(&c->second, device);
    device_destroy(device);
    return bad;
}
