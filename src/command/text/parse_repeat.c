/* Repeats and variables. A repeat does not become a call: its lines are read again for each repetition. So
 * the stream has the calls of a text with all repetitions written out. */
#include "command/text/parse.h"

/* Gives the innermost repeat's names their values. Variables that were first set in it have none yet. */
static void begin_repetition(struct parser *parser)
{
    struct expression_scope *scope = &parser->scope;
    scope->known[EXPRESSION_count] = parser->repeat_count > 0;
    if (!parser->repeat_count)
        return;
    const struct repeat *repeat = &parser->repeats[parser->repeat_count - 1];
    scope->builtin[EXPRESSION_count] = repeat->count;
    if (repeat->named)
        scope->variable[repeat->variables].value = repeat->count - repeat->left - 1;
}

/* N [NAME] */
int parse_repeat(struct parser *parser)
{
    struct lexer *lex = &parser->lex;
    int64_t count;
    if (parser->repeat_count == LIMIT_REPEATS)
        return lex_expected(lex, "at most %d repeats in one another", LIMIT_REPEATS);
    struct repeat *repeat = &parser->repeats[parser->repeat_count];
    *repeat = (struct repeat){.place = lex->token, .variables = parser->scope.variable_count};
    if (lex_integer(lex, "repetitions", 1, LIMIT_REPETITIONS, &count))
        return -1;
    repeat->count = (uint32_t)count;
    repeat->left = repeat->count - 1;
    struct token name = lex->token;
    repeat->named = name.type == TOKEN_WORD;
    if (repeat->named) {
        size_t length = expression_name(name.text, name.text + name.length);
        if (expression_add(lex, &name, length == name.length ? length : 0, 0) || lex_next(lex))
            return -1;
    }
    if (lex_line_end(lex))
        return -1;
    repeat->body = *lex;
    parser->repeat_count++;
    begin_repetition(parser);
    return 0;
}

int parse_end_repeat(struct parser *parser)
{
    struct lexer *lex = &parser->lex;
    struct repeat *repeat = &parser->repeats[parser->repeat_count - 1];
    if (lex_line_end(lex))
        return -1;
    bool again = repeat->left > 0;
    parser->scope.variable_count = repeat->variables + (again && repeat->named);
    if (again) {
        parser->repeated += (uint64_t)(lex->at - repeat->body.at) + 1;
        if (parser->repeated > LIMIT_REPEATED)
            return lex_fail(lex, &repeat->place,
                            "found repeats of more than %d bytes, expected fewer repetitions",
                            LIMIT_REPEATED);
        repeat->left--;
        *lex = repeat->body;
    } else {
        parser->repeat_count--;
    }
    begin_repetition(parser);
    return 0;
}

/* NAME = EXPRESSION */
int parse_let(struct parser *parser)
{
    struct lexer *lex = &parser->lex;
    struct token name = lex->token, expression;
    double value;
    size_t length = name.type == TOKEN_WORD ? expression_name(name.text, name.text + name.length) : 0;
    const char *at = name.text + length;
    while (at < lex->end && (*at == ' ' || *at == '\t'))
        at++;
    if (!length || at == lex->end || *at != '=')
        return lex_expected(lex, "NAME = EXPRESSION");
    if (lex_rest(lex, at + 1, &expression) || expression_value(lex, &expression, &value) ||
        expression_set(lex, &name, length, value))
        return -1;
    return lex_line_end(lex);
}
