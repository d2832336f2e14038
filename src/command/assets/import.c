/* Models of foreign formats, imported in a separate process.
 *
 * Assimp reads dozens of formats with hundreds of thousands of lines of C++. Damaged files crash it, let it
 * run forever or exhaust memory. So it runs in a fork (command/import/isolate.h) that opens the file, imports
 * it and sends the mesh back as bytes. These bytes are checked like those of any file
 * (command/assets/transfer.h). A file that kills the fork is refused with an error. */
#include "command/import/isolate.h"
#include "command/assets/mesh.h"
#include "command/assets/transfer.h"

#include <stdbool.h>
#include <stdlib.h>

struct request {
    const char *path;
    unsigned parts;
};

static int import(void *user, struct answer *answer, struct error *error)
{
    const struct request *request = user;
    struct mesh mesh = {0};
    if (mesh_import_model(&mesh, request->path, request->parts, error))
        return -1;
    return transfer_write(&mesh, answer) ? error_set(error, "%s: not enough memory", request->path) : 0;
}

int mesh_read_model_within(struct mesh *mesh, const char *path, unsigned parts,
                           const struct isolate_limits *limits, struct error *error)
{
    struct request request = {path, parts};
    struct answer answer;
    if (isolate_run(path, limits, import, &request, &answer, error))
        return -1;
    int result = transfer_read(path, answer.data, answer.bytes, mesh, error);
    free(answer.data);
    return result;
}

int mesh_read_model(struct mesh *mesh, const char *path, unsigned parts, struct error *error)
{
    static const struct isolate_limits limits = {
        .memory = (uint64_t)4 << 30, .seconds = 120, .milliseconds = 600000, .answer = LIMIT_STREAM_BYTES};
    return mesh_read_model_within(mesh, path, parts, &limits, error);
}
