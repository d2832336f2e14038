/* Present parameters: what Direct3D refuses, and what it fills in. */
#ifndef D3D9_PARAMETERS_H
#define D3D9_PARAMETERS_H

#include "front/d3d9/host.h"

enum d3d9_swap_effect {
    D3D9_SWAP_DISCARD = 1,
    D3D9_SWAP_FLIP,
    D3D9_SWAP_COPY,
    D3D9_SWAP_OVERLAY,
    D3D9_SWAP_FLIP_EX
};

enum {
    D3D9_PRESENT_LOCKABLE = 1, /* D3DPRESENTFLAG_LOCKABLE_BACKBUFFER */
    D3D9_MOST_BACK_BUFFERS = 30
};

/* Checks the parameters of a device or a swap chain on an adapter. Fills in the count, the size and the
 * format of the back buffers. `window` is the one of the parameters, or the focus window. `extended`: the
 * rules of Direct3D 9Ex. D3D9_INVALID_CALL if they are refused. */
int32_t d3d9_parameters_complete(struct d3d9_present_parameters *, uint32_t adapter,
                                 const struct d3d9_host_window *window, bool extended);
/* Checks the mode of CreateDeviceEx and ResetEx, which full screen needs and a window cannot have. */
int32_t d3d9_parameters_check_mode(const struct d3d9_present_parameters *,
                                   const struct d3d9_display_mode_ex *mode);

#endif
