/* What a shader has to do with the world: which elements or varyings it takes, which it gives, what it
 * samples.
 *
 * All models speak of usages here, as dcl does in vs and ps_3_0: oPos is position 0, oD1 color 1, oT3
 * texcoord 3, oFog fog 0, oPts psize 0; a pixel shader's v1 is color 1 and t3 texcoord 3 up to ps_2_x. So a
 * vertex shader's outputs and a pixel shader's inputs meet by usage and its number, whatever their models. */
#ifndef SHADER_INTERFACE_H
#define SHADER_INTERFACE_H

#include "shader/shader.h"

enum { SHADER_PORTS = 64, SHADER_SAMPLERS = 16 };

struct shader_port {
    uint8_t file, index; /* the register */
    uint8_t mask;        /* components that are declared, or all */
    uint8_t usage, usage_index;
    bool centroid; /* looked up inside the triangle (dcl_centroid) */
};

struct shader_interface {
    struct shader_port inputs[SHADER_PORTS], outputs[SHADER_PORTS]; /* in order of first mention */
    unsigned input_count, output_count;
    uint16_t sampled;               /* a bit per sampler */
    uint8_t kinds[SHADER_SAMPLERS]; /* of their textures, numbers of def/shader_usage.def; 0 in ps_1_x:
                                       whatever is bound */
    uint8_t targets;                /* pixel: a bit per oC# written; in ps_1_x r0 is the first */
    bool place, face;               /* pixel: reads vPos, vFace */
    bool depth, kills;              /* pixel: writes depth, discards pixels */
    uint8_t temporaries;            /* one more than the highest r# */
    uint16_t constants;             /* one more than the highest c# read by number */
    bool indexed;                   /* c# is read by a0 or aL: all of them may be read */
};

/* Of a valid shader. */
void shader_describe(const struct shader *shader, struct shader_interface *interface);

#endif
