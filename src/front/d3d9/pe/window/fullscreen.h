/* The windows of a device: full screen, focus, and the cursor.
 *
 * A device in full screen covers its monitor with its device window and replaces the window procedure of its
 * focus window. When the program loses the focus, the display modes are restored, the device window is
 * minimized and the device is lost. With D3DCREATE_NOWINDOWCHANGES the window is left as it is. */
#ifndef D3D9_PE_FULLSCREEN_H
#define D3D9_PE_FULLSCREEN_H

#include "bitmap.h"
#include "front/d3d9/pe/bridge/object_data.h"
#include <windows.h>
#include <d3d9.h>

/* The Windows side's data of a device. */
struct device_data {
    struct object_data head;
    IDirect3DDevice9Ex *device;
    UINT adapter;
    HWND focus, window; /* the device window: of the implicit swap chain */
    DWORD flags;        /* D3DCREATE_ */
    BOOL extended;
    struct bitmap bitmap; /* of the implicit swap chain */

    BOOL fullscreen, filter; /* filter: the focus window's messages do not reach the program */
    UINT width, height, refresh_rate;
    D3DFORMAT format;
    LONG style, extended_style; /* of the device window before full screen */

    HCURSOR cursor; /* null: none yet */
    BOOL cursor_visible;
};

/* The data of a new device. Returns null without memory. */
struct device_data *device_data_make(IDirect3DDevice9Ex *, UINT adapter, HWND focus, DWORD flags,
                                     BOOL extended);
static inline struct device_data *device_data_of(IDirect3DDevice9Ex *device)
{
    return object_data_of(device);
}

/* Makes windows and the display what the parameters of a successful CreateDevice or Reset specify. Returns
 * FALSE if the display refuses the mode. */
BOOL fullscreen_apply(struct device_data *, const D3DPRESENT_PARAMETERS *);
/* Back to the desktop, at the device's end. */
void fullscreen_leave(struct device_data *);
/* The focus window's program was activated, or another one. */
void fullscreen_activate(struct device_data *, BOOL active);

#endif
