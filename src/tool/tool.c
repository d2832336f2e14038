#include "tool/tool.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

int fail(const struct command *self, const char *format, ...)
{
    progress(NULL);
    fprintf(stderr, "triptych%s%s: ", self->name[0] ? " " : "", self->name);
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    return STATUS_BAD;
}

void progress(const char *format, ...)
{
    static bool shown;
    if (!isatty(STDERR_FILENO) || (!format && !shown))
        return;
    fputs("\r\033[K", stderr);
    shown = format;
    if (format) {
        va_list arguments;
        va_start(arguments, format);
        vfprintf(stderr, format, arguments);
        va_end(arguments);
    }
    fflush(stderr);
}

void path_stem(const char *path, char *stem, unsigned capacity)
{
    const char *slash = strrchr(path, '/');
    snprintf(stem, capacity, "%s", slash ? slash + 1 : path);
    char *dot = strrchr(stem, '.');
    if (dot && dot != stem)
        *dot = 0;
}
