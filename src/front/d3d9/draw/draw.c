/* The draws. Vertices and indices outside of their buffers do not stop a program: the draw is left out, as
 * far as the renderer refuses it. */
#include "front/d3d9/draw/draw.h"
#include "front/d3d9/call.h"
#include "front/d3d9/draw/buffer.h"
#include "front/d3d9/size.h"
#include "front/d3d9/state/declaration.h"
#include "front/d3d9/state/shader.h"

#include <string.h>

/* Returns -1 for a D3DPRIMITIVETYPE that does not exist. */
static int primitive_of(uint32_t type)
{
    static const int primitives[] = {-1,
                                     TRIPTYCH_POINT_LIST,
                                     TRIPTYCH_LINE_LIST,
                                     TRIPTYCH_LINE_STRIP,
                                     TRIPTYCH_TRIANGLE_LIST,
                                     TRIPTYCH_TRIANGLE_STRIP,
                                     TRIPTYCH_TRIANGLE_FAN};
    return type < sizeof primitives / sizeof *primitives ? primitives[type] : -1;
}

/* A shader for software vertex processing that is used without: the first draw fails, and further ones use
 * the fixed function, as by Direct3D's runtime. */
static int32_t check_shader(struct d3d9_device *device)
{
    struct d3d9_shader *shader = device->state->vertex_shader[0];
    bool fits = !shader || !shader->software || device->software_vertices || device->refused == shader;
    if (!fits)
        device->refused = shader;
    else if (device->refused != shader)
        device->refused = NULL;
    return fits ? D3D9_OK : D3D9_INVALID_CALL;
}

/* Programs that draw outside a scene exist, and drivers draw. */
static int32_t check_draw(struct d3d9_device *device, uint32_t type, uint32_t count)
{
    if (!device->state->declaration[0] || primitive_of(type) < 0 || count > D3D9_MOST_PRIMITIVES)
        return D3D9_INVALID_CALL;
    return check_shader(device);
}

int32_t d3d9_device_draw_primitive(struct d3d9_device *device, uint32_t type, uint32_t first, uint32_t count)
{
    int32_t result = check_draw(device, type, count);
    if (result == D3D9_OK && count && d3d9_draw_prepare(device, D3D9_NEEDS_STREAMS))
        triptych_draw(device->renderer, (enum triptych_primitive)primitive_of(type), first, count);
    return result;
}

/* Without indices Direct3D succeeds and draws nothing. */
int32_t d3d9_device_draw_indexed_primitive(struct d3d9_device *device, uint32_t type, int32_t base,
                                           uint32_t lowest, uint32_t vertices, uint32_t first, uint32_t count)
{
    (void)lowest, (void)vertices;
    int32_t result = check_draw(device, type, count);
    if (result == D3D9_OK && count && device->state->indices[0] &&
        d3d9_draw_prepare(device, D3D9_NEEDS_STREAMS | D3D9_NEEDS_INDICES | D3D9_NEEDS_INSTANCES))
        triptych_draw_indexed(device->renderer, (enum triptych_primitive)primitive_of(type), base, first,
                              count);
    return result;
}

/* --- Draws from the program's memory --- */

/* A draw from memory. Without indices every vertex is used once, from the first on. */
struct user_draw {
    enum triptych_primitive primitive;
    uint32_t count;
    const void *vertices, *indices;
    uint32_t stride, vertex_count;
    unsigned bits; /* of an index */
    uint64_t corners;
};

/* Direct3D unbinds stream 0 after such a draw, and the indices after an indexed one; never in a block. */
static void unbind(struct d3d9_device *device, bool indexed, bool drawn)
{
    struct d3d9_stream stream = {.stride = drawn ? 0 : device->state->stream[0].stride};
    struct d3d9_buffer *none = NULL;
    d3d9_state_set_now(device, D3D9_GROUP_STREAM, 0, &stream);
    if (indexed)
        d3d9_state_set_now(device, D3D9_GROUP_INDICES, 0, &none);
}

