#include "command/support/tool.h"
#include "base/file.h"
#include "command/support/command.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_CAPACITY = 4096, CHOICES_CAPACITY = 1024 };

static bool incomplete, failed;
static FILE *output; /* `stdout` as it was before tool_print_to_error, or null */

static void print_failure(const struct command *self, const char *format, va_list arguments)
{
    tool_progress(NULL);
    fprintf(stderr, "triptych%s%s: ", self->name[0] ? " " : "", self->name);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
}

int tool_fail(const struct command *self, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_failure(self, format, arguments);
    va_end(arguments);
    return STATUS_BAD;
}

int tool_fail_word(const struct command *self, const char *what, const char *given, struct words words)
{
    char choices[CHOICES_CAPACITY], suggestion[WORDS_SUGGESTION];
    words_join(words, choices, sizeof choices);
    return tool_fail(self, "%s \"%s\", expected one of: %s%s", what, given, choices,
                     words_suggest(words, given, strlen(given), suggestion));
}

void tool_fail_at_end(const struct command *self, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_failure(self, format, arguments);
    va_end(arguments);
    failed = true;
}

bool tool_has_failed(void)
{
    return failed;
}

void tool_report_begin(void)
{
    incomplete = failed = false;
}

void tool_report_mark_incomplete(void)
{
    incomplete = true;
}

bool tool_report_is_complete(void)
{
    return !incomplete;
}

/* glibc documents that `stdout` is a variable that can be set. */
void tool_print_to_error(void)
{
    if (!output)
        output = stdout;
    stdout = stderr;
}

void tool_print_to_output(void)
{
    if (output)
        stdout = output;
    output = NULL;
}

void tool_progress(const char *format, ...)
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

int tool_check_output(const struct command *self, const char *path)
{
    char folder[PATH_CAPACITY];
    struct stat found;
    if (!path || !strcmp(path, file_standard_output))
        return STATUS_OK;
    if (!stat(path, &found)) {
        if (S_ISDIR(found.st_mode))
            return tool_fail(self, "%s: cannot be written: it is a folder", path);
        if (!access(path, W_OK))
            return STATUS_OK;
    } else if (errno == ENOENT) {
        const char *slash = strrchr(path, '/');
        snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 1, slash ? path : ".");
        if (!access(folder, W_OK))
            return STATUS_OK;
    }
    return tool_fail(self, "%s: cannot be written: %s", path, strerror(errno));
}

int tool_check_picture(const struct command *self, const char *path)
{
    struct stat found;
    const char *dot = path ? strrchr(path, '.') : NULL;
    const bool named = dot && !strcmp(dot, ".png");
    if (path && !named && strcmp(path, file_standard_output) &&
        (stat(path, &found) || S_ISREG(found.st_mode)))
        return tool_fail(self, "%s: unknown kind of picture, expected .png", path);
    return tool_check_output(self, path);
}

bool tool_is_same_file(const char *first, const char *second)
{
    struct stat a, b;
    return !stat(first, &a) && S_ISREG(a.st_mode) && !stat(second, &b) && a.st_dev == b.st_dev &&
           a.st_ino == b.st_ino;
}

int tool_make_folder(const struct command *self, const char *path, bool *made)
{
    struct stat found;
    *made = path && !mkdir(path, 0777);
    if (!path || *made)
        return STATUS_OK;
    if (errno != EEXIST)
        return tool_fail(self, "%s: cannot make the folder: %s", path, strerror(errno));
    if (!stat(path, &found) && !S_ISDIR(found.st_mode))
        return tool_fail(self, "%s: is not a folder", path);
    return access(path, W_OK | X_OK) ? tool_fail(self, "%s: cannot be written: %s", path, strerror(errno))
                                     : STATUS_OK;
}

void tool_path_stem(const char *path, char *stem, unsigned capacity)
{
    const char *slash = strrchr(path, '/');
    snprintf(stem, capacity, "%s", slash ? slash + 1 : path);
    char *dot = strrchr(stem, '.');
    if (dot && dot != stem)
        *dot = 0;
}
