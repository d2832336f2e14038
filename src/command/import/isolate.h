/* Untrusted work in a separate process.
 *
 * The process is a fork of this one. It can read all memory of this process, but returns only its answer:
 * some bytes through a pipe. Its additional memory and its processor time are limited. A crash, a hang or an
 * exceeded limit is an error of one line. Its output is discarded, and it writes no core file.
 *
 * The other threads of this process do not exist in the fork, so locks that they held stay locked. The C
 * library handles its own locks (allocation, streams). The work must not use the locks of devices, pools and
 * caches. Thread-safe. */
#ifndef COMMAND_IMPORT_ISOLATE_H
#define COMMAND_IMPORT_ISOLATE_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

/* A growing array of bytes. */
struct answer {
    uint8_t *data;
    size_t bytes, capacity;
};

/* Appends bytes. Returns 0, or -1 if memory is short. */
int isolate_append(struct answer *answer, const void *data, size_t bytes);

struct isolate_limits {
    uint64_t memory;       /* bytes */
    unsigned seconds;      /* of processor time */
    unsigned milliseconds; /* of elapsed time */
    size_t answer;         /* bytes */
};

/* Runs in the new process. Fills the answer and returns 0, or -1 with the reason. */
typedef int isolated_work(void *user, struct answer *answer, struct error *error);

/* Returns 0 with the answer, whose data the caller frees. Returns -1 with the reason of the work, or of the
 * end of its process; that reason begins with `name`. The process may have been compromised: every byte of
 * the answer must be checked. */
int isolate_run(const char *name, const struct isolate_limits *limits, isolated_work *work, void *user,
                struct answer *answer, struct error *error);

#endif
