#include "base/file.h"
#include "base/leftover.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

const char file_standard_input[] = "/dev/stdin", file_standard_output[] = "/dev/stdout";

bool file_is_standard(const char *path)
{
    return !strcmp(path, file_standard_input) || !strcmp(path, file_standard_output);
}

static int fail(struct error *error, const char *path, const char *doing)
{
    char reason[128] = "unknown reason";
    strerror_r(errno, reason, sizeof reason);
    return error_set(error, "%s: %s: %s", path, doing, reason);
}

static int fail_empty(struct error *error)
{
    return error_set(error, "\"\": is not a path, expected that of a file");
}

/* --- Reading --- */

struct contents {
    char *data;
    size_t bytes, capacity;
};

/* Makes room for one more read and the final zero. At most `limit` + 1 bytes are read: one more shows that
 * the file is too large. */
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

static int open_to_read(const char *path)
{
    return strcmp(path, file_standard_input) ? open(path, O_RDONLY | O_CLOEXEC)
                                             : fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0);
}

int file_read(const char *path, size_t limit, char **data, size_t *bytes, struct error *error)
{
    struct contents contents = {0};
    struct stat status;
    *data = NULL;
    *bytes = 0;
    if (!*path)
        return fail_empty(error);
    int descriptor = open_to_read(path);
    if (descriptor < 0)
        return fail(error, path, "cannot open");
    /* Only a hint, which saves reallocation: the file may change. */
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

/* --- Writing --- */

static int put_all(int descriptor, const char *data, size_t bytes)
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

/* The kernel sends SIGXFSZ to the thread that writes. It is blocked here, and removed if this call has caused
 * it. */
int file_put(int descriptor, const void *data, size_t bytes)
{
    static const struct timespec now;
    sigset_t limit, before, pending;
    sigemptyset(&limit);
    sigaddset(&limit, SIGXFSZ);
    sigemptyset(&pending);
    sigpending(&pending);
    pthread_sigmask(SIG_BLOCK, &limit, &before);
    int result = put_all(descriptor, data, bytes);
    int reason = errno;
    if (result && reason == EFBIG && !sigismember(&pending, SIGXFSZ))
        sigtimedwait(&limit, NULL, &now);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = reason;
    return result;
}

/* Opens a new file in the folder of `path`. Writes its path to `name`, of `size` bytes, and notes it as a
 * leftover. */
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

/* Makes the new name durable. Some file systems cannot sync folders, which is not an error. */
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

static void release(struct file_output *output)
{
    leftover_forget(output->leftover);
    free(output->name);
    free(output->path);
    free(output->temporary);
    *output = (struct file_output){.descriptor = -1, .leftover = -1};
}

/* On failure, errno is the reason. */
static int begin_beside(struct file_output *output, mode_t mode)
{
    size_t size = strlen(output->path) + 64;
    char *name = malloc(size);
    output->descriptor = name ? open_temporary(output->path, name, size, &output->leftover) : -1;
    if (output->descriptor < 0) {
        int reason = errno;
        free(name);
        errno = reason;
        return -1;
    }
    output->temporary = name;
    return mode ? fchmod(output->descriptor, mode) : 0;
}

/* A symbolic link is followed, so that the file that it names is replaced and not the link. */
static int begin(struct file_output *output, const struct stat *existing)
{
    if (!strcmp(output->name, file_standard_output))
        output->descriptor = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    else if (existing && !S_ISREG(existing->st_mode))
        output->descriptor = open(output->name, O_WRONLY | O_CLOEXEC);
    else
        output->path = existing ? realpath(output->name, NULL) : strdup(output->name);
    if (output->path)
        return begin_beside(output, existing ? existing->st_mode & 07777 : 0);
    return output->descriptor;
}

int file_begin(struct file_output *output, const char *path, struct error *error)
{
    struct stat status;
    bool exists = !stat(path, &status);
    *output = (struct file_output){.descriptor = -1, .leftover = -1};
    if (!*path)
        return fail_empty(error);
    if (exists && S_ISDIR(status.st_mode))
        return error_set(error, "%s: is a folder, expected a file to write", path);
    output->name = strdup(path);
    if (output->name && begin(output, exists ? &status : NULL) >= 0)
        return 0;
    fail(error, path, "cannot write");
    file_discard(output);
    return -1;
}

int file_append(struct file_output *output, const void *data, size_t bytes, struct error *error)
{
    return file_put(output->descriptor, data, bytes) ? fail(error, output->name, "cannot write") : 0;
}

/* On a network or full file system, close may be the first call that reports an error. */
static int finish(struct file_output *output)
{
    int descriptor = output->descriptor;
    output->descriptor = -1;
    int result = output->temporary && !output->unsynced ? fsync(descriptor) : 0;
    int reason = errno;
    if (close(descriptor) && !result)
        return -1;
    errno = reason;
    return result || !output->temporary ? result : rename(output->temporary, output->path);
}

int file_commit(struct file_output *output, struct error *error)
{
    if (finish(output)) {
        fail(error, output->name, "cannot write");
        file_discard(output);
        return -1;
    }
    if (output->temporary && !output->unsynced)
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

int file_write(const char *path, const void *data, size_t bytes, struct error *error)
{
    struct file_output output;
    if (file_begin(&output, path, error))
        return -1;
    if (!file_append(&output, data, bytes, error))
        return file_commit(&output, error);
    file_discard(&output);
    return -1;
}

/* --- Programs --- */

/* Returns true if the file NAME of a folder can be executed. An empty folder is the current one. */
static bool is_program_of(const char *folder, int length, const char *name)
{
    char path[PATH_MAX];
    int bytes = snprintf(path, sizeof path, "%.*s%s%s", length, folder, length ? "/" : "", name);
    return bytes < (int)sizeof path && !access(path, X_OK);
}

bool file_is_program(const char *name)
{
    const char *folders = getauxval(AT_SECURE) ? NULL : getenv("PATH");
    if (strchr(name, '/'))
        return !access(name, X_OK);
    for (folders = folders ? folders : ""; *folders; folders += *folders == ':') {
        int length = (int)strcspn(folders, ":");
        if (is_program_of(folders, length, name))
            return true;
        folders += length;
    }
    return false;
}
