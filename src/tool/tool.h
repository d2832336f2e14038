/* What the subcommands share: their exit statuses, and how they speak.
 *
 * Results go to standard output. Failures are one line on standard error, `triptych COMMAND: what was wrong`.
 * Progress goes to standard error too, but only to a terminal, on one line that overwrites itself. */
#ifndef TOOL_TOOL_H
#define TOOL_TOOL_H

#include <stdbool.h>

enum status {
    STATUS_OK = 0,
    STATUS_DIFFERENT = 1, /* a difference was found, a verification failed */
    STATUS_BAD = 2        /* bad input or usage, or something refused by the system */
};                        /* and 128 + the signal's number of a command that was interrupted (interrupt.h) */

struct command {
    const char *name;
    const char *operands; /* as the help writes them */
    const char *summary;
    int (*run)(const struct command *self, int count, char **arguments); /* arguments behind the name */
};

#define COMMAND(name, operands, summary)                                                                     \
    int command_##name(const struct command *self, int count, char **arguments);
#include "tool/command.def"
#undef COMMAND

/* Prints the failure and returns STATUS_BAD. */
int fail(const struct command *self, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The same, where nobody can return it: the program will end with STATUS_BAD, whatever else it does. */
void fail_at_end(const struct command *self, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool has_failed(void);

/* Whether a file of that path can be made or replaced, asked before hours are spent on its contents. A null
 * path is fine. Returns 0, or STATUS_BAD after telling why not. */
int check_output(const struct command *self, const char *path);

/* Makes a folder for files, or finds that it is there and takes some; *made is whether it was not. A null path is fine.
 * Returns 0, or STATUS_BAD after telling why not. */
int make_folder(const struct command *self, const char *path, bool *made);

/* Once memory was refused to a part of a report, the program will end with STATUS_BAD, and no report is written to a
 * file. */
void report_begin(void);
void report_is_incomplete(void);
bool report_is_complete(void);

/* Shows a line of progress in place of the last; null wipes it. */
void progress(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A file's name without folders and extension: "bench/streams/horse.stream" is "horse". */
void path_stem(const char *path, char *stem, unsigned capacity);

#endif
