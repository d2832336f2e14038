/* The command line, callable by tests, and the list of subcommands. */
#ifndef COMMAND_TOOL_COMMAND_LINE_H
#define COMMAND_TOOL_COMMAND_LINE_H

#include "command/support/command.h"

#include <stdio.h>

/* Runs a command line, whose first argument is the program's name. Returns the exit status. If standard
 * output could not be written completely, the status is STATUS_BAD. */
int command_line_run(int count, char **arguments);

/* The subcommand of that index, null after the last; and its name. */
const struct command *command_line_at(unsigned index);
const char *command_line_name(unsigned index);

/* The last paragraphs of `triptych --help`. */
extern const char command_line_notes[];

/* Prints `triptych --help`. */
void command_line_print_help(FILE *out);

#endif
