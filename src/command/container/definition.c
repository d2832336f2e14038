/* Checks of the definitions of resources in containers, before their data are read. */
#include "command/container/container.h"
#include "command/stream/build.h"
#include "command/stream/lex.h"
#include "command/assets/asset.h"

#include <string.h>

/* The limits of the text. */
static int check_size(const struct resource *resource, size_t room, struct error *error)
{
    if (resource_cost(resource) > room)
        return error_set(error, "found more than %d bytes of resources, expected less", LIMIT_STREAM_BYTES);
    bool geometry = resource_has_geometry(resource);
    if (geometry && resource->vertex_count > LIMIT_VERTICES)
        return error_set(error, "found %u vertices, expected at most %d", resource->vertex_count,
                         LIMIT_VERTICES);
    if (geometry && resource->index_count > LIMIT_VALUES)
        return error_set(error, "found %u indices, expected at most %d", resource->index_count, LIMIT_VALUES);
    if (resource->type == RESOURCE_SHADER && resource->code_bytes > LIMIT_FILE_BYTES)
        return error_set(error, "found a shader of %zu bytes, expected at most %d", resource->code_bytes,
                         LIMIT_FILE_BYTES);
    return 0;
}

static bool positive(float number)
{
    return number > 0 && number <= 3.4028234e38f;
}

/* The conditions of command/text/parse_mesh.c. */
static int check_mesh(const struct resource *resource, struct error *error)
{
    const struct mesh_options *o = &resource->options;
    bool shape = o->source >= MESH_GRID && o->source <= MESH_TORUS;
    int least = o->source == MESH_GRID ? 1 : 3, least_down = o->source == MESH_SPHERE ? 2 : least;
    if (o->source == MESH_CYLINDER)
        least_down = 1;
    if (shape && ((int)o->cells[0] < least || (int)o->cells[1] < least_down || o->cells[0] > LIMIT_CELLS ||
                  o->cells[1] > LIMIT_CELLS))
        return error_set(error, "found a shape of %u x %u cells, expected at most %d each way", o->cells[0],
                         o->cells[1], LIMIT_CELLS);
    if (!shape && (o->cells[0] || o->cells[1]))
        return error_set(error, "found cells of a mesh that is not a shape, expected none");
    if (o->source == MESH_TORUS ? !positive(o->tube) : o->tube != 0)
        return error_set(error, "found a tube of radius %g, expected one only for a torus", (double)o->tube);
    if (o->fit != 0 && !positive(o->fit))
        return error_set(error, "found a size of %g, expected more than 0", (double)o->fit);
    if ((o->repeat[0] != 0 || o->repeat[1] != 0) && !(positive(o->repeat[0]) && positive(o->repeat[1])))
        return error_set(error, "found a repetition that is not positive, expected two that are");
    if (o->source == MESH_BEZIER ? !o->subdivisions || o->subdivisions > LIMIT_SUBDIVISIONS
                                 : o->subdivisions != 0)
        return error_set(error, "found %u subdivisions, expected 1 to %d of a Bézier file", o->subdivisions,
                         LIMIT_SUBDIVISIONS);
    return 0;
}

static int check_more_mesh(const struct resource *resource, struct error *error)
{
    const struct mesh_options *o = &resource->options;
    bool model = o->source == MESH_FILE || o->source == MESH_MODEL;
    bool file = model || o->source == MESH_BEZIER;
    if (file != (resource->path != NULL))
        return error_set(error, "found a mesh %s path, expected one only for meshes from files",
                         file ? "without a" : "with a");
    if ((o->normals || o->bones) && !model)
        return error_set(error, "found options of a model, expected them of one");
    if ((o->texcoords || o->center || o->fit != 0) && !file)
        return error_set(error, "found options of a file, expected them of one");
    if (o->repeat[0] != 0 && (o->source == MESH_SHADOW || o->source == MESH_DATA))
        return error_set(error, "found repeated texture coordinates, expected them of a shape or a file");
    for (int i = 0; i < 3 && o->source == MESH_SHADOW; i++)
        if (!(o->light[i] >= -3.4028234e38f && o->light[i] <= 3.4028234e38f) || !positive(o->length))
            return error_set(error, "found a shadow of a light that is not finite, expected one that is");
    return 0;
}

static int check_strings(const struct resource *resource, struct error *error)
{
    if (resource->name && !stream_build_is_name(resource->name, strlen(resource->name)))
        return error_set(error, "found an invalid name, expected a letter or _, then letters, digits, _ - .");
    if (resource->path && !lex_is_utf8(resource->path, strlen(resource->path)))
        return error_set(error, "found a path that is not UTF-8, expected one that is");
    for (int face = 0; face < CUBE_FACES && resource->type == RESOURCE_TEXTURE; face++)
        if (resource->face_path[face] &&
            !lex_is_utf8(resource->face_path[face], strlen(resource->face_path[face])))
            return error_set(error, "found a path that is not UTF-8, expected one that is");
    return 0;
}

int container_check_definition(const struct resource *resource, size_t room, struct error *error)
{
    if (check_size(resource, room, error) || check_strings(resource, error))
        return -1;
    return resource->type == RESOURCE_MESH &&
                   (check_mesh(resource, error) || check_more_mesh(resource, error))
               ? -1
               : 0;
}
