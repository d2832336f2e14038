/* Files of Bezier patches, made into meshes by every option. The first five bytes choose them. */
#include "command/assets/mesh.h"
#include "command/store/store.h"
#include "tests/command/fuzz/targets/target.h"

#include <math.h>

static struct mesh_options options(struct choices *c)
{
    struct mesh_options options = {.source = MESH_BEZIER, .subdivisions = 1 + choose(c, 5)};
    options.normals = (enum normals)choose(c, 2);
    options.texcoords = (enum texcoords)choose(c, 4);
    options.center = (int)choose(c, 2);
    options.fit = (float)choose(c, 3);
    options.repeat[0] = options.repeat[1] = options.fit / 2;
    return options;
}

static void expect_mesh(const struct resource *mesh)
{
    expect(mesh->vertex_bytes == (size_t)mesh->vertex_count * mesh->layout.stride, "%zu", mesh->vertex_bytes);
    expect(mesh->index_count && mesh->index_count % 3 == 0, "%u indices", mesh->index_count);
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        const uint16_t *narrow = mesh->indices;
        const uint32_t *wide = mesh->indices;
        uint32_t index = mesh->index_bits == 16 ? narrow[i] : wide[i];
        expect(index < mesh->vertex_count, "index %u of %u vertices", index, mesh->vertex_count);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *position =
            (const float *)(const void *)(mesh->vertices + (size_t)v * mesh->layout.stride);
        expect(isfinite(position[0]) && isfinite(position[1]) && isfinite(position[2]), "vertex %u", v);
    }
}

static void run(const uint8_t *data, size_t bytes)
{
    struct choices choices = {data, data + bytes};
    struct resource mesh = {.options = options(&choices)};
    struct error error = {{0}};
    const char *path = fuzz_file(choices.at, (size_t)(choices.end - choices.at));
    fuzz_files = 1;
    store_off = true;
    if (mesh_load(&mesh, path, &error))
        expect_refusal(&error, path);
    else
        expect_mesh(&mesh);
    fuzz_files = 0;
    free(mesh.vertices);
    free(mesh.indices);
}

const struct fuzz_target fuzz_bezier = {"bezier", run};
