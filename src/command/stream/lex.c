#include "command/stream/lex.h"

#include "base/position.h"
#include "command/stream/expression.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBER_BYTES = 128 };

/* --- Reasons -------------------------------------------------------------------------------------------- */

static struct position position_of(const struct lexer *lexer, const struct token *token)
{
    return (struct position){lexer->path, token->line, token->column};
}

int lex_fail(struct lexer *lexer, const struct token *token, const char *reason, ...)
{
    va_list arguments;
    va_start(arguments, reason);
    position_fail(lexer->error, position_of(lexer, token), reason, arguments);
    va_end(arguments);
    return -1;
}

static void expected_in(struct lexer *lexer, const char *expected, va_list arguments)
{
    const struct token *token = &lexer->token;
    char quoted[POSITION_QUOTED];
    const char *found = token->type == TOKEN_LINE_END ? "the end of the line"
                        : token->type == TOKEN_END
                            ? "the end of the file"
                            : position_quote(token->text, token->length, POSITION_SHOWN, quoted);
    position_expected(lexer->error, position_of(lexer, token), found, expected, arguments);
}

int lex_expected(struct lexer *lexer, const char *expected, ...)
{
    va_list arguments;
    va_start(arguments, expected);
    expected_in(lexer, expected, arguments);
    va_end(arguments);
    return -1;
}

int lex_expected_word(struct lexer *lexer, struct words words, const char *expected, ...)
{
    const struct token *token = &lexer->token;
    va_list arguments;
    va_start(arguments, expected);
    expected_in(lexer, expected, arguments);
    va_end(arguments);
    if (token->type == TOKEN_WORD)
        words_suggest_in(words, token->text, token->length, lexer->error);
    return -1;
}

/* --- The text as a whole -------------------------------------------------------------------------------- */

/* Bytes of the UTF-8 sequence at `at`, or 0 if there is no valid one (Unicode 15, table 3-7). */
static size_t sequence_length(const unsigned char *at, size_t left)
{
    static const struct {
        unsigned char first, last, low, high, length;
    } rows[] = {
        {0x00, 0x7f, 0, 0, 1},       {0xc2, 0xdf, 0x80, 0xbf, 2}, {0xe0, 0xe0, 0xa0, 0xbf, 3},
        {0xe1, 0xec, 0x80, 0xbf, 3}, {0xed, 0xed, 0x80, 0x9f, 3}, {0xee, 0xef, 0x80, 0xbf, 3},
        {0xf0, 0xf0, 0x90, 0xbf, 4}, {0xf1, 0xf3, 0x80, 0xbf, 4}, {0xf4, 0xf4, 0x80, 0x8f, 4},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        size_t length = rows[i].length;
        if (*at < rows[i].first || *at > rows[i].last)
            continue;
        if (length > left || (length > 1 && (at[1] < rows[i].low || at[1] > rows[i].high)))
            return 0;
        for (size_t j = 2; j < length; j++)
            if ((at[j] & 0xc0) != 0x80)
                return 0;
        return length;
    }
    return 0;
}

static bool is_text(unsigned char byte, bool before_line_feed)
{
    return (byte >= ' ' && byte != 0x7f) || byte == '\t' || byte == '\n' ||
           (byte == '\r' && before_line_feed);
}

bool lex_is_utf8(const char *text, size_t bytes)
{
    size_t length;
    for (const char *at = text; at < text + bytes; at += length)
        if (!(length = sequence_length((const unsigned char *)at, (size_t)(text + bytes - at))))
            return false;
    return true;
}

static int check_text(struct lexer *lexer)
{
    struct token place = {.line = 1};
    const char *line_start = lexer->at;
    size_t length;
    for (const char *at = lexer->at; at < lexer->end; at += length) {
        place.column = (uint32_t)(at - line_start) + 1;
        length = sequence_length((const unsigned char *)at, (size_t)(lexer->end - at));
        if (!length)
            return lex_fail(lexer, &place, "found byte 0x%02x, expected UTF-8", (unsigned char)*at);
        if (!is_text((unsigned char)*at, at + 1 < lexer->end && at[1] == '\n'))
            return lex_fail(lexer, &place, "found control character 0x%02x, expected text",
                            (unsigned char)*at);
        if (place.column > LIMIT_LINE_BYTES && *at != '\n')
            return lex_fail(lexer, &place, "found a longer line, expected at most %d bytes",
                            LIMIT_LINE_BYTES);
        if (*at == '\n') {
            line_start = at + 1;
            place.line++;
        }
    }
    return 0;
}

