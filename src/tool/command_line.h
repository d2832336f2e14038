/* The command line: what main does, for tests too. */
#ifndef TOOL_COMMAND_LINE_H
#define TOOL_COMMAND_LINE_H

/* Runs a command line, its first argument the program's name; returns the exit status. Standard output has been written
 * when it returns, or the status is STATUS_BAD. */
int command_line_run(int count, char **arguments);

#endif
