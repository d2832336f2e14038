/* Statements (6.2 to 6.4). */
#include "front/glsl/check/check.h"

struct glsl_statement *glsl_node_statement(struct glsl_context *context, enum glsl_statement_kind kind,
                                           struct glsl_place place)
{
    struct glsl_statement *statement = GLSL_NEW(&context->arena, struct glsl_statement);
    statement->kind = (uint8_t)kind;
    statement->place = place;
    return statement;
}

/* A statement can be the first of a list, as a declaration of several variables is. */
void glsl_node_add_statement(struct glsl_statements *list, struct glsl_statement *statement)
{
    if (!statement)
        return;
    if (list->last)
        list->last->next = statement;
    else
        list->first = statement;
    while (statement->next)
        statement = statement->next;
    list->last = statement;
}

void glsl_check_condition(struct glsl_context *context, const struct glsl_expression *condition)
{
    bool good = condition->type.base == GLSL_BOOL && glsl_is_scalar(condition->type);
    if (!good && !glsl_has_failed(condition))
        glsl_error(context, condition->place, "found a condition of type %s, expected bool",
                   glsl_type_name(&context->arena, condition->type));
}

static void check_return(struct glsl_context *context, struct glsl_place place,
                         const struct glsl_expression *value)
{
    struct glsl_type type = context->function->type;
    if (value && glsl_has_failed(value))
        return;
    if (type.base == GLSL_VOID && value)
        glsl_error(context, place, "found a value in '%s', which returns none", context->function->name);
    else if (type.base != GLSL_VOID && (!value || !glsl_same_type(type, value->type)))
        glsl_error(context, place, "found %s in '%s', expected %s",
                   value ? glsl_type_name(&context->arena, value->type) : "no value", context->function->name,
                   glsl_type_name(&context->arena, type));
}

struct glsl_statement *glsl_node_jump(struct glsl_context *context, enum glsl_statement_kind kind,
                                      struct glsl_place place, struct glsl_expression *value)
{
    struct glsl_statement *statement = glsl_node_statement(context, kind, place);
    statement->expression = value;
    if ((kind == GLSL_BREAK || kind == GLSL_CONTINUE) && !context->loops)
        glsl_error(context, place, "found '%s' outside of a loop", kind == GLSL_BREAK ? "break" : "continue");
    if (kind == GLSL_DISCARD && context->stage == GLSL_VERTEX)
        glsl_error(context, place, "found 'discard' in a vertex shader, expected it in a fragment shader");
    if (kind == GLSL_RETURN)
        check_return(context, place, value);
    return statement;
}

struct glsl_statement *glsl_node_if(struct glsl_context *context, struct glsl_place place,
                                    struct glsl_expression *condition, struct glsl_statement *then,
                                    struct glsl_statement *other)
{
    struct glsl_statement *statement = glsl_node_statement(context, GLSL_IF, place);
    glsl_check_condition(context, condition);
    statement->expression = condition;
    statement->body = then;
    statement->other = other;
    return statement;
}
