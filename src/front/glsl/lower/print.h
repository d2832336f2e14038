/* Code to text for the assembler. */
#ifndef FRONT_GLSL_PRINT_H
#define FRONT_GLSL_PRINT_H

#include "front/glsl/lower/code.h"

/* The register of the machine, and its first component, for a register of the code. -1: it has none. */
struct glsl_spot {
    int16_t number;
    uint8_t component;
};

/* Arrays by the numbers of the code. A uniform that is a sampler has the number of the sampler. */
struct glsl_layout {
    const struct glsl_spot *uniform, *attribute, *varying;
    const uint8_t *sampler; /* by s#: GLSL_SAMPLER_2D, GLSL_SAMPLER_CUBE; 0: not used */
    unsigned constants;     /* the c# of uniforms; literals follow */
    unsigned varyings;      /* vectors */
    bool turned;            /* vFace is negated: gl_FrontFacing is that of the other winding */
    bool second;            /* oC1 is the second colour of blending, not that of the second target */
};

/* The most c#, s# and varyings of a stage. */
struct glsl_machine {
    unsigned constants, samplers;
};
extern const struct glsl_machine glsl_machines[2];

/* Returns the text, in the arena; null, and code->failure is the reason, if literals have no room. */
char *glsl_print(struct glsl_code *code, const struct glsl_layout *layout);

#endif
