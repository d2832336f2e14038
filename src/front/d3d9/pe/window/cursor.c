/* The cursor of a device is a cursor of Windows. */
#include "hosted.h"
#include "front/d3d9/call.h"
#include "fullscreen.h"

static HCURSOR make_cursor(const struct d3d9_host_bits *bits, UINT x, UINT y)
{
    BITMAPV5HEADER header = {.bV5Size = sizeof header,
                             .bV5Width = (LONG)bits->width,
                             .bV5Height = -(LONG)bits->height,
                             .bV5Planes = 1,
                             .bV5BitCount = 32,
                             .bV5Compression = BI_BITFIELDS,
                             .bV5RedMask = 0xff0000,
                             .bV5GreenMask = 0xff00,
                             .bV5BlueMask = 0xff,
                             .bV5AlphaMask = 0xff000000};
    char *pixels = NULL;
    HBITMAP color = CreateDIBSection(NULL, (BITMAPINFO *)&header, DIB_RGB_COLORS, (void **)&pixels, NULL, 0);
    HBITMAP mask = CreateBitmap((int)bits->width, (int)bits->height, 1, 1, NULL);
    HCURSOR cursor = NULL;
    if (color && mask) {
        for (UINT row = 0; row < bits->height; row++)
            memcpy(pixels + row * bits->width * 4, (const char *)(uintptr_t)bits->bits + row * bits->pitch,
                   bits->width * 4);
        cursor = CreateIconIndirect(
            &(ICONINFO){.fIcon = FALSE, .xHotspot = x, .yHotspot = y, .hbmMask = mask, .hbmColor = color});
    }
    DeleteObject(color);
    DeleteObject(mask);
    return cursor;
}

HRESULT WINAPI hosted_device_SetCursorProperties(IDirect3DDevice9Ex *self, UINT x, UINT y,
                                                 IDirect3DSurface9 *surface)
{
    struct device_data *data = device_data_of(self);
    struct d3d9_host_bits bits = {.bits = 0};
    HRESULT result = d3d9_device_set_cursor_properties((void *)self, x, y, (void *)surface, &bits);
    HCURSOR cursor = FAILED(result) ? NULL : make_cursor(&bits, x, y), old = data->cursor;
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
