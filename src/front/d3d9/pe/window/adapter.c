#include "adapter.h"
#include "front/d3d9/call.h"
#include <stdlib.h>

struct adapter {
    WCHAR name[CCHDEVICENAME];
    HMONITOR monitor;
    LUID luid;
};

static struct adapter adapters[D3D9_HOST_ADAPTERS];
static UINT adapter_count;

/* Windows' table of display adapters by LUID (d3dkmthk.h). */
struct open_adapter {
    WCHAR name[CCHDEVICENAME];
    UINT adapter;
    LUID luid;
    UINT source;
};
struct close_adapter {
    UINT adapter;
};
typedef LONG(WINAPI *open_function)(struct open_adapter *);
typedef LONG(WINAPI *close_function)(const struct close_adapter *);

static LUID luid_of(const WCHAR *name)
{
    HMODULE gdi = GetModuleHandleA("gdi32.dll");
    open_function open = (open_function)(void *)GetProcAddress(gdi, "D3DKMTOpenAdapterFromGdiDisplayName");
    close_function close = (close_function)(void *)GetProcAddress(gdi, "D3DKMTCloseAdapter");
    struct open_adapter found = {.adapter = 0};
    lstrcpynW(found.name, name, CCHDEVICENAME);
    if (!open || !close || open(&found))
        return (LUID){0, 0};
    close(&(struct close_adapter){found.adapter});
    return found.luid;
}

static UINT32 format_of(DWORD bits)
{
    return bits == 32 ? D3DFMT_X8R8G8B8 : bits == 16 ? D3DFMT_R5G6B5 : D3DFMT_UNKNOWN;
}

static struct d3d9_host_mode host_mode(const DEVMODEW *mode)
{
    return (struct d3d9_host_mode){mode->dmPelsWidth, mode->dmPelsHeight,
                                   mode->dmDisplayFrequency > 1 ? mode->dmDisplayFrequency : 60,
                                   format_of(mode->dmBitsPerPel), mode->dmDisplayOrientation + 1};
}

static BOOL read_mode(const WCHAR *name, DWORD which, struct d3d9_host_mode *mode)
{
    DEVMODEW device_mode = {.dmSize = sizeof device_mode};
    if (!EnumDisplaySettingsW(name, which, &device_mode))
        return FALSE;
    *mode = host_mode(&device_mode);
    return TRUE;
}

/* Hands over the modes whose format Direct3D can have. */
static void register_adapter(UINT index)
{
    const struct adapter *adapter = &adapters[index];
    struct d3d9_host_adapter description = {.monitor = (uintptr_t)adapter->monitor};
    struct d3d9_host_mode *modes = NULL, mode;
    UINT count = 0;
    memcpy(&description.luid, &adapter->luid, sizeof adapter->luid);
    WideCharToMultiByte(CP_ACP, 0, adapter->name, -1, description.name, sizeof description.name, NULL, NULL);
    read_mode(adapter->name, ENUM_CURRENT_SETTINGS, &description.current);
    read_mode(adapter->name, ENUM_REGISTRY_SETTINGS, &description.desktop);
    for (DWORD i = 0; read_mode(adapter->name, i, &mode); i++) {
        struct d3d9_host_mode *more = mode.format ? realloc(modes, (count + 1) * sizeof *modes) : NULL;
        if (!more)
            continue;
        modes = more;
        modes[count++] = mode;
    }
    d3d9_host_set_adapter(index, &description, modes, count);
    free(modes);
}

static BOOL CALLBACK find_monitor(HMONITOR monitor, HDC dc, RECT *rectangle, LPARAM parameter)
{
    struct adapter *adapter = (struct adapter *)parameter;
    MONITORINFOEXW information = {.cbSize = sizeof information};
    (void)dc, (void)rectangle;
    if (GetMonitorInfoW(monitor, (MONITORINFO *)&information) &&
        !lstrcmpiW(information.szDevice, adapter->name))
        adapter->monitor = monitor;
    return !adapter->monitor;
}

static void add_adapter(const DISPLAY_DEVICEW *device)
{
    struct adapter adapter = {.monitor = NULL};
    lstrcpynW(adapter.name, device->DeviceName, CCHDEVICENAME);
    EnumDisplayMonitors(NULL, NULL, find_monitor, (LPARAM)&adapter);
    adapter.luid = luid_of(adapter.name);
    adapters[adapter_count++] = adapter;
}

/* The primary device first. */
static void find_adapters(BOOL primary)
{
    DISPLAY_DEVICEW device = {.cb = sizeof device};
    for (DWORD i = 0; EnumDisplayDevicesW(NULL, i, &device, 0) && adapter_count < D3D9_HOST_ADAPTERS; i++)
        if (device.StateFlags & DISPLAY_DEVICE_ATTACHED_TO_DESKTOP &&
            !(device.StateFlags & DISPLAY_DEVICE_PRIMARY_DEVICE) == !primary)
            add_adapter(&device);
}

BOOL adapter_register(void)
{
    adapter_count = 0;
    find_adapters(TRUE);
    find_adapters(FALSE);
    for (UINT i = 0; i < adapter_count; i++)
        register_adapter(i);
    d3d9_host_set_adapter_count(adapter_count);
    return adapter_count > 0;
}

HMONITOR adapter_monitor(UINT adapter)
{
    return adapter < adapter_count ? adapters[adapter].monitor : NULL;
}

void adapter_renew(UINT adapter)
{
    struct d3d9_host_mode mode;
    if (adapter < adapter_count && read_mode(adapters[adapter].name, ENUM_CURRENT_SETTINGS, &mode))
        d3d9_host_set_mode(adapter, &mode);
}

void adapter_renew_all(void)
{
    for (UINT i = 0; i < adapter_count; i++)
        adapter_renew(i);
}

BOOL adapter_set_mode(UINT adapter, UINT width, UINT height, UINT refresh_rate, D3DFORMAT format)
{
    struct d3d9_host_mode now;
    DEVMODEW mode = {.dmSize = sizeof mode,
                     .dmFields = DM_PELSWIDTH | DM_PELSHEIGHT | DM_BITSPERPEL,
                     .dmPelsWidth = width,
                     .dmPelsHeight = height,
                     .dmBitsPerPel = format == D3DFMT_R5G6B5 || format == D3DFMT_X1R5G5B5 ? 16 : 32,
                     .dmDisplayFrequency = refresh_rate};
    if (adapter >= adapter_count)
        return FALSE;
    if (refresh_rate)
        mode.dmFields |= DM_DISPLAYFREQUENCY;
    if (read_mode(adapters[adapter].name, ENUM_CURRENT_SETTINGS, &now) && now.width == width &&
        now.height == height && now.format == format_of(mode.dmBitsPerPel) &&
        (!refresh_rate || now.refresh_rate == refresh_rate))
        return TRUE;
    LONG result = ChangeDisplaySettingsExW(adapters[adapter].name, &mode, NULL, CDS_FULLSCREEN, NULL);
    adapter_renew(adapter);
    return result == DISP_CHANGE_SUCCESSFUL;
}

void adapter_restore_modes(void)
{
    ChangeDisplaySettingsExW(NULL, NULL, NULL, 0, NULL);
    adapter_renew_all();
}
