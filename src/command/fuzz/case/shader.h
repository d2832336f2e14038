/* Random shaders: valid, of every model and instruction, with flow control, predication, relative addressing
 * and textures.
 *
 * Instructions are proposed from the tables and checked by the validator one by one (shader/check/check.h).
 * The validator has the state at every point: declared and written registers, open blocks, remaining slots. A
 * refused proposal is replaced by another. The rules of shader models are therefore written only once, and a
 * refusal costs a microsecond. Labels, breaks and phases, for which the rules look ahead, are planned.
 *
 * Most shaders are tame, so that bugs show. Their vertex shaders write positions that are plausible for the
 * vertices, estimates of magnitude keep numbers finite, and later instructions prefer registers that no
 * instruction has read. The registers that are unread at the end are added to the result. Other shaders are
 * wild: any operation on any operands, with edge values in their constants. Most are short. */
#ifndef COMMAND_FUZZ_CASE_SHADER_H
#define COMMAND_FUZZ_CASE_SHADER_H

#include "base/random.h"
#include "command/fuzz/case/text.h"
#include "shader/interface.h"

enum { FUZZ_SHADER_INTEGERS = 16 };

struct fuzz_shader_options {
    unsigned instructions; /* about this number between first and last; 0: random, mostly few */
    unsigned constants;    /* registers c0 to this one - 1 have numbers in them; 0: any number */
    bool tame, wild;       /* only that kind; neither: mostly tame */
    /* The vertex shader before a pixel shader, whose outputs the pixel shader mostly reads. Null: any. */
    const struct fuzz_shader *before;
    /* Not 0: only definitions and instructions, without inputs, outputs, samplers, subroutines and gradients.
     * No model accepts that as a shader; tests put something around it. A bit per r# that has a value at the
     * start; those up to the highest are written. */
    uint32_t registers;
};

/* The inputs that a draw must provide for the shader. */
struct fuzz_shader {
    const struct shader_model *model;
    /* Inputs, outputs, targets; the samplers used, and the kinds of their textures, in ps_1_x too: what
     * makes the best picture there. `constants` counts the float constants read by number; if `indexed`,
     * any may be read. */
    struct shader_interface interface;
    int matrix; /* vertices: the first of four constants that rows of a matrix to clip space are in, or -1 */
    bool clip_position; /* vertices: the first input, position 0, is taken as a place in clip space */
    uint16_t integers;  /* a bit per i# that is read and not defined by the shader */
    int32_t integer[FUZZ_SHADER_INTEGERS][4]; /* values for these; counts may be lower, but not higher */
    uint16_t booleans;                        /* a bit per b# that is read and not defined by the shader */
    uint8_t bumps;                            /* pixels: a bit per stage whose bump matrix is read */
    unsigned instructions;                    /* with declarations */
    unsigned proposed, refused;               /* instructions that the validator checked, and refused */
    unsigned discarded;                       /* shaders that it refused as a whole before this one */
};

/* Makes a shader of the model; the caller frees it. Null with the reason only if memory is short. For tests:
 * random shaders without a case. */
struct shader *fuzz_shader_make(struct random *random, const struct shader_model *model,
                                const struct fuzz_shader_options *options, struct fuzz_shader *made,
                                struct error *error);

/* Adds it to the text of a stream as `shader NAME { ... }`. Returns 0, or -1 with the reason if memory is
 * short. */
int fuzz_shader_write(struct random *random, struct text *text, const char *name,
                      const struct shader_model *model, const struct fuzz_shader_options *options,
                      struct fuzz_shader *made, struct error *error);

/* A vertex and a pixel shader for the same draws: of the same age, or sometimes of any two models. The pixel
 * shader mostly reads what the vertex shader writes. `options.before` is not read. */
int fuzz_shader_pair(struct random *random, struct text *text, const char *vertex_name,
                     const char *pixel_name, const struct fuzz_shader_options *options,
                     struct fuzz_shader *vertex, struct fuzz_shader *pixel, struct error *error);

/* Any model of the stage; those of software processing are rare. */
const struct shader_model *fuzz_shader_model(struct random *random, enum shader_stage stage);

#endif
