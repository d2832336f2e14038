/* Linking (program.h): what the parts share. */
#ifndef FRONT_GLSL_LINK_H
#define FRONT_GLSL_LINK_H

#include "front/glsl/lower/lower.h"
#include "front/glsl/lower/print.h"
#include "front/glsl/program.h"

enum { GLSL_VARYING_VECTORS = 8, GLSL_MOST_SAMPLERS = 16 };

/* How the code of a stage uses a register: bits. */
enum { GLSL_USED = 1, GLSL_USED_RELATIVE = 2 };

struct glsl_stage_link {
    const struct glsl_unit *unit;
    struct glsl_code *code;
    uint8_t *uniform_use, *attribute_use, *varying_use; /* by registers of the code */
    struct glsl_spot *uniform, *attribute, *varying;
    uint8_t sampler[GLSL_MOST_SAMPLERS];
    unsigned constants;
    char *text;
};

struct glsl_linker {
    struct glsl_arena arena;
    char *log; /* GLSL_LOG_BYTES */
    unsigned used, errors;
    struct glsl_stage_link stage[GLSL_STAGES];
    char *turned;    /* the fragment shader with the other front; null: it does not read gl_FrontFacing */
    char *second[2]; /* both with the second colour of blending; null: it writes none */
    const struct glsl_binding *binding;
    unsigned bindings;
    struct glsl_uniform *uniform;
    struct glsl_attribute *attribute;
    unsigned uniforms, attributes, uniform_room, varyings;
};

extern const char *const glsl_stage_names[GLSL_STAGES];

/* Adds a line to the log. */
void glsl_link_error(struct glsl_linker *linker, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Something that needs consecutive registers of some components each. */
struct glsl_block_to_place {
    unsigned rows, registers; /* rows: 1 to 4 components */
    struct glsl_spot *spot;   /* of each register: the result */
};

/* pack.c: gives all blocks a place in `most` registers, each at component 0 if there is room for that, else
 * as in appendix A, section 7. Returns the number of registers, or more than `most` if there is no room. */
unsigned glsl_link_place(struct glsl_linker *linker, struct glsl_block_to_place *block, unsigned count,
                         unsigned most);

/* use.c: notes the use of all registers by the code of a stage. */
void glsl_link_note_uses(struct glsl_linker *linker, struct glsl_stage_link *stage);

/* varying.c */
void glsl_link_check_varyings(struct glsl_linker *linker);
/* The components of each varying of the vertex shader that the fragment shader reads. */
void glsl_link_need_varyings(struct glsl_linker *linker);
void glsl_link_place_varyings(struct glsl_linker *linker);

/* attribute.c */
void glsl_link_place_attributes(struct glsl_linker *linker);

/* uniform.c */
void glsl_link_check_uniforms(struct glsl_linker *linker);
void glsl_link_place_uniforms(struct glsl_linker *linker);

#endif
