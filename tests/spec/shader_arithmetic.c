/* What the arithmetic instructions of shaders compute: each of them over all pairs of the edges of binary32 and over
 * ordinary numbers, in models of every generation, against the definitions of docs/shader-semantics.md in double precision. */
#include "tests/support/trial.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

/* --- References -------------------------------------------------------------------------------------------
 * Of one result, from the operands a, b and c. */

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

/* As the definition has it, by way of a logarithm in binary32. */
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

/* The rows are b, c, b backwards and c with its components moved on. */
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

/* vs_1_1's */
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
 * In a body, a line with @ stands for four, one for each component. */

#define BITS_21 (1.0 / (1 << 21)) /* what the standard wants of exp and log */
#define BITS_15 (1.0 / (1 << 15)) /* and of pow */
#define SERIES                                                                                               \
    "def c20, -1.5500992e-006, -2.1701389e-005, 0.0026041667, 0.00026041668\n"                               \
    "def c21, -0.020833334, -0.12500000, 1.0, 0.50000000\n"
#define ROWS "mov r5, r2\nmov r6, r3\nmov r7, r2.wzyx\nmov r8, r3.yzxw\nmov r0, r3\n"

enum { ORDINARY = 1, ONLY_1 = 2, NOT_1 = 4 };

static const struct row {
    enum shader_opcode opcode;
    const char *body;
    trial_reference *reference;
    double relative, absolute;
    int flags;
    const char *setup;
} rows[] = {
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
    {SHADER_EXP, "exp r0.@, r1.@", exponential_reference, BITS_21, 0, 0, NULL},
    {SHADER_LOG, "log r0.@, r1.@", logarithm_reference, BITS_21, 0, 0, NULL},
    {SHADER_LIT, "lit r0, r1", lit_reference, BITS_15, 0, 0, NULL},
    {SHADER_DST, "dst r0, r1, r2", dst_reference, 0, 0, 0, NULL},
    {SHADER_LRP, "lrp r0, r1, r2, r3", lrp_reference, 0, 0, 0, NULL},
    {SHADER_FRC, "frc r0, r1", frc_reference, 0, 0, NOT_1, NULL},
    {SHADER_FRC, "mov r0, r3\nfrc r0.xy, r1", frc_xy_reference, 0, 0, ONLY_1, NULL},
    {SHADER_M4X4, ROWS "m4x4 r0, r1, r5", m4x4_reference, 0, 0, 0, NULL},
    {SHADER_M4X3, ROWS "m4x3 r0.xyz, r1, r5", m4x3_reference, 0, 0, 0, NULL},
    {SHADER_M3X4, ROWS "m3x4 r0, r1, r5", m3x4_reference, 0, 0, 0, NULL},
    {SHADER_M3X3, ROWS "m3x3 r0.xyz, r1, r5", m3x3_reference, 0, 0, 0, NULL},
    {SHADER_M3X2, ROWS "m3x2 r0.xy, r1, r5", m3x2_reference, 0, 0, 0, NULL},
    {SHADER_POW, "pow r0.@, r1.@, r2.@", power_reference, BITS_15, 0, 0, NULL},
    {SHADER_CRS, "mov r0, r3\ncrs r0.xyz, r1, r2", crs_reference, 0, 0, 0, NULL},
    {SHADER_SGN, "sgn r0, r1, r5, r6", sgn_reference, 0, 0, 0, NULL},
    {SHADER_ABS, "abs r0, r1", absolute_reference, 0, 0, 0, NULL},
    {SHADER_NRM, "nrm r0, r1", nrm_reference, 0, 0, 0, NULL},
    {SHADER_SINCOS_2, "mov r0, r3\nsincos r0.xy, r1.x, c20, c21", sincos_reference, 0, 6e-7, ORDINARY,
     SERIES},
    {SHADER_SINCOS, "mov r0, r3\nsincos r0.xy, r1.x", sincos_reference, 0, 6e-7, ORDINARY, NULL},
    {SHADER_EXPP, "expp r0.@, r1.@", exponential_reference, BITS_21, 0, NOT_1, NULL},
    {SHADER_EXPP, "expp r0, r1.x", expp_parts_reference, BITS_21, 0, ONLY_1, NULL},
    {SHADER_LOGP, "logp r0.@, r1.@", logarithm_reference, BITS_21, 0, NOT_1, NULL},
    {SHADER_LOGP, "logp r0, r1.x", logp_parts_reference, BITS_21, 0, ONLY_1, NULL},
    {SHADER_CMP, "cmp r0, r1, r2, r3", cmp_reference, 0, 0, 0, NULL},
    {SHADER_DP2ADD, "dp2add r0, r1, r2, r3.w", dp2add_reference, 0, 0, 0, NULL},
};