/* --- Tokens --------------------------------------------------------------------------------------------- */

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static bool ends_word(char c)
{
    return is_space(c) || c == '\n' || c == '{' || c == '}' || c == '"' || c == '#';
}

static int read_string(struct lexer *lexer)
{
    const char *at = lexer->at + 1;
    while (at < lexer->end && *at != '"' && *at != '\n')
        at += *at == '\\' && at + 1 < lexer->end && at[1] != '\n' ? 2 : 1;
    if (at >= lexer->end || *at != '"')
        return lex_fail(lexer, &lexer->token,
                        "found a string without an end, expected '\"' on the same line");
    lexer->at = at + 1;
    return 0;
}

/* Ends after the parenthesis that closes the first one. */
static int read_expression(struct lexer *lexer)
{
    unsigned open = 0;
    for (const char *at = lexer->at; at < lexer->end && *at != '\n' && *at != '#'; at++) {
        open += *at == '(';
        open -= *at == ')';
        if (!open) {
            lexer->at = at + 1;
            return 0;
        }
    }
    return lex_fail(lexer, &lexer->token, "found an expression without an end, expected ) on the same line");
}

static void skip_spaces_and_comment(struct lexer *lexer)
{
    while (lexer->at < lexer->end && is_space(*lexer->at))
        lexer->at++;
    if (lexer->at < lexer->end && *lexer->at == '#')
        while (lexer->at < lexer->end && *lexer->at != '\n')
            lexer->at++;
}

int lex_next(struct lexer *lexer)
{
    struct token *token = &lexer->token;
    if (token->type == TOKEN_LINE_END) {
        lexer->line++;
        lexer->line_start = lexer->at;
    }
    skip_spaces_and_comment(lexer);
    *token =
        (struct token){TOKEN_WORD, lexer->at, 0, lexer->line, (uint32_t)(lexer->at - lexer->line_start) + 1};
    if (lexer->at == lexer->end) {
        token->type = TOKEN_END;
        return 0;
    }
    char c = *lexer->at;
    if (c == '"') {
        token->type = TOKEN_STRING;
        if (read_string(lexer))
            return -1;
    } else if (c == '(' && lexer->scope) {
        token->type = TOKEN_EXPRESSION;
        if (read_expression(lexer))
            return -1;
    } else if (c == '\n' || c == '{' || c == '}') {
        token->type = c == '\n' ? TOKEN_LINE_END : c == '{' ? TOKEN_OPEN : TOKEN_CLOSE;
        lexer->at++;
    } else {
        while (lexer->at < lexer->end && !ends_word(*lexer->at))
            lexer->at++;
    }
    token->length = (size_t)(lexer->at - token->text);
    return 0;
}

int lex_start(struct lexer *lexer, const char *path, const char *text, size_t bytes, struct error *error)
{
    *lexer = (struct lexer){
        .path = path, .at = text, .end = text + bytes, .line_start = text, .line = 1, .error = error};
    if (check_text(lexer))
        return -1;
    return lex_next(lexer);
}

bool lex_is(const struct lexer *lexer, const char *word)
{
    return lexer->token.type == TOKEN_WORD && strlen(word) == lexer->token.length &&
           !memcmp(word, lexer->token.text, lexer->token.length);
}

bool lex_is_value(const struct lexer *lexer)
{
    return lexer->token.type == TOKEN_WORD || lexer->token.type == TOKEN_EXPRESSION;
}

bool lex_is_digits(const struct lexer *lexer)
{
    const struct token *token = &lexer->token;
    return token->type == TOKEN_EXPRESSION ||
           (token->type == TOKEN_WORD && *token->text >= '0' && *token->text <= '9');
}

int lex_rest(struct lexer *lexer, const char *at, struct token *rest)
{
    const char *end = at;
    *rest = lexer->token;
    rest->text = at;
    rest->column = (uint32_t)(at - lexer->line_start) + 1;
    while (end < lexer->end && *end != '\n' && *end != '\r' && *end != '#')
        end++;
    rest->length = (size_t)(end - at);
    lexer->at = end;
    return lex_next(lexer);
}

