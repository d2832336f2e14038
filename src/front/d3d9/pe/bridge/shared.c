#include "front/d3d9/remote/channel.h"
#include "front/d3d9/remote/packing.h"
#include "front/d3d9/unix/entry.h"
#include "transport.h"
#include "unixlib.h"

#include <windows.h>

/* One call is under way at a time: the memory for its arguments is that of all. */
static SRWLOCK lock = SRWLOCK_INIT;
static uint8_t *memory; /* struct d3d9_channel, and what follows it */

int transport_start(void)
{
    struct d3d9_unix_open open = {.codes = D3D9_CODE_COUNT};
    if (!unixlib_start() || unixlib_call(D3D9_UNIX_OPEN, &open))
        return 0;
    memory = (uint8_t *)(uintptr_t)open.memory;
    return memory != NULL;
}

/* A call that cannot be made has failed without any effect, as the results of its block show: those of
 * the Linux side's functions are results of COM, counts or addresses, and 0 or a failure are all of
 * these. */
static int run(unsigned code, void *block)
{
    struct d3d9_channel *channel = (void *)memory;
    struct d3d9_packing packing = {memory + D3D9_CHANNEL_HEADER, memory + D3D9_CHANNEL_ARENA, false};
    void *shared = d3d9_pack(&packing, code, block);
    if (!shared) {
        d3d9_pack_failure(code, block, packing.full ? D3D9_OUT_OF_MEMORY : D3D9_FAIL);
        return D3D9_DONE;
    }
    channel->code = code;
    channel->block = (uint32_t)(uintptr_t)shared;
    if (unixlib_call(D3D9_UNIX_SEND, NULL)) {
        d3d9_pack_failure(code, block, D3D9_DEVICE_LOST);
        return D3D9_DONE;
    }
    d3d9_unpack(code, block, shared);
    return channel->result;
}

int transport_run(unsigned code, void *block)
{
    AcquireSRWLockExclusive(&lock);
    int result = run(code, block);
    ReleaseSRWLockExclusive(&lock);
    return result;
}
