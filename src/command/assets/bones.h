/* Assimp's nodes, bones and animations as a skeleton (command/assets/skeleton.h). Only this header and
 * model.c depend on Assimp. */
#ifndef COMMAND_ASSETS_BONES_H
#define COMMAND_ASSETS_BONES_H

#include "command/assets/mesh.h"
#include "command/assets/skeleton.h"

#include <assimp/scene.h>

/* Reads one joint per node, and the animations, but no bones. Returns null if memory is short or nodes are
 * nested too deeply. */
struct skeleton *bones_read(const struct aiScene *scene, const char *path, struct error *error);

/* Adds the bones of a mesh that a node shows with this matrix. The mesh's vertices from `first` on follow
 * them. Vertices without bones follow the node. */
int bones_add(struct mesh *mesh, const char *path, const struct aiMesh *source, const struct aiNode *node,
              const struct aiMatrix4x4 *matrix, uint32_t first, struct error *error);

#endif
