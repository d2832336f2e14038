/* Recursive descent over the characters of one token. The functions read a grammar rule and return 0 with its
 * value, or -1 with the reason. Each nested rule counts against LIMIT_PARENTHESES, which bounds the stack. */
#include "command/stream/expression.h"

#include "base/position.h"
#include "command/stream/lex.h"
#include "command/stream/sine.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ARGUMENTS_MAXIMUM = 4, NUMBER_CAPACITY = 128, CHOICES_CAPACITY = 256 };

struct reader {
    struct lexer *lexer;
    const struct token *token;
    const char *at, *end;
    unsigned depth;
};

static int read_sum(struct reader *reader, double *value);

/* --- Names ---------------------------------------------------------------------------------------------- */

static const struct {
    const char *name, *where;
} builtins[] = {
#define BUILTIN(name, where, meaning) {#name, where},
#include "command/stream/expression.def"
};

static double color_of(const double channel[4])
{
    static const int shift[4] = {16, 8, 0, 24}; /* red, green, blue, alpha in AARRGGBB */
    double packed = 0;
    for (int i = 0; i < 4; i++) {
        double limited = channel[i] < 0 ? 0 : channel[i] > 1 ? 1 : channel[i];
        packed += floor(limited * 255 + 0.5) * (double)(1u << shift[i]);
    }
    return packed;
}

#define FUNCTION(name, arguments, result, meaning)                                                           \
    static double compute_##name(const double *a)                                                            \
    {                                                                                                        \
        return result;                                                                                       \
    }
#include "command/stream/expression.def"

static const struct function {
    const char *name;
    unsigned arguments;
    double (*compute)(const double *a);
} functions[] = {
#define FUNCTION(name, arguments, result, meaning) {#name, arguments, compute_##name},
#include "command/stream/expression.def"
};

enum { FUNCTIONS = sizeof functions / sizeof *functions };

static bool is_name(const char *name, const char *text, size_t length)
{
    return strlen(name) == length && !memcmp(name, text, length);
}

static bool begins_name(char c)
{
    return ((c | 32) >= 'a' && (c | 32) <= 'z') || c == '_';
}

size_t expression_name(const char *text, const char *end)
{
    const char *at = text;
    while (at < end && (begins_name(*at) || (at > text && *at >= '0' && *at <= '9')))
        at++;
    return (size_t)(at - text);
}

void expression_start(struct expression_scope *scope)
{
    *scope = (struct expression_scope){0};
    scope->builtin[EXPRESSION_pi] = 3.141592653589793;
    scope->known[EXPRESSION_pi] = scope->known[EXPRESSION_frame] = true;
}

static double *find_variable(struct expression_scope *scope, const char *name, size_t length)
{
    for (unsigned i = scope->variable_count; i-- > 0;)
        if (is_name(scope->variable[i].name, name, length))
            return &scope->variable[i].value;
    return NULL;
}

static bool is_reserved(const char *name, size_t length)
{
    for (size_t i = 0; i < EXPRESSION_BUILTINS; i++)
        if (is_name(builtins[i].name, name, length))
            return true;
    for (size_t i = 0; i < FUNCTIONS; i++)
        if (is_name(functions[i].name, name, length))
            return true;
    return false;
}

int expression_add(struct lexer *lexer, const struct token *place, size_t length, double value)
{
    struct expression_scope *scope = lexer->scope;
    const char *name = place->text;
    char quoted[POSITION_QUOTED];
    if (!length || length > LIMIT_NAME_BYTES)
        return lex_fail(
            lexer, place,
            "found %s, expected the name of a variable: a letter or _, then letters, digits, _ (at most "
            "%d bytes)",
            position_quote(place->text, place->length, POSITION_SHOWN, quoted), LIMIT_NAME_BYTES);
    if (is_reserved(name, length) || find_variable(scope, name, length))
        return lex_fail(lexer, place, "found '%.*s', expected a name that is not in use", (int)length, name);
    if (scope->variable_count == LIMIT_VARIABLES)
        return lex_fail(lexer, place, "found '%.*s', expected at most %d variables", (int)length, name,
                        LIMIT_VARIABLES);
    memcpy(scope->variable[scope->variable_count].name, name, length);
    scope->variable[scope->variable_count].name[length] = 0;
    scope->variable[scope->variable_count++].value = value;
    return 0;
}

