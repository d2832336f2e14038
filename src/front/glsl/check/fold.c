#include "front/glsl/check/fold.h"

#include <string.h>

/* Arithmetic of int wraps; a division by 0, which the language leaves open, is 0. */
static union glsl_scalar whole_arithmetic(unsigned operation, int32_t a, int32_t b)
{
    uint32_t x = (uint32_t)a, y = (uint32_t)b;
    union glsl_scalar r = {.i = 0};
    switch (operation) {
    case GLSL_ADD: r.i = (int32_t)(x + y); break;
    case GLSL_SUBTRACT: r.i = (int32_t)(x - y); break;
    case GLSL_MULTIPLY: r.i = (int32_t)(x * y); break;
    case GLSL_DIVIDE: r.i = b == 0 ? 0 : b == -1 ? (int32_t)-x : a / b; break;
    }
    return r;
}

static union glsl_scalar real_arithmetic(unsigned operation, float a, float b)
{
    union glsl_scalar r = {.f = 0};
    switch (operation) {
    case GLSL_ADD: r.f = a + b; break;
    case GLSL_SUBTRACT: r.f = a - b; break;
    case GLSL_MULTIPLY: r.f = a * b; break;
    case GLSL_DIVIDE: r.f = a / b; break;
    }
    return r;
}

static union glsl_scalar arithmetic(const struct glsl_expression *x, union glsl_scalar a, union glsl_scalar b)
{
    return x->type.base == GLSL_INT ? whole_arithmetic(x->operation, a.i, b.i)
                                    : real_arithmetic(x->operation, a.f, b.f);
}

/* --- Products of matrices: column by column ------------------------------------------------------------- */

/* Row r of matrix a times column c of b; a vector is a matrix of one column, or of one row on the left. */
static float dot_of(const struct glsl_expression *a, const struct glsl_expression *b, unsigned r, unsigned c)
{
    bool row_vector = a->type.columns == 1;
    unsigned inner = row_vector ? a->type.rows : a->type.columns;
    float sum = 0;
    for (unsigned k = 0; k < inner; k++)
        sum += a->value[row_vector ? k : k * a->type.rows + r].f * b->value[c * b->type.rows + k].f;
    return sum;
}

static void multiply_matrices(const struct glsl_expression *x, union glsl_scalar *value)
{
    const struct glsl_expression *a = x->operand[0], *b = x->operand[1];
    bool row_vector = a->type.columns == 1;
    unsigned rows = row_vector ? 1 : a->type.rows, columns = row_vector ? b->type.columns : b->type.columns;
    for (unsigned c = 0; c < columns; c++)
        for (unsigned r = 0; r < rows; r++)
            value[c * rows + r].f = dot_of(a, b, r, c);
}

static bool is_matrix_product(const struct glsl_expression *x)
{
    const struct glsl_expression *a = x->operand[0], *b = x->operand[1];
    return x->operation == GLSL_MULTIPLY && (a->type.columns > 1 || b->type.columns > 1) &&
           !glsl_is_scalar(a->type) && !glsl_is_scalar(b->type);
}

static void fold_arithmetic(const struct glsl_expression *x, union glsl_scalar *value)
{
    const struct glsl_expression *a = x->operand[0], *b = x->operand[1];
    if (is_matrix_product(x)) {
        multiply_matrices(x, value);
        return;
    }
    unsigned a_step = !glsl_is_scalar(a->type), b_step = !glsl_is_scalar(b->type);
    for (unsigned i = 0; i < glsl_scalars(x->type); i++)
        value[i] = arithmetic(x, a->value[i * a_step], b->value[i * b_step]);
}

/* --- Comparisons ---------------------------------------------------------------------------------------- */

static int compare(const struct glsl_expression *a, const struct glsl_expression *b)
{
    if (a->type.base == GLSL_FLOAT)
        return a->value->f < b->value->f ? -1 : a->value->f > b->value->f;
    return a->value->i < b->value->i ? -1 : a->value->i > b->value->i;
}

/* Scalar `at` and those after it, of a type; advances `at`. */
static bool equal_scalars(struct glsl_type type, const union glsl_scalar *a, const union glsl_scalar *b,
                          unsigned *at)
{
    bool equal = true;
    if (type.base == GLSL_STRUCT)
        for (unsigned i = 0; i < type.record->count; i++)
            equal &= equal_scalars(type.record->field[i].type, a, b, at);
    else
        for (unsigned i = 0; i < glsl_scalars(type); i++, ++*at)
            equal &= type.base == GLSL_FLOAT ? a[*at].f == b[*at].f : a[*at].i == b[*at].i;
    return equal;
}

static int32_t compared(const struct glsl_expression *x)
{
    const struct glsl_expression *a = x->operand[0], *b = x->operand[1];
    unsigned at = 0;
    switch ((enum glsl_operator)x->operation) {
    case GLSL_LESS: return compare(a, b) < 0;
    case GLSL_GREATER: return compare(a, b) > 0;
    case GLSL_LESS_EQUAL: return compare(a, b) <= 0;
    case GLSL_GREATER_EQUAL: return compare(a, b) >= 0;
    case GLSL_EQUAL: return equal_scalars(a->type, a->value, b->value, &at);
    case GLSL_NOT_EQUAL: return !equal_scalars(a->type, a->value, b->value, &at);
    case GLSL_AND: return a->value->i && b->value->i;
    case GLSL_OR: return a->value->i || b->value->i;
    default: return a->value->i != b->value->i; /* GLSL_XOR */
    }
}

/* --- Parts ---------------------------------------------------------------------------------------------- */

