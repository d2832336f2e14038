#include "base/file.h"
#include "base/leftover.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int fail(struct error *error, const char *path, const char *doing)
{
    char reason[128] = "unknown reason";
    strerror_r(errno, reason, sizeof reason);
    return error_set(error, "%s: %s: %s", path, doing, reason);
}

/* --- Reading ----------------------------------------------------------------------------------------------
 */

struct contents {
    char *data;
    size_t bytes, capacity;
};

/* Room for one more read and the final zero; `limit` + 1 bytes are read at most, to notice that there are
 * more. */
static int grow(struct contents *contents, size_t limit)
{
    if (contents->capacity - contents->bytes > 1)
        return 0;
    size_t capacity = contents->capacity ? contents->capacity * 2 : 65536;
    if (capacity > limit + 2)
        capacity = limit + 2;
    char *data = realloc(contents->data, capacity);
    if (!data)
        return -1;
    contents->data = data;
    contents->capacity = capacity;
    return 0;
}

static int read_all(int descriptor, const char *path, size_t limit, struct contents *contents,
                    struct error *error)
{
    for (;;) {
        if (grow(contents, limit))
            return error_set(error, "%s: not enough memory", path);
        ssize_t got =
            read(descriptor, contents->data + contents->bytes, contents->capacity - contents->bytes - 1);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return fail(error, path, "cannot read");
        if (got == 0)
            return 0;
        contents->bytes += (size_t)got;
        if (contents->bytes > limit)
            return error_set(error, "%s: more than %zu bytes, the largest size that is read", path, limit);
    }
}

int file_read(const char *path, size_t limit, char **data, size_t *bytes, struct error *error)
{
    struct contents contents = {0};
    struct stat status;
    *data = NULL;
    *bytes = 0;
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return fail(error, path, "cannot open");
    /* A regular file's size saves the growing; it is a hint, the file may change meanwhile. */
    if (!fstat(descriptor, &status) && S_ISREG(status.st_mode) && (uint64_t)status.st_size <= limit) {
        contents.capacity = (size_t)status.st_size + 2;
        contents.data = malloc(contents.capacity);
        if (!contents.data)
            contents.capacity = 0;
    }
    int result = read_all(descriptor, path, limit, &contents, error);
    close(descriptor);
    if (result) {
        free(contents.data);
        return -1;
    }
    contents.data[contents.bytes] = 0;
    *data = contents.data;
    *bytes = contents.bytes;
    return 0;
}

/* --- Writing ----------------------------------------------------------------------------------------------
 */

static int write_all(int descriptor, const char *data, size_t bytes)
{
    while (bytes) {
        ssize_t put = write(descriptor, data, bytes);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0) {
            errno = put ? errno : EIO;
            return -1;
        }
        data += put;
        bytes -= (size_t)put;
    }
    return 0;
}

/* Errors of a network or full file system may come as late as at close. */
static int write_and_close(int descriptor, const void *data, size_t bytes, int synchronize)
{
    int result = write_all(descriptor, data, bytes);
    if (!result && synchronize)
        result = fsync(descriptor);
    int reason = errno;
    if (close(descriptor) && !result)
        return -1;
    errno = reason;
    return result;
}

static int write_through(const char *path, const void *data, size_t bytes, struct error *error)
{
    int descriptor = open(path, O_WRONLY | O_CLOEXEC);
    if (descriptor < 0)
        return fail(error, path, "cannot open");
    if (write_and_close(descriptor, data, bytes, 0))
        return fail(error, path, "cannot write");
    return 0;
}

/* Opens a new file beside `path`; its name is left in `name`, of `size` bytes, and noted. */
static int open_temporary(const char *path, char *name, size_t size, int *leftover)
{
    static atomic_uint serial;
    for (int attempt = 0; attempt < 100; attempt++) {
        snprintf(name, size, "%s.%ld-%u.new", path, (long)getpid(), atomic_fetch_add(&serial, 1));
        *leftover = leftover_note(name);
        int descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0)
            return descriptor;
        leftover_forget(*leftover);
        if (errno != EEXIST)
            break;
    }
    return -1;
}

/* The new name is durable once the folder is; some file systems cannot sync folders, which is no failure. */
static void synchronize_folder(char *path)
{
    char *slash = strrchr(path, '/');
    if (slash)
        slash[slash == path] = 0;
    int descriptor = open(slash ? path : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) {
        fsync(descriptor);
        close(descriptor);
    }
}

