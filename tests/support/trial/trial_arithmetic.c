#include "trial_arithmetic.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* --- References -------------------------------------------------------------------------------------------
 * Each computes one result from the operands a, b and c. */

typedef const struct trial_operands *operands;

static double at(operands o, int operand, int c)
{
    return trial_flush(o->v[operand][c]);
}

#define A(c) at(o, 0, c)
#define B(c) at(o, 1, c)
#define C(c) at(o, 2, c)

static double rounded(double value)
{
    return (double)trial_round(value);
}

static double times(const struct trial *t, double a, double b)
{
    return t->legacy && (a == 0 || b == 0) ? 0 : a * b;
}

static double plus_times(const struct trial *t, double a, double b, double c)
{
    return t->legacy ? rounded(times(t, a, b)) + c : trial_fused(a, b, c);
}

static double dot(const struct trial *t, int count, const double *a, const double *b)
{
    double sum = rounded(times(t, a[0], b[0]));
    for (int c = 1; c < count; c++)
        sum = rounded(plus_times(t, a[c], b[c], sum));
    return sum;
}

/* A function of each component. */
#define COMPONENTS(name, expression)                                                                         \
    static void name##_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])              \
    {                                                                                                        \
        (void)t;                                                                                             \
        for (int i = 0; i < 4; i++) {                                                                        \
            double a = A(i), b = B(i), c = C(i);                                                             \
            (void)a, (void)b, (void)c;                                                                       \
            r[0][i] = expression;                                                                            \
        }                                                                                                    \
    }

COMPONENTS(mov, a)
COMPONENTS(add, a + b)
COMPONENTS(sub, a - b)
COMPONENTS(mul, times(t, a, b))
COMPONENTS(mad, plus_times(t, a, b, c))
COMPONENTS(lrp, plus_times(t, a, rounded(b - c), c))
COMPONENTS(frc, a - floor(a))
COMPONENTS(absolute, fabs(a))
COMPONENTS(min, a < b ? a : b)
COMPONENTS(max, a >= b ? a : b)
COMPONENTS(slt, a < b ? 1 : 0)
COMPONENTS(sge, a >= b ? 1 : 0)
COMPONENTS(cmp, a >= 0 ? b : c)
COMPONENTS(sgn, a < 0 ? -1 : a == 0 ? 0 : 1)
COMPONENTS(rcp, a == 0 ? FLT_MAX : 1 / a)
COMPONENTS(rsq, a == 0 ? FLT_MAX : 1 / rounded(sqrt(fabs(a))))
COMPONENTS(exponential, exp2(a))

static double logarithm(double a)
{
    return a == 0 ? -FLT_MAX : log2(fabs(a));
}

/* As the definition does, with a logarithm that is rounded to binary32. */
static double power(const struct trial *t, double a, double b)
{
    return b == 0 ? 1 : exp2(rounded(times(t, rounded(logarithm(a)), b)));
}

COMPONENTS(logarithm, logarithm(a))
COMPONENTS(power, power(t, a, b))

static void load(operands o, int operand, double v[4])
{
    for (int c = 0; c < 4; c++)
        v[c] = at(o, operand, c);
}

static void replicate(double value, double r[4])
{
    for (int c = 0; c < 4; c++)
        r[c] = value;
}

static void dp3_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    double a[4], b[4];
    load(o, 0, a), load(o, 1, b);
    replicate(dot(t, 3, a, b), r[0]);
}

static void dp4_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    double a[4], b[4];
    load(o, 0, a), load(o, 1, b);
    replicate(dot(t, 4, a, b), r[0]);
}

static void dp2add_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    double sum = rounded(plus_times(t, A(0), B(0), C(3)));
    replicate(plus_times(t, A(1), B(1), sum), r[0]);
}

/* The rows are b, c, b reversed, and c with its components rotated (see ROWS). */
static void matrix(const struct trial *t, operands o, int count, int rows, double r[4])
{
    double a[4], row[4][4];
    load(o, 0, a);
    for (int c = 0; c < 4; c++) {
        row[0][c] = B(c), row[1][c] = C(c);
        row[2][c] = B(3 - c), row[3][c] = C(c == 3 ? 3 : (c + 1) % 3);
        r[c] = C(c);
    }
    for (int i = 0; i < rows; i++)
        r[i] = dot(t, count, a, row[i]);
}

