/* Present: the Linux side copies the back buffer into a bitmap, which is drawn into the window. */
#include "hosted.h"
#include "bitmap.h"
#include "front/d3d9/call.h"
#include "fullscreen.h"
#include <stdlib.h>

/* The data of a swap chain that is not the implicit one. */
struct swapchain_data {
    struct object_data head;
    struct bitmap bitmap;
};

static void swapchain_data_free(struct object_data *head)
{
    struct swapchain_data *data = (struct swapchain_data *)head;
    bitmap_free(&data->bitmap);
    free(data);
}

/* The bitmap of a swap chain; null without memory. */
static struct bitmap *bitmap_of(IDirect3DSwapChain9Ex *swapchain)
{
    struct swapchain_data *data = object_data_of(swapchain);
    if (!data && (data = calloc(1, sizeof *data))) {
        data->head.free = swapchain_data_free;
        object_data_set(swapchain, &data->head);
    }
    return data ? &data->bitmap : NULL;
}

static HRESULT show(struct bitmap *bitmap, HRESULT result, struct d3d9_host_picture *picture,
                    const RECT *source, const RECT *destination, const RGNDATA *dirty)
{
    if (FAILED(result) || !picture->shown)
        return result;
    if (!picture->filled) {
        if (!bitmap_fit(bitmap, picture))
            return E_OUTOFMEMORY;
        bitmap_describe(bitmap, picture);
        HRESULT read = d3d9_swapchain_read_picture((void *)(uintptr_t)picture->swapchain, picture);
        if (FAILED(read))
            return read;
    }
    bitmap_draw(bitmap, picture, source, destination, dirty);
    return result;
}

HRESULT WINAPI hosted_device_Present(IDirect3DDevice9Ex *self, const RECT *source, const RECT *destination,
                                     HWND window, const RGNDATA *dirty)
{
    struct bitmap *bitmap = &device_data_of(self)->bitmap;
    struct d3d9_host_picture picture = {.bits = 0};
    bitmap_describe(bitmap, &picture);
    HRESULT result = d3d9_device_present((void *)self, (const void *)source, (const void *)destination,
                                         (uintptr_t)window, (const void *)dirty, &picture);
    return show(bitmap, result, &picture, source, destination, dirty);
}

HRESULT WINAPI hosted_device_PresentEx(IDirect3DDevice9Ex *self, const RECT *source, const RECT *destination,
                                       HWND window, const RGNDATA *dirty, DWORD flags)
{
    struct bitmap *bitmap = &device_data_of(self)->bitmap;
    struct d3d9_host_picture picture = {.bits = 0};
    bitmap_describe(bitmap, &picture);
    HRESULT result = d3d9_device_present_ex((void *)self, (const void *)source, (const void *)destination,
                                            (uintptr_t)window, (const void *)dirty, flags, &picture);
    return show(bitmap, result, &picture, source, destination, dirty);
}

HRESULT WINAPI hosted_swapchain_Present(IDirect3DSwapChain9Ex *self, const RECT *source,
                                        const RECT *destination, HWND window, const RGNDATA *dirty,
                                        DWORD flags)
{
    struct bitmap *bitmap = bitmap_of(self);
    struct d3d9_host_picture picture = {.bits = 0};
    if (!bitmap)
        return E_OUTOFMEMORY;
    bitmap_describe(bitmap, &picture);
    HRESULT result = d3d9_swapchain_present((void *)self, (const void *)source, (const void *)destination,
                                            (uintptr_t)window, (const void *)dirty, flags, &picture);
    return show(bitmap, result, &picture, source, destination, dirty);
}
