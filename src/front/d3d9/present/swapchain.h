/* Swap chains: back buffers and their presentation. */
#ifndef D3D9_SWAPCHAIN_H
#define D3D9_SWAPCHAIN_H

#include "front/d3d9/resource/surface.h"
#include "parameters.h"

struct d3d9_swapchain {
    struct d3d9_object object;
    struct d3d9_device *device;
    struct d3d9_present_parameters parameters;           /* complete; `device_window` is never 0 */
    struct d3d9_surface *buffer[D3D9_MOST_BACK_BUFFERS]; /* implicit, held */
    uint32_t presented;                                  /* the buffer that was presented last */
    uint32_t present_count;
};

/* Makes a swap chain of complete parameters: the device's implicit one, or one with a reference. */
int32_t d3d9_swapchain_make(struct d3d9_device *, const struct d3d9_present_parameters *, bool implicit,
                            struct d3d9_swapchain **out);
/* Replaces the back buffers by those of other parameters (Reset). After a failure it has none. */
int32_t d3d9_swapchain_renew(struct d3d9_swapchain *, const struct d3d9_present_parameters *);

#endif