#define MATRIX(name, count, rows)                                                                            \
    static void name##_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])              \
    {                                                                                                        \
        matrix(t, o, count, rows, r[0]);                                                                     \
    }

MATRIX(m4x4, 4, 4)
MATRIX(m4x3, 4, 3)
MATRIX(m3x4, 3, 4)
MATRIX(m3x3, 3, 3)
MATRIX(m3x2, 3, 2)

static void crs_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    for (int c = 0; c < 3; c++) {
        int next = (c + 1) % 3, last = (c + 2) % 3;
        r[0][c] = rounded(times(t, A(next), B(last))) - rounded(times(t, A(last), B(next)));
    }
    r[0][3] = C(3);
}

static void nrm_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    double a[4];
    load(o, 0, a);
    double square = dot(t, 3, a, a), scale = square == 0 ? FLT_MAX : rounded(1 / rounded(sqrt(square)));
    for (int c = 0; c < 4; c++)
        r[0][c] = times(t, a[c], scale);
}

static void sincos_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    (void)t;
    r[0][0] = cos(A(0)), r[0][1] = sin(A(0));
    r[0][2] = C(2), r[0][3] = C(3);
}

static void lit_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    double raised = A(3) < -127.9961f ? -127.9961f : A(3) > 127.9961f ? 127.9961f : A(3);
    r[0][0] = r[0][3] = 1;
    r[0][1] = A(0) > 0 ? A(0) : 0;
    r[0][2] = A(0) > 0 && A(1) > 0 ? power(t, A(1), raised) : 0;
}

static void dst_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    r[0][0] = 1;
    r[0][1] = times(t, A(1), B(1));
    r[0][2] = A(2);
    r[0][3] = B(3);
}

/* frc in vs_1_1 */
static void frc_xy_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    (void)t;
    for (int c = 0; c < 4; c++)
        r[0][c] = c < 2 ? A(c) - floor(A(c)) : C(c);
}

static void expp_parts_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    (void)t;
    double a = A(0);
    r[0][0] = exp2(floor(a)), r[0][1] = a - floor(a), r[0][2] = exp2(a), r[0][3] = 1;
}

static void logp_parts_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    (void)t;
    double a = A(0);
    int exponent = 129;
    double mantissa = isfinite(a) ? 2 * frexp(fabs(a), &exponent) : isnan(a) ? 1.5 : 1;
    r[0][0] = a == 0 ? -FLT_MAX : exponent - 1;
    r[0][1] = a == 0 ? 1 : mantissa;
    r[0][2] = logarithm(a);
    r[0][3] = 1;
}

/* --- The table --------------------------------------------------------------------------------------------
 * In a body, a line with @ is repeated four times, once for each component. */

#define ROWS "mov r5, r2\nmov r6, r3\nmov r7, r2.wzyx\nmov r8, r3.yzxw\nmov r0, r3\n"

