/* `triptych run`: starts a program of Windows with Wine and Triptych's Direct3D 9, or a program of Linux with
 * Triptych's OpenGL ES. */
#include "base/file.h"
#include "command/run/place.h"
#include "command/support/choose.h"
#include "command/support/option.h"
#include "triptych.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { THREADS_MAXIMUM = 256 };

struct settings {
    const char *engine, *record, *prefix, *wine;
    unsigned threads; /* 0: not given */
    bool gl;          /* a program of Linux, whatever its file is */
};

/* Sets a variable to `value`, with `separator` and its old value after it. */
static int extend(const char *name, const char *value, char separator)
{
    const char *old = getenv(name);
    size_t bytes = strlen(value) + (old ? strlen(old) : 0) + 2;
    char *joined = malloc(bytes);
    if (!joined)
        return -1;
    if (old && *old)
        snprintf(joined, bytes, "%s%c%s", value, separator, old);
    else
        snprintf(joined, bytes, "%s", value);
    int status = setenv(name, joined, 1);
    free(joined);
    return status;
}

/* Wine reads the overrides in order, and the last one of a name holds. */
static int set_overrides(void)
{
    const char *old = getenv("WINEDLLOVERRIDES");
    if (!old || !*old)
        return setenv("WINEDLLOVERRIDES", "d3d9=n", 1);
    size_t bytes = strlen(old) + sizeof ";d3d9=n";
    char *joined = malloc(bytes);
    if (!joined)
        return -1;
    snprintf(joined, bytes, "%s;d3d9=n", old);
    int status = setenv("WINEDLLOVERRIDES", joined, 1);
    free(joined);
    return status;
}

static int set_wine(const char *files, const char *prefix)
{
    return setenv("WINEPREFIX", prefix, 1) || extend("WINEDLLPATH", files, ':') || set_overrides() ||
           setenv("WINEDEBUG", "-all", 0);
}

static int set_renderer(const struct settings *settings, const char *record)
{
    char threads[16];
    snprintf(threads, sizeof threads, "%u", settings->threads);
    return (settings->engine && setenv("TRIPTYCH_ENGINE", settings->engine, 1)) ||
           (settings->threads && setenv("TRIPTYCH_THREADS", threads, 1)) ||
           (settings->record && setenv("TRIPTYCH_RECORD", record, 1));
}

/* Wine finds programs of its own, such as notepad, without a path. */
static int check_program(const struct command *self, const char *program)
{
    if (!strchr(program, '/') || !access(program, R_OK))
        return STATUS_OK;
    return tool_fail(self, "%s: %s", program, strerror(errno));
}

static int check(const struct command *self, const struct settings *settings, const char *program)
{
    unsigned index;
    if (settings->engine && choose_engine(self, settings->engine, 0, &index))
        return STATUS_BAD;
    if (settings->record && file_is_standard(settings->record))
        return tool_fail(self, "--record is \"-\", expected a file: the program has the standard output");
    return check_program(self, program) || tool_check_output(self, settings->record);
}

static int start(const struct command *self, const char *program, char **arguments)
{
    execvp(program, arguments);
    return tool_fail(self, "%s: cannot start: %s", program, strerror(errno));
}

static int start_wine(const struct command *self, const char *wine, const struct operands *operands)
{
    char **arguments = calloc((size_t)operands->count + 2, sizeof *arguments);
    if (!arguments)
        return tool_fail(self, "no memory for the arguments");
    arguments[0] = (char *)wine;
    memcpy(arguments + 1, operands->value, (size_t)operands->count * sizeof *arguments);
    int status = start(self, wine, arguments);
    free(arguments);
    return status;
}

static int start_native(const struct command *self, const struct operands *operands)
{
    char **arguments = calloc((size_t)operands->count + 1, sizeof *arguments);
    if (!arguments)
        return tool_fail(self, "no memory for the arguments");
    memcpy(arguments, operands->value, (size_t)operands->count * sizeof *arguments);
    int status = start(self, operands->value[0], arguments);
    free(arguments);
    return status;
}

