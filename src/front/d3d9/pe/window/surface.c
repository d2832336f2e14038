/* GetDC: the memory of a surface as a bitmap of GDI. */
#include "hosted.h"
#include "front/d3d9/call.h"
#include "front/d3d9/pe/bridge/object_data.h"
#include <stdlib.h>

/* Windows' functions for bitmaps in given memory (d3dkmthk.h). */
struct create_dc {
    void *memory;
    UINT format, width, height, pitch;
    HDC device;
    PALETTEENTRY *palette;
    HDC dc;
    HANDLE bitmap;
};
struct destroy_dc {
    HDC dc;
    HANDLE bitmap;
};
typedef LONG(WINAPI *create_function)(struct create_dc *);
typedef LONG(WINAPI *destroy_function)(const struct destroy_dc *);

/* The data of a surface whose DC the program has. */
struct surface_data {
    struct object_data head;
    struct destroy_dc dc;
};

static void destroy(const struct destroy_dc *dc)
{
    destroy_function function =
        (destroy_function)(void *)GetProcAddress(GetModuleHandleA("gdi32.dll"), "D3DKMTDestroyDCFromMemory");
    if (function && dc->dc)
        function(dc);
}

static void surface_data_free(struct object_data *head)
{
    destroy(&((struct surface_data *)head)->dc);
    free(head);
}

static BOOL create(const struct d3d9_host_bits *bits, struct destroy_dc *dc)
{
    create_function function =
        (create_function)(void *)GetProcAddress(GetModuleHandleA("gdi32.dll"), "D3DKMTCreateDCFromMemory");
    struct create_dc made = {.memory = (void *)(uintptr_t)bits->bits,
                             .format = bits->format,
                             .width = bits->width,
                             .height = bits->height,
                             .pitch = bits->pitch,
                             .device = CreateCompatibleDC(NULL)};
    BOOL done = function && !function(&made);
    DeleteDC(made.device);
    *dc = (struct destroy_dc){made.dc, made.bitmap};
    return done;
}

static struct surface_data *data_of(IDirect3DSurface9 *surface)
{
    struct surface_data *data = object_data_of(surface);
    if (!data && (data = calloc(1, sizeof *data))) {
        data->head.free = surface_data_free;
        object_data_set(surface, &data->head);
    }
    return data;
}

HRESULT WINAPI hosted_surface_GetDC(IDirect3DSurface9 *self, HDC *dc)
{
    struct d3d9_host_bits bits = {.bits = 0};
    struct surface_data *data = data_of(self);
    if (!dc || !data)
        return dc ? E_OUTOFMEMORY : D3DERR_INVALIDCALL;
    HRESULT result = d3d9_surface_get_dc((void *)self, &bits);
    if (FAILED(result))
        return result;
    if (!create(&bits, &data->dc)) {
        d3d9_surface_release_dc((void *)self);
        return D3DERR_INVALIDCALL;
    }
    *dc = data->dc.dc;
    return result;
}

HRESULT WINAPI hosted_surface_ReleaseDC(IDirect3DSurface9 *self, HDC dc)
{
    struct surface_data *data = object_data_of(self);
    if (!data || !dc || data->dc.dc != dc)
        return D3DERR_INVALIDCALL;
    struct destroy_dc old = data->dc;
    data->dc = (struct destroy_dc){NULL, NULL};
    destroy(&old);
    return d3d9_surface_release_dc((void *)self);
}
