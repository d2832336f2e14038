/* The creation of devices, Reset, and their end. */
#include "front/common/renderer.h"
#include "front/d3d9/adapter/factory.h"
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "swapchain.h"
#include <stdio.h>
#include <stdlib.h>

enum { DEVICE_HARDWARE = 1 };

static struct d3d9_device *devices; /* of the process, the newest first */

static void unlink_device(struct d3d9_device *device)
{
    struct d3d9_device **link = &devices;
    while (*link && *link != device)
        link = &(*link)->presentation.next;
    if (*link)
        *link = device->presentation.next;
}

int32_t d3d9_host_end(void)
{
    for (struct d3d9_device *device = devices; device; device = device->presentation.next) {
        front_statistics_end(&device->statistics, device->renderer);
        if (device->renderer)
            triptych_record_stop(device->renderer);
    }
    return D3D9_OK;
}

/* Drops what the presentation holds, when the device is destroyed. */
static void end_presentation(struct d3d9_device *device)
{
    struct d3d9_presentation *state = &device->presentation;
    d3d9_object_exchange((struct d3d9_object **)&state->depth, NULL);
    d3d9_object_exchange((struct d3d9_object **)&state->chain, NULL);
}

static void drop_targets(struct d3d9_device *device)
{
    for (unsigned i = 0; i < TRIPTYCH_TARGETS; i++)
        d3d9_device_bind_target(device, i, NULL);
    d3d9_device_bind_depth(device, NULL);
}

static void destroy(struct d3d9_object *object)
{
    struct d3d9_device *device = (struct d3d9_device *)object;
    unlink_device(device);
    if (device->state)
        drop_targets(device);
    if (device->state)
        d3d9_device_free_state(device);
    end_presentation(device);
    front_statistics_end(&device->statistics, device->renderer);
    triptych_device_destroy(device->renderer);
}

static void make_gamma(struct d3d9_gamma_ramp *ramp)
{
    for (unsigned i = 0; i < 256; i++)
        ramp->red[i] = ramp->green[i] = ramp->blue[i] = (uint16_t)(i << 8 | i);
}

static int32_t make_renderer(struct d3d9_device *device)
{
    enum triptych_result result = front_renderer_create(&device->renderer);
    if (!result)
        front_statistics_begin(&device->statistics);
    return !result ? D3D9_OK : result == TRIPTYCH_NO_MEMORY ? D3D9_OUT_OF_MEMORY : D3D9_NOT_AVAILABLE;
}

static int32_t make_depth(struct d3d9_device *device, const struct d3d9_present_parameters *p)
{
    const struct d3d9_surface_creation creation = {
        .width = p->back_buffer_width,
        .height = p->back_buffer_height,
        .format = p->auto_depth_stencil_format,
        .usage = D3D9_USAGE_DEPTH_STENCIL,
        .pool = D3D9_POOL_DEFAULT,
        .multi_sample_type = p->multi_sample_type,
        .multi_sample_quality = p->multi_sample_quality,
        .implicit = true,
    };
    if (!p->enable_auto_depth_stencil)
        return D3D9_OK;
    return d3d9_surface_make(device, &creation, &device->presentation.depth);
}

static void bind_targets(struct d3d9_device *device)
{
    struct d3d9_viewport viewport = *device->state->viewport;
    d3d9_device_bind_target(device, 0, device->presentation.chain->buffer[0]);
    d3d9_device_bind_depth(device, device->presentation.depth);
    /* The range of depth is a value that a Reset of an extended device keeps. */
    viewport.x = viewport.y = 0;
    viewport.width = device->presentation.chain->parameters.back_buffer_width;
    viewport.height = device->presentation.chain->parameters.back_buffer_height;
    d3d9_state_set_now(device, D3D9_GROUP_VIEWPORT, 0, &viewport);
}

static int32_t begin(struct d3d9_device *device, const struct d3d9_present_parameters *p)
{
    make_gamma(&device->presentation.gamma);
    int32_t result = make_renderer(device);
    if (result < 0)
        return result;
    result = d3d9_device_make_state(device, p->enable_auto_depth_stencil);
    if (result < 0)
        return result;
    result = d3d9_swapchain_make(device, p, true, &device->presentation.chain);
    if (result < 0)
        return result;
    result = make_depth(device, p);
    if (result < 0)
        return result;
    bind_targets(device);
    return D3D9_OK;
}

static bool flags_are_valid(uint32_t flags)
{
    uint32_t vertices =
        flags & (D3D9_CREATE_SOFTWARE_VERTICES | D3D9_CREATE_HARDWARE_VERTICES | D3D9_CREATE_MIXED_VERTICES);
    bool one = vertices && !(vertices & (vertices - 1));
    return one && !(flags & D3D9_CREATE_PURE_DEVICE && vertices != D3D9_CREATE_HARDWARE_VERTICES);
}

