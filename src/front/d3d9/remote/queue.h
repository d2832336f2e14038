/* The client's side of the shared memory (channel.h): it writes messages, and waits only for those whose
 * results are not certain (known.h). Nothing here calls Windows or Linux, so both sides compile it. */
#ifndef D3D9_REMOTE_QUEUE_H
#define D3D9_REMOTE_QUEUE_H

#include "channel.h"

struct d3d9_queue {
    struct d3d9_channel *channel;
    uint8_t *at; /* the arguments of the next message */
    /* Wakes the server. `wait`: until it has executed all messages. Returns nonzero if it has ended. */
    int (*send)(void *context, bool wait);
    void *context;
};

void d3d9_queue_begin(struct d3d9_queue *, struct d3d9_channel *, int (*send)(void *context, bool wait),
                      void *context);

/* Makes a call. Returns the result of d3d9_dispatch, or D3D9_DONE if the call waits to be executed. A call
 * that cannot be made fails without any effect, and its block shows this: results of COM report a failure,
 * counts and addresses are 0. */
int d3d9_queue_call(struct d3d9_queue *, unsigned code, void *block);

#endif
