/* Expressions: operators, fields, elements, assignments (chapter 5). */
#include "front/glsl/check/builtin.h"
#include "front/glsl/check/fold.h"

#include <string.h>

struct glsl_expression *glsl_node_expression(struct glsl_context *context, enum glsl_operator operation,
                                             struct glsl_type type, struct glsl_place place)
{
    struct glsl_expression *x = GLSL_NEW(&context->arena, struct glsl_expression);
    x->operation = (uint8_t)operation;
    x->type = type;
    x->place = place;
    return x;
}

struct glsl_expression *glsl_node_failed(struct glsl_context *context, struct glsl_place place)
{
    return glsl_node_expression(context, GLSL_VALUE, glsl_error_type(), place);
}

static const char *type_name(struct glsl_context *context, const struct glsl_expression *x)
{
    return glsl_type_name(&context->arena, x->type);
}

struct glsl_expression *glsl_node_literal(struct glsl_context *context, struct glsl_place place,
                                          enum glsl_base base, union glsl_scalar value)
{
    struct glsl_expression *x = glsl_node_expression(context, GLSL_VALUE, glsl_type_of(base, 1, 1), place);
    union glsl_scalar *copy = GLSL_NEW(&context->arena, union glsl_scalar);
    *copy = value;
    x->value = copy;
    return x;
}

struct glsl_expression *glsl_node_name(struct glsl_context *context, struct glsl_place place,
                                       const char *name)
{
    const struct glsl_symbol *symbol = glsl_symbol_find(context, name);
    if (!symbol || symbol->kind != GLSL_VARIABLE_SYMBOL) {
        glsl_error(context, place, "found '%s', which is %s, expected a variable", name,
                   symbol ? "a function" : "not declared");
        return glsl_node_failed(context, place);
    }
    struct glsl_variable *variable = symbol->variable;
    struct glsl_expression *x = glsl_node_expression(context, GLSL_READ, variable->type, place);
    x->variable = variable;
    x->value = variable->value;
    variable->read = true;
    if (variable->storage >= GLSL_BUILTIN_IN)
        glsl_builtin_use(context, x);
    else if (variable->storage == GLSL_CONSTANT_STORAGE)
        glsl_builtin_use_constant(context, x);
    return x;
}

/* --- Elements and fields -------------------------------------------------------------------------------- */

/* The number of elements that an index selects from. */
static int elements_of(struct glsl_type type)
{
    return type.array ? type.array : type.columns > 1 ? type.columns : type.rows;
}

static bool is_one_int(const struct glsl_expression *x)
{
    return glsl_is_scalar(x->type) && x->type.base == GLSL_INT;
}

struct glsl_expression *glsl_node_index(struct glsl_context *context, struct glsl_place place,
                                        struct glsl_expression *array, struct glsl_expression *index)
{
    if (glsl_has_failed(array) || glsl_has_failed(index))
        return glsl_node_failed(context, place);
    int count = elements_of(array->type);
    if (!array->type.array && (!glsl_is_numeric(array->type) || count < 2))
        glsl_error(context, place, "found an index of %s, expected an array, a vector or a matrix",
                   type_name(context, array));
    else if (!is_one_int(index))
        glsl_error(context, index->place, "found an index of type %s, expected int",
                   type_name(context, index));
    else if (index->value && (index->value->i < 0 || index->value->i >= count))
        glsl_error(context, index->place, "found the index %d, expected 0 to %d", index->value->i, count - 1);
    else {
        struct glsl_expression *x =
            glsl_node_expression(context, GLSL_INDEX, glsl_element_type(array->type), array->place);
        x->operand[0] = array;
        x->operand[1] = index;
        return glsl_fold(context, x);
    }
    return glsl_node_failed(context, place);
}

static struct glsl_expression *select_member(struct glsl_context *context, struct glsl_place place,
                                             struct glsl_expression *of, const char *name)
{
    const struct glsl_record *record = of->type.record;
    for (unsigned i = 0; i < record->count; i++)
        if (!strcmp(record->field[i].name, name)) {
            struct glsl_expression *x =
                glsl_node_expression(context, GLSL_FIELD, record->field[i].type, of->place);
            x->operand[0] = of;
            x->index = (uint16_t)i;
            return glsl_fold(context, x);
        }
    glsl_error(context, place, "found '%s', expected a field of %s", name, type_name(context, of));
    return glsl_node_failed(context, place);
}

