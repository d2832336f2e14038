/* A stream as a container: the resources in their order, then the calls in theirs. */
#include "container/codec.h"
#include "stream/container.h"
#include "stream/folder.h"

#include <stdlib.h>
#include <string.h>

struct writer {
    const struct stream *stream;
    char *prefix;
    struct chunk_writer chunks;
    struct codec codec; /* of one record after the other */
};

/* Begins a record of that type, which is written by end_record. */
static void begin_record(struct writer *writer, uint32_t type)
{
    writer->codec.bytes = 0;
    code_u8(&writer->codec, type, 0, "");
}

static void end_record(struct writer *writer)
{
    chunk_record(&writer->chunks, writer->codec.data, writer->codec.bytes);
}

/* The path from the new folder, which must not have become too long. */
static void move_path(struct writer *writer, char **path)
{
    if (!*path)
        return;
    *path = folder_join(writer->prefix, *path);
    if (!*path)
        codec_fail(&writer->codec, "not enough memory");
    else if (strlen(*path) > LIMIT_PATH_BYTES)
        codec_fail(&writer->codec, "a path of %zu bytes, expected at most %d", strlen(*path),
                   LIMIT_PATH_BYTES);
}

static void write_resource(struct writer *writer, uint32_t number)
{
    struct resource_part parts[RESOURCE_PARTS];
    struct resource copy = writer->stream->resources[number];
    enum { FACES = sizeof copy.face_path / sizeof *copy.face_path };
    if (copy.options.source == MESH_DATA)
        copy.path = NULL;
    move_path(writer, &copy.path);
    for (int face = 0; face < FACES; face++)
        move_path(writer, &copy.face_path[face]);
    begin_record(writer, RECORD_DEFINE);
    code_u32(&writer->codec, number, 0, "");
    code_u8(&writer->codec, copy.type, 0, "");
    resource_code(&writer->codec, &copy);
    end_record(writer);
    unsigned count = resource_parts(&copy, parts);
    for (unsigned i = 0; i < count; i++)
        chunk_data(&writer->chunks, parts[i].data, parts[i].bytes);
    free(copy.path);
    for (int face = 0; face < FACES; face++)
        free(copy.face_path[face]);
}

/* The call itself; sequences are defined here, where their calls are. */
static void write_call(struct writer *writer, const struct call *call)
{
    struct call copy = *call;
    if (call->type == CALL_SEQUENCE) {
        write_resource(writer, call->resource);
        return;
    }
    begin_record(writer, call->type);
    call_code(&writer->codec, &copy);
    end_record(writer);
    if (call->type == CALL_FRAME)
        chunk_frame(&writer->chunks);
}

static void write_all(struct writer *writer)
{
    const struct stream *stream = writer->stream;
    uint32_t end = UINT32_MAX; /* of the sequence that is open */
    for (uint32_t i = 0; i < stream->resource_count; i++)
        if (stream->resources[i].type != RESOURCE_SEQUENCE)
            write_resource(writer, i);
    for (uint32_t i = 0; i <= stream->call_count && !writer->codec.failed; i++) {
        if (i == end) {
            begin_record(writer, RECORD_END);
            end_record(writer);
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
        result = chunk_open(&writer.chunks, path, false, error);
    if (!result) {
        write_all(&writer);
        if (writer.codec.failed) {
            chunk_discard(&writer.chunks);
            result = error_set(error, "%s: %s", path, writer.codec.error.text);
        } else {
            result = chunk_close(&writer.chunks, error);
        }
    }
    free(writer.codec.data);
    free(writer.prefix);
    return result;
}
