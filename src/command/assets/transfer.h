/* A mesh with its skeleton as bytes, sent from the importing process (command/import/isolate.h).
 *
 * Both processes run the same program, so numbers and arrays are sent as they are in memory. A file may have
 * compromised the importing process, so the reader checks every value. */
#ifndef COMMAND_ASSETS_TRANSFER_H
#define COMMAND_ASSETS_TRANSFER_H

#include "command/import/isolate.h"
#include "command/assets/mesh.h"

/* Returns 0, or -1 if memory is short. */
int transfer_write(const struct mesh *mesh, struct answer *answer);

/* Fills an empty mesh; it is empty again after a failure. The result is within the limits of a stream.
 * Numbers are finite where importers guarantee it (mesh_add_vertex). Indices, bones and joints are in range.
 * Parents precede their joints. Names have no control characters. Memory is bounded by a small multiple of
 * `bytes`. */
int transfer_read(const char *path, const void *data, size_t bytes, struct mesh *mesh, struct error *error);

#endif