/* Failures are told by errno. */
static int write_beside(const char *path, mode_t mode, char *name, size_t size, const void *data,
                        size_t bytes)
{
    int leftover, descriptor = open_temporary(path, name, size, &leftover);
    if (descriptor < 0)
        return -1;
    int result = mode ? fchmod(descriptor, mode) : 0;
    if (result)
        close(descriptor);
    else
        result = write_and_close(descriptor, data, bytes, 1);
    if (!result)
        result = rename(name, path);
    int reason = errno;
    if (result)
        unlink(name);
    leftover_forget(leftover);
    errno = reason;
    if (result)
        return -1;
    synchronize_folder(name);
    return 0;
}

static int replace(const char *path, mode_t mode, const void *data, size_t bytes)
{
    size_t size = strlen(path) + 64;
    char *name = malloc(size);
    int result = name ? write_beside(path, mode, name, size, data, bytes) : -1;
    int reason = errno;
    free(name);
    errno = reason;
    return result;
}

/* Replacing a link would leave the file that it leads to as it was. */
static int replace_target(const char *path, mode_t mode, const void *data, size_t bytes)
{
    char *target = realpath(path, NULL);
    int result = target ? replace(target, mode, data, bytes) : -1;
    int reason = errno;
    free(target);
    errno = reason;
    return result;
}

int file_write(const char *path, const void *data, size_t bytes, struct error *error)
{
    struct stat status;
    int exists = !stat(path, &status);
    if (exists && S_ISDIR(status.st_mode))
        return error_set(error, "%s: is a folder, expected a file to write", path);
    if (exists && !S_ISREG(status.st_mode))
        return write_through(path, data, bytes, error);
    int result =
        exists ? replace_target(path, status.st_mode & 07777, data, bytes) : replace(path, 0, data, bytes);
    return result ? fail(error, path, "cannot write") : 0;
}

/* --- Writing piece by piece -------------------------------------------------------------------------------
 */

static void release(struct file_output *output)
{
    free(output->path);
    free(output->temporary);
    *output = (struct file_output){.descriptor = -1};
}

static int begin_beside(struct file_output *output, mode_t mode)
{
    size_t size = strlen(output->path) + 64;
    output->temporary = malloc(size);
    if (!output->temporary)
        return -1;
    output->descriptor = open_temporary(output->path, output->temporary, size);
    if (output->descriptor >= 0)
        return mode ? fchmod(output->descriptor, mode) : 0;
    free(output->temporary);
    output->temporary = NULL;
    return -1;
}

int file_begin(struct file_output *output, const char *path, struct error *error)
{
    struct stat status;
    int exists = !stat(path, &status), result = -1;
    *output = (struct file_output){.descriptor = -1};
    if (exists && S_ISDIR(status.st_mode))
        return error_set(error, "%s: is a folder, expected a file to write", path);
    output->path = exists && S_ISREG(status.st_mode) ? realpath(path, NULL) : strdup(path);
    if (output->path && exists && !S_ISREG(status.st_mode))
        result = output->descriptor = open(path, O_WRONLY | O_CLOEXEC);
    else if (output->path)
        result = begin_beside(output, exists ? status.st_mode & 07777 : 0);
    if (result >= 0)
        return 0;
    fail(error, path, "cannot write");
    file_discard(output);
    return -1;
}

int file_append(struct file_output *output, const void *data, size_t bytes, struct error *error)
{
    return write_all(output->descriptor, data, bytes) ? fail(error, output->path, "cannot write") : 0;
}

int file_commit(struct file_output *output, struct error *error)
{
    int descriptor = output->descriptor;
    output->descriptor = -1;
    int result = write_and_close(descriptor, NULL, 0, output->temporary != NULL);
    if (!result && output->temporary)
        result = rename(output->temporary, output->path);
    if (result) {
        fail(error, output->path, "cannot write");
        file_discard(output);
        return -1;
    }
    if (output->temporary)
        synchronize_folder(output->temporary);
    release(output);
    return 0;
}

void file_discard(struct file_output *output)
{
    if (output->descriptor >= 0)
        close(output->descriptor);
    if (output->temporary)
        unlink(output->temporary);
    release(output);
}
