/* Errors of text readers: reasons that begin with the position in the text, "PATH:LINE:COLUMN: ". */
#ifndef BASE_POSITION_H
#define BASE_POSITION_H

#include "base/error.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

struct position {
    const char *path;
    uint32_t line, column; /* from 1; columns are bytes */
};

/* Sets "PATH:LINE:COLUMN: REASON". Of a path of more than 200 bytes, the end is shown. Returns -1. */
int position_fail(struct error *error, struct position position, const char *reason, va_list arguments)
    __attribute__((format(printf, 3, 0)));

/* Sets "PATH:LINE:COLUMN: found FOUND, expected EXPECTED". Returns -1. */
int position_expected(struct error *error, struct position position, const char *found, const char *expected,
                      va_list arguments) __attribute__((format(printf, 4, 0)));

enum { POSITION_QUOTED = 64, POSITION_SHOWN = 48 };

/* Writes 'TEXT' with its quotes. A text of more than `shown` bytes, at most POSITION_SHOWN, is cut between
 * UTF-8 sequences and ends with "...". Returns `quoted`. */
const char *position_quote(const char *text, size_t length, size_t shown, char quoted[POSITION_QUOTED]);

#endif
