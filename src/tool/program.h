/* The program: what main does, for tests too. */
#ifndef TOOL_PROGRAM_H
#define TOOL_PROGRAM_H

/* Runs a command line, its first argument the program's name; returns the exit status. Standard output has been written
 * when it returns, or the status is STATUS_BAD. */
int program_run(int count, char **arguments);

#endif
