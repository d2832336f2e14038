/* Calls of a 32-bit program, in memory that it shares with the server: a copy of the call's block, and copies
 * of all that its arguments refer to. Nothing here calls Windows or Linux, so both sides compile it.
 *
 * Addresses of objects and of locked memory are the same in both processes, because these lie in the shared
 * memory; they are passed on unchanged. */
#ifndef D3D9_REMOTE_PACKING_H
#define D3D9_REMOTE_PACKING_H

#include "front/d3d9/block.h"

#include <stdbool.h>
#include <stddef.h>

/* The free part of the shared memory for a call. */
struct d3d9_packing {
    uint8_t *at, *end;
    bool full; /* there was no room for something */
};

/* Takes memory of the call, aligned to 16 bytes. Returns its address; 0, and sets `full`, if there is not
 * enough. */
uint64_t d3d9_packing_take(struct d3d9_packing *packing, uint64_t bytes);

/* Copies the block of a call and what it refers to. Returns the block of the server; null if the memory was
 * too small or the code does not exist. */
void *d3d9_pack(struct d3d9_packing *packing, unsigned code, const void *block);

/* Instead of the call: gives its block a result that reports that it has failed. A result that is a number or
 * an address is 0 then. */
void d3d9_pack_result(unsigned code, void *block, int32_t result);

/* After the call: copies its results to the program's block and to what this refers to. */
void d3d9_unpack(unsigned code, void *block, void *shared);

#endif
