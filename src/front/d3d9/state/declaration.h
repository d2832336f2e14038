/* Vertex declarations. */
#ifndef D3D9_STATE_DECLARATION_H
#define D3D9_STATE_DECLARATION_H

#include "front/d3d9/state.h"

struct d3d9_declaration {
    struct d3d9_object object;
    struct d3d9_device *device;
    uint32_t fvf;                  /* the vertex format code that has these elements; 0: none */
    struct d3d9_declaration *next; /* in the device's list of those made for codes */
    unsigned count;                /* without the end */
    struct d3d9_vertex_element element[TRIPTYCH_DECLARATION_ELEMENTS + 1];
    unsigned translated;
    struct triptych_declaration_element translation[TRIPTYCH_DECLARATION_ELEMENTS];
    uint16_t streams; /* those that it names, bit i stream i */
};

/* The elements of a vertex format code, at most TRIPTYCH_DECLARATION_ELEMENTS. Returns their number. */
unsigned d3d9_state_fvf_elements(uint32_t fvf, struct d3d9_vertex_element *elements);

#endif
