/* Limits for the streams of a fuzzer. The usual limits of a stream (command/stream/limit.def) allow long
 * work, but an input should take a millisecond. The linker puts these functions before those of the same
 * names (--wrap). A refusal is an ordinary error, so the readers' error paths run more often than usual. */
#include "base/file.h"
#include "command/stream/build.h"
#include "command/container/container.h"
#include "command/assets/mesh.h"
#include "tests/command/fuzz/targets/target.h"

#include <string.h>

enum { BYTES = 1 << 20, CELLS = 1 << 10 };

int fuzz_files;

int __real_stream_build_account(struct builder *builder, size_t bytes, struct error *error);
int __real_mesh_make(struct resource *resource, const struct resource *caster, struct error *error);
int __real_file_read(const char *path, size_t limit, char **data, size_t *bytes, struct error *error);
int __wrap_stream_build_account(struct builder *builder, size_t bytes, struct error *error);
int __real_container_next(struct chunk_reader *reader, size_t room, struct record *record,
                          struct error *error);
int __wrap_container_next(struct chunk_reader *reader, size_t room, struct record *record,
                          struct error *error);
int __wrap_mesh_make(struct resource *resource, const struct resource *caster, struct error *error);
int __wrap_file_read(const char *path, size_t limit, char **data, size_t *bytes, struct error *error);
int __wrap_mesh_read_model(struct mesh *mesh, const char *path, unsigned parts, struct error *error);

int __wrap_stream_build_account(struct builder *builder, size_t bytes, struct error *error)
{
    if (bytes > BYTES || builder->bytes + bytes > BYTES)
        return error_set(error, "found more bytes of resources than a fuzzer has patience for");
    return __real_stream_build_account(builder, bytes, error);
}

/* Readers of recordings count for themselves. */
int __wrap_container_next(struct chunk_reader *reader, size_t room, struct record *record,
                          struct error *error)
{
    size_t used = LIMIT_STREAM_BYTES - room;
    return __real_container_next(reader, used < BYTES ? BYTES - used : 0, record, error);
}

int __wrap_mesh_make(struct resource *resource, const struct resource *caster, struct error *error)
{
    const struct mesh_options *options = &resource->options;
    if ((uint64_t)options->cells[0] * options->cells[1] > CELLS)
        return error_set(error, "%s: more cells than a fuzzer has patience for", resource->name);
    return __real_mesh_make(resource, caster, error);
}

/* Refuses to read files, so that a stream cannot read files of the machine. */
int __wrap_file_read(const char *path, size_t limit, char **data, size_t *bytes, struct error *error)
{
    if (fuzz_files && (!strncmp(path, "/proc/self/fd/", 14) || strstr(path, "/fuzz-")))
        return __real_file_read(path, limit, data, bytes, error);
    *data = NULL;
    *bytes = 0;
    return error_set(error, "%s: no file for a fuzzer", path);
}

/* Models of other formats have a target that limits an import. */
int __wrap_mesh_read_model(struct mesh *mesh, const char *path, unsigned parts, struct error *error)
{
    (void)mesh;
    (void)parts;
    return error_set(error, "%s: no model for a fuzzer", path);
}
