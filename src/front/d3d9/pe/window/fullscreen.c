#include "fullscreen.h"
#include "adapter.h"
#include "hook.h"
#include "front/d3d9/call.h"
#include <stdlib.h>

static void device_data_free(struct object_data *head)
{
    struct device_data *data = (struct device_data *)head;
    fullscreen_leave(data);
    bitmap_free(&data->bitmap);
    if (data->cursor)
        DestroyCursor(data->cursor);
    free(data);
}

struct device_data *device_data_make(IDirect3DDevice9Ex *device, UINT adapter, HWND focus, DWORD flags,
                                     BOOL extended)
{
    struct device_data *data = calloc(1, sizeof *data);
    if (!data)
        return NULL;
    data->head.free = device_data_free;
    data->device = device;
    data->adapter = adapter;
    data->focus = focus;
    data->flags = flags;
    data->extended = extended;
    return data;
}

static BOOL may_change_window(const struct device_data *data)
{
    return !(data->flags & D3DCREATE_NOWINDOWCHANGES);
}

/* The monitor's corner, and the size of the mode. */
static RECT screen(const struct device_data *data)
{
    MONITORINFO information = {.cbSize = sizeof information};
    GetMonitorInfoW(adapter_monitor(data->adapter), &information);
    RECT r = information.rcMonitor;
    return (RECT){r.left, r.top, r.left + (LONG)data->width, r.top + (LONG)data->height};
}

/* A window without a frame. WS_SYSMENU keeps it managed, so that it gets the keyboard. */
static LONG screen_style(LONG style)
{
    return (style | WS_POPUP | WS_SYSMENU) & ~(WS_CAPTION | WS_THICKFRAME);
}

static LONG screen_extended_style(LONG style)
{
    return style & ~(WS_EX_CLIENTEDGE | WS_EX_WINDOWEDGE);
}

/* A minimized window cannot cover the screen. */
static void unminimize(const struct device_data *data)
{
    if (may_change_window(data) && IsIconic(data->window))
        ShowWindow(data->window, SW_SHOWNOACTIVATE);
}

static void cover_screen(struct device_data *data)
{
    unminimize(data);
    RECT r = screen(data);
    UINT flags =
        SWP_FRAMECHANGED | SWP_NOACTIVATE | (may_change_window(data) ? SWP_SHOWWINDOW : SWP_NOZORDER);
    data->style = GetWindowLongW(data->window, GWL_STYLE);
    data->extended_style = GetWindowLongW(data->window, GWL_EXSTYLE);
    SetWindowLongW(data->window, GWL_STYLE, screen_style(data->style));
    SetWindowLongW(data->window, GWL_EXSTYLE, screen_extended_style(data->extended_style));
    SetWindowPos(data->window, HWND_TOPMOST, r.left, r.top, r.right - r.left, r.bottom - r.top, flags);
}

/* How the window is shown after full screen. Devices of Direct3D 9 leave it visible and topmost; those of
 * Direct3D 9Ex restore what it was. */
static UINT shown_flags(const struct device_data *data)
{
    if (!data->extended || !may_change_window(data))
        return SWP_NOZORDER;
    return data->style & WS_VISIBLE ? SWP_SHOWWINDOW : SWP_HIDEWINDOW;
}

/* A style that the program has changed in the meantime stays. */
static void uncover_screen(const struct device_data *data)
{
    LONG style = GetWindowLongW(data->window, GWL_STYLE);
    LONG extended = GetWindowLongW(data->window, GWL_EXSTYLE);
    LONG visible = style & WS_VISIBLE, topmost = extended & WS_EX_TOPMOST;
    if (!IsWindow(data->window))
        return;
    if ((style & ~WS_VISIBLE) == (screen_style(data->style) & ~WS_VISIBLE) &&
        (extended & ~WS_EX_TOPMOST) == (screen_extended_style(data->extended_style) & ~WS_EX_TOPMOST)) {
        SetWindowLongW(data->window, GWL_STYLE, (data->style & ~WS_VISIBLE) | visible);
        SetWindowLongW(data->window, GWL_EXSTYLE, (data->extended_style & ~WS_EX_TOPMOST) | topmost);
    }
    SetWindowPos(data->window, data->extended_style & WS_EX_TOPMOST ? HWND_TOPMOST : HWND_NOTOPMOST, 0, 0, 0,
                 0, SWP_FRAMECHANGED | SWP_NOMOVE | SWP_NOSIZE | SWP_NOACTIVATE | shown_flags(data));
}

/* A window that is in full screen already. */
static void refit_screen(struct device_data *data)
{
    RECT r = screen(data);
    if (!may_change_window(data))
        return;
    unminimize(data);
    MoveWindow(data->window, r.left, r.top, r.right - r.left, r.bottom - r.top, TRUE);
    ShowWindow(data->window, SW_SHOW);
}

static BOOL enter(struct device_data *data, const D3DPRESENT_PARAMETERS *parameters)
{
    HWND window = parameters->hDeviceWindow ? parameters->hDeviceWindow : data->focus;
    BOOL covered = data->fullscreen && window == data->window;
    if (!data->fullscreen && data->focus) {
        hook_set(data);
        SetWindowPos(data->focus, NULL, 0, 0, 0, 0, SWP_NOSIZE | SWP_NOMOVE);
    }
    data->window = window;
    data->fullscreen = TRUE;
    data->width = parameters->BackBufferWidth;
    data->height = parameters->BackBufferHeight;
    data->refresh_rate = parameters->FullScreen_RefreshRateInHz;
    data->format = parameters->BackBufferFormat;
    data->filter = TRUE;
    /* The window's own style is read before the change of the mode, by which window managers change it. */
    if (!covered)
        cover_screen(data);
    BOOL set = adapter_set_mode(data->adapter, data->width, data->height, data->refresh_rate, data->format);
    if (covered)
        refit_screen(data);
    data->filter = FALSE;
    return set;
}

void fullscreen_leave(struct device_data *data)
{
    if (!data->fullscreen)
        return;
    data->filter = TRUE;
    adapter_restore_modes();
    uncover_screen(data);
    data->filter = FALSE;
    data->fullscreen = FALSE;
    hook_remove(data);
}

BOOL fullscreen_apply(struct device_data *data, const D3DPRESENT_PARAMETERS *parameters)
{
    if (!parameters->Windowed)
        return enter(data, parameters);
    fullscreen_leave(data);
    data->window = parameters->hDeviceWindow ? parameters->hDeviceWindow : data->focus;
    return TRUE;
}

void fullscreen_activate(struct device_data *data, BOOL active)
{
    RECT r = screen(data);
    if (!data->fullscreen)
        return;
    data->filter = TRUE;
    if (active) {
        if (may_change_window(data))
            SetWindowPos(data->window, NULL, r.left, r.top, r.right - r.left, r.bottom - r.top,
                         SWP_NOACTIVATE | SWP_NOZORDER);
        if (data->extended)
            adapter_set_mode(data->adapter, data->width, data->height, data->refresh_rate, data->format);
    } else {
        adapter_restore_modes();
        if (may_change_window(data) && IsWindowVisible(data->window))
            ShowWindow(data->window, SW_MINIMIZE);
    }
    data->filter = FALSE;
    d3d9_device_activate((void *)data->device, active);
}
