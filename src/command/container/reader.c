#include "command/container/reader.h"
#include "command/assets/asset.h"
#include "command/stream/build.h"
#include "command/stream/valid.h"
#include "command/stream/follow.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct stream_reader {
    const struct stream *stream;
    struct stream window;
    struct chunk_reader chunks;
    struct follower *follower;
    size_t bytes;      /* of the live resources */
    uint32_t defined;  /* resources, in all */
    uint32_t capacity; /* of the window's resources */
};

/* --- Opening -------------------------------------------------------------------------------------------- */

/* Returns true if the file can be read as it is played. */
static bool is_recording(int descriptor, const char *path)
{
    struct chunk_reader chunks;
    struct error ignored = {{0}};
    if (chunk_read_file(&chunks, path, descriptor, 0, &ignored))
        return false;
    bool recording = chunks.recording;
    chunk_reader_free(&chunks);
    return recording;
}

static int count_frames(const struct stream *stream, uint32_t *frames, struct error *error)
{
    struct chunk_reader chunks;
    uint64_t count = 0;
    if (chunk_read_file(&chunks, stream->path, stream->descriptor, 0, error))
        return -1;
    int result = chunk_find_end(&chunks, &count, error);
    chunk_reader_free(&chunks);
    if (!result && (!count || count >= UINT32_MAX))
        return error_set(error, "%s: found %" PRIu64 " frames, expected 1 to %" PRIu32, stream->path, count,
                         UINT32_MAX - 1);
    *frames = (uint32_t)count;
    return result;
}

/* Opening a pipe and closing it again would end the process that writes to it. */
static int open_regular(const char *path)
{
    struct stat status;
    return stat(path, &status) || !S_ISREG(status.st_mode) ? -1 : open(path, O_RDONLY | O_CLOEXEC);
}

int container_open(const char *path, struct stream **stream, struct error *error)
{
    *stream = NULL;
    int descriptor = open_regular(path);
    if (descriptor < 0 || !is_recording(descriptor, path)) {
        if (descriptor >= 0)
            close(descriptor);
        return stream_read(path, stream, error);
    }
    struct stream *made = calloc(1, sizeof *made);
    char *copy = strdup(path);
    if (!made || !copy) {
        free(made);
        free(copy);
        close(descriptor);
        return error_set(error, "%s: not enough memory", path);
    }
    *made = (struct stream){.path = copy, .container = true, .streamed = true, .descriptor = descriptor};
    if (count_frames(made, &made->frame_count, error)) {
        stream_free(made);
        return -1;
    }
    *stream = made;
    return 0;
}

/* --- Readers -------------------------------------------------------------------------------------------- */

static void forget(struct stream_reader *reader)
{
    for (uint32_t i = 0; i < reader->window.resource_count; i++)
        asset_free(&reader->window.resources[i]);
    reader->window.resource_count = 0;
    reader->bytes = 0;
    reader->defined = 0;
    chunk_reader_free(&reader->chunks);
    follower_free(reader->follower);
    reader->follower = NULL;
}

int reader_rewind(struct stream_reader *reader, struct error *error)
{
    forget(reader);
    reader->follower = follower_create(&reader->window);
    if (!reader->follower)
        return error_set(error, "%s: not enough memory", reader->stream->path);
    return chunk_read_file(&reader->chunks, reader->stream->path, reader->stream->descriptor, 0, error);
}

struct stream_reader *reader_create(const struct stream *stream, struct error *error)
{
    struct stream_reader *reader = calloc(1, sizeof *reader);
    if (!reader) {
        error_set(error, "%s: not enough memory", stream->path);
        return NULL;
    }
    reader->stream = stream;
    reader->window =
        (struct stream){.path = stream->path, .container = true, .frame_count = stream->frame_count};
    reader->chunks.descriptor = -1;
    if (!reader_rewind(reader, error))
        return reader;
    reader_free(reader);
    return NULL;
}

