/* The methods that bind textures, buffers and stream frequencies. */
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "front/d3d9/state/block.h"

#include <string.h>

/* --- Textures --- */

int32_t d3d9_device_set_texture(struct d3d9_device *device, uint32_t stage, struct d3d9_base_texture *texture)
{
    int sampler = d3d9_state_sampler(stage);
    if (sampler >= 0)
        d3d9_state_set(device, D3D9_GROUP_TEXTURE, (unsigned)sampler, &texture);
    return D3D9_OK;
}

int32_t d3d9_device_get_texture(struct d3d9_device *device, uint32_t stage, struct d3d9_base_texture **out)
{
    int sampler = d3d9_state_sampler(stage);
    if (!out)
        return D3D9_INVALID_CALL;
    *out = sampler < 0 ? NULL : device->state->texture[sampler];
    if (*out)
        d3d9_object_add_ref((struct d3d9_object *)*out);
    return D3D9_OK;
}

/* --- Streams --- */

/* A null buffer keeps offset and stride. */
int32_t d3d9_device_set_stream_source(struct d3d9_device *device, uint32_t stream,
                                      struct d3d9_vertex_buffer *buffer, uint32_t offset, uint32_t stride)
{
    if (stream >= TRIPTYCH_STREAMS || offset % 4)
        return D3D9_INVALID_CALL;
    struct d3d9_stream value =
        device->recording ? device->recording->state->stream[stream] : device->state->stream[stream];
    value.buffer = (struct d3d9_buffer *)buffer;
    if (buffer) {
        value.offset = offset;
        value.stride = stride;
    }
    d3d9_state_set(device, D3D9_GROUP_STREAM, stream, &value);
    return D3D9_OK;
}

int32_t d3d9_device_get_stream_source(struct d3d9_device *device, uint32_t stream,
                                      struct d3d9_vertex_buffer **buffer, uint32_t *offset, uint32_t *stride)
{
    if (!buffer || stream >= TRIPTYCH_STREAMS)
        return D3D9_INVALID_CALL;
    const struct d3d9_stream *from = device->state->stream + stream;
    *buffer = (struct d3d9_vertex_buffer *)from->buffer;
    if (offset)
        *offset = from->offset;
    if (stride)
        *stride = from->stride;
    if (*buffer)
        d3d9_object_add_ref((struct d3d9_object *)*buffer);
    return D3D9_OK;
}

int32_t d3d9_device_set_stream_source_freq(struct d3d9_device *device, uint32_t stream, uint32_t frequency)
{
    enum { INDEXED = 1 << 30, INSTANCE = 2 };
    bool indexed = frequency & INDEXED, instance = frequency >> 30 & INSTANCE;
    if (stream >= TRIPTYCH_STREAMS || !frequency || (indexed && instance) || (instance && !stream))
        return D3D9_INVALID_CALL;
    d3d9_state_set(device, D3D9_GROUP_FREQUENCY, stream, &frequency);
    return D3D9_OK;
}

int32_t d3d9_device_get_stream_source_freq(struct d3d9_device *device, uint32_t stream, uint32_t *frequency)
{
    if (!frequency || stream >= TRIPTYCH_STREAMS)
        return D3D9_INVALID_CALL;
    *frequency = device->state->frequency[stream];
    return D3D9_OK;
}

int32_t d3d9_device_set_indices(struct d3d9_device *device, struct d3d9_index_buffer *buffer)
{
    d3d9_state_set(device, D3D9_GROUP_INDICES, 0, &buffer);
    return D3D9_OK;
}

int32_t d3d9_device_get_indices(struct d3d9_device *device, struct d3d9_index_buffer **out)
{
    if (!out)
        return D3D9_INVALID_CALL;
    *out = (struct d3d9_index_buffer *)device->state->indices[0];
    if (*out)
        d3d9_object_add_ref((struct d3d9_object *)*out);
    return D3D9_OK;
}
