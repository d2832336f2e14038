/* Records written to a file of chunks: calls, definitions with their data, ends of sequences.
 *
 * The first thing that goes wrong stays, with the file's name in front; nothing is written from then on, chunk_close tells
 * it, and there is no file. A record that there was no memory for is such a thing: it must not be missing. */
#ifndef CONTAINER_WRITE_H
#define CONTAINER_WRITE_H

#include "container/call.h"
#include "container/chunk.h"
#include "container/codec.h"

struct record_writer {
    struct chunk_writer chunks; /* opened and closed by who has the writer */
    struct codec codec;         /* of one record after the other; its data are freed by who has the writer */
};

void record_write_call(struct record_writer *writer, const struct call *call);
void record_write_definition(struct record_writer *writer, uint32_t number, const struct resource *resource);
void record_write_end(struct record_writer *writer);

/* Something went wrong outside: nothing is written from here on. */
void record_write_fail(struct record_writer *writer, const char *reason);

#endif
