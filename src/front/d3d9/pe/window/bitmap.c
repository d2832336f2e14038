#include "bitmap.h"

#ifndef DCX_USESTYLE
#define DCX_USESTYLE 0x10000
#endif

void bitmap_free(struct bitmap *bitmap)
{
    if (bitmap->dc)
        DeleteDC(bitmap->dc);
    if (bitmap->bitmap)
        DeleteObject(bitmap->bitmap);
    *bitmap = (struct bitmap){.dc = NULL};
}

BOOL bitmap_fit(struct bitmap *bitmap, const struct d3d9_host_picture *picture)
{
    BITMAPINFO information = {.bmiHeader = {.biSize = sizeof information.bmiHeader,
                                            .biWidth = (LONG)picture->width,
                                            .biHeight = -(LONG)picture->height,
                                            .biPlanes = 1,
                                            .biBitCount = 32,
                                            .biCompression = BI_RGB}};
    if (bitmap->width == picture->width && bitmap->height == picture->height)
        return TRUE;
    bitmap_free(bitmap);
    bitmap->dc = CreateCompatibleDC(NULL);
    bitmap->bitmap = CreateDIBSection(bitmap->dc, &information, DIB_RGB_COLORS, &bitmap->bits, NULL, 0);
    if (!bitmap->dc || !bitmap->bitmap) {
        bitmap_free(bitmap);
        return FALSE;
    }
    SelectObject(bitmap->dc, bitmap->bitmap);
    bitmap->width = picture->width;
    bitmap->height = picture->height;
    return TRUE;
}

void bitmap_describe(const struct bitmap *bitmap, struct d3d9_host_picture *picture)
{
    GdiFlush(); /* GDI may still read the pixels. */
    picture->bits = (uintptr_t)bitmap->bits;
    picture->pitch = bitmap->width * 4;
    picture->room_width = bitmap->width;
    picture->room_height = bitmap->height;
}

static void clip(HDC dc, const RGNDATA *data, int x, int y)
{
    HRGN region = ExtCreateRegion(NULL, data->rdh.dwSize + data->rdh.nRgnSize, data);
    if (!region)
        return;
    OffsetRgn(region, x, y);
    SelectClipRgn(dc, region);
    DeleteObject(region);
}

void bitmap_draw(const struct bitmap *bitmap, const struct d3d9_host_picture *picture, const RECT *source,
                 const RECT *destination, const RGNDATA *region)
{
    HWND window = (HWND)(uintptr_t)picture->window;
    HDC dc = GetDCEx(window, NULL, DCX_CACHE | DCX_USESTYLE);
    RECT from = {0, 0, (LONG)picture->width, (LONG)picture->height}, to;
    if (!dc)
        return;
    if (source)
        from = *source;
    if (destination)
        to = *destination;
    else
        GetClientRect(window, &to);
    int width = from.right - from.left, height = from.bottom - from.top;
    if (to.right - to.left == width && to.bottom - to.top == height) {
        if (region && region->rdh.nCount)
            clip(dc, region, to.left - from.left, to.top - from.top);
        BitBlt(dc, to.left, to.top, width, height, bitmap->dc, from.left, from.top, SRCCOPY);
    } else {
        SetStretchBltMode(dc, COLORONCOLOR);
        StretchBlt(dc, to.left, to.top, to.right - to.left, to.bottom - to.top, bitmap->dc, from.left,
                   from.top, width, height, SRCCOPY);
    }
    ReleaseDC(window, dc);
}
