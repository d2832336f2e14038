/* A recording read as it is played: one record after the other, with what is alive in memory and nothing
 * else.
 *
 * The stream that it fills, the window, has resources by their numbers in the container, and no calls. A
 * resource is there from its definition to its release; its number may then be another's. Every call is
 * checked, as those of a whole stream are, when it is read. A reader takes the live resources, two chunks and
 * zstd's context, however long the recording. */
#ifndef COMMAND_CONTAINER_READER_H
#define COMMAND_CONTAINER_READER_H

#include "command/container/container.h"

struct stream_reader;

/* Opens a container that is a recording in a regular file: the stream has a path and a number of frames, and
 * readers are made of it. Anything else is read as a whole (stream_read). */
int container_open(const char *path, struct stream **stream, struct error *error);

/* A reader at the beginning of a stream that container_open has not read as a whole; the stream must outlive
 * it. Null with the reason. */
struct stream_reader *reader_create(const struct stream *stream, struct error *error);
void reader_free(struct stream_reader *reader);

/* Begins anew: the window has no resources then. */
int reader_rewind(struct stream_reader *reader, struct error *error);

const struct stream *reader_window(const struct stream_reader *reader);

/* Reads the next record. RECORD_IS_RESOURCE: the window has it under `number`. RECORD_IS_CALL: it can be
 * executed; after a release the resource has to be given up, by reader_release. */
struct step {
    enum record_type type;
    struct call call;
    uint32_t number;
};
int reader_next(struct stream_reader *reader, struct step *step, struct error *error);

/* The window's resource is gone; its texels or its data are not needed any more. */
void reader_release(struct stream_reader *reader, uint32_t number);
void reader_drop_texels(struct stream_reader *reader, uint32_t number);

#endif
