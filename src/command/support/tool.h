/* Exit statuses and messages of all subcommands.
 *
 * Results are printed to standard output. A failure is one line on standard error: `triptych COMMAND:
 * REASON`. Progress is shown on standard error if that is a terminal, on one line that overwrites itself. */
#ifndef COMMAND_SUPPORT_TOOL_H
#define COMMAND_SUPPORT_TOOL_H

#include "base/words.h"

#include <stdbool.h>

enum status {
    STATUS_OK = 0,
    STATUS_DIFFERENT = 1, /* a difference was found, a verification failed */
    STATUS_BAD = 2        /* bad input or usage, or a refusal by the system */
};                        /* or 128 + the number of the signal that interrupted the command (interrupt.h) */

struct command; /* command.h */

/* Prints the reason and returns STATUS_BAD. */
int tool_fail(const struct command *self, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The same for a word that is not in a list: `WHAT "GIVEN", expected one of: A, B, C; did you mean "B"?`. */
int tool_fail_word(const struct command *self, const char *what, const char *given, struct words words);

/* The same for callers that cannot return a status: the program will exit with STATUS_BAD in any case. */
void tool_fail_at_end(const struct command *self, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
bool tool_has_failed(void);

/* Checks that a file of that path can be created or replaced, before a long computation of its contents. A
 * null path is allowed. Returns 0, or STATUS_BAD after printing the reason. */
int tool_check_output(const struct command *self, const char *path);

/* Checks that the name of a PNG picture ends with .png, unless it is a device or a pipe, and that it can be
 * written, as above. */
int tool_check_picture(const struct command *self, const char *path);

/* Returns true if both paths lead to one regular file. */
bool tool_is_same_file(const char *first, const char *second);

/* Makes a folder, or checks that it exists and is writable. *made is true if the folder is new. A null path
 * is allowed. Returns 0, or STATUS_BAD after printing the reason. */
int tool_make_folder(const struct command *self, const char *path, bool *made);

/* A report whose memory was refused in part is marked incomplete. It is not written to a file, and the
 * program exits with STATUS_BAD. */
void tool_report_begin(void);
void tool_report_mark_incomplete(void);
bool tool_report_is_complete(void);

/* From this call on, all that is printed to `stdout` goes to standard error, because a file is written to
 * standard output. tool_print_to_output undoes it. */
void tool_print_to_error(void);
void tool_print_to_output(void);

/* Replaces the line of progress. Null clears it. */
void tool_progress(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Copies a file's name without folders and extension: of "bench/streams/horse.stream", "horse". */
void tool_path_stem(const char *path, char *stem, unsigned capacity);

#endif
