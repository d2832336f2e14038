/* Operators (5.8 to 5.10). */
#include "front/glsl/lower/lower.h"

struct glsl_operand glsl_lower_operand(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_value value = glsl_lower_expression(l, x);
    return glsl_value_part(l, &value, 0);
}

/* Returns true if the value is in registers that code can change. */
static bool can_change(const struct glsl_lowering *l, const struct glsl_value *value)
{
    return !value->constant && value->at.file == GLSL_FILE_TEMPORARY && l->code.temporaries &&
           (value->at.access || l->code.temporary[value->at.number].variable);
}

struct glsl_value glsl_lower_before(struct glsl_lowering *l, const struct glsl_expression *x,
                                    const struct glsl_expression *later)
{
    struct glsl_value value = glsl_lower_expression(l, x);
    return later && later->impure && can_change(l, &value) ? glsl_value_copied(l, &value) : value;
}

bool glsl_lower_any_impure(const struct glsl_expression *x)
{
    while (x && !x->impure)
        x = x->next;
    return x;
}

struct glsl_value glsl_lower_argument(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_value value = glsl_lower_expression(l, x);
    return glsl_lower_any_impure(x->next) && can_change(l, &value) ? glsl_value_copied(l, &value) : value;
}

/* --- Arithmetic ----------------------------------------------------------------------------------------- */

static struct glsl_operand divide(struct glsl_lowering *l, unsigned base, unsigned rows,
                                  struct glsl_operand a, struct glsl_operand b)
{
    struct glsl_operand quotient = glsl_emit_2(&l->code, GLSL_OP_DIV, rows, a, b);
    return base == GLSL_INT ? glsl_emit_1(&l->code, GLSL_OP_TRUNC, rows, quotient) : quotient;
}

static struct glsl_operand compute(struct glsl_lowering *l, unsigned operation, unsigned base, unsigned rows,
                                   struct glsl_operand a, struct glsl_operand b)
{
    switch ((enum glsl_operator)operation) {
    case GLSL_SUBTRACT: return glsl_emit_2(&l->code, GLSL_OP_ADD, rows, a, glsl_operand_negative(b));
    case GLSL_MULTIPLY: return glsl_emit_2(&l->code, GLSL_OP_MUL, rows, a, b);
    case GLSL_DIVIDE: return divide(l, base, rows, a, b);
    default: return glsl_emit_2(&l->code, GLSL_OP_ADD, rows, a, b);
    }
}

static bool is_product(unsigned operation, const struct glsl_value *a, const struct glsl_value *b)
{
    return operation == GLSL_MULTIPLY && (a->type.columns > 1 || b->type.columns > 1) &&
           !glsl_is_scalar(a->type) && !glsl_is_scalar(b->type);
}

/* a operation b; a scalar applies to all components. */
static struct glsl_value arithmetic(struct glsl_lowering *l, unsigned operation, struct glsl_type type,
                                    const struct glsl_value *a, const struct glsl_value *b)
{
    if (is_product(operation, a, b))
        return glsl_lower_product(l, a, b, type);
    if (type.columns == 1)
        return glsl_value_of(type, compute(l, operation, type.base, type.rows, glsl_value_part(l, a, 0),
                                           glsl_value_part(l, b, 0)));
    struct glsl_value result = glsl_value_temporary(l, type);
    for (unsigned i = 0; i < type.columns; i++) {
        struct glsl_operand to = result.at;
        to.number += i;
        struct glsl_operand column = compute(l, operation, type.base, type.rows,
                                             glsl_value_part(l, a, glsl_is_scalar(a->type) ? 0 : i),
                                             glsl_value_part(l, b, glsl_is_scalar(b->type) ? 0 : i));
        glsl_emit_store(&l->code, to, glsl_mask(type.rows), column);
    }
    return result;
}

/* Returns true if the node is a product that can be fused with a sum. The decision depends on the expression
 * only, so equal expressions have equal results in all shaders (4.6). */
static bool is_fusible(const struct glsl_expression *x)
{
    return x->operation == GLSL_MULTIPLY && !x->value && x->operand[0]->type.columns == 1 &&
           x->operand[1]->type.columns == 1;
}

/* a * b + c, or with a sign each of the product and of the sum. */
static struct glsl_value fused(struct glsl_lowering *l, const struct glsl_expression *x,
                               const struct glsl_expression *product, const struct glsl_expression *addend)
{
    bool first = x->operand[0] == product;
    struct glsl_value c = {0};
    if (!first)
        c = glsl_lower_before(l, addend, product);
    struct glsl_value a = glsl_lower_before(l, product->operand[0],
                                            product->operand[1]->impure ? product->operand[1]
                                            : first                     ? addend
                                                                        : NULL);
    struct glsl_value b = glsl_lower_before(l, product->operand[1], first ? addend : NULL);
    if (first)
        c = glsl_lower_expression(l, addend);
    struct glsl_operand from[] = {glsl_value_part(l, &a, 0), glsl_value_part(l, &b, 0),
                                  glsl_value_part(l, &c, 0)};
    if (x->operation == GLSL_SUBTRACT)
        from[first ? 2 : 0].negative ^= 1;
    return glsl_value_of(x->type,
                         glsl_emit_3(&l->code, GLSL_OP_MAD, x->type.rows, from[0], from[1], from[2]));
}

