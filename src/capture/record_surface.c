/* Calls that describe or clear the target, and those that name surfaces, as calls of a stream. */
#include "capture/record_part.h"
#include "base/minmax.h"
#include "render/target/surface.h"

#include <stdlib.h>
#include <string.h>

/* --- Targets -------------------------------------------------------------------------------------------- */

/* Colours are consecutive in a stream. A missing colour becomes the format NULL, which stores nothing. */
void record_target(struct triptych_device *device, const struct triptych_target_description *description)
{
    struct call call = {.type = CALL_TARGET, .resource = NO_RESOURCE, .target = *description};
    unsigned last = TRIPTYCH_TARGETS - 1;
    if (!device_recorder(device))
        return;
    while (last && !description->color_format[last])
        last--;
    for (unsigned t = 0; t <= last && last; t++)
        if (!call.target.color_format[t])
            call.target.color_format[t] = t ? TRIPTYCH_SURFACE_NULL : TRIPTYCH_SURFACE_A8R8G8B8;
    record_call(device, &call);
}

void record_viewport(struct triptych_device *device, const struct triptych_viewport *viewport)
{
    if (device_recorder(device))
        record_call(device,
                    &(struct call){.type = CALL_VIEWPORT, .resource = NO_RESOURCE, .viewport = *viewport});
}

/* The part from `from` on of a side of the scissor rectangle that a target can have. */
static unsigned part_of_side(unsigned from, unsigned length)
{
    return min_u32(length, TRIPTYCH_TARGET_MAXIMUM - min_u32(from, TRIPTYCH_TARGET_MAXIMUM));
}

/* A recording has what no target can have cut off. */
void record_scissor(struct triptych_device *device, unsigned x, unsigned y, unsigned width, unsigned height)
{
    struct call call = {.type = CALL_SCISSOR, .resource = NO_RESOURCE};
    if (!device_recorder(device))
        return;
    call.scissor.x = min_u32(x, TRIPTYCH_TARGET_MAXIMUM);
    call.scissor.y = min_u32(y, TRIPTYCH_TARGET_MAXIMUM);
    call.scissor.width = part_of_side(x, width);
    call.scissor.height = part_of_side(y, height);
    record_call(device, &call);
}

/* Values of surfaces that are not cleared are ignored. */
static struct call_clear clear_of(const struct triptych_clear_values *values)
{
    struct call_clear clear = {.flags = values->flags, .depth = values->depth};
    if (values->flags & TRIPTYCH_CLEAR_COLOR)
        memcpy(clear.color, values->color, sizeof clear.color);
    clear.stencil = values->stencil & 255;
    return clear;
}

static struct call_part part_of(const struct triptych_rectangle *r)
{
    return (struct call_part){
        (uint16_t)min_u32(r->x, TRIPTYCH_TARGET_MAXIMUM), (uint16_t)min_u32(r->y, TRIPTYCH_TARGET_MAXIMUM),
        (uint16_t)part_of_side(r->x, r->width), (uint16_t)part_of_side(r->y, r->height)};
}

/* A call for every PARTS_PER_CALL rectangles. A call without rectangles clears everything. */
static void record_clear_parts(struct triptych_device *device, const struct triptych_clear_values *values,
                               const struct triptych_rectangle *rectangles, unsigned count)
{
    struct call call = {.type = CALL_CLEAR_PARTS, .resource = NO_RESOURCE};
    struct call_clear_parts *parts = &call.clear_parts;
    parts->clear = clear_of(values);
    parts->color_mask = values->color_mask;
    parts->stencil_mask = values->stencil_mask & 255;
    parts->everywhere = values->everywhere;
    for (unsigned i = 0; i < count; i++) {
        if (parts->count == PARTS_PER_CALL) {
            record_call(device, &call);
            parts->count = 0;
        }
        parts->part[parts->count++] = part_of(rectangles + i);
    }
    record_call(device, &call);
}

/* Streams have a byte for the stencil and its mask: no format has more. */
void record_clear(struct triptych_device *device, const struct triptych_clear_values *values,
                  const struct triptych_rectangle *rectangles, unsigned count)
{
    struct call call = {.type = CALL_CLEAR, .resource = NO_RESOURCE};
    if (!device_recorder(device) || !values->flags)
        return;
    if (count || values->everywhere || values->color_mask != 15 || (values->stencil_mask & 255) != 255) {
        record_clear_parts(device, values, rectangles, count);
        return;
    }
    call.clear = clear_of(values);
    record_call(device, &call);
}

/* --- Surfaces ------------------------------------------------------------------------------------------- */

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
