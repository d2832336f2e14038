/* Model files of other formats: Assimp reads them, they become a mesh, and a process sends the mesh to
 * another. The first byte of the input chooses the format of the file's name. The second byte chooses if
 * bones and materials are read, and if the file is read by its own process, as usual, or by a process that
 * has read other files (importer.h). Assimp may crash, hang or exhaust memory. Each of these is a refusal,
 * noted with its reason. If other code crashes, the file is read again by its own process, because an earlier
 * file may have damaged the memory. */
#include "command/assets/mesh.h"
#include "command/assets/transfer.h"
#include "tests/command/fuzz/targets/importer.h"
#include "tests/command/fuzz/targets/target.h"

#include <fcntl.h>
#include <string.h>
#include <unistd.h>

static const char *const formats[] = {"obj", "ply", "3ds",     "gltf", "glb",  "stl", "off", "x",
                                      "dae", "md2", "md5mesh", "smd",  "ac",   "ase", "b3d", "fbx",
                                      "lwo", "nff", "dxf",     "raw",  "ms3d", "cob"};

enum { FORMATS = sizeof formats / sizeof *formats };

static const char *write_model(unsigned format, const uint8_t *data, size_t bytes)
{
    const char *path = fuzz_path(formats[format]);
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    expect(file >= 0 && write(file, data, bytes) == (ssize_t)bytes && !close(file), "a file");
    return path;
}

static uint32_t size_of(uint32_t count)
{
    return count ? 32 - (uint32_t)__builtin_clz(count) : 0;
}

/* Imports in a process of its own, as mesh_read_model() does. */
static int import_alone(struct mesh *mesh, const char *path, unsigned parts, struct error *error)
{
    static const struct isolate_limits limits = {
        .memory = 256 << 20, .seconds = 1, .milliseconds = 4000, .answer = 16 << 20};
    static const char ended[] = ": reading it ended ";
    int result = mesh_read_model_within(mesh, path, parts, &limits, error);
    int died = result && !strncmp(error->text + strlen(path), ended, sizeof ended - 1);
    expect(!died || importer_died_in_assimp(), "%s", error->text);
    return result;
}

static int import(struct mesh *mesh, const char *path, unsigned parts, struct error *error)
{
    struct answer answer;
    switch (importer_run(path, parts, &answer, error)) {
    case IMPORT_REFUSED: return -1;
    case IMPORT_DIED:
        if (importer_died_in_assimp())
            return -1;
        error_clear(error);
        return import_alone(mesh, path, parts, error);
    case IMPORT_ANSWERED: break;
    }
    int result = transfer_read(path, answer.data, answer.bytes, mesh, error);
    expect(!result, "%s", error->text);
    free(answer.data);
    return result;
}

static void expect_finishes(struct mesh *mesh, const char *path)
{
    static const struct mesh_options options = {.normals = NORMALS_SMOOTH};
    struct error error = {{0}};
    if (mesh_finish(mesh, path, &options, &error))
        expect_refusal(&error, path);
}

static void run(const uint8_t *data, size_t bytes)
{
    struct choices choices = {data, data + bytes};
    struct mesh mesh = {0};
    struct error error = {{0}};
    unsigned format = choose(&choices, FORMATS), way = choose(&choices, 16), parts = way & 3;
    importer_prepare();
    const char *path = write_model(format, choices.at, (size_t)(choices.end - choices.at));
    fuzz_files = 1;
    if ((way < 15 ? import : import_alone)(&mesh, path, parts, &error)) {
        expect(!mesh.vertices && !mesh.indices && !mesh.skeleton, "a refused mesh");
        expect_refusal(&error, path);
    } else {
        expect(!error.text[0], "%s", error.text);
        fuzz_note(format | size_of(mesh.vertex_count) << 8 | size_of(mesh.index_count) << 16 |
                  (mesh.has_color ? 1u << 24 : 0) | (mesh.has_texcoord ? 1u << 25 : 0) | parts << 26);
        expect_finishes(&mesh, path);
    }
    fuzz_files = 0;
    unlink(path);
    mesh_free(&mesh);
}

const struct fuzz_target fuzz_model = {"model", run};
