#include "front/d3d9/remote/queue.h"
#include "front/d3d9/block.h"
#include "front/d3d9/unix/entry.h"
#include "transport.h"
#include "unixlib.h"

#include <windows.h>

/* The queue and the memory for arguments are those of all threads. */
static SRWLOCK lock = SRWLOCK_INIT;
static struct d3d9_queue queue;

static int send_messages(void *context, bool wait)
{
    (void)context;
    return unixlib_call(wait ? D3D9_UNIX_WAIT : D3D9_UNIX_WAKE, NULL);
}

int transport_start(void)
{
    struct d3d9_unix_open open = {.codes = D3D9_CODE_COUNT};
    if (!unixlib_start() || unixlib_call(D3D9_UNIX_OPEN, &open) || !open.memory)
        return 0;
    d3d9_queue_begin(&queue, (void *)(uintptr_t)open.memory, send_messages, NULL);
    return 1;
}

int transport_run(unsigned code, void *block)
{
    AcquireSRWLockExclusive(&lock);
    int result = d3d9_queue_call(&queue, code, block);
    ReleaseSRWLockExclusive(&lock);
    return result;
}
