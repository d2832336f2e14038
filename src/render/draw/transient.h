/* Transient memory: vertices and indices of immediate draws, from the draw call until the draw is rendered.
 *
 * As with the constants of shaders (render/draw/constant.h), the memory is bounded and has two halves: one is
 * written while the draws of the other are rendered. When a draw does not fit, what is queued must be
 * rendered first.
 *
 * The half that is written is a buffer, and the vertices of draws with one stride are vertices of one stream
 * of it: consecutive draws differ in their first vertex and share a job. */
#ifndef RENDER_DRAW_TRANSIENT_H
#define RENDER_DRAW_TRANSIENT_H

#include "render/state/state.h"

enum { TRANSIENT_BYTES = 4 << 20, TRANSIENT_ALIGNMENT = 16 };

struct transient {
    uint8_t *memory;               /* twice TRANSIENT_BYTES; null before the first immediate draw */
    struct triptych_buffer buffer; /* the half that is written */
    struct triptych_buffer large;  /* the vertices of a draw that needs more, while it is queued */
    size_t used;                   /* bytes of the half */
};

/* The data of an immediate draw. */
struct immediate {
    const void *vertices;
    size_t vertex_bytes;
    uint32_t stride;
    const void *indices; /* null: none */
    size_t index_bytes;
    bool moves; /* its stream must begin with its first vertex */
};

/* Makes memory, if there is none yet. Returns 0, or -1 with the reason. */
int transient_create(struct transient *transient, struct error *error);
void transient_destroy(struct transient *transient);

/* Returns true if the data fit into an empty half. */
bool transient_may_fit(const struct immediate *immediate);
/* Returns true if the data fit into the rest of the half. */
bool transient_fits(const struct transient *transient, const struct immediate *immediate);

/* The offset of a stream that begins with the next vertex. */
size_t transient_next(const struct transient *transient);

/* Copies the data, which fit. Returns the number of the first vertex in the stream, whose buffer and stride
 * are those of the draw, and sets *indices. It may change the offset of the stream. */
uint32_t transient_place(struct transient *transient, const struct immediate *immediate,
                         struct state_stream *stream, const void **indices);

/* Empties the half. */
void transient_reset(struct transient *transient);
/* Empties the other half, which is written from now on. */
void transient_exchange(struct transient *transient);

#endif
