/* Programs: a vertex and a fragment shader, linked, as text for the models vs_gl and ps_gl.
 *
 * glsl_link() translates both units, matches their varyings, allocates registers and samplers, and reports
 * what is active. Units are only read, so a unit can be part of several programs. A program is a block of
 * memory of its own and does not refer to the units.
 *
 * How a draw provides values:
 *
 *   attributes   an active attribute at location i is v<i> of the vertex shader, which is declared as
 *                texcoord<i>; a matrix has a register per column, from its location on
 *   uniforms     in c#, as binary32: an int is its value, a bool 0 or 1. See struct glsl_uniform
 *   samplers     s0 to s3 of the vertex shader and s0 to s15 of the fragment shader
 *   results      o0 position, o1.x point size (declared as psize); oC0 to oC3, oDepth. A program that gives a
 *                second colour of blending has another text, with oC0 and this colour as oC1
 *
 * Literals are in the text as `def`. They are in the registers after the uniforms. */
#ifndef FRONT_GLSL_PROGRAM_H
#define FRONT_GLSL_PROGRAM_H

#include "front/glsl/glsl.h"
#include "front/glsl/type.h"

#include <stdbool.h>
#include <stdint.h>

enum { GLSL_STAGES = 2, GLSL_LOCATIONS = 16 };

/* A location for an attribute (glBindAttribLocation). The last one of a name counts. */
struct glsl_binding {
    const char *name;
    unsigned location;
};

/* An active uniform: a scalar, vector, matrix or sampler, or an array of these. Structures and arrays of
 * structures have an entry for each field that is used: "light[1].color". The name of an array has no
 * "[0]"; glGetActiveUniform adds it.
 *
 * Element e of the array, column k: `rows` components of the register first + e * columns + k, from
 * `component` on. Other components of a register can belong to other uniforms. An element whose register is
 * not used by a stage has none: `elements` counts those from 0 on that have one.
 *
 * A sampler in a stage with first >= 0 is read from the samplers s<first> to s<first + elements - 1>. */
struct glsl_uniform {
    const char *name;
    struct glsl_type type; /* without a record; `array` is 0 or the number of active elements */
    struct {
        int16_t first;     /* register or sampler; -1: the stage does not use the uniform */
        uint8_t component; /* 0 to 3 */
        uint16_t elements; /* 1 if it is not an array */
    } stage[GLSL_STAGES];
    bool builtin; /* gl_DepthRange.near, .far, .diff: active, without a location */
};

struct glsl_attribute {
    const char *name;
    struct glsl_type type;
    unsigned location;
};

/* The equations of blend.def. */
enum glsl_blend {
#define GLSL_BLEND(name, value, qualifier) GLSL_BLEND_##name,
#include "front/glsl/blend.def"
#undef GLSL_BLEND
    GLSL_BLENDS
};

struct glsl_program {
    const char *text[GLSL_STAGES]; /* of the models vs_gl and ps_gl; indexed by enum glsl_stage */
    const char
        *turned; /* of the fragment shader where clockwise triangles are front; null if it is the same */
    const char *second[2]; /* both where oC1 is the second colour of blending; null if there is none */
    const struct glsl_uniform *uniform;
    const struct glsl_attribute *attribute;
    unsigned uniforms, attributes;
    unsigned uniform_name_bytes, attribute_name_bytes; /* the longest name with its "[0]" and its zero */
    unsigned varyings;                                 /* vectors: texcoord0 to texcoord<varyings - 1> */
    uint8_t colors;                                    /* bit i: oC<i> is written */
    uint16_t blends;  /* bit i: the fragment shader allows enum glsl_blend i */
    bool broadcasts;  /* gl_FragColor is written: oC0 is the colour of all targets */
    bool point_size;  /* gl_PointSize is written; without it, it is undefined */
    bool point_coord; /* gl_PointCoord is read */
    bool frag_coord, front_facing;
    bool depth; /* gl_FragDepthEXT is written */
    bool discards;
};

/* Links two units. Both are of the right stage. `bindings` may be null if count is 0. Returns null if there
 * are errors; then *log has a line for each:
 *
 *   ERROR: found the varying 'a' ..., expected ...
 *
 * The caller frees *log, which is empty without errors. Returns null with a null log, and errno is ENOMEM,
 * if memory is refused. Thread-safe, for the same units too. */
struct glsl_program *glsl_link(const struct glsl_unit *vertex, const struct glsl_unit *fragment,
                               const struct glsl_binding *bindings, unsigned count, char **log);

/* Null is allowed. */
void glsl_program_free(struct glsl_program *program);

#endif
