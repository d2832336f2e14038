/* Starts the program of `triptych run`. */
#ifndef COMMAND_RUN_START_H
#define COMMAND_RUN_START_H

#include "command/support/command.h"

/* Replaces this process by the program, of a path or a name that PATH has. `arguments` end with a null.
 *
 * With `record`, the file of a recording, the program is a child process: signals that are sent to this
 * process are sent to it, and a recording that it leaves unfinished is completed. A line is printed if
 * nothing was recorded. Returns the exit status: that of the program, 128 + the number of the signal that
 * ended it, or STATUS_BAD after printing why it cannot start. */
int place_start(const struct command *self, const char *program, char **arguments, const char *record);

#endif
