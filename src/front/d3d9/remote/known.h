/* Calls whose results are certain before the server has executed them (known.def). */
#ifndef D3D9_REMOTE_KNOWN_H
#define D3D9_REMOTE_KNOWN_H

#include "front/d3d9/block.h"

#include <stdbool.h>

/* Returns true if the call succeeds and writes nothing, so the client need not wait for it. `block` is the
 * program's. */
bool d3d9_known(unsigned code, const void *block);

/* AddRef and Release that neither begin nor end a program's use of an object: changes its count, sets the
 * result and returns true. The server never changes counts while it executes calls of known.def. */
bool d3d9_known_count(unsigned code, void *block);

#endif
