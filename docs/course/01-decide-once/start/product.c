#include "matrix.h"

void product_generic(int size, const float *a, const float *b, float *c)
{
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            float sum = a[i * size] * b[j];
            for (int k = 1; k < size; k++)
                sum += a[i * size + k] * b[k * size + j];
            c[i * size + j] = sum;
        }
}

/* Step 1: write the four elements out. */
void product_written_out(const float *a, const float *b, float *c)
{
    (void)a;
    (void)b;
    (void)c;
}
