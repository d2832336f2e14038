/* Window procedures of focus windows, replaced while a device is in full screen. */
#ifndef D3D9_PE_HOOK_H
#define D3D9_PE_HOOK_H

#include "fullscreen.h"

/* Replaces the procedure of the device's focus window. Does nothing if this device has done so. */
void hook_set(struct device_data *);
/* Restores it, unless the program has replaced it since. */
void hook_remove(struct device_data *);

#endif
