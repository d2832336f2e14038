/* Vertex and pixel shaders. */
#ifndef D3D9_STATE_SHADER_H
#define D3D9_STATE_SHADER_H

#include "front/d3d9/state.h"

struct d3d9_shader {
    struct d3d9_object object;
    struct d3d9_device *device;
    triptych_shader *shader;
    uint32_t *code;
    uint32_t bytes;
    bool software; /* needs software vertex processing */
};

/* The types of the two interfaces. */
struct d3d9_vertex_shader {
    struct d3d9_shader shader;
};
struct d3d9_pixel_shader {
    struct d3d9_shader shader;
};

/* Changes what drivers accept although the shader's model forbids it into what the model allows. `tokens` is
 * their number, with the end. M3x3, M4x3 and M3x2 may have a mask with components that they do not write. */
void d3d9_state_tolerate(uint32_t *code, uint64_t tokens);

/* Changes a vertex shader of model 1.1 into one of model 2 for software vertex processing, which has more
 * constants: instructions get their lengths. Returns false if it cannot, because an instruction means
 * something else in model 2 (expp, logp, mov to a0); the code is then only partly changed. */
bool d3d9_state_lengthen(uint32_t *code, uint64_t tokens);

#endif
