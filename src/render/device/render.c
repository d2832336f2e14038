/* When the queue is rendered.
 *
 *   device_finish   now, with all threads, because the caller reads the target or changes what draws use
 *   device_start    from now on, in the background, because the buffer is full; the other one is filled
 *                   meanwhile
 *
 * At most one buffer is rendered at a time. The routines, constants, palettes and retired storage of its
 * draws are released when it is known to be rendered: when the next one begins, or when the device's thread
 * waits for it. Only the device's thread does this. */
#include "render/device/device_part.h"

#include <stdlib.h>
#include <string.h>

/* Waits for what is rendered in the background. */
static void await_rendered(struct triptych_device *device)
{
    if (!device->rendered.commands)
        return;
    queue_wait(device->queue);
    queries_rendered(&device->queries, device->queue->round.passed, device->rendered.commands);
    for (uint32_t i = 0; i < device->rendered.held_count; i++)
        cache_let_go(device->cache, device->rendered.held[i].routine);
    cache_trim(device->cache);
    device_free_palettes(device->rendered.palettes);
    device_reuse_storage(device, &device->rendered.retired);
    device->rendered.palettes = NULL;
    device_free_released(device->rendered.released);
    device->rendered.released = NULL;
    device->rendered.held_count = device->rendered.commands = 0;
}

/* Empties the queue, after its draws are rendered or dropped. */
static void empty(struct triptych_device *device)
{
    device_routines_let_go(&device->routines, device->cache, 0, device->derived.now->draw.routine);
    device->derived.now->draw.job = NULL;
    device->queue->commands.count = device->queue->commands.jobs = 0;
    constants_reset(&device->constants);
    transient_reset(&device->transient);
    device_reuse_storage(device, &device->resources.retired);
    device_free_palettes(device_derived_take_palettes(&device->derived));
    device_free_released(device->released);
    device->released = NULL;
    device->epoch++;
}

void device_finish(struct triptych_device *device)
{
    struct queue *queue = device->queue;
    uint32_t commands = queue->commands.count;
    await_rendered(device);
    if (commands)
        queue_render(queue);
    queries_rendered(&device->queries, queue->round.passed, commands);
    empty(device);
}

void device_forget(struct triptych_device *device)
{
    await_rendered(device);
    empty(device);
}

void device_start(struct triptych_device *device)
{
    struct queue *queue = device->queue;
    uint32_t commands = queue->commands.count;
    if (!commands || !queue_has_threads(queue)) {
        queue_could_start(queue);
        device_finish(device);
        return;
    }
    await_rendered(device);
    queue_start(queue);
    device_routines_count_hits(&device->routines, device->cache);
    device->rendered.held_count = device->routines.count;
    device->rendered.held = device_routines_exchange(&device->routines);
    device->rendered.commands = commands;
    device->rendered.palettes = device_derived_take_palettes(&device->derived);
    device->rendered.released = device->released;
    device->released = NULL;
    memset(device->derived.now->draw.routine, 0, sizeof device->derived.now->draw.routine);
    device->derived.now->draw.job = NULL;
    constants_exchange(&device->constants);
    transient_exchange(&device->transient);
    if (device->state.immediate)
        device_state_changed(device, CHANGE_OF_STREAM);
    extents_move(&device->rendered.retired, &device->resources.retired);
    device->epoch++;
}

void device_flush(struct triptych_device *device)
{
    if (!device->rendered.commands || !pool_is_busy(device->pool))
        device_start(device);
}

bool device_uses(const struct triptych_device *device, const struct triptych_texture *texture)
{
    return device_epoch_is_queued(device, texture->epoch);
}

uint32_t device_commands(const struct triptych_device *device)
{
    return device->rendered.commands + device->queue->commands.count;
}

void device_limit_threads(struct triptych_device *device, unsigned threads)
{
    await_rendered(device);
    pool_limit(device->pool, threads);
}

/* Textures that exist are ordered again: tools set settings after a stream has made its textures. */
static void order_textures(struct triptych_device *device, bool tiled)
{
    device_finish(device);
    for (struct triptych_texture *texture = device->resources.textures; texture; texture = texture->next)
        texture_set_order(texture, tiled);
    device->resources.tiled = tiled;
    device_state_changed(device, PARTS_ALL);
}

void device_set_settings(struct triptych_device *device, const struct setting_values *settings)
{
    bool tiled = settings->of[SETTING_texels] == SETTING_texels_tiles;
    bool quad_rows =
        settings->of[SETTING_target] == SETTING_target_rows && queue_reserve_views(device->queue);
    await_rendered(device);
    if (tiled != device->resources.tiled)
        order_textures(device, tiled);
    if (quad_rows != device->resources.quad_rows)
        device_order_targets(device, quad_rows);
    queue_set_settings(device->queue, settings);
    cache_evict_by(device->cache, (enum setting_replace)settings->of[SETTING_replace]);
    device->spans = (enum setting_spans)settings->of[SETTING_spans];
    device->state.late_tests = settings->of[SETTING_depth] == SETTING_depth_late;
    device_state_changed(device, PARTS_ALL);
}

void device_shuffle(struct triptych_device *device, uint64_t seed)
{
    await_rendered(device);
    queue_shuffle(device->queue, seed);
}
