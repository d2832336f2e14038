/* Whole files: read with a size limit, and written atomically, so that no reader finds half of one.
 *
 * Functions that return int return 0, or -1 with a reason of one line that begins with the path. */
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

/* The paths of the standard streams, "/dev/stdin" and "/dev/stdout". These functions use the open descriptors
 * for them. Opening the paths would replace a file that standard output is redirected to, and would fail for
 * a socket. */
extern const char file_standard_input[], file_standard_output[];

/* Returns true if the path is one of them. Paths that are relative to such a file are relative to the current
 * folder. */
bool file_is_standard(const char *path);

/* Reads the whole file into *data, which the caller frees. A zero byte, not counted in *bytes, follows the
 * contents. Fails if the file has more than `limit` bytes. On failure *data is null. */
int file_read(const char *path, size_t limit, char **data, size_t *bytes, struct error *error);

/* Writes a temporary file in the same folder, syncs it and renames it to `path`. After a failure (a full
 * disk, a read-only folder) or a crash, `path` is unchanged.
 *
 * A failure removes the temporary file, as does a signal whose handler calls leftovers_remove
 * (base/leftover.h). A process that is killed leaves it as PATH.PROCESS-NUMBER.new. The permission
 * bits of an existing file are kept. If `path` is a symbolic link, the file that it names is replaced. If
 * `path` is a device or a pipe, the data is written to it directly. */
int file_write(const char *path, const void *data, size_t bytes, struct error *error);

/* The same for contents that arrive in pieces. Between file_begin and file_commit they are in the temporary
 * file, and `path` is unchanged. After a failure of file_append, call file_discard. A failed file_commit
 * discards the output itself. */
struct file_output {
    int descriptor;
    bool unsynced;   /* may be set after file_begin: a crash of the system may lose the contents */
    int leftover;    /* of `temporary`: its number in base/leftover.h */
    char *name;      /* the caller's path, for messages */
    char *path;      /* the final path, links resolved */
    char *temporary; /* the temporary path; null when `name` is written to directly */
};

int file_begin(struct file_output *output, const char *path, struct error *error);
int file_append(struct file_output *output, const void *data, size_t bytes, struct error *error);
int file_commit(struct file_output *output, struct error *error);
void file_discard(struct file_output *output);

/* Returns true if posix_spawnp will find the program: an executable file, in a folder of PATH unless the name
 * has a slash. A process with more rights than its user (setuid) searches no folder. */
bool file_is_program(const char *name);

/* Writes all bytes to a descriptor. At a limit on file sizes (RLIMIT_FSIZE) errno is EFBIG, and the calling
 * thread does not get the signal SIGXFSZ. Returns 0, or -1 with the reason in errno. */
int file_put(int descriptor, const void *data, size_t bytes);

#endif
