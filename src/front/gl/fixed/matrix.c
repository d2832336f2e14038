/* Matrices and their stacks: chapter 2.10.2 of version 1.1. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/fixed.h"
#include "front/gl/state.h"

#include <math.h>
#include <string.h>

/* --- Numbers --- */

void gl_matrix_apply(const GLfloat matrix[16], const GLfloat vector[4], GLfloat to[4])
{
    for (unsigned row = 0; row < 4; row++)
        to[row] = matrix[row] * vector[0] + matrix[4 + row] * vector[1] + matrix[8 + row] * vector[2] +
                  matrix[12 + row] * vector[3];
}

/* to = a * b; `to` can be one of them. */
static void multiply(const GLfloat a[16], const GLfloat b[16], GLfloat to[16])
{
    GLfloat product[16];
    for (unsigned column = 0; column < 4; column++)
        gl_matrix_apply(a, b + column * 4, product + column * 4);
    memcpy(to, product, sizeof product);
}

/* Swaps rows so that the largest number of a column is on the diagonal. */
static void pivot(double work[4][8], unsigned column)
{
    unsigned best = column;
    for (unsigned row = column + 1; row < 4; row++)
        best = fabs(work[row][column]) > fabs(work[best][column]) ? row : best;
    for (unsigned k = 0; k < 8 && best != column; k++) {
        double other = work[best][k];
        work[best][k] = work[column][k];
        work[column][k] = other;
    }
}

static void eliminate(double work[4][8], unsigned column)
{
    double scale = work[column][column] != 0 ? 1 / work[column][column] : 0;
    for (unsigned k = 0; k < 8; k++)
        work[column][k] *= scale;
    for (unsigned row = 0; row < 4; row++) {
        double factor = row == column ? 0 : work[row][column];
        for (unsigned k = 0; k < 8; k++)
            work[row][k] -= factor * work[column][k];
    }
}

void gl_matrix_invert(const GLfloat matrix[16], GLfloat to[16])
{
    double work[4][8] = {{0}};
    for (unsigned i = 0; i < 16; i++)
        work[i % 4][i / 4] = (double)matrix[i];
    for (unsigned i = 0; i < 4; i++)
        work[i][4 + i] = 1;
    for (unsigned column = 0; column < 4; column++) {
        pivot(work, column);
        eliminate(work, column);
    }
    for (unsigned i = 0; i < 16; i++)
        to[i] = (GLfloat)work[i % 4][4 + i / 4];
}

/* --- Stacks --- */

static struct gl_fixed_stack *stack_of(struct gl_context *context)
{
    struct gl_fixed *fixed = context->fixed;
    return fixed->matrix_mode[0] == GL_MODELVIEW    ? &fixed->modelview
           : fixed->matrix_mode[0] == GL_PROJECTION ? &fixed->projection
                                                    : &fixed->texture[gl_state_unit(context)];
}

static GLfloat *top_of(struct gl_context *context)
{
    struct gl_fixed_stack *stack = stack_of(context);
    context->late |= GL_LATE_FIXED;
    return stack->matrix[stack->depth];
}

const GLfloat *gl_fixed_modelview(const struct gl_fixed *fixed)
{
    return fixed->modelview.matrix[fixed->modelview.depth];
}

void gl_MatrixMode(struct gl_context *context, GLenum mode)
{
    if (mode == GL_MODELVIEW || mode == GL_PROJECTION || mode == GL_TEXTURE)
        context->fixed->matrix_mode[0] = (GLfloat)mode;
    else
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a mode of matrices", gl_constant_name(mode));
}

void gl_PushMatrix(struct gl_context *context)
{
    struct gl_fixed_stack *stack = stack_of(context);
    if (stack->depth + 1 == GL_FIXED_DEPTH) {
        gl_error(context, GL_STACK_OVERFLOW, "found %d matrices, expected fewer", GL_FIXED_DEPTH);
        return;
    }
    memcpy(stack->matrix[stack->depth + 1], stack->matrix[stack->depth], sizeof stack->matrix[0]);
    stack->depth++;
}

