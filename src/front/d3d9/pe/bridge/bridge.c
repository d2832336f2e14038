#define COBJMACROS
#include "bridge.h"
#include "object_data.h"
#include "transport.h"
#include <windows.h>
#include <unknwn.h>

static INIT_ONCE once = INIT_ONCE_STATIC_INIT;
static int started;

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
        more = transport_run(D3D9_CODE_host_take_events, &take) == D3D9_EVENTS;
        for (UINT i = 0; i < take.result; i++)
            execute(&events[i]);
    } while (more);
}

void bridge_call(unsigned code, void *block)
{
    if (transport_run(code, block) == D3D9_EVENTS)
        execute_events();
}

static BOOL CALLBACK start(INIT_ONCE *self, void *context, void **data)
{
    void (*then)(void) = context;
    (void)self, (void)data;
    if (!transport_start())
        return FALSE;
    then();
    started = 1;
    return TRUE;
}

int bridge_start(void (*then)(void))
{
    return InitOnceExecuteOnce(&once, start, (void *)then, NULL);
}

int bridge_has_started(void)
{
    return started;
}
