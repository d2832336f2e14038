/* The operations of the text's `transform` call, as matrices for row vectors: p' = p * M.
 *
 * Everything is computed in binary64. The formulas are those of Direct3D's utility library
 * (D3DXMatrixLookAtLH and so on): clip depth from 0 to w. */
#ifndef COMMAND_STREAM_TRANSFORM_H
#define COMMAND_STREAM_TRANSFORM_H

#include <stddef.h>

enum { TRANSFORM_ARGUMENTS_MAXIMUM = 16 };

struct transform_operation {
    const char *word;
    size_t count; /* of arguments */
    /* Makes the matrix; returns null, or what was expected of the arguments. */
    const char *(*make)(const double *arguments, double matrix[4][4]);
};

/* The i-th operation, null past the last. */
const struct transform_operation *transform_operation(size_t i);

/* product = a * b; may be one of them. */
void transform_multiply(double a[4][4], double b[4][4], double product[4][4]);

/* Replaces the matrix; without an inverse there are values that are not finite. */
void transform_invert(double matrix[4][4]);

void transform_transpose(double matrix[4][4]);

#endif
