/* `triptych run`: starts a program of Windows with Wine and Triptych's Direct3D 9, or a program of Linux with
 * Triptych's OpenGL ES. */
#include "base/file.h"
#include "command/run/place.h"
#include "command/run/executable.h"
#include "command/run/start.h"
#include "command/support/choose.h"
#include "command/support/option.h"
#include "triptych.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

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
           (record && setenv("TRIPTYCH_RECORD", record, 1));
}

static int check(const struct command *self, const struct settings *settings, const char *program)
{
    unsigned index;
    if (settings->engine && choose_engine(self, settings->engine, 0, &index))
        return STATUS_BAD;
    if (settings->record && file_is_standard(settings->record))
        return tool_fail(self, "--record is \"-\", expected a file: the program has the standard output");
    if (settings->record && tool_is_same_file(settings->record, program))
        return tool_fail(self, "--record is \"%s\", the file of PROGRAM, expected another", settings->record);
    return tool_check_output(self, settings->record);
}

/* The program to start, with its kind and path. `record` is the path of the recording, or null. */
struct task {
    const struct settings *settings;
    const struct operands *operands;
    enum executable_kind kind;
    char path[PATH_MAX];
    const char *record;
};

static int fail_missing(const struct command *self, const struct task *task)
{
    return tool_fail(self, "%s: not found, expected a program in PATH or a file", task->operands->value[0]);
}

/* `first`, if there is one, comes before the program and its arguments. */
static int start(const struct command *self, const struct task *task, const char *first, const char *program)
{
    const size_t count = (size_t)task->operands->count, before = first != NULL;
    char **arguments = calloc(count + before + 1, sizeof *arguments);
    if (!arguments)
        return tool_fail(self, "no memory for the arguments");
    arguments[0] = (char *)(uintptr_t)first; /* arguments of execvp are not const */
    memcpy(arguments + before, task->operands->value, count * sizeof *arguments);
    if (first)
        arguments[1] = (char *)(uintptr_t)task->path;
    const int status = place_start(self, program, arguments, task->record);
    free(arguments);
    return status;
}

/* OpenGL ES: libglvnd reads only the named file. */
static int run_native(const struct command *self, const struct task *task)
{
    char vendor[PATH_MAX];
    struct error error = {""};
    if (place_vendor(vendor, &error))
        return tool_fail(self, "%s", error.text);
    if (setenv("__EGL_VENDOR_LIBRARY_FILENAMES", vendor, 1) || set_renderer(task->settings, task->record))
        return tool_fail(self, "no memory for the environment");
    return start(self, task, NULL, task->path);
}

static int run_wine(const struct command *self, const struct task *task)
{
    char files[PATH_MAX], prefix[PATH_MAX];
    const char *wine = task->settings->wine;
    struct error error = {""};
    if (!file_is_program(wine))
        return tool_fail(self, "%s: not found, expected Wine's program (Debian: apt-get install wine64)",
                         wine);
    if (place_files(files, &error) || place_prefix(task->settings->prefix, prefix, &error) ||
        place_make_prefix(wine, prefix, &error) || place_install(files, prefix, &error))
        return tool_fail(self, "%s", error.text);
    if (task->kind == EXECUTABLE_MISSING && !place_has_program(prefix, task->path))
        return fail_missing(self, task);
    if (set_wine(files, prefix) || set_renderer(task->settings, task->record))
        return tool_fail(self, "no memory for the environment");
    return start(self, task, wine, wine);
}

static bool ends_as_program(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && !strcasecmp(dot, ".exe");
}

/* Wine has programs of its own, such as notepad, in the prefix. A prefix is made only to look for NAME.exe.
 */
static bool wine_may_have(const struct settings *settings, const char *name)
{
    char files[PATH_MAX], prefix[PATH_MAX];
    struct error error = {""};
    if (strchr(name, '/') || !file_is_program(settings->wine) || place_files(files, &error) ||
        place_prefix(settings->prefix, prefix, &error))
        return false;
    return place_has_prefix(prefix) ? place_has_program(prefix, name) : ends_as_program(name);
}

static int run_kind(const struct command *self, struct task *task)
{
    const char *name = task->operands->value[0];
    const bool native = task->settings->gl;
    task->kind = place_find(name, task->path);
    if (task->kind == EXECUTABLE_MISSING) {
        if (native || !wine_may_have(task->settings, name))
            return fail_missing(self, task);
        snprintf(task->path, sizeof task->path, "%s", name);
    }
    if (native && task->kind == EXECUTABLE_WINDOWS)
        return tool_fail(self, "%s: found a program of Windows, expected one of Linux for --gl", name);
    if (!native && task->kind == EXECUTABLE_NONE)
        return tool_fail(
            self, "%s: is not a program, expected an ELF file, a script or a file that begins with MZ", name);
    return (native || task->kind == EXECUTABLE_LINUX ? run_native : run_wine)(self, task);
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    struct task task = {.settings = settings, .operands = operands};
    char record[PATH_MAX] = "";
    struct error error = {""};
    if (check(self, settings, operands->value[0]))
        return STATUS_BAD;
    if (settings->record && place_absolute(settings->record, record, &error))
        return tool_fail(self, "%s", error.text);
    task.record = settings->record ? record : NULL;
    return run_kind(self, &task);
}

static const char notes[] =
    "All that follows PROGRAM is for the program. Its exit status is that of this command. An ELF file or a\n"
    "script is a program of Linux, which gets Triptych's EGL; a file that begins with MZ is one of Windows. "
    "A\n"
    "name that neither PATH nor the folder has may be a program of Wine's prefix, such as notepad. For "
    "programs\n"
    "of Windows the prefix gets two files, d3d9.dll and triptych9.dll; programs that are started without "
    "this\n"
    "command use Wine's own d3d9.dll. Recordings are streams for the other commands. See docs/direct3d.md "
    "and\n"
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
