/* Statements (chapter 6). A return that is not at the end of its function sets a flag, which what follows
 * tests; a loop that contains it is left. */
#include "front/glsl/lower/lower.h"

static void lower_statement(struct glsl_lowering *l, const struct glsl_statement *s, bool tail);

/* --- Returns -------------------------------------------------------------------------------------------- */

static bool list_contains_return(const struct glsl_statement *list);

static bool contains_return(const struct glsl_statement *s)
{
    return s && (s->kind == GLSL_RETURN || contains_return(s->other) ||
                 (s->kind == GLSL_BLOCK ? list_contains_return(s->body) : contains_return(s->body)));
}

static bool list_contains_return(const struct glsl_statement *list)
{
    while (list && !contains_return(list))
        list = list->next;
    return list;
}

/* Returns true if no path reaches the end of the statement, because all of them return. */
static bool always_returns(const struct glsl_statement *s)
{
    if (!s)
        return false;
    if (s->kind == GLSL_IF)
        return always_returns(s->body) && always_returns(s->other);
    if (s->kind != GLSL_BLOCK)
        return s->kind == GLSL_RETURN;
    for (s = s->body; s; s = s->next)
        if (always_returns(s))
            return true;
    return false;
}

bool glsl_lower_needs_flag(const struct glsl_statement *body)
{
    const struct glsl_statement *s = body && body->kind == GLSL_BLOCK ? body->body : body;
    for (; s; s = s->next)
        if (contains_return(s))
            return s->kind != GLSL_RETURN;
    return false;
}

static void lower_return(struct glsl_lowering *l, const struct glsl_statement *s, bool tail)
{
    struct glsl_inlined *inlined = &l->inlined;
    if (s->expression) {
        struct glsl_value value = glsl_lower_expression(l, s->expression);
        if (!l->code.failure && s->expression->type.base != GLSL_VOID)
            glsl_value_copy(l, &inlined->result, &value);
    }
    if (tail)
        return;
    struct glsl_operand one = glsl_operand_literal(&l->code, 1);
    glsl_emit(&l->code, GLSL_OP_MOV, inlined->returned, 1, &one);
    if (inlined->loops)
        glsl_emit_jump(&l->code, GLSL_OP_BREAK);
}

/* --- Branches ------------------------------------------------------------------------------------------- */

static void begin_if(struct glsl_lowering *l, const struct glsl_expression *x, bool wanted)
{
    struct glsl_condition condition = glsl_lower_condition(l, x, wanted);
    glsl_emit_if(&l->code, (enum glsl_comparison)condition.comparison, condition.a, condition.b);
}

static bool is_discard(const struct glsl_statement *s)
{
    if (s && s->kind == GLSL_BLOCK)
        return s->body && !s->body->next && is_discard(s->body);
    return s && s->kind == GLSL_DISCARD;
}

static void jump_if(struct glsl_lowering *l, enum glsl_op op, const struct glsl_expression *x, bool wanted)
{
    struct glsl_condition condition = glsl_lower_condition(l, x, wanted);
    glsl_emit_jump_if(&l->code, op, (enum glsl_comparison)condition.comparison, condition.a, condition.b);
}

static void lower_if(struct glsl_lowering *l, const struct glsl_statement *s, bool tail)
{
    if (s->expression->value) {
        lower_statement(l, s->expression->value->i ? s->body : s->other, tail);
        return;
    }
    if (is_discard(s->body) && !s->other) {
        jump_if(l, GLSL_OP_KILL_IF, s->expression, true);
        return;
    }
    begin_if(l, s->expression, true);
    lower_statement(l, s->body, tail);
    if (s->other) {
        glsl_emit_else(&l->code);
        lower_statement(l, s->other, tail);
    }
    glsl_emit_endif(&l->code);
}

/* --- Loops ---------------------------------------------------------------------------------------------- */

static void test_condition(struct glsl_lowering *l, const struct glsl_statement *s)
{
    if (s->condition) {
        lower_statement(l, s->condition, false);
        struct glsl_value value = glsl_value_variable(l, s->condition->variable);
        if (!l->code.failure)
            glsl_emit_jump_if(&l->code, GLSL_OP_BREAK_IF, GLSL_IS_EQUAL, glsl_value_part(l, &value, 0),
                              glsl_operand_literal(&l->code, 0));
    } else if (s->expression && !s->expression->value) {
        jump_if(l, GLSL_OP_BREAK_IF, s->expression, false);
    }
}

static void end_pass(struct glsl_lowering *l)
{
    const struct glsl_expression *condition = l->loop.condition;
    if (l->loop.each)
        glsl_lower_effects(l, l->loop.each);
    if (condition && condition->value && !condition->value->i)
        glsl_emit_jump(&l->code, GLSL_OP_BREAK);
    else if (condition && !condition->value)
        jump_if(l, GLSL_OP_BREAK_IF, condition, false);
}

static void lower_loop(struct glsl_lowering *l, const struct glsl_statement *s)
{
    struct glsl_loop outer = l->loop;
    bool never = s->kind != GLSL_DO && s->expression && s->expression->value && !s->expression->value->i;
    for (const struct glsl_statement *f = s->kind == GLSL_FOR ? s->first : NULL; f; f = f->next)
        lower_statement(l, f, false);
    if (never)
        return;
    l->loop = (struct glsl_loop){s->each, s->kind == GLSL_DO ? s->expression : NULL};
    l->inlined.loops++;
    glsl_emit_while(&l->code);
    if (s->kind != GLSL_DO)
        test_condition(l, s);
    lower_statement(l, s->body, false);
    end_pass(l);
    glsl_emit_endwhile(&l->code);
    l->inlined.loops--;
    l->loop = outer;
}

