/* Constructors (5.4). */
#include "front/glsl/lower/lower.h"

/* A register of another base type. */
static struct glsl_operand converted(struct glsl_lowering *l, struct glsl_operand x, unsigned rows,
                                     unsigned from, unsigned to)
{
    if (to == GLSL_INT && from == GLSL_FLOAT)
        return glsl_emit_1(&l->code, GLSL_OP_TRUNC, rows, x);
    if (to == GLSL_BOOL && from != GLSL_BOOL)
        return glsl_emit_2(&l->code, GLSL_OP_SNE, rows, x, glsl_operand_literal(&l->code, 0));
    return x;
}

/* Writes scalars to the components of consecutive registers of `rows` components, in their order. */
struct filler {
    struct glsl_value to;
    unsigned rows, at, count; /* at: of count scalars */
};

static struct glsl_operand shifted(struct glsl_operand x, unsigned from, unsigned to, unsigned count)
{
    unsigned swizzle = 0;
    for (unsigned c = 0; c < 4; c++) {
        unsigned i = c < to ? 0 : c - to;
        swizzle |= (from + (i < count ? i : count - 1)) << 2 * c;
    }
    return glsl_operand_swizzled(x, (uint8_t)swizzle);
}

/* Adds `rows` components of a register, without those for which there is no room. */
static void fill(struct glsl_lowering *l, struct filler *filler, struct glsl_operand from, unsigned rows)
{
    for (unsigned used = 0; used < rows && filler->at < filler->count && !l->code.failure;) {
        struct glsl_operand to = filler->to.at;
        unsigned component = filler->at % filler->rows, room = filler->rows - component;
        unsigned count = rows - used < room ? rows - used : room;
        to.number += filler->at / filler->rows;
        glsl_emit_store(&l->code, to, glsl_mask(count) << component, shifted(from, used, component, count));
        used += count;
        filler->at += count;
    }
}

/* A scalar of a constant converts when the program is made. */
static struct glsl_operand argument_part(struct glsl_lowering *l, const struct glsl_value *value, unsigned i,
                                         unsigned base)
{
    unsigned rows = glsl_value_rows(value->type, i);
    return converted(l, glsl_value_part(l, value, i), rows, value->type.base, base);
}

static struct glsl_value construct_diagonal(struct glsl_lowering *l, struct glsl_type type,
                                            struct glsl_operand scalar)
{
    struct glsl_value result = glsl_value_temporary(l, type);
    for (unsigned i = 0; i < type.columns; i++) {
        struct glsl_operand to = result.at;
        to.number += i;
        glsl_emit_store(&l->code, to, 1u << i, scalar);
        glsl_emit_store(&l->code, to, glsl_mask(type.rows) & ~(1u << i), glsl_operand_literal(&l->code, 0));
    }
    return result;
}

/* The common elements, and those of the identity. */
static struct glsl_value construct_resized(struct glsl_lowering *l, struct glsl_type type,
                                           const struct glsl_value *from)
{
    struct glsl_value result = glsl_value_temporary(l, type);
    for (unsigned i = 0; i < type.columns; i++) {
        struct glsl_operand to = result.at;
        unsigned common = i < from->type.columns ? from->type.rows : 0;
        unsigned mask = glsl_mask(type.rows) & glsl_mask(common), rest = glsl_mask(type.rows) & ~mask;
        float identity[4] = {0};
        identity[i] = 1;
        to.number += i;
        if (mask)
            glsl_emit_store(&l->code, to, mask, glsl_value_part(l, from, i));
        if (rest)
            glsl_emit_store(&l->code, to, rest, glsl_operand_literals(&l->code, identity, type.rows));
    }
    return result;
}

/* One argument that is enough for all components. */
static struct glsl_value construct_of_one(struct glsl_lowering *l, struct glsl_type type,
                                          const struct glsl_value *from)
{
    if (type.columns > 1 && glsl_is_matrix(from->type))
        return construct_resized(l, type, from);
    struct glsl_operand part = argument_part(l, from, 0, type.base);
    if (type.columns > 1)
        return construct_diagonal(l, type, part);
    return glsl_value_of(type, type.rows == 1 ? glsl_operand_scalar(part, 0) : part);
}

static bool is_of_one(const struct glsl_expression *x)
{
    const struct glsl_expression *from = x->argument;
    if (from->next)
        return false;
    if (x->type.columns > 1)
        return glsl_is_scalar(from->type) || glsl_is_matrix(from->type);
    return from->type.columns == 1 && (glsl_is_scalar(from->type) || from->type.rows >= x->type.rows);
}

/* Each argument is copied before the next one is evaluated. */
static struct glsl_value construct_of_many(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct filler filler = {glsl_value_temporary(l, x->type), x->type.rows, 0, glsl_scalars(x->type)};
    for (const struct glsl_expression *a = x->argument; a && filler.at < filler.count; a = a->next) {
        struct glsl_value value = glsl_lower_expression(l, a);
        for (unsigned i = 0; i < glsl_registers(a->type) && filler.at < filler.count; i++)
            fill(l, &filler, argument_part(l, &value, i, x->type.base), a->type.rows);
    }
    return filler.to;
}

static struct glsl_value construct_record(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_value result = glsl_value_temporary(l, x->type);
    uint32_t at = 0;
    for (const struct glsl_expression *a = x->argument; a; a = a->next) {
        struct glsl_value value = glsl_lower_expression(l, a);
        struct glsl_value field = result;
        field.type = a->type;
        field.at.number += at;
        glsl_value_copy(l, &field, &value);
        at += glsl_registers(a->type);
    }
    return result;
}

struct glsl_value glsl_lower_construct(struct glsl_lowering *l, const struct glsl_expression *x)
{
    if (x->type.base == GLSL_STRUCT)
        return construct_record(l, x);
    if (!is_of_one(x))
        return construct_of_many(l, x);
    struct glsl_value value = glsl_lower_expression(l, x->argument);
    return construct_of_one(l, x->type, &value);
}