static void fold_unary(const struct glsl_expression *x, union glsl_scalar *value)
{
    const union glsl_scalar *from = x->operand[0]->value;
    for (unsigned i = 0; i < glsl_scalars(x->type); i++)
        if (x->operation == GLSL_NOT)
            value[i].i = !from[i].i;
        else if (x->type.base == GLSL_INT)
            value[i].i = (int32_t) - (uint32_t)from[i].i;
        else
            value[i].f = -from[i].f;
}

static unsigned offset_of_field(const struct glsl_record *record, unsigned field)
{
    unsigned offset = 0;
    for (unsigned i = 0; i < field; i++)
        offset += glsl_scalars(record->field[i].type);
    return offset;
}

static void fold_part(const struct glsl_expression *x, union glsl_scalar *value)
{
    const struct glsl_expression *of = x->operand[0];
    unsigned count = glsl_scalars(x->type), offset = 0;
    if (x->operation == GLSL_SWIZZLE) {
        for (unsigned i = 0; i < count; i++)
            value[i] = of->value[x->swizzle[i]];
        return;
    }
    if (x->operation == GLSL_FIELD)
        offset = offset_of_field(of->type.record, x->index);
    else
        offset = count * (unsigned)x->operand[1]->value->i;
    memcpy(value, of->value + offset, count * sizeof *value);
}

/* --- Constructors (5.4) --------------------------------------------------------------------------------- */

static union glsl_scalar converted(union glsl_scalar from, unsigned base, unsigned to)
{
    union glsl_scalar r = from;
    if (base == to)
        return r;
    if (to == GLSL_FLOAT)
        r.f = (float)from.i;
    else if (to == GLSL_BOOL)
        r.i = base == GLSL_FLOAT ? from.f != 0 : from.i != 0;
    else if (base == GLSL_FLOAT)
        r.i = from.f >= 2147483648.0f ? INT32_MAX : from.f > -2147483904.0f ? (int32_t)from.f : INT32_MIN;
    return r;
}

/* A matrix of one scalar is diagonal; of another matrix it has the common elements, else those of
 * identity. */
static void construct_matrix(const struct glsl_expression *x, union glsl_scalar *value)
{
    const struct glsl_expression *from = x->argument;
    unsigned size = x->type.rows;
    for (unsigned c = 0; c < size; c++)
        for (unsigned r = 0; r < size; r++)
            if (glsl_is_matrix(from->type) && c < from->type.columns && r < from->type.rows)
                value[c * size + r] = from->value[c * from->type.rows + r];
            else if (glsl_is_matrix(from->type))
                value[c * size + r].f = c == r;
            else
                value[c * size + r].f = c == r ? converted(*from->value, from->type.base, GLSL_FLOAT).f : 0;
}

static void fold_construct(const struct glsl_expression *x, union glsl_scalar *value)
{
    unsigned count = glsl_scalars(x->type), at = 0;
    const struct glsl_expression *from = x->argument;
    if (x->type.columns > 1 && !from->next && (glsl_is_scalar(from->type) || glsl_is_matrix(from->type))) {
        construct_matrix(x, value);
        return;
    }
    bool repeat = !from->next && glsl_is_scalar(from->type) && x->type.base != GLSL_STRUCT;
    for (; from && at < count; from = from->next)
        for (unsigned i = 0; i < glsl_scalars(from->type) && at < count; i++)
            value[at++] = x->type.base == GLSL_STRUCT
                              ? from->value[i]
                              : converted(from->value[i], from->type.base, x->type.base);
    for (; repeat && at < count; at++)
        value[at] = value[0];
}

/* --- All ------------------------------------------------------------------------------------------------ */

static bool has_constant_parts(const struct glsl_expression *x)
{
    for (int i = 0; i < 3; i++)
        if (x->operand[i] && !x->operand[i]->value)
            return false;
    for (const struct glsl_expression *a = x->argument; a; a = a->next)
        if (!a->value)
            return false;
    return x->operand[0] || x->argument;
}

static bool compute(const struct glsl_expression *x, union glsl_scalar *value)
{
    switch ((enum glsl_operator)x->operation) {
    case GLSL_FIELD:
    case GLSL_INDEX:
    case GLSL_SWIZZLE: fold_part(x, value); return true;
    case GLSL_CONSTRUCT: fold_construct(x, value); return true;
    case GLSL_NEGATE:
    case GLSL_NOT: fold_unary(x, value); return true;
    case GLSL_ADD:
    case GLSL_SUBTRACT:
    case GLSL_MULTIPLY:
    case GLSL_DIVIDE: fold_arithmetic(x, value); return true;
    case GLSL_SELECT:
        memcpy(value, x->operand[x->operand[0]->value->i ? 1 : 2]->value,
               glsl_scalars(x->type) * sizeof *value);
        return true;
    case GLSL_CALL_BUILTIN: return glsl_fold_call(x, value);
    default: break;
    }
    if (x->operation < GLSL_LESS || x->operation > GLSL_OR)
        return false;
    value->i = compared(x);
    return true;
}

static bool has_impure_part(const struct glsl_expression *x)
{
    for (int i = 0; i < 3; i++)
        if (x->operand[i] && x->operand[i]->impure)
            return true;
    for (const struct glsl_expression *a = x->argument; a; a = a->next)
        if (a->impure)
            return true;
    return false;
}

struct glsl_expression *glsl_fold(struct glsl_context *context, struct glsl_expression *x)
{
    x->impure = has_impure_part(x);
    if (!has_constant_parts(x))
        return x;
    union glsl_scalar *value = glsl_take(&context->arena, (glsl_scalars(x->type) + 1) * sizeof *value);
    if (compute(x, value))
        x->value = value;
    return x;
}
