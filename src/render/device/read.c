/* Reading the target, one sample or resolved, in rows. All arguments are checked before anything is read. */
#include "render/device/device_part.h"
#include "render/target/resolve.h"

#include <stdatomic.h>

/* Rows of tiles are read by several threads, into those of the images that are not null. `room` has the sizes
 * of the caller's arrays in bytes. */
struct reading {
    const struct target *target;
    unsigned t;                    /* which colour */
    int sample;                    /* or SAMPLE_RESOLVED */
    const struct routine *resolve; /* of its samples; null: one is read */
    uint32_t *color;
    float *numbers;
    float *depth;
    uint8_t *stencil;
    struct {
        size_t color, numbers, depth, stencil;
    } room;
    _Atomic uint32_t next_row;
};

static void read_task(void *user, unsigned worker)
{
    struct reading *r = user;
    const struct target_reading color = {r->target, r->t, r->sample, r->resolve};
    uint32_t row;
    (void)worker;
    while ((row = atomic_fetch_add(&r->next_row, 1)) < r->target->rows) {
        if (r->color)
            target_read_color(&color, row, r->color, r->target->width);
        if (r->numbers)
            target_read_numbers(&color, row, r->numbers, r->target->width);
        if (r->depth)
            target_read_depth(r->target, r->sample, row, r->depth);
        if (r->stencil)
            target_read_stencil(r->target, r->sample, row, r->stencil);
    }
}

static enum triptych_result lacks(const struct target *target, const char *what, struct error *error)
{
    error_set(error, "the target's depth format is %s: expected one with %s",
              depth_formats[target->depth_format].name, what);
    return TRIPTYCH_BAD_CALL;
}

enum triptych_result device_check_room(const char *what, size_t bytes, size_t needed, struct error *error)
{
    if (bytes >= needed)
        return TRIPTYCH_OK;
    error_set(error, "an array of %zu bytes for %s: expected at least %zu", bytes, what, needed);
    return TRIPTYCH_BAD_ARGUMENT;
}

static enum triptych_result check_room(const struct target *target, const struct reading *r,
                                       struct error *error)
{
    size_t pixels = (size_t)target->width * target->height;
    enum triptych_result result = TRIPTYCH_OK;
    if (r->color)
        result = device_check_room("colours", r->room.color, 4 * pixels, error);
    if (r->numbers && result == TRIPTYCH_OK)
        result = device_check_room("numbers", r->room.numbers, 16 * pixels, error);
    if (r->depth && result == TRIPTYCH_OK)
        result = device_check_room("depth", r->room.depth, 4 * pixels, error);
    if (r->stencil && result == TRIPTYCH_OK)
        result = device_check_room("stencil", r->room.stencil, pixels, error);
    return result;
}

static enum triptych_result check_reading(const struct target *target, const struct reading *r,
                                          struct error *error)
{
    if (r->sample != SAMPLE_RESOLVED && (unsigned)r->sample >= target->samples) {
        error_set(error, "sample %u: the target has %u per pixel", (unsigned)r->sample, target->samples);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if ((r->color || r->numbers) && (r->t >= TARGETS || !target->colors[r->t].format)) {
        error_set(error, "colour target %u: the target has none of that number", r->t);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (r->depth && !target->depth)
        return lacks(target, "depth", error);
    if (r->stencil && !stencil_mask(target->depth_format))
        return lacks(target, "stencil", error);
    return check_room(target, r, error);
}

/* Finds the routine that averages the samples of the colour, if that is what is read. */
static enum triptych_result find_resolve(struct triptych_device *device, struct reading *reading,
                                         struct error *error)
{
    const struct target *target = reading->target;
    bool reads = (reading->color || reading->numbers) && target->colors[reading->t].clear;
    if (!reads || reading->sample != SAMPLE_RESOLVED || target->samples == 1)
        return TRIPTYCH_OK;
    errno = 0;
    reading->resolve = target_acquire_resolve(&device->blits, target->colors[reading->t].storage,
                                              target->samples, &target->color_order, error);
    return reading->resolve ? TRIPTYCH_OK : device_refusal(TRIPTYCH_ENGINE_FAILED);
}

static enum triptych_result read_target(struct triptych_device *device, struct reading *reading,
                                        struct error *error)
{
    enum triptych_result result = device_has_target(device, error);
    if (result == TRIPTYCH_OK)
        result = check_reading(device->binding.target, reading, error);
    if (result != TRIPTYCH_OK)
        return result;
    device_finish_target(device);
    reading->target = device->binding.target;
    result = find_resolve(device, reading, error);
    if (result != TRIPTYCH_OK)
        return result;
    pool_run(device->pool, 0, device->binding.target->rows, POOL_ALL, read_task, reading);
    blit_release(&device->blits, reading->resolve);
    return TRIPTYCH_OK;
}

enum triptych_result device_read_target(struct triptych_device *device, unsigned t, uint32_t *rgba,
                                        size_t bytes, struct error *error)
{
    struct reading reading = {.t = t, .sample = SAMPLE_RESOLVED, .color = rgba, .room.color = bytes};
    return read_target(device, &reading, error);
}

enum triptych_result device_read_target_numbers(struct triptych_device *device, unsigned t, float *numbers,
                                                size_t bytes, struct error *error)
{
    struct reading reading = {.t = t, .sample = SAMPLE_RESOLVED, .numbers = numbers, .room.numbers = bytes};
    return read_target(device, &reading, error);
}

enum triptych_result device_read_depth(struct triptych_device *device, float *depth, size_t bytes,
                                       struct error *error)
{
    struct reading reading = {.sample = SAMPLE_RESOLVED, .depth = depth, .room.depth = bytes};
    return read_target(device, &reading, error);
}

enum triptych_result device_read_stencil(struct triptych_device *device, uint8_t *stencil, size_t bytes,
                                         struct error *error)
{
    struct reading reading = {.sample = SAMPLE_RESOLVED, .stencil = stencil, .room.stencil = bytes};
    return read_target(device, &reading, error);
}

enum triptych_result device_read_sample(struct triptych_device *device, unsigned sample,
                                        const struct sample_images *images, struct error *error)
{
    struct reading reading = {.sample = sample < INT32_MAX ? (int)sample : INT32_MAX,
                              .color = images->color,
                              .depth = images->depth,
                              .stencil = images->stencil,
                              .room.color = images->color_bytes,
                              .room.depth = images->depth_bytes,
                              .room.stencil = images->stencil_bytes};
    return read_target(device, &reading, error);
}