/* The component that a letter names in one of the three sets; -1: none. */
static int component_of(char letter, const char *set)
{
    const char *found = letter ? strchr(set, letter) : NULL;
    return found ? (int)(found - set) : -1;
}

static struct glsl_expression *select_components(struct glsl_context *context, struct glsl_place place,
                                                 struct glsl_expression *of, const char *name)
{
    static const char *const sets[] = {"xyzw", "rgba", "stpq"};
    size_t length = strlen(name);
    struct glsl_type type = of->type;
    struct glsl_expression *x = glsl_node_expression(context, GLSL_SWIZZLE, type, of->place);
    bool good = false;
    for (unsigned s = 0; s < 3 && !good && length <= 4; s++) {
        good = true;
        for (size_t i = 0; i < length; i++) {
            int component = component_of(name[i], sets[s]);
            good &= component >= 0 && component < type.rows;
            x->swizzle[i] = (uint8_t)component;
        }
    }
    if (!good) {
        glsl_error(context, place,
                   "found '.%s', expected 1 to 4 components of %s by letters of one set: xyzw, rgba, stpq",
                   name, type_name(context, of));
        return glsl_node_failed(context, place);
    }
    x->type.rows = (uint8_t)length;
    x->operand[0] = of;
    return glsl_fold(context, x);
}

struct glsl_expression *glsl_node_field(struct glsl_context *context, struct glsl_place place,
                                        struct glsl_expression *of, const char *name)
{
    if (glsl_has_failed(of))
        return of;
    if (of->type.base == GLSL_STRUCT && !of->type.array)
        return select_member(context, place, of, name);
    if (glsl_is_vector(of->type))
        return select_components(context, place, of, name);
    glsl_error(context, place, "found '.%s' after %s, expected a structure or a vector", name,
               type_name(context, of));
    return glsl_node_failed(context, place);
}

/* --- Writing -------------------------------------------------------------------------------------------- */

static const char *reason_not_to_write(const struct glsl_context *context,
                                       const struct glsl_variable *variable)
{
    switch ((enum glsl_storage)variable->storage) {
    case GLSL_CONSTANT_STORAGE:
    case GLSL_CONST_IN: return "is a constant";
    case GLSL_ATTRIBUTE: return "is an attribute";
    case GLSL_UNIFORM: return "is a uniform";
    case GLSL_VARYING: return context->stage == GLSL_FRAGMENT ? "is a varying of a fragment shader" : NULL;
    case GLSL_BUILTIN_IN: return "can only be read";
    case GLSL_LOCAL:
    case GLSL_IN:
    case GLSL_OUT:
    case GLSL_INOUT:
    case GLSL_BUILTIN_OUT: break;
    }
    return glsl_has_sampler(variable->type) ? "contains a sampler" : NULL;
}

static bool swizzle_repeats(const struct glsl_expression *x)
{
    unsigned seen = 0;
    for (unsigned i = 0; i < x->type.rows; i++) {
        if (seen >> x->swizzle[i] & 1)
            return true;
        seen |= 1u << x->swizzle[i];
    }
    return false;
}

bool glsl_check_writable(struct glsl_context *context, struct glsl_expression *x)
{
    switch ((enum glsl_operator)x->operation) {
    case GLSL_SWIZZLE:
        if (swizzle_repeats(x)) {
            glsl_error(context, x->place, "found a component twice in what is written, expected each once");
            return false;
        }
        return glsl_check_writable(context, x->operand[0]);
    case GLSL_FIELD:
    case GLSL_INDEX: return glsl_check_writable(context, x->operand[0]);
    case GLSL_READ: break;
    default:
        glsl_error(context, x->place,
                   "found an expression that cannot be written, expected a variable or a part of one");
        return false;
    }
    const char *reason = reason_not_to_write(context, x->variable);
    if (reason)
        glsl_error(context, x->place, "found '%s', which %s, expected a variable that can be written",
                   x->variable->name, reason);
    x->variable->written |= !reason;
    return !reason;
}

/* --- Operators ------------------------------------------------------------------------------------------ */

