/* Random shaders: valid, of every model and instruction, with flow control, predication, relative addressing, textures,
 * and what else the tables of def/shader*.def know.
 *
 * Instructions are proposed from the tables and put before the validator one by one (shader/check.h), which knows what is
 * declared, written, open and left at every point; what it refuses is proposed differently. So the rules stand where they
 * always stood, and refusals cost a microsecond. Labels, breaks and phases, which rules look ahead for, are planned.
 *
 * Most shaders are tame, so that bugs show: vertex shaders give positions that a draw's vertices can have meant, estimates
 * of magnitude keep numbers from running into infinity, later instructions prefer what nobody has read yet, and what is
 * left over at the end is added to the result. Others are wild: any operation of any operands, edge numbers in their
 * constants. Most are short. */
#ifndef FUZZ_SHADER_H
#define FUZZ_SHADER_H

#include "fuzz/random.h"
#include "fuzz/text.h"
#include "shader/interface.h"

enum { FUZZ_SHADER_INTEGERS = 16 };

struct fuzz_shader_options {
    unsigned instructions; /* about so many between first and last; 0: whatever comes, mostly few */
    unsigned constants;    /* registers c0 to this one - 1 have numbers in them; 0: any number */
    bool tame, wild;       /* that and nothing else; neither: mostly tame */
    /* The vertex shader before a pixel shader, whose outputs it mostly asks for. Null: any. */
    const struct fuzz_shader *before;
    /* Not 0: definitions and instructions alone, no inputs, outputs, samplers, subroutines and gradients, which no model
     * takes for a shader: for tests that put something around it. A bit per r# that has a value to begin with; those up
     * to the highest are written. */
    uint32_t registers;
};

/* What a draw has to bring for the shader. */
struct fuzz_shader {
    const struct shader_model *model;
    /* Inputs, outputs, targets; the samplers used, and the kinds of their textures, in ps_1_x too: what makes the best
     * picture there. `constants` counts the float constants read by number; if `indexed`, any may be read. */
    struct shader_interface interface;
    int matrix; /* vertices: the first of four constants that rows of a matrix to clip space are in, or -1 */
    bool clip_position; /* vertices: the first input, position 0, is taken as a place in clip space */
    uint16_t integers;  /* a bit per i# that is read and not defined by the shader */
    int32_t integer[FUZZ_SHADER_INTEGERS][4]; /* values for these; counts may be lower, but not higher */
    uint16_t booleans;                        /* a bit per b# that is read and not defined by the shader */
    uint8_t bumps;                            /* pixels: a bit per stage whose bump matrix is read */
    unsigned instructions;                    /* with declarations */
    unsigned proposed, refused; /* instructions that the validator was asked about, and said no to */
    unsigned discarded;         /* shaders that it refused as a whole before this one */
};

/* Makes a shader of the model; the caller frees it. Null with the reason only if memory is short. */
struct shader *fuzz_shader_make(struct random *random, const struct shader_model *model,
                                const struct fuzz_shader_options *options, struct fuzz_shader *made,
                                struct error *error);

/* Adds it to the text of a stream as `shader NAME { ... }`. Returns 0, or -1 with the reason if memory is short. */
int fuzz_shader_write(struct random *random, struct text *text, const char *name,
                      const struct shader_model *model, const struct fuzz_shader_options *options,
                      struct fuzz_shader *made, struct error *error);

/* A vertex and a pixel shader for the same draws: of the same age, or now and then of any two models; the pixel shader
 * mostly asks for what the vertex shader gives. `options.before` is not read. */
int fuzz_shader_pair(struct random *random, struct text *text, const char *vertex_name,
                     const char *pixel_name, const struct fuzz_shader_options *options,
                     struct fuzz_shader *vertex, struct fuzz_shader *pixel, struct error *error);

/* Any model of the stage; those of software processing are rare. */
const struct shader_model *fuzz_shader_model(struct random *random, enum shader_stage stage);

#endif
