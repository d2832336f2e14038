/* Triangle meshes under construction: filled by an importer, completed here, then packed into a stream's
 * resource.
 *
 * All vertices have all members; a normal of zero means that the file has none. Coordinates are those of the
 * file. Fronts are counter-clockwise in a right-handed system. Functions that return int return 0, or -1 with
 * a reason of one line that begins with the file's path. */
#ifndef COMMAND_ASSETS_MESH_H
#define COMMAND_ASSETS_MESH_H

#include "command/assets/skeleton.h"
#include "command/import/material.h"
#include "command/store/files.h"
#include "command/stream/stream.h"

#include <stdbool.h>

struct mesh_vertex {
    float position[3], normal[3], texcoord[2];
    uint32_t color;  /* 0xAARRGGBB */
    float weight[4]; /* of the bones; their sum is 1, or 0 in a mesh without bones */
    uint8_t bone[4];
};

struct mesh {
    struct mesh_vertex *vertices;
    uint32_t *indices; /* three per triangle */
    uint32_t vertex_count, vertex_capacity;
    uint32_t index_count, index_capacity;
    bool has_color, has_texcoord;
    struct skeleton *skeleton;  /* or null */
    struct materials materials; /* of all triangles, in their order; or none */
    struct store_files files;   /* all that determine it */
};

void mesh_free(struct mesh *mesh);

/* Append a vertex or a triangle, within the limits of a stream. `path` is for the reason. */
int mesh_add_vertex(struct mesh *mesh, const char *path, const struct mesh_vertex *vertex,
                    struct error *error);
int mesh_add_triangle(struct mesh *mesh, const char *path, uint32_t a, uint32_t b, uint32_t c,
                      struct error *error);

/* Parts of a model that are read on request: its skeleton; its materials, which also determine the order of
 * the triangles. */
enum model_part { MODEL_BONES = 1, MODEL_MATERIALS = 2 };

/* The importers. mesh_read_model reads all triangles of a model file that Assimp supports and the given
 * parts, a mask of enum model_part. It runs in a separate process (import.c), within the limits if they are
 * given. mesh_read_bezier reads the patches of a BEZ file. */
struct isolate_limits;
int mesh_read_model(struct mesh *mesh, const char *path, unsigned parts, struct error *error);
/* For tests: small limits. */
int mesh_read_model_within(struct mesh *mesh, const char *path, unsigned parts,
                           const struct isolate_limits *limits, struct error *error);
int mesh_read_bezier(struct mesh *mesh, const char *path, unsigned subdivisions, struct error *error);

/* The import itself, in that process: a damaged file can crash it. */
int mesh_import_model(struct mesh *mesh, const char *path, unsigned parts, struct error *error);

/* Meshes without a file: the shapes of shape.c, and the shadow volume of a mesh. `name` begins reasons. */
int mesh_make_shape(struct mesh *mesh, const char *name, const struct mesh_options *options,
                    struct error *error);
int mesh_make_shadow(struct mesh *mesh, const char *name, const struct mesh_options *options,
                     const struct resource *of, struct error *error);

/* Computes what the options select: missing normals, texture coordinates, centre, size. For tests: each
 * option by itself. */
int mesh_finish(struct mesh *mesh, const char *path, const struct mesh_options *options, struct error *error);

/* Reads the file at `path` and fills the resource's vertices, layout and indices. */
int mesh_load(struct resource *resource, const char *path, struct error *error);

/* The same without a file; `caster` is the mesh whose shadow is made. */
int mesh_make(struct resource *resource, const struct resource *caster, struct error *error);

/* Finds the least and the greatest index. Fails if one is not that of a vertex. */
int mesh_check_indices(struct resource *resource, struct error *error);

#endif
