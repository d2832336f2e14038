/* The capabilities of the device, from the renderer's tables of states and values. */
#ifndef D3D9_CAPS_H
#define D3D9_CAPS_H

#include "front/d3d9/types.h"

#include <stdbool.h>

/* Fills the capabilities of an adapter. `extended`: those of Direct3D 9Ex. */
void d3d9_caps_fill(uint32_t adapter, bool extended, struct d3d9_caps *);

#endif
