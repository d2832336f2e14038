/* The arithmetic of the job's matrices: in double, rounded once when a value is stored. */
#ifndef RENDER_DERIVE_MATRIX_H
#define RENDER_DERIVE_MATRIX_H

struct matrix {
    double m[4][4];
};

struct matrix matrix_of(const float source[4][4]);

/* a * b; products are summed first row first. */
struct matrix matrix_multiply(const struct matrix *a, const struct matrix *b);

void matrix_store(const struct matrix *source, float target[4][4]);

/* The inverse transpose of the upper left 3x3: cofactors over the determinant. A singular matrix gives the
 * cofactors, whose directions are right as far as they are defined. */
void matrix_store_normal(const struct matrix *source, float target[3][4]);

/* A point (w = 1) or a direction (w = 0) times the matrix. */
void matrix_transform(const float source[3], double w, const struct matrix *matrix, double target[3]);

#endif