void gl_PopMatrix(struct gl_context *context)
{
    struct gl_fixed_stack *stack = stack_of(context);
    if (!stack->depth) {
        gl_error(context, GL_STACK_UNDERFLOW, "found one matrix, expected more");
        return;
    }
    stack->depth--;
    context->late |= GL_LATE_FIXED;
}

/* --- Changes of the top --- */

void gl_LoadMatrixf(struct gl_context *context, const GLfloat *matrix)
{
    memcpy(top_of(context), matrix, 16 * sizeof *matrix);
}

void gl_MultMatrixf(struct gl_context *context, const GLfloat *matrix)
{
    GLfloat *top = top_of(context);
    multiply(top, matrix, top);
}

void gl_LoadIdentity(struct gl_context *context)
{
    const GLfloat identity[16] = {[0] = 1, [5] = 1, [10] = 1, [15] = 1};
    gl_LoadMatrixf(context, identity);
}

void gl_Translatef(struct gl_context *context, GLfloat x, GLfloat y, GLfloat z)
{
    const GLfloat matrix[16] = {[0] = 1, [5] = 1, [10] = 1, [12] = x, [13] = y, [14] = z, [15] = 1};
    gl_MultMatrixf(context, matrix);
}

void gl_Scalef(struct gl_context *context, GLfloat x, GLfloat y, GLfloat z)
{
    const GLfloat matrix[16] = {[0] = x, [5] = y, [10] = z, [15] = 1};
    gl_MultMatrixf(context, matrix);
}

/* Multiples of a right angle are exact. */
static void turn_of(GLfloat angle, GLfloat *sine, GLfloat *cosine)
{
    double quarter = fmod((double)angle, 360) / 90, radians = quarter * 1.57079632679489661923;
    static const GLfloat sines[4] = {0, 1, 0, -1};
    if (quarter == floor(quarter)) {
        unsigned i = (unsigned)((int)quarter + 4) & 3;
        *sine = sines[i];
        *cosine = sines[(i + 1) & 3];
    } else {
        *sine = (GLfloat)sin(radians);
        *cosine = (GLfloat)cos(radians);
    }
}

void gl_Rotatef(struct gl_context *context, GLfloat angle, GLfloat x, GLfloat y, GLfloat z)
{
    GLfloat length = sqrtf(x * x + y * y + z * z), s, c;
    if (!(length > 0))
        return;
    turn_of(angle, &s, &c);
    x /= length, y /= length, z /= length;
    const GLfloat d = 1 - c;
    const GLfloat matrix[16] = {x * x * d + c,
                                y * x * d + z * s,
                                x * z * d - y * s,
                                0,
                                x * y * d - z * s,
                                y * y * d + c,
                                y * z * d + x * s,
                                0,
                                x * z * d + y * s,
                                y * z * d - x * s,
                                z * z * d + c,
                                0,
                                0,
                                0,
                                0,
                                1};
    gl_MultMatrixf(context, matrix);
}

static void refuse_volume(struct gl_context *context)
{
    gl_error(context, GL_INVALID_VALUE, "found an empty volume, expected sides that differ");
}

void gl_Frustumf(struct gl_context *context, GLfloat l, GLfloat r, GLfloat b, GLfloat t, GLfloat n, GLfloat f)
{
    if (!(n > 0 && f > 0) || l == r || b == t || n == f) {
        refuse_volume(context);
        return;
    }
    const GLfloat matrix[16] = {
        [0] = 2 * n / (r - l),      [5] = 2 * n / (t - b),     [8] = (r + l) / (r - l),
        [9] = (t + b) / (t - b),    [10] = -(f + n) / (f - n), [11] = -1,
        [14] = -2 * f * n / (f - n)};
    gl_MultMatrixf(context, matrix);
}

void gl_Orthof(struct gl_context *context, GLfloat l, GLfloat r, GLfloat b, GLfloat t, GLfloat n, GLfloat f)
{
    if (l == r || b == t || n == f) {
        refuse_volume(context);
        return;
    }
    const GLfloat matrix[16] = {[0] = 2 / (r - l),
                                [5] = 2 / (t - b),
                                [10] = -2 / (f - n),
                                [12] = -(r + l) / (r - l),
                                [13] = -(t + b) / (t - b),
                                [14] = -(f + n) / (f - n),
                                [15] = 1};
    gl_MultMatrixf(context, matrix);
}
