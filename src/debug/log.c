#include "debug/log.h"
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

int log_open(struct log *log, const char *path, struct error *error)
{
    int result = 0;
    pthread_mutex_lock(&log->lock);
    if (!log->file) {
        snprintf(log->path, sizeof log->path, "%s", path);
        unlink(log->path);
        int file = open(log->path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
        result = file < 0 ? error_set(error, "%s: %s", log->path, strerror(errno)) : 1;
        log->file = file < 0 ? 0 : file;
        log->broken = false;
    }
    pthread_mutex_unlock(&log->lock);
    return result;
}

int log_append(struct log *log, const struct bytes *record, struct error *error)
{
    int result = 0;
    if (record->failed)
        return error_set(error, "%s: out of memory for a record", log->path);
    pthread_mutex_lock(&log->lock);
    off_t start = log->file && !log->broken ? lseek(log->file, 0, SEEK_CUR) : 0;
    if (log->file && !log->broken && file_put(log->file, record->data, record->count)) {
        result = error_set(error, "%s: %s; later routines are omitted", log->path, strerror(errno));
        log->broken = true;
        if (ftruncate(log->file, start))
            error_set(error, "%s: cannot be truncated after its last whole record: %s", log->path,
                      strerror(errno));
    }
    pthread_mutex_unlock(&log->lock);
    return result;
}
