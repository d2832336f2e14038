/* Containers read: record after record, and as whole streams. */
#include "command/container/container.h"
#include "base/file.h"
#include "capture/codec.h"
#include "capture/layout.h"
#include "shader/shader.h"
#include "command/assets/asset.h"
#include "command/stream/build.h"
#include "command/stream/valid.h"
#include "command/stream/expand.h"
#include "command/stream/follow.h"
#include "command/stream/lex.h"
#include "command/assets/mesh.h"
#include "command/assets/paint.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Records -------------------------------------------------------------------------------------------- */

/* Moves on to a chunk with contents left, if there is one. */
static int fill(struct chunk_reader *reader, struct error *error)
{
    while (!reader->ended && reader->at == reader->bytes)
        if (chunk_next(reader, error))
            return -1;
    return 0;
}

/* The bytes of the chunk from the next one on. */
static struct codec codec_of(const struct chunk_reader *reader)
{
    return (struct codec){
        .data = reader->contents, .bytes = reader->bytes, .at = reader->at, .reading = true};
}

/* Data grow as they arrive: what a header claims is not reserved. */
static int read_data(struct chunk_reader *reader, size_t bytes, void **data, struct error *error)
{
    size_t have = 0, capacity = 0;
    uint8_t *made = NULL;
    while (have < bytes) {
        if (fill(reader, error))
            break;
        size_t part = reader->bytes - reader->at;
        part = part < bytes - have ? part : bytes - have;
        if (reader->ended || have + part > capacity) {
            capacity = have + part > bytes / 2 ? bytes : 2 * (have + part);
            uint8_t *larger = reader->ended ? NULL : realloc(made, capacity);
            if (!larger) {
                chunk_fail(reader, reader->at, error, "%s",
                           reader->ended ? "found the end, expected data of a resource"
                                         : "not enough memory");
                break;
            }
            made = larger;
        }
        memcpy(made + have, reader->contents + reader->at, part);
        reader->at += part;
        have += part;
    }
    if (have == bytes) {
        *data = made;
        return 0;
    }
    free(made);
    return -1;
}

static int read_parts(struct chunk_reader *reader, struct resource *resource, struct error *error)
{
    struct resource_part parts[RESOURCE_PARTS];
    unsigned count = resource_parts(resource, parts);
    for (unsigned i = 0; i < count; i++) {
        void *data;
        if (read_data(reader, parts[i].bytes, &data, error))
            return -1;
        resource_set_part(resource, i, data);
    }
    resource->embedded = count != 0;
    return 0;
}

static struct call_position position_of(const struct chunk_reader *reader, size_t byte)
{
    return (struct call_position){.kind = POSITION_CONTAINER, .container = {reader->chunk, (uint32_t)byte}};
}

static int read_definition(struct chunk_reader *reader, struct codec *codec, size_t room,
                           struct record *record, struct error *error)
{
    struct resource *resource = &record->resource;
    size_t begin = reader->at;
    record->type = RECORD_IS_RESOURCE;
    record->number = codec_u32(codec, 0, NO_RESOURCE - 1, "resource");
    *resource = (struct resource){.type = codec_u8(codec, 0, RESOURCE_TYPES - 1, "type of resource")};
    if (!codec->failed)
        resource_code(codec, resource);
    if (!codec->failed && container_check_definition(resource, room, &codec->error))
        codec->failed = true;
    reader->at = codec->at;
    int result = codec->failed ? chunk_fail(reader, begin, error, "%s", codec->error.text)
                               : read_parts(reader, resource, error);
    if (result)
        asset_free(resource);
    return result;
}

