/* `triptych help`: what --help of the program or of a command prints. */
#include "command/support/option.h"
#include "command/tool/command_line.h"

static int run(const struct command *self, void *settings, const struct operands *operands)
{
    (void)self;
    (void)settings;
    if (operands->count)
        options_print_help(command_line_at(operands->word), stdout);
    else
        command_line_print_help(stdout);
    return STATUS_OK;
}

static const struct operand operands[] = {
    {"COMMAND", "the command; without it, the list of commands", .kind = OPERAND_WORD,
     .words = command_line_name, .optional = true},
    {0},
};

const struct command command_help = {
    .name = "help",
    .summary = "show the options of a command",
    .operands = operands,
    .run = run,
};
