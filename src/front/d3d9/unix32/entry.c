/* The Unix library of a 32-bit program: it starts the server, a 64-bit program beside it, and sends calls to
 * it. */
#define _GNU_SOURCE /* dladdr */
#include "front/d3d9/remote/channel.h"
#include "front/d3d9/unix/entry.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

static struct d3d9_client client;

/* The server is in the folder that has this library's folder. */
static void find_server(char path[PATH_MAX])
{
    Dl_info info;
    if (!dladdr((void *)find_server, &info) || snprintf(path, PATH_MAX, "%s", info.dli_fname) >= PATH_MAX)
        path[0] = 0;
    for (int i = 0; i < 2; i++)
        if (strrchr(path, '/'))
            *strrchr(path, '/') = 0;
    snprintf(path + strlen(path), PATH_MAX - strlen(path), "/triptych-d3d9-server");
}

static int start(void *arguments)
{
    struct d3d9_unix_open *open = arguments;
    char server[PATH_MAX], reason[PATH_MAX + 100];
    find_server(server);
    if (d3d9_client_open(&client, server, open->codes, reason, sizeof reason)) {
        fprintf(stderr, "triptych: Direct3D 9: %s\n", reason);
        return -1;
    }
    open->memory = (uint32_t)(uintptr_t)client.channel;
    return 0;
}

static int wait(void *arguments)
{
    (void)arguments;
    return d3d9_client_send(&client, true);
}

static int wake(void *arguments)
{
    (void)arguments;
    return d3d9_client_send(&client, false);
}

extern int (*const __wine_unix_call_funcs[])(void *);

__attribute__((visibility("default"))) int (*const __wine_unix_call_funcs[])(void *) = {
    [D3D9_UNIX_OPEN] = start,
    [D3D9_UNIX_WAIT] = wait,
    [D3D9_UNIX_WAKE] = wake,
};
