/* The command line, callable by tests. */
#ifndef COMMAND_TOOL_COMMAND_LINE_H
#define COMMAND_TOOL_COMMAND_LINE_H

/* Runs a command line, whose first argument is the program's name. Returns the exit status. If standard
 * output could not be written completely, the status is STATUS_BAD. */
int command_line_run(int count, char **arguments);

#endif
