#include "front/d3d9/draw/buffer.h"
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"

#include <string.h>

/* Formats (D3DFORMAT), and the bytes that a vertex may reach beyond the end of its buffer. */
enum { VERTEX_DATA = 100, INDEX16 = 101, INDEX32 = 102, BEYOND = 256 };

/* --- Life --- */

static void destroy_buffer(struct d3d9_object *object)
{
    struct d3d9_buffer *buffer = (struct d3d9_buffer *)object;
    triptych_buffer_destroy(buffer->resource.device->renderer, buffer->renderer);
    d3d9_resource_end(&buffer->resource);
    d3d9_memory_free(buffer->memory);
}

static int32_t check_creation(const struct d3d9_device *device, uint32_t bytes, uint32_t usage, uint32_t pool)
{
    const uint32_t not_of_buffers =
        D3D9_USAGE_RENDER_TARGET | D3D9_USAGE_DEPTH_STENCIL | D3D9_USAGE_AUTOMATIC_MIPS;
    if (!bytes || bytes > INT32_MAX - BEYOND || usage & not_of_buffers || pool >= D3D9_POOL_SCRATCH)
        return D3D9_INVALID_CALL;
    if (pool == D3D9_POOL_MANAGED && (device->extended || usage & D3D9_USAGE_DYNAMIC))
        return D3D9_INVALID_CALL;
    return D3D9_OK;
}

static int32_t make_buffer(struct d3d9_device *device, enum d3d9_interface interface, uint32_t bytes,
                           uint32_t usage, uint32_t pool, struct d3d9_buffer **out)
{
    int32_t result = check_creation(device, bytes, usage, pool);
    if (result != D3D9_OK)
        return result;
    struct d3d9_buffer *buffer = d3d9_object_make(sizeof *buffer, interface, &device->object, destroy_buffer);
    if (!buffer)
        return D3D9_OUT_OF_MEMORY;
    d3d9_resource_begin(&buffer->resource, device,
                        interface == D3D9_INTERFACE_VERTEX_BUFFER ? D3D9_TYPE_VERTEX_BUFFER
                                                                  : D3D9_TYPE_INDEX_BUFFER,
                        usage, (enum d3d9_pool)pool);
    buffer->bytes = bytes;
    buffer->memory = d3d9_memory_allocate(bytes);
    if (!buffer->memory) {
        d3d9_object_release(&buffer->resource.object);
        return D3D9_OUT_OF_VIDEO_MEMORY;
    }
    d3d9_resource_count_bytes(&buffer->resource, bytes);
    *out = buffer;
    return D3D9_OK;
}

/* Only IDirect3DDevice9Ex has shared memory, and no buffer has it. */
static int32_t refuse_shared(const struct d3d9_device *device, const uint64_t *shared)
{
    if (!shared)
        return D3D9_INVALID_CALL;
    return device->extended ? D3D9_NOT_AVAILABLE : D3D9_NOT_IMPLEMENTED;
}

int32_t d3d9_device_create_vertex_buffer(struct d3d9_device *device, uint32_t bytes, uint32_t usage,
                                         uint32_t fvf, uint32_t pool, struct d3d9_vertex_buffer **out,
                                         uint64_t *shared)
{
    struct d3d9_buffer *buffer;
    if (!out || shared)
        return refuse_shared(device, shared);
    int32_t result = make_buffer(device, D3D9_INTERFACE_VERTEX_BUFFER, bytes, usage, pool, &buffer);
    if (result != D3D9_OK)
        return result;
    buffer->format = VERTEX_DATA;
    buffer->fvf = fvf;
    *out = (struct d3d9_vertex_buffer *)buffer;
    return D3D9_OK;
}

int32_t d3d9_device_create_index_buffer(struct d3d9_device *device, uint32_t bytes, uint32_t usage,
                                        uint32_t format, uint32_t pool, struct d3d9_index_buffer **out,
                                        uint64_t *shared)
{
    struct d3d9_buffer *buffer;
    if (!out || shared || (format != INDEX16 && format != INDEX32))
        return refuse_shared(device, shared);
    int32_t result = make_buffer(device, D3D9_INTERFACE_INDEX_BUFFER, bytes, usage, pool, &buffer);
    if (result != D3D9_OK)
        return result;
    buffer->format = format;
    *out = (struct d3d9_index_buffer *)buffer;
    return D3D9_OK;
}

/* --- Changes --- */

static void change(struct d3d9_buffer *buffer, enum d3d9_buffer_change kind, uint32_t first, uint32_t last)
{
    bool fresh = buffer->change == D3D9_BUFFER_UNCHANGED || kind == D3D9_BUFFER_DISCARDED;
    buffer->first = fresh || first < buffer->first ? first : buffer->first;
    buffer->last = fresh || last > buffer->last ? last : buffer->last;
    if (kind > buffer->change)
        buffer->change = kind;
}

void d3d9_buffer_written(struct d3d9_buffer *buffer, uint32_t first, uint32_t last)
{
    change(buffer, D3D9_BUFFER_CHANGED, first, last);
}

/* Makes the renderer's buffer. Everything in memory is new to it. */
static bool make_renderer(struct d3d9_buffer *buffer)
{
    size_t bytes = (buffer->bytes + BEYOND + 3) & ~(size_t)3;
    triptych_device *renderer = buffer->resource.device->renderer;
    if (triptych_buffer_create(renderer, NULL, bytes, &buffer->renderer) != TRIPTYCH_OK)
        return false;
    buffer->change = D3D9_BUFFER_CHANGED;
    buffer->first = 0;
    buffer->last = buffer->bytes;
    return true;
}

/* Indices are checked when a draw is queued, so queued draws must read those of that time, whatever the
 * program has promised. An update in place costs the same. */
