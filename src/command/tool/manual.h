/* Texts for other programs that are made from the tables of commands: manual pages and completions of
 * shells. */
#ifndef COMMAND_TOOL_MANUAL_H
#define COMMAND_TOOL_MANUAL_H

#include "command/support/command.h"

#include <stdio.h>

/* Prints the manual page (man(7)) of a command, or of the program if `command` is null. */
void manual_print(const struct command *command, FILE *out);

/* Print the completion of all commands, options and words, for one shell each. */
void completion_print_bash(FILE *out);
void completion_print_zsh(FILE *out);
void completion_print_fish(FILE *out);

#endif
