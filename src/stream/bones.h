/* Assimp's nodes, bones and animations as a skeleton (stream/skeleton.h). Apart from model.c's header,
 * because nothing else knows Assimp. */
#ifndef STREAM_BONES_H
#define STREAM_BONES_H

#include "stream/mesh.h"
#include "stream/skeleton.h"

#include <assimp/scene.h>

/* Joints, one a node, and animations; no bones yet. Null if memory is short, or for nodes nested too deep. */
struct skeleton *bones_read(const struct aiScene *scene, const char *path, struct error *error);

/* Adds the bones of a mesh that a node shows with this matrix, and lets the mesh's vertices from `first` on
 * follow them; those that follow none, and all of a mesh without bones, follow the node. */
int bones_add(struct mesh *mesh, const char *path, const struct aiMesh *source, const struct aiNode *node,
              const struct aiMatrix4x4 *matrix, uint32_t first, struct error *error);

#endif
