/* Whole files: read with a limit, written so that nobody ever sees half of one.
 *
 * Errors are one line that begins with the path. Both functions return 0, or -1 with the reason in `error`.
 */
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include "base/error.h"

#include <stddef.h>

/* Reads all of the file into *data, which the caller frees; a zero byte, not counted in *bytes, follows the
 * contents. A file of more than `limit` bytes is refused. On failure *data is null. */
int file_read(const char *path, size_t limit, char **data, size_t *bytes, struct error *error);

/* Writes a temporary file in the same folder, syncs it and renames it to `path`: after a failure (a full
 * disk, a folder that may not be written) or a crash `path` is what it was before. A failure leaves no
 * temporary file, nor does a signal whose handler calls leftovers_remove (base/leftover.h); a process that is
 * killed leaves PATH.PROCESS-NUMBER.new. An existing file's permission bits are kept, and so are symbolic
 * links to it: the file that they lead to is replaced. What exists and is no regular file (a device, a pipe)
 * is written to as it is. */
int file_write(const char *path, const void *data, size_t bytes, struct error *error);

/* The same for contents that come piece by piece: between file_begin and file_commit or file_discard they are in the
 * temporary file, and nothing is at `path` that was not there before. After a failure of file_append the output is
 * still to be discarded; file_commit discards it itself. */
struct file_output {
    int descriptor;
    int leftover;    /* of `temporary` (base/leftover.h) */
    char *name;      /* as it was given, for messages */
    char *path;      /* that the file will have */
    char *temporary; /* that it has; null when `name` is written to as it is */
};

int file_begin(struct file_output *output, const char *path, struct error *error);
int file_append(struct file_output *output, const void *data, size_t bytes, struct error *error);
int file_commit(struct file_output *output, struct error *error);
void file_discard(struct file_output *output);

#endif
