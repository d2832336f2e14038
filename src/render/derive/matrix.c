#include "render/derive/matrix.h"

#include "render/derive/derive_part.h"

#include <math.h>
#include <stdbool.h>

struct matrix matrix_of(const float source[4][4])
{
    struct matrix r;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            r.m[i][j] = (double)source[i][j];
    return r;
}

struct matrix matrix_multiply(const struct matrix *a, const struct matrix *b)
{
    struct matrix r;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            r.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j] +
                        a->m[i][3] * b->m[3][j];
    return r;
}

float derive_narrow(double value)
{
    return (float)fmax(-(double)__FLT_MAX__, fmin(value, (double)__FLT_MAX__));
}

void matrix_store(const struct matrix *source, float target[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            target[i][j] = derive_narrow(source->m[i][j]);
}

static double cofactor(const struct matrix *m, int row, int column)
{
    int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
    return m->m[r1][c1] * m->m[r2][c2] - m->m[r1][c2] * m->m[r2][c1];
}

/* The cofactor of an element among all four rows and columns. */
static double cofactor4(const struct matrix *m, int row, int column)
{
    struct matrix minor;
    double sum = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            minor.m[i][j] = m->m[i + (i >= row)][j + (j >= column)];
    for (int c = 0; c < 3; c++)
        sum += minor.m[0][c] * cofactor(&minor, 0, c);
    return (row + column) % 2 ? -sum : sum;
}

static bool is_affine(const struct matrix *m)
{
    return m->m[0][3] == 0 && m->m[1][3] == 0 && m->m[2][3] == 0 && m->m[3][3] == 1;
}

/* The inverse transpose of an affine matrix has that of its 3x3 part. */
void matrix_store_normal(const struct matrix *source, float target[3][4])
{
    bool affine = is_affine(source);
    double determinant = 0;
    for (int c = 0; c < (affine ? 3 : 4); c++)
        determinant += source->m[0][c] * (affine ? cofactor(source, 0, c) : cofactor4(source, 0, c));
    double scale = determinant != 0 ? 1 / determinant : 1;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            target[i][j] = derive_narrow((affine ? cofactor(source, i, j) : cofactor4(source, i, j)) * scale);
}

void matrix_transform(const float source[3], double w, const struct matrix *matrix, double target[3])
{
    for (int c = 0; c < 3; c++)
        target[c] = (double)source[0] * matrix->m[0][c] + (double)source[1] * matrix->m[1][c] +
                    (double)source[2] * matrix->m[2][c] + w * matrix->m[3][c];
}
