/* The expressions of #if and #elif: whole numbers, `defined`, and the operators of C without assignment
 * and the conditional one. A name that is not a macro is an error, unless its operand is not evaluated. */
#include "front/glsl/context.h"
#include "front/glsl/preprocess/preprocess.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NESTING = 200 };

struct expression {
    struct glsl_context *context;
    const struct glsl_token *at, *end;
    struct glsl_place place; /* of the directive, for messages at the end */
    unsigned depth;
    bool failed;
};

static long binary(struct expression *x, unsigned level, bool evaluated);

static long fail(struct expression *x, const char *expected)
{
    if (!x->failed && x->at < x->end)
        glsl_error(x->context, x->at->place, "found '%.*s', expected %s", x->at->length, x->at->text,
                   expected);
    else if (!x->failed)
        glsl_error(x->context, x->place, "found the end of the line, expected %s", expected);
    x->failed = true;
    x->at = x->end;
    return 0;
}

static bool accept(struct expression *x, const char *text)
{
    bool found = x->at < x->end && glsl_token_is(x->at, text);
    x->at += found;
    return found;
}

static long number(struct expression *x)
{
    char text[32], *end;
    snprintf(text, sizeof text, "%.*s", x->at->length, x->at->text);
    errno = 0;
    unsigned long value = strtoul(text, &end, 0);
    if (*end || errno || x->at->length >= sizeof text)
        return fail(x, "a whole number");
    x->at++;
    return (int32_t)value;
}

static long primary(struct expression *x, bool evaluated)
{
    if (x->at == x->end)
        return fail(x, "a number");
    if (accept(x, "(")) {
        long value = binary(x, 0, evaluated);
        return accept(x, ")") ? value : fail(x, ")");
    }
    if (x->at->kind == GLSL_NUMBER)
        return number(x);
    if (x->at->kind != GLSL_NAME || evaluated)
        return fail(x, "a number or a macro");
    x->at++;
    return 0;
}

static long unary(struct expression *x, bool evaluated)
{
    long value;
    if (++x->depth > NESTING)
        return fail(x, "fewer levels");
    if (accept(x, "+"))
        value = unary(x, evaluated);
    else if (accept(x, "-"))
        value = (int32_t) - (uint32_t)unary(x, evaluated);
    else if (accept(x, "~"))
        value = ~unary(x, evaluated);
    else if (accept(x, "!"))
        value = !unary(x, evaluated);
    else
        value = primary(x, evaluated);
    x->depth--;
    return value;
}

enum operation {
    OR,
    AND,
    BIT_OR,
    BIT_XOR,
    BIT_AND,
    EQ,
    NE,
    LE,
    GE,
    LT,
    GT,
    SHL,
    SHR,
    ADD,
    SUB,
    MUL,
    DIV,
    MOD
};

static const struct {
    const char *text;
    uint8_t level, operation;
} operators[] = {
    {"||", 0, OR},  {"&&", 1, AND}, {"|", 2, BIT_OR}, {"^", 3, BIT_XOR}, {"&", 4, BIT_AND}, {"==", 5, EQ},
    {"!=", 5, NE},  {"<=", 6, LE},  {">=", 6, GE},    {"<", 6, LT},      {">", 6, GT},      {"<<", 7, SHL},
    {">>", 7, SHR}, {"+", 8, ADD},  {"-", 8, SUB},    {"*", 9, MUL},     {"/", 9, DIV},     {"%", 9, MOD},
};

enum { OPERATORS = sizeof operators / sizeof *operators, LEVELS = 10 };

static long divide(struct expression *x, long a, long b, bool remainder, bool evaluated)
{
    if (b)
        return remainder ? a % b : (int32_t)(a / b);
    if (evaluated)
        fail(x, "a divisor that is not 0");
    return 0;
}

static long apply(struct expression *x, enum operation operation, long a, long b, bool evaluated)
{
    uint32_t ua = (uint32_t)a, ub = (uint32_t)b;
    switch (operation) {
    case OR: return a || b;
    case AND: return a && b;
    case BIT_OR: return a | b;
    case BIT_XOR: return a ^ b;
    case BIT_AND: return a & b;
    case EQ: return a == b;
    case NE: return a != b;
    case LE: return a <= b;
    case GE: return a >= b;
    case LT: return a < b;
    case GT: return a > b;
    case SHL: return (int32_t)(ua << (ub & 31));
    case SHR: return (int32_t)a >> (ub & 31);
    case ADD: return (int32_t)(ua + ub);
    case SUB: return (int32_t)(ua - ub);
    case MUL: return (int32_t)(ua * ub);
    case DIV:
    case MOD: break;
    }
    return divide(x, a, b, operation == MOD, evaluated);
}

static int operator_at(const struct expression *x, unsigned level)
{
    for (int i = 0; x->at < x->end && i < OPERATORS; i++)
        if (operators[i].level == level && glsl_token_is(x->at, operators[i].text))
            return i;
    return -1;
}

static long binary(struct expression *x, unsigned level, bool evaluated)
{
    if (level == LEVELS)
        return unary(x, evaluated);
    long value = binary(x, level + 1, evaluated);
    for (int i; (i = operator_at(x, level)) >= 0;) {
        enum operation operation = (enum operation)operators[i].operation;
        bool other = evaluated && !(operation == OR && value) && !(operation == AND && !value);
        x->at++;
        long second = binary(x, level + 1, other);
        value = apply(x, operation, value, second, evaluated);
    }
    return value;
}

/* `defined NAME` and `defined ( NAME )` become 0 or 1, also if a macro has made them. */
static struct glsl_list replace_defined(struct glsl_context *context, const struct glsl_token *line,
                                        size_t count)
{
    struct glsl_list result = {0};
    for (size_t i = 0; i < count; i++) {
        struct glsl_token token = line[i];
        bool enclosed = i + 1 < count && glsl_token_is(&line[i + 1], "(");
        size_t name = i + 1 + enclosed;
        if (glsl_token_is(&token, "defined")) {
            if (name >= count || line[name].kind != GLSL_NAME ||
                (enclosed && (name + 1 >= count || !glsl_token_is(&line[name + 1], ")")))) {
                glsl_error(context, token.place, "expected a name after 'defined'");
                return (struct glsl_list){0};
            }
            token.kind = GLSL_NUMBER;
            token.text = glsl_macro_find(context->preprocessor, &line[name]) ? "1" : "0";
            token.length = 1;
            i = name + enclosed;
        }
        glsl_list_add(context, &result, &token);
    }
    return result;
}

long glsl_condition_value(struct glsl_context *context, struct glsl_place place,
                          const struct glsl_token *line, size_t count)
{
    struct glsl_list expanded = glsl_expand_all(context, line, count, true);
    struct glsl_list list = replace_defined(context, expanded.token, expanded.count);
    static const struct glsl_token nothing;
    const struct glsl_token *at = list.count ? list.token : &nothing;
    struct expression x = {.context = context, .at = at, .end = at + list.count, .place = place};
    if (expanded.count && !list.count)
        return 0;
    long value = binary(&x, 0, true);
    if (!x.failed && x.at < x.end)
        fail(&x, "the end of the line");
    return x.failed ? 0 : value;
}
