/* Any bytes that an importer's process may send after a damaged file. An accepted mesh is valid, and equal
 * after being sent again. */
#include "command/assets/transfer.h"

#include "tests/command/fuzz/targets/target.h"

#include <string.h>

/* Poses at a time inside and one outside of every animation stay in bounds. */
static void expect_poses(const struct skeleton *skeleton)
{
    double(*matrices)[4][4] = malloc(skeleton->bone_count * sizeof *matrices);
    for (uint32_t a = 0; matrices && a < skeleton->animation_count; a++)
        expect(!skeleton_pose(skeleton, a, 0.4, matrices) && !skeleton_pose(skeleton, a, -1e30, matrices),
               "animation %u", a);
    free(matrices);
}

static void expect_same_again(const struct mesh *mesh)
{
    struct answer once = {0}, twice = {0};
    struct mesh again = {0};
    struct error error = {{0}};
    expect(!transfer_write(mesh, &once), "memory");
    expect(!transfer_read("fuzz", once.data, once.bytes, &again, &error), "%s", error.text);
    expect(!transfer_write(&again, &twice), "memory");
    expect(once.bytes == twice.bytes && !memcmp(once.data, twice.data, once.bytes), "%zu and %zu bytes",
           once.bytes, twice.bytes);
    mesh_free(&again);
    free(once.data);
    free(twice.data);
}

static void run(const uint8_t *data, size_t bytes)
{
    static const struct mesh_options options = {
        .normals = NORMALS_FLAT, .texcoords = TEXCOORDS_SPHERICAL, .fit = 2};
    struct mesh mesh = {0};
    struct error error = {{0}};
    if (transfer_read("fuzz", data, bytes, &mesh, &error)) {
        expect(!mesh.vertices && !mesh.indices && !mesh.skeleton, "a refused mesh");
        expect_refusal(&error, "fuzz");
        return;
    }
    expect_same_again(&mesh);
    if (mesh.skeleton)
        expect_poses(mesh.skeleton);
    if (mesh_finish(&mesh, "fuzz", &options, &error))
        expect_refusal(&error, "fuzz");
    mesh_free(&mesh);
}

const struct fuzz_target fuzz_transfer = {"transfer", run};