static const char *const spelling[] = {
    [GLSL_NEGATE] = "-",
    [GLSL_NOT] = "!",
    [GLSL_INCREMENT] = "++",
    [GLSL_DECREMENT] = "--",
    [GLSL_INCREMENT_AFTER] = "++",
    [GLSL_DECREMENT_AFTER] = "--",
    [GLSL_ADD] = "+",
    [GLSL_SUBTRACT] = "-",
    [GLSL_MULTIPLY] = "*",
    [GLSL_DIVIDE] = "/",
    [GLSL_LESS] = "<",
    [GLSL_GREATER] = ">",
    [GLSL_LESS_EQUAL] = "<=",
    [GLSL_GREATER_EQUAL] = ">=",
    [GLSL_EQUAL] = "==",
    [GLSL_NOT_EQUAL] = "!=",
    [GLSL_AND] = "&&",
    [GLSL_XOR] = "^^",
    [GLSL_OR] = "||",
};

static bool is_arithmetic(const struct glsl_expression *x)
{
    return (x->type.base == GLSL_FLOAT || x->type.base == GLSL_INT) && !x->type.array;
}

static bool is_condition(const struct glsl_expression *x)
{
    return x->type.base == GLSL_BOOL && glsl_is_scalar(x->type);
}

struct glsl_expression *glsl_node_unary(struct glsl_context *context, struct glsl_place place,
                                        enum glsl_operator operation, struct glsl_expression *x)
{
    bool changes = operation >= GLSL_INCREMENT && operation <= GLSL_DECREMENT_AFTER;
    if (glsl_has_failed(x))
        return x;
    if (operation == GLSL_NOT ? !is_condition(x) : !is_arithmetic(x)) {
        glsl_error(context, place, "found '%s' with %s, expected %s", spelling[operation],
                   type_name(context, x),
                   operation == GLSL_NOT ? "bool" : "float, int, a vector or a matrix of them");
        return glsl_node_failed(context, place);
    }
    if (changes && !glsl_check_writable(context, x))
        return glsl_node_failed(context, place);
    if (operation == GLSL_ADD)
        return x;
    struct glsl_expression *result = glsl_node_expression(context, operation, x->type, place);
    result->operand[0] = x;
    result->impure = changes;
    return changes ? result : glsl_fold(context, result);
}

static struct glsl_expression *no_operator(struct glsl_context *context, struct glsl_place place,
                                           unsigned operation, const struct glsl_expression *a,
                                           const struct glsl_expression *b)
{
    glsl_error(context, place, "found %s %s %s, which is not defined", type_name(context, a),
               spelling[operation], type_name(context, b));
    return glsl_node_failed(context, place);
}

/* The type of a product with at least one matrix; an error type if there is none. */
static struct glsl_type product_type(struct glsl_type a, struct glsl_type b)
{
    if (glsl_is_scalar(a) || glsl_is_scalar(b))
        return glsl_is_scalar(a) ? b : a;
    if (a.columns > 1 && b.columns > 1)
        return a.columns == b.columns ? a : glsl_error_type();
    if (a.columns > 1)
        return a.columns == b.rows ? b : glsl_error_type();
    return a.rows == b.columns ? a : glsl_error_type();
}

/* The type of a sum, difference, product or quotient. */
static struct glsl_type arithmetic_type(unsigned operation, struct glsl_type a, struct glsl_type b)
{
    if (a.base != b.base)
        return glsl_error_type();
    if (operation == GLSL_MULTIPLY && (a.columns > 1 || b.columns > 1))
        return product_type(a, b);
    if (glsl_is_scalar(a) || glsl_is_scalar(b))
        return glsl_is_scalar(a) ? b : a;
    return a.rows == b.rows && a.columns == b.columns ? a : glsl_error_type();
}

static struct glsl_type higher_precision(struct glsl_type type, struct glsl_type a, struct glsl_type b)
{
    type.precision = a.precision > b.precision ? a.precision : b.precision;
    return type;
}

/* The type of a comparison or logical operation; an error type if it is not defined. */
static struct glsl_type bool_type(unsigned operation, const struct glsl_expression *a,
                                  const struct glsl_expression *b)
{
    bool same = glsl_same_type(a->type, b->type), good;
    if (operation >= GLSL_AND)
        good = is_condition(a) && is_condition(b);
    else if (operation >= GLSL_EQUAL)
        good = same && !glsl_has_array(a->type) && !glsl_has_sampler(a->type) && a->type.base != GLSL_VOID;
    else
        good = same && is_arithmetic(a) && glsl_is_scalar(a->type);
    return good ? glsl_type_of(GLSL_BOOL, 1, 1) : glsl_error_type();
}

