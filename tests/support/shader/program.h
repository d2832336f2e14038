/* Small IR programs over arrays: made at random, interpreted straight from the table, compiled and run.
 *
 * A program reads words from INPUT (ARRAYS arrays of LANES words) and from the job, gathers from tables, and
 * stores to slots of OUTPUT; it is what a vertex routine is, so the vertex frame runs it. */
#ifndef TESTS_SUPPORT_SHADER_PROGRAM_H
#define TESTS_SUPPORT_SHADER_PROGRAM_H

#include "contract/engine.h"
#include "engines/specialize/build.h"

enum { PROGRAM_LANES = 64, PROGRAM_ARRAYS = 4, PROGRAM_STORES = 8, PROGRAM_TABLE = 264, PROGRAM_PITCH = 9 };

struct program_data {
    struct job job;
    uint32_t input[PROGRAM_ARRAYS * PROGRAM_LANES];
    uint32_t table
        [PROGRAM_TABLE]; /* what is gathered from, by pointers in the job's attributes and first texture */
    alignas(64) float output[SLOT_COUNT * VERTEX_CAPACITY];
};

uint32_t program_random(uint64_t *seed);

/* Lanes that this machine has code for, in turn. */
unsigned program_width(uint64_t number);

/* The bits of an edge of binary32 or of integers, or of an ordinary float. */
uint32_t program_word(uint64_t *seed);

/* Fills input, job and table with edges and ordinary values. `data`, or a copy of it made while it exists,
 * can be run. */
void program_fill(struct program_data *data, uint64_t *seed);

/* A valid program of about `length` operations, regions included. */
void program_make(struct ir *ir, unsigned length, uint64_t *seed);

/* The same with nested regions, loops of up to three passes that end lane by lane, and variables. */
void program_make_loops(struct ir *ir, unsigned length, uint64_t *seed);

/* Either, with operations that no recording has but the intermediate representation allows: values of loops
 * that are used after them, and in OUTPUT scattered words, words broadcast from there, and lanes that are not
 * where they were stored, which depends on how many lanes run together. */
void program_make_wild(struct ir *ir, unsigned length, uint64_t *seed);

/* Runs every lane through the IR by def/op.def's expressions, under the contract's MXCSR. */
void program_interpret(const struct ir *ir, struct program_data *data, unsigned width);

/* The same; the observer receives every value of every lane. */
typedef void program_observer(void *context, uint32_t number, uint32_t value);
void program_observe(const struct ir *ir, struct program_data *data, unsigned width,
                     program_observer *observer, void *context);

/* Allocates with `registers`, encodes for `width` lanes and runs. Returns 0, or -1 with the reason. */
int program_compile_and_run(struct builder *builder, struct code_arena *arena, unsigned width,
                            unsigned registers, struct program_data *data, struct error *error);

int program_compile_with(struct builder *builder, struct code_arena *arena, unsigned width,
                         const struct register_file *file, struct program_data *data, struct error *error);

/* Its parts: encodes what has been allocated, and returns the bytes or 0; runs them. */
size_t program_emit(struct builder *builder, unsigned width, struct error *error);
int program_run(const struct builder *builder, size_t bytes, struct code_arena *arena,
                struct program_data *data, struct error *error);

/* Index of the first output word that differs (two NaN are equal), or -1. */
int program_difference(const struct program_data *a, const struct program_data *b);

#endif
