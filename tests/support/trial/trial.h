/* Trials of shaders: a few instructions are executed for many sets of operands, in every possible way, and
 * the results are compared as numbers.
 *
 * The body of a trial reads its operands from r1, r2 and r3 and writes its results to r0, then r4, r5 and so
 * on. A trial adds the rest of a shader of the model. In ps_1_x there are two operands, $1 and $2 in the
 * body, and one result. The ways are:
 *   emulated    the shader part of the specification, under the emulator's binding, four lanes at a time
 *   recorded    the same, recorded, verified, and evaluated lane by lane with the table of operations
 *   optimized   the recording after the specializer's passes
 *   engines     each engine that this machine can execute: vertex shaders by single routines
 * (trial_vertex.c),
 *               pixel shaders by whole draws (trial_pixel.c)
 * A failing comparison names the shader, the way, the operands and both values. A build with sanitizers tries
 * every seventh set of many, and in each trial every third engine, from trial to trial others. */
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
    const char *body;  /* lines, the last without its line feed */
    const char *after; /* subroutines after the main program's end, or null */
    unsigned results;  /* 1 to TRIAL_RESULTS */
    unsigned sets;
    const struct trial_operands *operands;
    const float (*constant)[4]; /* from c0 on */
    unsigned constants;
    const int32_t (*integer)[4]; /* from i0 on */
    unsigned integers;
    unsigned booleans; /* bit i: b# */
    int legacy;        /* the convention `multiply legacy` */
    int alone;         /* without the way `engines` */
    int requested;     /* also with engines that run only if they are named */
    int literal;       /* the shader defines the only set of operands as constants: compilers can fold them */
    int gives;         /* the body itself writes its results, to o1 and so on */
};

/* Computes the expected results of a set; values need not be rounded. */
typedef void trial_reference(const struct trial *trial, const struct trial_operands *operands,
                             double results[TRIAL_RESULTS][4]);

/* Runs the trial in every way. Fails unless each component of each result is the binary32 nearest to the
 * reference, or a NaN like the reference, or differs from it by at most `relative` times its magnitude plus
 * `absolute`. Denormals are zeros of their sign. */
void trial_expect_within(const struct trial *trial, trial_reference *reference, double relative,
                         double absolute);
void trial_expect(const struct trial *trial, trial_reference *reference);

/* Runs the trial in every way. Fails unless all results have the bits of the way `emulated`. */
void trial_expect_agreement(const struct trial *trial);

/* Returns the nearest binary32 under the contract's MXCSR: results below FLT_MIN are zero. */
float trial_round(double value);

/* Returns the value of an operand: a denormal is a zero of its sign. */
double trial_flush(float value);

/* Returns a * b + c, with the last bit of the binary64 odd if the sum is inexact (round to odd). Rounding the
 * result to binary32 then equals a single rounding of the exact sum. */
double trial_fused(double a, double b, double c);

/* Sets of operands, the same in each run. In each component, the first two operands have all pairs of edge
 * values of arithmetic; more sets have numbers of ordinary size. */
extern const struct trial_operands *trial_edges;
extern const unsigned trial_edge_sets;

/* The sets of ordinary size. */
extern const struct trial_operands *trial_ordinary;
extern const unsigned trial_ordinary_sets;

/* --- The ways ---------------------------------------------------------------------------------------------
 */

struct engine;
struct program;

/* The memory that the ways without an engine read. */
struct trial_memory {
    const struct program *program;
    const struct trial *trial;
    const uint8_t *constants;
    unsigned number; /* of the trial */
};

/* Values of an operand or a result are contiguous, four lanes each. */
enum { TRIAL_LANES = 4 };

/* Returns the number of the cell that has component x of a result. */
unsigned trial_cell(const struct program *program, unsigned result);

void trial_emulate(const struct trial_memory *memory, const float *input, float *output);
void trial_interpret(const struct trial_memory *memory, const float *input, float *output);
void trial_optimize(const struct trial_memory *memory, const float *input, float *output);

const struct shader_model *trial_model(const char *name);

/* Run all sets of a vertex shader by a routine of the engine, and of a pixel shader, given by its text, by a
 * device of the engine. */
void trial_run_vertices(const struct trial_memory *memory, const struct engine *engine,
                        struct trial_results *results);
void trial_run_pixels(const struct trial *trial, const char *text, const struct engine *engine,
                      struct trial_results *results);

#endif
