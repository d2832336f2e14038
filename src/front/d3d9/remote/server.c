#define _GNU_SOURCE /* MAP_FIXED_NOREPLACE */
#include "arena.h"
#include "channel.h"
#include "front/d3d9/dispatch.h"
#include "front/d3d9/memory.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* The memory of objects and of locks: one server, one arena. */
static struct d3d9_arena arena;

static void *allocate(size_t bytes)
{
    return d3d9_arena_allocate(&arena, bytes);
}

static void release(void *memory)
{
    d3d9_arena_free(&arena, memory);
}

static int fail(const char *text, const char *expected)
{
    fprintf(stderr, "triptych-d3d9-server: %s: %s\n", text, expected);
    return 2;
}

static struct d3d9_channel *map(int descriptor, uint32_t address)
{
    struct stat status;
    if (fstat(descriptor, &status) || status.st_size < D3D9_CHANNEL_BYTES)
        return NULL;
    void *memory = mmap((void *)(uintptr_t)address, D3D9_CHANNEL_BYTES, PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_NORESERVE | MAP_FIXED_NOREPLACE, descriptor, 0);
    return memory == MAP_FAILED ? NULL : memory;
}

static void serve(struct d3d9_channel *channel, int parent)
{
    uint32_t turn;
    d3d9_channel_pass(channel, D3D9_TURN_CLIENT);
    while ((turn = d3d9_channel_wait(channel, D3D9_TURN_CLIENT)) != D3D9_TURN_END) {
        if (turn == D3D9_TURN_SERVER) {
            channel->result = d3d9_dispatch(channel->code, (void *)(uintptr_t)channel->block);
            d3d9_channel_pass(channel, D3D9_TURN_CLIENT);
        } else if (getppid() != parent) {
            return;
        }
    }
}

int d3d9_serve(int descriptor, uint32_t address, int parent)
{
    static const struct d3d9_memory_host host = {allocate, release};
    struct d3d9_channel *channel = map(descriptor, address);
    if (!channel)
        return fail("no shared memory", "expected to be started by d3d9.dll of a 32-bit program");
    if (channel->codes != D3D9_CODE_COUNT || channel->bytes != D3D9_CHANNEL_BYTES ||
        channel->arena != D3D9_CHANNEL_ARENA)
        return fail("another table of calls", "expected d3d9.dll of the same version");
    d3d9_arena_create(&arena, (uint8_t *)channel + channel->arena, channel->bytes - channel->arena);
    d3d9_memory_set_host(&host);
    serve(channel, parent);
    d3d9_host_end();
    return 0;
}