int expression_set(struct lexer *lexer, const struct token *place, size_t length, double value)
{
    double *found = find_variable(lexer->scope, place->text, length);
    if (!found)
        return expression_add(lexer, place, length, value);
    *found = value;
    return 0;
}

/* --- Reasons -------------------------------------------------------------------------------------------- */

static struct token place_of(const struct reader *reader, const char *at)
{
    struct token place = *reader->token;
    place.column += (uint32_t)(at - place.text);
    return place;
}

static int fail(const struct reader *reader, const char *at, const char *reason, ...)
    __attribute__((format(printf, 3, 4)));
static int fail(const struct reader *reader, const char *at, const char *reason, ...)
{
    char text[CHOICES_CAPACITY + 128];
    struct token place = place_of(reader, at);
    va_list arguments;
    va_start(arguments, reason);
    vsnprintf(text, sizeof text, reason, arguments);
    va_end(arguments);
    return lex_fail(reader->lexer, &place, "%s", text);
}

static void skip_spaces(struct reader *reader)
{
    while (reader->at < reader->end && (*reader->at == ' ' || *reader->at == '\t'))
        reader->at++;
}

/* The found piece is a name, a character, or the end. */
static int expected(struct reader *reader, const char *what)
{
    char quoted[POSITION_QUOTED] = "the end of the expression";
    const char *at = reader->at;
    size_t length = expression_name(at, reader->end);
    while (!length && at + length < reader->end && (at[length] & 0x80))
        length++;
    if (at < reader->end)
        position_quote(at, length ? length : 1, POSITION_SHOWN, quoted);
    return fail(reader, at, "found %s, expected %s", quoted, what);
}

/* The names that have values, in the scope that words->list is. */
static const char *name_choice(const struct words *words, unsigned index)
{
    const struct expression_scope *scope = words->list;
    if (index < scope->variable_count)
        return scope->variable[index].name;
    index -= scope->variable_count;
    if (index < EXPRESSION_BUILTINS)
        return builtins[index].name;
    index -= EXPRESSION_BUILTINS;
    return index < FUNCTIONS ? functions[index].name : NULL;
}

static int unknown_name(const struct reader *reader, const char *name, size_t length)
{
    char choices[CHOICES_CAPACITY], quoted[POSITION_QUOTED];
    struct words words = {.at = name_choice, .list = reader->lexer->scope};
    words_join(words, choices, sizeof choices);
    fail(reader, name, "found %s, expected a name that has a value here: %s",
         position_quote(name, length, POSITION_SHOWN, quoted), choices);
    return words_suggest_in(words, name, length, reader->lexer->error);
}

/* --- Rules ---------------------------------------------------------------------------------------------- */

static int enter(struct reader *reader)
{
    if (++reader->depth > LIMIT_PARENTHESES)
        return fail(reader, reader->at, "found an expression %u deep, expected at most %d", reader->depth,
                    LIMIT_PARENTHESES);
    return 0;
}

static bool take(struct reader *reader, char c)
{
    skip_spaces(reader);
    if (reader->at == reader->end || *reader->at != c)
        return false;
    reader->at++;
    return true;
}

static int check_finite(const struct reader *reader, const char *at, double value)
{
    return isfinite(value) ? 0 : fail(reader, at, "found a result that is not finite, expected a finite one");
}

static int read_number(struct reader *reader, double *value)
{
    char text[NUMBER_CAPACITY], *end;
    size_t left = (size_t)(reader->end - reader->at);
    snprintf(text, sizeof text, "%.*s", (int)(left < sizeof text ? left : sizeof text - 1), reader->at);
    *value = strtod(text, &end);
    if (end == text || (size_t)(end - text) == sizeof text - 1)
        return expected(reader, "a number");
    if (check_finite(reader, reader->at, *value))
        return -1;
    reader->at += end - text;
    return 0;
}