/* --- Declarations --------------------------------------------------------------------------------------- */

static void lower_declaration(struct glsl_lowering *l, const struct glsl_statement *s)
{
    struct glsl_value value = {0};
    if (s->variable->storage == GLSL_CONSTANT_STORAGE)
        return;
    if (s->expression)
        value = glsl_lower_expression(l, s->expression);
    if (value.constant && !s->variable->written) {
        glsl_value_bind(l, s->variable, value);
        return;
    }
    struct glsl_value variable = glsl_value_temporary(l, s->variable->type);
    if (s->expression && !l->code.failure)
        glsl_value_copy(l, &variable, &value);
    glsl_value_bind(l, s->variable, variable);
}

void glsl_lower_global(struct glsl_lowering *l, const struct glsl_statement *declaration)
{
    if (!declaration->expression)
        return;
    struct glsl_value value =
        glsl_value_constant(declaration->variable->type, declaration->expression->value);
    if (!declaration->variable->written) {
        glsl_value_bind(l, declaration->variable, value);
        return;
    }
    struct glsl_value variable = glsl_value_variable(l, declaration->variable);
    glsl_value_copy(l, &variable, &value);
}

/* --- Lists ---------------------------------------------------------------------------------------------- */

static bool ends_list(const struct glsl_statement *s)
{
    return s->kind == GLSL_RETURN || s->kind == GLSL_BREAK || s->kind == GLSL_CONTINUE;
}

/* `if (...) return ...; rest`: the rest is in the other branch. */
static void lower_either(struct glsl_lowering *l, const struct glsl_statement *s)
{
    begin_if(l, s->expression, true);
    lower_statement(l, s->body, true);
    glsl_emit_else(&l->code);
    glsl_lower_statements(l, s->next, true);
    glsl_emit_endif(&l->code);
}

/* The statements after one that can have set the flag. */
static void lower_rest(struct glsl_lowering *l, const struct glsl_statement *rest, bool tail)
{
    struct glsl_operand zero = glsl_operand_literal(&l->code, 0);
    glsl_emit_if(&l->code, GLSL_IS_EQUAL, l->inlined.returned, zero);
    glsl_lower_statements(l, rest, tail);
    glsl_emit_endif(&l->code);
}

static bool is_loop(const struct glsl_statement *s)
{
    return s->kind == GLSL_FOR || s->kind == GLSL_WHILE || s->kind == GLSL_DO;
}

void glsl_lower_statements(struct glsl_lowering *l, const struct glsl_statement *list, bool tail)
{
    for (const struct glsl_statement *s = list; s && !l->code.failure; s = s->next) {
        bool last = tail && !s->next;
        if (tail && s->next && s->kind == GLSL_IF && !s->expression->value && !s->other &&
            always_returns(s->body)) {
            lower_either(l, s);
            return;
        }
        lower_statement(l, s, last || (tail && s->kind == GLSL_RETURN));
        if (ends_list(s))
            return;
        if (l->inlined.loops && is_loop(s) && contains_return(s)) {
            glsl_emit_jump_if(&l->code, GLSL_OP_BREAK_IF, GLSL_IS_NOT_EQUAL, l->inlined.returned,
                              glsl_operand_literal(&l->code, 0));
        } else if (!l->inlined.loops && s->next && contains_return(s)) {
            lower_rest(l, s->next, tail);
            return;
        }
    }
}

static void lower_jump(struct glsl_lowering *l, const struct glsl_statement *s)
{
    if (s->kind == GLSL_CONTINUE)
        end_pass(l);
    glsl_emit_jump(&l->code, s->kind == GLSL_BREAK      ? GLSL_OP_BREAK
                             : s->kind == GLSL_CONTINUE ? GLSL_OP_CONTINUE
                                                        : GLSL_OP_KILL);
}

static void lower_kind(struct glsl_lowering *l, const struct glsl_statement *s, bool tail)
{
    switch ((enum glsl_statement_kind)s->kind) {
    case GLSL_BLOCK: glsl_lower_statements(l, s->body, tail); break;
    case GLSL_EXPRESSION:
        if (s->expression)
            glsl_lower_effects(l, s->expression);
        break;
    case GLSL_DECLARATION: lower_declaration(l, s); break;
    case GLSL_IF: lower_if(l, s, tail); break;
    case GLSL_FOR:
    case GLSL_WHILE:
    case GLSL_DO: lower_loop(l, s); break;
    case GLSL_BREAK:
    case GLSL_CONTINUE:
    case GLSL_DISCARD: lower_jump(l, s); break;
    case GLSL_RETURN: lower_return(l, s, tail); break;
    }
}

static void lower_statement(struct glsl_lowering *l, const struct glsl_statement *s, bool tail)
{
    if (!s)
        return;
    if (++l->depth > GLSL_MOST_DEPTH)
        glsl_code_fail(&l->code, "statements of more than 1000 levels");
    if (!l->code.failure)
        lower_kind(l, s, tail);
    l->depth--;
}
