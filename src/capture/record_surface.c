/* Calls that name surfaces, as calls of a stream. */
#include "capture/record_part.h"
#include "render/target/surface.h"

#include <stdlib.h>
#include <string.h>

static struct call_surface surface_of(const struct triptych_surface *surface)
{
    if (surface->image)
        return (struct call_surface){surface->image->recorded, 0, 0};
    return (struct call_surface){surface->texture ? surface->texture->recorded : NO_RESOURCE,
                                 surface->texture ? surface->level : 0,
                                 surface->texture ? surface->slice : 0};
}

void record_attach(struct triptych_device *device, const struct triptych_target_surfaces *surfaces)
{
    static const struct triptych_surface none;
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_ATTACH, .resource = NO_RESOURCE};
    call.attach.some = surfaces != NULL;
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        call.attach.color[t] = surface_of(surfaces ? &surfaces->color[t] : &none);
    call.attach.depth = surface_of(surfaces ? &surfaces->depth : &none);
    if (surfaces && !surface_is_given(&surfaces->depth))
        call.attach.depth_format = surfaces->depth_format;
    record_call(device, &call);
}

static struct call_surface surface_or_target(const struct triptych_surface *surface)
{
    struct call_surface result = surface_of(surface);
    if (!surface_is_given(surface))
        result.slice = surface->slice;
    return result;
}

void record_copy(struct triptych_device *device, const struct surface_copy *copy)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_COPY, .resource = NO_RESOURCE, .copy.filter = copy->filter};
    for (int i = 0; i < 2; i++) {
        call.copy.surface[i] = surface_or_target(copy->surface[i]);
        if (copy->part[i].width)
            call.copy.part[i] = copy->part[i];
    }
    record_call(device, &call);
}

/* The rows of pixels without padding. The caller frees them. Null if memory is short. */
static uint8_t *pack_rows(const struct surface_memory *memory, const uint8_t *data, size_t pitch)
{
    uint8_t *packed = malloc(memory->row_bytes * memory->rows);
    for (size_t y = 0; packed && y < memory->rows; y++)
        memcpy(packed + y * memory->row_bytes, data + y * pitch, memory->row_bytes);
    return packed;
}

void record_write_rectangle(struct triptych_device *device, const struct triptych_surface *surface,
                            const struct surface_memory *memory, const void *data, size_t pitch)
{
    struct call call = {.type = CALL_SET_PIXELS, .resource = NO_RESOURCE};
    if (!device_recorder(device))
        return;
    uint8_t *packed = pack_rows(memory, data, pitch);
    if (!packed)
        record_memory_is_short(device);
    call.set_pixels.surface = surface_or_target(surface);
    call.set_pixels.part = memory->part;
    call.set_pixels.format = memory->format ? (enum triptych_surface_format)memory->format->number : 0;
    call.set_pixels.source = record_bytes(device, packed, packed ? memory->row_bytes * memory->rows : 0);
    record_call(device, &call);
    record_release(device, call.set_pixels.source);
    free(packed);
}

void record_fill(struct triptych_device *device, const struct triptych_surface *surface,
                 const struct triptych_rectangle *part, const float color[4])
{
    struct call call = {.type = CALL_FILL, .resource = NO_RESOURCE};
    if (!device_recorder(device))
        return;
    call.fill.surface = surface_or_target(surface);
    if (part && part->width)
        call.fill.part = *part;
    memcpy(call.fill.color, color, sizeof call.fill.color);
    record_call(device, &call);
}
