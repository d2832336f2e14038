/* Arithmetic in the text of streams: `(frame * 10 + 90)`.
 *
 * Values are binary64. Every operation is rounded once to nearest, as IEEE 754 defines, and no operation
 * depends on the C library (sine.h), so a stream gives the same calls on every machine. A result that is not
 * finite is an error. docs/streams.md defines the syntax, expression.def the names. */
#ifndef COMMAND_STREAM_EXPRESSION_H
#define COMMAND_STREAM_EXPRESSION_H

#include "command/stream/stream.h"

struct lexer;
struct token;

enum expression_builtin {
#define BUILTIN(name, where, meaning) EXPRESSION_##name,
#include "command/stream/expression.def"
    EXPRESSION_BUILTINS
};

/* The names that have values at a place of the text. */
struct expression_scope {
    struct {
        char name[LIMIT_NAME_BYTES + 1];
        double value;
    } variable[LIMIT_VARIABLES];
    unsigned variable_count;
    double builtin[EXPRESSION_BUILTINS];
    bool known[EXPRESSION_BUILTINS];
};

/* Starts a scope without variables, at the first frame. */
void expression_start(struct expression_scope *scope);

/* Computes the expression that the token contains. Returns 0, or -1 with the position inside the token and
 * the reason in the lexer's error. */
int expression_value(struct lexer *lexer, const struct token *token, double *value);

/* Returns the number of bytes at the start of a text that are the name of a variable or function. */
size_t expression_name(const char *text, const char *end);

/* Sets a variable that has been set before, or adds it. `place` is the token with its name at the beginning,
 * `length` bytes. Fails if the name is one of expression.def, or if there are too many variables. */
int expression_set(struct lexer *lexer, const struct token *place, size_t length, double value);

/* Adds a variable. Fails also if one of this name exists. */
int expression_add(struct lexer *lexer, const struct token *place, size_t length, double value);

#endif