/* Through buffers: for strides and elements that the renderer accepts only there. */
static void draw_copy(struct d3d9_device *device, const struct user_draw *draw)
{
    triptych_device *renderer = device->renderer;
    triptych_buffer *vertices = NULL, *indices = NULL;
    enum triptych_result result =
        d3d9_buffer_copy(renderer, draw->vertices, (size_t)draw->vertex_count * draw->stride, &vertices);
    if (result == TRIPTYCH_OK && draw->indices)
        result = d3d9_buffer_copy(renderer, draw->indices, draw->corners * draw->bits / 8, &indices);
    if (result == TRIPTYCH_OK)
        result = triptych_set_stream(renderer, 0, vertices, 0, draw->stride);
    if (result == TRIPTYCH_OK && draw->indices) {
        triptych_set_indices(renderer, indices, draw->bits);
        triptych_draw_indexed(renderer, draw->primitive, 0, 0, draw->count);
    } else if (result == TRIPTYCH_OK) {
        triptych_draw(renderer, draw->primitive, 0, draw->count);
    }
    triptych_buffer_destroy(renderer, vertices);
    triptych_buffer_destroy(renderer, indices);
    device->late |= D3D9_LATE_STREAMS;
}

static int32_t draw_user(struct d3d9_device *device, uint32_t type, struct user_draw *draw)
{
    enum triptych_result result;
    if (!draw->stride || !draw->vertices)
        return D3D9_INVALID_CALL;
    if (check_draw(device, type, draw->count) != D3D9_OK) {
        unbind(device, draw->indices, false);
        return D3D9_INVALID_CALL;
    }
    draw->primitive = (enum triptych_primitive)primitive_of(type);
    draw->corners = d3d9_size_primitives(type, draw->count);
    if (!draw->indices)
        draw->vertex_count = (uint32_t)draw->corners;
    if (draw->count && d3d9_draw_prepare(device, draw->indices ? D3D9_NEEDS_INSTANCES : 0)) {
        result = draw->indices ? triptych_draw_indexed_user(device->renderer, draw->primitive, draw->count,
                                                            draw->indices, draw->bits, draw->vertex_count,
                                                            draw->vertices, draw->stride)
                               : triptych_draw_user(device->renderer, draw->primitive, draw->count,
                                                    draw->vertices, draw->stride);
        if (result != TRIPTYCH_OK)
            draw_copy(device, draw);
    }
    unbind(device, draw->indices, true);
    return D3D9_OK;
}

int32_t d3d9_device_draw_primitive_up(struct d3d9_device *device, uint32_t type, uint32_t count,
                                      const void *vertices, uint32_t stride)
{
    return draw_user(device, type,
                     &(struct user_draw){.count = count, .vertices = vertices, .stride = stride});
}

int32_t d3d9_device_draw_indexed_primitive_up(struct d3d9_device *device, uint32_t type, uint32_t lowest,
                                              uint32_t vertex_count, uint32_t count, const void *indices,
                                              uint32_t index_format, const void *vertices, uint32_t stride)
{
    enum { INDEX32 = 102 };
    if (!indices)
        return D3D9_INVALID_CALL;
    return draw_user(device, type,
                     &(struct user_draw){.count = count,
                                         .vertices = vertices,
                                         .indices = indices,
                                         .stride = stride,
                                         .vertex_count = lowest + vertex_count,
                                         .bits = index_format == INDEX32 ? 32 : 16});
}

/* --- Patches, which no device has --- */

int32_t d3d9_device_draw_rect_patch(struct d3d9_device *device, uint32_t patch, const float *segments,
                                    const struct d3d9_rect_patch_info *information)
{
    (void)device, (void)patch, (void)segments, (void)information;
    return D3D9_OK;
}

int32_t d3d9_device_draw_tri_patch(struct d3d9_device *device, uint32_t patch, const float *segments,
                                   const struct d3d9_tri_patch_info *information)
{
    (void)device, (void)patch, (void)segments, (void)information;
    return D3D9_OK;
}

int32_t d3d9_device_delete_patch(struct d3d9_device *device, uint32_t patch)
{
    (void)device, (void)patch;
    return D3D9_OK;
}
