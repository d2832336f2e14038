#include "front/glsl/log.h"

#include "front/glsl/context.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void add(struct glsl_log *log, const char *format, va_list arguments)
{
    unsigned room = GLSL_LOG_BYTES - log->used;
    int length = vsnprintf(log->text + log->used, room, format, arguments);
    log->used += length < 0 ? 0 : (unsigned)length < room ? (unsigned)length : room - 1;
}

static void add_part(struct glsl_log *log, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void add_part(struct glsl_log *log, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add(log, format, arguments);
    va_end(arguments);
}

/* A line for which there is no room is left out. */
static void add_line(struct glsl_log *log, const char *kind, struct glsl_place place, const char *format,
                     va_list arguments)
{
    unsigned before = log->used;
    add_part(log, "%s: %u:%u:", kind, place.string, place.line);
    if (place.column)
        add_part(log, "%u:", place.column);
    add_part(log, " ");
    add(log, format, arguments);
    add_part(log, "\n");
    if (log->used == GLSL_LOG_BYTES - 1)
        log->text[log->used = before] = '\0';
}

static bool same_place(struct glsl_place a, struct glsl_place b)
{
    return a.line == b.line && a.string == b.string && a.column == b.column;
}

void glsl_error(struct glsl_context *context, struct glsl_place place, const char *format, ...)
{
    struct glsl_log *log = &context->log;
    if (log->errors && same_place(log->last, place))
        return;
    log->last = place;
    if (++log->errors > GLSL_ERRORS)
        return;
    va_list arguments;
    va_start(arguments, format);
    add_line(log, "ERROR", place, format, arguments);
    va_end(arguments);
}

void glsl_warning(struct glsl_context *context, struct glsl_place place, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_line(&context->log, "WARNING", place, format, arguments);
    va_end(arguments);
}
