/* The arithmetic of ps_1_1 to ps_1_4: the same instructions with registers of a limited range. Constants are
 * limited to
 * -1 to 1, and results to -8 to 8. */
#include "tests/spec/shader/operand.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static const float constants[2][4] = {{0.75f, 3, -0.625f, -5}, {-1, 0.25f, 1.5f, -0.0f}};

/* Returns a constant as the shader reads it, limited to -1 to 1. */
static double constant(int row, int c)
{
    return fmin(fmax((double)constants[row][c], -1), 1);
}

static double within(double value)
{
    return value > -8 ? value < 8 ? value : 8 : -8;
}

/* The shift and saturation of the trial's result, and the modifier of the first operand. */
static int shift, saturates;
static enum shader_modifier_id modifier;

static double finished(double value)
{
    double shifted = shift ? ldexp(rounded(value), shift) : value;
    if (saturates)
        return shifted > 0 ? shifted < 1 ? shifted : 1 : 0;
    return within(shifted);
}

static double modified(double a)
{
    switch (modifier) {
    case MODIFIER_NEGATE: return -a;
    case MODIFIER_BIAS: return rounded(a - 0.5);
    case MODIFIER_NEGATE_BIAS: return rounded(0.5 - a);
    case MODIFIER_SIGN: return rounded(2 * a - 1);
    case MODIFIER_NEGATE_SIGN: return rounded(1 - 2 * a);
    case MODIFIER_COMPLEMENT: return rounded(1 - a);
    case MODIFIER_X2: return rounded(2 * a);
    case MODIFIER_NEGATE_X2: return rounded(-2 * a);
    default: return a;
    }
}

/* The operands after their modifiers. */
static double first(operands o, int c)
{
    return modified(at(o, 0, c));
}

static double times(const struct trial *t, double a, double b)
{
    return t->legacy && (a == 0 || b == 0) ? 0 : a * b;
}

static double plus_times(const struct trial *t, double a, double b, double c)
{
    return t->legacy ? rounded(times(t, a, b)) + c : trial_fused(a, b, c);
}

#define A constant(0, i)
#define B constant(1, i)

#define COMPONENTS(name, expression)                                                                         \
    static void name##_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])              \
    {                                                                                                        \
        (void)t;                                                                                             \
        for (int i = 0; i < 4; i++) {                                                                        \
            double x = first(o, i), y = at(o, 1, i);                                                         \
            (void)x, (void)y;                                                                                \
            r[0][i] = finished(expression);                                                                  \
        }                                                                                                    \
    }

static double dot(const struct trial *t, operands o, int count)
{
    double sum = rounded(times(t, first(o, 0), at(o, 1, 0)));
    for (int c = 1; c < count; c++)
        sum = rounded(plus_times(t, first(o, c), at(o, 1, c), sum));
    return sum;
}

COMPONENTS(mov, x)
COMPONENTS(constant, A)
COMPONENTS(add, x + y)
COMPONENTS(sub, x - B)
COMPONENTS(mul, times(t, x, y))
COMPONENTS(mad, plus_times(t, x, y, A))
COMPONENTS(lrp, plus_times(t, x, rounded(y - A), A))
COMPONENTS(cmp, x >= 0 ? y : B)
COMPONENTS(cnd, x > 0.5 ? y : B)
COMPONENTS(cnd_alpha, within(first(o, 3)) > 0.5 ? y : B)
COMPONENTS(dp3, dot(t, o, 3))
COMPONENTS(dp4, dot(t, o, 4))

/* Sixteen times a number, which exceeds the range of registers and is limited after each step. */
COMPONENTS(grown, within(within(x * 4) * 4) * 0.25)

static const struct row {
    enum shader_opcode opcode;
    const char *body;
    trial_reference *reference;
    unsigned models; /* bit m: ps_1_<m + 1> */
} rows[] = {
    {SHADER_MOV, "mov r0, $1", mov_reference, 15},
    {SHADER_MOV, "mov r0, c0", constant_reference, 15},
    {SHADER_ADD, "add r0, $1, $2", add_reference, 15},
    {SHADER_SUB, "sub r0, $1, c1", sub_reference, 15},
    {SHADER_MUL, "mul r0, $1, $2", mul_reference, 15},
    {SHADER_MAD, "mad r0, $1, $2, c0", mad_reference, 15},
    {SHADER_LRP, "lrp r0, $1, $2, c0", lrp_reference, 15},
    {SHADER_DP3, "dp3 r0, $1, $2", dp3_reference, 15},
    {SHADER_DP4, "dp4 r0, $1, $2", dp4_reference, 14},
    {SHADER_CMP, "cmp r0, $1, $2, c1", cmp_reference, 14},
    {SHADER_CND, "cnd r0, $1, $2, c1", cnd_reference, 8},
    {SHADER_CND, "mov r0, $1\ncnd r0, r0.a, $2, c1", cnd_alpha_reference, 7},
    {SHADER_MOV, "mov_x4 r0, $1\nmov_x4 r0, r0\nmov_d2 r0, r0\nmov_d2 r0, r0", grown_reference, 15},
};

