/* A program of Windows that opens a window, makes a Direct3D 9 device, draws a triangle and presents it.
 *
 * wine triangle.exe [FRAMES [MILLISECONDS]]
 *
 * It draws FRAMES frames, 1 by default, shows the last one for MILLISECONDS, and prints what it did. It
 * ends with 0 if the window has the triangle's color in its middle and the background's in its corner. */
#define COBJMACROS
#include <windows.h>
#include <d3d9.h>
#include <stdio.h>
#include <stdlib.h>

struct vertex {
    float x, y, z, rhw;
    DWORD color;
};

enum { WIDTH = 320, HEIGHT = 240 };
static const D3DCOLOR background = 0xff204060, foreground = 0xffffc020;

static HWND open_window(void)
{
    WNDCLASSA class = {
        .lpfnWndProc = DefWindowProcA, .hInstance = GetModuleHandleA(NULL), .lpszClassName = "triangle"};
    RECT r = {0, 0, WIDTH, HEIGHT};
    RegisterClassA(&class);
    AdjustWindowRect(&r, WS_OVERLAPPEDWINDOW, FALSE);
    return CreateWindowA("triangle", "Triptych", WS_OVERLAPPEDWINDOW | WS_VISIBLE, 20, 20, r.right - r.left,
                         r.bottom - r.top, NULL, NULL, class.hInstance, NULL);
}

static void handle_messages(void)
{
    MSG message;
    while (PeekMessageA(&message, NULL, 0, 0, PM_REMOVE))
        DispatchMessageA(&message);
}

static HRESULT draw(IDirect3DDevice9 *device)
{
    const struct vertex triangle[3] = {
        {20, 20, 0, 1, foreground}, {300, 20, 0, 1, foreground}, {160, 220, 0, 1, foreground}};
    HRESULT result = IDirect3DDevice9_Clear(device, 0, NULL, D3DCLEAR_TARGET, background, 1, 0);
    if (SUCCEEDED(result))
        result = IDirect3DDevice9_BeginScene(device);
    if (FAILED(result))
        return result;
    IDirect3DDevice9_SetRenderState(device, D3DRS_LIGHTING, FALSE);
    IDirect3DDevice9_SetFVF(device, D3DFVF_XYZRHW | D3DFVF_DIFFUSE);
    result = IDirect3DDevice9_DrawPrimitiveUP(device, D3DPT_TRIANGLELIST, 1, triangle, sizeof *triangle);
    IDirect3DDevice9_EndScene(device);
    return SUCCEEDED(result) ? IDirect3DDevice9_Present(device, NULL, NULL, NULL, NULL) : result;
}

static IDirect3DDevice9 *make_device(IDirect3D9 *factory, HWND window)
{
    D3DPRESENT_PARAMETERS parameters = {.BackBufferFormat = D3DFMT_X8R8G8B8,
                                        .SwapEffect = D3DSWAPEFFECT_DISCARD,
                                        .hDeviceWindow = window,
                                        .Windowed = TRUE};
    IDirect3DDevice9 *device = NULL;
    HRESULT result = IDirect3D9_CreateDevice(factory, 0, D3DDEVTYPE_HAL, window,
                                             D3DCREATE_HARDWARE_VERTEXPROCESSING, &parameters, &device);
    printf("CreateDevice: %08lx, %ux%u\n", result, parameters.BackBufferWidth, parameters.BackBufferHeight);
    return device;
}

static double milliseconds(void)
{
    LARGE_INTEGER now, frequency;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&frequency);
    return 1e3 * (double)now.QuadPart / (double)frequency.QuadPart;
}

/* GDI's colors have red in the lowest byte. */
static DWORD swapped(COLORREF c)
{
    return (c & 0xff) << 16 | (c & 0xff00) | (c >> 16 & 0xff);
}

int main(int count, char **arguments)
{
    int frames = count > 1 ? atoi(arguments[1]) : 1;
    HWND window = open_window();
    IDirect3D9 *factory = Direct3DCreate9(D3D_SDK_VERSION);
    IDirect3DDevice9 *device = factory ? make_device(factory, window) : NULL;
    if (!device)
        return printf("no device\n"), 1;
    HRESULT result = draw(device);
    double begin = milliseconds();
    for (int i = 1; i < frames; i++) {
        handle_messages();
        result = draw(device);
    }
    if (frames > 1)
        printf("%.3f ms a frame\n", (milliseconds() - begin) / (frames - 1));
    HDC dc = GetDC(window);
    DWORD middle = swapped(GetPixel(dc, WIDTH / 2, HEIGHT / 3)), corner = swapped(GetPixel(dc, 2, 2));
    ReleaseDC(window, dc);
    printf("last result %08lx, middle %06lx, corner %06lx\n", result, middle, corner);
    fflush(stdout);
    handle_messages();
    if (count > 2)
        Sleep(atoi(arguments[2]));
    ULONG left = IDirect3DDevice9_Release(device) + IDirect3D9_Release(factory);
    printf("references left: %lu\n", left);
    return middle != (foreground & 0xffffff) || corner != (background & 0xffffff) || left;
}
