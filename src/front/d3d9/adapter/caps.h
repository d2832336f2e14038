/* The capabilities of the device, from the renderer's tables of states and values. */
#ifndef D3D9_CAPS_H
#define D3D9_CAPS_H

#include "front/d3d9/types.h"

/* Fills the capabilities of an adapter. */
void d3d9_caps_fill(uint32_t adapter, struct d3d9_caps *);

#endif