/* (ARGUMENT, ...) */
static int read_call(struct reader *reader, const struct function *function, const char *name, double *value)
{
    double arguments[ARGUMENTS_MAXIMUM];
    if (!take(reader, '('))
        return expected(reader, "( and the arguments of the function");
    for (unsigned i = 0; i < function->arguments; i++) {
        if (i && !take(reader, ','))
            return expected(reader, ", and another argument");
        if (read_sum(reader, &arguments[i]))
            return -1;
    }
    if (!take(reader, ')'))
        return expected(reader, ") after the last argument");
    *value = function->compute(arguments);
    if (isfinite(*value))
        return 0;
    return fail(reader, name, "found %s of %.9g, expected an argument for which it is defined",
                function->name, arguments[0]);
}

static int read_name(struct reader *reader, double *value)
{
    const char *name = reader->at;
    size_t length = expression_name(name, reader->end);
    struct expression_scope *scope = reader->lexer->scope;
    const double *variable = find_variable(scope, name, length);
    reader->at += length;
    if (variable)
        return *value = *variable, 0;
    for (size_t i = 0; i < EXPRESSION_BUILTINS; i++)
        if (is_name(builtins[i].name, name, length)) {
            *value = scope->builtin[i];
            return scope->known[i] ? 0
                                   : fail(reader, name, "found '%s', expected it only %s", builtins[i].name,
                                          builtins[i].where);
        }
    for (size_t i = 0; i < FUNCTIONS; i++)
        if (is_name(functions[i].name, name, length))
            return read_call(reader, &functions[i], name, value);
    return unknown_name(reader, name, length);
}

/* A number, a name, a function, (SUM), or one of them with signs before it. */
static int read_factor(struct reader *reader, double *value)
{
    static const char items[] = "a number, a name or (";
    if (enter(reader))
        return -1;
    int result;
    if (take(reader, '-')) {
        result = read_factor(reader, value);
        *value = result ? 0 : -*value;
    } else if (take(reader, '(')) {
        result = read_sum(reader, value);
        if (!result && !take(reader, ')'))
            result = expected(reader, "an operator or )");
    } else if (reader->at < reader->end && begins_name(*reader->at)) {
        result = read_name(reader, value);
    } else if (reader->at < reader->end &&
               ((*reader->at >= '0' && *reader->at <= '9') || *reader->at == '.')) {
        result = read_number(reader, value);
    } else {
        result = expected(reader, items);
    }
    reader->depth--;
    return result;
}

/* The remainder has the sign of the divisor: -1 % 3 is 2. */
static double remainder_of(double a, double b)
{
    double remainder = fmod(a, b);
    return remainder != 0 && (remainder < 0) != (b < 0) ? remainder + b : remainder;
}

static int read_product(struct reader *reader, double *value)
{
    double factor = 0;
    if (read_factor(reader, value))
        return -1;
    for (;;) {
        skip_spaces(reader);
        const char *op = reader->at;
        if (op == reader->end || !strchr("*/%", *op))
            return 0;
        reader->at++;
        if (read_factor(reader, &factor))
            return -1;
        if (*op != '*' && factor == 0)
            return fail(reader, op, "found a division by zero, expected another divisor");
        *value = *op == '*' ? *value * factor : *op == '/' ? *value / factor : remainder_of(*value, factor);
        if (check_finite(reader, op, *value))
            return -1;
    }
}

static int read_sum(struct reader *reader, double *value)
{
    double term = 0;
    if (read_product(reader, value))
        return -1;
    for (;;) {
        skip_spaces(reader);
        const char *sign = reader->at;
        if (sign == reader->end || (*sign != '+' && *sign != '-'))
            return 0;
        reader->at++;
        if (read_product(reader, &term))
            return -1;
        *value = *sign == '+' ? *value + term : *value - term;
        if (check_finite(reader, sign, *value))
            return -1;
    }
}

int expression_value(struct lexer *lexer, const struct token *token, double *value)
{
    struct reader reader = {lexer, token, token->text, token->text + token->length, 0};
    *value = 0;
    if (read_sum(&reader, value))
        return -1;
    skip_spaces(&reader);
    return reader.at == reader.end ? 0 : expected(&reader, "an operator or the end of the expression");
}
