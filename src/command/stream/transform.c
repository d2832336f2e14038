#include "command/stream/transform.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Returns false if the vector is too short to have a direction. */
static bool normalize(double v[3])
{
    double length = sqrt(dot(v, v));
    if (!(length > 1e-30))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

static void set_identity(double m[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            m[i][j] = i == j;
}

void transform_multiply(double a[4][4], double b[4][4], double product[4][4])
{
    double sum[4][4] = {{0}};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            for (int k = 0; k < 4; k++)
                sum[i][j] += a[i][k] * b[k][j];
    memcpy(product, sum, sizeof sum);
}

static void swap_rows(double a[4], double b[4])
{
    for (int j = 0; j < 4; j++) {
        double other = a[j];
        a[j] = b[j];
        b[j] = other;
    }
}

/* Column c of `left` becomes that of the identity. */
static void eliminate(double left[4][4], double right[4][4], int c)
{
    double scale = 1 / left[c][c];
    for (int j = 0; j < 4; j++) {
        left[c][j] *= scale;
        right[c][j] *= scale;
    }
    for (int i = 0; i < 4; i++) {
        double factor = i == c ? 0 : left[i][c];
        for (int j = 0; j < 4; j++) {
            left[i][j] -= factor * left[c][j];
            right[i][j] -= factor * right[c][j];
        }
    }
}

/* Gauss and Jordan, with the greatest pivot of each column. */
void transform_invert(double matrix[4][4])
{
    double left[4][4], inverse[4][4];
    memcpy(left, matrix, sizeof left);
    set_identity(inverse);
    for (int c = 0; c < 4; c++) {
        int pivot = c;
        for (int i = c + 1; i < 4; i++)
            if (fabs(left[i][c]) > fabs(left[pivot][c]))
                pivot = i;
        swap_rows(left[c], left[pivot]);
        swap_rows(inverse[c], inverse[pivot]);
        eliminate(left, inverse, c);
    }
    memcpy(matrix, inverse, sizeof inverse);
}

void transform_transpose(double matrix[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++) {
            double other = matrix[i][j];
            matrix[i][j] = matrix[j][i];
            matrix[j][i] = other;
        }
}

static const char *identity(const double *a, double m[4][4])
{
    (void)a;
    set_identity(m);
    return NULL;
}

static const char *matrix(const double *a, double m[4][4])
{
    memcpy(m, a, 16 * sizeof *a);
    return NULL;
}

static const char *translate(const double *a, double m[4][4])
{
    set_identity(m);
    memcpy(m[3], a, 3 * sizeof *a);
    return NULL;
}

static const char *scale(const double *a, double m[4][4])
{
    set_identity(m);
    for (int i = 0; i < 3; i++)
        m[i][i] = a[i];
    return NULL;
}

/* Rodrigues' formula, transposed for row vectors. Quarter turns are exact. */
static const char *rotate(const double *a, double m[4][4])
{
    double axis[3] = {a[1], a[2], a[3]};
    double turn = remainder(a[0], 360);
    double c = fabs(turn) == 90 ? 0 : cos(turn * pi / 180);
    double s = fabs(turn) == 180 ? 0 : sin(turn * pi / 180);
    if (!normalize(axis))
        return "an axis that is not zero";
    const double turned[3][3] = {
        {0, axis[2] * s, -axis[1] * s}, {-axis[2] * s, 0, axis[0] * s}, {axis[1] * s, -axis[0] * s, 0}};
    set_identity(m);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            m[i][j] = (1 - c) * axis[i] * axis[j] + (i == j ? c : 0) + turned[i][j];
    return NULL;
}

static const char *look(const double *a, double m[4][4], double sign)
{
    double x[3], y[3], z[3];
    for (int i = 0; i < 3; i++)
        z[i] = sign * (a[3 + i] - a[i]);
    if (!normalize(z))
        return "a point to look at that is not the eye";
    cross(a + 6, z, x);
    if (!normalize(x))
        return "an up direction that is not along the view";
    cross(z, x, y);
    set_identity(m);
    for (int i = 0; i < 3; i++) {
        m[i][0] = x[i];
        m[i][1] = y[i];
        m[i][2] = z[i];
    }
    m[3][0] = -dot(x, a);
    m[3][1] = -dot(y, a);
    m[3][2] = -dot(z, a);
    return NULL;
}

static const char *look_at(const double *a, double m[4][4])
{
    return look(a, m, 1);
}

static const char *look_at_rh(const double *a, double m[4][4])
{
    return look(a, m, -1);
}

static const char *project(const double *a, double m[4][4], double sign)
{
    double fovy = a[0], aspect = a[1], near = a[2], far = a[3];
    if (!(fovy > 0 && fovy < 180 && aspect > 0 && near > 0 && far > near))
        return "0 < FOVY < 180, 0 < ASPECT, 0 < NEAR < FAR";
    memset(m, 0, sizeof(double[4][4]));
    m[1][1] = 1 / tan(fovy * pi / 360);
    m[0][0] = m[1][1] / aspect;
    m[2][2] = sign * far / (far - near);
    m[2][3] = sign;
    m[3][2] = -near * far / (far - near);
    return NULL;
}

static const char *perspective(const double *a, double m[4][4])
{
    return project(a, m, 1);
}

static const char *perspective_rh(const double *a, double m[4][4])
{
    return project(a, m, -1);
}

static const char *flatten(const double *a, double m[4][4], double sign)
{
    double left = a[0], right = a[1], bottom = a[2], top = a[3], near = a[4], far = a[5];
    if (left == right || bottom == top || near == far)
        return "LEFT and RIGHT, BOTTOM and TOP, NEAR and FAR to differ";
    set_identity(m);
    m[0][0] = 2 / (right - left);
    m[1][1] = 2 / (top - bottom);
    m[2][2] = sign / (far - near);
    m[3][0] = (left + right) / (left - right);
    m[3][1] = (bottom + top) / (bottom - top);
    m[3][2] = near / (near - far);
    return NULL;
}

static const char *orthographic(const double *a, double m[4][4])
{
    return flatten(a, m, 1);
}

static const char *orthographic_rh(const double *a, double m[4][4])
{
    return flatten(a, m, -1);
}

const struct transform_operation *transform_operation(size_t i)
{
    static const struct transform_operation operations[] = {
        {"identity", 0, identity},
        {"matrix", 16, matrix},
        {"translate", 3, translate},
        {"scale", 3, scale},
        {"rotate", 4, rotate},
        {"lookat", 9, look_at},
        {"lookat-rh", 9, look_at_rh},
        {"perspective", 4, perspective},
        {"perspective-rh", 4, perspective_rh},
        {"orthographic", 6, orthographic},
        {"orthographic-rh", 6, orthographic_rh},
    };
    return i < sizeof operations / sizeof operations[0] ? &operations[i] : NULL;
}
