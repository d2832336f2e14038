/* Lab 1: products of N x N matrices of binary32, rows one after the other. */
#ifndef MATRIX_H
#define MATRIX_H

#include <stddef.h>
#include <stdint.h>

enum { SIZE_MAXIMUM = 4 };

/* --- product.c --- */

/* c = a * b. Element (i, j) is a[i][0] * b[0][j] + a[i][1] * b[1][j] + ..., added from the left. */
void product_generic(int size, const float *a, const float *b, float *c);

/* The same for size 2, without a loop and without a decision. */
void product_written_out(const float *a, const float *b, float *c);

/* --- record.c: a tiny staged language --- */

enum operation { OPERATION_LOAD_A, OPERATION_LOAD_B, OPERATION_MULTIPLY, OPERATION_ADD, OPERATION_STORE_C };

/* One recorded operation. Its number in the recording is the name of its result. */
struct recorded {
    enum operation operation;
    int left, right; /* numbers of earlier operations: both of a product or a sum, `left` of a store */
    int element;     /* of a load or a store: the index of the float in a, b or c */
};

enum { RECORDING_MAXIMUM = 512 };

struct recording {
    int count;
    struct recorded at[RECORDING_MAXIMUM];
};

/* A value of the program that is recorded: the number of an operation. */
typedef int value;

value load_a(struct recording *recording, int element);
value load_b(struct recording *recording, int element);
value multiply(struct recording *recording, value left, value right);
value add(struct recording *recording, value left, value right);
void store_c(struct recording *recording, int element, value stored);

/* Records the product of two matrices of that size. */
void product_record(struct recording *recording, int size);

/* --- generate.c --- */

typedef void product_function(const float *a, const float *b, float *c);

/* Writes the machine code of a recording to `code`, which has room for `room` bytes, as a product_function.
 * Returns the number of bytes. */
size_t product_generate(const struct recording *recording, uint8_t *code, size_t room);

/* --- encode.c, which is given: one instruction each ---
 *
 * They append to the code at *at and move *at. Registers are 0 to 15, for xmm0 to xmm15. By the System V
 * convention the addresses a, b and c are in the general registers rdi, rsi and rdx, and a function may
 * change all xmm registers. `memory` is one of these three registers; `element` counts floats. */
enum memory { MEMORY_C = 2, MEMORY_B = 6, MEMORY_A = 7 };

void encode_load(uint8_t **at, int result, enum memory memory, int element);  /* vmovss xmm, [memory] */
void encode_store(uint8_t **at, enum memory memory, int element, int stored); /* vmovss [memory], xmm */
void encode_multiply(uint8_t **at, int result, int left, int right);          /* vmulss xmm, xmm, xmm */
void encode_add(uint8_t **at, int result, int left, int right);               /* vaddss xmm, xmm, xmm */
void encode_return(uint8_t **at);                                             /* ret */

enum { INSTRUCTION_BYTES = 8 }; /* the longest of them */

#endif
