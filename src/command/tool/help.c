/* `triptych help`: what --help of the program or of a command prints, as text or as a manual page; and the
 * completions of shells. */
#include "command/support/option.h"
#include "command/tool/command_line.h"
#include "command/tool/manual.h"

struct settings {
    unsigned form;
};

static void print_text(const struct command *command, FILE *out)
{
    if (command)
        options_print_help(command, out);
    else
        command_line_print_help(out);
}

/* A form has one of the functions: for one command, or for the whole program. */
static const struct form {
    const char *name;
    void (*print_one)(const struct command *command, FILE *out);
    void (*print_all)(FILE *out);
} forms[] = {
    {"text", print_text, NULL},
    {"man", manual_print, NULL},
    {"bash", NULL, completion_print_bash},
    {"zsh", NULL, completion_print_zsh},
    {"fish", NULL, completion_print_fish},
};

static const char *form_at(unsigned index)
{
    return index < sizeof forms / sizeof *forms ? forms[index].name : NULL;
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    const struct form *form = forms + settings->form;
    if (form->print_all && operands->count)
        return tool_fail(self, "--as is \"%s\", which is for all commands, expected no COMMAND", form->name);
    if (form->print_all)
        form->print_all(stdout);
    else
        form->print_one(operands->count ? command_line_at(operands->word) : NULL, stdout);
    return STATUS_OK;
}

static const struct option options[] = {
    {"as", "FORM", "text, man: a manual page, or a completion for bash, zsh or fish; text",
     OPTION_IS_INDEX(struct settings, form), .words = form_at},
    {0},
};

static const struct operand operands[] = {
    {"COMMAND", "the command; without it, the list of commands", .kind = OPERAND_WORD,
     .words = command_line_name, .optional = true},
    {0},
};

static const char notes[] =
    "make install installs the manual pages and completions. To try the completion for bash:\n"
    "eval \"$(triptych help --as bash)\"";

const struct command command_help = {
    .name = "help",
    .summary = "show the options of a command",
    .options = options,
    .operands = operands,
    .notes = notes,
    .settings_bytes = sizeof(struct settings),
    .run = run,
};
