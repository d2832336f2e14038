/* The methods of a device for its swap chains, the display and the state of its presentation. */
#include "front/d3d9/adapter/caps.h"
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "swapchain.h"

/* The implicit swap chain is the only one with a number. */
static struct d3d9_swapchain *chain_at(const struct d3d9_device *device, uint32_t index)
{
    return index ? NULL : device->presentation.chain;
}

int32_t d3d9_device_create_additional_swap_chain(struct d3d9_device *device,
                                                 struct d3d9_present_parameters *parameters,
                                                 struct d3d9_swapchain **out,
                                                 const struct d3d9_host_window *window)
{
    if (!out)
        return D3D9_INVALID_CALL;
    *out = NULL;
    if (!parameters || !parameters->windowed || !device->presentation.chain->parameters.windowed)
        return D3D9_INVALID_CALL;
    int32_t result = d3d9_parameters_complete(parameters, device->creation.adapter, window, device->extended);
    if (result < 0)
        return result;
    struct d3d9_present_parameters complete = *parameters;
    if (!complete.device_window)
        complete.device_window = device->creation.focus_window;
    if (!complete.device_window)
        return D3D9_INVALID_CALL;
    return d3d9_swapchain_make(device, &complete, false, out);
}

int32_t d3d9_device_get_swap_chain(struct d3d9_device *device, uint32_t index, struct d3d9_swapchain **out)
{
    if (!out)
        return D3D9_INVALID_CALL;
    *out = chain_at(device, index);
    if (!*out)
        return D3D9_INVALID_CALL;
    d3d9_object_add_ref(&(*out)->object);
    return D3D9_OK;
}

uint32_t d3d9_device_get_number_of_swap_chains(struct d3d9_device *device)
{
    (void)device;
    return 1;
}

int32_t d3d9_device_get_back_buffer(struct d3d9_device *device, uint32_t index, uint32_t buffer,
                                    uint32_t type, struct d3d9_surface **surface)
{
    struct d3d9_swapchain *chain = chain_at(device, index);
    if (!surface)
        return D3D9_INVALID_CALL;
    *surface = NULL;
    return chain ? d3d9_swapchain_get_back_buffer(chain, buffer, type, surface) : D3D9_INVALID_CALL;
}

int32_t d3d9_device_get_front_buffer_data(struct d3d9_device *device, uint32_t index,
                                          struct d3d9_surface *destination)
{
    struct d3d9_swapchain *chain = chain_at(device, index);
    return chain ? d3d9_swapchain_get_front_buffer_data(chain, destination) : D3D9_INVALID_CALL;
}

int32_t d3d9_device_get_raster_status(struct d3d9_device *device, uint32_t index,
                                      struct d3d9_raster_status *status)
{
    struct d3d9_swapchain *chain = chain_at(device, index);
    return chain ? d3d9_swapchain_get_raster_status(chain, status) : D3D9_INVALID_CALL;
}

int32_t d3d9_device_get_display_mode(struct d3d9_device *device, uint32_t index,
                                     struct d3d9_display_mode *mode)
{
    struct d3d9_swapchain *chain = chain_at(device, index);
    return chain ? d3d9_swapchain_get_display_mode(chain, mode) : D3D9_INVALID_CALL;
}

int32_t d3d9_device_get_display_mode_ex(struct d3d9_device *device, uint32_t index,
                                        struct d3d9_display_mode_ex *mode, uint32_t *rotation)
{
    struct d3d9_swapchain *chain = chain_at(device, index);
    return chain ? d3d9_swapchain_get_display_mode_ex(chain, mode, rotation) : D3D9_INVALID_CALL;
}

int32_t d3d9_device_get_device_caps(struct d3d9_device *device, struct d3d9_caps *caps)
{
    if (!caps)
        return D3D9_INVALID_CALL;
    d3d9_caps_fill(device->creation.adapter, device->extended, caps);
    if (device->creation.behavior_flags & D3D9_CREATE_SOFTWARE_VERTICES)
        caps->max_vertex_shader_const = device->vertex_floats;
    return D3D9_OK;
}

