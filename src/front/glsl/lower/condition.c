/* Bools: comparisons, logical operators, selection (5.8, 5.9). */
#include "front/glsl/lower/lower.h"

/* --- Expressions that can be computed without a branch -------------------------------------------------- */

enum { CHEAP = 24 };

/* The number of nodes, up to a limit. */
static unsigned nodes_of(const struct glsl_expression *x, unsigned limit)
{
    unsigned count = 1;
    if (x->value)
        return 1;
    for (unsigned i = 0; i < 3 && x->operand[i] && count < limit; i++)
        count += nodes_of(x->operand[i], limit - count);
    for (const struct glsl_expression *a = x->argument; a && count < limit; a = a->next)
        count += nodes_of(a, limit - count);
    return count;
}

static bool is_cheap(const struct glsl_expression *x)
{
    return !x->impure && nodes_of(x, CHEAP) < CHEAP;
}

/* --- Comparisons ---------------------------------------------------------------------------------------- */

struct glsl_operand glsl_lower_reduce(struct glsl_lowering *l, enum glsl_op op, struct glsl_operand vector,
                                      unsigned rows)
{
    struct glsl_operand result = glsl_operand_scalar(vector, 0);
    for (unsigned i = 1; i < rows; i++)
        result = glsl_emit_2(&l->code, op, 1, result, glsl_operand_scalar(vector, i));
    return result;
}

/* Structures and matrices are equal if all their registers are. */
struct glsl_value glsl_lower_equal(struct glsl_lowering *l, const struct glsl_expression *x)
{
    bool equal = x->operation == GLSL_EQUAL;
    enum glsl_op compare = equal ? GLSL_OP_SEQ : GLSL_OP_SNE, combine = equal ? GLSL_OP_MIN : GLSL_OP_MAX;
    struct glsl_value a = glsl_lower_before(l, x->operand[0], x->operand[1]);
    struct glsl_value b = glsl_lower_expression(l, x->operand[1]);
    struct glsl_operand all = {0};
    for (unsigned i = 0; i < glsl_registers(a.type) && !l->code.failure; i++) {
        unsigned rows = glsl_value_rows(a.type, i);
        struct glsl_operand is =
            glsl_emit_2(&l->code, compare, rows, glsl_value_part(l, &a, i), glsl_value_part(l, &b, i));
        is = glsl_lower_reduce(l, combine, is, rows);
        all = i ? glsl_emit_2(&l->code, combine, 1, all, is) : is;
    }
    return glsl_value_of(x->type, all);
}

static struct glsl_operand compared(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_value left = glsl_lower_before(l, x->operand[0], x->operand[1]);
    struct glsl_operand a = glsl_value_part(l, &left, 0), b = glsl_lower_operand(l, x->operand[1]);
    switch ((enum glsl_operator)x->operation) {
    case GLSL_LESS: return glsl_emit_2(&l->code, GLSL_OP_SLT, 1, a, b);
    case GLSL_GREATER: return glsl_emit_2(&l->code, GLSL_OP_SLT, 1, b, a);
    case GLSL_LESS_EQUAL: return glsl_emit_2(&l->code, GLSL_OP_SGE, 1, b, a);
    case GLSL_GREATER_EQUAL: return glsl_emit_2(&l->code, GLSL_OP_SGE, 1, a, b);
    case GLSL_XOR: return glsl_emit_2(&l->code, GLSL_OP_SNE, 1, a, b);
    case GLSL_AND: return glsl_emit_2(&l->code, GLSL_OP_MIN, 1, a, b);
    default: return glsl_emit_2(&l->code, GLSL_OP_MAX, 1, a, b); /* GLSL_OR */
    }
}

/* The right operand of && and || is evaluated only if the left one does not decide. */
static struct glsl_operand decided(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_operand result = glsl_operand_temporary(glsl_code_temporary(&l->code, 1), 1);
    struct glsl_operand left = glsl_lower_operand(l, x->operand[0]);
    glsl_emit(&l->code, GLSL_OP_MOV, result, 1, &left);
    glsl_emit_if(&l->code, x->operation == GLSL_AND ? GLSL_IS_NOT_EQUAL : GLSL_IS_EQUAL, result,
                 glsl_operand_literal(&l->code, 0));
    glsl_emit_store(&l->code, result, 1, glsl_lower_operand(l, x->operand[1]));
    glsl_emit_endif(&l->code);
    return result;
}

