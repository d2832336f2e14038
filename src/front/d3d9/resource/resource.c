#include "front/d3d9/resource.h"
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"

void d3d9_resource_begin(struct d3d9_resource *resource, struct d3d9_device *device,
                         enum d3d9_resource_type type, uint32_t usage, enum d3d9_pool pool)
{
    resource->device = device;
    resource->type = type;
    resource->usage = usage;
    resource->pool = pool;
    struct d3d9_resource **first = &device->presentation.resources;
    resource->next = *first;
    if (*first)
        (*first)->last = resource;
    *first = resource;
}

void d3d9_resource_end(struct d3d9_resource *resource)
{
    struct d3d9_device *device = resource->device;
    if (!device)
        return;
    if (resource->next)
        resource->next->last = resource->last;
    if (resource->last)
        resource->last->next = resource->next;
    else
        device->presentation.resources = resource->next;
    device->presentation.resource_bytes -= resource->bytes;
}

void d3d9_resource_count_bytes(struct d3d9_resource *resource, uint64_t bytes)
{
    if (resource->pool != D3D9_POOL_DEFAULT)
        return;
    resource->bytes += bytes;
    resource->device->presentation.resource_bytes += bytes;
}

bool d3d9_resource_prevents_reset(const struct d3d9_device *device)
{
    const struct d3d9_resource *resource = device->presentation.resources;
    while (resource && !(resource->pool == D3D9_POOL_DEFAULT && resource->object.references))
        resource = resource->next;
    return resource;
}

/* IDirect3DResource9. Surfaces of textures and everything outside of the managed pool have the priority 0. */
uint32_t d3d9_object_set_priority(struct d3d9_object *object, uint32_t priority)
{
    struct d3d9_resource *resource = (struct d3d9_resource *)object;
    uint32_t old = resource->priority;
    if (resource->pool == D3D9_POOL_MANAGED && resource->type != D3D9_TYPE_SURFACE)
        resource->priority = priority;
    return old;
}

uint32_t d3d9_object_get_priority(struct d3d9_object *object)
{
    return ((struct d3d9_resource *)object)->priority;
}

uint32_t d3d9_object_get_type(struct d3d9_object *object)
{
    return ((struct d3d9_resource *)object)->type;
}

int32_t d3d9_object_get_device(struct d3d9_object *object, struct d3d9_device **device)
{
    if (!device)
        return D3D9_INVALID_CALL;
    d3d9_object_add_ref(object->parent);
    *device = (struct d3d9_device *)object->parent;
    return D3D9_OK;
}
