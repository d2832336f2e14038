/* Checks of containers: calls name resources of the right types, and their values can be written as text.
 * call_code() has already checked enumerations and array indices. Afterwards the executed calls are followed
 * (follow.h). */
#ifndef COMMAND_STREAM_VALID_H
#define COMMAND_STREAM_VALID_H

#include "command/stream/stream.h"

int valid_call(const struct stream *stream, struct call *call, struct error *error);

/* Checks that an update's box is a part of its texture, and that its source has the bytes of the box. */
int valid_update_bytes(const struct stream *stream, const struct call *call, struct error *error);

/* Checks that the bits of packed vertices that belong to no component are 0: they have no text. */
int valid_vertex_bits(const struct resource *resource, struct error *error);

/* Calls whose rows do not describe them (stream_functions). Resources and numbers were checked before. */
int valid_target(const struct stream *stream, const struct call *call, struct error *error);
int valid_set(const struct stream *stream, const struct call *call, struct error *error);
int valid_bind_indices(const struct stream *stream, const struct call *call, struct error *error);
int valid_declare(const struct stream *stream, const struct call *call, struct error *error);
int valid_fvf(const struct stream *stream, const struct call *call, struct error *error);
int valid_shader(const struct stream *stream, const struct call *call, struct error *error);
int valid_update(const struct stream *stream, const struct call *call, struct error *error);
int valid_attach(const struct stream *stream, const struct call *call, struct error *error);
int valid_copy(const struct stream *stream, const struct call *call, struct error *error);
int valid_set_pixels(const struct stream *stream, const struct call *call, struct error *error);
int valid_fill(const struct stream *stream, const struct call *call, struct error *error);

/* The bytes of a row of checked pixels, and the rows: of pixels or, if the format is compressed, of blocks.
 */
size_t valid_set_pixels_row(const struct stream *stream, const struct call_set_pixels *write, size_t *rows);
int valid_clear(const struct stream *stream, const struct call *call, struct error *error);

#endif
