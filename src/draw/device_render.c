/* When what is recorded is rendered.
 *
 *   device_finish   now, with all threads, because somebody asks for what is drawn or changes what draws use
 *   device_start    from now on, in the background, because the queue is full: recording goes on in the other queue
 *
 * No more than one queue is rendered at a time. What its draws use, routines, constants and palettes, is let go of when it
 * is known to be rendered: when the next one begins, or somebody waits. All that is done by the device's thread. */
#include "draw/device.h"

#include <stdlib.h>
#include <string.h>

static void free_palettes(struct palette *palette)
{
    for (struct palette *next; palette; palette = next) {
        next = palette->next;
        free(palette);
    }
}

/* Takes away what draws used that are or will be rendered; the newest palette is the job's. */
static struct palette *take_palettes(struct triptych_device *device)
{
    struct palette *palettes = device->palettes ? device->palettes->next : NULL;
    if (device->palettes)
        device->palettes->next = NULL;
    return palettes;
}

/* Waits for what is rendered in the background. */
static void await_rendered(struct triptych_device *device)
{
    if (!device->rendered.commands)
        return;
    frame_wait(device->frame);
    queries_rendered(&device->queries, device->frame->passed, device->rendered.commands);
    for (uint32_t i = 0; i < device->rendered.held_count; i++)
        cache_release(device->cache, device->rendered.held[i].routine);
    free_palettes(device->rendered.palettes);
    device->rendered.palettes = NULL;
    device->rendered.held_count = device->rendered.commands = 0;
}

/* Empties the queue, whose draws are rendered or not wanted. */
static void empty(struct triptych_device *device)
{
    device_let_go(device, 0);
    device->draw.job = NULL;
    device->frame->commands = device->frame->jobs = 0;
    constants_reset(&device->constants);
    free_palettes(take_palettes(device));
    device->recording++;
}

void device_finish(struct triptych_device *device)
{
    struct frame *frame = device->frame;
    uint32_t commands = frame->commands;
    await_rendered(device);
    if (commands)
        frame_render(frame, &device->target);
    queries_rendered(&device->queries, frame->passed, commands);
    empty(device);
}

void device_forget(struct triptych_device *device)
{
    await_rendered(device);
    empty(device);
}

void device_start(struct triptych_device *device)
{
    struct frame *frame = device->frame;
    uint32_t commands = frame->commands;
    if (!commands || !frame_has_threads(frame)) {
        device_finish(device);
        return;
    }
    await_rendered(device);
    frame_start(frame, &device->target);
    struct held *held = device->rendered.held;
    device_count_hits(device);
    device->rendered.held = device->held;
    device->rendered.held_count = device->held_count;
    device->rendered.commands = commands;
    device->rendered.palettes = take_palettes(device);
    device->held = held;
    device->held_count = 0;
    memset(device->draw.routine, 0, sizeof device->draw.routine);
    device->draw.job = NULL;
    constants_exchange(&device->constants);
    device->recording++;
}

bool device_uses(const struct triptych_device *device, const struct triptych_texture *texture)
{
    return texture->recording == device->recording ||
           (device->rendered.commands && texture->recording == device->recording - 1);
}

uint32_t device_commands(const struct triptych_device *device)
{
    return device->rendered.commands + device->frame->commands;
}

void device_limit_threads(struct triptych_device *device, unsigned threads)
{
    await_rendered(device);
    pool_limit(device->pool, threads);
}

void device_shuffle(struct triptych_device *device, uint64_t seed)
{
    await_rendered(device);
    device->frame->shuffle = seed;
}
