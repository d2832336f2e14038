/* A file that is only ever appended to, record by record, by any thread; perf reads it afterwards. */
#ifndef DEBUG_LOG_H
#define DEBUG_LOG_H

#include "base/error.h"
#include "debug/dwarf.h"

#include <pthread.h>

enum { LOG_PATH_CAPACITY = 512 };

struct log {
    pthread_mutex_t lock;
    int file;    /* 0: none yet */
    bool broken; /* a record could not be written whole: no more are */
    char path[LOG_PATH_CAPACITY];
};

/* Makes the file, new, readable and writable for its owner alone, unless it is open already; what a process of the same
 * number has left is removed. Returns 1 if it was made, 0 if it was there, -1 with the reason. */
int log_open(struct log *log, const char *path, struct error *error);

/* Appends a record. -1 with the reason; only the first time when a file is full. */
int log_append(struct log *log, const struct bytes *record, struct error *error);

#endif
