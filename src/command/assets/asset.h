/* Files that a stream names: read together with its text, and compared with the copies of their data in a
 * container. */
#ifndef COMMAND_ASSETS_ASSET_H
#define COMMAND_ASSETS_ASSET_H

#include "render/texture/texture.h"
#include "command/stream/stream.h"

#include <stdbool.h>

struct shader;

/* Resolves a path in a stream; relative paths start at the stream's folder. The caller frees the result. */
char *asset_path(const char *stream_path, const char *path);

/* Fails if the path exists and is not a regular file. A pipe might never end, or never begin. */
int asset_check_path(const char *path, struct error *error);

/* Fills a resource from the file at a path. */
typedef int resource_loader(struct resource *resource, const char *path, struct error *error);
resource_loader asset_load_texture, asset_load_shader; /* and mesh_load (mesh.h) */

/* Fills a texture from the bytes of a PNG or DDS file, and frees them. `path` is for the reason. */
int asset_decode_texture(struct resource *resource, const char *path, char *data, size_t bytes,
                         struct error *error);

/* Frees the materials of a mesh, which are needed only while a text is read. */
void asset_free_materials(struct resource *resource);

/* Reads a PNG into one face of the given level, in the texture's format. */
int asset_load_face(struct resource *resource, const struct triptych_texture *shape, unsigned number,
                    const char *path, struct error *error);

/* Gives a shader to the resource: its program and its canonical text. Frees the shader. */
int asset_keep_shader(struct resource *resource, struct shader *shader, struct error *error);

/* Returns true if the resource's files exist and give the data that the resource has. */
bool asset_is_unchanged(const struct stream *stream, const struct resource *resource);

/* Everything that a resource has. */
void asset_free(struct resource *resource);

#endif