void reader_free(struct stream_reader *reader)
{
    if (!reader)
        return;
    forget(reader);
    free(reader->window.resources);
    free(reader);
}

const struct stream *reader_window(const struct stream_reader *reader)
{
    return &reader->window;
}

/* --- Records -------------------------------------------------------------------------------------------- */

/* Room for the number, and for all below it. */
static int reserve(struct stream_reader *reader, uint32_t number, struct error *error)
{
    struct stream *window = &reader->window;
    if (number >= reader->capacity) {
        uint32_t capacity = 2 * number + 16;
        struct resource *larger = realloc(window->resources, capacity * sizeof *larger);
        if (!larger)
            return error_set(error, "not enough memory");
        window->resources = larger;
        reader->capacity = capacity;
    }
    while (window->resource_count <= number)
        window->resources[window->resource_count++] = (struct resource){.type = RESOURCE_SEQUENCE};
    return 0;
}

/* Resources of recordings have names only in reasons and reports. */
static int name(struct stream_reader *reader, struct resource *resource, struct error *error)
{
    char text[LIMIT_NAME_BYTES];
    reader->defined++;
    if (resource->name)
        return 0;
    snprintf(text, sizeof text, "%s%" PRIu32, container_type_name(resource->type), reader->defined - 1);
    resource->name = strdup(text);
    return resource->name ? 0 : error_set(error, "not enough memory");
}

static int define(struct stream_reader *reader, struct record *record, struct error *error)
{
    struct resource *resource = &record->resource;
    if (resource->type == RESOURCE_SEQUENCE || resource->type == RESOURCE_MESH)
        return error_set(error, "found a %s in a recording, expected none",
                         container_type_name(resource->type));
    if (reserve(reader, record->number, error))
        return -1;
    if (reader->window.resources[record->number].name)
        return error_set(error, "found resource %" PRIu32 " defined again, expected a number that is free",
                         record->number);
    if (name(reader, resource, error) || container_finish_resource(resource, NULL, error))
        return -1;
    reader->bytes += resource_cost(resource);
    reader->window.resources[record->number] = *resource;
    follower_define(reader->follower, record->number);
    return 0;
}

static int follow_read(struct stream_reader *reader, struct call *call, struct error *error)
{
    struct error reason = {{0}};
    if (call->type == CALL_FRAME)
        return follower_frame(reader->follower, error);
    if (call->type == CALL_PLAY)
        error_set(&reason, "found a play in a recording, expected none");
    else
        valid_call(&reader->window, call, &reason);
    if (*reason.text)
        return stream_fail(&reader->window, call, reason.text, error);
    return follower_call(reader->follower, call, error);
}

int reader_next(struct stream_reader *reader, struct step *step, struct error *error)
{
    struct record record;
    struct error reason = {{0}};
    if (container_next(&reader->chunks, LIMIT_STREAM_BYTES - reader->bytes, &record, error))
        return -1;
    step->type = record.type;
    step->number = record.number;
    if (record.type == RECORD_IS_CALL) {
        step->call = record.call;
        return follow_read(reader, &step->call, error);
    }
    if (record.type == RECORD_IS_END)
        error_set(&reason, "found the end of a sequence in a recording, expected none");
    if (record.type == RECORD_IS_RESOURCE && define(reader, &record, &reason))
        asset_free(&record.resource);
    return *reason.text ? chunk_fail(&reader->chunks, record.byte, error, "%s", reason.text) : 0;
}

void reader_release(struct stream_reader *reader, uint32_t number)
{
    struct resource *resource = &reader->window.resources[number];
    reader->bytes -= resource_cost(resource);
    asset_free(resource);
}

void reader_drop_texels(struct stream_reader *reader, uint32_t number)
{
    struct resource *resource = &reader->window.resources[number];
    if (resource->type != RESOURCE_TEXTURE)
        return;
    free(resource->texels);
    free(resource->colors);
    resource->texels = NULL;
    resource->colors = NULL;
}
