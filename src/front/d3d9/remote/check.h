/* The server's check of a message: a program can damage the memory that it shares with the server. */
#ifndef D3D9_REMOTE_CHECK_H
#define D3D9_REMOTE_CHECK_H

#include "form.h"

/* Where arguments can be, and which addresses are memory that the arena has given out. */
struct d3d9_message_limits {
    uint64_t begin, end;
    bool (*is_allocated)(uint64_t address);
};

enum { D3D9_MESSAGE_BLOCK = 256 }; /* no block is larger */

/* Copies the block of a message. Returns null if the code exists, the block and all that it refers to are
 * memory for arguments, and the objects are objects with the right interfaces; otherwise what is wrong. */
const char *d3d9_message_check(const struct d3d9_message_limits *, unsigned code, uint64_t address,
                               uint8_t block[D3D9_MESSAGE_BLOCK]);

#endif