/* The window of a swap chain without one is the focus window. A device in a window needs none: its pictures
 * are not shown. */
static int32_t choose_window(struct d3d9_present_parameters *p, uint64_t focus, bool extended)
{
    if (!p->device_window)
        p->device_window = focus;
    return p->device_window || extended || p->windowed ? D3D9_OK : D3D9_INVALID_CALL;
}

int32_t d3d9_factory_create_device(struct d3d9_factory *factory, uint32_t adapter, uint32_t type,
                                   uint64_t focus, uint32_t flags, struct d3d9_present_parameters *parameters,
                                   struct d3d9_device **out, const struct d3d9_host_window *window)
{
    enum d3d9_interface interface = factory->extended ? D3D9_INTERFACE_DEVICE_EX : D3D9_INTERFACE_DEVICE;
    if (!out)
        return D3D9_INVALID_CALL;
    *out = NULL;
    if (!parameters || !flags_are_valid(flags) || adapter >= d3d9_host_adapter_count())
        return D3D9_INVALID_CALL;
    if (type != DEVICE_HARDWARE)
        return D3D9_NOT_AVAILABLE;
    if (!parameters->windowed && !focus)
        return D3D9_INVALID_CALL;
    int32_t result = d3d9_parameters_complete(parameters, adapter, window, factory->extended);
    struct d3d9_present_parameters complete = *parameters;
    if (result >= 0)
        result = choose_window(&complete, focus, factory->extended);
    if (result < 0)
        return result;
    struct d3d9_device *device = d3d9_object_make(sizeof *device, interface, &factory->object, destroy);
    if (!device)
        return D3D9_OUT_OF_MEMORY;
    device->presentation.next = devices;
    devices = device;
    device->extended = factory->extended;
    device->creation = (struct d3d9_creation_parameters){
        adapter,
        type,
        focus ? focus : complete.device_window,
        flags,
    };
    result = begin(device, &complete);
    if (result < 0)
        d3d9_object_release(&device->object);
    else
        *out = device;
    return result;
}

int32_t d3d9_factory_create_device_ex(struct d3d9_factory *factory, uint32_t adapter, uint32_t type,
                                      uint64_t focus, uint32_t flags,
                                      struct d3d9_present_parameters *parameters,
                                      struct d3d9_display_mode_ex *mode, struct d3d9_device **out,
                                      const struct d3d9_host_window *window)
{
    if (!out)
        return D3D9_INVALID_CALL;
    *out = NULL;
    if (!parameters || d3d9_parameters_check_mode(parameters, mode) < 0)
        return D3D9_INVALID_CALL;
    return d3d9_factory_create_device(factory, adapter, type, focus, flags, parameters, out, window);
}

/* --- Reset --- */

/* A failed Reset of a device that is not extended leaves it without use until the next one. */
static int32_t refuse(struct d3d9_device *device, int32_t result)
{
    if (!device->extended)
        device->presentation.not_reset = true;
    return result;
}

static int32_t renew(struct d3d9_device *device, const struct d3d9_present_parameters *p)
{
    struct d3d9_presentation *state = &device->presentation;
    drop_targets(device);
    d3d9_object_exchange((struct d3d9_object **)&state->depth, NULL);
    int32_t result = d3d9_swapchain_renew(state->chain, p);
    if (result < 0)
        return result;
    result = make_depth(device, p);
    if (result < 0)
        return result;
    if (!device->extended)
        d3d9_device_reset_state(device, p->enable_auto_depth_stencil);
    bind_targets(device);
    device->in_scene = false;
    state->lost = state->not_reset = state->inactive = false;
    return D3D9_OK;
}

int32_t d3d9_device_reset(struct d3d9_device *device, struct d3d9_present_parameters *parameters,
                          const struct d3d9_host_window *window)
{
    const struct d3d9_presentation *state = &device->presentation;
    if (!parameters)
        return D3D9_INVALID_CALL;
    if (state->lost && state->inactive)
        return D3D9_DEVICE_LOST;
    if (!device->extended && d3d9_resource_prevents_reset(device))
        return refuse(device, D3D9_INVALID_CALL);
    int32_t result = d3d9_parameters_complete(parameters, device->creation.adapter, window, device->extended);
    struct d3d9_present_parameters complete = *parameters;
    if (result >= 0)
        result = choose_window(&complete, device->creation.focus_window, device->extended);
    if (result >= 0)
        result = renew(device, &complete);
    return result < 0 ? refuse(device, result) : D3D9_OK;
}

int32_t d3d9_device_reset_ex(struct d3d9_device *device, struct d3d9_present_parameters *parameters,
                             struct d3d9_display_mode_ex *mode, const struct d3d9_host_window *window)
{
    if (!parameters || d3d9_parameters_check_mode(parameters, mode) < 0)
        return D3D9_INVALID_CALL;
    return d3d9_device_reset(device, parameters, window);
}