int container_next(struct chunk_reader *reader, size_t room, struct record *record, struct error *error)
{
    record->type = RECORD_NONE;
    if (fill(reader, error))
        return -1;
    if (reader->ended)
        return 0;
    struct codec codec = codec_of(reader);
    size_t begin = record->byte = reader->at;
    unsigned type = codec_u8(&codec, 0, RECORD_END, "record");
    reader->all_records++;
    if (type == RECORD_DEFINE)
        return read_definition(reader, &codec, room, record, error);
    if (type == RECORD_END) {
        record->type = RECORD_IS_END;
    } else if (codec.failed || !call_row(type) || type == CALL_SEQUENCE) {
        codec_fail(&codec, "found a record of type %u, expected a call, 64 or 65", type);
    } else {
        record->type = RECORD_IS_CALL;
        record->call.type = (enum call_type)type;
        record->call.position = position_of(reader, begin);
        call_code(&codec, &record->call);
    }
    reader->at = codec.at;
    if (!codec.failed)
        return 0;
    const char *word = record->type == RECORD_IS_CALL ? call_row(type)->word : NULL;
    return chunk_fail(reader, begin, error, "%s%s%s", word ? word : "", word ? ": " : "", codec.error.text);
}

/* --- What definitions imply ----------------------------------------------------------------------------- */

static int finish_texture(struct resource *resource, struct error *error)
{
    struct triptych_texture shape;
    if (resource->texels)
        return 0;
    texture_describe(&resource->texture, &shape, NULL);
    resource->texels = calloc(resource->texel_bytes, 1);
    if (!resource->texels)
        return error_set(error, "not enough memory");
    return resource->source == TEXTURE_EMPTY ? 0 : paint_texture(resource, &shape, error);
}

/* The front end's functions need a locale that writes numbers with a point. */
static int finish_shader(struct resource *resource, struct error *error)
{
    struct shader *shader;
    char *text = resource->code;
    size_t bytes = resource->code_bytes;
    locale_t locale = newlocale(LC_NUMERIC_MASK, "C", NULL);
    if (!locale)
        return error_set(error, "not enough memory");
    locale_t before = uselocale(locale);
    resource->code = NULL;
    int result = shader_assemble(resource->name ? resource->name : "shader", text, bytes, &shader, error);
    if (!result)
        result = asset_keep_shader(resource, shader, error);
    uselocale(before);
    freelocale(locale);
    free(text);
    return result;
}

static int finish_mesh(struct resource *resource, const struct resource *caster, struct error *error)
{
    if (!resource->vertices &&
        (resource->options.source == MESH_SHADOW && (!caster || caster->type != RESOURCE_MESH)))
        return error_set(error, "found a shadow without a mesh, expected one defined before");
    if (!resource->vertices && mesh_make(resource, caster, error))
        return -1;
    return mesh_check_indices(resource, error);
}

int container_finish_resource(struct resource *resource, const struct resource *caster, struct error *error)
{
    bool geometry = resource_has_geometry(resource);
    int result = geometry && resource->vertices ? valid_vertex_bits(resource, error) : 0;
    if (result)
        return -1;
    if (resource->type == RESOURCE_TEXTURE)
        result = finish_texture(resource, error);
    else if (resource->type == RESOURCE_SHADER)
        result = finish_shader(resource, error);
    else if (resource->type == RESOURCE_MESH)
        result = finish_mesh(resource, caster, error);
    else if (geometry && resource->indices)
        stream_build_extremes(resource);
    return result;
}

/* --- Whole streams -------------------------------------------------------------------------------------- */

struct whole {
    struct chunk_reader reader;
    struct builder build;
    struct stream *stream;
    uint32_t *slots; /* the resource that each number of the container means now, or NO_RESOURCE */
    /* Up to the last frame's end. */
    uint32_t whole_calls, whole_resources, whole_executed;
};

const char *container_type_name(enum resource_type type)
{
    static const char *const name[] = {
        [RESOURCE_TEXTURE] = "texture", [RESOURCE_VERTICES] = "vertices", [RESOURCE_INDICES] = "indices",
        [RESOURCE_BUFFER] = "buffer",   [RESOURCE_MESH] = "mesh",         [RESOURCE_SHADER] = "shader",
        [RESOURCE_QUERY] = "query",     [RESOURCE_SEQUENCE] = "sequence", [RESOURCE_IMAGE] = "image"};
    return name[type];
}

