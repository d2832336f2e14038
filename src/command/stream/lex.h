/* The text of a draw stream as tokens with their positions.
 *
 * A token is a word (everything up to a space, `{`, `}`, `"` or `#`), a string, a brace, the end of a line,
 * or the end of the text. Callers interpret words. The functions below read the current token as a value,
 * report an error if it is another one, and advance to the next token. */
#ifndef COMMAND_STREAM_LEX_H
#define COMMAND_STREAM_LEX_H

#include "base/error.h"
#include "base/words.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum token_type {
    TOKEN_WORD,
    TOKEN_EXPRESSION,
    TOKEN_STRING,
    TOKEN_OPEN,
    TOKEN_CLOSE,
    TOKEN_LINE_END,
    TOKEN_END
};

struct expression_scope;

struct token {
    enum token_type type;
    const char *text; /* strings include their quotes, expressions their parentheses */
    size_t length;
    uint32_t line, column; /* from 1; columns are bytes */
};

struct lexer {
    const char *path;
    const char *at, *end, *line_start;
    uint32_t line;
    struct token token;             /* the current one */
    struct expression_scope *scope; /* null: the text has no expressions */
    struct error *error;
};

/* Starts at the first token, without a scope. Fails if the text is not UTF-8, has control characters, or has
 * a line that is too long. The locale of the thread must have a decimal point. */
int lex_start(struct lexer *lexer, const char *path, const char *text, size_t bytes, struct error *error);

/* Returns nonzero if the bytes are valid UTF-8 without control characters. */
bool lex_is_utf8(const char *text, size_t bytes);

/* Advances to the next token. Fails at a string or an expression that does not end on its line. */
int lex_next(struct lexer *lexer);

/* Sets "PATH:LINE:COLUMN: found TOKEN, expected EXPECTED" for the current token. Returns -1. */
int lex_expected(struct lexer *lexer, const char *expected, ...) __attribute__((format(printf, 2, 3)));

/* The same for a word that is not in a list: adds the nearest word of the list to the reason. */
int lex_expected_word(struct lexer *lexer, struct words words, const char *expected, ...)
    __attribute__((format(printf, 3, 4)));

/* Sets "PATH:LINE:COLUMN: REASON" for a token. Returns -1. */
int lex_fail(struct lexer *lexer, const struct token *place, const char *reason, ...)
    __attribute__((format(printf, 3, 4)));

bool lex_is(const struct lexer *lexer, const char *word);

/* Returns true if the current token is the end of the line or of the text. */
bool lex_ends_line(const struct lexer *lexer);

/* Returns true if the current token can be a number: a word or an expression. */
bool lex_is_value(const struct lexer *lexer);

/* Returns true if the current token is an expression or begins with a digit. */
bool lex_is_digits(const struct lexer *lexer);

/* Read a finite number, an integer from `low` to `high`, or a colour 0xAARRGGBB, or an expression with such a
 * value. `what` names it in the reason. */
int lex_number(struct lexer *lexer, const char *what, float *number);
/* Reads any number. Infinities and NaN are written as bits: and the eight hexadecimal digits of a
 * binary32. */
int lex_any_number(struct lexer *lexer, const char *what, float *number);
/* Returns true if the current token is bits: and the four digits of a binary16, and reads them. */
bool lex_half_bits(const struct lexer *lexer, int64_t *bits);
int lex_double(struct lexer *lexer, const char *what, double *number);
int lex_numbers(struct lexer *lexer, const char *what, float *numbers, size_t count);
int lex_integer(struct lexer *lexer, const char *what, int64_t low, int64_t high, int64_t *integer);
int lex_color(struct lexer *lexer, const char *what, uint32_t *color);

/* Returns the value of a hexadecimal digit, or -1. */
int lex_hexadecimal_digit(char c);

/* Reads a string, which the caller frees. */
int lex_string(struct lexer *lexer, const char *what, char **string);

/* Sets *rest to the text from `at`, in the current line, up to the end of the line or a comment. Advances to
 * the end of the line. */
int lex_rest(struct lexer *lexer, const char *at, struct token *rest);

/* Reads the end of the line. */
int lex_line_end(struct lexer *lexer);

/* At the end of a line: reads the following lines unchanged, up to a line that begins with }, which is the
 * next token. */
int lex_lines(struct lexer *lexer, const char **text, size_t *bytes);

/* Skips empty lines. */
int lex_skip_lines(struct lexer *lexer);

#endif
