/* The interface of a shader: the elements or varyings that it reads, the outputs that it writes, the samplers
 * that it uses.
 *
 * All models use usages here, as dcl does in vs and ps_3_0: oPos is position 0, oD1 color 1, oT3 texcoord 3,
 * oFog fog 0, oPts psize 0; up to ps_2_x, a pixel shader's v1 is color 1 and t3 texcoord 3. So a vertex
 * shader's outputs and a pixel shader's inputs are linked by usage and its number, whatever their models are.
 */
#ifndef SHADER_INTERFACE_H
#define SHADER_INTERFACE_H

#include "shader/shader.h"

enum { SHADER_PORTS = 64, SHADER_SAMPLERS = 16 };

struct shader_port {
    uint8_t file, index; /* the register */
    uint8_t mask;        /* components that are declared, or all */
    uint8_t usage, usage_index;
    bool centroid; /* interpolated at the centroid (dcl_centroid) */
};

struct shader_interface {
    struct shader_port inputs[SHADER_PORTS], outputs[SHADER_PORTS]; /* in order of first mention */
    unsigned input_count, output_count;
    uint16_t sampled;               /* a bit per sampler */
    uint8_t kinds[SHADER_SAMPLERS]; /* of their textures, numbers of def/shader/shader_usage.def; 0 in ps_1_x:
                                       whatever is bound */
    uint8_t targets;                /* pixel: a bit per oC# written; in ps_1_x r0 is the first */
    uint8_t place;                  /* pixel: the components of vPos that it reads */
    bool face, sprite;              /* pixel: reads vFace, vPoint */
    bool depth, kills;              /* pixel: writes depth, discards pixels */
    uint16_t temporaries;           /* one more than the highest r# */
    uint16_t constants;             /* one more than the highest c# read by number */
    bool indexed;                   /* c# is read by a0 or aL, so any of them may be read */
};

/* Describes a valid shader. */
void shader_describe(const struct shader *shader, struct shader_interface *interface);

#endif
