/* Products with matrices (5.10): a column is a register. */
#include "front/glsl/lower/lower.h"

/* matrix * vector: column 0 * v.x + column 1 * v.y + ..., with fused steps in this order. */
static struct glsl_operand transform(struct glsl_lowering *l, const struct glsl_value *matrix,
                                     struct glsl_operand vector)
{
    unsigned rows = matrix->type.rows;
    struct glsl_operand sum = glsl_emit_2(&l->code, GLSL_OP_MUL, rows, glsl_value_part(l, matrix, 0),
                                          glsl_operand_scalar(vector, 0));
    for (unsigned i = 1; i < matrix->type.columns; i++)
        sum = glsl_emit_3(&l->code, GLSL_OP_MAD, rows, glsl_value_part(l, matrix, i),
                          glsl_operand_scalar(vector, i), sum);
    return sum;
}

/* vector * matrix: a dot product for each column. */
static struct glsl_value transform_row(struct glsl_lowering *l, const struct glsl_value *vector,
                                       const struct glsl_value *matrix, struct glsl_type type)
{
    struct glsl_value result = glsl_value_temporary(l, type);
    struct glsl_operand row = glsl_value_part(l, vector, 0);
    for (unsigned i = 0; i < type.rows; i++) {
        struct glsl_operand dot = glsl_emit_dot(&l->code, type.rows, row, glsl_value_part(l, matrix, i));
        glsl_emit_store(&l->code, result.at, 1u << i, dot);
    }
    return result;
}

struct glsl_value glsl_lower_product(struct glsl_lowering *l, const struct glsl_value *a,
                                     const struct glsl_value *b, struct glsl_type type)
{
    if (a->type.columns == 1)
        return transform_row(l, a, b, type);
    if (b->type.columns == 1)
        return glsl_value_of(type, transform(l, a, glsl_value_part(l, b, 0)));
    struct glsl_value result = glsl_value_temporary(l, type);
    for (unsigned i = 0; i < type.columns; i++) {
        struct glsl_operand to = result.at;
        to.number += i;
        glsl_emit_store(&l->code, to, glsl_mask(type.rows), transform(l, a, glsl_value_part(l, b, i)));
    }
    return result;
}
