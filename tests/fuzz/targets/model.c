/* Files of foreign formats on the whole of their way: into a process of its own, through Assimp, and back. The first
 * byte chooses the format by which the file is named, the second whether bones are asked for. Assimp crashes, hangs and
 * takes all memory; that is a refusal as any other, noted by its reason. */
#include "stream/isolate.h"
#include "stream/mesh.h"
#include "tests/fuzz/targets/target.h"

#include <fcntl.h>
#include <pthread.h>
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

/* The end of an importer's process is no finding, so a sanitizer there must not tell libFuzzer. */
void __sanitizer_set_death_callback(void (*callback)(void)) __attribute__((weak));

static void forget_callback(void)
{
    if (__sanitizer_set_death_callback)
        __sanitizer_set_death_callback(NULL);
}

static uint32_t size_of(uint32_t count)
{
    return count ? 32 - (uint32_t)__builtin_clz(count) : 0;
}

static void run(const uint8_t *data, size_t bytes)
{
    static const struct isolate_limits limits = {
        .memory = 256 << 20, .seconds = 2, .milliseconds = 8000, .answer = 16 << 20};
    static const struct mesh_options options = {.normals = NORMALS_SMOOTH};
    static int prepared;
    struct choices choices = {data, data + bytes};
    if (!prepared++)
        pthread_atfork(NULL, NULL, forget_callback);
    struct mesh mesh = {0};
    struct error error = {{0}};
    unsigned format = choose(&choices, FORMATS), bones = choose(&choices, 2);
    const char *path = write_model(format, choices.at, (size_t)(choices.end - choices.at));
    if (mesh_read_model_within(&mesh, path, (int)bones, &limits, &error)) {
        expect(!mesh.vertices && !mesh.indices && !mesh.skeleton, "a refused mesh");
        expect_refusal(&error, path);
    } else {
        expect(!error.text[0], "%s", error.text);
        fuzz_note(format | size_of(mesh.vertex_count) << 8 | size_of(mesh.index_count) << 16 |
                  (mesh.has_color ? 1u << 24 : 0) | (mesh.has_texcoord ? 1u << 25 : 0) | bones << 26);
        if (mesh_finish(&mesh, path, &options, &error))
            expect_refusal(&error, path);
    }
    unlink(path);
    mesh_free(&mesh);
}

const struct fuzz_target fuzz_model = {"model", run};