struct glsl_value glsl_lower_logical(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_operand result;
    if (x->operation == GLSL_NOT)
        result = glsl_emit_2(&l->code, GLSL_OP_SEQ, 1, glsl_lower_operand(l, x->operand[0]),
                             glsl_operand_literal(&l->code, 0));
    else if ((x->operation == GLSL_AND || x->operation == GLSL_OR) && !is_cheap(x->operand[1]))
        result = decided(l, x);
    else
        result = compared(l, x);
    return glsl_value_of(x->type, result);
}

/* --- Conditions of branches ----------------------------------------------------------------------------- */

static struct glsl_condition of_bool(struct glsl_lowering *l, const struct glsl_expression *x, bool wanted)
{
    struct glsl_operand value = glsl_lower_operand(l, x);
    return (struct glsl_condition){wanted ? GLSL_IS_NOT_EQUAL : GLSL_IS_EQUAL, value,
                                   glsl_operand_literal(&l->code, 0)};
}

struct glsl_condition glsl_lower_condition(struct glsl_lowering *l, const struct glsl_expression *x,
                                           bool wanted)
{
    static const uint8_t comparison[2][6] = {{GLSL_IS_GREATER_EQUAL, GLSL_IS_LESS_EQUAL, GLSL_IS_GREATER,
                                              GLSL_IS_LESS, GLSL_IS_NOT_EQUAL, GLSL_IS_EQUAL},
                                             {GLSL_IS_LESS, GLSL_IS_GREATER, GLSL_IS_LESS_EQUAL,
                                              GLSL_IS_GREATER_EQUAL, GLSL_IS_EQUAL, GLSL_IS_NOT_EQUAL}};
    if (x->operation == GLSL_NOT && !x->value)
        return glsl_lower_condition(l, x->operand[0], !wanted);
    bool relation = !x->value && x->operation >= GLSL_LESS && x->operation <= GLSL_NOT_EQUAL &&
                    glsl_is_scalar(x->operand[0]->type);
    bool ordered = relation && x->operation < GLSL_EQUAL;
    /* "not less" is not "greater or equal" if one is NaN. */
    if (!relation || (!wanted && ordered && x->operand[0]->type.base == GLSL_FLOAT))
        return of_bool(l, x, wanted);
    struct glsl_value a = glsl_lower_before(l, x->operand[0], x->operand[1]);
    struct glsl_operand left = glsl_value_part(l, &a, 0), right = glsl_lower_operand(l, x->operand[1]);
    return (struct glsl_condition){comparison[wanted][x->operation - GLSL_LESS], left, right};
}

/* --- Selection ------------------------------------------------------------------------------------------ */

static struct glsl_value branched(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_value result = glsl_value_temporary(l, x->type);
    struct glsl_condition condition = glsl_lower_condition(l, x->operand[0], true);
    glsl_emit_if(&l->code, (enum glsl_comparison)condition.comparison, condition.a, condition.b);
    struct glsl_value a = glsl_lower_expression(l, x->operand[1]);
    glsl_value_copy(l, &result, &a);
    glsl_emit_else(&l->code);
    struct glsl_value b = glsl_lower_expression(l, x->operand[2]);
    glsl_value_copy(l, &result, &b);
    glsl_emit_endif(&l->code);
    return result;
}

static struct glsl_value selected(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_value result = glsl_value_temporary(l, x->type);
    struct glsl_operand condition = glsl_lower_operand(l, x->operand[0]);
    struct glsl_value a = glsl_lower_expression(l, x->operand[1]);
    struct glsl_value b = glsl_lower_expression(l, x->operand[2]);
    for (unsigned i = 0; i < glsl_registers(x->type) && !l->code.failure; i++) {
        struct glsl_operand to = result.at;
        struct glsl_operand from[] = {condition, glsl_value_part(l, &a, i), glsl_value_part(l, &b, i)};
        to.number += i;
        glsl_emit(&l->code, GLSL_OP_SELECT, to, glsl_mask(glsl_value_rows(x->type, i)), from);
    }
    return result;
}

struct glsl_value glsl_lower_select(struct glsl_lowering *l, const struct glsl_expression *x)
{
    if (x->operand[0]->value)
        return glsl_lower_expression(l, x->operand[x->operand[0]->value->i ? 1 : 2]);
    return is_cheap(x->operand[1]) && is_cheap(x->operand[2]) ? selected(l, x) : branched(l, x);
}
