/* Adapters, windows and presenting: the part of struct d3d9_device that the folders
 * adapter, resource and present use. */
#ifndef D3D9_PRESENTATION_H
#define D3D9_PRESENTATION_H

#include "types.h"
#include <stdbool.h>

struct d3d9_device;
struct d3d9_resource;
struct d3d9_surface;
struct d3d9_swapchain;

struct d3d9_presentation {
    struct d3d9_swapchain *chain;    /* the implicit one; held */
    struct d3d9_surface *depth;      /* made for EnableAutoDepthStencil; held; null: none */
    struct d3d9_resource *resources; /* all but surfaces of textures, in no order */
    uint64_t resource_bytes;         /* of those in the default pool */
    bool inactive;                   /* full screen without the focus */
    bool lost;                       /* lost until the window is active again */
    bool not_reset;                  /* a Reset is necessary, or has failed */
    struct d3d9_gamma_ramp gamma;
    struct d3d9_device *next; /* of all devices of the process */
};

#endif