static struct glsl_value binary(struct glsl_lowering *l, const struct glsl_expression *x)
{
    bool sum = (x->operation == GLSL_ADD || x->operation == GLSL_SUBTRACT) && x->type.columns == 1;
    if (sum && is_fusible(x->operand[0]))
        return fused(l, x, x->operand[0], x->operand[1]);
    if (sum && is_fusible(x->operand[1]))
        return fused(l, x, x->operand[1], x->operand[0]);
    struct glsl_value a = glsl_lower_before(l, x->operand[0], x->operand[1]);
    struct glsl_value b = glsl_lower_expression(l, x->operand[1]);
    return arithmetic(l, x->operation, x->type, &a, &b);
}

static struct glsl_value negated(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_value value = glsl_lower_expression(l, x->operand[0]);
    if (!value.constant) {
        value.at.negative ^= 1;
        return value;
    }
    struct glsl_value result = glsl_value_temporary(l, x->type);
    for (unsigned i = 0; i < x->type.columns; i++) {
        struct glsl_operand to = result.at, part = glsl_value_part(l, &value, i);
        to.number += i;
        part.negative = true;
        glsl_emit_store(&l->code, to, glsl_mask(x->type.rows), part);
    }
    return result;
}

/* --- Assignments ---------------------------------------------------------------------------------------- */

/* The place keeps its meaning if the value is computed after it: the index is copied already
 * (glsl_value_index), and the variable is not moved. */
static struct glsl_value assign(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_place_to to = glsl_lower_place(l, x->operand[0]);
    struct glsl_value value = glsl_lower_expression(l, x->operand[1]);
    if (l->code.failure)
        return value;
    if (x->update) {
        struct glsl_value old = glsl_lower_read(l, &to);
        value = arithmetic(l, x->update, x->type, &old, &value);
    }
    glsl_lower_write(l, &to, &value);
    return to.component.file ? glsl_lower_read(l, &to) : to.value;
}

/* The value before is copied, because the place is written then. */
static struct glsl_value increment(struct glsl_lowering *l, const struct glsl_expression *x)
{
    bool after = x->operation == GLSL_INCREMENT_AFTER || x->operation == GLSL_DECREMENT_AFTER;
    bool up = x->operation == GLSL_INCREMENT || x->operation == GLSL_INCREMENT_AFTER;
    static const union glsl_scalar one = {.f = 1};
    struct glsl_place_to to = glsl_lower_place(l, x->operand[0]);
    struct glsl_value step = glsl_value_constant(glsl_type_of(GLSL_FLOAT, 1, 1), &one);
    struct glsl_value old = glsl_lower_read(l, &to);
    if (after && x->type.base != GLSL_ERROR)
        old = glsl_value_copied(l, &old);
    if (l->code.failure)
        return old;
    struct glsl_value value = arithmetic(l, up ? GLSL_ADD : GLSL_SUBTRACT, x->type, &old, &step);
    glsl_lower_write(l, &to, &value);
    return after ? old : glsl_lower_read(l, &to);
}

void glsl_lower_effects(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_expression before = *x;
    if (x->operation == GLSL_INCREMENT_AFTER)
        before.operation = GLSL_INCREMENT;
    if (x->operation == GLSL_DECREMENT_AFTER)
        before.operation = GLSL_DECREMENT;
    if (x->impure)
        glsl_lower_expression(l, &before);
}

/* --- All ------------------------------------------------------------------------------------------------ */

static struct glsl_value lower(struct glsl_lowering *l, const struct glsl_expression *x)
{
    switch ((enum glsl_operator)x->operation) {
    case GLSL_VALUE: break;
    case GLSL_READ: return glsl_value_variable(l, x->variable);
    case GLSL_FIELD:
    case GLSL_INDEX:
    case GLSL_SWIZZLE: return glsl_lower_part(l, x);
    case GLSL_CALL: return glsl_lower_call(l, x);
    case GLSL_CALL_BUILTIN: return glsl_lower_builtin(l, x);
    case GLSL_CONSTRUCT: return glsl_lower_construct(l, x);
    case GLSL_NEGATE: return negated(l, x);
    case GLSL_INCREMENT:
    case GLSL_DECREMENT:
    case GLSL_INCREMENT_AFTER:
    case GLSL_DECREMENT_AFTER: return increment(l, x);
    case GLSL_ADD:
    case GLSL_SUBTRACT:
    case GLSL_MULTIPLY:
    case GLSL_DIVIDE: return binary(l, x);
    case GLSL_NOT:
    case GLSL_LESS:
    case GLSL_GREATER:
    case GLSL_LESS_EQUAL:
    case GLSL_GREATER_EQUAL:
    case GLSL_AND:
    case GLSL_XOR:
    case GLSL_OR: return glsl_lower_logical(l, x);
    case GLSL_EQUAL:
    case GLSL_NOT_EQUAL: return glsl_lower_equal(l, x);
    case GLSL_SELECT: return glsl_lower_select(l, x);
    case GLSL_ASSIGN: return assign(l, x);
    case GLSL_SEQUENCE:
        glsl_lower_expression(l, x->operand[0]);
        return glsl_lower_expression(l, x->operand[1]);
    }
    return glsl_value_temporary(l, x->type);
}

struct glsl_value glsl_lower_expression(struct glsl_lowering *l, const struct glsl_expression *x)
{
    if (x->value)
        return glsl_value_constant(x->type, x->value);
    if (++l->depth > GLSL_MOST_DEPTH)
        glsl_code_fail(&l->code, "an expression of more than 1000 levels");
    struct glsl_value value = l->code.failure ? glsl_value_temporary(l, x->type) : lower(l, x);
    l->depth--;
    return value;
}
