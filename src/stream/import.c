/* Models of foreign formats, imported in a process of its own.
 *
 * Assimp reads dozens of formats with hundreds of thousands of lines of C++, and damaged files crash it, let it run
 * forever or take all memory. So it does its work in a fork (stream/isolate.h) that opens the file, imports it and
 * sends the mesh back as bytes, which are checked like those of any file (stream/transfer.h). A file that ends the
 * fork's life is refused with a line. */
#include "stream/isolate.h"
#include "stream/mesh.h"
#include "stream/transfer.h"

#include <stdlib.h>

struct request {
    const char *path;
    int bones;
};

static int import(void *user, struct answer *answer, struct error *error)
{
    const struct request *request = user;
    struct mesh mesh = {0};
    if (model_import(&mesh, request->path, request->bones, error))
        return -1;
    return transfer_write(&mesh, answer) ? error_set(error, "%s: not enough memory", request->path) : 0;
}

int mesh_read_model_within(struct mesh *mesh, const char *path, int bones,
                           const struct isolate_limits *limits, struct error *error)
{
    struct request request = {path, bones};
    struct answer answer;
    if (isolate(path, limits, import, &request, &answer, error))
        return -1;
    int result = transfer_read(path, answer.data, answer.bytes, mesh, error);
    free(answer.data);
    return result;
}

int mesh_read_model(struct mesh *mesh, const char *path, int bones, struct error *error)
{
    static const struct isolate_limits limits = {
        .memory = (uint64_t)4 << 30, .seconds = 120, .milliseconds = 600000, .answer = LIMIT_STREAM_BYTES};
    return mesh_read_model_within(mesh, path, bones, &limits, error);
}
