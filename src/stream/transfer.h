/* A mesh with its skeleton as bytes, from the process that imports it to the one that wants it (stream/isolate.h). Both
 * are the same program, so numbers and arrays are as they lie in memory; but the one that imports may have been led
 * astray by the file, so the reader takes nothing for granted. */
#ifndef STREAM_TRANSFER_H
#define STREAM_TRANSFER_H

#include "stream/isolate.h"
#include "stream/mesh.h"

/* Returns -1 if memory is short. */
int transfer_write(const struct mesh *mesh, struct answer *answer);

/* The mesh is empty before, and after a failure. What it is afterwards is within the limits of a stream, numbers are
 * finite where an importer promises it (mesh_add_vertex), indices, bones and joints are there, joints stand behind their
 * parents, and names have no control characters. Memory is at most some times that of the bytes. */
int transfer_read(const char *path, const void *data, size_t bytes, struct mesh *mesh, struct error *error);

#endif