struct glsl_expression *glsl_node_binary(struct glsl_context *context, struct glsl_place place,
                                         enum glsl_operator operation, struct glsl_expression *a,
                                         struct glsl_expression *b)
{
    struct glsl_type type = glsl_error_type();
    if (glsl_has_failed(a) || glsl_has_failed(b))
        return glsl_node_failed(context, place);
    if (operation >= GLSL_LESS)
        type = bool_type(operation, a, b);
    else if (is_arithmetic(a) && is_arithmetic(b))
        type = arithmetic_type(operation, a->type, b->type);
    if (type.base == GLSL_ERROR)
        return no_operator(context, place, operation, a, b);
    struct glsl_expression *x =
        glsl_node_expression(context, operation, higher_precision(type, a->type, b->type), place);
    x->operand[0] = a;
    x->operand[1] = b;
    return glsl_fold(context, x);
}

struct glsl_expression *glsl_node_choose(struct glsl_context *context, struct glsl_place place,
                                         struct glsl_expression *condition, struct glsl_expression *a,
                                         struct glsl_expression *b)
{
    if (glsl_has_failed(condition) || glsl_has_failed(a) || glsl_has_failed(b))
        return glsl_node_failed(context, place);
    if (!is_condition(condition))
        glsl_error(context, condition->place, "found %s before '?', expected bool",
                   type_name(context, condition));
    else if (!glsl_same_type(a->type, b->type))
        glsl_error(context, place, "found %s and %s around ':', expected the same type",
                   type_name(context, a), type_name(context, b));
    else if (glsl_has_array(a->type) || glsl_has_sampler(a->type))
        glsl_error(context, place, "found %s after '?', which cannot be selected", type_name(context, a));
    else {
        struct glsl_expression *x =
            glsl_node_expression(context, GLSL_SELECT, higher_precision(a->type, a->type, b->type), place);
        x->operand[0] = condition;
        x->operand[1] = a;
        x->operand[2] = b;
        return glsl_fold(context, x);
    }
    return glsl_node_failed(context, place);
}

struct glsl_expression *glsl_node_assign(struct glsl_context *context, struct glsl_place place,
                                         uint8_t update, struct glsl_expression *to,
                                         struct glsl_expression *value)
{
    struct glsl_type type = value->type;
    if (glsl_has_failed(to) || glsl_has_failed(value) || !glsl_check_writable(context, to))
        return glsl_node_failed(context, place);
    if (update && (!is_arithmetic(to) || !is_arithmetic(value)))
        return no_operator(context, place, update, to, value);
    if (update)
        type = arithmetic_type(update, to->type, value->type);
    if (!glsl_same_type(to->type, type))
        glsl_error(context, place, "found an assignment of %s to %s, expected the same type",
                   type_name(context, value), type_name(context, to));
    else if (glsl_has_array(to->type))
        glsl_error(context, place, "found an assignment of %s, but arrays cannot be assigned",
                   type_name(context, to));
    else {
        struct glsl_expression *x = glsl_node_expression(context, GLSL_ASSIGN, to->type, place);
        x->update = update;
        x->impure = true;
        x->operand[0] = to;
        x->operand[1] = value;
        return x;
    }
    return glsl_node_failed(context, place);
}

struct glsl_expression *glsl_node_sequence(struct glsl_context *context, struct glsl_place place,
                                           struct glsl_expression *a, struct glsl_expression *b)
{
    struct glsl_expression *x = glsl_node_expression(context, GLSL_SEQUENCE, b->type, place);
    x->operand[0] = a;
    x->operand[1] = b;
    x->impure = a->impure || b->impure;
    x->value = a->value ? b->value : NULL;
    return glsl_has_failed(a) ? a : x;
}

int glsl_check_array_size(struct glsl_context *context, struct glsl_place place,
                          const struct glsl_expression *size)
{
    enum { MOST = 65536 };
    if (!size)
        glsl_error(context, place, "found an array without a size, expected a constant");
    else if (glsl_has_failed(size))
        return 1;
    else if (!is_one_int(size) || !size->value)
        glsl_error(context, size->place, "found a size that is not a constant of type int");
    else if (size->value->i < 1 || size->value->i > MOST)
        glsl_error(context, size->place, "found the size %d, expected 1 to %d", size->value->i, MOST);
    else
        return size->value->i;
    return 1;
}
