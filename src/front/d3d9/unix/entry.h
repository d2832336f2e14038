/* The functions of the Unix library, by number, and their parameters. */
#ifndef D3D9_UNIX_ENTRY_H
#define D3D9_UNIX_ENTRY_H

#include <stdint.h>

enum { D3D9_UNIX_CALL };

/* D3D9_UNIX_CALL: executes a call (block.h). */
struct d3d9_unix_call {
    uint32_t code;
    int32_t result; /* of d3d9_dispatch */
    uint64_t block;
};

#endif
