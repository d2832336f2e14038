/* Lab 3: a machine that executes a small shader for many elements. */
#ifndef MACHINE_H
#define MACHINE_H

#include <stddef.h>

enum { REGISTERS = 40, INPUTS = 4, STEPS_MAXIMUM = 64 };

enum operation { OPERATION_ADD, OPERATION_MULTIPLY, OPERATION_MULTIPLY_ADD, OPERATION_MAXIMUM };

/* One instruction: register `result` becomes a + b, a * b, a * b + c, or the larger of a and b (b if they are
 * equal). The numbers are those of registers. */
struct step {
    enum operation operation;
    int result, a, b, c;
};

/* Registers 0 to INPUTS - 1 have the element's inputs when the program begins. All registers are written
 * before they are read. Register REGISTERS - 1 has the result when it ends. */
struct program {
    int steps;
    struct step step[STEPS_MAXIMUM];
};

/* naive.c, which is given: executes the program for one element after the other. Input i of element e is
 * input[i][e]; the result of element e is output[e]. */
void naive_run(const struct program *program, const float *const input[INPUTS], float *output, size_t count);

/* batch.c: the same for `batch` elements at a time, 1 to 4096. `frame` has room for REGISTERS * batch
 * numbers. The last batch is smaller if count is not a multiple of it. */
void batch_run(const struct program *program, size_t batch, float *frame, const float *const input[INPUTS],
               float *output, size_t count);

/* batch.c: the bytes of the frame that the program touches again and again, in a batch of that size. */
size_t batch_bytes(size_t batch);

#endif
