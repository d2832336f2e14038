#include "host.h"
#include "call.h"
#include "object.h"
#include <stdlib.h>

struct adapter {
    struct d3d9_host_adapter adapter;
    struct d3d9_host_mode *modes;
    uint32_t count;
};

static struct adapter adapters[D3D9_HOST_ADAPTERS];
static uint32_t adapter_count;

struct event {
    struct event *next;
    struct d3d9_host_event event;
};

static struct event *events; /* the last one first */

int32_t d3d9_host_start(const struct d3d9_host_face *faces, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (faces[i].number < D3D9_INTERFACE_COUNT)
            d3d9_object_set_face(faces[i].number, faces[i].vtable);
    return D3D9_OK;
}

int32_t d3d9_host_set_adapter(uint32_t index, const struct d3d9_host_adapter *adapter,
                              const struct d3d9_host_mode *modes, uint32_t count)
{
    if (index >= D3D9_HOST_ADAPTERS)
        return D3D9_INVALID_CALL;
    struct d3d9_host_mode *copy = malloc((count ? count : 1) * sizeof *copy);
    if (!copy)
        return D3D9_OUT_OF_MEMORY;
    if (count)
        memcpy(copy, modes, count * sizeof *copy);
    free(adapters[index].modes);
    adapters[index] = (struct adapter){*adapter, copy, count};
    return D3D9_OK;
}

int32_t d3d9_host_set_adapter_count(uint32_t count)
{
    if (count > D3D9_HOST_ADAPTERS)
        return D3D9_INVALID_CALL;
    adapter_count = count;
    return D3D9_OK;
}

int32_t d3d9_host_set_mode(uint32_t index, const struct d3d9_host_mode *mode)
{
    if (index >= adapter_count)
        return D3D9_INVALID_CALL;
    adapters[index].adapter.current = *mode;
    return D3D9_OK;
}

uint32_t d3d9_host_adapter_count(void)
{
    return adapter_count;
}

const struct d3d9_host_adapter *d3d9_host_adapter(uint32_t index)
{
    return index < adapter_count ? &adapters[index].adapter : NULL;
}

const struct d3d9_host_mode *d3d9_host_modes(uint32_t index, uint32_t *count)
{
    *count = index < adapter_count ? adapters[index].count : 0;
    return index < adapter_count ? adapters[index].modes : NULL;
}

void d3d9_host_event(enum d3d9_host_event_kind kind, uint64_t pointer)
{
    struct event *event = malloc(sizeof *event);
    if (!event)
        return;
    *event = (struct event){events, {kind, 0, pointer}};
    events = event;
}

bool d3d9_host_has_events(void)
{
    return events || d3d9_foreign_waits();
}

uint32_t d3d9_host_take_events(struct d3d9_host_event *out, uint32_t room)
{
    uint32_t count = 0;
    for (; events && count < room; count++) {
        struct event *first = events;
        out[count] = first->event;
        events = first->next;
        free(first);
    }
    for (uint64_t pointer; count < room && d3d9_foreign_take(&pointer, 1); count++)
        out[count] = (struct d3d9_host_event){D3D9_EVENT_RELEASE, 0, pointer};
    return count;
}