/* Rules and readings of the models differ in all of them, the machine code that comes of an instruction does not: the
 * machine alone is tried in each model, engines in one of each generation. */
static int is_for_engines(const struct shader_model *model)
{
    return model->column != COLUMN_VS_2_X && model->column != COLUMN_PS_2_X;
}

static const int models[] = {MODEL_VS_1_1, MODEL_VS_2_0, MODEL_VS_2_X, MODEL_VS_3_0,
                             MODEL_PS_2_0, MODEL_PS_2_X, MODEL_PS_3_0};

/* Four lines in place of one with @. */
static void unfold(const char *body, char *text, size_t bytes)
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

static void try_row(const struct row *row, const struct shader_model *model, int legacy)
{
    char body[512];
    int first = shader_major(model) == 1;
    if (shader_slots(&shader_operations[row->opcode], model) < 0 || row->flags & (first ? NOT_1 : ONLY_1))
        return;
    unfold(row->body, body, sizeof body);
    struct trial trial = {
        .model = model->name, .setup = row->setup, .body = body, .results = 1, .legacy = legacy};
    trial.operands = row->flags & ORDINARY ? trial_ordinary : trial_edges;
    trial.sets = row->flags & ORDINARY ? trial_ordinary_sets : trial_edge_sets;
    trial.alone = legacy ? shader_major(model) < 3 : !is_for_engines(model);
    trial_expect_within(&trial, row->reference, row->relative, row->absolute);
}

static void try_all(int legacy)
{
    for (unsigned m = 0; m < sizeof models / sizeof *models; m++)
        for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
            try_row(&rows[i], &shader_models[models[m]], legacy);
}

/* --- Masks ------------------------------------------------------------------------------------------------
 */

static const struct row *masked_row;
static unsigned mask;

/* What is not in the mask is the third operand; where four lines made one component each, one of x makes all. */
static void masked_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    double whole[TRIAL_RESULTS][4];
    int scalar = strchr(masked_row->body, '@') != NULL;
    masked_row->reference(t, o, whole);
    for (int c = 0; c < 4; c++)
        r[0][c] = mask >> c & 1 ? whole[0][scalar ? 0 : c] : C(c);
}

static void mask_body(char *text, size_t bytes)
{
    const char *body = masked_row->body, *end = strrchr(body, '\n');
    const char *result = strstr(end ? end : body, " r0") + 3, *rest = strchr(result, ',');
    size_t used = (size_t)snprintf(text, bytes, "mov r0, r3\n%.*s.", (int)(result - body), body);
    for (int c = 0; c < 4; c++)
        if (mask >> c & 1)
            text[used++] = "xyzw"[c];
    for (; *rest && used + 1 < bytes; rest++)
        text[used++] = *rest == '@' ? 'x' : *rest;
    text[used] = 0;
}

static int is_allowed(uint8_t masks, const struct shader_model *model)
{
    switch (masks) {
    case MASKS_ANY: return 1;
    case MASKS_WITHIN_XYZ: return mask < 8;
    case MASKS_WITHIN_XY: return mask < 4;
    case MASKS_NORMAL: return mask == 7 || mask == 15;
    case MASKS_FRACTION: return shader_major(model) > 1 || mask == 2 || mask == 3;
    default: return 0; /* they have one, which the row has */
    }
}

