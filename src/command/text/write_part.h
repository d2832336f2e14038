/* Shared by the parts of the writer of text: resources (write.c) and calls (write_call.c). */
#ifndef COMMAND_TEXT_WRITE_PART_H
#define COMMAND_TEXT_WRITE_PART_H

#include "command/stream/stream.h"

#include <stdio.h>

struct writer {
    FILE *out;
    const struct stream *stream;
    /* the path from the new text's folder to the old one, which relative paths begin with; "" if they are
     * equal */
    char *prefix;
    bool by_path; /* the files of the current resource have its data */
    bool starved; /* this could not be determined because memory is short */
};

/* Numbers, each after a space. */
void write_number(struct writer *writer, float number);
void write_numbers(struct writer *writer, const float *numbers, size_t count);

/* A call, without the end of its line. */
void write_call(struct writer *writer, const struct call *call);

/* All calls, one per line. */
void write_calls(struct writer *writer);

/* Calls whose text does not follow from their rows (stream_functions), without the end of the line. */
void write_target(struct writer *writer, const struct call *call);
void write_set(struct writer *writer, const struct call *call);
void write_convention(struct writer *writer, const struct call *call);
void write_transform(struct writer *writer, const struct call *call);
void write_material(struct writer *writer, const struct call *call);
void write_light(struct writer *writer, const struct call *call);
void write_enable_light(struct writer *writer, const struct call *call);
void write_bind_texture(struct writer *writer, const struct call *call);
void write_bind_indices(struct writer *writer, const struct call *call);
void write_bind_element(struct writer *writer, const struct call *call);
void write_bind_stream(struct writer *writer, const struct call *call);
void write_declare(struct writer *writer, const struct call *call);
void write_fvf(struct writer *writer, const struct call *call);
void write_set_shader(struct writer *writer, const struct call *call);
void write_constants(struct writer *writer, const struct call *call);
void write_constant_matrix(struct writer *writer, const struct call *call);
void write_update(struct writer *writer, const struct call *call);
void write_attach(struct writer *writer, const struct call *call);
void write_copy(struct writer *writer, const struct call *call);
void write_set_pixels(struct writer *writer, const struct call *call);
void write_fill(struct writer *writer, const struct call *call);
void write_clear(struct writer *writer, const struct call *call);
void write_clear_parts(struct writer *writer, const struct call *call);

#endif
