/* Calls of functions, which are inlined (6.1.1). */
#include "front/glsl/lower/lower.h"

/* --- Arguments ------------------------------------------------------------------------------------------ */

static bool is_global(const struct glsl_lowering *l, const struct glsl_value *value)
{
    return !value->constant && value->at.file == GLSL_FILE_TEMPORARY &&
           (value->at.access || l->code.temporary[value->at.number].global);
}

/* An argument is the parameter itself if neither the function nor an argument after it can change the
 * variable. Samplers are never copied. */
static bool can_be_alias(const struct glsl_lowering *l, const struct glsl_variable *parameter,
                         const struct glsl_expression *argument, const struct glsl_value *value)
{
    if (glsl_has_sampler(parameter->type))
        return true;
    return !parameter->written && !glsl_lower_any_impure(argument->next) && !is_global(l, value);
}

static struct glsl_value in_argument(struct glsl_lowering *l, const struct glsl_variable *parameter,
                                     const struct glsl_expression *argument)
{
    struct glsl_value value = glsl_lower_expression(l, argument);
    return can_be_alias(l, parameter, argument, &value) ? value : glsl_value_copied(l, &value);
}

/* The arguments are evaluated in their order, before the parameters are bound: an argument can call the same
 * function. */
static void evaluate_arguments(struct glsl_lowering *l, const struct glsl_expression *x,
                               struct glsl_value *value, struct glsl_place_to *place)
{
    const struct glsl_expression *argument = x->argument;
    for (const struct glsl_variable *p = x->function->parameter; p; p = p->next, argument = argument->next) {
        bool out = p->storage == GLSL_OUT || p->storage == GLSL_INOUT;
        if (out) {
            *place = glsl_lower_place(l, argument);
            if (p->storage == GLSL_INOUT && !l->code.failure)
                *value = glsl_lower_read(l, place);
            *value =
                p->storage == GLSL_INOUT ? glsl_value_copied(l, value) : glsl_value_temporary(l, p->type);
        } else {
            *value = in_argument(l, p, argument);
        }
        value++;
        place++;
    }
}

/* Copies results to the places of their arguments, in the order of the parameters. */
static void return_results(struct glsl_lowering *l, const struct glsl_function *function,
                           const struct glsl_value *value, const struct glsl_place_to *place)
{
    for (const struct glsl_variable *p = function->parameter; p; p = p->next, value++, place++)
        if (p->storage == GLSL_OUT || p->storage == GLSL_INOUT)
            glsl_lower_write(l, place, value);
}

/* --- Bodies --------------------------------------------------------------------------------------------- */

static struct glsl_value inline_body(struct glsl_lowering *l, const struct glsl_function *function)
{
    struct glsl_inlined outer = l->inlined;
    struct glsl_loop loop = l->loop;
    l->inlined = (struct glsl_inlined){.function = function};
    if (function->type.base != GLSL_VOID)
        l->inlined.result = glsl_value_temporary(l, function->type);
    if (glsl_lower_needs_flag(function->body)) {
        l->inlined.returned = glsl_operand_temporary(glsl_code_temporary(&l->code, 1), 1);
        struct glsl_operand zero = glsl_operand_literal(&l->code, 0);
        glsl_emit(&l->code, GLSL_OP_MOV, l->inlined.returned, 1, &zero);
    }
    glsl_lower_statements(l, function->body, true);
    struct glsl_value result = l->inlined.result;
    l->inlined = outer;
    l->loop = loop;
    return result;
}

struct glsl_value glsl_lower_call(struct glsl_lowering *l, const struct glsl_expression *x)
{
    const struct glsl_function *function = x->function;
    size_t count = function->parameters + 1;
    struct glsl_value *value = glsl_take(l->code.arena, count * sizeof *value);
    struct glsl_place_to *place = glsl_take(l->code.arena, count * sizeof *place);
    if (++l->calls > GLSL_MOST_CALLS)
        glsl_code_fail(&l->code, "more than 20000 calls of functions after inlining");
    if (++l->call_depth > GLSL_MOST_CALL_DEPTH)
        glsl_code_fail(&l->code, "more than 128 levels of calls");
    evaluate_arguments(l, x, value, place);
    unsigned i = 0;
    for (const struct glsl_variable *p = function->parameter; p; p = p->next)
        glsl_value_bind(l, p, value[i++]);
    struct glsl_value result = {.type = x->type};
    if (!l->code.failure)
        result = inline_body(l, function);
    if (!l->code.failure)
        return_results(l, function, value, place);
    else if (x->type.base != GLSL_VOID)
        result = glsl_value_temporary(l, x->type);
    l->call_depth--;
    return result;
}