bool lex_ends_line(const struct lexer *lexer)
{
    return lexer->token.type == TOKEN_LINE_END || lexer->token.type == TOKEN_END;
}

int lex_line_end(struct lexer *lexer)
{
    if (lexer->token.type == TOKEN_END)
        return 0;
    if (lexer->token.type != TOKEN_LINE_END)
        return lex_expected(lexer, "the end of the line");
    return lex_next(lexer);
}

int lex_lines(struct lexer *lexer, const char **text, size_t *bytes)
{
    const char *at = lexer->at, *first;
    uint32_t line = lexer->line + 1;
    for (*text = at; at < lexer->end; line++) {
        for (first = at; first < lexer->end && is_space(*first); first++)
            ;
        if (first < lexer->end && *first == '}') {
            *bytes = (size_t)(at - *text);
            lexer->token.type = TOKEN_CLOSE;
            lexer->line = line;
            lexer->line_start = at;
            lexer->at = first;
            return lex_next(lexer);
        }
        while (at < lexer->end && *at++ != '\n')
            ;
    }
    return lex_fail(lexer, &lexer->token, "found a block without an end, expected a line that begins with }");
}

int lex_skip_lines(struct lexer *lexer)
{
    while (lexer->token.type == TOKEN_LINE_END)
        if (lex_next(lexer))
            return -1;
    return 0;
}

/* --- Values --------------------------------------------------------------------------------------------- */

/* The C library also reads "inf", "nan(1)" and the like, which have no place in a stream. */
static bool looks_like_number(const char *text)
{
    text += *text == '-' || *text == '+';
    text += *text == '.';
    return *text >= '0' && *text <= '9';
}

/* Copies the current word, for functions that need a terminating zero. */
static int copy_word(struct lexer *lexer, char word[NUMBER_BYTES])
{
    if (lexer->token.type != TOKEN_WORD || lexer->token.length >= NUMBER_BYTES)
        return -1;
    memcpy(word, lexer->token.text, lexer->token.length);
    word[lexer->token.length] = 0;
    return 0;
}

/* Sets the reason of an expression whose value is not `expected`. */
static int unexpected_value(struct lexer *lexer, double value, const char *expected, ...)
{
    char quoted[POSITION_QUOTED], found[POSITION_QUOTED + 48];
    const struct token *token = &lexer->token;
    snprintf(found, sizeof found, "%s, which is %.10g",
             position_quote(token->text, token->length, POSITION_SHOWN, quoted), value);
    va_list arguments;
    va_start(arguments, expected);
    position_expected(lexer->error, position_of(lexer, token), found, expected, arguments);
    va_end(arguments);
    return -1;
}

/* Reads an expression whose value is finite in binary32. */
static int read_real(struct lexer *lexer, const char *what, double *number)
{
    if (expression_value(lexer, &lexer->token, number))
        return -1;
    if (!isfinite((float)*number))
        return unexpected_value(lexer, *number, "a number (%s) in the range of binary32", what);
    return lex_next(lexer);
}

/* Reads an expression whose value is an integer from `low` to `high`. */
static int read_whole(struct lexer *lexer, const char *what, int64_t low, int64_t high, int64_t *integer)
{
    double value;
    if (expression_value(lexer, &lexer->token, &value))
        return -1;
    if (value != floor(value) || value < (double)low || value > (double)high)
        return unexpected_value(lexer, value, "an integer (%s) from %" PRId64 " to %" PRId64, what, low,
                                high);
    *integer = (int64_t)value;
    return lex_next(lexer);
}

/* Reads a number that is finite in binary32. A word is rounded to binary32 if `single`, else to binary64. */
static int read_number(struct lexer *lexer, const char *what, bool single, double *number)
{
    char word[NUMBER_BYTES], *end;
    if (lexer->token.type == TOKEN_EXPRESSION)
        return read_real(lexer, what, number);
    if (copy_word(lexer, word) || !looks_like_number(word))
        return lex_expected(lexer, "a number (%s)", what);
    *number = single ? (double)strtof(word, &end) : strtod(word, &end);
    if (*end || !isfinite((float)*number))
        return lex_expected(lexer, "a number (%s) in the range of binary32", what);
    return lex_next(lexer);
}

