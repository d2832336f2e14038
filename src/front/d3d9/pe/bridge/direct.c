#include "front/d3d9/unix/entry.h"
#include "transport.h"
#include "unixlib.h"

int transport_start(void)
{
    return unixlib_start();
}

int transport_run(unsigned code, void *block)
{
    struct d3d9_unix_call call = {code, 0, (uintptr_t)block};
    unixlib_call(D3D9_UNIX_CALL, &call);
    return call.result;
}
