/* Calls from one process to another through shared memory: the program (32-bit) is the client, the server
 * executes.
 *
 * The memory begins with a struct d3d9_channel. The rest of its first part is the client's, for the block of
 * a call and its arguments (packing.h). The second part is the server's arena (arena.h). Both processes map
 * it at the same address, below 2^32.
 *
 * One call is under way at a time. `turn` is the process that may write; the other one spins for a short
 * time, then sleeps on `turn` as a futex. */
#ifndef D3D9_REMOTE_CHANNEL_H
#define D3D9_REMOTE_CHANNEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum d3d9_channel_turn {
    D3D9_TURN_SERVER, /* the server starts, or executes a call */
    D3D9_TURN_CLIENT,
    D3D9_TURN_END /* there is no client any more */
};

/* All members have the same layout in both processes. */
struct d3d9_channel {
    uint32_t codes;        /* D3D9_CODE_COUNT of the client: both must have the same table of calls */
    uint32_t bytes, arena; /* of the memory; where its second part begins */
    _Atomic uint32_t turn;
    _Atomic uint32_t sleepers; /* processes that sleep on `turn` */
    uint32_t code, block;      /* the call, and the address of its block */
    int32_t result;            /* of d3d9_dispatch */
};

enum {
    D3D9_CHANNEL_BYTES = 512 << 20, /* of memory, which the system provides as it is used */
    D3D9_CHANNEL_ARENA = 48 << 20,
    D3D9_CHANNEL_HEADER = 4096 /* from here on the client may use the first part */
};

/* Both processes wait with this: until the turn is no longer `turn`, or for about a second. Returns the
 * turn. */
uint32_t d3d9_channel_wait(struct d3d9_channel *channel, uint32_t turn);
/* Sets the turn and wakes the other process. */
void d3d9_channel_pass(struct d3d9_channel *channel, uint32_t turn);

/* --- The client --- */

struct d3d9_client {
    struct d3d9_channel *channel;
    int process; /* 0: there is no server, or it has ended */
};

/* Starts the program `server` and waits until it is ready. Returns 0, or -1 with a reason of one line. */
int d3d9_client_open(struct d3d9_client *client, const char *server, uint32_t codes, char *reason,
                     size_t bytes);
/* Executes the call in channel->code and channel->block. Returns 0, or -1 if the server has ended. */
int d3d9_client_call(struct d3d9_client *client);
/* Ends the server and unmaps the memory. For tests: a program that ends leaves this to the server. */
void d3d9_client_close(struct d3d9_client *client);

/* --- The server --- */

/* Executes calls in the memory of this descriptor until the client or its process, `parent`, has ended.
 * Returns the exit status: 0, or 2 with a line on standard error if the memory cannot be mapped or is not
 * that of a client. */
int d3d9_serve(int descriptor, uint32_t address, int parent);

#endif
