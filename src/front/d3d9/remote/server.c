#define _GNU_SOURCE /* MAP_FIXED_NOREPLACE */
#include "arena.h"
#include "channel.h"
#include "check.h"
#include "front/d3d9/dispatch.h"
#include "front/d3d9/memory.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* The memory of objects and of locks: one server, one arena. `given` has a bit for each unit: set for the
 * first one of memory that is in use. Unlike the arena's own headers, the program cannot change it. */
static struct d3d9_arena arena;
static uint64_t given[D3D9_CHANNEL_BYTES / D3D9_ARENA_UNIT / 64];

static uint64_t unit_of(const void *memory)
{
    return (uint64_t)((const uint8_t *)memory - arena.base) / D3D9_ARENA_UNIT;
}

static void *allocate(size_t bytes)
{
    void *memory = d3d9_arena_allocate(&arena, bytes);
    if (memory)
        given[unit_of(memory) / 64] |= UINT64_C(1) << unit_of(memory) % 64;
    return memory;
}

static void release(void *memory)
{
    given[unit_of(memory) / 64] &= ~(UINT64_C(1) << unit_of(memory) % 64);
    d3d9_arena_free(&arena, memory);
}

static bool is_allocated(uint64_t address)
{
    const uint8_t *memory = (const uint8_t *)(uintptr_t)address;
    bool inside = memory >= arena.base && memory < arena.base + (size_t)arena.units * D3D9_ARENA_UNIT;
    return inside && !(address % D3D9_ARENA_UNIT) && given[unit_of(memory) / 64] >> unit_of(memory) % 64 & 1;
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

/* Executes a message. Returns what is wrong with it, or null. The results are copied back, because the
 * program can change its block at any time. */
static const char *execute(struct d3d9_channel *channel, struct d3d9_message message)
{
    const struct d3d9_message_limits check = {(uintptr_t)channel + D3D9_CHANNEL_HEADER,
                                              (uintptr_t)channel + D3D9_CHANNEL_ARENA, is_allocated};
    alignas(16) uint8_t block[D3D9_MESSAGE_BLOCK];
    const char *problem = d3d9_message_check(&check, message.code, message.block, block);
    if (problem)
        return problem;
    channel->result = d3d9_dispatch(message.code, block);
    memcpy((void *)(uintptr_t)message.block, block, d3d9_form_of(message.code)->bytes);
    return NULL;
}

/* Returns what is wrong with a message, or null at the end of the client. */
static const char *serve(struct d3d9_channel *channel, int parent)
{
    const char *problem;
    for (uint32_t done = 0;; channel->done = ++done) {
        /* The client sleeps until all of its messages are executed. */
        if (channel->sent == done)
            d3d9_channel_wake(&channel->done, &channel->client_sleeps);
        while (channel->sent == done) {
            d3d9_channel_wait(&channel->sent, done, &channel->server_sleeps);
            if (channel->sent == done && getppid() != parent)
                return NULL;
        }
        struct d3d9_message message = channel->message[done % D3D9_CHANNEL_MESSAGES];
        if (message.code == (uint32_t)D3D9_MESSAGE_END)
            return NULL;
        if ((problem = execute(channel, message)))
            return problem;
    }
}

/* A crash: objects or the arena's headers, which the program can reach, are damaged. */
static void end_after_crash(int signal)
{
    static const char line[] = "triptych-d3d9-server: a call has failed: expected that the program does not "
                               "write beyond the memory that it locks\n";
    (void)signal;
    ssize_t written = write(STDERR_FILENO, line, sizeof line - 1);
    _exit(written < 0 ? 3 : 2);
}

static void catch_crashes(void)
{
    static const int signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    struct sigaction action = {.sa_handler = end_after_crash, .sa_flags = SA_ONSTACK};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        sigaction(signals[i], &action, NULL);
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
    catch_crashes();
    channel->ready = 1;
    d3d9_channel_wake(&channel->ready, &channel->client_sleeps);
    const char *problem = serve(channel, parent);
    if (problem)
        return fail(problem, "expected messages of d3d9.dll, so the program has damaged its memory");
    d3d9_host_end();
    return 0;
}
