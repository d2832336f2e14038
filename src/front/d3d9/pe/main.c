/* The exports of d3d9.dll. */
#include "vtable.h"
#include "bridge/bridge.h"
#include "window/factory.h"

static IDirect3D9Ex *make(UINT version, BOOL extended, HRESULT *result)
{
    *result = D3DERR_NOTAVAILABLE;
    return bridge_start(vtable_register) ? factory_make(version, extended, result) : NULL;
}

IDirect3D9 *WINAPI Direct3DCreate9(UINT version)
{
    HRESULT result;
    return (IDirect3D9 *)make(version, FALSE, &result);
}

HRESULT WINAPI Direct3DCreate9Ex(UINT version, IDirect3D9Ex **factory)
{
    HRESULT result;
    IDirect3D9Ex *made = make(version, TRUE, &result);
    if (factory)
        *factory = made;
    return result;
}

/* Marks for a profiler of graphics. There is none. */
int WINAPI D3DPERF_BeginEvent(D3DCOLOR color, const WCHAR *name)
{
    (void)color, (void)name;
    return -1;
}

int WINAPI D3DPERF_EndEvent(void)
{
    return -1;
}

DWORD WINAPI D3DPERF_GetStatus(void)
{
    return 0;
}

BOOL WINAPI D3DPERF_QueryRepeatFrame(void)
{
    return FALSE;
}

void WINAPI D3DPERF_SetMarker(D3DCOLOR color, const WCHAR *name)
{
    (void)color, (void)name;
}

void WINAPI D3DPERF_SetOptions(DWORD options)
{
    (void)options;
}

void WINAPI D3DPERF_SetRegion(D3DCOLOR color, const WCHAR *name)
{
    (void)color, (void)name;
}

void WINAPI DebugSetMute(void)
{
}

BOOL WINAPI DllMain(HINSTANCE instance, DWORD reason, void *reserved)
{
    if (reason == DLL_PROCESS_ATTACH)
        DisableThreadLibraryCalls(instance);
    if (reason == DLL_PROCESS_DETACH && reserved && bridge_has_started())
        d3d9_host_end();
    return TRUE;
}
