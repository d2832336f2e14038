#define COBJMACROS
#include "bridge.h"
#include "object_data.h"
#include "front/d3d9/unix/entry.h"
#include <windows.h>
#include <winternl.h>
#include <unknwn.h>

typedef UINT64 unixlib_handle_t;
NTSTATUS WINAPI __wine_unix_call(unixlib_handle_t, unsigned, void *);
NTSTATUS WINAPI NtQueryVirtualMemory(HANDLE, const void *, int, void *, SIZE_T, SIZE_T *);

enum { MEMORY_WINE_UNIX_FUNCTIONS = 1000 };

static unixlib_handle_t library;
static INIT_ONCE once = INIT_ONCE_STATIC_INIT;

static int run(unsigned code, void *block)
{
    struct d3d9_unix_call call = {code, 0, (uintptr_t)block};
    __wine_unix_call(library, D3D9_UNIX_CALL, &call);
    return call.result;
}

static void execute(const struct d3d9_host_event *event)
{
    if (event->kind == D3D9_EVENT_RELEASE)
        IUnknown_Release((IUnknown *)(uintptr_t)event->pointer);
    else if (event->kind == D3D9_EVENT_FORGET)
        object_data_free((void *)(uintptr_t)event->pointer);
}

/* The program's Release may call the front end again, which then executes the rest. */
static void execute_events(void)
{
    int more;
    do {
        struct d3d9_host_event events[16];
        struct d3d9_block_host_take_events take = {.events = (uintptr_t)events, .room = ARRAYSIZE(events)};
        more = run(D3D9_CODE_host_take_events, &take) == D3D9_EVENTS;
        for (UINT i = 0; i < take.result; i++)
            execute(&events[i]);
    } while (more);
}

void bridge_call(unsigned code, void *block)
{
    if (run(code, block) == D3D9_EVENTS)
        execute_events();
}

static BOOL CALLBACK start(INIT_ONCE *self, void *context, void **data)
{
    extern IMAGE_DOS_HEADER __ImageBase;
    void (*then)(void) = context;
    (void)self, (void)data;
    if (NtQueryVirtualMemory(GetCurrentProcess(), &__ImageBase, MEMORY_WINE_UNIX_FUNCTIONS, &library,
                             sizeof library, NULL))
        return FALSE;
    then();
    return TRUE;
}

int bridge_start(void (*then)(void))
{
    return InitOnceExecuteOnce(&once, start, (void *)then, NULL);
}
