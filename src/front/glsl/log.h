/* The information log: a line for each error and warning, with the place in the source. */
#ifndef FRONT_GLSL_LOG_H
#define FRONT_GLSL_LOG_H

#include <stdint.h>

/* A place in the sources: the number of the string, which #line can change, line and column from 1. Column
 * 0: the whole line. */
struct glsl_place {
    uint32_t line;
    uint16_t string, column;
};

struct glsl_log {
    char *text; /* GLSL_LOG_BYTES */
    unsigned used, errors;
    struct glsl_place last; /* of the last error: a second one at the same place is not reported */
};

struct glsl_context;

/* Adds a line to the log. After GLSL_ERRORS errors, or without room, further lines are counted but not
 * written. */
void glsl_error(struct glsl_context *context, struct glsl_place place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void glsl_warning(struct glsl_context *context, struct glsl_place place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
