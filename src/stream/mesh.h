/* Triangle meshes while they are made: read by an importer, finished here, then packed into a stream's
 * resource.
 *
 * Vertices are wide and uniform; a normal of zero means that the file has none there. Coordinates are the
 * file's, fronts are taken to be counter-clockwise in a right-handed system. Functions that return int return
 * 0, or -1 with one line of reason that begins with the file's path. */
#ifndef STREAM_MESH_H
#define STREAM_MESH_H

#include "stream/skeleton.h"
#include "stream/stream.h"

struct mesh_vertex {
    float position[3], normal[3], texcoord[2];
    uint32_t color;  /* 0xAARRGGBB */
    float weight[4]; /* of the bones, together 1; all 0 in a mesh without */
    uint8_t bone[4];
};

struct mesh {
    struct mesh_vertex *vertices;
    uint32_t *indices; /* three per triangle */
    uint32_t vertex_count, vertex_capacity;
    uint32_t index_count, index_capacity;
    int has_color, has_texcoord;
    struct skeleton *skeleton; /* or null */
};

void mesh_free(struct mesh *mesh);

/* Append; not past the limits of a stream. `path` is for the reason. */
int mesh_add_vertex(struct mesh *mesh, const char *path, const struct mesh_vertex *vertex,
                    struct error *error);
int mesh_add_triangle(struct mesh *mesh, const char *path, uint32_t a, uint32_t b, uint32_t c,
                      struct error *error);

/* The importers: all triangles of a model file that Assimp reads, with `bones` also its skeleton, in a process of its
 * own (import.c) that takes no more than the limits, if they are given; the cells of a BEZ file's patches. */
struct isolate_limits;
int mesh_read_model(struct mesh *mesh, const char *path, int bones, struct error *error);
int mesh_read_model_within(struct mesh *mesh, const char *path, int bones,
                           const struct isolate_limits *limits, struct error *error);
int mesh_read_bezier(struct mesh *mesh, const char *path, unsigned subdivisions, struct error *error);

/* What happens in that process: a damaged file can crash it. */
int model_import(struct mesh *mesh, const char *path, int bones, struct error *error);

/* Those without a file: the shapes of shape.c; the volume that a mesh keeps from a light. `name` begins
 * reasons. */
int mesh_make_shape(struct mesh *mesh, const char *name, const struct mesh_options *options,
                    struct error *error);
int mesh_make_shadow(struct mesh *mesh, const char *name, const struct mesh_options *options,
                     const struct resource *of, struct error *error);

/* Missing normals, texture coordinates, centre, size: what the options ask for. */
int mesh_finish(struct mesh *mesh, const char *path, const struct mesh_options *options, struct error *error);

/* All of it: reads the file at `path` and fills the resource's vertices, layout and indices. */
int mesh_load(struct resource *resource, const char *path, struct error *error);

/* The same without a file; `caster` is the mesh of a shadow. */
int mesh_make(struct resource *resource, const struct resource *caster, struct error *error);

/* Finds the extremes of its indices, which must be of vertices that it has. */
int mesh_check_indices(struct resource *resource, struct error *error);

#endif
