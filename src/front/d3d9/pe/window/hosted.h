/* The methods that are written by hand: their rows in the table of calls are HOSTED or LOCAL. */
#ifndef D3D9_PE_HOSTED_H
#define D3D9_PE_HOSTED_H

#include <windows.h>
#include <d3d9.h>

HRESULT WINAPI hosted_factory_GetAdapterDisplayMode(IDirect3D9Ex *, UINT adapter, D3DDISPLAYMODE *);
HRESULT WINAPI hosted_factory_GetAdapterDisplayModeEx(IDirect3D9Ex *, UINT adapter, D3DDISPLAYMODEEX *,
                                                      D3DDISPLAYROTATION *);
HMONITOR WINAPI hosted_factory_GetAdapterMonitor(IDirect3D9Ex *, UINT adapter);
HRESULT WINAPI hosted_factory_CreateDevice(IDirect3D9Ex *, UINT adapter, D3DDEVTYPE, HWND focus, DWORD flags,
                                           D3DPRESENT_PARAMETERS *, IDirect3DDevice9 **);
HRESULT WINAPI hosted_factory_CreateDeviceEx(IDirect3D9Ex *, UINT adapter, D3DDEVTYPE, HWND focus,
                                             DWORD flags, D3DPRESENT_PARAMETERS *, D3DDISPLAYMODEEX *,
                                             IDirect3DDevice9Ex **);

HRESULT WINAPI hosted_device_GetDisplayMode(IDirect3DDevice9Ex *, UINT swapchain, D3DDISPLAYMODE *);
HRESULT WINAPI hosted_device_GetDisplayModeEx(IDirect3DDevice9Ex *, UINT swapchain, D3DDISPLAYMODEEX *,
                                              D3DDISPLAYROTATION *);
HRESULT WINAPI hosted_device_GetRasterStatus(IDirect3DDevice9Ex *, UINT swapchain, D3DRASTER_STATUS *);
HRESULT WINAPI hosted_device_CreateAdditionalSwapChain(IDirect3DDevice9Ex *, D3DPRESENT_PARAMETERS *,
                                                       IDirect3DSwapChain9 **);
HRESULT WINAPI hosted_device_Reset(IDirect3DDevice9Ex *, D3DPRESENT_PARAMETERS *);
HRESULT WINAPI hosted_device_ResetEx(IDirect3DDevice9Ex *, D3DPRESENT_PARAMETERS *, D3DDISPLAYMODEEX *);
HRESULT WINAPI hosted_device_CheckDeviceState(IDirect3DDevice9Ex *, HWND);
HRESULT WINAPI hosted_device_Present(IDirect3DDevice9Ex *, const RECT *source, const RECT *destination, HWND,
                                     const RGNDATA *dirty);
HRESULT WINAPI hosted_device_PresentEx(IDirect3DDevice9Ex *, const RECT *source, const RECT *destination,
                                       HWND, const RGNDATA *dirty, DWORD flags);
HRESULT WINAPI hosted_device_SetCursorProperties(IDirect3DDevice9Ex *, UINT x, UINT y, IDirect3DSurface9 *);
void WINAPI hosted_device_SetCursorPosition(IDirect3DDevice9Ex *, int x, int y, DWORD flags);
BOOL WINAPI hosted_device_ShowCursor(IDirect3DDevice9Ex *, BOOL show);

HRESULT WINAPI hosted_swapchain_Present(IDirect3DSwapChain9Ex *, const RECT *source, const RECT *destination,
                                        HWND, const RGNDATA *dirty, DWORD flags);
HRESULT WINAPI hosted_swapchain_GetRasterStatus(IDirect3DSwapChain9Ex *, D3DRASTER_STATUS *);
HRESULT WINAPI hosted_swapchain_GetDisplayMode(IDirect3DSwapChain9Ex *, D3DDISPLAYMODE *);
HRESULT WINAPI hosted_swapchain_GetDisplayModeEx(IDirect3DSwapChain9Ex *, D3DDISPLAYMODEEX *,
                                                 D3DDISPLAYROTATION *);

HRESULT WINAPI hosted_surface_GetDC(IDirect3DSurface9 *, HDC *);
HRESULT WINAPI hosted_surface_ReleaseDC(IDirect3DSurface9 *, HDC);

#endif
