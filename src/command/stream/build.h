/* A stream under construction. All readers append resources and calls with these functions, which find names,
 * follow sequences and enforce limits.
 *
 * Reasons contain what was found and what was expected. The caller adds the position. */
#ifndef COMMAND_STREAM_BUILD_H
#define COMMAND_STREAM_BUILD_H

#include "base/hash.h"
#include "command/stream/stream.h"

struct builder {
    struct stream *stream;
    uint32_t resource_capacity, call_capacity;
    struct hash_table names; /* 1 + the index of each resource, by its name */
    size_t bytes;            /* bytes of all resources */
    uint32_t sequence;       /* the open sequence, or NO_RESOURCE */
    uint32_t executed;       /* calls that are executed, outside sequences */
    uint32_t frames;         /* frames that ended, outside sequences */
};

void stream_build_start(struct builder *builder, struct stream *stream);
void stream_build_free(struct builder *builder); /* keeps the stream */

/* Returns nonzero if the bytes can be a name. */
bool stream_build_is_name(const char *name, size_t length);

/* Returns the number of the resource with this name, or NO_RESOURCE. */
uint32_t stream_build_find(const struct builder *builder, const char *name, size_t length);

/* Appends a resource with a valid name. *resource is valid until the next one is appended. */
int stream_build_resource(struct builder *builder, const char *name, size_t length, enum resource_type type,
                          struct resource **resource, struct error *error);

/* Counts a resource's bytes against the stream's limit. */
int stream_build_account(struct builder *builder, size_t bytes, struct error *error);

/* Counts the calls that a play of the sequence executes, before the play is appended. */
int stream_build_play(struct builder *builder, uint32_t number, struct error *error);

/* Appends a call. After a CALL_SEQUENCE the following calls belong to the sequence, until
 * stream_build_end. */
int stream_build_call(struct builder *builder, const struct call *call, struct error *error);
void stream_build_end(struct builder *builder);

/* Finds the least and the largest of a resource's indices. */
void stream_build_extremes(struct resource *resource);

#endif
