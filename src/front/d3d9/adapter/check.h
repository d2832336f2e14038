/* Which formats, samples and combinations the device has. They are those of the renderer's tables. */
#ifndef D3D9_CHECK_H
#define D3D9_CHECK_H

#include "format.h"
#include "front/d3d9/resource.h"

/* CheckDeviceFormat for a type of resource, without the adapter's format: D3D9_OK, D3D9_NO_AUTOMATIC_MIPS,
 * D3D9_NOT_AVAILABLE or D3D9_INVALID_CALL. */
int32_t d3d9_check_format(uint32_t usage, uint32_t type, uint32_t format);
/* Returns true if a back buffer of this format can be presented on a display: in full screen without
 * conversion. */
bool d3d9_check_back_buffer(uint32_t display, uint32_t back_buffer, bool windowed);
/* The number of modes of an adapter with this format. */
uint32_t d3d9_check_mode_count(uint32_t adapter, uint32_t format);

/* The number of samples of a D3DMULTISAMPLE_TYPE and quality; 0: not supported. */
uint32_t d3d9_check_samples(uint32_t type, uint32_t quality);

#endif
