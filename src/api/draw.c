/* Draws, clears, copies, what is drawn to, and queries. */
#include "api/api.h"

#include <limits.h>
#include <string.h>

enum triptych_result triptych_draw(triptych_device *device, enum triptych_primitive primitive, uint32_t first,
                                   uint32_t count)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_draw(device, primitive, first, count, error);
    if (result == TRIPTYCH_OK)
        record_draw(device, primitive, first, count);
    return api_finish(device, result);
}

enum triptych_result triptych_draw_indexed(triptych_device *device, enum triptych_primitive primitive,
                                           int32_t base, uint32_t first, uint32_t count)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_draw_indexed(device, primitive, base, first, count, error);
    if (result == TRIPTYCH_OK)
        record_draw_indexed(device, primitive, base, first, count);
    return api_finish(device, result);
}

enum triptych_result triptych_draw_user(triptych_device *device, enum triptych_primitive primitive,
                                        uint32_t count, const void *vertices, size_t stride)
{
    struct user_draw draw = {.primitive = primitive, .count = count, .vertices = vertices, .stride = stride};
    struct error *error = api_begin_with(device, vertices || !count, "vertices");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_draw_user(device, &draw, error);
    if (result == TRIPTYCH_OK)
        record_draw_user(device, &draw);
    return api_finish(device, result);
}

enum triptych_result triptych_draw_indexed_user(triptych_device *device, enum triptych_primitive primitive,
                                                uint32_t count, const void *indices, unsigned bits,
                                                uint32_t vertex_count, const void *vertices, size_t stride)
{
    struct user_draw draw = {primitive, count, indices, bits, vertex_count, vertices, stride};
    struct error *error = api_begin_with_both(device, vertices || !count, "vertices", indices, "indices");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_draw_user(device, &draw, error);
    if (result == TRIPTYCH_OK)
        record_draw_user(device, &draw);
    return api_finish(device, result);
}

enum triptych_result triptych_process_vertices(triptych_device *device, uint32_t first, uint32_t count,
                                               struct triptych_processed_vertex *out)
{
    struct error *error = api_begin_with(device, out || !count, "vertices");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_process_vertices(device, first, count, out, error));
}

static enum triptych_result clear(triptych_device *device, struct error *error,
                                  struct triptych_clear_values values,
                                  const struct triptych_rectangle *rectangles, unsigned count)
{
    enum triptych_result result = device_clear(device, &values, rectangles, count, error);
    if (result == TRIPTYCH_OK)
        record_clear(device, &values, rectangles, count);
    return api_finish(device, result);
}

/* The values of a clear without masks; the colour only if it is cleared. */
static struct triptych_clear_values plain_values(unsigned flags, const float *color, float depth,
                                                 unsigned stencil)
{
    struct triptych_clear_values values = {
        .flags = flags, .depth = depth, .stencil = stencil, .color_mask = 15, .stencil_mask = UINT_MAX};
    if (flags & TRIPTYCH_CLEAR_COLOR)
        memcpy(values.color, color, sizeof values.color);
    return values;
}

enum triptych_result triptych_clear(triptych_device *device, const float color[4], float depth)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    unsigned flags = (color ? TRIPTYCH_CLEAR_COLOR : 0) | (depth < 0 ? 0 : TRIPTYCH_CLEAR_DEPTH);
    return clear(device, error, plain_values(flags, color, depth, 0), NULL, 0);
}

enum triptych_result triptych_clear_buffers(triptych_device *device, unsigned flags, const float color[4],
                                            float depth, unsigned stencil)
{
    struct error *error = api_begin_with(device, !(flags & TRIPTYCH_CLEAR_COLOR) || color, "color");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return clear(device, error, plain_values(flags, color, depth, stencil), NULL, 0);
}

enum triptych_result triptych_clear_rectangles(triptych_device *device,
                                               const struct triptych_clear_values *values,
                                               const struct triptych_rectangle *rectangles, unsigned count)
{
    struct error *error =
        api_begin_with(device, values && (rectangles || !count), values ? "rectangles" : "values");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return clear(device, error, *values, rectangles, count);
}

enum triptych_result triptych_set_target_surfaces(triptych_device *device,
                                                  const struct triptych_target_surfaces *surfaces)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    bool changes = surfaces || device_drawn_surfaces(device);
    enum triptych_result result = device_set_target_surfaces(device, surfaces, error);
    if (result == TRIPTYCH_OK && changes)
        record_attach(device, surfaces);
    return api_finish(device, result);
}