static void try_masks(const struct row *row, const struct shader_model *model)
{
    char body[512];
    const struct shader_operation *operation = &shader_operations[row->opcode];
    if (shader_slots(operation, model) < 0 || row->flags & (shader_major(model) == 1 ? NOT_1 : ONLY_1))
        return;
    masked_row = row;
    for (mask = 1; mask < 16; mask++) {
        if (!is_allowed(operation->masks, model))
            continue;
        mask_body(body, sizeof body);
        struct trial trial = {.model = model->name, .setup = row->setup, .body = body, .results = 1};
        trial.operands = trial_ordinary;
        trial.sets = 12;
        trial.alone = shader_major(model) < 3 || (mask != 6 && mask != 9 && mask != 2);
        trial_expect_within(&trial, masked_reference, row->relative, row->absolute);
    }
}

static void masks_leave_the_other_components_alone(void)
{
    for (unsigned m = 0; m < sizeof models / sizeof *models; m++)
        for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
            try_masks(&rows[i], &shader_models[models[m]]);
}

static void instructions_compute_what_their_definitions_say(void)
{
    try_all(0);
}

static void with_legacy_multiplication_zeros_give_zero(void)
{
    try_all(1);
}

/* Each set of operands a shader of its own, which folds its constants: on all ways for some of them. */
static void try_literals(const struct row *row, const struct shader_model *model, unsigned step, int alone)
{
    char body[512];
    if (shader_slots(&shader_operations[row->opcode], model) < 0 ||
        row->flags & (shader_major(model) == 1 ? NOT_1 : ONLY_1))
        return;
    unfold(row->body, body, sizeof body);
    struct trial trial = {
        .model = model->name, .setup = row->setup, .body = body, .results = 1, .literal = 1, .sets = 1};
    for (unsigned set = 0; set < trial_edge_sets; set += step) {
        if (row->flags & ORDINARY && set < trial_edge_sets - trial_ordinary_sets)
            continue;
        trial.operands = &trial_edges[set];
        trial.alone = alone;
        trial_expect_within(&trial, row->reference, row->relative, row->absolute);
    }
}

static void constants_that_are_known_compute_the_same(void)
{
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++) {
        try_literals(&rows[i], &shader_models[MODEL_VS_3_0], 7, 1);
        try_literals(&rows[i], &shader_models[MODEL_VS_3_0], 61, 0);
        try_literals(&rows[i], &shader_models[MODEL_PS_3_0], 113, 0);
        try_literals(&rows[i], &shader_models[MODEL_VS_1_1], 113, 0);
    }
}

/* --- Modifiers --------------------------------------------------------------------------------------------
 * Every instruction with what can be written at it: of the result, of its first source, and a predicate. */

enum dress { SATURATED, PARTIAL, NEGATED, MAGNITUDE, NEGATED_MAGNITUDE, PREDICATED, DRESSES };

static const struct {
    const char *before, *behind, *source; /* the name of the instruction; what stands for r1 */
} dresses[DRESSES] = {
    [SATURATED] = {"", "_sat", "r1"},
    [PARTIAL] = {"", "_pp", "r1"},
    [NEGATED] = {"", "", "-r1"},
    [MAGNITUDE] = {"", "", "r1_abs"},
    [NEGATED_MAGNITUDE] = {"", "", "-r1_abs"},
    [PREDICATED] = {"(p0) ", "", "r1"},
};

static const struct row *dressed_row;
static enum dress dress;
static unsigned written; /* components */

static double saturated(double value)
{
    return value > 0 ? value < 1 ? value : 1 : 0;
}

/* sincos of models 2 takes a predicate for all components only. */
static int predicate_component(int c)
{
    return dressed_row->opcode == SHADER_SINCOS_2 ? 1 : c;
}

static void dressed_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    struct trial_operands changed = *o;
    for (int c = 0; c < 4; c++) {
        if (dress == MAGNITUDE || dress == NEGATED_MAGNITUDE)
            changed.v[0][c] = fabsf(changed.v[0][c]);
        if (dress == NEGATED || dress == NEGATED_MAGNITUDE)
            changed.v[0][c] = -changed.v[0][c];
    }
    dressed_row->reference(t, &changed, r);
    for (int c = 0; c < 4; c++) {
        int p = predicate_component(c);
        if (dress == SATURATED && written >> c & 1)
            r[0][c] = saturated(r[0][c]);
        if (dress == PREDICATED && !(C(p) > B(p)))
            r[0][c] = C(c);
    }
}

