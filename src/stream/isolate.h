/* Work that is not trusted to end well, in a process of its own.
 *
 * The process is a fork of this one: it sees all that this one sees, and nothing that it does comes back but its
 * answer, some bytes through a pipe. It may take so much memory beyond what it was born with and so much processor time;
 * when it crashes, hangs or takes more, that is an error with one line. Nothing it prints is seen, and it leaves no core.
 *
 * The other threads of this process do not exist in the new one. What they held is held forever there; the C library
 * sees to its own locks (allocation, streams). Work must keep away from the locks of others: of devices, pools and
 * caches. Two callers may isolate at once. */
#ifndef STREAM_ISOLATE_H
#define STREAM_ISOLATE_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

/* Bytes that grow. */
struct answer {
    uint8_t *data;
    size_t bytes, capacity;
};

/* Returns -1 if memory is short. */
int answer_add(struct answer *answer, const void *data, size_t bytes);

struct isolate_limits {
    uint64_t memory;       /* bytes */
    unsigned seconds;      /* of processor time */
    unsigned milliseconds; /* of time */
    size_t answer;         /* bytes */
};

/* Runs in the new process: fills the answer and returns 0, or -1 with the reason. */
typedef int isolated_work(void *user, struct answer *answer, struct error *error);

/* Returns 0 with the answer, whose data the caller frees; or -1 with the work's own reason or that of its end, which
 * begins with `name`. The answer is what a process says that may have gone astray: every byte of it is to be checked. */
int isolate(const char *name, const struct isolate_limits *limits, isolated_work *work, void *user,
            struct answer *answer, struct error *error);

#endif
