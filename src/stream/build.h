/* A stream while it is made, by whichever reader: resources and calls are appended, names found, sequences followed,
 * limits held.
 *
 * Reasons say what was found and what was expected; where, the caller knows. */
#ifndef STREAM_BUILD_H
#define STREAM_BUILD_H

#include "stream/stream.h"

struct builder {
    struct stream *stream;
    uint32_t resource_capacity, call_capacity;
    uint32_t *names; /* open addressing: 1 + a resource's number, 0 is free; a power of two of places */
    uint32_t name_places;
    size_t bytes;      /* of all resources */
    uint32_t sequence; /* the one that is being read, or NO_RESOURCE */
    uint32_t executed; /* by the calls outside sequences */
};

void build_start(struct builder *builder, struct stream *stream);
void build_free(struct builder *builder); /* not the stream */

/* Whether the bytes can be a name. */
int build_is_name(const char *name, size_t length);

/* The number of the resource of that name, or NO_RESOURCE. */
uint32_t build_find(const struct builder *builder, const char *name, size_t length);

/* Appends a resource with a name that can be one; *resource is valid until the next one. */
int build_resource(struct builder *builder, const char *name, size_t length, enum resource_type type,
                   struct resource **resource, struct error *error);

/* Counts a resource's bytes against the stream's limit. */
int build_account(struct builder *builder, size_t bytes, struct error *error);

/* Counts what a play of the sequence of that number executes, before its call is appended. */
int build_play(struct builder *builder, uint32_t number, struct error *error);

/* Appends a call. That which begins a sequence makes the calls behind it that sequence's, until build_end. */
int build_call(struct builder *builder, const struct call *call, struct error *error);
void build_end(struct builder *builder);

/* Finds the least and the largest of a resource's indices. */
void build_extremes(struct resource *resource);

#endif
