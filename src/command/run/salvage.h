/* The unfinished recordings that a program leaves when it is killed (base/file.h). */
#ifndef COMMAND_RUN_SALVAGE_H
#define COMMAND_RUN_SALVAGE_H

#include "command/support/command.h"

#include <stdbool.h>
#include <time.h>

/* Completes the recordings that processes have begun after `begin` and did not finish before they ended:
 * `record`, an absolute path, and those of further devices. Each gets its whole frames, and a line on stderr
 * reports how many. Returns true if there was one. */
bool salvage_recordings(const struct command *self, const char *record, const struct timespec *begin);

#endif
