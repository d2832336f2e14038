#define _GNU_SOURCE /* memfd_create, environ */
#include "channel.h"

#include <errno.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SERVER_DESCRIPTOR = 3, START_WAITS = 150 /* of a fifth of a second */ };

static int fail(char *reason, size_t bytes, const char *server, const char *doing)
{
    snprintf(reason, bytes, "%s: %s: %s", server, doing, strerror(errno));
    return -1;
}

/* Maps the memory at an address that the system chooses; a 64-bit client needs one below 2^32. */
static void *map(int descriptor)
{
#ifdef MAP_32BIT
    int place = sizeof(void *) > 4 ? MAP_32BIT : 0;
#else
    int place = 0;
#endif
    return mmap(NULL, D3D9_CHANNEL_BYTES, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_NORESERVE | place,
                descriptor, 0);
}

/* The server gets the memory as descriptor 3, no signal blocked, and its arguments as numbers. */
static int start(struct d3d9_client *client, const char *server, int descriptor)
{
    extern char **environ;
    char address[16], parent[16];
    char *arguments[] = {(char *)server, address, parent, NULL};
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none;
    snprintf(address, sizeof address, "%lu", (unsigned long)(uintptr_t)client->channel);
    snprintf(parent, sizeof parent, "%d", (int)getpid());
    sigemptyset(&none);
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawn_file_actions_adddup2(&actions, descriptor, SERVER_DESCRIPTOR);
    errno = posix_spawn(&client->process, server, &actions, &attributes, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    return errno ? -1 : 0;
}

/* Returns true while the server's process exists. */
static bool runs(const struct d3d9_client *client)
{
    int status;
    return !waitpid(client->process, &status, WNOHANG);
}

static int await_start(struct d3d9_client *client)
{
    struct d3d9_channel *channel = client->channel;
    for (int i = 0; i < START_WAITS && !channel->ready && runs(client); i++)
        d3d9_channel_wait(&channel->ready, 0, &channel->client_sleeps);
    if (channel->ready)
        return 0;
    errno = ECHILD;
    return -1;
}

static int open_with(struct d3d9_client *client, const char *server, int descriptor, uint32_t codes,
                     char *reason, size_t bytes)
{
    void *memory = map(descriptor);
    if (memory == MAP_FAILED)
        return fail(reason, bytes, server, "cannot map shared memory");
    client->channel = memory;
    client->channel->codes = codes;
    client->channel->bytes = D3D9_CHANNEL_BYTES;
    client->channel->arena = D3D9_CHANNEL_ARENA;
    if (start(client, server, descriptor)) {
        client->process = 0;
        return fail(reason, bytes, server, "cannot start");
    }
    if (await_start(client))
        return fail(reason, bytes, server, "ended before it was ready");
    return 0;
}

int d3d9_client_open(struct d3d9_client *client, const char *server, uint32_t codes, char *reason,
                     size_t bytes)
{
    *client = (struct d3d9_client){0};
    int descriptor = memfd_create("triptych", 0);
    if (descriptor < 0 || ftruncate(descriptor, D3D9_CHANNEL_BYTES)) {
        int result = fail(reason, bytes, server, "cannot make shared memory");
        if (descriptor >= 0)
            close(descriptor);
        return result;
    }
    int result = open_with(client, server, descriptor, codes, reason, bytes);
    close(descriptor);
    if (result)
        d3d9_client_close(client);
    return result;
}

/* After the server's end the memory stays mapped: the program may still read what it has locked. */
int d3d9_client_send(struct d3d9_client *client, bool wait)
{
    struct d3d9_channel *channel = client->channel;
    uint32_t done;
    if (!client->process)
        return -1;
    d3d9_channel_wake(&channel->sent, &channel->server_sleeps);
    while (wait && (done = channel->done) != channel->sent) {
        d3d9_channel_wait(&channel->done, done, &channel->client_sleeps);
        if (channel->done == done && !runs(client)) {
            client->process = 0;
            return -1;
        }
    }
    return 0;
}

static void send_end(struct d3d9_channel *channel)
{
    uint32_t sent = channel->sent;
    channel->message[sent % D3D9_CHANNEL_MESSAGES] = (struct d3d9_message){(uint32_t)D3D9_MESSAGE_END, 0};
    channel->sent = sent + 1;
    d3d9_channel_wake(&channel->sent, &channel->server_sleeps);
}

void d3d9_client_close(struct d3d9_client *client)
{
    int status;
    if (client->process && !d3d9_client_send(client, true))
        send_end(client->channel);
    if (client->process)
        waitpid(client->process, &status, 0);
    if (client->channel)
        munmap(client->channel, D3D9_CHANNEL_BYTES);
    *client = (struct d3d9_client){0};
}
