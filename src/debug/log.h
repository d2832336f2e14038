/* A file to which any thread appends records; perf reads it later. */
#ifndef DEBUG_LOG_H
#define DEBUG_LOG_H

#include "base/error.h"
#include "debug/dwarf.h"

#include <pthread.h>

enum { LOG_PATH_CAPACITY = 512 };

struct log {
    pthread_mutex_t lock;
    int file;    /* 0: not open */
    bool broken; /* a record could not be written, so no more are */
    char path[LOG_PATH_CAPACITY];
};

/* Creates the file with access for its owner only, unless it is open already. A file that an earlier process
 * with the same number has left is removed. Returns 1 if the file was created, 0 if it was open, -1 with the
 * reason. */
int log_open(struct log *log, const char *path, struct error *error);

/* Appends a record. Returns 0, or -1 with the reason. After an error the file stays as it is, and later calls
 * do nothing and return 0. */
int log_append(struct log *log, const struct bytes *record, struct error *error);

#endif
