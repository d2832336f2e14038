/* Functions: prototypes, definitions, and the checks of the whole source (chapter 6). */
#include "front/glsl/check/builtin.h"

#include <string.h>

struct glsl_variable *glsl_node_parameter(struct glsl_context *context, struct glsl_place place,
                                          bool is_const, enum glsl_storage storage,
                                          const struct glsl_specifier *specifier, const char *name,
                                          struct glsl_expression *size, bool has_size)
{
    struct glsl_variable *parameter = GLSL_NEW(&context->arena, struct glsl_variable);
    struct glsl_type type = specifier->type;
    glsl_check_no_record(context, specifier, "a parameter");
    if (has_size)
        type.array = glsl_check_array_size(context, place, size);
    if (type.base == GLSL_VOID)
        glsl_error(context, place, "found a parameter of type void");
    if (is_const && storage != GLSL_IN)
        glsl_error(context, place, "found a constant parameter that is out or inout, expected in");
    if (glsl_has_sampler(type) && storage != GLSL_IN)
        glsl_error(context, place, "found a sampler as an out or inout parameter, expected in");
    parameter->name = name;
    parameter->type = type;
    parameter->storage = (uint8_t)(is_const ? GLSL_CONST_IN : storage);
    parameter->place = place;
    return parameter;
}

static struct glsl_variable *reversed(struct glsl_variable *list, unsigned *count)
{
    struct glsl_variable *result = NULL;
    for (*count = 0; list; ++*count) {
        struct glsl_variable *next = list->next;
        list->next = result;
        result = list;
        list = next;
    }
    return result;
}

struct glsl_function *glsl_node_prototype(struct glsl_context *context, struct glsl_place place,
                                          const struct glsl_specifier *result, const char *name,
                                          struct glsl_variable *parameters)
{
    struct glsl_function *function = GLSL_NEW(&context->arena, struct glsl_function);
    glsl_check_no_record(context, result, "a function");
    if (result->qualified)
        glsl_error(context, place, "found a function with a storage qualifier, expected none");
    if (glsl_has_array(result->type) || glsl_has_sampler(result->type))
        glsl_error(context, place, "found a function that returns an array or a sampler");
    function->name = name;
    function->type = result->type;
    function->place = place;
    function->parameter = reversed(parameters, &function->parameters);
    return function;
}

/* --- Overloads ------------------------------------------------------------------------------------------ */

static bool same_parameters(const struct glsl_function *a, const struct glsl_function *b)
{
    const struct glsl_variable *p = a->parameter, *q = b->parameter;
    for (; p && q; p = p->next, q = q->next)
        if (!glsl_same_type(p->type, q->type))
            return false;
    return !p && !q;
}

static bool same_qualifiers(const struct glsl_function *a, const struct glsl_function *b)
{
    const struct glsl_variable *p = a->parameter, *q = b->parameter;
    for (; p && q; p = p->next, q = q->next)
        if (p->storage != q->storage || p->type.precision != q->type.precision)
            return false;
    return true;
}

/* The declaration before with these parameters; null if this is the first one. */
static struct glsl_function *earlier(struct glsl_context *context, const struct glsl_function *function)
{
    const struct glsl_symbol *symbol = glsl_symbol_find(context, function->name);
    struct glsl_function *old = symbol && symbol->kind == GLSL_FUNCTION_SYMBOL ? symbol->function : NULL;
    while (old && !same_parameters(old, function))
        old = old->overload;
    if (old && (!glsl_same_type(old->type, function->type) ||
                old->type.precision != function->type.precision || !same_qualifiers(old, function)))
        glsl_error(context, function->place,
                   "found another declaration of '%s', expected the same result and qualifiers",
                   function->name);
    return old;
}

static void add_function(struct glsl_context *context, struct glsl_function *function)
{
    struct glsl_symbol *symbol = glsl_symbol_find(context, function->name);
    if (!symbol || symbol->kind != GLSL_FUNCTION_SYMBOL)
        symbol = glsl_symbol_add(context, GLSL_FUNCTION_SYMBOL, function->name, function->place);
    if (!symbol)
        return;
    function->overload = symbol->function;
    symbol->function = function;
    *context->unit->last_function = function;
    context->unit->last_function = &function->next;
}

