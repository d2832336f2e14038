/* Calls and constructors (5.4, 5.9, 6.1). */
#include "front/glsl/check/builtin.h"
#include "front/glsl/check/fold.h"

#include <string.h>

void glsl_node_add_expression(struct glsl_expressions *list, struct glsl_expression *x)
{
    if (list->last)
        list->last->next = x;
    else
        list->first = x;
    list->last = x;
    list->count++;
}

/* "(float, vec3)" */
static const char *types_of(struct glsl_context *context, const struct glsl_expressions *arguments)
{
    const char *text = "";
    for (const struct glsl_expression *x = arguments->first; x; x = x->next)
        text = glsl_format(&context->arena, "%s%s%s", text, x == arguments->first ? "" : ", ",
                           glsl_type_name(&context->arena, x->type));
    return glsl_format(&context->arena, "(%s)", text);
}

static bool any_failed(const struct glsl_expressions *arguments)
{
    for (const struct glsl_expression *x = arguments->first; x; x = x->next)
        if (glsl_has_failed(x))
            return true;
    return false;
}

/* --- Functions ------------------------------------------------------------------------------------------ */

static bool fits(const struct glsl_function *function, const struct glsl_expressions *arguments)
{
    const struct glsl_variable *p = function->parameter;
    const struct glsl_expression *x = arguments->first;
    for (; p && x; p = p->next, x = x->next)
        if (!glsl_same_type(p->type, x->type))
            return false;
    return !p && !x;
}

static struct glsl_function *find(const struct glsl_symbol *symbol, const struct glsl_expressions *arguments)
{
    struct glsl_function *function = symbol && symbol->kind == GLSL_FUNCTION_SYMBOL ? symbol->function : NULL;
    while (function && !fits(function, arguments))
        function = function->overload;
    return function;
}

static void note_call(struct glsl_context *context, struct glsl_function *function, struct glsl_place place)
{
    struct glsl_callee *callee = GLSL_NEW(&context->arena, struct glsl_callee);
    if (!context->function)
        return;
    *callee = (struct glsl_callee){function, place, context->function->callee};
    context->function->callee = callee;
}

static struct glsl_expression *call_function(struct glsl_context *context, struct glsl_place place,
                                             struct glsl_function *function,
                                             const struct glsl_expressions *arguments)
{
    struct glsl_expression *x = glsl_node_expression(context, GLSL_CALL, function->type, place);
    const struct glsl_variable *p = function->parameter;
    x->function = function;
    x->impure = true;
    x->argument = arguments->first;
    note_call(context, function, place);
    for (struct glsl_expression *a = arguments->first; a; a = a->next, p = p->next)
        if ((p->storage == GLSL_OUT || p->storage == GLSL_INOUT) && !glsl_check_writable(context, a))
            return glsl_node_failed(context, place);
    return x;
}

static struct glsl_expression *call_builtin(struct glsl_context *context, struct glsl_place place,
                                            enum glsl_meaning meaning, struct glsl_type result,
                                            const struct glsl_expressions *arguments)
{
    struct glsl_expression *x = glsl_node_expression(context, GLSL_CALL_BUILTIN, result, place);
    x->index = (uint16_t)meaning;
    x->argument = arguments->first;
    return glsl_fold(context, x);
}

struct glsl_expression *glsl_node_call(struct glsl_context *context, struct glsl_place place,
                                       const char *name, const struct glsl_expressions *arguments)
{
    const struct glsl_symbol *symbol = glsl_symbol_find(context, name);
    bool hidden = symbol && symbol->kind != GLSL_FUNCTION_SYMBOL;
    struct glsl_function *function = find(symbol, arguments);
    enum glsl_meaning meaning;
    struct glsl_type result;
    if (any_failed(arguments))
        return glsl_node_failed(context, place);
    if (function)
        return call_function(context, place, function, arguments);
    if (!hidden && glsl_builtin_find(context, place, name, arguments, &meaning, &result))
        return call_builtin(context, place, meaning, result, arguments);
    if (hidden)
        glsl_error(context, place, "found a call of '%s', which is a variable, expected a function", name);
    else if (symbol || glsl_builtin_has(context, name))
        glsl_error(context, place,
                   "found a call of '%s' with %s, expected the types of one of its declarations", name,
                   types_of(context, arguments));
    else
        glsl_error(context, place, "found a call of '%s', which is not declared", name);
    return glsl_node_failed(context, place);
}

/* --- Constructors --------------------------------------------------------------------------------------- */

static struct glsl_expression *bad_constructor(struct glsl_context *context, struct glsl_place place,
                                               struct glsl_type type, const char *expected)
{
    glsl_error(context, place, "found a constructor of %s %s", glsl_type_name(&context->arena, type),
               expected);
    return glsl_node_failed(context, place);
}

static bool fields_fit(const struct glsl_record *record, const struct glsl_expressions *arguments)
{
    const struct glsl_expression *x = arguments->first;
    for (unsigned i = 0; i < record->count; i++, x = x ? x->next : NULL)
        if (!x || !glsl_same_type(record->field[i].type, x->type))
            return false;
    return !x;
}

/* Returns the error in the arguments of a constructor of scalars, vectors and matrices; null if there is
 * none. */
static const char *wrong_scalars(struct glsl_type type, const struct glsl_expressions *arguments)
{
    unsigned needed = glsl_scalars(type), found = 0;
    bool one = arguments->count == 1;
    for (const struct glsl_expression *x = arguments->first; x; x = x->next) {
        if (!glsl_is_numeric(x->type) || x->type.array)
            return "with an argument that is neither a scalar, a vector nor a matrix";
        if (found >= needed)
            return "with too many arguments";
        if (glsl_is_matrix(x->type) && type.columns > 1 && !one)
            return "with a matrix and other arguments";
        found += glsl_scalars(x->type);
    }
    bool spread = one && (glsl_is_scalar(arguments->first->type) ||
                          (type.columns > 1 && glsl_is_matrix(arguments->first->type)));
    return found < needed && !spread ? "with too few components" : NULL;
}

struct glsl_expression *glsl_node_construct(struct glsl_context *context, struct glsl_place place,
                                            struct glsl_type type, const struct glsl_expressions *arguments)
{
    if (any_failed(arguments))
        return glsl_node_failed(context, place);
    if (!arguments->count)
        return bad_constructor(context, place, type, "without arguments");
    if (type.base == GLSL_VOID || glsl_is_sampler(type))
        return bad_constructor(context, place, type, "which does not exist");
    if (type.base == GLSL_STRUCT && !fields_fit(type.record, arguments))
        return bad_constructor(context, place, type,
                               glsl_format(&context->arena, "with %s, expected the types of its fields",
                                           types_of(context, arguments)));
    const char *wrong = type.base == GLSL_STRUCT ? NULL : wrong_scalars(type, arguments);
    if (wrong)
        return bad_constructor(context, place, type, wrong);
    struct glsl_expression *x = glsl_node_expression(context, GLSL_CONSTRUCT, type, place);
    x->argument = arguments->first;
    return glsl_fold(context, x);
}
