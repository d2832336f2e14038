/* Executes a call from its block. Takes the lock of the front end: calls of several threads are one after
 * another. */
#ifndef D3D9_DISPATCH_H
#define D3D9_DISPATCH_H

#include "block.h"

/* `block` is the structure of this code. Returns D3D9_DONE or D3D9_EVENTS; D3D9_BAD_CODE without executing
 * anything for a code that does not exist. */
int d3d9_dispatch(unsigned code, void *block);

#endif
