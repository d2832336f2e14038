/* A stream as a container: the resources in their order, then the calls in theirs. */
#include "capture/write.h"
#include "command/container/container.h"
#include "command/assets/folder.h"

#include <stdlib.h>
#include <string.h>

struct writer {
    const struct stream *stream;
    char *prefix;
    struct record_writer write;
};

/* The path from the new folder, which must not have become too long. */
static void move_path(struct writer *writer, char **path)
{
    if (!*path)
        return;
    *path = folder_join(writer->prefix, *path);
    if (!*path)
        codec_fail(&writer->write.codec, "not enough memory");
    else if (strlen(*path) > LIMIT_PATH_BYTES)
        codec_fail(&writer->write.codec, "a path of %zu bytes, expected at most %d", strlen(*path),
                   LIMIT_PATH_BYTES);
}

static void write_resource(struct writer *writer, uint32_t number)
{
    struct resource copy = writer->stream->resources[number];
    enum { FACES = sizeof copy.face_path / sizeof *copy.face_path };
    if (copy.type == RESOURCE_MESH && copy.options.source == MESH_DATA)
        copy.path = NULL;
    move_path(writer, &copy.path);
    for (int face = 0; face < FACES && copy.type == RESOURCE_TEXTURE; face++)
        move_path(writer, &copy.face_path[face]);
    record_write_definition(&writer->write, number, &copy);
    free(copy.path);
    for (int face = 0; face < FACES && copy.type == RESOURCE_TEXTURE; face++)
        free(copy.face_path[face]);
}

/* The call itself; sequences are defined here, where their calls are. */
static void write_call(struct writer *writer, const struct call *call)
{
    if (call->type == CALL_SEQUENCE)
        write_resource(writer, call->resource);
    else
        record_write_call(&writer->write, call);
}

static void write_all(struct writer *writer)
{
    const struct stream *stream = writer->stream;
    uint32_t end = UINT32_MAX; /* of the sequence that is open */
    for (uint32_t i = 0; i < stream->resource_count; i++)
        if (stream->resources[i].type != RESOURCE_SEQUENCE)
            write_resource(writer, i);
    for (uint32_t i = 0; i <= stream->call_count && !writer->write.codec.failed; i++) {
        if (i == end) {
            record_write_end(&writer->write);
            end = UINT32_MAX;
        }
        if (i == stream->call_count)
            break;
        write_call(writer, &stream->calls[i]);
        if (stream->calls[i].type == CALL_SEQUENCE)
            end = i + 1 + stream->calls[i].sequence.count;
    }
}

int container_save(const struct stream *stream, const char *path, struct error *error)
{
    struct writer writer = {.stream = stream};
    int result = folder_prefix(stream, path, &writer.prefix, error);
    if (!result)
        result = chunk_open(&writer.write.chunks, path, false, error);
    if (!result) {
        write_all(&writer);
        result = chunk_close(&writer.write.chunks, error);
    }
    free(writer.write.codec.data);
    free(writer.prefix);
    return result;
}
