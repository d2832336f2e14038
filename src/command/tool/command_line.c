/* Finds the subcommand in the table, runs it, and checks that its output was written. */
#include "command/tool/command_line.h"
#include "machine/cpu.h"
#include "command/support/json.h"
#include "command/support/tool.h"
#include "triptych.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static const struct command commands[] = {
#define COMMAND(name, operands, summary) {#name, operands, summary, command_##name},
#include "command/support/command.def"
#undef COMMAND
};

enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static const struct command program = {"", "", "", NULL};

static void print_help(FILE *out)
{
    fputs("usage: triptych COMMAND [OPTIONS] ...\n\n", out);
    for (int i = 0; i < COMMAND_COUNT; i++)
        fprintf(out, "  %-8s %-13s %s\n", commands[i].name, commands[i].operands, commands[i].summary);
    fputs("\ntriptych COMMAND --help lists the options of a command; triptych --version prints the version.\n"
          "TRIPTYCH_CPU=-avx512f,... hides processor features (triptych list cpu); TRIPTYCH_CC is the "
          "compiler\n"
          "of the engine external.\n"
          "Exit status: 0 success; 1 a difference was found; 2 bad input or usage, or a refusal by the "
          "system;\n"
          "128 + N: stopped by signal N (130: SIGINT) after a report of the work done.\n",
          out);
}

static int unknown_command(const char *name)
{
    char names[256] = "";
    for (int i = 0; i < COMMAND_COUNT; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i ? ", " : "",
                 commands[i].name);
    return tool_fail(&program, "unknown %s \"%s\", expected one of: %s",
                     name[0] == '-' ? "option" : "command", name, names);
}

static int run(int count, char **arguments)
{
    if (count < 2) {
        print_help(stderr);
        return STATUS_BAD;
    }
    if (!strcmp(arguments[1], "--help"))
        return print_help(stdout), STATUS_OK;
    if (!strcmp(arguments[1], "--version"))
        return puts("triptych " TRIPTYCH_VERSION), STATUS_OK;
    if (cpu_native_error())
        return tool_fail(&program, "%s", cpu_native_error());
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (!strcmp(arguments[1], commands[i].name))
            return commands[i].run(commands + i, count - 2, arguments + 2);
    return unknown_command(arguments[1]);
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
    if (!tool_report_is_complete() && status != STATUS_BAD)
        status = tool_fail(&program, "out of memory: the report is incomplete");
    return check_standard_output() || tool_has_failed() ? STATUS_BAD : status;
}
