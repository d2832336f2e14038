#include "command/stream/build.h"

#include <stdlib.h>
#include <string.h>

void stream_build_start(struct builder *builder, struct stream *stream)
{
    *builder = (struct builder){.stream = stream, .sequence = NO_RESOURCE};
}

void stream_build_free(struct builder *builder)
{
    free(builder->names.slot);
    builder->names = (struct hash_table){0};
}

/* --- Names ---------------------------------------------------------------------------------------------- */

bool stream_build_is_name(const char *name, size_t length)
{
    if (!length || length > LIMIT_NAME_BYTES)
        return false;
    for (size_t i = 0; i < length; i++) {
        char c = name[i], letter = (char)(c | 32);
        bool first = (letter >= 'a' && letter <= 'z') || c == '_';
        if (!first && (i == 0 || !((c >= '0' && c <= '9') || c == '-' || c == '.')))
            return false;
    }
    return !(length == 4 && !memcmp(name, "none", 4));
}

struct wanted_name {
    const struct stream *stream;
    const char *name;
    size_t length;
};

static bool is_name_of(const void *context, uint32_t number)
{
    const struct wanted_name *wanted = context;
    const char *name = wanted->stream->resources[number - 1].name;
    return strlen(name) == wanted->length && !memcmp(name, wanted->name, wanted->length);
}

static uint32_t hash_name(const char *name, size_t length)
{
    uint32_t hash = 2166136261; /* FNV-1a */
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)name[i]) * 16777619;
    return hash ^ hash >> 15;
}

static uint32_t hash_resource(const void *stream, uint32_t number)
{
    const char *name = ((const struct stream *)stream)->resources[number - 1].name;
    return hash_name(name, strlen(name));
}

/* Returns the slot of a name, or the free slot where it belongs. */
static uint32_t find_slot(const struct builder *builder, const char *name, size_t length)
{
    const struct wanted_name wanted = {builder->stream, name, length};
    return hash_find(builder->names, hash_name(name, length), is_name_of, &wanted);
}

uint32_t stream_build_find(const struct builder *builder, const char *name, size_t length)
{
    uint32_t number = builder->names.slot ? hash_get(builder->names, find_slot(builder, name, length)) : 0;
    return number ? number - 1 : NO_RESOURCE;
}

/* --- Resources ------------------------------------------------------------------------------------------ */

static int grow(void **array, uint32_t count, uint32_t *capacity, size_t size)
{
    if (count < *capacity)
        return 0;
    void *larger = realloc(*array, (*capacity ? 2 * (size_t)*capacity : 16) * size);
    if (!larger)
        return -1;
    *array = larger;
    *capacity = *capacity ? 2 * *capacity : 16;
    return 0;
}

int stream_build_resource(struct builder *builder, const char *name, size_t length, enum resource_type type,
                          struct resource **resource, struct error *error)
{
    struct stream *stream = builder->stream;
    if (stream->resource_count == LIMIT_NAMES)
        return error_set(error, "found '%.*s', expected at most %d names", (int)length, name, LIMIT_NAMES);
    if (hash_reserve(&builder->names, stream->resource_count, hash_resource, stream) ||
        grow((void **)&stream->resources, stream->resource_count, &builder->resource_capacity,
             sizeof **resource))
        return error_set(error, "not enough memory");
    uint32_t slot = find_slot(builder, name, length);
    if (hash_get(builder->names, slot))
        return error_set(error, "found '%.*s', expected a name that is not in use", (int)length, name);
    struct resource *made = &stream->resources[stream->resource_count];
    *made = (struct resource){.type = type, .name = strndup(name, length)};
    if (!made->name)
        return error_set(error, "not enough memory");
    hash_set(builder->names, slot, ++stream->resource_count);
    *resource = made;
    return 0;
}

int stream_build_account(struct builder *builder, size_t bytes, struct error *error)
{
    builder->bytes += bytes;
    if (builder->bytes > LIMIT_STREAM_BYTES)
        return error_set(error, "found more than %d bytes of resources, expected less", LIMIT_STREAM_BYTES);
    return 0;
}