/* One line with the instruction, and which components it writes. */
static void dress_line(const char *line, size_t length, const char *name, char *text)
{
    const char *result = line + strlen(name), *source = strstr(result, " r1"), *comma = strchr(result, ',');
    const char *before =
        dress == PREDICATED && dressed_row->opcode == SHADER_SINCOS_2 ? "(p0.y) " : dresses[dress].before;
    for (const char *c = result; c < comma; c++)
        for (unsigned i = 0; i < 4; i++)
            written |= (unsigned)(*c == "xyzw"[i]) << i;
    if (!memchr(result, '.', (size_t)(comma - result)))
        written = 15;
    sprintf(text + strlen(text), "%s%s%s%.*s %s%.*s", before, name, dresses[dress].behind,
            (int)(source - result), result, dresses[dress].source, (int)(line + length - source - 3),
            source + 3);
}

/* Every line that has the row's instruction; a predicate comes first. */
static void dress_body(const char *body, const char *name, char *text)
{
    written = 0;
    strcpy(text, dress == PREDICATED ? "mov r0, r3\nsetp_gt p0, r3, r2\n" : "");
    for (const char *line = body; *line;) {
        size_t length = strcspn(line, "\n"), letters = strlen(name);
        if (!strncmp(line, name, letters) && line[letters] == ' ')
            dress_line(line, length, name, text);
        else
            strncat(text, line, length);
        line += length;
        if (*line) {
            strcat(text, "\n");
            line++;
        }
    }
}

static int can_be_dressed(const struct shader_operation *operation, const struct shader_model *model)
{
    int third = shader_major(model) == 3, vertices = model->stage == STAGE_VERTEX;
    switch (dress) {
    case SATURATED: return !(operation->flags & IS_UNSATURATED) && (third || !vertices);
    case PARTIAL: return !vertices;
    case NEGATED: return 1;
    case PREDICATED: return (model->capabilities & CAN_PREDICATION) != 0;
    default: return third;
    }
}

static void try_dressed(const struct row *row, const struct shader_model *model)
{
    char body[512], text[700];
    const struct shader_operation *operation = &shader_operations[row->opcode];
    if (shader_slots(operation, model) < 0 || row->flags & (shader_major(model) == 1 ? NOT_1 : ONLY_1))
        return;
    dressed_row = row;
    unfold(row->body, body, sizeof body);
    for (dress = 0; dress < DRESSES; dress++) {
        if (!can_be_dressed(operation, model))
            continue;
        dress_body(body, operation->name, text);
        struct trial trial = {.model = model->name, .setup = row->setup, .body = text, .results = 1};
        trial.operands = row->flags & ORDINARY ? trial_ordinary : trial_edges;
        trial.sets = row->flags & ORDINARY ? trial_ordinary_sets : trial_edge_sets;
        trial.alone = shader_major(model) < 3 || dress == PARTIAL || dress == NEGATED_MAGNITUDE;
        trial_expect_within(&trial, dressed_reference, row->relative, row->absolute);
    }
}

static void every_instruction_takes_every_modifier(void)
{
    for (unsigned m = 0; m < sizeof models / sizeof *models; m++)
        for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
            try_dressed(&rows[i], &shader_models[models[m]]);
}

/* --- Edges by hand ----------------------------------------------------------------------------------------
 */