enum triptych_result triptych_copy(triptych_device *device, const struct triptych_surface *source,
                                   const struct triptych_rectangle *source_part,
                                   const struct triptych_surface *target,
                                   const struct triptych_rectangle *target_part,
                                   enum triptych_copy_filter filter)
{
    struct error *error = api_begin_with_both(device, source, "source", target, "target");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    struct surface_copy copy = {.surface = {source, target}, .filter = filter};
    if (source_part)
        copy.part[0] = *source_part;
    if (target_part)
        copy.part[1] = *target_part;
    enum triptych_result result = device_copy(device, &copy, error);
    if (result == TRIPTYCH_OK)
        record_copy(device, &copy);
    return api_finish(device, result);
}

enum triptych_result triptych_write_rectangle(triptych_device *device, const struct triptych_surface *surface,
                                              const struct triptych_rectangle *part,
                                              enum triptych_surface_format format, const void *data,
                                              size_t pitch)
{
    struct error *error = api_begin_with_both(device, surface, "surface", data, "data");
    struct surface_memory memory;
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result =
        device_write_rectangle(device, surface, part, format, data, pitch, &memory, error);
    if (result == TRIPTYCH_OK)
        record_write_rectangle(device, surface, &memory, data, pitch);
    return api_finish(device, result);
}

enum triptych_result triptych_fill(triptych_device *device, const struct triptych_surface *surface,
                                   const struct triptych_rectangle *part, const float color[4])
{
    struct error *error = api_begin_with_both(device, surface, "surface", color, "color");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_fill(device, surface, part, color, error);
    if (result == TRIPTYCH_OK)
        record_fill(device, surface, part, color);
    return api_finish(device, result);
}

/* --- Queries -------------------------------------------------------------------------------------------- */

enum triptych_result triptych_query_create(triptych_device *device, enum triptych_query_type type,
                                           triptych_query **query)
{
    struct error *error = api_begin_with(device, query, "query");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    *query = NULL;
    if ((unsigned)type >= TRIPTYCH_QUERY_COUNT) {
        error_set(error, "query type %u: expected 0 to %u", (unsigned)type, TRIPTYCH_QUERY_COUNT - 1);
        return api_finish(device, TRIPTYCH_BAD_ARGUMENT);
    }
    *query = query_create(&device->queries, type);
    if (*query) {
        record_new_query(device, *query);
        return TRIPTYCH_OK;
    }
    error_set(error, "out of memory for a query");
    return api_finish(device, TRIPTYCH_NO_MEMORY);
}

enum triptych_result triptych_query_destroy(triptych_device *device, triptych_query *query)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!query)
        return TRIPTYCH_OK;
    record_end_query(device, query);
    return api_finish(device, device_query_destroy(device, query, error));
}

enum triptych_result triptych_query_begin(triptych_device *device, triptych_query *query)
{
    struct error *error = api_begin_with(device, query, "query");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_query_begin(device, query, error);
    if (result == TRIPTYCH_OK)
        record_query(device, query, 1);
    return api_finish(device, result);
}

enum triptych_result triptych_query_end(triptych_device *device, triptych_query *query)
{
    struct error *error = api_begin_with(device, query, "query");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_query_end(device, query, error);
    if (result == TRIPTYCH_OK)
        record_query(device, query, 0);
    return api_finish(device, result);
}

enum triptych_result triptych_query_result(triptych_device *device, triptych_query *query, uint64_t *result)
{
    struct error *error = api_begin_with_both(device, query, "query", result, "result");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_query_result(device, query, result, error));
}

enum triptych_result triptych_query_poll(triptych_device *device, triptych_query *query, int *ready,
                                         uint64_t *result)
{
    struct error *error = api_begin_with_both(device, query, "query", ready && result, "ready or result");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_query_poll(device, query, ready, result, error));
}

enum triptych_result triptych_flush(triptych_device *device)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    device_flush(device);
    return TRIPTYCH_OK;
}

enum triptych_result triptych_finish(triptych_device *device)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    device_finish(device);
    record_wait(device);
    return TRIPTYCH_OK;
}

enum triptych_result triptych_end_frame(triptych_device *device)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    device_finish(device);
    record_frame(device);
    return TRIPTYCH_OK;
}
