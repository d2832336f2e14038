/* The text of a shader as tokens with their places.
 *
 * A token is a word (letters, digits and underscores, not beginning with a digit), a number, one punctuation
 * character, the end of a line, or the end of the text. Comments (from ; or // to the line's end, and between
 * the signs of C) count as spaces. */
#ifndef SHADER_TEXT_SCAN_H
#define SHADER_TEXT_SCAN_H

#include "base/error.h"
#include "base/words.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum scan_type { SCAN_WORD, SCAN_NUMBER, SCAN_SIGN, SCAN_LINE_END, SCAN_END };

struct scan_token {
    enum scan_type type;
    const char *text;
    size_t length;
    uint32_t line, column; /* from 1; columns are bytes */
};

/* A run of a word's bytes that ends at `_` or at the word's end. */
struct scan_piece {
    const char *text;
    size_t length;
};

struct scanner {
    const char *path, *at, *end, *line_start;
    uint32_t line;
    struct scan_token token; /* the current one */
    struct error *error;
};

/* Starts at the first token. Fails if the text has control characters, or characters outside ASCII except in
 * comments. */
int scan_start(struct scanner *scanner, const char *path, const char *text, size_t bytes,
               struct error *error);

/* Advances to the next token. */
int scan_next(struct scanner *scanner);

/* Sets "PATH:LINE:COLUMN: found TOKEN, expected EXPECTED" for the current token. Returns -1. */
int scan_expected(struct scanner *scanner, const char *expected, ...) __attribute__((format(printf, 2, 3)));

/* The same for a piece of the token that is not in a list: adds the nearest word of the list to the
 * reason. */
int scan_expected_word(struct scanner *scanner, struct words words, struct scan_piece piece,
                       const char *expected, ...) __attribute__((format(printf, 4, 5)));

/* Sets "PATH:LINE:COLUMN: REASON" for a place `offset` bytes after the token's beginning. Returns -1. */
int scan_fail(struct scanner *scanner, const struct scan_token *place, size_t offset, const char *reason, ...)
    __attribute__((format(printf, 4, 5)));

bool scan_is(const struct scanner *scanner, char sign);

/* Advances if the sign is the current token. */
bool scan_skip(struct scanner *scanner, char sign);

/* Advances past the sign, or fails because it was expected. */
int scan_sign(struct scanner *scanner, char sign);

/* Reads the current token and advances. A number is decimal, with an optional fraction, exponent or f, in the
 * range of binary32; or 0x and the eight digits of its bits. `what` names it in the reason. */
int scan_number(struct scanner *scanner, const char *what, uint32_t *bits);

/* A whole decimal number from 0 to `high`. */
int scan_whole(struct scanner *scanner, const char *what, uint32_t high, uint32_t *whole);

/* Returns true if the piece is the name, in small letters or large. */
bool scan_piece_is(struct scan_piece piece, const char *name);

/* Removes the next piece of a word from `rest`, and the `_` after it. `rest` is empty at the end. */
struct scan_piece scan_piece_next(struct scan_piece *rest);

#endif