/* The function that a declaration or definition belongs to. */
static struct glsl_function *resolved(struct glsl_context *context, struct glsl_function *function,
                                      bool defines)
{
    struct glsl_function *old = earlier(context, function);
    if (old && !defines)
        glsl_error(context, function->place, "found a second declaration of '%s'", function->name);
    if (glsl_builtin_has_parameters(context, function->name, function->parameter))
        glsl_error(context, function->place, "found '%s' with the parameters of a function of the language",
                   function->name);
    if (!old)
        add_function(context, function);
    return old ? old : function;
}

void glsl_node_declare_function(struct glsl_context *context, struct glsl_function *function)
{
    if (context->scopes.depth > 1)
        glsl_error(context, function->place, "found a function in a function, expected it outside");
    else
        resolved(context, function, false);
}

/* --- Definitions ---------------------------------------------------------------------------------------- */

static void check_main(struct glsl_context *context, const struct glsl_function *function)
{
    if (!strcmp(function->name, "main") && (function->parameters || function->type.base != GLSL_VOID))
        glsl_error(context, function->place, "found another 'main', expected void main()");
}

struct glsl_function *glsl_node_begin_function(struct glsl_context *context, struct glsl_function *function)
{
    struct glsl_function *known = resolved(context, function, true);
    check_main(context, function);
    if (known->defined)
        glsl_error(context, function->place, "found a second definition of '%s'", function->name);
    known->defined = true;
    known->parameter = function->parameter;
    context->function = known;
    glsl_scope_open(context, function->place);
    for (struct glsl_variable *p = known->parameter; p; p = p->next) {
        struct glsl_symbol *symbol =
            p->name ? glsl_symbol_add(context, GLSL_VARIABLE_SYMBOL, p->name, p->place) : NULL;
        if (symbol)
            symbol->variable = p;
    }
    glsl_scope_open(context, function->place);
    return known;
}

void glsl_node_end_function(struct glsl_context *context, struct glsl_statement *body)
{
    glsl_scope_close(context);
    glsl_scope_close(context);
    context->function->body = body;
    if (!strcmp(context->function->name, "main"))
        context->unit->main = context->function;
    context->function = NULL;
}

/* --- The whole source ----------------------------------------------------------------------------------- */

/* Visits all functions that one calls; a call of one that is being visited is recursion. The depth of the
 * search is bounded by GLSL_FUNCTIONS. */
enum { GLSL_FUNCTIONS = 2000 };

static void visit(struct glsl_context *context, struct glsl_function *function, unsigned depth)
{
    function->visit = 1;
    for (const struct glsl_callee *c = function->callee; c; c = c->next) {
        if (!c->function->defined)
            glsl_error(context, c->place, "found a call of '%s', which is declared and not defined",
                       c->function->name);
        else if (c->function->visit == 1)
            glsl_error(context, c->place, "found a call of '%s' by itself, which the language does not have",
                       c->function->name);
        else if (depth == GLSL_FUNCTIONS)
            glsl_error(context, c->place, "found more than %d levels of calls", GLSL_FUNCTIONS);
        else if (!c->function->visit)
            visit(context, c->function, depth + 1);
    }
    function->visit = 2;
}

static void check_colors(struct glsl_context *context, struct glsl_place end)
{
    uint32_t colors = 1u << GLSL_FRAG_COLOR | 1u << GLSL_SECOND_COLOR,
             data = 1u << GLSL_FRAG_DATA | 1u << GLSL_SECOND_DATA, used = context->unit->builtins;
    if (context->stage == GLSL_FRAGMENT && used & colors && used & data)
        glsl_error(context, end, "found %s and %s, expected variables of one kind",
                   used >> GLSL_FRAG_COLOR & 1 ? "gl_FragColor" : "gl_SecondaryFragColorEXT",
                   used >> GLSL_FRAG_DATA & 1 ? "gl_FragData" : "gl_SecondaryFragDataEXT");
}

void glsl_check_unit(struct glsl_context *context, struct glsl_place end)
{
    for (struct glsl_function *f = context->unit->function; f; f = f->next)
        if (f->defined && !f->visit)
            visit(context, f, 0);
    check_colors(context, end);
}
