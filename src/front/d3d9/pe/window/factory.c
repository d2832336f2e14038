#define COBJMACROS
#include "hosted.h"
#include "adapter.h"
#include "front/d3d9/call.h"
#include "factory.h"
#include "fullscreen.h"

IDirect3D9Ex *factory_make(UINT version, BOOL extended, HRESULT *result)
{
    struct d3d9_factory *factory = NULL;
    *result = D3DERR_NOTAVAILABLE;
    if (adapter_register())
        *result = d3d9_factory_create(version, extended, &factory);
    return (IDirect3D9Ex *)factory;
}

HRESULT WINAPI hosted_factory_GetAdapterDisplayMode(IDirect3D9Ex *self, UINT adapter, D3DDISPLAYMODE *mode)
{
    adapter_renew(adapter);
    return d3d9_factory_get_adapter_display_mode((void *)self, adapter, (void *)mode);
}

HRESULT WINAPI hosted_factory_GetAdapterDisplayModeEx(IDirect3D9Ex *self, UINT adapter,
                                                      D3DDISPLAYMODEEX *mode, D3DDISPLAYROTATION *rotation)
{
    adapter_renew(adapter);
    return d3d9_factory_get_adapter_display_mode_ex((void *)self, adapter, (void *)mode, (void *)rotation);
}

HMONITOR WINAPI hosted_factory_GetAdapterMonitor(IDirect3D9Ex *self, UINT adapter)
{
    (void)self;
    return adapter_monitor(adapter);
}

struct d3d9_host_window factory_window(HWND window)
{
    RECT client = {0, 0, 0, 0};
    GetClientRect(window, &client);
    return (struct d3d9_host_window){(uintptr_t)window, client.right, client.bottom, IsWindow(window),
                                     IsIconic(window)};
}

static struct d3d9_host_window target_of(const D3DPRESENT_PARAMETERS *parameters, HWND focus)
{
    return factory_window(parameters && parameters->hDeviceWindow ? parameters->hDeviceWindow : focus);
}

/* The work in Windows for a device that the Linux side has made. */
static HRESULT begin(IDirect3DDevice9Ex **device, UINT adapter, HWND focus, DWORD flags, BOOL extended,
                     const D3DPRESENT_PARAMETERS *parameters)
{
    struct device_data *data = device_data_make(*device, adapter, focus, flags, extended);
    HRESULT result = data ? D3D_OK : E_OUTOFMEMORY;
    if (data) {
        object_data_set(*device, &data->head);
        if (!fullscreen_apply(data, parameters))
            result = D3DERR_NOTAVAILABLE;
    }
    if (FAILED(result)) {
        IDirect3DDevice9Ex_Release(*device);
        *device = NULL;
        return result;
    }
#ifdef __i386__
    if (!(flags & D3DCREATE_FPU_PRESERVE)) {
        WORD control = 0x7f; /* single precision, no exceptions, as Direct3D leaves it */
        __asm__ volatile("fnclex; fldcw %0" : : "m"(control));
    }
#endif
    return D3D_OK;
}

HRESULT WINAPI hosted_factory_CreateDevice(IDirect3D9Ex *self, UINT adapter, D3DDEVTYPE type, HWND focus,
                                           DWORD flags, D3DPRESENT_PARAMETERS *parameters,
                                           IDirect3DDevice9 **device)
{
    struct d3d9_host_window target = target_of(parameters, focus);
    adapter_renew_all();
    HRESULT result = d3d9_factory_create_device((void *)self, adapter, type, (uintptr_t)focus, flags,
                                                (void *)parameters, (void *)device, &target);
    return FAILED(result) ? result
                          : begin((IDirect3DDevice9Ex **)device, adapter, focus, flags, FALSE, parameters);
}

HRESULT WINAPI hosted_factory_CreateDeviceEx(IDirect3D9Ex *self, UINT adapter, D3DDEVTYPE type, HWND focus,
                                             DWORD flags, D3DPRESENT_PARAMETERS *parameters,
                                             D3DDISPLAYMODEEX *mode, IDirect3DDevice9Ex **device)
{
    struct d3d9_host_window target = target_of(parameters, focus);
    adapter_renew_all();
    HRESULT result = d3d9_factory_create_device_ex((void *)self, adapter, type, (uintptr_t)focus, flags,
                                                   (void *)parameters, (void *)mode, (void *)device, &target);
    return FAILED(result) ? result : begin(device, adapter, focus, flags, TRUE, parameters);
}