/* Constants are set by the draw or defined by the shader. Both are limited to -1 to 1. */
static void try_row(const struct row *row, int model, const char *body, int legacy,
                    const struct trial_operands *sets, unsigned count, int alone)
{
    static const char *const defined = "def c0, 0.75, 3, -0.625, -5\ndef c1, -1, 0.25, 1.5, -0.0\n";
    char name[] = "ps_1_1";
    name[5] = (char)('1' + model);
    struct trial trial = {.model = name, .body = body, .results = 1, .legacy = legacy};
    if (legacy)
        trial.setup = defined;
    else
        trial.constant = constants, trial.constants = 2;
    trial.operands = sets;
    trial.sets = count;
    trial.alone = alone;
    trial_expect(&trial, row->reference);
}

static void each_row(const struct trial_operands *sets, unsigned count, int alone)
{
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int model = 0; model < 4; model++)
            for (int legacy = 0; legacy < 2; legacy++)
                if (rows[i].models >> model & 1)
                    try_row(&rows[i], model, rows[i].body, legacy, sets, count, alone);
}

static void the_machine_computes_the_definitions(void)
{
    each_row(trial_edges, trial_edge_sets, 1);
}

enum { SETS = 120 };

/* Returns the sets of operands within -8 and 8, with edge values. Operands of draws are texels, which are
 * limited to this range. */
static const struct trial_operands *narrow_sets(void)
{
    static struct trial_operands sets[SETS];
    for (unsigned s = 0; s < 120; s++) {
        sets[s] = s < 60 ? trial_edges[s * 4] : trial_ordinary[s - 60];
        for (int o = 0; o < 2; o++)
            for (int c = 0; c < 4; c++)
                if (!(fabsf(sets[s].v[o][c]) <= 8))
                    sets[s].v[o][c] = (float)(o * 4 + c) - 7.5f;
    }
    return sets;
}

static void engines_compute_the_definitions(void)
{
    each_row(narrow_sets(), SETS, 0);
}

/* --- Modifiers ----------------------------------------------------------------------------------------- */

static const char *const shifts[] = {"_d8", "_d4", "_d2", "", "_x2", "_x4", "_x8"};

/* The body, with the modifier at $1 and the shift and _sat at the last instruction. */
static void modify_body(const char *body, char *text)
{
    const char *end = strrchr(body, '\n'), *last = end ? end + 1 : body, *after = strchr(last, ' ');
    const struct shader_modifier *m = &shader_modifiers[modifier];
    *text = 0;
    for (const char *c = body; *c; c++) {
        if (c == after)
            sprintf(text + strlen(text), "%s%s", shifts[shift + 3], saturates ? "_sat" : "");
        if (*c == '$' && c[1] == '1')
            sprintf(text + strlen(text), "%s$1%s", m->before, m->after), c++;
        else
            strncat(text, c, 1);
    }
}

static void try_modified(const struct row *row, int model, int alone)
{
    char body[200];
    modify_body(row->body, body);
    try_row(row, model, body, 0, narrow_sets(), SETS, alone);
}

/* Tries all results. Engines are tried in ps_1_1 and ps_1_4, with the shifts that all models have. */
static void try_results(const struct row *row, int model)
{
    for (shift = -3; shift <= 3; shift++)
        for (saturates = 0; saturates < 2; saturates++)
            if (model == 3 || (shift >= -1 && shift <= 2)) /* _x8, _d4 and _d8 are ps_1_4's */
                try_modified(row, model, model % 3 || shift % 2 == 0);
    shift = saturates = 0;
}

static void try_sources(const struct row *row, int model)
{
    for (modifier = MODIFIER_NONE; modifier <= MODIFIER_NEGATE_X2; modifier++)
        if (shader_modifiers[modifier].columns[COLUMN_PS_1_1 + model] == 'x')
            try_modified(row, model, model % 3);
    modifier = MODIFIER_NONE;
}

static void every_instruction_works_with_every_modifier(void)
{
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int model = 0; model < 4; model++)
            if (rows[i].models >> model & 1 && rows[i].reference != grown_reference) {
                try_results(&rows[i], model);
                if (strstr(rows[i].body, "$1"))
                    try_sources(&rows[i], model);
            }
}

static void every_instruction_of_these_models_has_a_row(void)
{
    for (int opcode = 0; opcode < SHADER_COUNT; opcode++) {
        const struct shader_operation *operation = &shader_operations[opcode];
        unsigned wanted = 0, tried = 0;
        if (operation->destination != OPERAND_RESULT || operation->flags & IS_TEXTURE)
            continue;
        for (int model = 0; model < 4; model++)
            if (shader_slots(operation, &shader_models[MODEL_PS_1_1 + model]) >= 0)
                wanted |= 1u << model;
        for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
            if ((int)rows[i].opcode == opcode)
                tried |= rows[i].models;
        TEST_ASSERT_EQUAL_HEX_MESSAGE(wanted, tried, operation->name);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_instruction_of_these_models_has_a_row);
    RUN_TEST(the_machine_computes_the_definitions);
    RUN_TEST(engines_compute_the_definitions);
    RUN_TEST(every_instruction_works_with_every_modifier);
    return UNITY_END();
}