int lex_number(struct lexer *lexer, const char *what, float *number)
{
    double value;
    if (read_number(lexer, what, true, &value))
        return -1;
    *number = (float)value;
    return 0;
}

int lex_double(struct lexer *lexer, const char *what, double *number)
{
    return read_number(lexer, what, false, number);
}

int lex_any_number(struct lexer *lexer, const char *what, float *number)
{
    static const char prefix[] = "bits:";
    const struct token *token = &lexer->token;
    size_t skip = sizeof prefix - 1;
    uint32_t bits;
    if (token->type != TOKEN_WORD || token->length != skip + 8 || memcmp(token->text, prefix, skip))
        return lex_number(lexer, what, number);
    lexer->token.text += skip;
    lexer->token.length -= skip;
    if (lex_color(lexer, what, &bits))
        return -1;
    memcpy(number, &bits, sizeof bits);
    return 0;
}

bool lex_half_bits(const struct lexer *lexer, int64_t *bits)
{
    const struct token *token = &lexer->token;
    if (token->type != TOKEN_WORD || token->length != 9 || memcmp(token->text, "bits:", 5))
        return false;
    *bits = 0;
    for (int i = 5; i < 9; i++) {
        int digit = lex_hexadecimal_digit(token->text[i]);
        if (digit < 0)
            return false;
        *bits = *bits << 4 | digit;
    }
    return true;
}

int lex_numbers(struct lexer *lexer, const char *what, float *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (lex_number(lexer, what, &numbers[i]))
            return -1;
    return 0;
}

int lex_integer(struct lexer *lexer, const char *what, int64_t low, int64_t high, int64_t *integer)
{
    if (lexer->token.type == TOKEN_EXPRESSION)
        return read_whole(lexer, what, low, high, integer);
    const char *at = lexer->token.text, *end = at + lexer->token.length;
    bool negative = false, good = lexer->token.type == TOKEN_WORD;
    int64_t value = 0;
    if (good && (*at == '-' || *at == '+'))
        negative = *at++ == '-';
    good = good && at < end && end - at <= 18;
    for (; good && at < end; at++) {
        good = *at >= '0' && *at <= '9';
        value = value * 10 + (*at - '0');
    }
    value = negative ? -value : value;
    if (!good || value < low || value > high)
        return lex_expected(lexer, "an integer (%s) from %" PRId64 " to %" PRId64, what, low, high);
    *integer = value;
    return lex_next(lexer);
}

int lex_hexadecimal_digit(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    c |= 32;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

int lex_color(struct lexer *lexer, const char *what, uint32_t *color)
{
    const char *text = lexer->token.text;
    size_t length = lexer->token.length;
    uint32_t value = 0;
    int64_t integer;
    if (lexer->token.type == TOKEN_EXPRESSION) {
        if (read_whole(lexer, what, 0, UINT32_MAX, &integer))
            return -1;
        *color = (uint32_t)integer;
        return 0;
    }
    bool good = lexer->token.type == TOKEN_WORD;
    if (good && length == 10 && text[0] == '0' && (text[1] | 32) == 'x') {
        text += 2;
        length -= 2;
    }
    good = good && length == 8;
    for (size_t i = 0; good && i < 8; i++) {
        int digit = lex_hexadecimal_digit(text[i]);
        good = digit >= 0;
        value = value << 4 | (uint32_t)(digit & 15);
    }
    if (!good)
        return lex_expected(lexer, "a color (%s): 0x and eight hexadecimal digits AARRGGBB", what);
    *color = value;
    return lex_next(lexer);
}

int lex_string(struct lexer *lexer, const char *what, char **string)
{
    const struct token *token = &lexer->token;
    if (token->type != TOKEN_STRING)
        return lex_expected(lexer, "%s in double quotes", what);
    char *out = malloc(token->length);
    size_t length = 0;
    if (!out)
        return lex_fail(lexer, token, "not enough memory");
    for (const char *at = token->text + 1; at < token->text + token->length - 1; at++) {
        if (*at == '\\' && *++at != '"' && *at != '\\') {
            free(out);
            return lex_expected(lexer, "%s in which \\ is only followed by \" or \\", what);
        }
        out[length++] = *at;
    }
    out[length] = 0;
    *string = out;
    if (!lex_next(lexer))
        return 0;
    free(out);
    *string = NULL;
    return -1;
}
