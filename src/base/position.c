#include "base/position.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { PATH_SHOWN = 200 };

static int set(struct error *error, struct position position, const char *text)
{
    size_t length = strlen(position.path);
    bool cut = length > PATH_SHOWN;
    return error_set(error, "%s%s:%" PRIu32 ":%" PRIu32 ": %s", cut ? "..." : "",
                     position.path + (cut ? length - PATH_SHOWN : 0), position.line, position.column, text);
}

int position_fail(struct error *error, struct position position, const char *reason, va_list arguments)
{
    char text[ERROR_CAPACITY];
    vsnprintf(text, sizeof text, reason, arguments);
    return set(error, position, text);
}

int position_expected(struct error *error, struct position position, const char *found, const char *expected,
                      va_list arguments)
{
    char text[ERROR_CAPACITY];
    int length = snprintf(text, sizeof text, "found %s, expected ", found);
    if (length < (int)sizeof text)
        vsnprintf(text + length, sizeof text - (size_t)length, expected, arguments);
    return set(error, position, text);
}

const char *position_quote(const char *text, size_t length, size_t shown, char quoted[POSITION_QUOTED])
{
    size_t end = length;
    if (length > shown)
        for (end = shown; end && ((unsigned char)text[end] & 0xc0) == 0x80; end--)
            ;
    snprintf(quoted, POSITION_QUOTED, "'%.*s%s'", (int)end, text, end < length ? "..." : "");
    return quoted;
}
