/* Small random IR programs over arrays: they are interpreted by the expressions of def/op.def, and compiled
 * and run by the specializer.
 *
 * A program reads words from INPUT (ARRAYS arrays of LANES words) and from the job, gathers from tables, and
 * stores to slots of OUTPUT. It has the form of a vertex routine, so the vertex frame runs it. */
#ifndef TESTS_SUPPORT_SHADER_PROGRAM_H
#define TESTS_SUPPORT_SHADER_PROGRAM_H

#include "contract/engine.h"
#include "engines/specialize/build.h"

enum { PROGRAM_LANES = 64, PROGRAM_ARRAYS = 4, PROGRAM_STORES = 8, PROGRAM_TABLE = 264, PROGRAM_PITCH = 9 };

struct program_data {
    struct job job;
    uint32_t input[PROGRAM_ARRAYS * PROGRAM_LANES];
    uint32_t table[PROGRAM_TABLE]; /* for gathers: the job's attributes and first texture point to it */
    alignas(64) float output[SLOT_COUNT * VERTEX_CAPACITY];
};

uint32_t program_random(uint64_t *seed);

/* Returns a number of lanes that this machine can execute; consecutive numbers choose them in turn. */
unsigned program_width(uint64_t number);

/* Returns a number of parts for values of `width` lanes (passes/split.c). */
unsigned program_parts(uint64_t number, unsigned width);

/* Returns the lanes that run together if the pass split makes `parts` parts of `width` lanes. */
unsigned program_lanes(const struct ir *ir, unsigned width, unsigned parts);

/* Returns the bits of an edge value of binary32 or of integers, or of an ordinary float. */
uint32_t program_word(uint64_t *seed);

/* Fills input, job and table with edge values and ordinary values. Programs can run on `data` and on copies
 * of it. The copies contain pointers into `data`, which must exist as long as they do. */
void program_fill(struct program_data *data, uint64_t *seed);

/* Makes a valid program of about `length` operations, with regions. */
void program_make(struct ir *ir, unsigned length, uint64_t *seed);

/* The same with nested regions, variables, and loops whose lanes end after up to three passes each. */
void program_make_loops(struct ir *ir, unsigned length, uint64_t *seed);

/* The same, and half of the loops begin to count from a literal. */
void program_make_counted(struct ir *ir, unsigned length, uint64_t *seed);

/* One of the two kinds, with operations that the IR allows and that recordings do not contain: values of
 * loops that are used after the loop, scattered stores to OUTPUT, broadcasts from it, and loads of OUTPUT at
 * other lanes than those that were stored. The results of such loads depend on the number of lanes that run
 * together. */
void program_make_wild(struct ir *ir, unsigned length, uint64_t *seed);

/* Executes the program with the expressions of def/op.def, under the contract's MXCSR. `width` is the number
 * of lanes of a value; of a program that the pass split has made, of a part. */
void program_interpret(const struct ir *ir, struct program_data *data, unsigned width);

/* The same. The observer receives every value of every lane, with the number of its instruction. */
typedef void program_observer(void *context, uint32_t number, uint32_t value);
void program_observe(const struct ir *ir, struct program_data *data, unsigned width,
                     program_observer *observer, void *context);

/* Allocates with `registers` registers, encodes for `width` lanes, and runs the code. Returns 0, or -1 with
 * the reason in `error`. */
int program_compile_and_run(struct builder *builder, struct code_arena *arena, unsigned width,
                            unsigned registers, struct program_data *data, struct error *error);

int program_compile_with(struct builder *builder, struct code_arena *arena, unsigned width,
                         const struct register_file *file, struct program_data *data, struct error *error);

/* The two parts of these functions. program_emit() encodes a program that has its registers, and returns the
 * number of bytes, or 0 with the reason. program_run() runs them. */
size_t program_emit(struct builder *builder, unsigned width, struct error *error);
int program_run(const struct builder *builder, size_t bytes, struct code_arena *arena,
                struct program_data *data, struct error *error);

/* Returns the index of the first output word that differs (two NaN are equal), or -1. */
int program_difference(const struct program_data *a, const struct program_data *b);

#endif