/* Names that recordings leave out are made of the type and the number. */
static int name_resource(const struct whole *whole, struct record *record, char name[LIMIT_NAME_BYTES + 1])
{
    if (record->resource.name)
        return snprintf(name, LIMIT_NAME_BYTES + 1, "%s", record->resource.name);
    return snprintf(name, LIMIT_NAME_BYTES + 1, "%s%u", container_type_name(record->resource.type),
                    whole->stream->resource_count);
}

static int begin_sequence(struct whole *whole, uint32_t resource, struct error *error)
{
    struct call call = {.type = CALL_SEQUENCE, .resource = resource};
    call.position = position_of(&whole->reader, whole->reader.at);
    return stream_build_call(&whole->build, &call, error);
}

static int add_resource(struct whole *whole, struct record *record, struct error *error)
{
    char name[LIMIT_NAME_BYTES + 1];
    struct resource *made, *from = &record->resource;
    bool shadow = from->type == RESOURCE_MESH && from->options.source == MESH_SHADOW;
    uint32_t caster = shadow ? from->options.caster : 0;
    int length = name_resource(whole, record, name);
    bool sequence = from->type == RESOURCE_SEQUENCE;
    if (whole->build.sequence != NO_RESOURCE) {
        error_set(error, "found a definition in a sequence, expected calls");
    } else if (whole->slots[record->number] != NO_RESOURCE) {
        error_set(error, "found resource %u defined again, expected a number that is free", record->number);
    } else if (shadow && (from->options.caster = whole->slots[caster]) == NO_RESOURCE) {
        error_set(error, "found a shadow of resource %u, expected a mesh defined before", caster);
    } else if (!stream_build_account(&whole->build, resource_cost(from), error) &&
               !stream_build_resource(&whole->build, name, (size_t)length, from->type, &made, error)) {
        char *kept = made->name;
        free(from->name);
        *made = *from;
        made->name = kept;
        uint32_t number = whole->stream->resource_count - 1;
        whole->slots[record->number] = number;
        const struct resource *of = &whole->stream->resources[shadow ? made->options.caster : 0];
        if (container_finish_resource(made, of, error))
            return -1;
        return sequence ? begin_sequence(whole, number, error) : 0;
    }
    asset_free(from);
    return -1;
}

/* From numbers of the container to those of the stream. */
static int translate(struct whole *whole, struct call *call, struct error *error)
{
    for (const struct call_field *f = call_row(call->type)->fields; (f = call_next_resource(f)); f++) {
        uint32_t *number = call_resource(call, f);
        if (*number == NO_RESOURCE && f->or_none)
            continue;
        if (*number >= NO_RESOURCE || whole->slots[*number] == NO_RESOURCE)
            return error_set(error, "found resource %u, expected one defined before", *number);
        uint32_t slot = *number;
        *number = whole->slots[slot];
        if (call->type == CALL_RELEASE)
            whole->slots[slot] = NO_RESOURCE;
    }
    return 0;
}

static int add_call(struct whole *whole, struct call *call, struct error *error)
{
    struct error reason = {{0}};
    bool inside = whole->build.sequence != NO_RESOURCE;
    if (inside && call_row(call->type)->traits & CALL_OUTSIDE)
        return stream_fail(whole->stream, call, "found in a sequence, expected it outside of sequences",
                           error);
    if (translate(whole, call, &reason) || valid_call(whole->stream, call, &reason) ||
        (call->type == CALL_PLAY && stream_build_play(&whole->build, call->resource, &reason)) ||
        stream_build_call(&whole->build, call, &reason))
        return stream_fail(whole->stream, call, reason.text, error);
    if (call->type == CALL_FRAME && !inside) {
        whole->whole_calls = whole->stream->call_count;
        whole->whole_resources = whole->stream->resource_count;
        whole->whole_executed = whole->build.executed;
    }
    return 0;
}