void d3d9_device_set_gamma_ramp(struct d3d9_device *device, uint32_t index, uint32_t flags,
                                const struct d3d9_gamma_ramp *ramp)
{
    (void)flags;
    if (ramp && chain_at(device, index))
        device->presentation.gamma = *ramp;
}

void d3d9_device_get_gamma_ramp(struct d3d9_device *device, uint32_t index, struct d3d9_gamma_ramp *ramp)
{
    if (ramp && chain_at(device, index))
        *ramp = device->presentation.gamma;
}

/* --- Lost devices --- */

int32_t d3d9_device_activate(struct d3d9_device *device, int32_t active)
{
    struct d3d9_presentation *state = &device->presentation;
    if (!state->chain || state->chain->parameters.windowed)
        return D3D9_OK;
    state->inactive = !active;
    if (!active && !device->extended)
        state->lost = true;
    return D3D9_OK;
}

int32_t d3d9_device_test_cooperative_level(struct d3d9_device *device)
{
    const struct d3d9_presentation *state = &device->presentation;
    if (device->extended)
        return D3D9_OK;
    if (state->lost && state->inactive)
        return D3D9_DEVICE_LOST;
    return state->lost || state->not_reset ? D3D9_DEVICE_NOT_RESET : D3D9_OK;
}

/* In full screen, the device's window is hidden without the focus, and other windows are hidden with it. */
int32_t d3d9_device_check_device_state(struct d3d9_device *device, uint64_t window,
                                       const struct d3d9_host_window *target)
{
    (void)target;
    const struct d3d9_swapchain *chain = device->presentation.chain;
    if (chain->parameters.windowed)
        return D3D9_OK;
    bool own = window == chain->parameters.device_window;
    return own == device->presentation.inactive ? D3D9_PRESENT_OCCLUDED : D3D9_OK;
}

/* --- IDirect3DDevice9Ex --- */

enum { LATENCY_DEFAULT = 3, LATENCY_MOST = 30, PRIORITY_MOST = 7 };

int32_t d3d9_device_set_maximum_frame_latency(struct d3d9_device *device, uint32_t frames)
{
    if (frames > LATENCY_MOST)
        return D3D9_INVALID_CALL;
    device->frame_latency = frames;
    return D3D9_OK;
}

int32_t d3d9_device_get_maximum_frame_latency(struct d3d9_device *device, uint32_t *frames)
{
    if (!frames)
        return D3D9_INVALID_CALL;
    *frames = device->frame_latency ? device->frame_latency : LATENCY_DEFAULT;
    return D3D9_OK;
}

int32_t d3d9_device_set_gpu_thread_priority(struct d3d9_device *device, int32_t priority)
{
    if (priority < -PRIORITY_MOST || priority > PRIORITY_MOST)
        return D3D9_INVALID_CALL;
    device->gpu_priority = priority;
    return D3D9_OK;
}

int32_t d3d9_device_get_gpu_thread_priority(struct d3d9_device *device, int32_t *priority)
{
    if (!priority)
        return D3D9_INVALID_CALL;
    *priority = device->gpu_priority;
    return D3D9_OK;
}

int32_t d3d9_device_wait_for_v_blank(struct d3d9_device *device, uint32_t index)
{
    return chain_at(device, index) ? D3D9_OK : D3D9_INVALID_CALL;
}

int32_t d3d9_device_set_convolution_mono_kernel(struct d3d9_device *device, uint32_t width, uint32_t height,
                                                float *rows, float *columns)
{
    (void)device, (void)width, (void)height, (void)rows, (void)columns;
    return D3D9_INVALID_CALL;
}

int32_t d3d9_device_compose_rects(struct d3d9_device *device, struct d3d9_surface *source,
                                  struct d3d9_surface *destination,
                                  struct d3d9_vertex_buffer *source_rectangles, uint32_t count,
                                  struct d3d9_vertex_buffer *destination_rectangles, uint32_t operation,
                                  int32_t x, int32_t y)
{
    (void)device, (void)source, (void)destination, (void)source_rectangles, (void)count;
    (void)destination_rectangles, (void)operation, (void)x, (void)y;
    return D3D9_INVALID_CALL;
}
