/* Which formats, samples and combinations the device has. */
#ifndef D3D9_CHECK_H
#define D3D9_CHECK_H

#include "format.h"
#include "front/d3d9/resource.h"

/* CheckDeviceFormat for a resource, without the adapter's format: D3D9_OK, D3D9_NO_AUTOMATIC_MIPS,
 * D3D9_NOT_AVAILABLE or D3D9_INVALID_CALL. */
int32_t d3d9_check_format(uint32_t usage, uint32_t type, uint32_t format);

#endif
