/* A program that draws a frame and ends without releasing its device, as many programs do. */
#define COBJMACROS
#include <windows.h>
#include <d3d9.h>
#include <stdio.h>

int main(void)
{
    HWND window = CreateWindowA("static", "leave", WS_OVERLAPPEDWINDOW, 0, 0, 64, 64, NULL, NULL, NULL, NULL);
    D3DPRESENT_PARAMETERS parameters = {.SwapEffect = D3DSWAPEFFECT_DISCARD, .Windowed = TRUE};
    IDirect3D9 *factory = Direct3DCreate9(D3D_SDK_VERSION);
    IDirect3DDevice9 *device = NULL;
    if (!factory ||
        FAILED(IDirect3D9_CreateDevice(factory, 0, D3DDEVTYPE_HAL, window,
                                       D3DCREATE_SOFTWARE_VERTEXPROCESSING, &parameters, &device)))
        return printf("no device\n"), 1;
    IDirect3DDevice9_Clear(device, 0, NULL, D3DCLEAR_TARGET, 0xff008000, 1, 0);
    HRESULT result = IDirect3DDevice9_Present(device, NULL, NULL, NULL, NULL);
    printf("presented: %08lx\n", result);
    return FAILED(result);
}
