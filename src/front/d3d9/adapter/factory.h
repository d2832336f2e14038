#ifndef D3D9_FACTORY_H
#define D3D9_FACTORY_H

#include "front/d3d9/object.h"

/* IDirect3D9 or IDirect3D9Ex. */
struct d3d9_factory {
    struct d3d9_object object;
    bool extended;
};

#endif
