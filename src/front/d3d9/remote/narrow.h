/* Direct3D 9's structures with pointers or handles, as a 32-bit program lays them out, and how they are
 * converted. All other structures have one layout in 32- and 64-bit programs of Windows. */
#ifndef D3D9_REMOTE_NARROW_H
#define D3D9_REMOTE_NARROW_H

#include "front/d3d9/host.h"

#include <stddef.h>

struct d3d9_packing;

/* Of D3DLOCKED_RECT, D3DLOCKED_BOX, D3DPRESENT_PARAMETERS and D3DDEVICE_CREATION_PARAMETERS. */
struct d3d9_narrow_locked_rect {
    int32_t pitch;
    uint32_t bits;
};
struct d3d9_narrow_locked_box {
    int32_t row_pitch, slice_pitch;
    uint32_t bits;
};
struct d3d9_narrow_present_parameters {
    uint32_t before[7];
    uint32_t device_window;
    uint32_t after[6];
};
struct d3d9_narrow_creation_parameters {
    uint32_t adapter, device_type, focus_window, behavior_flags;
};
/* Of D3DPRESENTSTATS and D3DADAPTER_IDENTIFIER9: 64-bit numbers are aligned to 4 bytes. */
struct d3d9_narrow_present_stats {
    uint32_t counts[3], times[4];
};
struct d3d9_narrow_adapter_identifier {
    uint32_t words[275];
};

/* A type of elements: their bytes in the program and in the server. Null functions: both are the same. */
struct d3d9_narrow {
    size_t narrow, wide;
    void (*widen)(const void *narrow, void *wide);
    void (*shorten)(const void *wide, void *narrow);
    /* For memory that the element itself refers to: into the packing before the call, back after it. */
    void (*attach)(struct d3d9_packing *packing, void *wide);
    void (*detach)(const void *before, void *wide);
};

extern const struct d3d9_narrow d3d9_narrow_address, d3d9_narrow_locked_rect, d3d9_narrow_locked_box;
extern const struct d3d9_narrow d3d9_narrow_present_parameters, d3d9_narrow_creation_parameters;
extern const struct d3d9_narrow d3d9_narrow_present_stats, d3d9_narrow_adapter_identifier;
extern const struct d3d9_narrow d3d9_narrow_picture;

#endif