const struct arithmetic_row arithmetic_rows[ARITHMETIC_ROWS] = {
    {SHADER_MOV, "mov r0, r1", mov_reference, 0, 0, 0, NULL},
    {SHADER_ADD, "add r0, r1, r2", add_reference, 0, 0, 0, NULL},
    {SHADER_SUB, "sub r0, r1, r2", sub_reference, 0, 0, 0, NULL},
    {SHADER_MUL, "mul r0, r1, r2", mul_reference, 0, 0, 0, NULL},
    {SHADER_MAD, "mad r0, r1, r2, r3", mad_reference, 0, 0, 0, NULL},
    {SHADER_RCP, "rcp r0.@, r1.@", rcp_reference, 0, 0, 0, NULL},
    {SHADER_RSQ, "rsq r0.@, r1.@", rsq_reference, 0, 0, 0, NULL},
    {SHADER_DP3, "dp3 r0, r1, r2", dp3_reference, 0, 0, 0, NULL},
    {SHADER_DP4, "dp4 r0, r1, r2", dp4_reference, 0, 0, 0, NULL},
    {SHADER_MIN, "min r0, r1, r2", min_reference, 0, 0, 0, NULL},
    {SHADER_MAX, "max r0, r1, r2", max_reference, 0, 0, 0, NULL},
    {SHADER_SLT, "slt r0, r1, r2", slt_reference, 0, 0, 0, NULL},
    {SHADER_SGE, "sge r0, r1, r2", sge_reference, 0, 0, 0, NULL},
    {SHADER_EXP, "exp r0.@, r1.@", exponential_reference, ARITHMETIC_BITS_21, 0, 0, NULL},
    {SHADER_LOG, "log r0.@, r1.@", logarithm_reference, ARITHMETIC_BITS_21, 0, 0, NULL},
    {SHADER_LIT, "lit r0, r1", lit_reference, ARITHMETIC_BITS_15, 0, 0, NULL},
    {SHADER_DST, "dst r0, r1, r2", dst_reference, 0, 0, 0, NULL},
    {SHADER_LRP, "lrp r0, r1, r2, r3", lrp_reference, 0, 0, 0, NULL},
    {SHADER_FRC, "frc r0, r1", frc_reference, 0, 0, ARITHMETIC_NOT_1, NULL},
    {SHADER_FRC, "mov r0, r3\nfrc r0.xy, r1", frc_xy_reference, 0, 0, ARITHMETIC_ONLY_1, NULL},
    {SHADER_M4X4, ROWS "m4x4 r0, r1, r5", m4x4_reference, 0, 0, 0, NULL},
    {SHADER_M4X3, ROWS "m4x3 r0.xyz, r1, r5", m4x3_reference, 0, 0, 0, NULL},
    {SHADER_M3X4, ROWS "m3x4 r0, r1, r5", m3x4_reference, 0, 0, 0, NULL},
    {SHADER_M3X3, ROWS "m3x3 r0.xyz, r1, r5", m3x3_reference, 0, 0, 0, NULL},
    {SHADER_M3X2, ROWS "m3x2 r0.xy, r1, r5", m3x2_reference, 0, 0, 0, NULL},
    {SHADER_POW, "pow r0.@, r1.@, r2.@", power_reference, ARITHMETIC_BITS_15, 0, 0, NULL},
    {SHADER_CRS, "mov r0, r3\ncrs r0.xyz, r1, r2", crs_reference, 0, 0, 0, NULL},
    {SHADER_SGN, "sgn r0, r1, r5, r6", sgn_reference, 0, 0, 0, NULL},
    {SHADER_ABS, "abs r0, r1", absolute_reference, 0, 0, 0, NULL},
    {SHADER_NRM, "nrm r0, r1", nrm_reference, 0, 0, 0, NULL},
    {SHADER_SINCOS_2, "mov r0, r3\nsincos r0.xy, r1.x, c20, c21", sincos_reference, 0, 6e-7,
     ARITHMETIC_ORDINARY, ARITHMETIC_SERIES},
    {SHADER_SINCOS, "mov r0, r3\nsincos r0.xy, r1.x", sincos_reference, 0, 6e-7, ARITHMETIC_ORDINARY, NULL},
    {SHADER_EXPP, "expp r0.@, r1.@", exponential_reference, ARITHMETIC_BITS_21, 0, ARITHMETIC_NOT_1, NULL},
    {SHADER_EXPP, "expp r0, r1.x", expp_parts_reference, ARITHMETIC_BITS_21, 0, ARITHMETIC_ONLY_1, NULL},
    {SHADER_LOGP, "logp r0.@, r1.@", logarithm_reference, ARITHMETIC_BITS_21, 0, ARITHMETIC_NOT_1, NULL},
    {SHADER_LOGP, "logp r0, r1.x", logp_parts_reference, ARITHMETIC_BITS_21, 0, ARITHMETIC_ONLY_1, NULL},
    {SHADER_CMP, "cmp r0, r1, r2, r3", cmp_reference, 0, 0, 0, NULL},
    {SHADER_DP2ADD, "dp2add r0, r1, r2, r3.w", dp2add_reference, 0, 0, 0, NULL},
};

const int arithmetic_models[ARITHMETIC_MODELS] = {MODEL_VS_1_1, MODEL_VS_2_0, MODEL_VS_2_X, MODEL_VS_3_0,
                                                  MODEL_PS_2_0, MODEL_PS_2_X, MODEL_PS_3_0};

void arithmetic_unfold(const char *body, char *text, size_t bytes)
{
    int lines = strchr(body, '@') ? 4 : 1;
    size_t used = 0;
    for (int i = 0; i < lines; i++) {
        for (const char *c = body; *c && used + 2 < bytes; c++)
            text[used++] = *c == '@' ? "xyzw"[i] : *c;
        if (i + 1 < lines)
            text[used++] = '\n';
    }
    text[used] = 0;
}