/* OpenGL ES: libglvnd reads only the named file. */
static int run_native(const struct command *self, const struct settings *settings,
                      const struct operands *operands, const char *record)
{
    char vendor[PATH_MAX];
    struct error error = {""};
    if (place_vendor(vendor, &error))
        return tool_fail(self, "%s", error.text);
    if (setenv("__EGL_VENDOR_LIBRARY_FILENAMES", vendor, 1) || set_renderer(settings, record))
        return tool_fail(self, "no memory for the environment");
    return start_native(self, operands);
}

/* Without Wine a name is that of a file, because only Wine has programs of its own. */
static int fail_without_wine(const struct command *self, const char *wine, const char *program)
{
    if (!strchr(program, '/') && access(program, F_OK))
        return tool_fail(self, "%s: not found, expected a program that PATH has, or a file", program);
    return tool_fail(self, "%s: not found, expected Wine's program (Debian: apt-get install wine64)", wine);
}

static int run_wine(const struct command *self, const struct settings *settings,
                    const struct operands *operands, const char *record)
{
    char files[PATH_MAX], prefix[PATH_MAX];
    struct error error = {""};
    if (!file_is_program(settings->wine))
        return fail_without_wine(self, settings->wine, operands->value[0]);
    if (place_files(files, &error) || place_prefix(settings->prefix, prefix, &error) ||
        place_make_prefix(settings->wine, prefix, &error) || place_install(files, prefix, &error))
        return tool_fail(self, "%s", error.text);
    if (set_wine(files, prefix) || set_renderer(settings, record))
        return tool_fail(self, "no memory for the environment");
    return start_wine(self, settings->wine, operands);
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    char record[PATH_MAX] = "";
    struct error error = {""};
    if (check(self, settings, operands->value[0]))
        return STATUS_BAD;
    if (settings->record && place_absolute(settings->record, record, &error))
        return tool_fail(self, "%s", error.text);
    const bool native = settings->gl || place_is_native(operands->value[0]);
    return (native ? run_native : run_wine)(self, settings, operands, record);
}

static const char notes[] =
    "All that follows PROGRAM is for the program. Its exit status is that of this command. An ELF file or a\n"
    "script is a program of Linux, which gets Triptych's EGL; all others are programs of Windows. For these "
    "the\n"
    "prefix gets two files, d3d9.dll and triptych9.dll; programs that are started without this command use\n"
    "Wine's own d3d9.dll. Recordings are streams for the other commands. See docs/direct3d.md and\n"
    "docs/opengles.md.";

static const struct option options[] = {
    {"engine", "NAME", "the engine, one of triptych list engines; specialize",
     OPTION_IS_WORD(struct settings, engine), .words = triptych_engine_name, .suffixed = true},
    {"threads", "N", "threads that draw; 1", OPTION_IS_NUMBER(struct settings, threads), .least = 1,
     .most = THREADS_MAXIMUM},
    {"record", "FILE", "record what is drawn, as a container", OPTION_IS_FILE(struct settings, record),
     .extension = "trib"},
    {"gl", NULL, "the program is one of Linux: OpenGL ES through EGL", OPTION_IS_FLAG(struct settings, gl)},
    {"prefix", "DIR", "Wine's prefix, made if it is missing; WINEPREFIX, or ~/.wine",
     OPTION_IS_FOLDER(struct settings, prefix)},
    {"wine", "PROGRAM", "Wine's program; wine", OPTION_IS_TEXT(struct settings, wine)},
    {0},
};

static const struct operand operands[] = {
    {"PROGRAM", "a program of Windows, or of Linux with OpenGL ES", .kind = OPERAND_TEXT, .extension = "exe",
     .ends_options = true},
    {"ARGUMENT", "for the program", .kind = OPERAND_TEXT, .optional = true, .repeated = true},
    {0},
};

static const struct settings defaults = {.wine = "wine"};

const struct command command_run = {
    .name = "run",
    .summary = "start a program on Direct3D 9 or OpenGL ES",
    .options = options,
    .operands = operands,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof(struct settings),
    .run = run,
};
