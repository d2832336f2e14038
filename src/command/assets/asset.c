#include "command/assets/asset.h"
#include "base/file.h"
#include "image/png.h"
#include "shader/program/program.h"
#include "command/assets/dds.h"
#include "command/assets/mesh.h"
#include "command/assets/paint.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

char *asset_path(const char *stream_path, const char *path)
{
    const char *slash = file_is_standard(stream_path) ? NULL : strrchr(stream_path, '/');
    size_t folder = slash && path[0] != '/' ? (size_t)(slash - stream_path) + 1 : 0;
    char *joined = malloc(folder + strlen(path) + 1);
    if (joined) {
        memcpy(joined, stream_path, folder);
        strcpy(joined + folder, path);
    }
    return joined;
}

int asset_check_path(const char *path, struct error *error)
{
    struct stat status;
    if (!stat(path, &status) && !S_ISREG(status.st_mode))
        return error_set(error, "%s: is not a regular file, expected one", path);
    return 0;
}

/* --- Textures --- */

static int load_png(struct resource *resource, const char *path, const char *data, size_t bytes,
                    struct error *error)
{
    unsigned width, height;
    uint32_t *rgba;
    if (png_decode(path, data, bytes, &width, &height, &rgba, error))
        return -1;
    resource->source = TEXTURE_IMAGE;
    resource->texels = (uint8_t *)rgba;
    paint_describe_image(resource, width, height);
    return 0;
}

static int load_dds(struct resource *resource, const char *path, char *data, size_t bytes,
                    struct error *error)
{
    size_t offset;
    resource->source = TEXTURE_DDS;
    resource->texels = (uint8_t *)data;
    if (dds_read(path, data, bytes, &resource->texture, &offset, error))
        return -1;
    resource->texel_bytes = bytes - offset;
    memmove(data, data + offset, resource->texel_bytes);
    return 0;
}

int asset_decode_texture(struct resource *resource, const char *path, char *data, size_t bytes,
                         struct error *error)
{
    if (dds_is(data, bytes))
        return load_dds(resource, path, data, bytes, error);
    int result = load_png(resource, path, data, bytes, error);
    free(data);
    return result;
}

int asset_load_texture(struct resource *resource, const char *path, struct error *error)
{
    char *data;
    size_t bytes;
    if (asset_check_path(path, error) || file_read(path, LIMIT_FILE_BYTES, &data, &bytes, error))
        return -1;
    return asset_decode_texture(resource, path, data, bytes, error);
}

/* Each picture is stored in `colors` while it is encoded into its face. */
int asset_load_face(struct resource *resource, const struct triptych_texture *shape, unsigned number,
                    const char *path, struct error *error)
{
    struct resource face = {.source = TEXTURE_FILES, .texture = resource->texture, .mips = 1};
    struct triptych_texture alone = *shape;
    unsigned width, height;
    alone.faces = 1;
    face.texels = resource->texels + number * texture_level_bytes(shape, 0);
    if (asset_check_path(path, error) || png_load(path, &width, &height, &face.colors, error))
        return -1;
    int result = 0;
    if (width != shape->width || height != shape->height)
        result = error_set(error, "%s: %u x %u pixels, expected %u x %u", path, width, height, shape->width,
                           shape->height);
    if (!result)
        result = paint_texture(&face, &alone, error);
    free(face.colors);
    return result;
}

/* --- Shaders --- */

int asset_keep_shader(struct resource *resource, struct shader *shader, struct error *error)
{
    resource->program = program_acquire(shader, error);
    int result = resource->program ? shader_print(shader, &resource->code, &resource->code_bytes, error) : -1;
    shader_free(shader);
    return result;
}

int asset_load_shader(struct resource *resource, const char *path, struct error *error)
{
    struct shader *shader;
    if (asset_check_path(path, error))
        return -1;
    return shader_load(path, &shader, error) ? -1 : asset_keep_shader(resource, shader, error);
}

/* --- Comparing --- */

static void free_texture(struct resource *resource)
{
    free(resource->texels);
    free(resource->colors);
    for (unsigned face = 0; face < CUBE_FACES; face++)
        free(resource->face_path[face]);
}

void asset_free_materials(struct resource *resource)
{
    if (resource->materials)
        material_free_all(resource->materials);
    free(resource->materials);
    resource->materials = NULL;
}

void asset_free(struct resource *resource)
{
    free(resource->name);
    free(resource->path);
    if (resource->type == RESOURCE_TEXTURE)
        free_texture(resource);
    if (resource_has_geometry(resource)) {
        free(resource->vertices);
        free(resource->indices);
        skeleton_free(resource->skeleton);
        asset_free_materials(resource);
    }
    if (resource->type == RESOURCE_SHADER) {
        free(resource->code);
        free(resource->written);
        program_release(resource->program);
    }
    *resource = (struct resource){.type = resource->type};
}

static int load_faces(const struct stream *stream, const struct resource *resource, struct resource *fresh,
                      struct error *error)
{
    struct triptych_texture shape;
    int result = texture_describe(&resource->texture, &shape, error) ? -1 : 0;
    fresh->texel_bytes = resource->texel_bytes;
    fresh->texels = calloc(resource->texel_bytes, 1);
    for (unsigned face = 0; face < shape.faces && !result; face++) {
        char *path = asset_path(stream->path, resource->face_path[face]);
        result = path && fresh->texels ? asset_load_face(fresh, &shape, face, path, error) : -1;
        free(path);
    }
    return result;
}

/* Loads the resource again from its file. */
static int load_again(const struct stream *stream, const struct resource *resource, struct resource *fresh,
                      struct error *error)
{
    static resource_loader *const loaders[] = {[RESOURCE_TEXTURE] = asset_load_texture,
                                               [RESOURCE_MESH] = mesh_load,
                                               [RESOURCE_SHADER] = asset_load_shader};
    if (!resource->path)
        return load_faces(stream, resource, fresh, error);
    char *path = asset_path(stream->path, resource->path);
    int result = path ? loaders[resource->type](fresh, path, error) : -1;
    free(path);
    return result;
}

static bool same_parts(const struct resource *a, const struct resource *b)
{
    struct resource_part part_a[RESOURCE_PARTS], part_b[RESOURCE_PARTS];
    unsigned count = resource_parts(a, part_a);
    bool same = count == resource_parts(b, part_b);
    for (unsigned i = 0; i < count && same; i++)
        same = part_a[i].bytes == part_b[i].bytes && !memcmp(part_a[i].data, part_b[i].data, part_a[i].bytes);
    return same;
}

static bool same_shape(const struct resource *a, const struct resource *b)
{
    if (a->type == RESOURCE_TEXTURE)
        return a->source == b->source && !memcmp(&a->texture, &b->texture, sizeof a->texture);
    if (a->type == RESOURCE_MESH)
        return !memcmp(&a->layout, &b->layout, sizeof a->layout) && a->index_bits == b->index_bits;
    return true;
}

bool asset_is_unchanged(const struct stream *stream, const struct resource *resource)
{
    struct error ignored = {{0}};
    struct resource fresh = {.type = resource->type};
    if (resource->type == RESOURCE_TEXTURE) {
        fresh.texture = resource->texture;
        fresh.source = resource->source;
        fresh.mips = resource->mips;
    } else if (resource->type == RESOURCE_MESH) {
        fresh.options = resource->options;
    }
    int same = !load_again(stream, resource, &fresh, &ignored) && same_shape(&fresh, resource) &&
               same_parts(&fresh, resource);
    asset_free(&fresh);
    return same;
}