void stream_build_extremes(struct resource *resource)
{
    const uint16_t *narrow = resource->indices;
    const uint32_t *wide = resource->indices;
    resource->index_least = UINT32_MAX;
    resource->index_most = 0;
    for (uint32_t i = 0; i < resource->index_count; i++) {
        uint32_t index = resource->index_bits == 16 ? narrow[i] : wide[i];
        resource->index_least = index < resource->index_least ? index : resource->index_least;
        resource->index_most = index > resource->index_most ? index : resource->index_most;
    }
}

/* --- Calls ---------------------------------------------------------------------------------------------- */

static uint32_t *executed_here(struct builder *builder)
{
    return builder->sequence == NO_RESOURCE ? &builder->executed
                                            : &builder->stream->resources[builder->sequence].executed;
}

static uint32_t *frames_here(struct builder *builder)
{
    return builder->sequence == NO_RESOURCE ? &builder->frames
                                            : &builder->stream->resources[builder->sequence].frames;
}

int stream_build_play(struct builder *builder, uint32_t number, struct error *error)
{
    struct resource *resources = builder->stream->resources;
    const struct resource *played = &resources[number];
    if (number == builder->sequence)
        return error_set(error, "found '%s' playing itself, expected a sequence that has ended",
                         played->name);
    if (builder->sequence != NO_RESOURCE) {
        struct resource *sequence = &resources[builder->sequence];
        if (sequence->depth < played->depth + 1)
            sequence->depth = played->depth + 1;
        if (sequence->depth > LIMIT_DEPTH)
            return error_set(error, "found sequences %u deep, expected at most %d", sequence->depth,
                             LIMIT_DEPTH);
    }
    *executed_here(builder) += played->executed;
    *frames_here(builder) += played->frames;
    return 0;
}

static void begin_sequence(struct builder *builder, const struct call *call)
{
    struct resource *sequence = &builder->stream->resources[call->resource];
    sequence->call = builder->stream->call_count - 1;
    sequence->depth = 1;
    builder->sequence = call->resource;
}

static void note_changes(struct stream *stream, struct call *call)
{
    for (const struct call_field *f = call_row(call->type)->fields; (f = call_next_resource(f)); f++) {
        uint32_t number = *call_resource(call, f);
        if ((f->types & CALL_TEXTURES || number == call->resource) && number != NO_RESOURCE)
            stream->resources[number].changes = true;
    }
}

int stream_build_call(struct builder *builder, const struct call *call, struct error *error)
{
    struct stream *stream = builder->stream;
    if (stream->call_count == LIMIT_CALLS)
        return error_set(error, "found one more call, expected at most %d", LIMIT_CALLS);
    if (grow((void **)&stream->calls, stream->call_count, &builder->call_capacity, sizeof *call))
        return error_set(error, "not enough memory");
    struct call *made = &stream->calls[stream->call_count++];
    *made = *call;
    if (call_row(call->type)->traits & CALL_CHANGES)
        note_changes(stream, made);
    if (call->type == CALL_SEQUENCE) {
        begin_sequence(builder, call);
        return 0;
    }
    if (call->type == CALL_FRAME)
        ++*frames_here(builder);
    /* Plays have added at most LIMIT_EXECUTED to a number of at most LIMIT_EXECUTED, so there is no
     * overflow. */
    if (++*executed_here(builder) > LIMIT_EXECUTED)
        return error_set(error, "found more calls with sequences played, expected at most %d",
                         LIMIT_EXECUTED);
    return 0;
}

void stream_build_end(struct builder *builder)
{
    struct stream *stream = builder->stream;
    const struct resource *sequence = &stream->resources[builder->sequence];
    stream->calls[sequence->call].sequence.count = stream->call_count - sequence->call - 1;
    builder->sequence = NO_RESOURCE;
}
