/* Finished meshes in the cache (command/store/store.h). */
#ifndef COMMAND_ASSETS_KEPT_H
#define COMMAND_ASSETS_KEPT_H

#include "command/assets/mesh.h"

#include <stdbool.h>

/* Fills an empty mesh with the one that mesh_finish made of the same files with the same options. Returns
 * false with an empty mesh if there is none. */
bool kept_find(const char *path, const struct mesh_options *options, struct mesh *mesh);

/* Keeps a finished mesh. */
void kept_add(const char *path, const struct mesh_options *options, const struct mesh *mesh);

#endif
