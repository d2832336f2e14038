/* The functions of chapter 8, by the steps of builtin.def. */
#include "front/glsl/check/builtin.h"
#include "front/glsl/lower/lower.h"

/* --- The table ------------------------------------------------------------------------------------------ */

enum { GLSL_OP_DOT = GLSL_OPS, GLSL_OP_SIN, GLSL_OP_COS, GLSL_OP_SERIES };

enum cell {
    CELL_NONE,
    CELL_R,
    CELL_A,
    CELL_B,
    CELL_C,
    CELL_T0,
    CELL_T1,
    CELL_T2,
    CELL_T3,
    CELL_T4,
    CELL_S0,
    CELL_S1,
    CELL_S2,
    CELL_NUMBER,
    CELLS = CELL_NUMBER
};

enum sign { PLAIN, NEGATIVE, MAGNITUDE };

enum series {
#define GLSL_SERIES(id, ...) SERIES_##id##_ROW,
#include "front/glsl/lower/builtin.def"
#undef GLSL_SERIES
    SERIES_ROWS
};

enum { MOST_COEFFICIENTS = 9 };

/* From the highest power on; those of shorter series are followed by zeros. */
static const float series[SERIES_ROWS][MOST_COEFFICIENTS] = {
#define GLSL_SERIES(id, ...) {__VA_ARGS__},
#include "front/glsl/lower/builtin.def"
#undef GLSL_SERIES
};

struct source {
    uint8_t cell, sign;
    float number;
};

static const struct step {
    uint8_t id, op, to;
    struct source from[3];
} steps[] = {
#define PLAIN_OF(cell)                                                                                       \
    {                                                                                                        \
        CELL_##cell, PLAIN, 0                                                                                \
    }
#define __ PLAIN_OF(NONE)
#define A  PLAIN_OF(A)
#define B  PLAIN_OF(B)
#define C  PLAIN_OF(C)
#define T0 PLAIN_OF(T0)
#define T1 PLAIN_OF(T1)
#define T2 PLAIN_OF(T2)
#define T3 PLAIN_OF(T3)
#define T4 PLAIN_OF(T4)
#define S0 PLAIN_OF(S0)
#define S1 PLAIN_OF(S1)
#define S2 PLAIN_OF(S2)
#define NEGATIVE_OF(cell)                                                                                    \
    {                                                                                                        \
        CELL_##cell, NEGATIVE, 0                                                                             \
    }
#define N_A  NEGATIVE_OF(A)
#define N_B  NEGATIVE_OF(B)
#define N_T0 NEGATIVE_OF(T0)
#define N_T1 NEGATIVE_OF(T1)
#define N_T3 NEGATIVE_OF(T3)
#define N_T4 NEGATIVE_OF(T4)
#define N_S0 NEGATIVE_OF(S0)
#define N_S1 NEGATIVE_OF(S1)
#define N_S2 NEGATIVE_OF(S2)
#define MAGNITUDE_OF(cell)                                                                                   \
    {                                                                                                        \
        CELL_##cell, MAGNITUDE, 0                                                                            \
    }
#define M_A  MAGNITUDE_OF(A)
#define M_B  MAGNITUDE_OF(B)
#define M_T0 MAGNITUDE_OF(T0)
#define M_T1 MAGNITUDE_OF(T1)
#define K(x)                                                                                                 \
    {                                                                                                        \
        CELL_NUMBER, PLAIN, (float)(x)                                                                       \
    }
#define SERIES_ATAN                                                                                          \
    {                                                                                                        \
        CELL_NUMBER, PLAIN, SERIES_ATAN_ROW                                                                  \
    }
#define SERIES_ASIN                                                                                          \
    {                                                                                                        \
        CELL_NUMBER, PLAIN, SERIES_ASIN_ROW                                                                  \
    }
#define GLSL_STEP(id, op, to, ...) {GLSL_CALL_##id, GLSL_OP_##op, CELL_##to, {__VA_ARGS__}},
#include "front/glsl/lower/builtin.def"
#undef GLSL_STEP
#undef __
#undef A
#undef B
#undef C
#undef K
};

enum { STEPS = sizeof steps / sizeof *steps };

/* --- Steps ---------------------------------------------------------------------------------------------- */

/* A call: the operands of its cells, and the rows of its result and of its widest argument. */
struct call {
    struct glsl_operand cell[CELLS];
    unsigned rows, width;
};

static struct glsl_operand source_of(struct glsl_lowering *l, const struct call *call,
                                     const struct source *source)
{
    if (source->cell == CELL_NUMBER)
        return glsl_operand_literal(&l->code, source->number);
    struct glsl_operand x = call->cell[source->cell];
    if (source->sign == NEGATIVE)
        x.negative = !x.negative;
    if (source->sign == MAGNITUDE) {
        x.negative = false;
        x.absolute = true;
    }
    return x;
}

