/* Files that a stream names: read when the text is, and held against the data that a container has of them. */
#ifndef STREAM_ASSET_H
#define STREAM_ASSET_H

#include "draw/texture.h"
#include "stream/stream.h"

struct shader;

/* Where a path of a stream leads: a relative one starts at the stream's folder. The caller frees it. */
char *asset_path(const char *stream_path, const char *path);

/* Refuses what exists and is no regular file: a pipe may never end, or never begin. */
int asset_check_path(const char *path, struct error *error);

/* Fills a resource from the file at a path. */
typedef int resource_loader(struct resource *resource, const char *path, struct error *error);
resource_loader asset_load_texture, asset_load_shader; /* and mesh_load */

/* A PNG into the level that is given of a face, of the texture's texels. */
int asset_load_face(struct resource *resource, const struct triptych_texture *shape, unsigned number,
                    const char *path, struct error *error);

/* Makes a shader the resource's: its program and its canonical text. Frees the shader. */
int asset_keep_shader(struct resource *resource, struct shader *shader, struct error *error);

/* Whether the resource's files are there and give the data that it has. */
int asset_is_unchanged(const struct stream *stream, const struct resource *resource);

/* Everything that a resource has. */
void resource_free(struct resource *resource);

#endif
