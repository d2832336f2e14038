/* Writes records to a file of chunks: calls, definitions with their data, ends of sequences.
 *
 * The first failure is kept, with the name of the file. Nothing is written afterwards, chunk_close reports
 * it, and there is no file. Missing memory for a record is such a failure, because no record may be
 * missing. */
#ifndef CAPTURE_WRITE_H
#define CAPTURE_WRITE_H

#include "capture/call.h"
#include "capture/chunk.h"
#include "capture/codec.h"

struct record_writer {
    struct chunk_writer chunks; /* opened and closed by the owner of the writer */
    struct codec codec;         /* for one record at a time; the owner frees its data */
};

void record_write_call(struct record_writer *writer, const struct call *call);
void record_write_definition(struct record_writer *writer, uint32_t number, const struct resource *resource);
void record_write_end(struct record_writer *writer);

/* Reports a failure of the caller: nothing is written from now on. */
void record_write_fail(struct record_writer *writer, const char *reason);

#endif
