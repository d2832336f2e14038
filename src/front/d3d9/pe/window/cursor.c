/* The cursor of a device is a cursor of Windows. */
#include "hosted.h"
#include "adapter.h"
#include "front/d3d9/call.h"
#include "fullscreen.h"

static void copy_rows(char *pixels, const struct d3d9_locked_rect *locked,
                      const struct d3d9_surface_desc *size)
{
    for (UINT row = 0; row < size->height; row++)
        memcpy(pixels + row * size->width * 4, (const char *)locked->bits + (INT)row * locked->pitch,
               size->width * 4);
}

static HCURSOR make_cursor(const struct d3d9_locked_rect *locked, const struct d3d9_surface_desc *size,
                           UINT x, UINT y)
{
    BITMAPV5HEADER header = {.bV5Size = sizeof header,
                             .bV5Width = (LONG)size->width,
                             .bV5Height = -(LONG)size->height,
                             .bV5Planes = 1,
                             .bV5BitCount = 32,
                             .bV5Compression = BI_BITFIELDS,
                             .bV5RedMask = 0xff0000,
                             .bV5GreenMask = 0xff00,
                             .bV5BlueMask = 0xff,
                             .bV5AlphaMask = 0xff000000};
    char *pixels = NULL;
    HBITMAP color = CreateDIBSection(NULL, (BITMAPINFO *)&header, DIB_RGB_COLORS, (void **)&pixels, NULL, 0);
    HBITMAP mask = CreateBitmap((int)size->width, (int)size->height, 1, 1, NULL);
    HCURSOR cursor = NULL;
    if (color && mask) {
        copy_rows(pixels, locked, size);
        cursor = CreateIconIndirect(
            &(ICONINFO){.fIcon = FALSE, .xHotspot = x, .yHotspot = y, .hbmMask = mask, .hbmColor = color});
    }
    DeleteObject(color);
    DeleteObject(mask);
    return cursor;
}

/* Null if the surface is locked already. */
static HCURSOR cursor_of(struct d3d9_surface *surface, UINT x, UINT y)
{
    struct d3d9_surface_desc size;
    struct d3d9_locked_rect locked;
    if (FAILED(d3d9_surface_get_desc(surface, &size)) ||
        FAILED(d3d9_surface_lock_rect(surface, &locked, NULL, D3DLOCK_READONLY)))
        return NULL;
    HCURSOR cursor = make_cursor(&locked, &size, x, y);
    d3d9_surface_unlock_rect(surface);
    return cursor;
}

HRESULT WINAPI hosted_device_SetCursorProperties(IDirect3DDevice9Ex *self, UINT x, UINT y,
                                                 IDirect3DSurface9 *surface)
{
    struct device_data *data = device_data_of(self);
    adapter_renew_all();
    HRESULT result = d3d9_device_set_cursor_properties((void *)self, x, y, (void *)surface);
    HCURSOR cursor = FAILED(result) ? NULL : cursor_of((void *)surface, x, y), old = data->cursor;
    if (FAILED(result) || !cursor)
        return FAILED(result) ? result : D3DERR_INVALIDCALL;
    data->cursor = cursor;
    if (data->cursor_visible)
        SetCursor(cursor);
    if (old)
        DestroyCursor(old);
    return result;
}

void WINAPI hosted_device_SetCursorPosition(IDirect3DDevice9Ex *self, int x, int y, DWORD flags)
{
    POINT now;
    (void)self, (void)flags;
    if (!GetCursorPos(&now) || now.x != x || now.y != y)
        SetCursorPos(x, y);
}

/* The cursor of a device without an image cannot be shown. */
BOOL WINAPI hosted_device_ShowCursor(IDirect3DDevice9Ex *self, BOOL show)
{
    struct device_data *data = device_data_of(self);
    BOOL was = data->cursor_visible;
    data->cursor_visible = data->cursor && show;
    if (data->cursor)
        SetCursor(show ? data->cursor : NULL);
    return was;
}
