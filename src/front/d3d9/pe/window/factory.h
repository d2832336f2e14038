/* Factories, and windows as the Linux side gets to know them. */
#ifndef D3D9_PE_FACTORY_H
#define D3D9_PE_FACTORY_H

#include "front/d3d9/host.h"
#include <windows.h>
#include <d3d9.h>

/* Direct3DCreate9 and Direct3DCreate9Ex: null and the error without a display or for another version. */
IDirect3D9Ex *factory_make(UINT version, BOOL extended, HRESULT *result);
/* A window now. */
struct d3d9_host_window factory_window(HWND);

#endif
