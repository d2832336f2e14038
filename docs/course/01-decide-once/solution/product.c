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

void product_written_out(const float *a, const float *b, float *c)
{
    c[0] = a[0] * b[0] + a[1] * b[2];
    c[1] = a[0] * b[1] + a[1] * b[3];
    c[2] = a[2] * b[0] + a[3] * b[2];
    c[3] = a[2] * b[1] + a[3] * b[3];
}