static bool keeps_queued(const struct d3d9_buffer *buffer)
{
    return buffer->change == D3D9_BUFFER_CHANGED ||
           (buffer->change == D3D9_BUFFER_APPENDED && buffer->format != VERTEX_DATA);
}

static bool upload(struct d3d9_buffer *buffer)
{
    triptych_device *renderer = buffer->resource.device->renderer;
    size_t bytes = buffer->last - buffer->first;
    void *data;
    if (keeps_queued(buffer))
        return triptych_buffer_update(renderer, buffer->renderer, buffer->first,
                                      buffer->memory + buffer->first, bytes) == TRIPTYCH_OK;
    enum triptych_map map =
        buffer->change == D3D9_BUFFER_DISCARDED ? TRIPTYCH_MAP_DISCARD : TRIPTYCH_MAP_NO_OVERWRITE;
    if (triptych_buffer_map(renderer, buffer->renderer, buffer->first, bytes, map, &data) != TRIPTYCH_OK)
        return false;
    memcpy(data, buffer->memory + buffer->first, bytes);
    return triptych_buffer_unmap(renderer, buffer->renderer) == TRIPTYCH_OK;
}

triptych_buffer *d3d9_buffer_use(struct d3d9_buffer *buffer)
{
    if (!buffer->renderer && !make_renderer(buffer))
        return NULL;
    if (buffer->change != D3D9_BUFFER_UNCHANGED && !upload(buffer))
        return NULL;
    /* A program may write to a buffer until it unlocks it. */
    if (!buffer->locks)
        buffer->change = D3D9_BUFFER_UNCHANGED;
    else if (buffer->change == D3D9_BUFFER_DISCARDED)
        buffer->change = D3D9_BUFFER_CHANGED;
    return buffer->renderer;
}

enum triptych_result d3d9_buffer_copy(triptych_device *renderer, const void *data, size_t bytes,
                                      triptych_buffer **buffer)
{
    size_t all = (bytes + BEYOND + 3) & ~(size_t)3;
    enum triptych_result result = triptych_buffer_create(renderer, NULL, all, buffer);
    return result == TRIPTYCH_OK ? triptych_buffer_update(renderer, *buffer, 0, data, bytes) : result;
}

/* --- Methods --- */

/* Hints are for dynamic buffers only. Of both hints, NOOVERWRITE counts. */
static int32_t lock(struct d3d9_buffer *buffer, uint32_t offset, uint32_t bytes, void **data, uint32_t flags)
{
    bool dynamic = buffer->resource.usage & D3D9_USAGE_DYNAMIC;
    if (!data || offset > buffer->bytes || bytes > buffer->bytes - offset)
        return D3D9_INVALID_CALL;
    uint32_t last = bytes ? offset + bytes : buffer->bytes;
    buffer->locks++;
    *data = buffer->memory + offset;
    if (flags & D3D9_LOCK_READ_ONLY || last == offset)
        return D3D9_OK;
    change(buffer,
           dynamic && flags & D3D9_LOCK_NO_OVERWRITE ? D3D9_BUFFER_APPENDED
           : dynamic && flags & D3D9_LOCK_DISCARD    ? D3D9_BUFFER_DISCARDED
                                                     : D3D9_BUFFER_CHANGED,
           offset, last);
    return D3D9_OK;
}

/* Direct3D does not count: an Unlock without Lock succeeds. Appended bytes are passed on immediately: no draw
 * has to be preserved from them. If memory is short, the next draw tries again. */
static int32_t unlock(struct d3d9_buffer *buffer)
{
    if (buffer->locks)
        buffer->locks--;
    if (!buffer->locks && buffer->change == D3D9_BUFFER_APPENDED && buffer->renderer)
        d3d9_buffer_use(buffer);
    return D3D9_OK;
}

int32_t d3d9_vertex_buffer_lock(struct d3d9_vertex_buffer *buffer, uint32_t offset, uint32_t bytes,
                                void **data, uint32_t flags)
{
    return lock(&buffer->buffer, offset, bytes, data, flags);
}

int32_t d3d9_index_buffer_lock(struct d3d9_index_buffer *buffer, uint32_t offset, uint32_t bytes, void **data,
                               uint32_t flags)
{
    return lock(&buffer->buffer, offset, bytes, data, flags);
}

int32_t d3d9_vertex_buffer_unlock(struct d3d9_vertex_buffer *buffer)
{
    return unlock(&buffer->buffer);
}

int32_t d3d9_index_buffer_unlock(struct d3d9_index_buffer *buffer)
{
    return unlock(&buffer->buffer);
}

int32_t d3d9_vertex_buffer_get_desc(struct d3d9_vertex_buffer *vertices,
                                    struct d3d9_vertex_buffer_desc *description)
{
    const struct d3d9_buffer *buffer = &vertices->buffer;
    if (!description)
        return D3D9_INVALID_CALL;
    *description = (struct d3d9_vertex_buffer_desc){.format = buffer->format,
                                                    .type = buffer->resource.type,
                                                    .usage = buffer->resource.usage,
                                                    .pool = buffer->resource.pool,
                                                    .size = buffer->bytes,
                                                    .fvf = buffer->fvf};
    return D3D9_OK;
}

int32_t d3d9_index_buffer_get_desc(struct d3d9_index_buffer *indices,
                                   struct d3d9_index_buffer_desc *description)
{
    const struct d3d9_buffer *buffer = &indices->buffer;
    if (!description)
        return D3D9_INVALID_CALL;
    *description = (struct d3d9_index_buffer_desc){.format = buffer->format,
                                                   .type = buffer->resource.type,
                                                   .usage = buffer->resource.usage,
                                                   .pool = buffer->resource.pool,
                                                   .size = buffer->bytes};
    return D3D9_OK;
}
