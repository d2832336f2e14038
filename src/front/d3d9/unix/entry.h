/* The functions of the Unix library, by number, and their parameters. A 64-bit program has the first one;
 * a 32-bit program the others. All members have the same layout in Windows and Linux. */
#ifndef D3D9_UNIX_ENTRY_H
#define D3D9_UNIX_ENTRY_H

#include <stdint.h>

enum { D3D9_UNIX_CALL, D3D9_UNIX_OPEN = 0, D3D9_UNIX_WAIT, D3D9_UNIX_WAKE };

/* D3D9_UNIX_CALL: executes a call (block.h). */
struct d3d9_unix_call {
    uint32_t code;
    int32_t result; /* of d3d9_dispatch */
    uint64_t block;
};

/* D3D9_UNIX_OPEN: starts the server and returns the address of the shared memory (remote/channel.h);
 * fails with a line on standard error. */
struct d3d9_unix_open {
    uint32_t codes; /* D3D9_CODE_COUNT */
    uint32_t memory;
};

/* D3D9_UNIX_WAIT and D3D9_UNIX_WAKE have no parameters: they wake the server if it sleeps; the first one
 * waits until it has executed all messages. They fail if the server has ended. */

#endif
