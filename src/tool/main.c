/* The command `triptych`: finds the subcommand in the table and lets it run. */
#include "base/cpu.h"
#include "tool/tool.h"
#include "triptych.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static const struct command commands[] = {
#define COMMAND(name, operands, summary) {#name, operands, summary, command_##name},
#include "tool/command.def"
#undef COMMAND
};

enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static const struct command program = {"", "", "", NULL};

static void print_help(FILE *out)
{
    fputs("usage: triptych COMMAND [OPTIONS] ...\n\n", out);
    for (int i = 0; i < COMMAND_COUNT; i++)
        fprintf(out, "  %-8s %-13s %s\n", commands[i].name, commands[i].operands, commands[i].summary);
    fputs("\ntriptych COMMAND --help tells a command's options; triptych --version tells the version.\n"
          "TRIPTYCH_CPU=-avx512f,... hides features of the processor (list cpu), TRIPTYCH_CC names "
          "external's compiler.\n"
          "Exit status: 0 good, 1 a difference was found, 2 bad input or usage.\n",
          out);
}

static int unknown_command(const char *name)
{
    char names[256] = "";
    for (int i = 0; i < COMMAND_COUNT; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i ? ", " : "",
                 commands[i].name);
    return fail(&program, "unknown %s \"%s\", expected one of: %s", name[0] == '-' ? "option" : "command",
                name, names);
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
        return fail(&program, "%s", cpu_native_error());
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (!strcmp(arguments[1], commands[i].name))
            return commands[i].run(commands + i, count - 2, arguments + 2);
    return unknown_command(arguments[1]);
}

int main(int count, char **arguments)
{
    int status = run(count, arguments);
    progress(NULL);
    /* What could not be written was not reported: a full disk must not look like success. */
    if (fflush(stdout) || ferror(stdout))
        return fail(&program, "cannot write to standard output: %s", strerror(errno));
    return status;
}
