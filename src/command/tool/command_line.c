/* Finds the subcommand in the table, reads its options, runs it, and checks that its output was written. */
#include "command/tool/command_line.h"
#include "machine/cpu.h"
#include "command/support/json.h"
#include "command/support/option.h"
#include "command/support/tool.h"
#include "triptych.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct command *const commands[] = {
#define COMMAND(name) &command_##name,
#include "command/support/command.def"
#undef COMMAND
};

enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static const struct command program = {.name = ""};

const char command_line_notes[] =
    "triptych COMMAND --help lists the options of a command; triptych --version prints the version.\n"
    "TRIPTYCH_CPU=-avx512f,... hides processor features (triptych list cpu); TRIPTYCH_CC is the compiler\n"
    "of the engine external. Meshes of model files are kept in XDG_CACHE_HOME/triptych or "
    "~/.cache/triptych.\n"
    "Exit status: 0 success; 1 a difference was found; 2 bad input or usage, or a refusal by the system;\n"
    "128 + N: stopped by signal N (130: SIGINT) after a report of the work done.";

const struct command *command_line_at(unsigned index)
{
    return index < COMMAND_COUNT ? commands[index] : NULL;
}

const char *command_line_name(unsigned index)
{
    return index < COMMAND_COUNT ? commands[index]->name : NULL;
}

void command_line_print_help(FILE *out)
{
    char usage[OPTIONS_USAGE];
    fputs("usage: triptych COMMAND [OPTIONS] ...\n\n", out);
    for (int i = 0; i < COMMAND_COUNT; i++)
        fprintf(out, "  %-8s %-13s %s\n", commands[i]->name, options_usage(commands[i], usage),
                commands[i]->summary);
    fprintf(out, "\n%s\n", command_line_notes);
}

static const char *word_at(const struct words *words, unsigned index)
{
    static const char *const options[] = {"--help", "--version"};
    unsigned i = index - COMMAND_COUNT;
    (void)words;
    return index < COMMAND_COUNT                  ? commands[index]->name
           : i < sizeof options / sizeof *options ? options[i]
                                                  : NULL;
}

/* Reads the options into settings that the command may change. */
static int run_command(const struct command *self, int count, char **arguments)
{
    struct operands operands;
    int status = STATUS_BAD;
    void *settings = calloc(1, self->settings_bytes + 1);
    if (!settings)
        return tool_fail(self, "no memory for the options");
    if (self->defaults)
        memcpy(settings, self->defaults, self->settings_bytes);
    enum options_result result = options_read(self, count, arguments, settings, &operands);
    if (result == OPTIONS_GO) {
        status = self->run(self, settings, &operands);
    } else if (result == OPTIONS_HELP) {
        tool_print_to_output(); /* an option before --help may have changed it */
        options_print_help(self, stdout);
        status = STATUS_OK;
    }
    free(settings);
    return status;
}

static int run(int count, char **arguments)
{
    unsigned index;
    if (count < 2) {
        command_line_print_help(stderr);
        return STATUS_BAD;
    }
    const char *first = arguments[1];
    if (!strcmp(first, "--help") || !strcmp(first, "-h"))
        return command_line_print_help(stdout), STATUS_OK;
    if (!strcmp(first, "--version"))
        return puts("triptych " TRIPTYCH_VERSION), STATUS_OK;
    if (cpu_native_error())
        return tool_fail(&program, "%s", cpu_native_error());
    struct words words = {.at = word_at};
    if (!words_find(words, first, strlen(first), &index))
        return tool_fail_word(&program, first[0] == '-' ? "unknown option" : "unknown command", first, words);
    return run_command(commands[index], count - 2, arguments + 2);
}

/* A full disk must not look like success. The errno of an earlier failure is lost by now. */
static int check_standard_output(void)
{
    int failed = ferror(stdout);
    errno = 0;
    if (!fflush(stdout) && !failed)
        return STATUS_OK;
    return errno ? tool_fail(&program, "cannot write to standard output: %s", strerror(errno))
                 : tool_fail(&program, "cannot write to standard output");
}

int command_line_run(int count, char **arguments)
{
    tool_report_begin();
    json_begin();
    int status = run(count, arguments);
    json_end();
    tool_progress(NULL);
    tool_print_to_output();
    if (!tool_report_is_complete() && status != STATUS_BAD)
        status = tool_fail(&program, "out of memory: the report is incomplete");
    return check_standard_output() || tool_has_failed() ? STATUS_BAD : status;
}
