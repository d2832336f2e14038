/* The binary form of draw streams: what capture/chunk.h frames, as a stream. docs/container.md is its
 * reference.
 *
 * The contents of the chunks are records, each a byte of type and its fields (capture/call.c,
 * capture/resource.c):
 *
 *   1..63  a call, by its number in capture/call.def
 *   64     the definition of a resource: its number u32, its type u8, its name, what its type needs; then its
 *          data, which may go on through any number of chunks. A sequence's calls follow it, up to
 *   65     the end of a sequence
 *
 * A resource's number is free again when it has been released. Everything that is read is checked as text is:
 * what the grammar makes sure of by codecs and command/stream/valid.c, the rest by following the calls
 * (command/stream/follow.h).
 *
 * Functions that return int return 0, or -1 with one line: PATH: offset N (chunk K, byte B): found ...,
 * expected ... */
#ifndef COMMAND_CONTAINER_CONTAINER_H
#define COMMAND_CONTAINER_CONTAINER_H

#include "capture/chunk.h"
#include "command/stream/stream.h"

/* Reads a container in memory as a whole stream. `flags` may have CHUNK_IGNORE_CHECKSUMS, and: a container
 * that was cut off or damaged ends with its last whole frame. It must have one. */
enum { CONTAINER_SALVAGE = 2 };
int container_parse(const char *path, const void *data, size_t bytes, unsigned flags, struct stream **stream,
                    struct error *error);

/* stream_read of a container with flags. */
int container_read(const char *path, unsigned flags, struct stream **stream, struct error *error);

/* Writes a stream as a container, whole or not at all. Files are embedded, and their paths changed to begin
 * at the new folder. */
int container_save(const struct stream *stream, const char *path, struct error *error);

/* --- Records, read one after the other ------ ----------------------------------------------- */

enum record_type { RECORD_IS_CALL, RECORD_IS_RESOURCE, RECORD_IS_END, RECORD_NONE };

struct record {
    enum record_type type;
    size_t byte;              /* of the chunk's contents, where it begins */
    struct call call;         /* its place is set */
    struct resource resource; /* with its data; the reader of the record owns it */
    uint32_t number;          /* the resource's */
};

/* Reads the next record. `room` is how many bytes of a device its resource may cost. At the container's end
 * the type is RECORD_NONE. A failure leaves nothing to be freed. */
int container_next(struct chunk_reader *reader, size_t room, struct record *record, struct error *error);

/* "texture", "buffer", ...: what resources without a name are called, with a number. */
const char *container_type_name(enum resource_type type);

/* Makes what the definition implies: a shader's program, a shape's vertices, texels that are made. The
 * resources that it names are the stream's; `caster` is that of a shadow, or null. */
int container_finish_resource(struct resource *resource, const struct resource *caster, struct error *error);

/* Checks a definition that was read. `room` is the number of bytes of a device that its resource may take. */
int container_check_definition(const struct resource *resource, size_t room, struct error *error);

#endif