static int end_sequence(struct whole *whole, struct error *error)
{
    if (whole->build.sequence == NO_RESOURCE)
        return error_set(error, "found the end of a sequence, expected one that has begun");
    stream_build_end(&whole->build);
    return 0;
}

static int read_records(struct whole *whole, struct error *error)
{
    for (;;) {
        struct record record;
        struct error reason = {{0}};
        if (container_next(&whole->reader, LIMIT_STREAM_BYTES - whole->build.bytes, &record, error))
            return -1;
        if (record.type == RECORD_NONE)
            return 0;
        if (record.type == RECORD_IS_CALL && add_call(whole, &record.call, error))
            return -1;
        if ((record.type == RECORD_IS_RESOURCE && add_resource(whole, &record, &reason)) ||
            (record.type == RECORD_IS_END && end_sequence(whole, &reason)))
            return chunk_fail(&whole->reader, record.byte, error, "%s", reason.text);
    }
}

/* Nothing is left after the end of the last frame: of a recording, and of what was read before something was
 * wrong. That may be a resource, defined and not finished. */
static int cut(struct whole *whole, struct error *error)
{
    struct stream *stream = whole->stream;
    if (!whole->whole_calls)
        return error_set(error, "%s: found no end of a frame, expected at least one", stream->path);
    stream->call_count = whole->whole_calls;
    while (stream->resource_count > whole->whole_resources)
        asset_free(&stream->resources[--stream->resource_count]);
    whole->build.executed = whole->whole_executed;
    whole->build.sequence = NO_RESOURCE;
    error_clear(error);
    return 0;
}

static int finish(struct whole *whole, struct error *error)
{
    struct stream *stream = whole->stream;
    if (whole->build.sequence != NO_RESOURCE)
        return chunk_fail(&whole->reader, whole->reader.at, error,
                          "found the end of the container, expected that of sequence %s",
                          stream->resources[whole->build.sequence].name);
    if (stream_expand(stream, whole->build.executed, error))
        return -1;
    if (!stream->frame_count)
        return error_set(error, "%s: found no call that is executed, expected at least one", stream->path);
    return follower_check(stream, error);
}

static int read_whole(struct whole *whole, const void *data, size_t bytes, unsigned flags,
                      struct error *error)
{
    if (chunk_read_memory(&whole->reader, whole->stream->path, data, bytes, flags, error))
        return -1;
    int result = read_records(whole, error);
    if (result ? flags & CONTAINER_SALVAGE : whole->reader.recording)
        result = cut(whole, error);
    if (!result)
        result = finish(whole, error);
    chunk_reader_free(&whole->reader);
    return result;
}

int container_parse(const char *path, const void *data, size_t bytes, unsigned flags, struct stream **stream,
                    struct error *error)
{
    struct whole whole = {.stream = calloc(1, sizeof *whole.stream),
                          .slots = malloc(NO_RESOURCE * sizeof *whole.slots)};
    int result = -1;
    *stream = NULL;
    if (whole.stream)
        whole.stream->path = strdup(path);
    if (!whole.stream || !whole.stream->path || !whole.slots) {
        error_set(error, "%s: not enough memory", path);
    } else {
        for (uint32_t i = 0; i < NO_RESOURCE; i++)
            whole.slots[i] = NO_RESOURCE;
        whole.stream->container = true;
        stream_build_start(&whole.build, whole.stream);
        result = read_whole(&whole, data, bytes, flags, error);
        stream_build_free(&whole.build);
    }
    free(whole.slots);
    if (result)
        stream_free(whole.stream);
    else
        *stream = whole.stream;
    return result;
}

int container_read(const char *path, unsigned flags, struct stream **stream, struct error *error)
{
    char *data;
    size_t bytes;
    *stream = NULL;
    if (file_read(path, LIMIT_FILE_BYTES, &data, &bytes, error))
        return -1;
    int result = container_parse(path, data, bytes, flags, stream, error);
    free(data);
    return result;
}