/* What lit makes of x, y and w: the second operand's y and z. */
static const struct trial_operands lights[] = {
    {{{1, 0, 9, 0}, {0, 1, 0}}}, /* 0 to the power 0 is not seen */
    {{{1, -0.0f, 9, 0}, {0, 1, 0}}},
    {{{1, -1, 9, 2}, {0, 1, 0}}},
    {{{0, 1, 9, 1}, {0, 0, 0}}},
    {{{-0.0f, 1, 9, 1}, {0, 0, 0}}},
    {{{-1, 0.5f, 9, 2}, {0, 0, 0}}},
    {{{0.25f, 0.5f, 9, 2}, {0, 0.25f, 0.25f}}},
    {{{2, 0.5f, 9, 0}, {0, 2, 1}}},
    {{{2, 0.5f, 9, -2}, {0, 2, 4}}},
    {{{1, 1, 9, INFINITY}, {0, 1, 1}}}, /* the power stays finite */
    {{{1, INFINITY, 9, 0}, {0, 1, 1}}},
    {{{1, INFINITY, 9, -1}, {0, 1, 0}}},
    {{{INFINITY, 0.5f, 9, 1}, {0, INFINITY, 0.5f}}},
    {{{NAN, 0.5f, 9, 1}, {0, 0, 0}}},
    {{{1, NAN, 9, 1}, {0, 1, 0}}},
    {{{1e-39f, 0.5f, 9, 1}, {0, 0, 0}}},
    {{{1, 1e-39f, 9, 0}, {0, 1, 0}}},
};

static void light_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    (void)t;
    r[0][0] = r[0][3] = 1;
    r[0][1] = B(1), r[0][2] = B(2);
}

static void light_at_the_edges(void)
{
    static const char *const those[] = {"vs_1_1", "vs_2_0", "vs_3_0"};
    for (int m = 0; m < 3; m++) {
        struct trial trial = {.model = those[m],
                              .body = "lit r0, r1",
                              .results = 1,
                              .operands = lights,
                              .sets = sizeof lights / sizeof *lights};
        trial_expect_within(&trial, light_reference, BITS_15, 0);
    }
}

/* Angles by hand: zeros, right and straight angles as binary32 has them, beyond 2^25, and none at all. */
static const struct trial_operands angles[] = {
    {{{0.0f, 1, 0}}},
    {{{-0.0f, 1, -0.0f}}},
    {{{0x1.921fb6p+0f, 0, 1}}},
    {{{-0x1.921fb6p+0f, 0, -1}}},
    {{{0x1.921fb6p+1f, -1, 0}}},
    {{{0x1p26f, 1, 0}}},
    {{{FLT_MAX, 1, 0}}},
    {{{-FLT_MAX, 1, 0}}},
    {{{INFINITY, NAN, NAN}}},
    {{{-INFINITY, NAN, NAN}}},
    {{{NAN, NAN, NAN}}},
};

static void angle_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    (void)t;
    r[0][0] = A(1), r[0][1] = A(2);
    r[0][2] = r[0][3] = C(2);
}

static void angles_at_the_edges(void)
{
    static const char *const those[] = {"vs_3_0", "ps_3_0", "vs_2_0", "vs_2_x", "ps_2_0", "ps_2_x"};
    for (int m = 0; m < 6; m++) {
        int series = m >= 2;
        struct trial trial = {.model = those[m],
                              .setup = series ? SERIES : NULL,
                              .body = series ? "mov r0, r3\nsincos r0.xy, r1.x, c20, c21"
                                             : "mov r0, r3\nsincos r0.xy, r1.x",
                              .results = 1,
                              .operands = angles,
                              .sets = sizeof angles / sizeof *angles};
        trial_expect_within(&trial, angle_reference, 0, 1.6e-7);
    }
}

/* cnd is of ps_1_x only (tests/spec/shader_1.c). */
static void no_instruction_is_without_a_row(void)
{
    for (int opcode = 0; opcode < SHADER_COUNT; opcode++) {
        const struct shader_operation *operation = &shader_operations[opcode];
        int tried = opcode == SHADER_CND;
        if (operation->destination != OPERAND_RESULT || operation->flags & (IS_TEXTURE | IS_GRADIENT))
            continue;
        for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
            tried |= (int)rows[i].opcode == opcode;
        TEST_ASSERT_TRUE_MESSAGE(tried, operation->name);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(no_instruction_is_without_a_row);
    RUN_TEST(instructions_compute_what_their_definitions_say);
    RUN_TEST(every_instruction_takes_every_modifier);
    RUN_TEST(light_at_the_edges);
    RUN_TEST(angles_at_the_edges);
    RUN_TEST(constants_that_are_known_compute_the_same);
    RUN_TEST(masks_leave_the_other_components_alone);
    RUN_TEST(with_legacy_multiplication_zeros_give_zero);
    return UNITY_END();
}
