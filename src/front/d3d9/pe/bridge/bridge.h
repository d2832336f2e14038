/* Calls from the Windows side into the Linux side, through Wine's interface between a builtin DLL and its
 * Unix library. The functions of call.h are defined here too (invoke.c): each fills a block and makes a
 * bridge_call. */
#ifndef D3D9_PE_BRIDGE_H
#define D3D9_PE_BRIDGE_H

#include "front/d3d9/block.h"

/* Connects to the Unix library, and executes `then` the first time. Returns 0 if the library is missing. */
int bridge_start(void (*then)(void));

/* Returns nonzero after a successful bridge_start. */
int bridge_has_started(void);

/* Executes the call of this code, then the events that it left. */
void bridge_call(unsigned code, void *block);

#endif
