/* Display adapters: the monitors of the desktop. Adapter 0 is the primary one. */
#ifndef D3D9_PE_ADAPTER_H
#define D3D9_PE_ADAPTER_H

#include <windows.h>
#include <d3d9.h>

/* Finds the adapters and their modes, and hands them to the Linux side. Returns FALSE without a display. */
BOOL adapter_register(void);
/* The monitor of an adapter; null if there is no such adapter. */
HMONITOR adapter_monitor(UINT adapter);
/* Hands the current mode to the Linux side. */
void adapter_renew(UINT adapter);
void adapter_renew_all(void);
/* Changes the mode until it is restored or the process ends. Zero refresh rate: any. Returns FALSE if the
 * display refuses. */
BOOL adapter_set_mode(UINT adapter, UINT width, UINT height, UINT refresh_rate, D3DFORMAT format);
/* All displays get the modes of the registry. */
void adapter_restore_modes(void);

#endif
