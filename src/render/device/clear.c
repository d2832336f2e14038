/* The device's clears: checked, cut to the pixels that they may change, and recorded. */
#include "base/minmax.h"
#include "contract/lane.h"
#include "machine/mxcsr.h"
#include "render/derive/derive.h"
#include "render/device/device_part.h"

#include <float.h>

/* --- Areas --- */

static bool is_empty(const struct rectangle *r)
{
    return r->x0 >= r->x1 || r->y0 >= r->y1;
}

/* The end of a side, at most `end`. */
static int32_t cut_side(unsigned from, unsigned length, int32_t end)
{
    uint64_t to = (uint64_t)from + length;
    return to < (uint64_t)end ? (int32_t)to : end;
}

static struct rectangle cut(const struct triptych_rectangle *r, const struct rectangle *area)
{
    return (struct rectangle){max_i32((int32_t)min_u32(r->x, TARGET_SIZE_MAXIMUM), area->x0),
                              max_i32((int32_t)min_u32(r->y, TARGET_SIZE_MAXIMUM), area->y0),
                              cut_side(r->x, r->width, area->x1), cut_side(r->y, r->height, area->y1)};
}

/* Moves up to CLEAR_PARTS of the rectangles to `parts`, cut to the area and without those that are empty
 * then. Returns their number. */
static uint32_t take_parts(const struct triptych_rectangle **next, const struct triptych_rectangle *end,
                           const struct rectangle *area, struct rectangle parts[CLEAR_PARTS])
{
    uint32_t count = 0;
    for (; *next < end && count < CLEAR_PARTS; (*next)++) {
        parts[count] = cut(*next, area);
        count += !is_empty(&parts[count]);
    }
    return count;
}

static struct rectangle area_of(const struct rectangle *parts, uint32_t count)
{
    struct rectangle all = parts[0];
    for (uint32_t i = 1; i < count; i++)
        all = (struct rectangle){min_i32(all.x0, parts[i].x0), min_i32(all.y0, parts[i].y0),
                                 max_i32(all.x1, parts[i].x1), max_i32(all.y1, parts[i].y1)};
    return all;
}

/* --- Values --- */

/* Not inlined: the compiler may move arithmetic over a change of MXCSR, but not a call. The pipeline has
 * neither denormals nor -0 in depth. */
__attribute__((noinline)) static void encode(const struct target *target,
                                             const struct triptych_clear_values *values, struct clear *clear)
{
    if (clear->set_color)
        target_clear_words(target, values->color, clear->color);
    if (values->flags & TRIPTYCH_CLEAR_DEPTH)
        clear->depth = depth_encode(target->depth_format, values->depth >= FLT_MIN ? values->depth : 0);
}

/* A clear of no area yet. */
static struct clear make_clear(const struct target *target, const struct triptych_clear_values *values)
{
    enum triptych_depth_format format = target->depth_format;
    bool color = values->flags & TRIPTYCH_CLEAR_COLOR && values->color_mask;
    struct clear clear = {.set_color = color, .kept_channels = 15 & ~values->color_mask};
    unsigned saved = mxcsr_enter();
    encode(target, values, &clear);
    mxcsr_leave(saved);
    if (values->flags & TRIPTYCH_CLEAR_DEPTH)
        clear.depth_mask = depth_mask(format);
    if (values->flags & TRIPTYCH_CLEAR_STENCIL) {
        uint32_t mask = values->stencil_mask & stencil_mask(format);
        clear.depth |= values->stencil & mask;
        clear.depth_mask |= mask;
    }
    return clear;
}

/* --- Commands --- */

static void record(struct triptych_device *device, const struct clear *clear)
{
    device_note_drawn(device,
                      (clear->set_color ? TARGET_DEPTH - 1 : 0) | (clear->depth_mask ? TARGET_DEPTH : 0));
    struct command *command = device_next_command(device);
    command->kind = COMMAND_CLEAR;
    command->clear = *clear;
    for (int kind = 0; kind < CLEAR_KINDS; kind++)
        if (clear->merge[kind]) {
            cache_retain(device->cache, clear->merge[kind]);
            device_routines_keep(&device->routines, clear->merge[kind]);
        }
    device->queue->commands.count++;
}

/* Records a clear of parts, whose memory lasts until it is rendered. */
static void record_parts(struct triptych_device *device, struct clear *clear, const struct rectangle *parts,
                         uint32_t count)
{
    clear->area = area_of(parts, count);
    clear->parts = NULL;
    if (count > 1) {
        size_t bytes = target_clear_bytes(parts, count);
        void *memory = queue_next(device->queue) ? constants_take(&device->constants, bytes) : NULL;
        if (!memory) {
            device_start(device);
            memory = constants_take(&device->constants, bytes);
        }
        target_clear_sort(parts, count, memory);
        clear->parts = memory;
    }
    record(device, clear);
}

static enum triptych_result check(const struct triptych_device *device,
                                  const struct triptych_clear_values *values, struct error *error)
{
    enum triptych_result result = device_has_target(device, error);
    return result == TRIPTYCH_OK ? state_check_clear(device->state.depth_format, values, error) : result;
}

enum triptych_result device_clear(struct triptych_device *device, const struct triptych_clear_values *values,
                                  const struct triptych_rectangle *rectangles, unsigned count,
                                  struct error *error)
{
    enum triptych_result result = check(device, values, error);
    if (result != TRIPTYCH_OK)
        return result;
    if (count > 1 && constants_create(&device->constants, error))
        return TRIPTYCH_NO_MEMORY;
    struct clear clear = make_clear(device->binding.target, values);
    const struct rectangle area = derive_area(&device->state, values->everywhere);
    if (is_empty(&area) || (!clear.set_color && !clear.depth_mask))
        return TRIPTYCH_OK;
    device_prepare_target(device); /* it may render what is queued, whose memory is then reused */
    errno = 0;
    if (target_acquire_clear(device->binding.target, &device->blits, count ? NULL : &area, &clear, error))
        return device_refusal(TRIPTYCH_ENGINE_FAILED);
    struct rectangle parts[CLEAR_PARTS] = {area};
    if (!count)
        record_parts(device, &clear, parts, 1);
    const struct triptych_rectangle *end = count ? rectangles + count : NULL;
    for (const struct triptych_rectangle *next = rectangles; count && next < end;) {
        uint32_t taken = take_parts(&next, end, &area, parts);
        if (taken)
            record_parts(device, &clear, parts, taken);
    }
    target_release_clear(&device->blits, &clear);
    return TRIPTYCH_OK;
}
