#include "swapchain.h"
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "front/d3d9/resource/renderer.h"

static void drop_buffers(struct d3d9_swapchain *chain)
{
    for (uint32_t i = 0; i < D3D9_MOST_BACK_BUFFERS; i++)
        d3d9_object_exchange((struct d3d9_object **)&chain->buffer[i], NULL);
}

static void destroy(struct d3d9_object *object)
{
    drop_buffers((struct d3d9_swapchain *)object);
}

static int32_t make_buffers(struct d3d9_swapchain *chain)
{
    const struct d3d9_present_parameters *p = &chain->parameters;
    const struct d3d9_surface_creation creation = {
        .width = p->back_buffer_width,
        .height = p->back_buffer_height,
        .format = p->back_buffer_format,
        .usage = D3D9_USAGE_RENDER_TARGET,
        .pool = D3D9_POOL_DEFAULT,
        .multi_sample_type = p->multi_sample_type,
        .multi_sample_quality = p->multi_sample_quality,
        .lockable = p->flags & D3D9_PRESENT_LOCKABLE,
        .implicit = true,
        .container = &chain->object,
    };
    int32_t result = D3D9_OK;
    for (uint32_t i = 0; result >= 0 && i < p->back_buffer_count; i++)
        result = d3d9_surface_make(chain->device, &creation, &chain->buffer[i]);
    if (result < 0)
        drop_buffers(chain);
    return result;
}

int32_t d3d9_swapchain_renew(struct d3d9_swapchain *chain, const struct d3d9_present_parameters *parameters)
{
    drop_buffers(chain);
    chain->parameters = *parameters;
    chain->presented = 0;
    return make_buffers(chain);
}

int32_t d3d9_swapchain_make(struct d3d9_device *device, const struct d3d9_present_parameters *parameters,
                            bool implicit, struct d3d9_swapchain **out)
{
    enum d3d9_interface interface = device->extended ? D3D9_INTERFACE_SWAPCHAIN_EX : D3D9_INTERFACE_SWAPCHAIN;
    *out = NULL;
    struct d3d9_swapchain *chain = (implicit ? d3d9_object_make_implicit : d3d9_object_make)(
        sizeof *chain, interface, &device->object, destroy);
    if (!chain)
        return D3D9_OUT_OF_MEMORY;
    chain->device = device;
    int32_t result = d3d9_swapchain_renew(chain, parameters);
    if (result >= 0)
        *out = chain;
    else if (implicit)
        d3d9_object_drop(&chain->object);
    else
        d3d9_object_release(&chain->object);
    return result;
}

/* --- IDirect3DSwapChain9Ex --- */

int32_t d3d9_swapchain_get_back_buffer(struct d3d9_swapchain *chain, uint32_t index, uint32_t type,
                                       struct d3d9_surface **surface)
{
    (void)type;
    if (!surface || index >= chain->parameters.back_buffer_count || !chain->buffer[index])
        return D3D9_INVALID_CALL;
    *surface = chain->buffer[index];
    d3d9_object_add_ref(&(*surface)->resource.object);
    return D3D9_OK;
}

int32_t d3d9_swapchain_get_present_parameters(struct d3d9_swapchain *chain,
                                              struct d3d9_present_parameters *parameters)
{
    if (!parameters)
        return D3D9_INVALID_CALL;
    *parameters = chain->parameters;
    return D3D9_OK;
}

static struct d3d9_factory *factory_of(const struct d3d9_swapchain *chain)
{
    return (struct d3d9_factory *)chain->device->object.parent;
}

int32_t d3d9_swapchain_get_display_mode(struct d3d9_swapchain *chain, struct d3d9_display_mode *mode)
{
    return d3d9_factory_get_adapter_display_mode(factory_of(chain), chain->device->creation.adapter, mode);
}

int32_t d3d9_swapchain_get_display_mode_ex(struct d3d9_swapchain *chain, struct d3d9_display_mode_ex *mode,
                                           uint32_t *rotation)
{
    return d3d9_factory_get_adapter_display_mode_ex(factory_of(chain), chain->device->creation.adapter, mode,
                                                    rotation);
}

int32_t d3d9_swapchain_get_last_present_count(struct d3d9_swapchain *chain, uint32_t *count)
{
    if (!count)
        return D3D9_INVALID_CALL;
    *count = chain->present_count;
    return D3D9_OK;
}

int32_t d3d9_swapchain_get_present_stats(struct d3d9_swapchain *chain, struct d3d9_present_stats *statistics)
{
    if (!statistics)
        return D3D9_INVALID_CALL;
    *statistics = (struct d3d9_present_stats){.present_count = chain->present_count,
                                              .present_refresh_count = chain->present_count};
    return D3D9_OK;
}
