/* Trials of shaders: a few instructions, run for many sets of operands in every way there is, and what came
 * out as numbers.
 *
 * The body of a trial finds its operands in r1, r2 and r3 and leaves results in r0, then r4, r5 and so on; a
 * trial makes a whole shader of the model around it. In ps_1_x there are two operands, $1 and $2 in the
 * body, and one result. The ways are:
 *   emulated    only the specification's machine, under the emulator's binding, four lanes at a time
 *   recorded    the same recorded, verified, and evaluated lane by lane by the table of operations
 *   optimized   the same after the specializer's passes
 *   engines     each engine that can run here: vertex shaders as routines by themselves (trial_vertex.c),
 *               pixel shaders by whole draws (trial_pixel.c)
 * A failing comparison names the shader, the way, the operands and both values. */
#ifndef TESTS_SUPPORT_TRIAL_TRIAL_H
#define TESTS_SUPPORT_TRIAL_TRIAL_H

#include "shader/shader.h"

#include <unity.h>

enum { TRIAL_OPERANDS = 3, TRIAL_RESULTS = 4 };

struct trial_operands {
    float v[TRIAL_OPERANDS][4];
};

struct trial_results {
    float v[TRIAL_RESULTS][4];
};

struct trial {
    const char *model; /* any but ps_1_1 to ps_1_4 */
    const char *setup; /* further declarations and definitions, or null */
    const char *body;  /* lines, the last without its end */
    const char *after; /* subroutines after the main program's end, or null */
    unsigned results;  /* 1 to TRIAL_RESULTS */
    unsigned sets;
    const struct trial_operands *operands;
    const float (*constant)[4]; /* from c0 on */
    unsigned constants;
    const int32_t (*integer)[4]; /* from i0 on */
    unsigned integers;
    unsigned booleans; /* bit i: b# */
    int legacy;        /* how multiplication goes */
    int alone;         /* without engines */
    int requested;     /* with those that wait to be named too */
    int literal;       /* the operands, one set, are constants that the shader defines: compilers see them */
    int gives;         /* the body writes its results to o1 and so on itself */
};

/* Computes the expected results of a set; values need not be rounded. */
typedef void trial_reference(const struct trial *trial, const struct trial_operands *operands,
                             double results[TRIAL_RESULTS][4]);

/* Runs the trial in every way, and fails unless each component of each result is the binary32 nearest to the
 * reference, a NaN where the reference is NaN, or no further from it than `relative` times it plus
 * `absolute`. Denormals are zeros of their sign. */
void trial_expect_within(const struct trial *trial, trial_reference *reference, double relative,
                         double absolute);
void trial_expect(const struct trial *trial, trial_reference *reference);

/* The same against what the specification's machine gives under the emulator's binding, to the bit. */
void trial_expect_agreement(const struct trial *trial);

/* The nearest binary32, as arithmetic under the contract gives it: to zero below FLT_MIN. */
float trial_round(double value);

/* Of an operand: a denormal is a zero of its sign. */
double trial_flush(float value);

/* a * b + c with the last bit of binary64 odd if the sum is inexact: rounding that once more is one
 * rounding. */
double trial_fused(double a, double b, double c);

/* Sets of operands in which all pairs of the edges of arithmetic meet in each component of the first two, and
 * numbers of ordinary size; the same ones each time. */
extern const struct trial_operands *trial_edges;
extern const unsigned trial_edge_sets;

/* The ordinary ones of them. */
extern const struct trial_operands *trial_ordinary;
extern const unsigned trial_ordinary_sets;

/* --- The ways ---------------------------------------------------------------------------------------------
 */

struct engine;
struct program;

/* The memory that the two ways without an engine read. */
struct trial_memory {
    const struct program *program;
    const struct trial *trial;
    const uint8_t *constants;
    unsigned number; /* of the trial */
};

/* Where the specification has the values of an operand and a result: four lanes each, contiguous. */
enum { TRIAL_LANES = 4 };

/* The number of the cell that has component x of a result. */
unsigned trial_cell(const struct program *program, unsigned result);

/* The number of the cell that has component x of a result. */
unsigned trial_cell(const struct program *program, unsigned result);

void trial_emulate(const struct trial_memory *memory, const float *input, float *output);
void trial_interpret(const struct trial_memory *memory, const float *input, float *output);
void trial_optimize(const struct trial_memory *memory, const float *input, float *output);

const struct shader_model *trial_model(const char *name);

/* All sets of a vertex shader by a routine of the engine, and of a pixel shader by a device of it, which is
 * given its text. */
void trial_run_vertices(const struct trial_memory *memory, const struct engine *engine,
                        struct trial_results *results);
void trial_run_pixels(const struct trial *trial, const char *text, const struct engine *engine,
                      struct trial_results *results);

#endif
