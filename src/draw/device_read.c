/* The device's readers: what the target has, sample by sample or resolved, in rows. */
#include "draw/device.h"

#include <stdatomic.h>

/* Rows of tiles are read by several threads, into the one of the images that is not null. */
struct reading {
    const struct target *target;
    unsigned t; /* which colour */
    int sample; /* or SAMPLE_RESOLVED */
    uint32_t *color;
    float *numbers;
    float *depth;
    uint8_t *stencil;
    _Atomic uint32_t next_row;
};

static void read_task(void *user, unsigned worker)
{
    struct reading *reading = user;
    uint32_t row;
    (void)worker;
    while ((row = atomic_fetch_add(&reading->next_row, 1)) < reading->target->rows)
        if (reading->color)
            target_read_color(reading->target, reading->t, reading->sample, row, reading->color);
        else if (reading->numbers)
            target_read_numbers(reading->target, reading->t, reading->sample, row, reading->numbers);
        else if (reading->depth)
            target_read_depth(reading->target, reading->sample, row, reading->depth);
        else
            target_read_stencil(reading->target, reading->sample, row, reading->stencil);
}

static void read_target(struct triptych_device *device, struct reading *reading)
{
    device_finish(device);
    reading->target = &device->target;
    pool_run(device->pool, device->target.rows, read_task, reading);
}

static enum triptych_result read_color(struct triptych_device *device, struct reading *reading,
                                       struct error *error)
{
    enum triptych_result result = device_has_target(device, error);
    if (result == TRIPTYCH_OK && (reading->t >= TARGETS || !device->target.colors[reading->t].format)) {
        error_set(error, "colour target %u: the target has none of that number", reading->t);
        result = TRIPTYCH_BAD_ARGUMENT;
    }
    if (result == TRIPTYCH_OK)
        read_target(device, reading);
    return result;
}

enum triptych_result device_read_target(struct triptych_device *device, unsigned t, uint32_t *rgba,
                                        struct error *error)
{
    struct reading reading = {.t = t, .sample = SAMPLE_RESOLVED, .color = rgba};
    return read_color(device, &reading, error);
}

enum triptych_result device_read_target_numbers(struct triptych_device *device, unsigned t, float *numbers,
                                                struct error *error)
{
    struct reading reading = {.t = t, .sample = SAMPLE_RESOLVED, .numbers = numbers};
    return read_color(device, &reading, error);
}

static enum triptych_result lacks(const struct triptych_device *device, const char *what, struct error *error)
{
    error_set(error, "the target's depth format is %s: expected one with %s",
              depth_formats[device->target.depth_format].name, what);
    return TRIPTYCH_BAD_CALL;
}

static enum triptych_result read_depth(struct triptych_device *device, struct reading *reading,
                                       struct error *error)
{
    enum triptych_result result = device_has_target(device, error);
    if (result == TRIPTYCH_OK && !device->target.depth)
        return lacks(device, "depth", error);
    if (result == TRIPTYCH_OK)
        read_target(device, reading);
    return result;
}

static enum triptych_result read_stencil(struct triptych_device *device, struct reading *reading,
                                         struct error *error)
{
    enum triptych_result result = device_has_target(device, error);
    if (result == TRIPTYCH_OK && !stencil_mask(device->target.depth_format))
        return lacks(device, "stencil", error);
    if (result == TRIPTYCH_OK)
        read_target(device, reading);
    return result;
}

enum triptych_result device_read_depth(struct triptych_device *device, float *depth, struct error *error)
{
    struct reading reading = {.sample = SAMPLE_RESOLVED, .depth = depth};
    return read_depth(device, &reading, error);
}

enum triptych_result device_read_stencil(struct triptych_device *device, uint8_t *stencil,
                                         struct error *error)
{
    struct reading reading = {.sample = SAMPLE_RESOLVED, .stencil = stencil};
    return read_stencil(device, &reading, error);
}

enum triptych_result device_read_sample(struct triptych_device *device, unsigned sample, uint32_t *rgba,
                                        float *depth, uint8_t *stencil, struct error *error)
{
    struct reading colors = {.sample = (int)sample, .color = rgba};
    struct reading depths = {.sample = (int)sample, .depth = depth};
    struct reading stencils = {.sample = (int)sample, .stencil = stencil};
    enum triptych_result result = device_has_target(device, error);
    if (result == TRIPTYCH_OK && sample >= device->target.samples) {
        error_set(error, "sample %u: the target has %u per pixel", sample, device->target.samples);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (result == TRIPTYCH_OK && depth)
        result = read_depth(device, &depths, error);
    if (result == TRIPTYCH_OK && stencil)
        result = read_stencil(device, &stencils, error);
    if (result == TRIPTYCH_OK && rgba)
        result = read_color(device, &colors, error);
    return result;
}
