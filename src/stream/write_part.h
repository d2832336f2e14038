/* What the parts of the writer of text share: the whole and the resources (write.c), the calls (write_call.c). */
#ifndef STREAM_WRITE_PART_H
#define STREAM_WRITE_PART_H

#include "stream/stream.h"

#include <stdio.h>

struct writer {
    FILE *out;
    const struct stream *stream;
    char *prefix; /* from the new text's folder to that of the old, in front of relative paths; "" if they are
                     one */
    int by_path;  /* the files of the resource that is being written have its data */
    int starved;  /* that could not be found out for want of memory */
};

/* Numbers, with a space in front of each. */
void write_number(struct writer *writer, float number);
void write_numbers(struct writer *writer, const float *numbers, size_t count);

/* All calls, a line each. */
void write_calls(struct writer *writer);

#endif
