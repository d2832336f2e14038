/* Methods of the device that depend on its windows or on the display. */
#include "hosted.h"
#include "adapter.h"
#include "front/d3d9/call.h"
#include "factory.h"
#include "fullscreen.h"

HRESULT WINAPI hosted_device_GetDisplayMode(IDirect3DDevice9Ex *self, UINT swapchain, D3DDISPLAYMODE *mode)
{
    adapter_renew_all();
    return d3d9_device_get_display_mode((void *)self, swapchain, (void *)mode);
}

HRESULT WINAPI hosted_device_GetDisplayModeEx(IDirect3DDevice9Ex *self, UINT swapchain,
                                              D3DDISPLAYMODEEX *mode, D3DDISPLAYROTATION *rotation)
{
    adapter_renew_all();
    return d3d9_device_get_display_mode_ex((void *)self, swapchain, (void *)mode, (void *)rotation);
}

HRESULT WINAPI hosted_device_GetRasterStatus(IDirect3DDevice9Ex *self, UINT swapchain,
                                             D3DRASTER_STATUS *status)
{
    adapter_renew_all();
    return d3d9_device_get_raster_status((void *)self, swapchain, (void *)status);
}

HRESULT WINAPI hosted_swapchain_GetRasterStatus(IDirect3DSwapChain9Ex *self, D3DRASTER_STATUS *status)
{
    adapter_renew_all();
    return d3d9_swapchain_get_raster_status((void *)self, (void *)status);
}

HRESULT WINAPI hosted_swapchain_GetDisplayMode(IDirect3DSwapChain9Ex *self, D3DDISPLAYMODE *mode)
{
    adapter_renew_all();
    return d3d9_swapchain_get_display_mode((void *)self, (void *)mode);
}

HRESULT WINAPI hosted_swapchain_GetDisplayModeEx(IDirect3DSwapChain9Ex *self, D3DDISPLAYMODEEX *mode,
                                                 D3DDISPLAYROTATION *rotation)
{
    adapter_renew_all();
    return d3d9_swapchain_get_display_mode_ex((void *)self, (void *)mode, (void *)rotation);
}

static struct d3d9_host_window target_of(IDirect3DDevice9Ex *self, const D3DPRESENT_PARAMETERS *parameters)
{
    return factory_window(parameters && parameters->hDeviceWindow ? parameters->hDeviceWindow
                                                                  : device_data_of(self)->focus);
}

HRESULT WINAPI hosted_device_CreateAdditionalSwapChain(IDirect3DDevice9Ex *self,
                                                       D3DPRESENT_PARAMETERS *parameters,
                                                       IDirect3DSwapChain9 **swapchain)
{
    struct d3d9_host_window target = target_of(self, parameters);
    return d3d9_device_create_additional_swap_chain((void *)self, (void *)parameters, (void *)swapchain,
                                                    &target);
}

static HRESULT finish_reset(IDirect3DDevice9Ex *self, HRESULT result, const D3DPRESENT_PARAMETERS *parameters)
{
    if (FAILED(result))
        return result;
    return fullscreen_apply(device_data_of(self), parameters) ? result : D3DERR_NOTAVAILABLE;
}

HRESULT WINAPI hosted_device_Reset(IDirect3DDevice9Ex *self, D3DPRESENT_PARAMETERS *parameters)
{
    struct d3d9_host_window target = target_of(self, parameters);
    adapter_renew_all();
    return finish_reset(self, d3d9_device_reset((void *)self, (void *)parameters, &target), parameters);
}

HRESULT WINAPI hosted_device_ResetEx(IDirect3DDevice9Ex *self, D3DPRESENT_PARAMETERS *parameters,
                                     D3DDISPLAYMODEEX *mode)
{
    struct d3d9_host_window target = target_of(self, parameters);
    adapter_renew_all();
    return finish_reset(self, d3d9_device_reset_ex((void *)self, (void *)parameters, (void *)mode, &target),
                        parameters);
}

HRESULT WINAPI hosted_device_CheckDeviceState(IDirect3DDevice9Ex *self, HWND window)
{
    struct d3d9_host_window target = factory_window(window);
    return d3d9_device_check_device_state((void *)self, (uintptr_t)window, &target);
}
