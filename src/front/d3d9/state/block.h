/* State blocks: sets of values with a mask. */
#ifndef D3D9_STATE_BLOCK_H
#define D3D9_STATE_BLOCK_H

#include "front/d3d9/state.h"

struct d3d9_state_block {
    struct d3d9_object object;
    struct d3d9_device *device;
    bool recorded; /* between BeginStateBlock and EndStateBlock */
    struct d3d9_mask mask;
    struct d3d9_state *state;
    struct d3d9_lights lights;
};

#endif
