#include "shader/text/scan.h"

#include "base/position.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { SHOWN_BYTES = 40, NUMBER_BYTES = 64 };

/* --- Reasons ------------------------------------------------------------------------------------------- */

static struct position position_of(const struct scanner *scanner, const struct scan_token *token,
                                   size_t offset)
{
    return (struct position){scanner->path, token->line, token->column + (uint32_t)offset};
}

int scan_fail(struct scanner *scanner, const struct scan_token *token, size_t offset, const char *reason, ...)
{
    va_list arguments;
    va_start(arguments, reason);
    position_fail(scanner->error, position_of(scanner, token, offset), reason, arguments);
    va_end(arguments);
    return -1;
}

static void expected_in(struct scanner *scanner, const char *expected, va_list arguments)
{
    const struct scan_token *token = &scanner->token;
    char quoted[POSITION_QUOTED];
    const char *found = token->type == SCAN_LINE_END ? "the end of the line"
                        : token->type == SCAN_END
                            ? "the end of the text"
                            : position_quote(token->text, token->length, SHOWN_BYTES, quoted);
    position_expected(scanner->error, position_of(scanner, token, 0), found, expected, arguments);
}

int scan_expected(struct scanner *scanner, const char *expected, ...)
{
    va_list arguments;
    va_start(arguments, expected);
    expected_in(scanner, expected, arguments);
    va_end(arguments);
    return -1;
}

int scan_expected_word(struct scanner *scanner, struct words words, struct scan_piece piece,
                       const char *expected, ...)
{
    va_list arguments;
    va_start(arguments, expected);
    expected_in(scanner, expected, arguments);
    va_end(arguments);
    return words_suggest_in(words, piece.text, piece.length, scanner->error);
}

/* --- Tokens -------------------------------------------------------------------------------------------- */

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static char ahead(const struct scanner *scanner, size_t offset)
{
    return (size_t)(scanner->end - scanner->at) > offset ? scanner->at[offset] : 0;
}

static struct scan_token place_of(const struct scanner *scanner, enum scan_type type)
{
    return (struct scan_token){type, scanner->at, 0, scanner->line,
                               (uint32_t)(scanner->at - scanner->line_start) + 1};
}

static void next_line(struct scanner *scanner)
{
    scanner->line++;
    scanner->line_start = scanner->at;
}

/* A comment between the signs of C; the scanner is at the first. */
static int skip_block(struct scanner *scanner)
{
    struct scan_token place = place_of(scanner, SCAN_SIGN);
    for (scanner->at += 2; scanner->at < scanner->end; scanner->at++) {
        if (*scanner->at == '*' && ahead(scanner, 1) == '/') {
            scanner->at += 2;
            return 0;
        }
        if (*scanner->at == '\n') {
            scanner->at++;
            next_line(scanner);
            scanner->at--;
        }
    }
    return scan_fail(scanner, &place, 0, "found a comment without an end, expected */");
}

static int skip_spaces(struct scanner *scanner)
{
    for (;;) {
        char c = ahead(scanner, 0);
        if (c == ' ' || c == '\t' || c == '\r') {
            scanner->at++;
        } else if (c == ';' || (c == '/' && ahead(scanner, 1) == '/')) {
            while (scanner->at < scanner->end && *scanner->at != '\n')
                scanner->at++;
        } else if (c == '/' && ahead(scanner, 1) == '*') {
            if (skip_block(scanner))
                return -1;
        } else {
            return 0;
        }
    }
}

/* Digits, a fraction, an exponent, an f; or 0x and hexadecimal digits. */
static void skip_number(struct scanner *scanner)
{
    if (ahead(scanner, 0) == '0' && (ahead(scanner, 1) | 32) == 'x') {
        for (scanner->at += 2; isxdigit((unsigned char)ahead(scanner, 0));)
            scanner->at++;
        return;
    }
    while (is_digit(ahead(scanner, 0)))
        scanner->at++;
    if (ahead(scanner, 0) == '.')
        do
            scanner->at++;
        while (is_digit(ahead(scanner, 0)));
    if ((ahead(scanner, 0) | 32) == 'e') {
        size_t sign = ahead(scanner, 1) == '-' || ahead(scanner, 1) == '+';
        if (is_digit(ahead(scanner, 1 + sign)))
            for (scanner->at += 1 + sign; is_digit(ahead(scanner, 0));)
                scanner->at++;
    }
    if ((ahead(scanner, 0) | 32) == 'f')
        scanner->at++;
}

