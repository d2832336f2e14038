/* Calls from one process to another through shared memory: the program (32-bit) is the client, the server
 * executes.
 *
 * The memory begins with a struct d3d9_channel. The rest of its first part is the client's, for the blocks of
 * calls and their arguments (packing.h). The second part is the server's arena (arena.h). Both processes map
 * it at the same address, below 2^32.
 *
 * A call is a message. The client writes messages one after another and counts them in `sent`; the server
 * executes them in this order and counts them in `done`. The client waits when it needs a result or room
 * (queue.h). A process that waits spins for a short time, then sleeps on the other one's count as a futex. */
#ifndef D3D9_REMOTE_CHANNEL_H
#define D3D9_REMOTE_CHANNEL_H

#include <stdalign.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    D3D9_CHANNEL_BYTES = 512 << 20, /* of memory, which the system provides as it is used */
    D3D9_CHANNEL_ARENA = 48 << 20,
    D3D9_CHANNEL_HEADER = 1 << 16, /* from here on the client may use the first part */
    D3D9_CHANNEL_MESSAGES = 4096   /* that are not executed, at most */
};

/* A call: its code, and the address of its block. */
struct d3d9_message {
    uint32_t code, block;
};
enum { D3D9_MESSAGE_END = -1 }; /* as a code: the client has ended */

/* All members have the same layout in both processes. The two processes write to different cache lines. */
struct d3d9_channel {
    uint32_t codes;         /* D3D9_CODE_COUNT of the client: both must have the same table of calls */
    uint32_t bytes, arena;  /* of the memory; where its second part begins */
    _Atomic uint32_t ready; /* 1 when the server has started */
    alignas(64) _Atomic uint32_t sent;
    _Atomic uint32_t client_sleeps;
    alignas(64) _Atomic uint32_t done;
    _Atomic uint32_t server_sleeps;
    int32_t result; /* of d3d9_dispatch for the last call that was executed */
    alignas(64) struct d3d9_message message[D3D9_CHANNEL_MESSAGES]; /* message i at i % their number */
};
_Static_assert(sizeof(struct d3d9_channel) <= D3D9_CHANNEL_HEADER,
               "the header of the memory is large enough");

/* Waits until the word is no longer `old`, or for about a fifth of a second. `sleeps` is 1 while this process
 * sleeps. */
void d3d9_channel_wait(_Atomic uint32_t *word, uint32_t old, _Atomic uint32_t *sleeps);
/* After a change of the word: wakes the other process if it sleeps. */
void d3d9_channel_wake(_Atomic uint32_t *word, const _Atomic uint32_t *sleeps);

/* --- The client --- */

struct d3d9_client {
    struct d3d9_channel *channel;
    int process; /* 0: there is no server, or it has ended */
};

/* Starts the program `server` and waits until it is ready. Returns 0, or -1 with a reason of one line. */
int d3d9_client_open(struct d3d9_client *client, const char *server, uint32_t codes, char *reason,
                     size_t bytes);
/* Wakes the server. `wait`: until it has executed all messages. Returns 0, or -1 if it has ended. */
int d3d9_client_send(struct d3d9_client *client, bool wait);
/* Ends the server and unmaps the memory. For tests: a program that ends leaves this to the server. */
void d3d9_client_close(struct d3d9_client *client);

/* --- The server --- */

/* Executes calls in the memory of this descriptor until the client or its process, `parent`, has ended.
 * Returns the exit status: 0, or 2 with a line on standard error if the memory cannot be mapped, is not that
 * of a client, or has a damaged call (check.h). Ends the process in the same way if a call crashes, because
 * the program has damaged memory of objects. */
int d3d9_serve(int descriptor, uint32_t address, int parent);

#endif