/* Instructions that compute one scalar, for each component. sincos has its results in y and x. */
static struct glsl_operand each_component(struct glsl_lowering *l, enum glsl_op op, unsigned result,
                                          unsigned rows, const struct glsl_operand *from)
{
    struct glsl_operand to = glsl_operand_temporary(glsl_code_temporary(&l->code, 1), rows);
    for (unsigned c = 0; c < rows; c++) {
        struct glsl_operand scalar = glsl_operand_temporary(glsl_code_temporary(&l->code, 1), 1);
        struct glsl_operand part[] = {glsl_operand_scalar(from[0], c), glsl_operand_scalar(from[1], c)};
        scalar.swizzle = glsl_replicate(result);
        glsl_emit(&l->code, op, scalar, 1u << result, part);
        glsl_emit_store(&l->code, to, 1u << c, scalar);
    }
    return to;
}

static struct glsl_operand polynomial(struct glsl_lowering *l, unsigned rows, struct glsl_operand x,
                                      const float *coefficient)
{
    struct glsl_operand sum = glsl_operand_literal(&l->code, coefficient[0]);
    for (unsigned i = 1; i < MOST_COEFFICIENTS && coefficient[i] != 0; i++)
        sum =
            glsl_emit_3(&l->code, GLSL_OP_MAD, rows, sum, x, glsl_operand_literal(&l->code, coefficient[i]));
    return sum;
}

static struct glsl_operand run_step(struct glsl_lowering *l, const struct call *call, const struct step *step)
{
    struct glsl_operand from[3] = {0};
    unsigned rows = step->to == CELL_R ? call->rows : step->to >= CELL_S0 ? 1 : call->width;
    for (unsigned i = 0; i < 3 && step->from[i].cell; i++)
        from[i] = source_of(l, call, &step->from[i]);
    switch (step->op) {
    case GLSL_OP_DOT: return glsl_emit_dot(&l->code, call->width, from[0], from[1]);
    case GLSL_OP_SIN: return each_component(l, GLSL_OP_SINCOS, 1, rows, from);
    case GLSL_OP_COS: return each_component(l, GLSL_OP_SINCOS, 0, rows, from);
    case GLSL_OP_SERIES: return polynomial(l, rows, from[0], series[(unsigned)step->from[1].number]);
    case GLSL_OP_RSQ:
    case GLSL_OP_EXP:
    case GLSL_OP_LOG:
    case GLSL_OP_POW: return each_component(l, (enum glsl_op)step->op, 0, rows, from);
    default: return glsl_emit_3(&l->code, (enum glsl_op)step->op, rows, from[0], from[1], from[2]);
    }
}

static struct glsl_operand run_steps(struct glsl_lowering *l, struct call *call, unsigned id)
{
    unsigned i = 0;
    while (i < STEPS && steps[i].id != id)
        i++;
    for (; i < STEPS && steps[i].id == id; i++)
        call->cell[steps[i].to] = run_step(l, call, &steps[i]);
    return call->cell[CELL_R];
}

/* --- Calls ---------------------------------------------------------------------------------------------- */

static struct glsl_value multiply_components(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_value a = glsl_lower_argument(l, x->argument), b = glsl_lower_argument(l, x->argument->next);
    struct glsl_value result = glsl_value_temporary(l, x->type);
    for (unsigned i = 0; i < x->type.columns && !l->code.failure; i++) {
        struct glsl_operand to = result.at;
        struct glsl_operand from[] = {glsl_value_part(l, &a, i), glsl_value_part(l, &b, i)};
        to.number += i;
        glsl_emit(&l->code, GLSL_OP_MUL, to, glsl_mask(x->type.rows), from);
    }
    return result;
}

static struct glsl_value call_steps(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct call call = {.rows = x->type.rows, .width = 1};
    unsigned cell = CELL_A;
    for (const struct glsl_expression *a = x->argument; a; a = a->next) {
        struct glsl_value value = glsl_lower_argument(l, a);
        if (call.width < a->type.rows)
            call.width = a->type.rows;
        if (!l->code.failure)
            call.cell[cell++] = glsl_value_part(l, &value, 0);
    }
    return glsl_value_of(x->type, run_steps(l, &call, x->index));
}

struct glsl_value glsl_lower_builtin(struct glsl_lowering *l, const struct glsl_expression *x)
{
    bool all = x->index == GLSL_CALL_ALL;
    if (x->index >= GLSL_CALL_TEXTURE && x->index <= GLSL_CALL_TEXTURE_PROJ_GRADIENT)
        return glsl_lower_texture(l, x);
    if (x->index == GLSL_CALL_MATRIXCOMPMULT)
        return multiply_components(l, x);
    if (!all && x->index != GLSL_CALL_ANY)
        return call_steps(l, x);
    struct glsl_operand vector = glsl_lower_operand(l, x->argument);
    return glsl_value_of(
        x->type, glsl_lower_reduce(l, all ? GLSL_OP_MIN : GLSL_OP_MAX, vector, x->argument->type.rows));
}