int scan_next(struct scanner *scanner)
{
    struct scan_token *token = &scanner->token;
    if (token->type == SCAN_LINE_END)
        next_line(scanner);
    if (skip_spaces(scanner))
        return -1;
    *token = place_of(scanner, SCAN_SIGN);
    if (scanner->at == scanner->end) {
        token->type = SCAN_END;
        return 0;
    }
    char c = *scanner->at;
    if (is_letter(c)) {
        token->type = SCAN_WORD;
        while (is_letter(ahead(scanner, 0)) || is_digit(ahead(scanner, 0)))
            scanner->at++;
    } else if (is_digit(c) || (c == '.' && is_digit(ahead(scanner, 1)))) {
        token->type = SCAN_NUMBER;
        skip_number(scanner);
    } else if (c == '\n') {
        token->type = SCAN_LINE_END;
        scanner->at++;
    } else if (c > ' ' && c < 0x7f) {
        scanner->at++;
    } else {
        return scan_fail(scanner, token, 0, "found byte 0x%02x, expected text", (unsigned char)c);
    }
    token->length = (size_t)(scanner->at - token->text);
    return 0;
}

int scan_start(struct scanner *scanner, const char *path, const char *text, size_t bytes, struct error *error)
{
    *scanner = (struct scanner){.path = path,
                                .at = text,
                                .end = text + bytes,
                                .line_start = text,
                                .line = 1,
                                .token = {.type = SCAN_SIGN},
                                .error = error};
    return scan_next(scanner);
}

bool scan_is(const struct scanner *scanner, char sign)
{
    return scanner->token.type == SCAN_SIGN && *scanner->token.text == sign;
}

/* If the token after the sign is invalid, the sign remains current, with the reason: no token that is
 * expected next fits. */
bool scan_skip(struct scanner *scanner, char sign)
{
    return scan_is(scanner, sign) && !scan_next(scanner);
}

int scan_sign(struct scanner *scanner, char sign)
{
    if (!scan_is(scanner, sign))
        return scan_expected(scanner, "'%c'", sign);
    return scan_next(scanner);
}

/* --- Numbers ------------------------------------------------------------------------------------------- */

int scan_number(struct scanner *scanner, const char *what, uint32_t *bits)
{
    const struct scan_token *token = &scanner->token;
    char text[NUMBER_BYTES], *end;
    if (token->type != SCAN_NUMBER || token->length >= sizeof text)
        return scan_expected(scanner, "%s", what);
    memcpy(text, token->text, token->length);
    text[token->length] = 0;
    if ((text[1] | 32) == 'x') {
        if (token->length != 10)
            return scan_expected(scanner, "%s: 0x and eight digits", what);
        *bits = (uint32_t)strtoul(text, NULL, 16);
        return scan_next(scanner);
    }
    float value = strtof(text, &end);
    if (!isfinite(value) || (*end && ((*end | 32) != 'f' || end[1])))
        return scan_expected(scanner, "%s in the range of binary32", what);
    memcpy(bits, &value, sizeof value);
    return scan_next(scanner);
}

int scan_whole(struct scanner *scanner, const char *what, uint32_t high, uint32_t *whole)
{
    const struct scan_token *token = &scanner->token;
    uint64_t value = 0;
    bool good = token->type == SCAN_NUMBER && token->length <= 10;
    for (size_t i = 0; good && i < token->length; i++) {
        good = is_digit(token->text[i]);
        value = value * 10 + (uint64_t)(token->text[i] - '0');
    }
    if (!good || value > high)
        return scan_expected(scanner, "%s from 0 to %" PRIu32, what, high);
    *whole = (uint32_t)value;
    return scan_next(scanner);
}

/* --- Pieces -------------------------------------------------------------------------------------------- */

bool scan_piece_is(struct scan_piece piece, const char *name)
{
    return strlen(name) == piece.length && !strncasecmp(name, piece.text, piece.length);
}

struct scan_piece scan_piece_next(struct scan_piece *rest)
{
    const char *cut = memchr(rest->text, '_', rest->length);
    if (cut && cut + 1 == rest->text + rest->length)
        cut = NULL; /* a last underscore is part of the piece, which then matches no name */
    struct scan_piece piece = {rest->text, cut ? (size_t)(cut - rest->text) : rest->length};
    size_t taken = piece.length + (cut != NULL);
    rest->text += taken;
    rest->length -= taken;
    return piece;
}
