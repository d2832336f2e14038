/* The Unix library of the builtin DLL: Wine finds __wine_unix_call_funcs by name. */
#include "entry.h"
#include "front/d3d9/dispatch.h"

static int call(void *arguments)
{
    struct d3d9_unix_call *call = arguments;
    call->result = d3d9_dispatch(call->code, (void *)(uintptr_t)call->block);
    return 0;
}

extern int (*const __wine_unix_call_funcs[])(void *);

__attribute__((visibility("default"))) int (*const __wine_unix_call_funcs[])(void *) = {
    [D3D9_UNIX_CALL] = call,
};
